"""Places along the path of contact at which the film is solved, and what lies between them.

The load of a tooth pair jumps where another pair enters or leaves, and its friction turns round at
the pitch point. Between two such places everything is smooth: each zone has the Gauss-Lobatto
points of its own, both ends included, and the polynomial through them is nearly the best one.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from tribodyn.contact import PathOfContact
from tribodyn.errors import require_between
from tribodyn.types import Array, Index

#: Number of positions that can be asked for.
LEAST, MOST = 8, 200
#: A zone with fewer points is not worth a polynomial.
_LEAST_IN_ZONE = 4
#: Zones narrower than this are rounding [mesh cycles].
_ROUNDING = 1e-9
#: A bend this near to an edge is left to it [mesh cycles].
_NARROW = 0.01
#: Distance from the end of a zone that tells its two sides apart [mesh cycles].
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
        found = np.zeros(age.shape + values.shape[1:])
        for number, part in enumerate(self.zones):
            here = zone == number
            matrix = lobatto_polynomial(self.age[part], age[here])
            found[here] = np.tensordot(matrix, values[part], axes=(1, 0))
        return found


def lobatto_points(count: int) -> Array:
    """Gauss-Lobatto points of Chebyshev between -1 and 1, rising."""
    return np.asarray(-np.cos(np.pi * np.arange(count) / (count - 1)))


def lobatto_polynomial(knots: Array, at: Array) -> Array:
    """Weights of the values at Gauss-Lobatto points in the polynomial through them.

    Parameters
    ----------
    knots : array (count,)
        Points of :func:`lobatto_points`, shifted and scaled.
    at : array (m,)
        Where the polynomial is evaluated.

    Returns
    -------
    array (m, count)

    Notes
    -----
    Source: barycentric formula, Berrut and Trefethen (2004).
    """
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
    found = [0.0, ratio]
    for number in range(1, contact.pairs):
        found += [float(number), ratio - number]
    pitch_point = contact.direction * (contact.C - contact.A) / contact.pair.base_pitch
    found.append(pitch_point)
    for number in range(contact.pairs):
        wide = [number + bend for bend in bends]
        found += [age for age in wide if np.min(np.abs(np.array(found) - age)) > _NARROW]
    edges = [0.0]
    for edge in sorted(edge for edge in found if 0.0 < edge <= ratio):
        if edge - edges[-1] > _ROUNDING:
            edges.append(edge)
    edges[-1] = ratio
    return PathPositions(tuple(edges), _shares(np.diff(edges), int(positions)))


def _shares(lengths: Array, total: int) -> tuple[int, ...]:
    """Whole numbers in proportion to the lengths, at least four each, by the largest remainder."""
    free = np.maximum(total * lengths / lengths.sum(), _LEAST_IN_ZONE)
    wide = free > _LEAST_IN_ZONE
    room = total - _LEAST_IN_ZONE * int(np.sum(~wide))
    if not np.any(wide) or room < _LEAST_IN_ZONE * int(np.sum(wide)):
        return (_LEAST_IN_ZONE,) * lengths.size
    wanted = np.where(wide, room * lengths / lengths[wide].sum(), _LEAST_IN_ZONE)
    counts = np.maximum(np.floor(wanted), _LEAST_IN_ZONE).astype(int)
    for index in np.argsort(counts - wanted)[: max(total - int(counts.sum()), 0)]:
        counts[index] += 1
    return tuple(int(count) for count in counts)
