"""Oil film of the touching pairs: by a formula everywhere, or solved at positions on the path.

A numerical film is solved at some positions of the path of contact under the load that they carry.
Between them, and for slightly different loads, the ratio of the solution to a formula that covers
all regimes is interpolated: it hardly changes along the path, while the formula follows every
change of load, radius and speed.
"""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from itertools import product
from typing import Protocol

import numpy as np

from tribodyn.contact import hertz_line
from tribodyn.ehl import FILM_MODELS
from tribodyn.ehl.steady.batch import Films
from tribodyn.ehl.traction.traction import FilmState
from tribodyn.errors import quiet, warn
from tribodyn.friction import LAWS, FrictionParts, TribologicalContact
from tribodyn.mesh.cycle import (
    MOST,
    MeshCycle,
    PairsInContact,
    PathPositions,
    lobatto_points,
    lobatto_polynomial,
    path_positions,
)
from tribodyn.mesh.film.film_columns import (
    film_places,
    friction_by_law,
    judged,
    warn_of_loaded,
)
from tribodyn.mesh.film.film_refinement import (
    PRESSURE,
    PROMISED,
    QUANTITIES,
    RIGID,
    STIFFNESS,
    PathLoads,
    Places,
    Refinement,
    SolvedContacts,
    contact_numbers,
    curves_over_age,
    joined_over_age,
    places_of,
)
from tribodyn.mesh.film.loaded_contacts import ContactMotion
from tribodyn.mesh.grid import PhaseFunction, PhaseGrid
from tribodyn.mesh.sharing import Teeth, ToothContact
from tribodyn.progress import Progress
from tribodyn.types import Array, Index, Mask, Tree

#: Coefficients, with their parts where the law has them.
Friction = Array | FrictionParts

#: Distance from an event that separates its two sides [mesh cycles].
_BESIDE = 1e-9
#: Sliding speed up to which friction is about linear in it, for any oil under pressure [m/s].
_SLOW = 1e-4
#: Samples for each unit of asinh(v/_SLOW), and the least number of them.
_DENSITY, _LEAST = 4.0, 8
#: Greatest sliding over entrainment speed, below the 2 at which one surface is at rest.
_MOST_SLIDING = 1.99


#: The film model under whose loads a heated film is solved.
COLD = "newton"


def cold_film(settings: ToothContact) -> tuple[str, Tree]:
    """Model and options of the film without its heat, which shares the loads."""
    options = dict(settings.film)
    heated = options.pop("thermal", None) is not None
    return COLD if heated else settings.film_model, options


class FilmAt(Protocol):
    """Films of all pairs in contact as a function of their loads per width."""

    def __call__(self, load_per_width: Array) -> Films:
        """Films under these loads."""

    @property
    def keeps_distance(self) -> bool:
        """Whether each film is a spring about the distance that it keeps between the flanks."""

    @property
    def rigid_share(self) -> float:
        """Part of the contacts whose film does not fall with the load."""

    def warn_of_doubt(self) -> None:
        """Warn where quantities are inaccurate."""

    def reported(self, films: Films, load: Array) -> tuple[Films, Mask]:
        """Films as they are reported under these loads, and a mask of their certain quantities."""

    def friction(
        self, contact: TribologicalContact, motion: ContactMotion, settings: ToothContact
    ) -> Friction:
        """Friction of every pair in contact by the law of the settings, with its parts if any."""


@dataclass(frozen=True, eq=False)
class FormulaFilm:
    """Film by a formula, which needs no numerical solution."""

    settings: ToothContact
    pairs: PairsInContact
    #: Lower bound of the load for which a film is computed; one for each row of contacts.
    least_load: Array | float

    keeps_distance = False
    rigid_share = 0.0

    def solve(self, loads: Array, checked: tuple[int, ...] = ()) -> FilmAt:
        """Return the film itself: a formula needs no solution."""
        return self

    def __call__(self, load_per_width: Array) -> Films:
        """Films of all contacts of the mesh table."""
        load, model = np.maximum(load_per_width, self.least_load), self.settings.film_model
        if load.ndim > 1:  # several operating points: the caller repeats each for its warnings
            return self.pairs.films(model, load, **self.settings.film)
        judge = np.flatnonzero(judged(load))
        return warn_of_loaded(
            lambda: self.pairs.films(model, load, **self.settings.film),
            lambda: self.pairs.some(judge).films(model, load[judge], **self.settings.film),
        )

    def warn_of_doubt(self) -> None:
        """Do nothing: a formula has no discretisation error."""

    def reported(self, films: Films, load: Array) -> tuple[Films, Mask]:
        """Report every film."""
        return films, np.ones((len(QUANTITIES), *(1,) * load.ndim), dtype=bool)

    def friction(
        self, contact: TribologicalContact, motion: ContactMotion, settings: ToothContact
    ) -> Friction:
        """Evaluate the friction law."""
        return friction_by_law(settings.friction_law, contact, settings.friction_options)


@dataclass(frozen=True, eq=False)
class PathFilm:
    """A solved film along the path of contact, as a function of the load of every contact."""

    settings: ToothContact
    grid: PhaseGrid
    in_contact: Mask
    least_load: float  #: lower bound of the load for which a film is computed [N/m]
    progress: Progress
    places: PathPositions  #: positions at which the film is solved
    first_angle: float  #: roll angle of the driving gear where a pair enters [rad]
    angle_per_cycle: float  #: and its change over a mesh cycle [rad]
    solved: PairsInContact  #: the pair at these positions
    pairs: PairsInContact  #: contacts of the mesh table
    zone: Index  #: zone of each contact of the mesh table
    memory: SolvedContacts = field(default_factory=SolvedContacts)

    def _loads(self, load_per_width: Array) -> PathLoads:
        """Interpolate the loads at the positions from those of a mesh table."""
        age, least = self.places.sided_age, self.least_load
        over_age = PhaseFunction(self.grid, load_per_width)(age)
        at_places = over_age[np.arange(age.size), np.floor(age).astype(int)]
        of_contacts = load_per_width[self.in_contact]
        return PathLoads(np.maximum(at_places, least), of_contacts, of_contacts > least)

    def solve(self, load_per_width: Array, checked: tuple[int, ...] = ()) -> FilmAt:
        """Solve the film at the positions, and between them where checked quantities need it."""
        loads = self._loads(load_per_width)
        count, cache = self.places.age.size, self.memory
        # A pair that carries the whole load alone carries it in every pass.
        cache.retain(
            contact_numbers(self.solved, loads.at_positions)
            + contact_numbers(self.pairs, loads.of_contacts)
        )
        # A pass that does not check the pressure leaves out places that only the pressure needs.
        again = cache.contacts if PRESSURE in checked else cache.contacts[cache.yielding]
        first = self._solve(
            self.solved.joined(self.pairs.some(again)),
            np.concatenate([self.places.zone, self.zone[again]]),
            np.concatenate([loads.at_positions, loads.of_contacts[again]]),
        )
        yielding = cache.yielding if PRESSURE in checked else np.ones(again.size, dtype=bool)
        first.yielding[count:] = yielding
        more = partial(self._solve_more, loads)
        refinement = Refinement(self.places, self.pairs, self.zone, loads, cache, first, more)
        if checked:
            refinement.refine(checked)
        if PRESSURE in checked:
            refinement.solve_extremes()
        values, heated = refinement.values(np.arange(self.zone.size)), None
        if PRESSURE in checked and FILM_MODELS[self.settings.film_model].heated:
            heated = self._heated(loads.at_positions)
            ratio = heated.values[:STIFFNESS] - refinement.places.values[:STIFFNESS, :count]
            ages = self.pairs.age, self.zone
            values[:STIFFNESS] += curves_over_age(self.places, ratio, *ages)
        return SolvedPath(
            heated=heated,
            pairs=self.pairs,
            keeps_distance=self.settings.film["stiffness"] == "approach",
            factors=np.exp(values[:STIFFNESS]),
            yielding=values[STIFFNESS],
            doubtful=refinement.doubtful,
            loads=loads,
            path=self,
            places=refinement.places,
        )

    def _heated(self, load: Array) -> Places:
        """Heated films at the positions, under loads that the cold ones share."""
        angles = self.first_angle + self.angle_per_cycle * self.solved.age
        settings, zone = self.settings, self.places.zone
        with film_places(lambda index: f"at the roll angle {angles[index]:.4f} rad"):
            films = self.solved.films(
                settings.film_model, load, **settings.film, progress=self.progress
            )
        return places_of(self.solved, zone, load, films, np.ones(zone.size, dtype=bool))

    def _solve_more(self, loads: PathLoads, contacts: Index) -> Places:
        pairs, zone = self.pairs.some(contacts), self.zone[contacts]
        with quiet("seed-film-stiffness"):
            # The positions have already caused this warning.
            return self._solve(pairs, zone, loads.of_contacts[contacts])

    def _solve(self, pairs: PairsInContact, zone: Index, loads: Array) -> Places:
        # The heat comes in at the positions, under the loads of the cold films.
        model, options = cold_film(self.settings)

        def solve(new: Index) -> Places:
            some, load = pairs.some(new), loads[new]
            angles = self.first_angle + self.angle_per_cycle * some.age
            with film_places(lambda index: f"at the roll angle {angles[index]:.4f} rad"):
                films = some.films(model, load, **options, progress=self.progress)
            return places_of(some, zone[new], load, films, np.ones(new.size, dtype=bool))

        return self.memory.films_of(pairs, zone, loads, solve)


@dataclass(frozen=True, eq=False)
class LoadedFilms:
    """Films of all contacts under solved loads, scaled by a formula to other loads."""

    pairs: PairsInContact  #: contacts of the mesh table
    keeps_distance: bool  #: whether each film is a spring about the distance that it keeps
    factors: Array  #: films and pressure (3, n) over their scales
    yielding: Array  #: compliance of the films over its scale
    doubtful: Mask  #: quantities (4, contacts) that may be further from a solution than promised
    loads: PathLoads  #: loads that the films were solved for

    @property
    @abstractmethod
    def distance_factors(self) -> Array:
        """Distance under the solved loads, over the scale of films."""

    @property
    def scored(self) -> Mask:
        """Mask of the contacts whose load exceeds the least load."""
        return self.loads.scored

    @property
    def rigid_share(self) -> float:
        """Part of the contacts whose film does not fall with the load."""
        return float(np.mean(self.yielding[self.scored] < RIGID))

    @cached_property
    def _distance(self) -> tuple[Array, Array]:
        """Distance under the solved loads, and the power of the load by which it falls."""
        film = self.pairs.scales(self.loads.of_contacts)["central_film"]
        factors = self.distance_factors
        return film * factors, np.clip(self.yielding / factors, RIGID, 1.0)

    def __call__(self, load_per_width: Array) -> Films:
        """Films of all contacts of the mesh table."""
        *scales, stiffness = self.pairs.scales(load_per_width).values()
        central, minimum, pressure = np.stack(scales) * self.factors
        if not self.keeps_distance:
            film_stiffness = stiffness / np.maximum(self.yielding, RIGID)
            return Films(central, minimum, pressure, film_stiffness)
        solved, power = self._distance
        distance = solved * (load_per_width / self.loads.of_contacts) ** -power
        film_stiffness = self.pairs.length * load_per_width / (power * distance)
        return Films(central, minimum, pressure, film_stiffness, film_distance=distance)

    def reported(self, films: Films, load: Array) -> tuple[Films, Mask]:
        """Films as they are reported, and a mask of their certain quantities."""
        return films, ~self.doubtful


@dataclass(frozen=True, eq=False)
class SolvedPath(LoadedFilms):
    """Films solved along the path of contact; a call returns those of all contacts under loads."""

    path: PathFilm  #: positions and contacts
    places: Places  #: solved contacts: the positions first, then those that were added
    heated: Places | None = None  #: heated films at the positions

    @cached_property
    def distance_factors(self) -> Array:
        """Distance under the solved loads, over the scale of films."""
        path, zones, places = self.path, self.path.zone, self.places.with_stiffness
        factors = np.empty(zones.size)
        for zone in range(len(path.places.counts)):
            in_zone, curve = zones == zone, path.memory.curves.get((zone, STIFFNESS), False)
            distances, age = places.distance[places.zone == zone], path.pairs.age[in_zone]
            factors[in_zone] = joined_over_age(
                path.places, places, distances, age, zone, curve=curve
            )
        return np.asarray(np.exp(factors))

    def warn_of_doubt(self) -> None:
        """Warn of the quantities that are left out, and at how many contacts."""
        doubtful = self.doubtful & self.scored
        count = int(doubtful.any(axis=0).sum())
        if not count:
            return
        rows = zip(QUANTITIES, doubtful, strict=True)
        names = [name.replace("_", " ") for name, row in rows if row.any()]
        positions = self.path.settings.film["positions"]
        more = f" More positions help: film.positions = {min(2 * positions, MOST)}."
        warn(
            "film-positions",
            f"at {count} of {int(self.scored.sum())} contacts of the mesh cycle the "
            f"{', '.join(names)} is left out, because it may deviate by more than "
            f"{100.0 * PROMISED:g} % from a solution: it changes so much along the path of contact "
            f"that {self.places.age.size} solved contacts are too few."
            f"{more if positions < MOST else ''}",
            stacklevel=6,
        )

    def friction(
        self, contact: TribologicalContact, motion: ContactMotion, settings: ToothContact
    ) -> Friction:
        """Friction of every pair; a law that shears the film is evaluated at the solved places."""
        if LAWS[settings.friction_law].needs_film:
            solved = self if self.heated is None else replace(self, places=self.heated)
            return film_friction(solved, motion, settings)
        return friction_by_law(settings.friction_law, contact, settings.friction_options)


def film_of(
    settings: ToothContact,
    cycle: MeshCycle,
    teeth: Teeth,
    pairs: PairsInContact,
    speed: float,
    progress: Progress,
) -> FormulaFilm | PathFilm:
    """Return the film by the settings: a formula, or solutions along the path of contact."""
    model = FILM_MODELS[settings.film_model]
    if not model.method:
        return FormulaFilm(settings, pairs, teeth.least_load)
    contact, side = cycle.contact, cycle.side
    places = path_positions(contact, settings.film["positions"], teeth.bends)
    path = contact.A + contact.direction * places.age * contact.pair.base_pitch
    motion = contact.kinematics(path, speed)
    solved = replace(
        pairs,
        age=places.age,
        equivalent_radius=motion.equivalent_radius,
        entrainment_speed=motion.entrainment_speed,
        sliding_speed=motion.sliding_speed,
    )
    radius = getattr(motion, f"{contact.pair.driver}_curvature_radius")
    angle = radius / contact.pair.driving.base_radius
    return PathFilm(
        settings=settings,
        grid=cycle.grid,
        in_contact=cycle.in_contact,
        least_load=teeth.least_load,
        progress=progress,
        places=places,
        first_angle=float(angle[0]),
        angle_per_cycle=float((angle[-1] - angle[0]) / (places.age[-1] - places.age[0])),
        solved=solved,
        pairs=pairs,
        # At an event the side decides the zone; bends lie between the grid points.
        zone=places.zone_of(pairs.age + np.clip(side - pairs.age, -_BESIDE, _BESIDE)),
    )


def film_friction(solved: SolvedPath, motion: ContactMotion, settings: ToothContact) -> Friction:
    """Friction of the sheared film, from its values at the solved places over the sliding speed.

    A contact between two places uses its actual sliding speed, so that the steep reversal at the
    pitch point is resolved although no place lies close to it. Along the path friction is
    interpolated like the pressure.
    """
    path, places = solved.path, solved.places
    columns: list[Array] = [np.zeros(path.zone.size) for _ in range(3)]
    shared = False
    # Which body is the faster one matters where one takes up more heat than the other.
    first, second = settings.bodies
    for zone, sign in product(
        range(len(path.places.counts)), (0.0,) if first == second else (1, -1)
    ):
        in_zone = (path.zone == zone) & (motion.sliding_speed * sign >= 0.0)
        if not np.any(in_zone):
            continue
        sliding = np.abs(motion.sliding_speed[in_zone])
        speeds = sampled_speeds(sliding)
        chosen = np.flatnonzero(places.zone == zone)
        friction = _friction_over_speed(solved, settings, chosen, speeds, np.copysign(1.0, sign))
        over_speed = speed_weights(speeds, sliding)
        curve = path.memory.curves.get((zone, PRESSURE), False)
        shared = isinstance(friction, FrictionParts)
        for column, values in zip(columns, parts_of(friction), strict=False):
            along = joined_over_age(
                path.places,
                places,
                values.reshape(-1, speeds.size),
                path.pairs.age[in_zone],
                zone,
                curve=curve,
            )
            column[in_zone] = np.maximum(np.einsum("ks,ks->k", along, over_speed), 0.0)
    return FrictionParts(*columns) if shared else columns[0]


def parts_of(friction: Friction) -> tuple[Array, ...]:
    """Coefficient, or film, asperities and load share of the film where the law has them."""
    if isinstance(friction, FrictionParts):
        return friction.film, friction.asperities, friction.film_load_share
    return (friction,)


def sampled_speeds(sliding: Array) -> Array:
    """Sliding speeds of a zone [m/s], dense near zero, from its least to its greatest."""
    ends = np.arcsinh(np.array([np.min(sliding), np.max(sliding)]) / _SLOW)
    count = max(_LEAST, int(np.ceil(_DENSITY * (ends[1] - ends[0]))) + 1)
    inner = ends.mean() + 0.5 * (ends[1] - ends[0]) * lobatto_points(count)
    return np.asarray(_SLOW * np.sinh(inner))


def speed_weights(speeds: Array, sliding: Array) -> Array:
    """Weights (k, s) of values at sampled speeds for each sliding speed."""
    return lobatto_polynomial(np.arcsinh(speeds / _SLOW), np.arcsinh(sliding / _SLOW))


def _friction_over_speed(
    solved: SolvedPath, settings: ToothContact, chosen: Index, speeds: Array, sign: float
) -> Friction:
    """Friction of some solved places (place by speed), at all speeds of one sign."""
    places = solved.places
    judge = np.flatnonzero(judged(places.load_per_width))
    loaded = chosen[np.isin(chosen, judge)]

    def friction(some: Index) -> Friction:
        index, speed = np.repeat(some, speeds.size), np.tile(speeds, some.size)
        return sheared_friction(places, solved.path.pairs, settings, index, sign * speed)

    return warn_of_loaded(
        lambda: friction(chosen), lambda: friction(loaded) if loaded.size else None
    )


def sheared_friction(
    places: Places, pairs: PairsInContact, settings: ToothContact, index: Index, sliding: Array
) -> Friction:
    """Friction of solved places, one sliding speed for each."""
    load, radius = places.load_per_width[index], places.equivalent_radius[index]
    entrainment = places.entrainment_speed[index]
    most = _MOST_SLIDING * entrainment
    speed = np.clip(sliding, -most, most)
    contact = TribologicalContact(
        load_per_width=load,
        hertz_pressure=hertz_line(load, radius, pairs.effective_modulus).maximum_pressure,
        sliding_speed=speed,
        entrainment_speed=entrainment,
        slide_to_roll_ratio=speed / entrainment,
        equivalent_radius=radius,
        dynamic_viscosity=pairs.lubricant.dynamic_viscosity,
        composite_roughness=settings.composite_roughness,
        film=FilmState.from_solutions(list(places.solution), index),
        bodies=settings.bodies,
    )
    return LAWS[settings.friction_law].evaluate(contact, settings.friction_options)
