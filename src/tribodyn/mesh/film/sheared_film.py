"""Friction and heat of films that slices or cells shear, from a table over load and place.

The pressure of a film depends on the place on the path of contact, or on the flank of a hypoid
pair, and on the load alone, as does its friction at a sliding speed. Both are tabled, and every
contact interpolates its friction at its own sliding speed.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tribodyn.ehl import FILM_MODELS
from tribodyn.errors import ComputationError, quiet
from tribodyn.friction import LAWS, FrictionParts
from tribodyn.mesh.cycle import PairsInContact
from tribodyn.mesh.film.film_columns import judged
from tribodyn.mesh.film.film_refinement import STIFFNESS, Places, places_of
from tribodyn.mesh.film.film_table import FittedTable
from tribodyn.mesh.film.path_film import (
    COLD,
    Friction,
    parts_of,
    sampled_speeds,
    sheared_friction,
    speed_weights,
)
from tribodyn.mesh.sharing import ToothContact
from tribodyn.progress import SILENT
from tribodyn.types import Array, Index

#: Cells of the table for each unit of the logarithm of the load, of cold and of heated films, which
#: take longer; from the pitch point to the furthest contact, of a path and of a flank.
_OF_LOAD, _HEATED_LOAD, _ON_PATH, _ON_FLANK = 1.0, 0.5, (2.0,), (1.0, 1.0)
#: Load over the greatest from which on films are sheared and heated: lighter ones have the
#: coefficient and the heat of that load.
_LEAST_SHEARED, _LEAST_HEATED = 0.01, 0.05
#: The last contact is in the last of these cells.
_END = 1.0 - 1e-9


def place_from_pitch(distance: Array) -> Array:
    """Place from -1 to 1 by the distance from the pitch point, where heat and shear have a kink."""
    return np.asarray(np.sign(distance) * np.sqrt(np.abs(distance) / np.abs(distance).max()))


@dataclass(frozen=True, eq=False)
class ShearedFilms:
    """Friction and heat of the contacts of a mesh at one speed over place and load."""

    # The sliding speed of the contacts is the amount of their sliding: that along a line of contact
    # shears and heats its film like that across it. Its sign says which body is the faster one.

    settings: ToothContact
    pairs: PairsInContact  #: contacts of the mesh table
    #: Of each of them: its :func:`place_from_pitch`, and on a flank its place along it, 0 to 1.
    place: Array

    @property
    def sliding(self) -> Array:
        """Sliding speed of each contact [m/s]."""
        assert self.pairs.sliding_speed is not None
        return self.pairs.sliding_speed

    @property
    def key(self) -> object:
        """What the friction depends on besides load and place: mesh, speed, film and law."""
        settings, pairs = self.settings, self.pairs
        law = settings.friction_law, repr(sorted(settings.friction_options.items()))
        film = settings.film_model, repr(sorted(settings.film.items()))
        columns = pairs.equivalent_radius, pairs.entrainment_speed, self.sliding, *self.place
        sums = tuple(float(number) for each in columns for number in (each.min(), each.sum()))
        bodies = settings.bodies, settings.composite_roughness
        return (*law, *film, *bodies, pairs.lubricant, pairs.effective_modulus, self.cells, sums)

    @property
    def heated(self) -> bool:
        """Whether the films are heated, so that they depend on the sliding."""
        return FILM_MODELS[self.settings.film_model].heated

    @property
    def columns(self) -> int:
        """Rows of friction in a table, at all sliding speeds; those of heated films follow."""
        law = LAWS[self.settings.friction_law]
        return (3 if law.asperities else 1) * self.sliding_grid.size if law.needs_film else 0

    @property
    def cells(self) -> tuple[float, ...]:
        """Cells of the table for each unit of the logarithm of the load, and of each place."""
        load = _HEATED_LOAD if self.heated else _OF_LOAD
        return load, *(_ON_PATH if len(self.place) == 1 else _ON_FLANK)

    def table(self) -> FittedTable:
        """Table over the logarithm of the load and the place."""
        return FittedTable(self._sample, 1 + len(self.place))

    def values(self, table: FittedTable, load: Array) -> Array:
        """Rows of the table (rows, n) of every contact under its load."""
        least = _LEAST_HEATED if self.heated else _LEAST_SHEARED
        log_load = self.cells[0] * np.log(np.maximum(load, least * load.max()))
        return table(np.concatenate([log_load[None], self._places]))

    @property
    def _places(self) -> Array:
        """Place of each contact, in cells."""
        return np.array(self.cells[1:])[:, None] * (_END * self.place)

    def film_ratios(self, table: FittedTable, load: Array) -> Array:
        """Logarithms of heated films and pressure over the cold ones (3, n)."""
        ratios = self.values(table, load)[self.columns :]
        for contact in np.flatnonzero(np.isnan(ratios).any(axis=0)):
            some = np.array([contact])
            ratios[:, some] = self.heat(self.pairs.some(some), load[some])[1]
        return ratios

    def _sample(self, places: Array) -> tuple[Array, Array, Array]:
        """Solve the contacts nearest to places, with other loads."""
        from scipy.spatial import cKDTree

        nearest = cKDTree(self._places.T).query(places[1:].T)[1]
        load = np.exp(places[0] / self.cells[0])
        rows = self._solved(np.asarray(nearest), load)
        return np.concatenate([places[:1], self._places[:, nearest]]), rows[1:], rows[0]

    def _solved(self, chosen: Index, load: Array) -> Array:
        """Tips of the pressure, and rows of the table; NaN where a contact has no solution."""
        contacts = self.pairs.some(chosen)
        try:
            places, ratios = self.heat(contacts, load)
        except ComputationError:
            if load.size == 1:
                return np.full((1 + self.columns + (STIFFNESS if self.heated else 0), 1), np.nan)
            halves = zip(np.array_split(chosen, 2), np.array_split(load, 2), strict=True)
            return np.concatenate([self._solved(*half) for half in halves], axis=1)
        rows = [places.peak_place[None]]
        if self.columns:
            index = np.repeat(np.arange(load.size), self.sliding_grid.size)
            sliding = np.tile(self.sliding_grid, load.size)
            with quiet():
                friction = sheared_friction(places, contacts, self.settings, index, sliding)
            rows += [part.reshape(load.size, -1).T for part in parts_of(friction)]
        return np.concatenate([*rows, ratios])

    def heat(self, contacts: PairsInContact, load: Array) -> tuple[Places, Array]:
        """Films of some contacts, and logarithms of films and pressure over the cold ones."""
        settings, index = self.settings, np.zeros(load.size, dtype=np.int64)
        cold, every = dict(settings.film), np.ones(load.size, dtype=bool)
        with quiet():
            films = contacts.films(settings.film_model, load, **cold, progress=SILENT)
            places = places_of(contacts, index, load, films, every)
            if cold.pop("thermal", None) is None:
                return places, np.zeros((0, load.size))
            films = contacts.films(COLD, load, **cold, progress=SILENT)
        before = places_of(contacts, index, load, films, every)
        return places, places.values[:STIFFNESS] - before.values[:STIFFNESS]

    @property
    def speeds(self) -> Array:
        """Sliding speeds at which friction is tabled [m/s]."""
        return sampled_speeds(np.abs(self.sliding))

    @property
    def signs(self) -> Array:
        """Directions of sliding that differ: both where one body takes up more heat."""
        first, second = self.settings.bodies
        return np.array([1.0] if first == second else [1.0, -1.0])

    @property
    def sliding_grid(self) -> Array:
        """Sliding speeds of the table with their directions [m/s]."""
        return np.ravel(self.signs[:, None] * self.speeds)

    def friction(self, table: FittedTable, load: Array) -> Friction:
        """Friction of every contact under its load."""
        values, count = self.values(table, load)[: self.columns], np.arange(load.size)
        rows = values.reshape(-1, self.signs.size, self.speeds.size, load.size)
        side = ((self.sliding < 0.0) & (self.signs.size > 1)).astype(int)
        over_speed = speed_weights(self.speeds, np.abs(self.sliding))
        parts = np.einsum("npk,nk->pn", rows[:, side, :, count], over_speed).clip(0.0)
        # Solved for itself: a contact of which the table has none, and those of extreme values,
        # of which the law warns.
        unknown = np.flatnonzero(np.isnan(parts[0]))
        with quiet():
            self._replace(parts, unknown, load)
        heavy = judged(load)
        extremes = parts[:2].sum(axis=0), np.abs(self.sliding), load, -self.pairs.entrainment_speed
        chosen = [int(np.argmax(np.where(heavy, column, -np.inf))) for column in extremes]
        self._replace(parts, np.unique(chosen), load)
        return FrictionParts(*parts) if len(parts) > 1 else parts[0]

    def _replace(self, parts: Array, chosen: Index, load: Array) -> None:
        if chosen.size:
            contacts = self.pairs.some(chosen)
            index, sliding = np.arange(chosen.size), self.sliding[chosen]
            places, _ = self.heat(contacts, load[chosen])
            friction = sheared_friction(places, contacts, self.settings, index, sliding)
            parts[:, chosen] = parts_of(friction)
