"""Films of the touching pairs from a table that many operating points share.

Every point takes its films from the table. What is reported as greatest or least, and what stands
at the pitch point, is solved for the very contact.
"""

from __future__ import annotations

import threading
from collections import OrderedDict
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from tribodyn.contact.path import pitch_point_age
from tribodyn.ehl import FILM_MODELS
from tribodyn.ehl.formulas.dimensionless_groups import line_contact_groups
from tribodyn.ehl.steady.batch import Films, warn_coarse
from tribodyn.errors import TribodynError, quiet
from tribodyn.friction import LAWS, FrictionParts, TribologicalContact
from tribodyn.lubricant import Lubricant
from tribodyn.mesh.cycle import MeshCycle, PairsInContact
from tribodyn.mesh.film.film_columns import friction_by_law
from tribodyn.mesh.film.film_refinement import (
    PRESSURE,
    QUANTITIES,
    STIFFNESS,
    SWING,
    PathLoads,
    places_of,
)
from tribodyn.mesh.film.film_table import FilmTable
from tribodyn.mesh.film.path_film import LoadedFilms
from tribodyn.mesh.sharing import Teeth, ToothContact
from tribodyn.progress import SILENT
from tribodyn.types import Array, Index, Mask

#: What a table holds beside the films: their distance, how sharp the peak of the pressure is and at
#: which node it lies, and the estimated error of the central film over it.
_DISTANCE, _DROP, _TIP, _ERROR, _NUMBER = range(len(QUANTITIES), len(QUANTITIES) + 5)
#: Errors of the logarithms up to which the table is kept; of the compliance, where it is a slope of
#: the film. That of the approach differs by several percent from node to node of a solution.
_EXACT, _YIELDING = 3e-4, 2e-3
#: Tables that are kept at most.
_MOST_TABLES = 12
#: Radius of the contacts of a table [m]: any other one has the same films over their scales.
_RADIUS = 1e-2
#: Contacts that are solved at most to find the greatest pressure, and expected pressure over the
#: greatest one from which on a contact is worth it.
_TRIALS, _WORTH = 7, 0.98
#: Pressure over the greatest one above which a contact may have the greatest one itself.
_NEAR = 0.85
#: Contacts nearer than this [mesh cycles], [nodes] are not both tried.
_BESIDE, _ASIDE = 0.05, 0.1
#: Ages nearer than this are one place [mesh cycles].
_SAME = 1e-6


class UntabledError(Exception):
    """A contact lies where a table has no films."""


@dataclass(eq=False)
class _Shared:
    """Tables of one study."""

    tables: OrderedDict[Any, FilmTable] = field(default_factory=OrderedDict)
    lock: threading.Lock = field(default_factory=threading.Lock)


_shared: ContextVar[_Shared | None] = ContextVar("shared_films", default=None)
#: Tables of a process that computes one chunk of a study after the other.
_lasting = _Shared()


@contextmanager
def shared_films(*, lasting: bool = False) -> Iterator[None]:
    """Let all meshes that are computed inside the block take their solved films from one table.

    A ``lasting`` one is that of all such blocks: a film depends on its contact alone, so that it
    does not matter who made the table, and what for.
    """
    token = _shared.set(_lasting if lasting else _Shared())
    try:
        yield
    finally:
        _shared.reset(token)


def tabled_film(
    settings: ToothContact, cycle: MeshCycle, teeth: Teeth, pairs: PairsInContact
) -> TabledFilm | None:
    """Film of a tooth contact by the table that it shares; none where it is to be solved alone."""
    table = _table_for(settings, pairs)
    if table is None:
        return None
    # Of both sides of the pitch point the one after it counts.
    pitch = np.flatnonzero(np.abs(pairs.age - pitch_point_age(cycle.contact)) < _SAME)[-1:]
    return TabledFilm(settings, table, pairs, cycle.in_contact, teeth.least_load, pitch)


def _table_for(settings: ToothContact, pairs: PairsInContact) -> FilmTable | None:
    shared = _shared.get()
    if shared is None or not FILM_MODELS[settings.film_model].method:
        return None
    # A law that shears the film asks for its pressure at all nodes, and the printed sum for nodes.
    if LAWS[settings.friction_law].needs_film or settings.film["stiffness"] == "seed":
        return None
    options = {name: value for name, value in settings.film.items() if name != "positions"}
    oil, modulus = pairs.lubricant, pairs.effective_modulus
    key = (settings.film_model, oil, modulus, repr(sorted(options.items())))
    with shared.lock:
        if key not in shared.tables:
            slope = _YIELDING if options["stiffness"] == "tangent" else np.inf
            tolerance = np.array([_EXACT, _EXACT, np.inf, slope, _EXACT, np.inf, np.inf, np.inf])
            solver = _Contacts(settings.film_model, options, oil, modulus)
            shared.tables[key] = FilmTable(solver, tolerance, tolerance < _YIELDING)
            if len(shared.tables) > _MOST_TABLES:
                shared.tables.popitem(last=False)
        return shared.tables[key]


@dataclass(frozen=True, eq=False)
class _Contacts:
    """Solves contacts that are given by ``ln M`` and ``ln L``."""

    model: str
    options: dict[str, Any]
    lubricant: Lubricant
    modulus: float

    def __call__(self, log_m: Array, log_l: Array) -> Array:
        """Quantities of a table (q, n); NaN where a contact has no solution."""
        try:
            return self._solved(np.exp(log_m), np.exp(log_l))
        except TribodynError:
            if log_m.size == 1:
                return np.full((_ERROR + 1, 1), np.nan)
        parts = zip(np.array_split(log_m, 2), np.array_split(log_l, 2), strict=True)
        return np.concatenate([self(*part) for part in parts], axis=1)

    def _solved(self, load_number: Array, material_number: Array) -> Array:
        oil, radius = self.lubricant, np.full(load_number.shape, _RADIUS)
        material = oil.pressure_viscosity_coefficient * self.modulus
        twice = (material_number / material) ** 4
        speed = 0.5 * twice * self.modulus * radius / oil.dynamic_viscosity
        load = load_number * np.sqrt(twice) * self.modulus * radius
        pairs = PairsInContact(np.zeros(load.size), radius, speed, oil, self.modulus, 1.0)
        with quiet():
            films = pairs.films(self.model, load, **self.options)
        index, every = np.zeros(load.size, dtype=np.int64), np.ones(load.size, dtype=bool)
        places = places_of(pairs, index, load, films, every)
        errors = [each.central_film_error / each.central_film for each in films.solutions]
        more = np.array([places.distance, places.peak_drop, places.peak_place, errors])
        return np.concatenate([places.values, more])


#: Place between two nodes of the tip whose peak is the highest.
_HIGHEST = 0.68


@dataclass(frozen=True, eq=False)
class TabledFilm:
    """Films of the contacts of a mesh table as a function of their loads."""

    settings: ToothContact
    table: FilmTable
    pairs: PairsInContact
    in_contact: Mask
    least_load: float  #: load for which the film of a pair is found at least [N/m]
    pitch: Index  #: contact at the pitch point, if there is one

    def solve(self, load_per_width: Array, checked: tuple[int, ...] = ()) -> TabledPath:
        """Films under the loads of a mesh table."""
        loads, pairs, least = load_per_width[self.in_contact], self.pairs, self.least_load
        oil = pairs.lubricant.dynamic_viscosity, pairs.lubricant.pressure_viscosity_coefficient
        contacts = loads, pairs.equivalent_radius, pairs.entrainment_speed
        groups = line_contact_groups(*contacts, *oil, pairs.effective_modulus)
        number = np.log(groups.moes_load)
        values = self.table(number, np.log(groups.moes_material))
        if np.any(np.isnan(values)):
            raise UntabledError
        doubtful = np.zeros((len(QUANTITIES), loads.size), dtype=bool)
        # It is told where it is solved. The stiffness of the approach differs by several percent
        # from node to node: of it a study reports that of the pitch point alone, which is solved.
        doubtful[PRESSURE] = True
        return TabledPath(
            pairs=pairs,
            keeps_distance=self.settings.film["stiffness"] == "approach",
            factors=np.exp(values[:STIFFNESS]),
            yielding=values[STIFFNESS],
            doubtful=doubtful,
            loads=PathLoads(np.zeros(0), loads, loads > least),
            path=self,
            values=np.vstack([values, number]),
        )


@dataclass(frozen=True, eq=False)
class TabledPath(LoadedFilms):
    """Films from a table under some loads."""

    path: TabledFilm
    values: Array  #: quantities of the table

    @property
    def distance_factors(self) -> Array:
        """Distance under the solved loads, over the scale of films."""
        return np.asarray(np.exp(self.values[_DISTANCE]))

    def warn_of_doubt(self) -> None:
        """Say where the nodes are too few."""
        warn_coarse(self.values[_ERROR], self.path.settings.film["nodes"])

    def friction(
        self, contact: TribologicalContact, motion: Any, settings: ToothContact
    ) -> Array | FrictionParts:
        """Ask the friction law."""
        return friction_by_law(settings.friction_law, contact, settings.friction_options)

    def reported(self, films: Films, load: Array) -> tuple[Films, Mask]:
        """Solve the contacts that figures are taken from; which of all quantities are known."""
        columns: dict[str, Any] = {name: np.array(getattr(films, name)) for name in QUANTITIES}
        known = ~self.doubtful
        least = [int(np.argmin(np.where(self.scored, columns[n], np.inf))) for n in QUANTITIES[:2]]
        # One call for all of them: threads take their time to begin.
        chosen = np.unique([*least, *self.path.pitch, *self._trials(columns["film_pressure"])])
        settings = self.path.settings
        with quiet():
            solved = self.pairs.some(chosen).films(
                settings.film_model, load[chosen], **settings.film, progress=SILENT
            )
        for name, column in columns.items():
            column[chosen] = getattr(solved, name)
        known[:, chosen] = True
        return replace(films, **columns), known

    def _trials(self, pressure: Array) -> list[int]:
        """Contacts one of which has the greatest pressure, which rises and falls over the nodes."""
        near = self.scored & (pressure > _NEAR * np.max(pressure, where=self.scored, initial=0.0))
        number, tip = self.values[[_NUMBER, _TIP]]
        # Over some nodes the ups and downs of the table are as many.
        even = np.polynomial.Polynomial.fit(number[near], self.values[PRESSURE, near], 1)
        sharp = float(np.mean(self.values[_DROP, near]))
        high = 0.5 * SWING * sharp * np.cos(2.0 * np.pi * (tip - _HIGHEST))
        scale = pressure / np.exp(self.values[PRESSURE])
        expected = np.where(near, scale * np.exp(even(number) + high), 0.0)
        worth, trials = _WORTH * expected.max(), list[int]()
        while len(trials) < _TRIALS and expected.max() > worth:
            best = int(np.argmax(expected))
            trials.append(best)
            beside = np.abs(self.pairs.age - self.pairs.age[best]) < _BESIDE
            expected[beside & (np.abs(tip - tip[best]) < _ASIDE)] = 0.0
        return trials
