"""Places on the path of contact where the film is solved, and what lies between them.

The positions of a zone carry a polynomial. Where a further solution beside it shows that it is not
good enough, more contacts are solved: in between, the remainder is followed linearly, or, where
the load bends and the polynomial swings, a monotone curve goes through all places.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from tribodyn.ehl.steady.solved_films import Films
from tribodyn.mesh.positions import PathPositions
from tribodyn.mesh.touching import Touching
from tribodyn.types import Array, Index, Mask

#: What is interpolated, in this order; the last as compliance, which has no pole.
QUANTITIES = ("central_film", "minimum_film", "film_pressure", "film_stiffness")
PRESSURE, STIFFNESS = 2, 3
ALL = (0, 1, 2, 3)
#: Compliance over its estimate below which a film counts as rigid: its stiffness has a bound.
RIGID = 1e-3
#: Error of a value between the places above which more of them are solved, and what is promised.
GOOD, PROMISED = 0.006, 0.02
#: Difference of logarithms beyond which more is as bad.
_FAR = 20.0


class Places(NamedTuple):
    """Solved contacts: the positions first, then those of the mesh table that were added."""

    age: Array
    zone: Index
    load_per_width: Array
    values: Array
    peak_node: Index
    peak_drop: Array
    yielding: Mask  #: whether the stiffness of the film is taken from here too

    def joined(self, others: Places) -> Places:
        """Both together."""
        return Places(*(np.concatenate(pair, axis=-1) for pair in zip(self, others, strict=True)))


@dataclass(eq=False)
class Memory:
    """What the solutions before have shown, so that the next ones begin with it."""

    contacts: Index = field(default_factory=lambda: np.zeros(0, dtype=np.int64))
    yielding: Mask = field(default_factory=lambda: np.zeros(0, dtype=bool))
    curves: dict[tuple[int, int], bool] = field(default_factory=dict)

    def add(self, contacts: Index, yielding: Mask) -> None:
        """Keep contacts, and whether the stiffness of their films is needed."""
        self.contacts = np.concatenate([self.contacts, contacts])
        self.yielding = np.concatenate([self.yielding, yielding])


def places_of(touching: Touching, zone: Index, load: Array, films: Films, yielding: Mask) -> Places:
    """Solved films over their scales, as logarithms, and where their pressure is greatest."""
    scales = touching.scales(load)
    values = [np.log(getattr(films, name) / scales[name]) for name in QUANTITIES[:STIFFNESS]]
    # The compliance and not the stiffness, which has a pole where the compliance is zero.
    values.append(scales["film_stiffness"] / np.asarray(films.film_stiffness))
    peaks = [_peak(solution.pressure) for solution in films.solutions]
    node, drop = np.array(peaks).reshape(-1, 2).T
    return Places(touching.age, zone, load, np.stack(values), node.astype(np.int64), drop, yielding)


def _peak(pressure: Array) -> tuple[int, float]:
    """Node of the greatest pressure, and how far it falls to its neighbours."""
    node = int(np.clip(np.argmax(pressure), 1, pressure.size - 2))
    before, most, after = pressure[node - 1 : node + 2]
    return node, float((2.0 * most - before - after) / (2.0 * most))


def between(
    positions: PathPositions, memory: Memory, places: Places, age: Array, zone: Index
) -> Array:
    """Values (4, m) at other ages."""
    count = positions.age.size
    base = places.values[:, :count].T
    found = positions.interpolate(base, age, zone).T
    rest = places.values - positions.interpolate(base, places.age, places.zone).T
    added = np.arange(places.age.size) >= count
    for number, quantity in np.ndindex(len(positions.counts), len(QUANTITIES)):
        here, near = zone == number, places.zone == number
        if quantity == STIFFNESS:
            # Where only the pressure was in doubt the stiffness is left as it was.
            near &= ~added | places.yielding
        if memory.curves.get((number, quantity), False):
            found[quantity, here] = _curve(
                places.age[near], places.values[quantity, near], age[here]
            )
        elif (near & added).any():
            order = np.flatnonzero(near)[np.argsort(places.age[near])]
            found[quantity, here] += np.interp(age[here], places.age[order], rest[quantity, order])
    return found


def _curve(knots: Array, values: Array, age: Array) -> Array:
    """Monotone cubic through the places of a zone."""
    from scipy.interpolate import PchipInterpolator

    at, first = np.unique(knots, return_index=True)
    return np.asarray(PchipInterpolator(at, values[first])(age))


def deviation(expected: Array, solved: Array) -> Array:
    """Relative error of each quantity (4, m); films that do not yield all count as rigid."""
    error = np.abs(np.expm1(np.clip(expected - solved, -_FAR, _FAR)))
    yielding, solved_yielding = (np.maximum(v[STIFFNESS], RIGID) for v in (expected, solved))
    error[STIFFNESS] = np.abs(solved_yielding / yielding - 1.0)
    return np.asarray(error)
