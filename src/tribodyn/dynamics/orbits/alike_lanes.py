"""Systems alike marched over one mesh cycle: side by side, or one after the other with its rows."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from tribodyn.arrays.workspace import Memory
from tribodyn.dynamics._engine.blocks import LaneBlock, lane_blocks
from tribodyn.dynamics._engine.method import RungeKutta4
from tribodyn.dynamics.equations.grid import Grid
from tribodyn.dynamics.equations.nodes import Nodes
from tribodyn.dynamics.equations.program import LaneRows, Program, program_of_lanes
from tribodyn.dynamics.equations.system import System
from tribodyn.interrupt import refuse_stopped, stop_flag
from tribodyn.types import Array, Index

#: Systems that march side by side: fewer are no reason to compile that.
_MANY = 8


class AlikeLanes(NamedTuple):
    """One motion of each of systems alike, several side by side as lanes of a block."""

    program: Program  #: without rows, with constant loads (p, n)
    rows: list[LaneRows]  #: of every block
    blocks: list[LaneBlock]
    room: Memory

    @classmethod
    def of(cls, system: System, grid: Grid, nodes: Nodes, room: Memory) -> AlikeLanes:
        """Lanes of systems alike on a grid."""
        count = len(nodes.stiffness)
        blocks = lane_blocks(count, _MANY if count >= _MANY else 1)
        lanes = [block.index for block in blocks]
        flat = program_of_lanes(system, grid, nodes, lanes, room)
        return cls(*flat, blocks, room)

    def every_other(self, grid: Grid) -> AlikeLanes:
        """The same on the grid of which this one has the halves."""
        program = self.program._replace(width=grid.width, restart=grid.after_event)
        rows = [rows.whole() for rows in self.rows]
        return self._replace(program=program, rows=rows)

    def each_alone(self) -> Iterator[Program]:
        """Programs of all systems, with their rows, each in the memory of the one before."""
        program, places = self.program, self.rows[0].places
        steps, columns, width = program.width.size, int(program.code[2]), self.blocks[0].index.size
        table = self.room("alone", (steps, 3, columns))
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
        """Motions (rows, 2 n, 1) of some systems from states (p, 1, 2 n); NaN where one ends."""
        wanted = np.zeros(len(period), dtype=bool)
        wanted[which] = True
        for rows, block in zip(self.rows, self.blocks, strict=True):
            asked = wanted[block.index]
            if not asked.any():
                continue
            # A lane that is not asked for marches with one that is.
            lanes = np.where(asked, np.arange(asked.size), int(np.argmax(asked)))
            given = block.index, period, load, state
            record = self._marched("record 0", rows, lanes, *given)
            for lane in np.flatnonzero(asked[: block.count]):
                own = record[..., lane : lane + 1]
                if np.isnan(own[0, 0, 0]):  # some lane ended, and the block with it
                    again = np.full(asked.size, lane)
                    own = self._marched("again", rows, again, *given)[..., :1]
                yield int(block.index[lane]), own

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
        own: Array | LaneRows = rows
        memory = self.room(name, (program.width.size + 1, 2 * int(program.code[0]), lanes.size))
        if lanes.size == 1:
            own = rows.table(program.width.size)
        elif np.any(np.diff(lanes) != 1):
            own = rows.take(lanes, lanes.size)
        march_cycle(program, own, period[numbers], load[numbers], state[numbers, 0], memory)
        return memory


def march_cycle(
    program: Program,
    rows: Array | LaneRows,
    period: Array,
    load: Array,
    start: Array,
    record: Array,
) -> Array:
    """Last states (lanes, 2 n) of a block over a mesh cycle, whose first items are recorded.

    NaN if any lane ends.
    """
    from tribodyn.dynamics._engine.marching import march_block

    state = np.array(start)
    lanes = (0.0,) * len(state), RungeKutta4(), program, rows, period, load
    code = refuse_stopped(int(march_block(*lanes, state, 1, record, None, stop_flag())))
    if code >= 0:
        record[:] = state[:] = np.nan
    return state
