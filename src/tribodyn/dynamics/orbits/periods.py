"""The number of mesh cycles after which a motion repeats, found by trying."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tribodyn.dynamics.orbits.orbit_map import OrbitMap
from tribodyn.dynamics.orbits.search import (
    OrbitPoint,
    approach_orbit,
    find_orbit,
    finish_orbit,
    motion_size,
)
from tribodyn.types import Array

#: States one period apart that differ by less than this part of the motion are the same.
_REPEATS = 1e-5
#: Mesh cycles of the longest period that is tried.
MOST_PERIODS = 8
#: Plain mesh cycles before the periods are compared, and again if none of them is an orbit.
_MARCHED = (40, 120, 400, 1200)
#: Cycles over which a motion is compared with itself one period earlier.
_COMPARED = 2 * MOST_PERIODS
#: Newton's method is tried where the motion has this little left to repeat.
_NEAR = 0.05
#: A motion this much larger than the unstable orbit that it left is not held by anything.
_UNBOUNDED = 1e9


@dataclass
class AnyOrbit:
    """What was found."""

    mapping: OrbitMap  #: the map over as many mesh cycles as the orbit has
    orbit: OrbitPoint  #: the stable orbit, or that of one mesh cycle if there is none
    found: bool  #: whether the orbit is stable and within the tolerance
    apart: Array  #: [-]
    cycles: int  #: mesh cycles marched in all


def shortest_period(mapping: OrbitMap, states: Array) -> int:
    """Mesh cycles after which a recorded orbit repeats: a divisor of those recorded."""
    steps, whole = mapping.compiled.grid.steps, mapping.periods
    reduced = mapping.coordinates.reduce(states[: whole * steps : steps])
    size = max(float(np.linalg.norm(mapping.coordinates.reduce(states), axis=1).max()), 1e-300)
    for count in range(1, whole):
        apart = np.linalg.norm(np.roll(reduced, count, axis=0) - reduced, axis=1).max()
        if whole % count == 0 and apart <= _REPEATS * size:
            return count
    return whole


def _march(mapping: OrbitMap, y: Array, cycles: int) -> tuple[Array, Array]:
    """March plain mesh cycles; returns the last points and the last point."""
    kept: list[Array] = []
    for _ in range(cycles):
        y = mapping(y)
        kept.append(y)
    return np.array(kept[-(_COMPARED + MOST_PERIODS) :]), y


def _apart(points: Array) -> Array:
    """Largest distance of a motion from itself 1 to 8 mesh cycles earlier, over its size."""
    spread = np.linalg.norm(points, axis=1).max() or 1.0
    return np.array(
        [
            np.linalg.norm(points[count:] - points[:-count], axis=1)[-_COMPARED:].max() / spread
            for count in range(1, MOST_PERIODS + 1)
        ]
    )


def _stable(orbit: OrbitPoint, tolerance: float) -> bool:
    return orbit.error <= tolerance and orbit.attracts


def _finish(
    first: OrbitMap, periods: int, y: Array, tolerance: float, given: int = 1
) -> tuple[OrbitMap, OrbitPoint]:
    """Newton's method over several mesh cycles, from a vector of the map over ``given``."""
    mapping = OrbitMap(first.compiled, 1.0 / first.period, periods, first.coordinates, first.width)
    y = y.copy()
    if mapping.balance is not None:
        # The last number is the speed that the balancing torque gives within the period.
        y[-1] *= periods / given
    return mapping, finish_orbit(mapping, y, tolerance)


def find_any_orbit(first: OrbitMap, y: Array, tolerance: float) -> AnyOrbit:
    """Look for a stable orbit of 1 to 8 mesh cycles, the shortest that the motion approaches."""
    if first.affine:
        orbit = finish_orbit(first, y, tolerance)
        return AnyOrbit(first, orbit, _stable(orbit, tolerance), np.zeros(0), first.cycles)
    start, size = y, motion_size(first, first.follow(y)[1])
    known, y = approach_orbit(first, y, tolerance)
    if known is not None:
        return AnyOrbit(first, known, True, np.zeros(0), first.cycles)
    apart, cycles = np.zeros(0), 0
    for count in _MARCHED:
        points, y = _march(first, y, count)
        if not np.linalg.norm(y) < _UNBOUNDED * size:
            apart = np.full(MOST_PERIODS, np.inf)
            break
        apart = _apart(points)
        for periods in np.flatnonzero(apart <= _NEAR) + 1:
            mapping, trial = _finish(first, int(periods), y, tolerance)
            cycles += mapping.cycles
            if _stable(trial, tolerance):
                count = shortest_period(mapping, mapping.record(trial.point)[0])
                if count < periods:
                    mapping, trial = _finish(first, count, trial.point, tolerance, int(periods))
                    cycles += mapping.cycles
                trial.search = first.cycles + cycles - mapping.cycles
                return AnyOrbit(mapping, trial, True, apart, first.cycles + cycles)
    orbit = find_orbit(first, start, tolerance, patience=())
    return AnyOrbit(first, orbit, _stable(orbit, tolerance), apart, first.cycles + cycles)
