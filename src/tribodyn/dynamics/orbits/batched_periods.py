"""Integrate a batch of systems over one mesh cycle, as lanes of a block or one after the other."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from tribodyn.arrays.memory import Memory
from tribodyn.dynamics._engine.blocks import LaneBlock, lane_blocks
from tribodyn.dynamics._engine.method import RungeKutta4
from tribodyn.dynamics.equations.grid import Grid
from tribodyn.dynamics.equations.nodes import Nodes
from tribodyn.dynamics.equations.program import LaneRows, Program, program_of_lanes
from tribodyn.dynamics.equations.system import System
from tribodyn.interrupt import refuse_stopped, stop_flag
from tribodyn.types import Array, Index

#: Systems in one block of lanes: for fewer the kernel is not compiled.
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
        blocks = lane_blocks(count, _MANY if count >= _MANY else 1)
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
