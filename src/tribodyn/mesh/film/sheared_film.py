"""Friction of films that slices of lines of contact shear, from a table over place and load.

The pressure of a film depends on the place on the path of contact and on the load alone, as does
its friction at a sliding speed. Both are tabled, and every slice interpolates its friction at its
own sliding speed.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.polynomial import Polynomial

from tribodyn.errors import ComputationError, quiet
from tribodyn.friction import LAWS, FrictionParts
from tribodyn.mesh.cycle import PairsInContact
from tribodyn.mesh.film.film_columns import judged
from tribodyn.mesh.film.film_refinement import places_of
from tribodyn.mesh.film.film_table import FilmTable
from tribodyn.mesh.film.path_film import (
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

    def table(self) -> FilmTable:
        """Table over the logarithm of the load and the place on the path of contact."""
        return FilmTable(_Sheared(self), np.array(_TOLERANCE), np.array(False), _SMALLEST)

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
        place = self.pairs.age / self.pairs.age.max() * (_CELLS * _END)
        values, count = table(np.log(load), place), np.arange(load.size)
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
            friction = self.solve(
                contacts, load[chosen], np.arange(chosen.size), self.sliding[chosen]
            )
            parts[:, chosen] = parts_of(friction)

    def solve(
        self, contacts: PairsInContact, load: Array, index: Index, sliding: Array
    ) -> Friction:
        """Friction of solved contacts, each at some sliding speeds."""
        settings, every = self.settings, np.ones(load.size, dtype=bool)
        with quiet():
            films = contacts.films(settings.film_model, load, **settings.film, progress=SILENT)
        places = places_of(contacts, np.zeros(load.size, dtype=np.int64), load, films, every)
        return sheared_friction(places, contacts, settings, index, sliding)


class _Sheared:
    """Solver of a table: friction at all sliding speeds over the load and the place."""

    def __init__(self, films: ShearedFilms) -> None:
        self.films = films
        pairs, place = films.pairs, films.pairs.age / films.pairs.age.max() * _CELLS
        # Along the path of involutes the radius is quadratic, and the speeds are linear.
        self._radius = Polynomial.fit(place, pairs.equivalent_radius, 2)
        self._speed = Polynomial.fit(place, pairs.entrainment_speed, 1)

    def __call__(self, log_load: Array, place: Array) -> Array:
        """Friction (parts * signs * speeds, n); NaN where a contact has no solution."""
        try:
            return self._solved(np.exp(log_load), place)
        except ComputationError:
            if log_load.size == 1:
                parts = 3 if LAWS[self.films.settings.friction_law].asperities else 1
                return np.full((parts * self.films.sliding_grid.size, 1), np.nan)
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
        )
        sliding = films.sliding_grid
        index = np.repeat(np.arange(load.size), sliding.size)
        with quiet():
            friction = films.solve(contacts, load, index, np.tile(sliding, load.size))
        return np.concatenate([part.reshape(load.size, -1).T for part in parts_of(friction)])
