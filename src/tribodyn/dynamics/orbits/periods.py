"""Number of mesh cycles after which a motion repeats; a batch of systems over one of them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from tribodyn.arrays.memory import Memory
from tribodyn.dynamics._engine.blocks import OWN_ROWS, LaneBlock, lane_blocks
from tribodyn.dynamics._engine.method import RungeKutta4
from tribodyn.dynamics.equations.grid import Grid
from tribodyn.dynamics.equations.nodes import Nodes
from tribodyn.dynamics.equations.program import LaneRows, Program, program_of_lanes
from tribodyn.dynamics.equations.system import System
from tribodyn.dynamics.orbits.orbit_map import OrbitMap
from tribodyn.dynamics.orbits.search import (
    OrbitPoint,
    approach_orbit,
    find_orbit,
    finish_orbit,
    is_stable,
    motion_size,
)
from tribodyn.interrupt import refuse_stopped, stop_flag
from tribodyn.types import Array, Index

#: Points that differ by less than this, relative to the motion, are the same; so are points of a
#: decaying motion within the second limit that approached each other by the third.
SAME, _NEARLY, _CALMS_DOWN = 1e-5, 1e-3, 0.5
#: Points beyond this belong to a motion that grows beyond all bounds.
_HUGE = 1e100
#: Mesh cycles of the longest period that is tried.
MOST_PERIODS = 8
#: Plain mesh cycles before the periods are compared, and again if none of them is an orbit.
_MARCHED = (40, 120, 400, 1200)
#: Cycles over which a motion is compared with itself one period earlier.
_COMPARED = 2 * MOST_PERIODS
#: Newton's method is tried where the motion repeats within this part of its size.
_NEAR = 0.05
#: A motion this much larger than the unstable orbit that it left is unbounded.
_UNBOUNDED = 1e9


@dataclass
class AnyOrbit:
    """Result of the search for an orbit of any period."""

    mapping: OrbitMap  #: the map over the period of the orbit
    orbit: OrbitPoint  #: the stable orbit, or that of one mesh cycle if there is none
    accepted: bool  #: whether the orbit is stable and within the tolerance
    recurrence: Array  #: distance of the motion from itself 1 to 8 mesh cycles earlier [-]
    cycles: int  #: integrated mesh cycles in total


def shortest_period(mapping: OrbitMap, states: Array) -> int:
    """Mesh cycles after which a recorded orbit repeats: a divisor of those recorded."""
    steps, cycles = mapping.compiled.grid.steps, mapping.periods
    size = float(np.linalg.norm(mapping.coordinates.reduce(states), axis=1).max())
    return closed_period(mapping.coordinates.reduce(states[: cycles * steps : steps]), size)


def closed_period(points: Array, size: float) -> int:
    """Smallest divisor of the number of points of a closed orbit after which they repeat."""
    for period in range(1, len(points)):
        if len(points) % period == 0:
            distance = np.linalg.norm(np.roll(points, -period, axis=0) - points, axis=1)
            if distance.max() <= SAME * size:
                return period
    return len(points)


def open_period(points: Array) -> int:
    """Number of points after which a sequence repeats or converges to repeating; 0 if none."""
    largest = float(np.abs(points).max(initial=0.0))
    if not largest < _HUGE:
        return 0
    size = float(np.linalg.norm(points, axis=1).max(initial=0.0)) or 1.0
    for period in range(1, min(16, len(points) // 2) + 1):
        distance = distance_from(points, period) / size
        third = max(1, len(distance) // 3)
        first, last = float(distance[:third].max()), float(distance[-third:].max())
        if last <= SAME or (last <= _NEARLY and last <= _CALMS_DOWN * first):
            return period
    return 0


def distance_from(points: Array, period: int) -> Array:
    """Distances of points from those ``period`` earlier."""
    return np.asarray(np.linalg.norm(points[period:] - points[:-period], axis=1))


def _march(mapping: OrbitMap, y: Array, cycles: int) -> tuple[Array, Array]:
    """Integrate mesh cycles; returns the last points and the last point."""
    points: list[Array] = []
    for _ in range(cycles):
        y = mapping(y)
        points.append(y)
    return np.array(points[-(_COMPARED + MOST_PERIODS) :]), y


def _recurrence(points: Array) -> Array:
    """Largest distance of a motion from itself 1 to 8 mesh cycles earlier, over its size."""
    spread = np.linalg.norm(points, axis=1).max() or 1.0
    return np.array(
        [
            distance_from(points, count)[-_COMPARED:].max() / spread
            for count in range(1, MOST_PERIODS + 1)
        ]
    )


def _finish(
    first: OrbitMap, periods: int, y: Array, tolerance: float, start_periods: int = 1
) -> tuple[OrbitMap, OrbitPoint]:
    """Newton's method over several mesh cycles, from a vector of the map over ``start_periods``."""
    mapping = first.over(periods)
    return mapping, finish_orbit(mapping, mapping.rescaled(y, start_periods), tolerance)


def find_any_orbit(first: OrbitMap, y: Array, tolerance: float) -> AnyOrbit:
    """Search for a stable orbit of 1 to 8 mesh cycles, the shortest that the motion approaches."""
    if first.affine:
        orbit = finish_orbit(first, y, tolerance)
        return AnyOrbit(first, orbit, is_stable(orbit, tolerance), np.zeros(0), first.cycles)
    start, size = y, motion_size(first, first.follow(y)[1])
    attractor, y = approach_orbit(first, y, tolerance)
    if attractor is not None:
        return AnyOrbit(first, attractor, True, np.zeros(0), first.cycles)
    recurrence, cycles = np.zeros(0), 0
    for count in _MARCHED:
        points, y = _march(first, y, count)
        if not np.linalg.norm(y) < _UNBOUNDED * size:
            recurrence = np.full(MOST_PERIODS, np.inf)
            break
        recurrence = _recurrence(points)
        for periods in np.flatnonzero(recurrence <= _NEAR) + 1:
            mapping, trial = _finish(first, int(periods), y, tolerance)
            cycles += mapping.cycles
            if is_stable(trial, tolerance):
                count = shortest_period(mapping, mapping.record(trial.point)[0])
                if count < periods:
                    mapping, trial = _finish(first, count, trial.point, tolerance, int(periods))
                    cycles += mapping.cycles
                trial.search = first.cycles + cycles - mapping.cycles
                return AnyOrbit(mapping, trial, True, recurrence, first.cycles + cycles)
    orbit = find_orbit(first, start, tolerance, patience=())
    return AnyOrbit(first, orbit, is_stable(orbit, tolerance), recurrence, first.cycles + cycles)


#: Systems of a batch: for fewer the kernel of blocks is not compiled.
_MANY = 8


class BatchedLanes(NamedTuple):
    """One motion of each system of a batch; several are lanes of one block."""

    program: Program  #: without rows, with constant loads (p, n)
    rows: list[LaneRows]  #: of every block
    blocks: list[LaneBlock]
    memory: Memory

    @classmethod
    def of(cls, system: System, grid: Grid, nodes: Nodes, memory: Memory) -> BatchedLanes:
        """Lanes of a batch of systems on a grid."""
        count = len(nodes.stiffness)
        blocks = lane_blocks(count, OWN_ROWS if count >= _MANY else 1)
        lanes = [block.index for block in blocks]
        flat = program_of_lanes(system, grid, nodes, lanes, memory)
        return cls(*flat, blocks, memory)

    def coarsened(self, grid: Grid) -> BatchedLanes:
        """The same batch on the grid with full steps instead of their halves."""
        program = self.program._replace(width=grid.width, restart=grid.after_event)
        rows = [rows.full_steps() for rows in self.rows]
        return self._replace(program=program, rows=rows)

    def each_alone(self) -> Iterator[Program]:
        """Yield the programs of all systems with their rows, which share one array."""
        program, places = self.program, self.rows[0].places
        steps, columns, width = program.width.size, int(program.code[2]), self.blocks[0].index.size
        table = self.memory("alone", (steps, 3, columns))
        constant = np.full(columns, np.nan)
        for rows, block in zip(self.rows, self.blocks, strict=True):
            firsts = rows.first.reshape(columns, width).T.copy()
            firsts[:, places] = 0.0
            cells = rows.varying.reshape(steps, 3, places.size, width)
            varying = np.ascontiguousarray(cells.transpose(3, 2, 0, 1))
            for lane, number in enumerate(block.lanes):
                for place in np.flatnonzero(firsts[lane] != constant):
                    table[:, :, place] = firsts[lane, place]
                constant = firsts[lane]
                for place, values in zip(places, varying[lane], strict=True):
                    table[:, :, place] = values
                load = program.constant_load[number]
                yield program._replace(rows=table.reshape(-1), constant_load=load)

    def march(
        self, period: Array, load: Array, state: Array, which: Index
    ) -> Iterator[tuple[int, Array]]:
        """Yield motions (rows, 2 n, 1) of some systems from states (p, 1, 2 n); NaN if one ends."""
        wanted = np.zeros(len(period), dtype=bool)
        wanted[which] = True
        for rows, block in zip(self.rows, self.blocks, strict=True):
            requested = wanted[block.index]
            if not requested.any():
                continue
            # A lane that is not requested repeats one that is.
            lanes = np.where(requested, np.arange(requested.size), int(np.argmax(requested)))
            lane_arrays = block.index, period, load, state
            record = self._marched("record 0", rows, lanes, *lane_arrays)
            for lane in np.flatnonzero(requested[: block.count]):
                lane_record = record[..., lane : lane + 1]
                if np.isnan(lane_record[0, 0, 0]):  # some lane ended, and the block with it
                    again = np.full(requested.size, lane)
                    lane_record = self._marched("again", rows, again, *lane_arrays)[..., :1]
                yield int(block.index[lane]), lane_record

    def _marched(
        self,
        name: str,
        rows: LaneRows,
        lanes: Index,
        index: Index,
        period: Array,
        load: Array,
        state: Array,
    ) -> Array:
        """States (rows, 2 n, lanes) of lanes of a block; NaN if any of them ends."""
        numbers, program = index[lanes], self.program
        program = program._replace(constant_load=program.constant_load[0])
        block_rows: Array | LaneRows = rows
        record = self.memory(name, (program.width.size + 1, 2 * int(program.code[0]), lanes.size))
        if lanes.size == 1:
            block_rows = rows.table(program.width.size)
        elif np.any(np.diff(lanes) != 1):
            block_rows = rows.take(lanes, lanes.size)
        march_cycle(program, block_rows, period[numbers], load[numbers], state[numbers, 0], record)
        return record


def march_cycle(
    program: Program,
    rows: Array | LaneRows,
    period: Array,
    load: Array,
    start: Array,
    record: Array,
) -> Array:
    """Integrate a block over a mesh cycle; returns the last states (lanes, 2 n).

    ``record`` receives the first items of the states. All are NaN if any lane ends early.
    """
    from tribodyn.dynamics._engine.marching import march_block

    state = np.array(start)
    lanes = (0.0,) * len(state), RungeKutta4(), program, rows, period, load
    code = refuse_stopped(int(march_block(*lanes, state, 1, record, None, stop_flag())))
    if code >= 0:
        record[:] = state[:] = np.nan
    return state
