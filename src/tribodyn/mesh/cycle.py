"""One mesh cycle as places: where every tooth pair is at every knot, and whether it touches."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from tribodyn.contact import (
    FaceContacts,
    Kinematics,
    PathOfContact,
    effective_modulus,
    face_contacts,
    hertz_line,
)
from tribodyn.contact.path import pitch_point_age
from tribodyn.ehl import FILM_MODELS, moes_central
from tribodyn.ehl.steady.batch import Films
from tribodyn.errors import require_between
from tribodyn.gear import Material
from tribodyn.lubricant import Lubricant
from tribodyn.mesh.grid import PhaseGrid, phase_grid
from tribodyn.types import Array, Index, Mask, Tree


@dataclass(frozen=True, eq=False)
class MeshCycle:
    """Places of all tooth pairs over one mesh cycle; made by :func:`mesh_cycle`."""

    contact: PathOfContact  #: path of contact of the pair
    grid: PhaseGrid  #: knots on the mesh phase, twice at each event
    path: Array  #: position of each contact on the line of action [m]
    in_contact: Mask  #: whether the pair is in contact
    slices: FaceContacts | None = None  #: of the lines of contact, where contacts are slices

    @cached_property
    def age(self) -> Array:
        """Mesh cycles since the pair entered, at the place of each touching contact on the path."""
        return np.asarray(self._aged(self.grid.phase))

    @cached_property
    def stiffness_length(self) -> Array | float:
        """Length of each touching contact, as far as the stiffness of its film goes [m]."""
        # The line of a slice is 1/cos(beta_b) as long as the slice is wide; along the transverse
        # line of action a film is cos(beta_b)^2 as stiff as along the normal.
        pair = self.contact.pair
        if self.slices is None:
            return pair.common_face_width
        return np.asarray(self.slices.width[self.in_contact] * math.cos(pair.base_helix_angle))

    @cached_property
    def side(self) -> Array:
        """Age in the middle of the segment of each knot: which side of an event is meant."""
        return np.asarray(self._aged(self.grid.middle))

    def _aged(self, phase: Array) -> Array:
        if self.slices is not None:
            travel = self.contact.direction * (self.path[self.in_contact] - self.contact.A)
            return np.asarray(travel / self.contact.pair.base_pitch)
        return (phase[:, None] + np.arange(self.path.shape[1]))[self.in_contact]

    @cached_property
    def sliding_direction(self) -> Array:
        """Sign of the sliding speed of the touching pairs; never zero, but for slices at C."""
        if self.slices is not None:
            return self.contact.sliding_direction(self.path[self.in_contact])
        middle = self.contact.pair_paths(self.grid.middle)[0]
        return self.contact.sliding_direction(middle[self.in_contact])

    def named(self, knot: int, pair: int) -> str:
        """Name a tooth pair by its roll angle."""
        gears, path = self.contact.pair, float(self.path[knot, pair])
        angle = gears.driving_radius(path) / gears.driving.base_radius
        return f"the tooth pair at the roll angle {angle:.4f} rad"

    def motion(self, speed: Array | float) -> Kinematics:
        """Curvatures and speeds of the touching pairs; speeds in a column give them in rows."""
        return self.contact.kinematics(self.path[self.in_contact], speed)


def mesh_cycle(contact: PathOfContact, steps: int, slices: int = 0) -> MeshCycle:
    """Place all tooth pairs over one mesh cycle, cut into slices of the face if there are any."""
    grid = phase_grid(contact.event_phases(), steps)
    if slices:
        contacts = face_contacts(contact, grid.phase, slices, grid.middle)
        return MeshCycle(contact, grid, contacts.path, contacts.in_contact, contacts)
    middle, in_contact = contact.pair_paths(grid.middle)
    # Advance from the middle of the segment, so that both of its ends keep its pairs.
    path = (
        middle + contact.direction * contact.pair.base_pitch * (grid.phase - grid.middle)[:, None]
    )
    return MeshCycle(contact, grid, path, in_contact)


@dataclass(frozen=True, eq=False)
class PairsInContact:
    """Pairs in contact without their load, as arrays of one shape."""

    age: Array  #: mesh cycles since the pair entered contact
    equivalent_radius: Array  #: reduced radius of curvature [m]
    entrainment_speed: Array  #: HALF the sum of the surface speeds [m/s]
    lubricant: Lubricant  #: oil at working temperature
    effective_modulus: float  #: ``2/E' = (1-nu1^2)/E1 + (1-nu2^2)/E2`` [Pa]
    length: Array | float  #: of the contact line, as far as the stiffness of a film goes [m]
    sliding_speed: Array | None = None  #: difference of the surface speeds [m/s], for a heated film

    def some(self, index: Index) -> PairsInContact:
        """A part of these contacts."""
        columns: Tree = {n: v for n, v in vars(self).items() if np.ndim(v)}
        return replace(self, **{name: column[index] for name, column in columns.items()})

    def joined(self, others: PairsInContact) -> PairsInContact:
        """These contacts and others of the same pair."""
        values = {n: v for n, v in vars(self).items() if n != "length" and np.ndim(v)}
        columns: Tree = {
            name: np.concatenate([value, getattr(others, name)]) for name, value in values.items()
        }
        return replace(self, **columns)

    def films(self, model: str, load_per_width: Array, **options: Any) -> Films:
        """Films of every one of these contacts."""
        return FILM_MODELS[model].films(
            load_per_width,
            self.equivalent_radius,
            self.entrainment_speed,
            self.lubricant,
            self.effective_modulus,
            length=self.length,
            sliding_speed=self.sliding_speed,
            **options,
        )

    def scales(self, load_per_width: Array) -> dict[str, Array]:
        """Estimates of the films, right in every regime but for a factor that is smooth."""
        oil = self.lubricant.dynamic_viscosity, self.lubricant.pressure_viscosity_coefficient
        contacts = load_per_width, self.equivalent_radius, self.entrainment_speed
        film = moes_central(*contacts, *oil, self.effective_modulus)
        hertz = hertz_line(load_per_width, self.equivalent_radius, self.effective_modulus)
        return {
            "central_film": film,
            "minimum_film": film,
            "film_pressure": hertz.maximum_pressure,
            "film_stiffness": self.length * load_per_width / film,
        }


def pairs_in_contact(
    cycle: MeshCycle, motion: Kinematics, lubricant: Lubricant, material: Material
) -> PairsInContact:
    """Gather what the films of the touching pairs depend on, their loads excepted."""
    return PairsInContact(
        age=cycle.age,
        equivalent_radius=motion.equivalent_radius,
        entrainment_speed=motion.entrainment_speed,
        lubricant=lubricant,
        effective_modulus=effective_modulus(material, material),
        length=cycle.stiffness_length,
        sliding_speed=motion.sliding_speed,
    )


#: Least and greatest number of positions.
LEAST, MOST = 8, 200
#: A zone with fewer points is not worth a polynomial.
_LEAST_IN_ZONE = 4
#: Zones narrower than this are rounding [mesh cycles].
_ROUNDING = 1e-9
#: A bend this near to an edge is left to it [mesh cycles].
_NARROW = 0.01
#: Distance from the end of a zone that separates its two sides [mesh cycles].
_SIDE = 1e-10


@dataclass(frozen=True, eq=False)
class PathPositions:
    """Positions of one tooth pair from its entry to its exit, counted in mesh cycles."""

    edges: tuple[float, ...]  #: [mesh cycles]
    counts: tuple[int, ...]  #: positions in each zone

    @cached_property
    def age(self) -> Array:
        """Mesh cycles since the pair entered; an edge between two zones occurs twice."""
        zones = zip(self.edges[:-1], self.edges[1:], self.counts, strict=True)
        parts = [0.5 * (a + b) + 0.5 * (b - a) * lobatto_points(count) for a, b, count in zones]
        for part, start, end in zip(parts, self.edges[:-1], self.edges[1:], strict=True):
            part[0], part[-1] = start, end
        return np.concatenate(parts)

    @cached_property
    def sided_age(self) -> Array:
        """The same ages moved by a hair into their own zone, so that edges have two sides."""
        first = np.repeat(self.edges[:-1], self.counts) + _SIDE
        last = np.repeat(self.edges[1:], self.counts) - _SIDE
        return np.asarray(np.clip(self.age, first, last))

    @property
    def zones(self) -> tuple[slice, ...]:
        """Positions of each zone."""
        stops = np.cumsum(self.counts)
        return tuple(
            slice(int(stop) - count, int(stop))
            for stop, count in zip(stops, self.counts, strict=True)
        )

    @property
    def zone(self) -> Index:
        """Zone of each position."""
        return np.repeat(np.arange(len(self.counts)), self.counts)

    def zone_of(self, age: Array) -> Index:
        """Find the zone of a pair."""
        inner = np.array(self.edges[1:-1])
        return np.asarray(np.searchsorted(inner, age, side="right"), dtype=np.int64)

    def interpolate(self, values: Array, age: Array, zone: Index) -> Array:
        """Evaluate the polynomial through the positions of a zone."""
        interpolated = np.zeros(age.shape + values.shape[1:])
        for number, part in enumerate(self.zones):
            in_zone = zone == number
            matrix = lobatto_polynomial(self.age[part], age[in_zone])
            interpolated[in_zone] = np.tensordot(matrix, values[part], axes=(1, 0))
        return interpolated


def lobatto_points(count: int) -> Array:
    """Gauss-Lobatto points of Chebyshev between -1 and 1, rising."""
    return np.asarray(-np.cos(np.pi * np.arange(count) / (count - 1)))


def lobatto_polynomial(knots: Array, at: Array) -> Array:
    """Weights of values at Lobatto points; barycentric formula, Berrut and Trefethen (2004)."""
    weight = (-1.0) ** np.arange(knots.size)
    weight[[0, -1]] *= 0.5
    distance = at[:, None] - knots
    hit = distance == 0.0
    parts = weight / np.where(hit, 1.0, distance)
    parts = np.where(hit.any(axis=1, keepdims=True), hit, parts)
    return np.asarray(parts / parts.sum(axis=1, keepdims=True))


def path_positions(
    contact: PathOfContact, positions: int, bends: tuple[float, ...] = ()
) -> PathPositions:
    """Spread positions over the zones of the path of contact."""
    require_between("positions", positions, LEAST, MOST)
    ratio = contact.contact_ratio
    path_points = [0.0, ratio]
    for number in range(1, contact.pairs):
        path_points += [float(number), ratio - number]
    path_points.append(pitch_point_age(contact))
    for number in range(contact.pairs):
        wide = [number + bend for bend in bends]
        path_points += [
            age for age in wide if np.min(np.abs(np.array(path_points) - age)) > _NARROW
        ]
    edges = [0.0]
    for edge in sorted(edge for edge in path_points if 0.0 < edge <= ratio):
        if edge - edges[-1] > _ROUNDING:
            edges.append(edge)
    edges[-1] = ratio
    return PathPositions(tuple(edges), _shares(np.diff(edges), int(positions)))


def _shares(lengths: Array, total: int) -> tuple[int, ...]:
    """Whole numbers in proportion to the lengths, at least four each, by the largest remainder."""
    free = np.maximum(total * lengths / lengths.sum(), _LEAST_IN_ZONE)
    wide = free > _LEAST_IN_ZONE
    shared_total = total - _LEAST_IN_ZONE * int(np.sum(~wide))
    if not np.any(wide) or shared_total < _LEAST_IN_ZONE * int(np.sum(wide)):
        return (_LEAST_IN_ZONE,) * lengths.size
    wanted = np.where(wide, shared_total * lengths / lengths[wide].sum(), _LEAST_IN_ZONE)
    counts = np.maximum(np.floor(wanted), _LEAST_IN_ZONE).astype(int)
    for index in np.argsort(counts - wanted)[: max(total - int(counts.sum()), 0)]:
        counts[index] += 1
    return tuple(int(count) for count in counts)
