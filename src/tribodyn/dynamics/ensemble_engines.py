"""Ensembles with the engines whose kernels gather no statistics: block by block, in threads.

A block of lanes is marched to the last mesh cycles; these are recorded one at a time, so that
room is needed for one cycle of each block that marches at the moment.
"""

from __future__ import annotations

import os
from collections.abc import Callable

import numpy as np

from tribodyn.dynamics.dormand_prince import AdaptiveEngine, adaptive_engine
from tribodyn.dynamics.dormand_prince_tolerance import Tolerance
from tribodyn.dynamics.ensemble_moments import RecordedLanes, add_moments
from tribodyn.dynamics.lane_parameters import LaneParameters
from tribodyn.dynamics.march import Compiled, Member
from tribodyn.dynamics.newmark_engine import newmark_engine
from tribodyn.dynamics.newmark_limit import refuse_newmark
from tribodyn.interrupt import in_threads
from tribodyn.types import Array, Index

#: Marches the lanes of one block by some mesh cycles, after others, records them, and returns the
#: new state.
_Advance = Callable[[Array, int, Array | None, int], Array]

#: Lanes of one block, and the tolerance of the contact forces.
_WIDTH, _TOLERANCE = 16, 1e-12


class Block:
    """Lanes that march side by side the same system."""

    def __init__(self, member: Member, lanes: Index, advance: _Advance) -> None:
        self.member, self.lanes, self.advance = member, lanes, advance


def _members(compiled: Compiled, lanes: int) -> tuple[Member, ...]:
    return compiled.members or (Member(compiled.system, compiled.nodes, np.arange(lanes)),)


def newmark_blocks(
    compiled: Compiled,
    period: Array,
    extra_force: Array,
    parameters: LaneParameters | None,
    gamma: float,
    beta: float,
) -> list[Block]:
    """Blocks that march by Newmark's scheme."""
    refuse_newmark(compiled, period, gamma, beta, parameters)
    engine = newmark_engine(compiled, np.array([gamma, beta, _TOLERANCE]), parameters)
    scales = None if parameters is None else parameters.table(period.size)
    members = _members(compiled, period.size)

    def build(number: int, lanes: Index) -> Block:
        called = lanes if period.size > 1 else None

        def advance(state: Array, cycles: int, record: Array | None, elapsed: int) -> Array:
            return engine.march(
                period[lanes], state, cycles, extra_force=extra_force[lanes],
                scales=None if scales is None else scales[lanes], record=record, member=number,
                numbers=called, threads=1, elapsed=elapsed,
            )  # fmt: skip

        return Block(members[number], lanes, advance)

    return [build(number, lanes) for number, lanes in engine.blocks(period.size)]


def adaptive_blocks(
    compiled: Compiled,
    period: Array,
    cycles: int,
    extra_force: Array,
    parameters: LaneParameters | None,
    rtol: float,
    atol: Tolerance | None,
) -> list[Block]:
    """Blocks that march in adaptive steps."""
    scales = np.ones((period.size, 6)) if parameters is None else parameters.table(period.size)
    found = []
    for member in _members(compiled, period.size):
        engine = adaptive_engine(
            member.system, 1.0 / period[member.lanes], cycles, rtol=rtol, atol=atol,
            parameters=parameters,
        )  # fmt: skip

        def build(lanes: Index, member: Member = member, engine: AdaptiveEngine = engine) -> Block:
            memory: list[Array | None] = [None]

            def advance(state: Array, cycles: int, record: Array | None, elapsed: int) -> Array:
                run = engine.march(
                    period[lanes], state, cycles, extra_force=extra_force[lanes],
                    points=compiled.grid.left, record=record, memory=memory[0], threads=1,
                    scales=scales[lanes], numbers=lanes if period.size > 1 else None,
                    width=1 if lanes.size == 1 else _WIDTH, elapsed=elapsed,
                )  # fmt: skip
                memory[0] = run.memory
                return np.asarray(run.state)

            return Block(member, lanes, advance)

        found += [build(member.lanes[at : at + _WIDTH])
                  for at in range(0, member.lanes.size, _WIDTH)]  # fmt: skip
    return found


def march_blocks(
    compiled: Compiled,
    blocks: list[Block],
    state: Array,
    cycles: int,
    take: Callable[[Block, Array], None] | None,
    threads: int | None,
    elapsed: int = 0,
) -> Array:
    """March all blocks; where somebody takes them, mesh cycle by mesh cycle with their records."""
    new = np.empty_like(state)

    def march(block: Block) -> None:
        part = state[block.lanes]
        if take is None:
            new[block.lanes] = block.advance(part, cycles, None, elapsed)
            return
        record = np.empty((compiled.grid.steps + 1, state.shape[1], block.lanes.size))
        for cycle in range(cycles):
            part = block.advance(part, 1, record, elapsed + cycle)
            take(block, record)
        new[block.lanes] = part

    threads = threads or os.cpu_count() or 1
    in_threads(march, blocks, threads)
    return new


def moments_taker(
    compiled: Compiled,
    period: Array,
    extra_force: Array,
    parameters: LaneParameters | None,
    outputs: Array,
    waves: Array,
    share: float,
    moments: Array,
) -> Callable[[Block, Array], None]:
    """Make what adds recorded mesh cycles to the moments of all lanes."""
    scales = np.ones((period.size, 6)) if parameters is None else parameters.table(period.size)

    def take(block: Block, record: Array) -> None:
        own, lanes = moments[:, block.lanes], block.lanes
        cycle = RecordedLanes(
            block.member, compiled.grid, period[lanes], extra_force[lanes], scales[lanes], record
        )
        add_moments(cycle, outputs, waves, share, own)
        moments[:, lanes] = own

    return take
