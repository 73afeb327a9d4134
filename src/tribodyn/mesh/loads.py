"""Quasi-static loads of the tooth pairs, with or without their oil film in series."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from tribodyn.contact import Kinematics, hertz_line
from tribodyn.ehl import FILM_MODELS
from tribodyn.ehl.steady.solved_films import Films
from tribodyn.errors import warn
from tribodyn.friction import TribologicalContact
from tribodyn.mesh.cycle import MeshCycle
from tribodyn.mesh.film_refinement import PathLoads
from tribodyn.mesh.path_film import FilmAt, PathFilm, SolvedPath, path_film
from tribodyn.mesh.positions import MOST
from tribodyn.mesh.series import FilmOf, in_series
from tribodyn.mesh.solved_places import ALL, PROMISED, QUANTITIES
from tribodyn.mesh.teeth import Carried, Teeth
from tribodyn.mesh.touching import Touching
from tribodyn.progress import Progress
from tribodyn.types import Array

#: Kinds of film stiffness that are springs; the printed sum of one source has the unit of a length.
IN_SERIES = ("tangent", "secant")


@dataclass(frozen=True, eq=False)
class Loads:
    """Loads, stiffness and film of every tooth pair."""

    carried: Carried  #: how the mesh carries its load, film included where it counts
    tribological: Array  #: [N/m]
    film_at: FilmAt  #: films of the touching pairs as a function of their loads per width


def quasi_static_loads(
    cycle: MeshCycle,
    teeth: Teeth,
    total_load: float,
    touching: Touching,
    pinion_speed: float,
    model: str,
    options: Mapping[str, Any],
    progress: Progress,
) -> Loads:
    """Share the load among the pairs and find their films."""
    least = teeth.least_share * total_load

    def raised(loads: Array) -> Array:
        return np.where(cycle.in_contact, np.maximum(loads, least), 0.0)

    def of_formula(loads: Array, checked: tuple[int, ...]) -> FilmAt:
        return lambda load: touching.films(model, np.maximum(load, least), **options)

    def of_path(loads: Array, checked: tuple[int, ...]) -> FilmAt:
        every = raised(loads)
        at_places = np.maximum(along.load_of(cycle.grid, every), least)
        of_contacts = every[cycle.in_contact]
        path_loads = PathLoads(at_places, of_contacts, of_contacts > least)
        return along.solve(path_loads, checked, progress)

    film_of: FilmOf = of_formula
    if FILM_MODELS[model].method:
        along: PathFilm = path_film(
            model, options, cycle.contact, pinion_speed, touching, cycle.side, teeth.bends
        )
        film_of = of_path
    if options["stiffness"] in IN_SERIES:
        carried, film_at = in_series(teeth, total_load, film_of, cycle.named)
    else:
        carried = teeth.carried()
        film_at = film_of(total_load * carried.share, ALL)
    return Loads(carried, raised(total_load * carried.share)[cycle.in_contact], film_at)


def reported_films(
    films: Films, film_at: FilmAt, load_per_width: Array, least_load: float
) -> Films:
    """Leave out pairs that hardly touch, and what is not known well enough."""
    touches = load_per_width > least_load
    known = np.broadcast_to(touches, (len(QUANTITIES), touches.size)).copy()
    if isinstance(film_at, SolvedPath):
        known &= ~film_at.doubtful
        _warn_of_doubt(film_at)
    columns: dict[str, Any] = {}
    for row, name in zip(known, QUANTITIES, strict=True):
        column = getattr(films, name)
        columns[name] = None if column is None else np.where(row, column, np.nan)
    return replace(films, **columns)


def _warn_of_doubt(film: SolvedPath) -> None:
    doubtful = film.doubtful & film.scored
    count = int(doubtful.any(axis=0).sum())
    if not count:
        return
    names = [
        name.replace("_", " ") for name, row in zip(QUANTITIES, doubtful, strict=True) if row.any()
    ]
    positions = film.path.options["positions"]
    more = f" More positions help: film.positions = {min(2 * positions, MOST)}."
    warn(
        "film-positions",
        f"at {count} of {int(film.scored.sum())} contacts of the mesh cycle the {', '.join(names)} "
        f"is not told, because it may be more than {100.0 * PROMISED:g} % from a solution there: "
        f"it changes so much along the path of contact that {len(film.films.solutions)} solved "
        f"contacts are too few.{more if positions < MOST else ''}",
        stacklevel=5,
    )


def warn_of_rigid_films(film_at: FilmAt) -> None:
    """Say where a solved film has no tangent stiffness, because it does not fall with the load."""
    share = film_at.rigid_share if isinstance(film_at, SolvedPath) else 0.0
    if share > 0.0:
        warn(
            "film-stiffness",
            f"in {100.0 * share:.2g} % of the contacts of the mesh cycle the central film does not "
            "fall with the load, so that it has no tangent stiffness: there it counts as rigid. "
            "Light loads do that, where contacts turn from rigid to elastic, and starved inlets",
            stacklevel=4,
        )


def tribological_contact(
    motion: Kinematics, touching: Touching, load_per_width: Array, composite_roughness: float
) -> TribologicalContact:
    """Loaded contacts as the friction laws see them."""
    hertz = hertz_line(load_per_width, motion.equivalent_radius, touching.effective_modulus)
    return TribologicalContact(
        load_per_width=load_per_width,
        hertz_pressure=hertz.maximum_pressure,
        sliding_speed=motion.sliding_speed,
        entrainment_speed=motion.entrainment_speed,
        slide_to_roll_ratio=motion.slide_to_roll_ratio,
        equivalent_radius=motion.equivalent_radius,
        dynamic_viscosity=touching.lubricant.dynamic_viscosity,
        composite_roughness=composite_roughness,
    )
