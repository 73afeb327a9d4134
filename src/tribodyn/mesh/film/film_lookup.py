"""Films of the touching pairs from a table that many operating points share.

Every operating point interpolates its films in the table. The extremes that a result reports, and
the film at the pitch point, are solved for the contact itself.
"""

from __future__ import annotations

import threading
from collections import OrderedDict
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext
from contextvars import ContextVar
from dataclasses import dataclass, field, replace
from typing import Any, TypeVar

import numpy as np

from tribodyn.contact.path import pitch_point_age
from tribodyn.ehl import FILM_MODELS
from tribodyn.ehl.formulas.dimensionless_groups import line_contact_groups
from tribodyn.ehl.steady.batch import Films, warn_coarse
from tribodyn.errors import TribodynError, quiet
from tribodyn.friction import LAWS, FrictionParts, TribologicalContact
from tribodyn.lubricant import Lubricant
from tribodyn.mesh.cycle import MeshCycle, PairsInContact
from tribodyn.mesh.film.film_columns import film_places, friction_by_law
from tribodyn.mesh.film.film_refinement import (
    PRESSURE,
    QUANTITIES,
    STIFFNESS,
    SWING,
    PathLoads,
    places_of,
)
from tribodyn.mesh.film.film_table import FilmTable, FittedTable
from tribodyn.mesh.film.loaded_contacts import ContactMotion
from tribodyn.mesh.film.path_film import LoadedFilms, cold_film
from tribodyn.mesh.film.sheared_film import ShearedFilms, place_from_pitch
from tribodyn.mesh.sharing import Teeth, ToothContact
from tribodyn.progress import SILENT
from tribodyn.types import Array, Index, Mask, Tree

#: Columns of a table after the films: their distance, the sharpness of the pressure peak and the
#: node at which it lies, and the estimated error of the central film over that film.
_DISTANCE, _DROP, _TIP, _ERROR, _NUMBER = range(len(QUANTITIES), len(QUANTITIES) + 5)
#: Tolerances of the logarithms in the table, and of the compliance where it is a slope of the film.
#: The compliance of the approach differs by several percent from node to node of a solution.
_EXACT, _YIELDING = 3e-4, 2e-3
#: Tables in the cache at most.
_MOST_TABLES = 12
#: Radius of the contacts of a table [m]: any other one has the same films over their scales.
_RADIUS = 1e-2
#: Contacts solved at most to find the greatest pressure, and the ratio of the expected pressure to
#: the greatest one from which a contact is solved.
_TRIALS, _WORTH = 7, 0.98
#: Pressure over the greatest one above which a contact may have the greatest one itself.
_NEAR = 0.85
#: Of contacts closer together than this [mesh cycles], [nodes] only the first is solved.
_NEIGHBOUR_AGE, _NEIGHBOUR_TIP = 0.05, 0.1
#: Ages closer together than this are the same position [mesh cycles].
_SAME = 1e-6


Table = TypeVar("Table", FilmTable, FittedTable)


class OutsideTableError(Exception):
    """Raised for a contact that lies where a table has no films."""


@dataclass(eq=False)
class _Shared:
    """Tables of one study."""

    tables: OrderedDict[Any, Any] = field(default_factory=OrderedDict)
    lock: threading.Lock = field(default_factory=threading.Lock)


_shared: ContextVar[_Shared | None] = ContextVar("shared_films", default=None)
#: Tables of a process that computes the chunks of a study one after the other.
_persistent = _Shared()


@contextmanager
def shared_films(*, persistent: bool = False) -> Iterator[None]:
    """Share one table of solved films among all meshes that are computed inside the block.

    With ``persistent`` the table outlives the block and serves later blocks of the process: a film
    depends on its contact alone, not on the study for which the table was built.
    """
    token = _shared.set(_persistent if persistent else _Shared())
    try:
        yield
    finally:
        _shared.reset(token)


def look_up_slices(
    settings: ToothContact, cycle: MeshCycle, teeth: Teeth, pairs: PairsInContact
) -> FilmLookup | None:
    """Film of slices of lines of contact from a table; None of whole pairs and of formulas."""
    if cycle.slices is None:
        return None
    with shared_films(persistent=True):
        return look_up_film(settings, cycle, teeth, pairs)


def look_up_film(
    settings: ToothContact, cycle: MeshCycle, teeth: Teeth, pairs: PairsInContact
) -> FilmLookup | None:
    """Film of a tooth contact from the shared table, or None where it has to be solved."""
    of_slices = cycle.slices is not None
    table = table_for(settings, pairs, sheared=of_slices)
    if table is None:
        return None
    # The pitch point has two sides: take the one after it.
    pitch = np.flatnonzero(np.abs(pairs.age - pitch_point_age(cycle.contact)) < _SAME)[-1:]
    place = place_from_pitch(pairs.age - pitch_point_age(cycle.contact))[None]
    in_contact, least = cycle.in_contact, teeth.least_load
    return FilmLookup(settings, table, pairs, in_contact, least, pitch, place, of_slices)


def table_for(
    settings: ToothContact, pairs: PairsInContact, *, sheared: bool = False
) -> FilmTable | None:
    """Shared table of solved films; None where the settings need what no table has."""
    shared, model = _shared.get(), FILM_MODELS[settings.film_model]
    if shared is None or not model.method:
        return None
    # A law that shears the film needs its pressure at all nodes: whole pairs solve their path.
    # Contacts that are sheared have a table of the friction and heat of their films as well.
    at_nodes = LAWS[settings.friction_law].needs_film or settings.film["stiffness"] == "seed"
    # The table of a heated film is that of the cold one: it does not know the sliding.
    if (at_nodes or model.heated) and not sheared:
        return None
    model_name, options = cold_film(settings)
    del options["positions"]
    oil, modulus = pairs.lubricant, pairs.effective_modulus
    key = (model_name, oil, modulus, repr(sorted(options.items())))

    def table() -> FilmTable:
        """Table of solved contacts of any load and speed."""
        slope = _YIELDING if options["stiffness"] == "tangent" else np.inf
        tolerance = np.array([_EXACT, _EXACT, np.inf, slope, _EXACT, np.inf, np.inf, np.inf])
        solver = _Contacts(model_name, options, oil, modulus)
        return FilmTable(solver, tolerance, tolerance < _YIELDING)

    return _cached_table(shared, key, table)


def _cached_table(shared: _Shared, key: object, make: Callable[[], Table]) -> Table:
    """Table of a key, the same object in the blocks that share it."""
    with shared.lock:
        if key not in shared.tables:
            shared.tables[key] = make()
            if len(shared.tables) > _MOST_TABLES:
                shared.tables.popitem(last=False)
        table: Table = shared.tables[key]
        return table


@dataclass(frozen=True, eq=False)
class _Contacts:
    """Solver of contacts in terms of ``ln M`` and ``ln L``."""

    model: str
    options: Tree
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
        return _quantities(pairs, load, self.model, self.options)


def _quantities(pairs: PairsInContact, load: Array, model: str, options: Tree) -> Array:
    """Quantities of a table (q, n) of solved contacts."""
    with quiet():
        films = pairs.films(model, load, **options)
    if options["stiffness"] == "seed":  # a length: times the pressure it is a stiffness
        pressure = pairs.scales(load)["film_pressure"]
        films = replace(films, film_stiffness=np.asarray(films.film_stiffness) * pressure)
    index, every = np.zeros(load.size, dtype=np.int64), np.ones(load.size, dtype=bool)
    places = places_of(pairs, index, load, films, every)
    errors = [each.central_film_error / each.central_film for each in films.solutions]
    more = np.array([places.distance, places.peak_drop, places.peak_place, errors])
    return np.concatenate([places.values, more])


#: Place between two nodes of the tip whose peak is the highest.
_HIGHEST = 0.68


@dataclass(frozen=True, eq=False)
class FilmLookup:
    """Films of the contacts of a mesh table as a function of their loads."""

    settings: ToothContact
    table: FilmTable
    pairs: PairsInContact
    in_contact: Mask
    least_load: float  #: lower bound of the load for which a film is computed [N/m]
    pitch: Index  #: contact at the pitch point, if there is one
    place: Array  #: of each contact from the pitch point, and along the flank (d, contacts)
    of_slices: bool = False  #: whether contacts beyond the table are solved for themselves

    def solve(self, load_per_width: Array, checked: tuple[int, ...] = ()) -> FilmsFromTable:
        """Films under the loads of a mesh table."""
        loads, pairs, least = load_per_width[self.in_contact], self.pairs, self.least_load
        oil = pairs.lubricant.dynamic_viscosity, pairs.lubricant.pressure_viscosity_coefficient
        contacts = loads, pairs.equivalent_radius, pairs.entrainment_speed
        groups = line_contact_groups(*contacts, *oil, pairs.effective_modulus)
        number = np.log(groups.moes_load)
        values = self.table(number, np.log(groups.moes_material))
        outside = np.flatnonzero(np.isnan(values).any(axis=0))
        if outside.size and not self.of_slices:
            raise OutsideTableError
        if outside.size:
            values[:, outside] = self._solved(outside, loads)
        doubtful = np.zeros((len(QUANTITIES), loads.size), dtype=bool)
        # The pressure of whole pairs is certain only where it is solved; that of slices, which a
        # map over the face needs everywhere, is within 2 or 3 %. The stiffness of the approach
        # differs by several percent from node to node: a study reports only its value at the
        # pitch point, which is solved.
        doubtful[PRESSURE] = not self.of_slices
        yielding = values[STIFFNESS]
        if PRESSURE in checked and FILM_MODELS[self.settings.film_model].heated:
            sheared = ShearedFilms(self.settings, pairs, self.place)
            values[:STIFFNESS] += sheared.film_ratios(self._sheared_table(sheared), loads)
        if self.settings.film["stiffness"] == "seed":
            yielding = yielding * pairs.scales(loads)["film_pressure"]
        return FilmsFromTable(
            pairs=pairs,
            keeps_distance=self.settings.film["stiffness"] == "approach",
            factors=np.exp(values[:STIFFNESS]),
            yielding=yielding,
            doubtful=doubtful,
            loads=PathLoads(np.zeros(0), loads, loads > least),
            path=self,
            values=np.vstack([values, number]),
        )

    def friction(self, load: Array, settings: ToothContact) -> Array | FrictionParts:
        """Friction of the sheared film of every contact under its load, by the law of settings."""
        sheared = ShearedFilms(settings, self.pairs, self.place)
        return sheared.friction(self._sheared_table(sheared), load)

    def _sheared_table(self, films: ShearedFilms) -> FittedTable:
        """Table of sheared or heated films, shared like that of films."""
        return _cached_table(_shared.get() or _persistent, films.key, films.table)

    def _solved(self, contacts: Index, loads: Array) -> Array:
        """Quantities of contacts that lie where the table has no films."""
        settings, some = self.settings, self.pairs.some(contacts)
        with film_places(lambda index: f"{some.age[index]:.3f} base pitches after its entry"):
            return _quantities(some, loads[contacts], *cold_film(settings))


@dataclass(frozen=True, eq=False)
class FilmsFromTable(LoadedFilms):
    """Films from a table under some loads."""

    path: FilmLookup
    values: Array  #: quantities of the table

    @property
    def distance_factors(self) -> Array:
        """Distance under the solved loads, over the scale of films."""
        return np.asarray(np.exp(self.values[_DISTANCE]))

    def warn_of_doubt(self) -> None:
        """Warn where the film has too few nodes."""
        warn_coarse(self.values[_ERROR], self.path.settings.film["nodes"])

    def friction(
        self, contact: TribologicalContact, motion: ContactMotion, settings: ToothContact
    ) -> Array | FrictionParts:
        """Evaluate the friction law; one that shears the film has a table of its own."""
        if not LAWS[settings.friction_law].needs_film:
            return friction_by_law(settings.friction_law, contact, settings.friction_options)
        return self.path.friction(contact.load_per_width, settings)

    def reported(self, films: Films, load: Array) -> tuple[Films, Mask]:
        """Solve the contacts that results report; also return a mask of the certain quantities."""
        columns: Tree = {name: np.array(getattr(films, name)) for name in QUANTITIES}
        certain = ~self.doubtful
        least = [int(np.argmin(np.where(self.scored, columns[n], np.inf))) for n in QUANTITIES[:2]]
        # One call for all of them, because starting threads takes time.
        of_slices, pressure = self.path.of_slices, columns["film_pressure"]
        trials = [] if of_slices else self._trials(pressure)
        chosen = np.unique([*least, *self.path.pitch, *trials])
        settings = self.path.settings
        # The printed sum "seed" warns of what it is, wherever it is reported.
        with nullcontext() if settings.film["stiffness"] == "seed" else quiet():
            solved = self.pairs.some(chosen).films(
                settings.film_model, load[chosen], **settings.film, progress=SILENT
            )
        for name, column in columns.items():
            # Single solutions would stand out of the pressures of a map over the face.
            if not (of_slices and name == "film_pressure"):
                column[chosen] = getattr(solved, name)
        certain[:, chosen] = True
        return replace(films, **columns), certain

    def _trials(self, pressure: Array) -> list[int]:
        """Candidates for the greatest pressure, which oscillates with the position on the nodes."""
        candidates = self.scored & (
            pressure > _NEAR * np.max(pressure, where=self.scored, initial=0.0)
        )
        number, tip = self.values[[_NUMBER, _TIP]]
        # The oscillations of the table average out over several nodes.
        even = np.polynomial.Polynomial.fit(
            number[candidates], self.values[PRESSURE, candidates], 1
        )
        sharp = float(np.mean(self.values[_DROP, candidates]))
        high = 0.5 * SWING * sharp * np.cos(2.0 * np.pi * (tip - _HIGHEST))
        scale = pressure / np.exp(self.values[PRESSURE])
        expected = np.where(candidates, scale * np.exp(even(number) + high), 0.0)
        worth, trials = _WORTH * expected.max(), list[int]()
        while len(trials) < _TRIALS and expected.max() > worth:
            best = int(np.argmax(expected))
            trials.append(best)
            neighbours = np.abs(self.pairs.age - self.pairs.age[best]) < _NEIGHBOUR_AGE
            expected[neighbours & (np.abs(tip - tip[best]) < _NEIGHBOUR_TIP)] = 0.0
        return trials
