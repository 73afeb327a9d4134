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

#: Points that differ by less than this, relative to the motion, are the same; those that still
#: approach each other are when this near and so much nearer than at first.
SAME, _NEARLY, _CALMS_DOWN = 1e-5, 1e-3, 0.5
#: Points beyond this are on their way beyond all bounds.
_HUGE = 1e100
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
    size = float(np.linalg.norm(mapping.coordinates.reduce(states), axis=1).max())
    return closed_period(mapping.coordinates.reduce(states[: whole * steps : steps]), size)


def closed_period(points: Array, size: float) -> int:
    """Least divisor of the points of a closed orbit after which they come again."""
    for period in range(1, len(points)):
        if len(points) % period == 0:
            apart = np.linalg.norm(np.roll(points, -period, axis=0) - points, axis=1)
            if apart.max() <= SAME * size:
                return period
    return len(points)


def open_period(points: Array, longest: int = 16) -> int:
    """Points after which a sequence repeats, or comes nearer to doing so; 0 if none."""
    largest = float(np.abs(points).max(initial=0.0))
    if not largest < _HUGE:
        return 0
    size = float(np.linalg.norm(points, axis=1).max(initial=0.0)) or 1.0
    for period in range(1, min(longest, len(points) // 2) + 1):
        apart = distance_from(points, period) / size
        third = max(1, len(apart) // 3)
        first, last = float(apart[:third].max()), float(apart[-third:].max())
        if last <= SAME or (last <= _NEARLY and last <= _CALMS_DOWN * first):
            return period
    return 0


def distance_from(points: Array, period: int) -> Array:
    """Distances of points from those ``period`` earlier."""
    return np.asarray(np.linalg.norm(points[period:] - points[:-period], axis=1))


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
            distance_from(points, count)[-_COMPARED:].max() / spread
            for count in range(1, MOST_PERIODS + 1)
        ]
    )


def _stable(orbit: OrbitPoint, tolerance: float) -> bool:
    return orbit.error <= tolerance and orbit.attracts


def _finish(
    first: OrbitMap, periods: int, y: Array, tolerance: float, given: int = 1
) -> tuple[OrbitMap, OrbitPoint]:
    """Newton's method over several mesh cycles, from a vector of the map over ``given``."""
    mapping = first.over(periods)
    return mapping, finish_orbit(mapping, mapping.rescaled(y, given), tolerance)


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
