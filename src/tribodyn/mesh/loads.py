"""Quasi-static loads of the tooth pairs, with or without their oil film in series."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, replace
from typing import Any, Generic

import numpy as np

from tribodyn.contact import hertz_line
from tribodyn.ehl.steady.batch import Films
from tribodyn.errors import ComputationError, quiet, warn
from tribodyn.friction import PitchPoint, TribologicalContact
from tribodyn.friction.base import STEEL_BODIES
from tribodyn.mesh.cycle import MeshCycle, PairsInContact
from tribodyn.mesh.film.film_columns import smallest_film
from tribodyn.mesh.film.film_lookup import (
    FilmLookup,
    OutsideTableError,
    look_up_film,
    look_up_slices,
)
from tribodyn.mesh.film.film_refinement import ALL, PRESSURE, QUANTITIES, STIFFNESS
from tribodyn.mesh.film.loaded_contacts import ContactMotion, FilmSprings, LoadedTeeth, Share
from tribodyn.mesh.film.path_film import FilmAt, FormulaFilm, PathFilm, film_of
from tribodyn.mesh.sharing import (
    LEAST_SHARE,
    SharedLoad,
    Teeth,
    ToothContact,
)
from tribodyn.progress import Progress
from tribodyn.record import from_parts
from tribodyn.types import Array, Mask, Tree


@dataclass(frozen=True, eq=False)
class Loads(Generic[Share]):
    """Loads, stiffness and film of every tooth pair."""

    shared: Share  #: how the mesh carries its load, film included where it counts
    load_per_width: Array  #: of the pairs in contact [N/m]
    tribological: Array  #: the same, no less than a film needs [N/m]
    film_at: FilmAt  #: films of the pairs in contact as a function of their loads per width
    springs: FilmSprings | None  #: films in series with the teeth


def quasi_static_loads(
    cycle: MeshCycle,
    teeth: Teeth,
    pairs: PairsInContact,
    settings: ToothContact,
    speed: float,
    progress: Progress,
) -> Loads[SharedLoad]:
    """Share the load among the pairs and find their films."""
    if (film_of_slices := look_up_slices(settings, cycle, teeth, pairs)) is not None:
        return under_load(teeth, settings, film_of_slices, cycle.named)
    if (tabled := look_up_film(settings, cycle, teeth, pairs)) is not None:
        # What the table cannot settle, films of its own may.
        with suppress(OutsideTableError, ComputationError):
            return under_load(teeth, settings, tabled, cycle.named)
    film = film_of(settings, cycle, teeth, pairs, speed, progress)
    return under_load(teeth, settings, film, cycle.named)


def under_load(
    teeth: LoadedTeeth[Share],
    settings: ToothContact,
    film: FormulaFilm | PathFilm | FilmLookup,
    where: Callable[[int, int], str],
) -> Loads[Share]:
    """Share the load among the pairs with some films, in series with the teeth if requested."""

    def solve(loads: Array, checked: tuple[int, ...]) -> FilmAt:
        raised = np.maximum(loads, film.least_load)
        return film.solve(np.where(teeth.in_contact, raised, 0.0), checked)

    springs = None
    if settings.film_in_series:
        shared, film_at = in_series(teeth, solve, where)
        load = np.maximum(teeth.load_per_width * shared.share, teeth.least_load)
        springs = _springs(teeth, load, film_at)
    else:
        shared = teeth.shared_load()
        film_at = solve(teeth.load_per_width * shared.share, ALL)
    load = teeth.dry_load
    if springs is not None:
        load = (teeth.load_per_width * shared.share)[teeth.in_contact]
    return Loads(shared, load, np.maximum(load, film.least_load), film_at, springs)


def reported_films(films: Films, loads: Loads[Any], least_load: Array | float) -> Films:
    """Leave out pairs that hardly touch, and what is not known well enough."""
    loads.film_at.warn_of_doubt()
    films, certain = loads.film_at.reported(films, loads.tribological)
    certain = (loads.load_per_width > least_load) & certain
    columns: Tree = {}
    for row, name in zip(certain, QUANTITIES, strict=True):
        column = getattr(films, name)
        columns[name] = None if column is None else np.where(row, column, np.nan)
    return replace(films, **columns)


def warn_of_rigid_films(film_at: FilmAt) -> None:
    """Say where a solved film has no tangent stiffness, because it does not fall with the load."""
    share = film_at.rigid_share
    if share > 0.0:
        warn(
            "film-stiffness",
            f"in {100.0 * share:.2g} % of the contacts of the mesh cycle the central film does not "
            "fall with the load, so that it has no tangent stiffness: there it counts as rigid. "
            "Light loads do that, where contacts turn from rigid to elastic, and starved inlets",
            stacklevel=4,
        )


def tribological_contact(
    motion: ContactMotion,
    pairs: PairsInContact,
    load_per_width: Array,
    composite_roughness: float,
    pitch: PitchPoint | None,
    films: Films,
    *,
    bodies: tuple[float, float] = STEEL_BODIES,
) -> TribologicalContact:
    """Loaded contacts as the friction laws see them."""
    hertz = hertz_line(load_per_width, motion.equivalent_radius, pairs.effective_modulus)
    return from_parts(
        TribologicalContact,
        *(motion, films, pairs.lubricant),
        load_per_width=load_per_width,
        hertz_pressure=hertz.maximum_pressure,
        composite_roughness=composite_roughness,
        oil_density=pairs.lubricant.density,
        film_thickness=smallest_film(films),
        pitch=pitch,
        bodies=bodies,
    )


#: Films of the loads given, with the quantities in which they are checked between the positions.
SolveFilm = Callable[[Array, tuple[int, ...]], FilmAt]

#: The film is solved again until the load shares move by less than this.
_TOLERANCE = 1e-6
#: Where pairs are solved together one may be about to lose its load to its film: there it is this.
_TOLERANCE_TOGETHER = 1e-5
#: Part of its share by which that of a film with a distance may move: the square of it is the part
#: of the distance by which a film that is solved again would differ, but for rounding.
_MOVED = 2e-3
_PASSES = 60
#: Solutions in which the last change has to halve: else it goes to and fro for ever.
_HALVED = 15
#: What is checked between the positions, first and whenever the shares have settled. At last the
#: stiffness stays as it is, so that an end is reached where a pair is about to lose its load.
_STAGES = ((STIFFNESS,), ALL, ALL, ALL[:STIFFNESS])
#: Part of the last change to which the next shares settle.
_ENOUGH = 1e-3
#: Between two solutions the shares settle to this; each pass gains one digit or two, and after
#: every few of them the limit is extrapolated.
_SETTLED = 1e-13
#: Pairs that are solved together are solved to this.
_SETTLED_TOGETHER = 1e-9
_STEPS = 300
#: Steps that tell a slope, and bounds of that slope: 1 is a share that does not act on itself.
_TOLD, _FALLS, _FALLS_OF_PASSES = 1e-11, (0.2, 50.0), (0.4, 3.0)
_ROUND = 4
#: Change of the steps, relative to them, without which nothing can be extrapolated.
_BENT = 1e-3
#: Load share below which a pair has lost its load to a film that is softer than its teeth.
_LOST = 1e-9


def in_series(
    teeth: LoadedTeeth[Share],
    solve: SolveFilm,
    where: Callable[[int, int], str],
) -> tuple[Share, FilmAt]:
    """Put the film of each pair in series with its teeth, at the load share that follows."""
    tolerance = _TOLERANCE_TOGETHER if teeth.coupled else _TOLERANCE
    share, stages = teeth.shared_load().share, list(_STAGES)
    checked, change = stages.pop(0), 1.0
    least, since, number = 2.0, 0, 0
    before, step, slope = share, np.zeros(share.shape), np.ones(share.shape)
    while number < _PASSES and since < _HALVED:
        number += 1
        film_at = solve(teeth.load_per_width * share, checked)
        enough = _ENOUGH * min(change, 1.0)
        shared = _settle(teeth, film_at, share, where, enough)
        earlier, step = step, shared.share - share
        change = float(np.max(np.abs(step)))
        free = _MOVED * share if film_at.keeps_distance else 0.0
        settled = bool(np.all(np.abs(step) < tolerance + free))
        if settled and PRESSURE in checked:
            return shared, film_at
        checked = stages.pop(0) if settled and stages else ()
        least, since = (change, 0) if settled or change < 0.5 * least else (least, since + 1)
        if film_at.keeps_distance:
            share = shared.share
            continue
        slope = _secant(share - before, step - earlier, slope, _FALLS_OF_PASSES)
        before, share = share, np.clip(share + step / slope, 0.0, 1.0)
    raise _unsettled(f"the load share still moves by {change:.2g} after {number} solutions")


def _settle(
    teeth: LoadedTeeth[Share],
    film_at: FilmAt,
    share: Array,
    where: Callable[[int, int], str],
    enough: float,
) -> Share:
    """Find the fixed point of share and stiffness with the films as a function of their load."""
    if film_at.keeps_distance:
        return _settle_distances(teeth, film_at, share, where)
    if teeth.coupled:
        return _settle_together(teeth, film_at, share, where, enough)
    earlier = [share]
    loaded = teeth.in_contact & (share > _LOST)
    for _ in range(_STEPS):
        shared = teeth.shared_load(_springs(teeth, teeth.load_per_width * share, film_at))
        share = shared.share
        change = np.abs(share - earlier[-1])
        if change.max() < _SETTLED:
            return shared
        lost = loaded & (share < _LOST)
        if lost.any():
            row, pair = np.argwhere(lost)[0]
            raise _unsettled(f"{where(row, pair)} loses its whole load to its film")
        earlier.append(share)
        if len(earlier) == _ROUND:
            share = _extrapolated(earlier, teeth.in_contact)
            earlier = [share]
    raise _still_moving(change, where)


def _settle_distances(
    teeth: LoadedTeeth[Share], film_at: FilmAt, share: Array, where: Callable[[int, int], str]
) -> Share:
    """The same for films that keep a distance: Newton's method, as each spring is a tangent."""
    least = LEAST_SHARE * teeth.normal_force / teeth.face_width
    for _ in range(_STEPS):
        load = np.maximum(teeth.load_per_width * share, least)
        shared = teeth.shared_load(_springs(teeth, load, film_at))
        step, share = np.abs(shared.share - share), shared.share
        if step.max() < _SETTLED_TOGETHER:
            return shared
    raise _still_moving(step, where)


def _settle_together(
    teeth: LoadedTeeth[Share],
    film_at: FilmAt,
    share: Array,
    where: Callable[[int, int], str],
    enough: float,
) -> Share:
    """The same for pairs solved together; a share that swings to and fro is slowed down."""
    before, step = share, np.zeros(share.shape)
    slope = np.ones(share.shape)
    for _ in range(_STEPS):
        load = np.maximum(teeth.load_per_width * share, teeth.least_load)
        shared = teeth.shared_load(_springs(teeth, load, film_at))
        earlier, step = step, shared.share - share
        if np.abs(step).max() < max(enough, _SETTLED_TOGETHER):
            return shared
        slope = _secant(share - before, step - earlier, slope, _FALLS)
        before, share = share, np.clip(share + step / slope, 0.0, 1.0)
    raise _still_moving(np.abs(step), where)


def _secant(moved: Array, change: Array, slope: Array, bounds: tuple[float, float]) -> Array:
    """Fall of the step over the share, within bounds that neither stop it nor let it jump."""
    significant = np.abs(moved) > _TOLD
    fall = -change / np.where(significant, moved, 1.0)
    return np.where(significant, np.clip(fall, *bounds), slope)


def _still_moving(change: Array, where: Callable[[int, int], str]) -> ComputationError:
    row, pair = np.unravel_index(int(np.argmax(change)), change.shape)
    return _unsettled(
        f"the load share of {where(int(row), int(pair))} still moves by {change.max():.2g} after "
        f"{_STEPS} steps"
    )


def _springs(teeth: LoadedTeeth[Any], load_per_width: Array, film_at: FilmAt) -> FilmSprings:
    """Films of the pairs under their loads."""
    on_path = teeth.in_contact
    load = load_per_width[on_path]
    with quiet():
        # What a formula has to say, it says of the load share that is found.
        film = film_at(load)
    stiffness, lead = np.zeros((2, *on_path.shape))
    stiffness[on_path] = np.asarray(film.film_stiffness)
    if not film_at.keeps_distance:
        return FilmSprings(stiffness, None)
    # The straight line with this slope through distance and load of the film.
    force = load * np.broadcast_to(teeth.face_widths, on_path.shape)[on_path]
    lead[on_path] = np.asarray(film.film_distance) + force / stiffness[on_path]
    return FilmSprings(stiffness, lead)


def _extrapolated(earlier: list[Array], in_contact: Mask) -> Array:
    """Limit of the last three shares by the rule of Aitken, where it lies nearby."""
    first, second, third = earlier[-3:]
    step, bend = third - second, third - 2.0 * second + first
    safe = np.where(np.abs(bend) > _BENT * np.abs(step), bend, 1.0)
    limit = np.where(np.abs(bend) > _BENT * np.abs(step), third - step * step / safe, third)
    limit = np.where(in_contact & (limit > 0.5 * third), limit, third)
    return np.asarray(limit * (third.sum(axis=1) / limit.sum(axis=1))[:, None])


def _unsettled(what: str) -> ComputationError:
    why = "The film of a lightly loaded pair is softer than its teeth"
    remedy = 'Set film.stiffness = "none", or "approach" where it is another one'
    return ComputationError(what, "film stiffness in series with the teeth", why, remedy)
