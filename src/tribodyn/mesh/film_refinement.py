"""Adds solved contacts along the path until what lies between them is near enough to a solution.

Between two solved places the contact in the middle is solved and compared with what was expected
there. Where both differ, the two halves and their neighbours are looked at in the same way.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from tribodyn.mesh.positions import PathPositions
from tribodyn.mesh.solved_places import (
    GOOD,
    PRESSURE,
    PROMISED,
    QUANTITIES,
    RIGID,
    STIFFNESS,
    Memory,
    Places,
    between,
    deviation,
)
from tribodyn.mesh.touching import Touching
from tribodyn.types import Array, Index, Mask

#: Contacts that are solved beside the positions at most.
MOST_ADDED = 800
#: Ages nearer than this are one place [mesh cycles].
_SAME = 1e-8
#: Compliance below which a film is nearly rigid, and ratio of two of them that is steep.
_NEARLY_RIGID, _SOARS = 5.0 * RIGID, 1.4
#: Times that the contact with the greatest pressure or the least film is looked for anew.
_EXTREMES = 6


class PathLoads(NamedTuple):
    """Loads that a film is solved for [N/m]."""

    at_positions: Array
    of_contacts: Array  #: of the contacts of the mesh table
    scored: Mask  #: contacts that carry enough for a film of their own


@dataclass(frozen=True)
class _Interval:
    """Ages of one zone between two solved places, and the errors found around it."""

    zone: int
    start: float
    end: float
    error: Array


@dataclass(eq=False)
class Refinement:
    """Solved places of one set of loads, to which contacts of the mesh table are added."""

    positions: PathPositions
    touching: Touching  #: contacts of the mesh table
    zone: Index  #: zone of each of them
    loads: PathLoads
    memory: Memory
    places: Places
    solve: Callable[[Index], Places]

    def __post_init__(self) -> None:
        self.doubtful = np.zeros((len(QUANTITIES), self.zone.size), dtype=bool)

    def values(self, contacts: Index) -> Array:
        """Logarithms of the films over their scales, and the compliance over its own."""
        age, zone = self.touching.age[contacts], self.zone[contacts]
        return between(self.positions, self.memory, self.places, age, zone)

    def refine(self, quantities: tuple[int, ...]) -> None:
        """Add contacts until these quantities are good everywhere, or there are too many."""
        intervals, first = self._between_places(), True
        while intervals:
            middles = [self._middle(interval) for interval in intervals]
            pairs = [(i, m) for i, m in zip(intervals, middles, strict=True) if m >= 0]
            if self.memory.contacts.size + len(pairs) > MOST_ADDED:
                self._doubt(intervals)
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
        """Solve the contacts with the least films and the greatest pressure themselves."""
        every = np.arange(self.zone.size)
        scales = self.touching.scales(self.loads.of_contacts)
        for _ in range(_EXTREMES):
            values = self.values(every)
            wanted = set()
            for quantity, sign in ((0, -1.0), (1, -1.0), (PRESSURE, 1.0)):
                size = sign * scales[QUANTITIES[quantity]] * np.exp(values[quantity])
                known = self.loads.scored & ~self.doubtful[quantity]
                if known.any():
                    wanted.add(int(np.argmax(np.where(known, size, -np.inf))))
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
        near = np.abs(self.places.age - self.touching.age[contact]) < _SAME
        return bool((same_zone & near).any())

    def _between_places(self) -> list[_Interval]:
        found = []
        for zone in range(len(self.positions.counts)):
            ages = np.unique(self.places.age[self.places.zone == zone])
            nothing = np.zeros(len(QUANTITIES))
            found += [_Interval(zone, float(a), float(b), nothing) for a, b in pairwise(ages)]
        return found

    def _inside(self, interval: _Interval) -> Index:
        age = self.touching.age
        inside = (age > interval.start + _SAME) & (age < interval.end - _SAME)
        return np.flatnonzero(inside & self.loads.scored & (self.zone == interval.zone))

    def _middle(self, interval: _Interval) -> int:
        """Contact nearest to the middle, or -1."""
        inside = self._inside(interval)
        if not inside.size:
            return -1
        middle = 0.5 * (interval.start + interval.end)
        return int(inside[np.argmin(np.abs(self.touching.age[inside] - middle))])

    def _choose_curves(self, contacts: Index, solved: Places, errors: Array) -> None:
        """Leave the polynomial of a zone where a curve through its positions is nearer."""
        known = self.memory.curves
        for zone in np.unique(self.zone[contacts]):
            here = self.zone[contacts] == zone
            for quantity in range(len(QUANTITIES)):
                worst = float(errors[quantity, here].max())
                if worst <= GOOD or known.get((int(zone), quantity), False):
                    continue
                trial = with_curve(self.memory, int(zone), quantity)
                age = self.touching.age[contacts[here]]
                of_curve = between(
                    self.positions, trial, self.places, age, self.zone[contacts[here]]
                )
                error = deviation(of_curve, solved.values[:, here])[quantity]
                known[int(zone), quantity] = bool(error.max() < worst)

    def _opened(self, intervals: list[_Interval], errors: Array) -> Mask:
        """Intervals with an error, and those beside them."""
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
        found = []
        for number, (interval, contact) in enumerate(pairs):
            age = float(self.touching.age[contact])
            for start, end in ((interval.start, age), (age, interval.end)):
                half = _Interval(interval.zone, start, end, errors[:, number])
                uneven = spikes and self._passes_nodes(half)
                if opened[number] or uneven or self._turns_rigid(half):
                    found.append(half)
        return found

    def _passes_nodes(self, interval: _Interval) -> bool:
        """Whether a sharp peak passes several nodes between two places: its height is uneven."""
        ends = self._ends(interval)
        nodes, drops = self.places.peak_node[ends], self.places.peak_drop[ends]
        return bool(abs(nodes[1] - nodes[0]) > 1 and drops.max() > PROMISED)

    def _turns_rigid(self, interval: _Interval) -> bool:
        """Whether the film turns rigid between both ends, so that its stiffness soars."""
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

    def _doubt(self, intervals: list[_Interval]) -> None:
        """Mark the contacts between places that are not near enough to each other."""
        for interval in intervals:
            inside = self._inside(interval)
            self.doubtful[np.ix_(interval.error > PROMISED, inside)] = True


def with_curve(memory: Memory, zone: int, quantity: int) -> Memory:
    """The same memory with a curve in one zone."""
    return replace(memory, curves={**memory.curves, (zone, quantity): True})
