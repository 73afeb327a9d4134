"""Mesh tables of several operating points of one pair, whose contacts are looked at in one pass."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import fields, replace
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from tribodyn.ehl import FILM_MODELS
from tribodyn.ehl.steady.batch import Films
from tribodyn.errors import ModelWarning, TribodynError, collected, require_positive
from tribodyn.friction import LAWS, FrictionParts, pitch_point
from tribodyn.mesh.build import columns_of, known_teeth, table_of
from tribodyn.mesh.cycle import MeshCycle, pairs_in_contact
from tribodyn.mesh.film.path_film import FormulaFilm, Friction
from tribodyn.mesh.gears import Gears
from tribodyn.mesh.loads import Loads, reported_films, tribological_contact
from tribodyn.mesh.sharing import Teeth, ToothContact, shared_load_columns
from tribodyn.mesh.table import MeshTable

#: A mesh table, and what the models said of it.
Told = tuple[MeshTable, list[ModelWarning]]


class _Point(NamedTuple):
    """An operating point with its teeth, and what was said of them."""

    speed: float
    torque: float
    cycle: MeshCycle
    teeth: Teeth
    told: list[ModelWarning]


def mesh_tables(
    pair: Gears,
    settings: ToothContact,
    operations: Sequence[tuple[float, float]],
    *,
    force_law: bool = False,
) -> list[Told]:
    """Mesh tables at several speeds and torques.

    None at all where films are solved or are springs, or where a point cannot be computed: then
    each table has to be computed by itself.
    """
    if FILM_MODELS[settings.film_model].method or settings.film_in_series or len(operations) < 2:
        return []
    try:
        points = [_point(pair, settings, *operation) for operation in operations]
        columns = _columns(pair, settings, points)
    except TribodynError:
        return []
    tables: list[Told] = []
    for row, (speed, torque, cycle, teeth, told) in enumerate(points):
        with collected() as also:
            shared = shared_load_columns(teeth, teeth.shared_load(), None, force_law=force_law)
        own = {name: c[row] if np.ndim(c) == 3 else c for name, c in columns.items()}
        table = table_of(pair, settings, cycle, (speed, torque), shared | own)
        tables.append((table, [*told, *also]))
    return tables


def _point(pair: Gears, settings: ToothContact, speed: float, torque: float) -> _Point:
    require_positive("pinion_torque", torque, "N*m")
    with collected() as told:
        cycle, teeth = known_teeth(pair, settings, torque, None, None)
    return _Point(speed, torque, cycle, teeth, told)


def _columns(pair: Gears, settings: ToothContact, points: Sequence[_Point]) -> dict[str, Any]:
    """Columns of all points, each in its row, or without rows where they are the same."""
    cycle = points[0].cycle
    motion = cycle.motion(np.array([[point.speed] for point in points]))
    pairs = pairs_in_contact(cycle, motion, settings.lubricant, settings.material)
    load = np.stack([point.teeth.dry_load for point in points])
    least = np.array([[point.teeth.least_load] for point in points])
    film_at = FormulaFilm(settings, pairs, least)
    shared = points[0].teeth.shared_load()
    loads = Loads(shared, load, np.maximum(load, least), film_at, None)

    def films_of(row: int) -> Films:
        own: FormulaFilm = replace(_row(film_at, row), pairs=_row(pairs, row))
        return own(loads.tribological[row])

    films: Films = _asked(points, lambda: film_at(loads.tribological), films_of)
    roughness = settings.composite_roughness
    contact = tribological_contact(motion, pairs, loads.tribological, roughness, None, films)

    def friction_of(row: int) -> Friction:
        pitch = pitch_point(pair, points[row].speed, points[row].torque)
        own = replace(_row(contact, row), pitch=pitch)
        return film_at.friction(own, motion, settings)

    together = LAWS[settings.friction_law].together
    all_at_once = partial(film_at.friction, contact, motion, settings) if together else None
    friction = _asked(points, all_at_once, friction_of)
    reported = reported_films(films, loads, least)
    return columns_of(cycle, motion, loads, contact, reported, friction)


def _asked(
    points: Sequence[_Point],
    together: Callable[[], Any] | None,
    alone: Callable[[int], Any],
) -> Any:
    """Ask about all rows at a time, or one after the other where what is told may differ."""
    if together is not None:
        with collected() as told:
            found = together()
        if not told:
            return found
    each = []
    for row, point in enumerate(points):
        with collected() as told:
            each.append(alone(row))
        point.told.extend(told)
    return _stacked(each)


def _row(bundle: Any, row: int) -> Any:
    """One row of all that is in rows."""
    known = {each.name: getattr(bundle, each.name) for each in fields(bundle)}
    own = {name: value[row] for name, value in known.items() if np.ndim(value) == 2}
    return replace(bundle, **own)


def _stacked(each: Sequence[Any]) -> Any:
    """What was found of every row, in rows."""
    first: Any = each[0]
    if isinstance(first, np.ndarray):
        return np.stack(each)
    if not isinstance(first, Films | FrictionParts):
        return first
    names = [part.name for part in fields(first)]
    return replace(first, **{n: _stacked([getattr(one, n) for one in each]) for n in names})
