"""Mesh tables of several operating points of one pair, whose contacts are looked at in one pass."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields, replace
from typing import Any, NamedTuple

import numpy as np

from tribodyn.contact import Kinematics
from tribodyn.ehl import FILM_MODELS
from tribodyn.errors import ModelWarning, TribodynError, collected, require_positive
from tribodyn.friction import LAWS, FrictionParts, TribologicalContact, pitch_point
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

    None at all where films are solved or are springs, where a point cannot be computed, or where
    something is told of its films: then each table has to be computed by itself.
    """
    if FILM_MODELS[settings.film_model].method or settings.film_in_series or len(operations) < 2:
        return []
    try:
        points = [_point(pair, settings, *operation) for operation in operations]
        with collected() as found:
            columns = _columns(pair, settings, points)
    except TribodynError:
        return []
    tables: list[Told] = []
    for row, (speed, torque, cycle, teeth, told) in enumerate(points):
        with collected() as also:
            shared = shared_load_columns(teeth, teeth.shared_load(), None, force_law=force_law)
        own = {name: c if c is None else c[row] for name, c in columns.items()}
        table = table_of(pair, settings, cycle, (speed, torque), shared | own)
        tables.append((table, [*told, *also]))
    return [] if found else tables


def _point(pair: Gears, settings: ToothContact, speed: float, torque: float) -> _Point:
    require_positive("pinion_torque", torque, "N*m")
    with collected() as told:
        cycle, teeth = known_teeth(pair, settings, torque, None, None)
    return _Point(speed, torque, cycle, teeth, told)


def _columns(pair: Gears, settings: ToothContact, points: Sequence[_Point]) -> dict[str, Any]:
    """Columns of all points, each in its row."""
    cycle = points[0].cycle
    motion = cycle.motion(np.array([[point.speed] for point in points]))
    pairs = pairs_in_contact(cycle, motion, settings.lubricant, settings.material)
    load = np.stack([point.teeth.dry_load for point in points])
    least = np.array([[point.teeth.least_load] for point in points])
    film_at = FormulaFilm(settings, pairs, least)
    shared = points[0].teeth.shared_load()
    loads = Loads(shared, load, np.maximum(load, least), film_at, None)
    films = film_at(loads.tribological)
    roughness = settings.composite_roughness
    contact = tribological_contact(motion, pairs, loads.tribological, roughness, None, films)
    law = _Law(pair, settings, film_at, motion)
    reported = reported_films(films, loads, least)
    return columns_of(cycle, motion, loads, contact, reported, law.friction(contact, points))


class _Law(NamedTuple):
    """The friction law of some settings, asked about contacts in rows."""

    pair: Gears
    settings: ToothContact
    film_at: FormulaFilm
    motion: Kinematics

    def friction(self, contact: TribologicalContact, points: Sequence[_Point]) -> Friction:
        """Friction of all rows at a time, or of one after the other where that may differ."""
        if LAWS[self.settings.friction_law].together:
            with collected() as told:
                friction = self._of(contact)
            if not told:
                return friction
        each: list[Any] = [self._of_row(contact, row, point) for row, point in enumerate(points)]
        if not isinstance(each[0], FrictionParts):
            return np.stack(each)
        parts = ([getattr(one, part.name) for one in each] for part in fields(each[0]))
        return FrictionParts(*(np.stack(part) for part in parts))

    def _of_row(self, contact: TribologicalContact, row: int, point: _Point) -> Friction:
        known = {each.name: getattr(contact, each.name) for each in fields(contact)}
        own = {name: value[row] for name, value in known.items() if np.ndim(value) == 2}
        pitch = pitch_point(self.pair, point.speed, point.torque)
        with collected() as told:
            friction = self._of(replace(contact, **own, pitch=pitch))
        point.told.extend(told)
        return friction

    def _of(self, contact: TribologicalContact) -> Friction:
        return self.film_at.friction(contact, self.motion, self.settings)
