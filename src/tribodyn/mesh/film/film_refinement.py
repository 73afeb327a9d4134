"""Adaptive refinement of solved contacts along the path of contact.

The contact midway between two solved ones is solved and compared with the interpolated value.
Where they differ, both halves and their neighbours are refined in the same way.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from tribodyn.arrays.splines import monotone_cubic
from tribodyn.ehl.steady.batch import Films
from tribodyn.mesh.cycle import PairsInContact, PathPositions, lobatto_polynomial
from tribodyn.types import Array, Index, Mask

#: What is interpolated, in this order; the last as compliance, which has no pole.
QUANTITIES = ("central_film", "minimum_film", "film_pressure", "film_stiffness")
PRESSURE, STIFFNESS = 2, 3
ALL = (0, 1, 2, 3)
#: Compliance over its estimate below which a film counts as rigid: its stiffness has a bound.
RIGID = 1e-3
#: Interpolation error above which more contacts are solved, and the error that is guaranteed.
GOOD, PROMISED = 0.006, 0.02
#: Difference of logarithms at which the error saturates.
_FAR = 20.0
#: Vertex of a parabola through the greatest pressure and its neighbours, in parts of a node, while
#: the tip of a sharp peak moves in even steps of a tenth of a node.
_VERTEX = (0.53, 0.61, 0.655, 0.69, 0.73, 0.77, 0.82, 0.90, 1.03, 1.26, 1.53)
_EVEN = 0.35 + 0.1 * np.arange(len(_VERTEX))
#: Variation of the height of a sharp peak while its tip moves from node to node, over its fall to
#: the neighbouring nodes.
SWING = 0.25
#: Number of neighbouring places from which the sharpness of a peak is estimated.
_NEIGHBOURS = 8
#: Contacts solved in addition to the positions, at most.
MOST_ADDED = 800
#: Ages closer together than this are the same place [mesh cycles].
_SAME = 1e-8
#: Compliance below which a film is nearly rigid, and ratio of two compliances that is steep.
_NEARLY_RIGID, _SOARS = 5.0 * RIGID, 1.4
#: Iterations at most of the search for the greatest pressure and the least films.
_EXTREMES = 6


#: Solved films, one for each place.
Solutions = NDArray[np.object_]
#: Radius, speeds and load per width: a contact with the same has the same film.
ContactNumbers = tuple[float, float, float, float]


class Places(NamedTuple):
    """Solved contacts: the positions first, then those of the mesh table that were added."""

    age: Array
    zone: Index
    equivalent_radius: Array
    entrainment_speed: Array
    load_per_width: Array
    values: Array
    peak_place: Array  #: of the tip of the greatest pressure, in nodes
    peak_drop: Array
    yielding: Mask  #: whether the film stiffness is interpolated from this place too
    solution: Solutions  #: of each of them
    distance: Array  #: logarithm of the distance that the film keeps, over the scale of films

    @property
    def with_stiffness(self) -> Places:
        """Places from which the film stiffness is interpolated."""
        return self.some(self.yielding)

    def some(self, which: Mask | slice) -> Places:
        """Return a subset of the places."""
        return Places(**{name: getattr(self, name)[..., which] for name in self._fields})

    def joined(self, others: Places) -> Places:
        """Return the places followed by others."""
        return Places(*(np.concatenate(pair, axis=-1) for pair in zip(self, others, strict=True)))


@dataclass(eq=False)
class SolvedContacts:
    """Cache of solved contacts and refinement decisions, from which the next solution starts."""

    contacts: Index = field(default_factory=lambda: np.zeros(0, dtype=np.int64))
    yielding: Mask = field(default_factory=lambda: np.zeros(0, dtype=bool))
    curves: dict[tuple[int, int], bool] = field(default_factory=dict)
    solved: dict[ContactNumbers, Places] = field(default_factory=dict)  #: one contact each

    def add(self, contacts: Index, yielding: Mask) -> None:
        """Store contacts, and whether the stiffness of their films is needed."""
        self.contacts = np.concatenate([self.contacts, contacts])
        self.yielding = np.concatenate([self.yielding, yielding])

    def retain(self, numbers: Iterable[ContactNumbers]) -> None:
        """Drop all solutions but those of these contacts: most shared loads change every pass."""
        self.solved = {each: self.solved[each] for each in numbers if each in self.solved}

    def films_of(
        self, pairs: PairsInContact, zone: Index, load: Array, solve: Callable[[Index], Places]
    ) -> Places:
        """Return solved films of some pairs; solve and store those that are not cached."""
        numbers = contact_numbers(pairs, load)
        new = np.array([i for i, each in enumerate(numbers) if each not in self.solved], dtype=int)
        if new.size:
            places = solve(new)
            for column, index in enumerate(new):
                self.solved[numbers[index]] = places.some(slice(column, column + 1))
        parts = zip(*(self.solved[each] for each in numbers), strict=True)
        solved_places = Places(*(np.concatenate(columns, axis=-1) for columns in parts))
        every = np.ones(zone.size, dtype=bool)
        return solved_places._replace(age=pairs.age, zone=zone, yielding=every)


def contact_numbers(pairs: PairsInContact, load: Array) -> list[ContactNumbers]:
    """Radius, speeds and load of each pair: the key of its solved film."""
    sliding = np.zeros(load.size) if pairs.sliding_speed is None else pairs.sliding_speed
    numbers = pairs.equivalent_radius, pairs.entrainment_speed, sliding, load
    return list(zip(*(column.tolist() for column in numbers), strict=True))


def places_of(
    pairs: PairsInContact, zone: Index, load: Array, films: Films, yielding: Mask
) -> Places:
    """Solved films over their scales, as logarithms, and where their pressure is greatest."""
    scales = pairs.scales(load)
    values = [np.log(getattr(films, name) / scales[name]) for name in QUANTITIES[:STIFFNESS]]
    # The compliance and not the stiffness, which has a pole where the compliance is zero.
    values.append(scales["film_stiffness"] / np.asarray(films.film_stiffness))
    peaks = [_peak(solution.pressure) for solution in films.solutions]
    tip, drop = np.array(peaks).reshape(-1, 2).T
    solution = np.empty(zone.size, dtype=object)
    solution[:] = films.solutions
    radius, speed, logarithms = pairs.equivalent_radius, pairs.entrainment_speed, np.stack(values)
    where = pairs.age, zone, radius, speed, load
    distance = np.log(np.asarray(films.film_distance) / scales["central_film"])
    return Places(*where, logarithms, tip, drop, yielding, solution, distance)


def _peak(pressure: Array) -> tuple[float, float]:
    """Position of the pressure peak, in nodes, and its relative fall to the neighbouring nodes."""
    node = int(np.clip(np.argmax(pressure), 1, pressure.size - 2))
    before, most, after = pressure[node - 1 : node + 2]
    bend = 2.0 * most - before - after
    vertex = node + (0.5 * (after - before) / bend if bend > 0.0 else 0.0)
    node_below = np.floor(vertex - _VERTEX[0])
    place = node_below + np.interp(vertex - node_below, _VERTEX, _EVEN)
    return float(place), float(bend / (2.0 * most))


def between(
    positions: PathPositions, memory: SolvedContacts, places: Places, age: Array, zone: Index
) -> Array:
    """Values (4, m) at other ages."""
    count = positions.age.size
    base = places.values[:, :count].T
    values = positions.interpolate(base, age, zone).T
    correction = places.values - positions.interpolate(base, places.age, places.zone).T
    added = np.arange(places.age.size) >= count
    for number, quantity in np.ndindex(len(positions.counts), len(QUANTITIES)):
        requested, in_zone = zone == number, places.zone == number
        if quantity == STIFFNESS:
            # Places that were added for the pressure alone do not change the stiffness.
            in_zone &= ~added | places.yielding
        if memory.curves.get((number, quantity), False):
            values[quantity, requested] = _curve(
                places.age[in_zone], places.values[quantity, in_zone], age[requested]
            )
        elif (in_zone & added).any():
            order = np.flatnonzero(in_zone)[np.argsort(places.age[in_zone])]
            values[quantity, requested] += np.interp(
                age[requested], places.age[order], correction[quantity, order]
            )
    return values


def _curve(knots: Array, values: Array, age: Array) -> Array:
    """Monotone cubic through the places of a zone."""
    at, first = np.unique(knots, return_index=True)
    return monotone_cubic(at, values[first])(age)


def curves_over_age(positions: PathPositions, values: Array, age: Array, zone: Index) -> Array:
    """Rows (rows, m) of values at the positions, joined by monotone cubics in each zone."""
    rows = np.zeros((len(values), age.size))
    for number in range(len(positions.counts)):
        at, wanted = positions.zone == number, zone == number
        for row, of_positions in zip(rows, values, strict=True):
            row[wanted] = _curve(positions.age[at], of_positions[at], age[wanted])
    return rows


def joined_over_age(
    positions: PathPositions, places: Places, values: Array, age: Array, zone: int, *, curve: bool
) -> Array:
    """Values (m, ...) of one zone at other ages, from those (places, ...) of all places in it."""
    in_zone = np.flatnonzero(places.zone == zone)
    base, added = in_zone[in_zone < positions.age.size], in_zone[in_zone >= positions.age.size]
    base_values = values[base - base[0]]
    if not added.size:
        return np.tensordot(_polynomial(positions, base, age), base_values, axes=(1, 0))
    order = in_zone[np.argsort(places.age[in_zone], kind="stable")]
    at, first = np.unique(places.age[order], return_index=True)
    sorted_values = values[np.searchsorted(in_zone, order[first])]
    if curve:
        return _curve(at, sorted_values, age)
    smooth = np.tensordot(_polynomial(positions, base, at), base_values, axes=(1, 0))
    correction = sorted_values - smooth
    flat = correction.reshape(at.size, -1)
    remainder = np.stack([np.interp(age, at, column) for column in flat.T], axis=1)
    polynomial = np.tensordot(_polynomial(positions, base, age), base_values, axes=(1, 0))
    return np.asarray(polynomial + remainder.reshape(age.size, *correction.shape[1:]))


def _polynomial(positions: PathPositions, base: Index, age: Array) -> Array:
    return lobatto_polynomial(positions.age[base], age)


def deviation(expected: Array, solved: Array) -> Array:
    """Relative error of each quantity (4, m); compliances below ``RIGID`` count as ``RIGID``."""
    error = np.abs(np.expm1(np.clip(expected - solved, -_FAR, _FAR)))
    yielding, solved_yielding = (np.maximum(v[STIFFNESS], RIGID) for v in (expected, solved))
    error[STIFFNESS] = np.abs(solved_yielding / yielding - 1.0)
    return np.asarray(error)


class PathLoads(NamedTuple):
    """Loads that a film is solved for [N/m]."""

    at_positions: Array
    of_contacts: Array  #: of the contacts of the mesh table
    scored: Mask  #: contacts that carry enough for a film of their own


@dataclass(frozen=True)
class _Interval:
    """Ages of one zone between two solved places, and the errors around it."""

    zone: int
    start: float
    end: float
    error: Array


@dataclass(eq=False)
class Refinement:
    """Solved places of one set of loads, to which contacts of the mesh table are added."""

    positions: PathPositions
    pairs: PairsInContact  #: contacts of the mesh table
    zone: Index  #: zone of each of them
    loads: PathLoads
    memory: SolvedContacts
    places: Places
    solve: Callable[[Index], Places]

    def __post_init__(self) -> None:
        self.doubtful = np.zeros((len(QUANTITIES), self.zone.size), dtype=bool)

    def values(self, contacts: Index) -> Array:
        """Logarithms of the films over their scales, and the compliance over its own."""
        age, zone = self.pairs.age[contacts], self.zone[contacts]
        return between(self.positions, self.memory, self.places, age, zone)

    def refine(self, quantities: tuple[int, ...]) -> None:
        """Solve more contacts until these quantities are accurate or the limit is reached."""
        intervals, first = self._between_places(), True
        while intervals:
            middles = [self._middle(interval) for interval in intervals]
            pairs = [(i, m) for i, m in zip(intervals, middles, strict=True) if m >= 0]
            if self.memory.contacts.size + len(pairs) > MOST_ADDED:
                self._doubt(intervals, PRESSURE in quantities)
                return
            if not pairs:
                return
            contacts = np.array([middle for _, middle in pairs])
            expected = self.values(contacts)
            solved = self.solve(contacts)
            errors = np.zeros((len(QUANTITIES), contacts.size))
            errors[list(quantities)] = deviation(expected, solved.values)[list(quantities)]
            if first:
                self._choose_curves(contacts, solved, errors)
                first = False
            opened = self._opened([interval for interval, _ in pairs], errors)
            turning = [self._turns_rigid(interval) for interval, _ in pairs]
            self._add(contacts, solved, (opened | turning) & (errors[STIFFNESS] > 0.0))
            intervals = self._halves(pairs, errors, opened, PRESSURE in quantities)

    def solve_extremes(self) -> None:
        """Solve the very contacts that have the least films and the greatest pressure."""
        every = np.arange(self.zone.size)
        scales = self.pairs.scales(self.loads.of_contacts)
        for _ in range(_EXTREMES):
            values = self.values(every)
            wanted = set()
            for quantity, sign in ((0, -1.0), (1, -1.0), (PRESSURE, 1.0)):
                size = sign * scales[QUANTITIES[quantity]] * np.exp(values[quantity])
                eligible = self.loads.scored & ~self.doubtful[quantity]
                if eligible.any():
                    wanted.add(int(np.argmax(np.where(eligible, size, -np.inf))))
            new = np.array([contact for contact in wanted if not self._is_solved(contact)])
            if not new.size:
                return
            solved = self.solve(new)
            self._add(new, solved, np.zeros(new.size, dtype=bool))

    def _add(self, contacts: Index, solved: Places, yielding: Mask) -> None:
        self.memory.add(contacts, yielding)
        self.places = self.places.joined(solved._replace(yielding=yielding))

    def _is_solved(self, contact: int) -> bool:
        same_zone = self.places.zone == self.zone[contact]
        same_age = np.abs(self.places.age - self.pairs.age[contact]) < _SAME
        return bool((same_zone & same_age).any())

    def _between_places(self) -> list[_Interval]:
        intervals = []
        for zone in range(len(self.positions.counts)):
            ages = np.unique(self.places.age[self.places.zone == zone])
            no_error = np.zeros(len(QUANTITIES))
            intervals += [_Interval(zone, float(a), float(b), no_error) for a, b in pairwise(ages)]
        return intervals

    def _inside(self, interval: _Interval) -> Index:
        age = self.pairs.age
        inside = (age > interval.start + _SAME) & (age < interval.end - _SAME)
        return np.flatnonzero(inside & self.loads.scored & (self.zone == interval.zone))

    def _middle(self, interval: _Interval) -> int:
        """Contact nearest to the middle, or -1."""
        inside = self._inside(interval)
        if not inside.size:
            return -1
        middle = 0.5 * (interval.start + interval.end)
        return int(inside[np.argmin(np.abs(self.pairs.age[inside] - middle))])

    def _choose_curves(self, contacts: Index, solved: Places, errors: Array) -> None:
        """Replace the polynomial of a zone by a monotone curve where that is more accurate."""
        curves = self.memory.curves
        for zone in np.unique(self.zone[contacts]):
            in_zone = self.zone[contacts] == zone
            for quantity in range(len(QUANTITIES)):
                worst = float(errors[quantity, in_zone].max())
                if worst <= GOOD or curves.get((int(zone), quantity), False):
                    continue
                trial = with_curve(self.memory, int(zone), quantity)
                age = self.pairs.age[contacts[in_zone]]
                of_curve = between(
                    self.positions, trial, self.places, age, self.zone[contacts[in_zone]]
                )
                error = deviation(of_curve, solved.values[:, in_zone])[quantity]
                curves[int(zone), quantity] = bool(error.max() < worst)

    def _opened(self, intervals: list[_Interval], errors: Array) -> Mask:
        """Mask of the intervals with an error and of their neighbours."""
        bad = np.asarray((errors > GOOD).any(axis=0))
        opened = np.array(bad)
        for left in range(len(intervals) - 1):
            a, b = intervals[left], intervals[left + 1]
            if a.zone == b.zone and abs(a.end - b.start) < _SAME:
                opened[left] |= bad[left + 1]
                opened[left + 1] |= bad[left]
        return opened

    def _halves(
        self,
        pairs: list[tuple[_Interval, int]],
        errors: Array,
        opened: Mask,
        spikes: bool,
    ) -> list[_Interval]:
        halves = []
        for number, (interval, contact) in enumerate(pairs):
            age = float(self.pairs.age[contact])
            for start, end in ((interval.start, age), (age, interval.end)):
                half = _Interval(interval.zone, start, end, errors[:, number])
                uneven = spikes and self._passes_nodes(half)
                if opened[number] or uneven or self._turns_rigid(half):
                    halves.append(half)
        return halves

    def _passes_nodes(self, interval: _Interval) -> bool:
        """Whether a sharp peak moves so far over the nodes that its height oscillates."""
        ends = self._ends(interval)
        tips = self.places.peak_place[ends]
        # The fall of a peak depends on its position between the nodes, so use several neighbours.
        same = np.flatnonzero(self.places.zone == interval.zone)
        distance = np.abs(self.places.age[same] - 0.5 * (interval.start + interval.end))
        drop = self.places.peak_drop[same[np.argsort(distance)[:_NEIGHBOURS]]].max()
        turn = np.pi * min(abs(tips[1] - tips[0]), 1.0)
        return bool(SWING * drop * np.sin(0.5 * turn) ** 2 > 0.5 * PROMISED)

    def _turns_rigid(self, interval: _Interval) -> bool:
        """Whether the film turns rigid between both ends, so that its stiffness rises steeply."""
        least, most = np.sort(
            np.maximum(self.places.values[STIFFNESS, self._ends(interval)], RIGID)
        )
        return bool(least < _NEARLY_RIGID and most > _SOARS * least)

    def _ends(self, interval: _Interval) -> list[int]:
        """Places at both ends."""
        same_zone = self.places.zone == interval.zone
        return [
            int(np.flatnonzero(same_zone & (np.abs(self.places.age - age) < _SAME))[0])
            for age in (interval.start, interval.end)
        ]

    def _doubt(self, intervals: list[_Interval], spikes: bool) -> None:
        """Mark the contacts between places that are too far apart as doubtful."""
        for interval in intervals:
            bad = interval.error > PROMISED
            bad[PRESSURE] |= spikes and self._passes_nodes(interval)
            self.doubtful[np.ix_(bad, self._inside(interval))] = True


def with_curve(memory: SolvedContacts, zone: int, quantity: int) -> SolvedContacts:
    """Return a copy of the cache with a monotone curve in one zone."""
    return replace(memory, curves={**memory.curves, (zone, quantity): True})
