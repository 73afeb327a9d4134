"""Friction of films that slices of lines of contact shear, from a table over place and load.

The pressure of a film depends on the place on the path of contact and on the load alone, as does
its friction at a sliding speed. Both are tabled, and every slice interpolates its friction at its
own sliding speed.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.polynomial import Polynomial

from tribodyn.ehl import FILM_MODELS
from tribodyn.errors import ComputationError, quiet
from tribodyn.friction import LAWS, FrictionParts
from tribodyn.mesh.cycle import PairsInContact
from tribodyn.mesh.film.film_columns import judged
from tribodyn.mesh.film.film_refinement import STIFFNESS, Places, places_of
from tribodyn.mesh.film.film_table import FilmTable
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

#: Cells of the table along the path of contact.
_CELLS = 4.0
#: Error of the coefficient and of the load share of the film from which a cell is halved.
_TOLERANCE = 1e-4
#: Side of the smallest cells in steps of the table.
_SMALLEST = 64
#: The same of a heated film, whose friction settles to 0.2 %: error of the coefficient and of the
#: logarithm of the films over the cold ones; cells along the path and over the logarithm of the
#: load; and the load over the greatest from which on a film is heated.
_HEATED, _HEATED_CELLS, _OF_LOAD, _LEAST_HEATED = (5e-4, 4e-3), 2.0, 0.5, 0.05
#: The last contact is in the last of these cells.
_END = 1.0 - 1e-9


@dataclass(frozen=True, eq=False)
class ShearedFilms:
    """Friction of one mesh at one speed as a function of place and load."""

    settings: ToothContact
    pairs: PairsInContact  #: contacts of the mesh table
    sliding: Array  #: sliding speed of each of them [m/s]

    @property
    def key(self) -> object:
        """What the friction depends on beside load and place: mesh, speed, film and law."""
        settings, pairs = self.settings, self.pairs
        law = settings.friction_law, repr(sorted(settings.friction_options.items()))
        film = settings.film_model, repr(sorted(settings.film.items()))
        columns = pairs.equivalent_radius, pairs.entrainment_speed, self.sliding, pairs.age
        ends = tuple(float(end(column)) for column in columns for end in (np.min, np.max))
        bodies = settings.bodies, settings.composite_roughness
        return (*law, *film, *bodies, pairs.lubricant, pairs.effective_modulus, ends)

    @property
    def heated(self) -> bool:
        """Whether the films are heated, so that they depend on the sliding."""
        return FILM_MODELS[self.settings.film_model].heated

    @property
    def columns(self) -> int:
        """Rows of friction in a table, at all sliding speeds; those of heated films follow."""
        law = LAWS[self.settings.friction_law]
        return (3 if law.asperities else 1) * self.sliding_grid.size if law.needs_film else 0

    def table(self) -> FilmTable:
        """Table over the logarithm of the load and the place on the path of contact."""
        tolerance = np.array(_TOLERANCE)
        if self.heated:
            tolerance = np.repeat(_HEATED, [self.columns, STIFFNESS])
        return FilmTable(_Sheared(self), tolerance, np.array(False), _SMALLEST)

    def place(self, age: Array) -> Array:
        """Place on the path of contact, in cells."""
        cells = _HEATED_CELLS if self.heated else _CELLS
        return np.asarray(age / self.pairs.age.max() * (cells * _END))

    def values(self, table: FilmTable, load: Array) -> Array:
        """Rows of the table (rows, n) of every contact under its load."""
        scale = _OF_LOAD if self.heated else 1.0
        least = _LEAST_HEATED * load.max() if self.heated else 0.0
        return table(scale * np.log(np.maximum(load, least)), self.place(self.pairs.age))

    def film_ratios(self, table: FilmTable, load: Array) -> Array:
        """Logarithms of heated films and pressure over the cold ones (3, n)."""
        ratios = self.values(table, load)[self.columns :]
        for contact in np.flatnonzero(np.isnan(ratios).any(axis=0)):
            some = np.array([contact])
            ratios[:, some] = self.heat(self.pairs.some(some), load[some])[1]
        return ratios

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

    def friction(self, table: FilmTable, load: Array) -> Friction:
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


class _Sheared:
    """Solver of a table: friction at all sliding speeds over the load and the place."""

    def __init__(self, films: ShearedFilms) -> None:
        self.films = films
        pairs, place = films.pairs, films.place(films.pairs.age)
        # Along the path of involutes the radius is quadratic, and the speeds are linear.
        self._radius = Polynomial.fit(place, pairs.equivalent_radius, 2)
        self._speed = Polynomial.fit(place, pairs.entrainment_speed, 1)
        self._sliding = Polynomial.fit(place, films.sliding, 1)

    def __call__(self, log_load: Array, place: Array) -> Array:
        """Rows of the table (rows, n); NaN where a contact has no solution."""
        films = self.films
        try:
            return self._solved(np.exp(log_load / (_OF_LOAD if films.heated else 1.0)), place)
        except ComputationError:
            if log_load.size == 1:
                return np.full((films.columns + (STIFFNESS if films.heated else 0), 1), np.nan)
        halves = zip(np.array_split(log_load, 2), np.array_split(place, 2), strict=True)
        return np.concatenate([self(*half) for half in halves], axis=1)

    def _solved(self, load: Array, place: Array) -> Array:
        films, zero = self.films, np.zeros(load.size)
        contacts = PairsInContact(
            zero,
            self._radius(place),
            self._speed(place),
            films.pairs.lubricant,
            films.pairs.effective_modulus,
            1.0,
            self._sliding(place),
        )
        places, ratios = films.heat(contacts, load)
        if not films.columns:
            return ratios
        sliding = films.sliding_grid
        index = np.repeat(np.arange(load.size), sliding.size)
        with quiet():
            friction = sheared_friction(
                places, contacts, films.settings, index, np.tile(sliding, load.size)
            )
        parts = [part.reshape(load.size, -1).T for part in parts_of(friction)]
        return np.concatenate([*parts, ratios])
