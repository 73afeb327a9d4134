"""Fixed-step integration of lanes in blocks and threads, and the report of failures."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, TypeVar

import numpy as np

from tribodyn.dynamics._engine.method import Newmark, RungeKutta4
from tribodyn.dynamics._engine.statistics import Statistics
from tribodyn.dynamics.equations.compiled import Compiled
from tribodyn.dynamics.equations.divergence import Failed, chattering_step, newmark_failure, runaway
from tribodyn.dynamics.equations.lane_parameters import LaneParameters, kinds_of
from tribodyn.dynamics.equations.program import LaneRows, Program, lane_load
from tribodyn.errors import Argument, InputError
from tribodyn.interrupt import in_threads, refuse_stopped, stop_flag
from tribodyn.types import Array, Index

if TYPE_CHECKING:
    from tribodyn.dynamics._engine.running_statistics import Gathered

Value = TypeVar("Value")
Block = TypeVar("Block", bound="LaneBlock")

#: Lanes of one block. A single lane uses scalar registers; the state of several has to stay in the
#: first-level cache, which 64 lanes of a pair of gears overflow.
WIDTH = 16
#: Lanes of one block whose rows differ: these stream from memory, which more lanes do not help.
#: Fewer lanes than these are integrated one by one.
OWN_ROWS = 4
#: Steps of all lanes, times coordinates and contacts, that take a few milliseconds together.
_BRIEF = 200_000

#: Device that integrates the lanes: this processor or a graphics processor.
Backend = Literal["cpu", "cuda"]
_backend: ContextVar[Backend] = ContextVar("backend", default="cpu")


def on_gpu() -> bool:
    """Whether lanes are integrated on a graphics processor."""
    return _backend.get() == "cuda"


@contextmanager
def marching_on(backend: Backend | None) -> Iterator[None]:
    """Context in which all lanes are integrated on ``backend``; None keeps the current one."""
    if backend not in (None, "cpu", "cuda"):
        why = 'It is "cpu", or "cuda" for a graphics processor'
        raise InputError(f"backend = {backend!r}", Argument("backend"), why)
    if backend == "cuda":
        from tribodyn.dynamics._engine.generated.cuda import require_gpu

        require_gpu()
    token = _backend.set(backend or _backend.get())
    try:
        yield
    finally:
        _backend.reset(token)


@dataclass(frozen=True)
class LaneBlock:
    """Lanes that are integrated together; the last lane is repeated to fill the block."""

    index: Index
    count: int  #: lanes without repetitions

    @property
    def lanes(self) -> Index:
        """Numbers of the lanes."""
        return self.index[: self.count]


def lane_blocks(
    lanes: int, width: int | None = None, *, own_rows: bool = False, kind: Index | None = None
) -> list[LaneBlock]:
    """Divide lanes into blocks, each of lanes of one ``kind`` (lanes,)."""
    if width is None:
        width = 1 if lanes < OWN_ROWS else OWN_ROWS if own_rows else WIDTH
    every = np.arange(lanes)
    groups = [every] if kind is None else [every[kind == each] for each in np.unique(kind)]
    return [
        LaneBlock(
            group[np.minimum(np.arange(first, first + width), group.size - 1)],
            min(width, group.size - first),
        )
        for group in groups
        for first in range(0, group.size, width)
    ]


class BlockRecord:
    """The lanes of one block in a record of all."""

    def __init__(self, record: Array | None, lanes: Index, width: int) -> None:
        self._all, self._lanes = record, lanes
        covers_record = record is not None and record.shape[2] == lanes.size == width
        self.states = record
        if record is not None and not covers_record:
            self.states = np.empty((*record.shape[:2], width))

    def put(self) -> None:
        """Copy the lanes of the block into the record."""
        if self._all is not None and self.states is not None and self.states is not self._all:
            self._all[:, :, self._lanes] = self.states[:, :, : self._lanes.size]


class BlockMoments:
    """The lanes of one block in the statistics of all."""

    def __init__(self, statistics: Statistics | None, block: LaneBlock) -> None:
        self._all, self._block = statistics, block
        self.gathered: Gathered | None = None
        if statistics is not None:
            from tribodyn.dynamics._engine.running_statistics import Gathered

            waves = np.ascontiguousarray(statistics.waves).reshape(-1)
            moments = np.ascontiguousarray(statistics.moments[:, block.index]).reshape(-1)
            harmonics = statistics.waves.shape[2]
            self.gathered = Gathered(statistics.outputs, waves, harmonics, moments)

    def put(self) -> None:
        """Copy the moments of the block into the statistics."""
        if self._all is not None and self.gathered is not None:
            numbers = self.gathered.moments.reshape(-1, self._block.index.size)
            self._all.moments[:, self._block.lanes] = numbers[:, : self._block.count]


def march_blocks(
    blocks: Sequence[Block],
    state: Array,
    record: Array | None,
    march_block: Callable[[Block, Array, Array | None], Value],
    threads: int | None,
    *,
    brief: bool = False,
) -> tuple[Array, list[Value]]:
    """Integrate every block in threads; returns the new states and the value of each block."""
    new = np.empty_like(state)

    def march_lanes(block: Block) -> Value:
        part = np.ascontiguousarray(state[block.index])
        block_record = BlockRecord(record, block.lanes, block.index.size)
        value = march_block(block, part, block_record.states)
        block_record.put()
        new[block.lanes] = part[: block.count]
        return value

    return new, in_threads(march_lanes, blocks, threads or os.cpu_count() or 1, brief=brief)


def is_brief(compiled: Compiled, lanes: int, cycles: int) -> bool:
    """Whether an integration takes only milliseconds, so that nobody needs to interrupt it."""
    size = compiled.system.size + len(compiled.system.contacts)
    return lanes * cycles * compiled.grid.steps * size <= _BRIEF


def march(
    compiled: Compiled,
    period: Array,
    state: Array,
    cycles: int,
    *,
    method: RungeKutta4 | Newmark = RungeKutta4(),  # noqa: B008  # a constant tuple
    extra_force: Array | None = None,
    parameters: LaneParameters | None = None,
    record: Array | None = None,
    statistics: Statistics | None = None,
    width: int | None = None,
    threads: int | None = None,
    elapsed: int = 0,
) -> Array:
    """Integrate lanes over mesh cycles, after ``elapsed`` others; returns their new states."""
    # The caller has checked that the steps are short enough for the parameters.
    if compiled.engine is not None:
        new: Array = compiled.engine.march(period, state, cycles, extra_force, record, statistics)
        return new
    lanes = state.shape[0]
    run = Run(compiled, method, parameters, period, state, extra_force)
    if on_gpu():
        from tribodyn.dynamics._engine.generated.cuda import march_on_gpu

        new, ended = march_on_gpu(
            run.programs(np.arange(lanes)),
            run.member,
            period,
            run.load,
            state,
            cycles,
            record,
            statistics,
        )
        if ended.max() >= 0:
            lane = int(np.argmax(ended))
            run.report(LaneBlock(np.array([lane]), 1), int(ended[lane]), elapsed)
        return new
    if isinstance(method, Newmark):
        width = 1  # a block iterates until the forces of all its lanes converge
    blocks = lane_blocks(lanes, width, own_rows=bool(compiled.members), kind=run.kind)
    brief = is_brief(compiled, lanes, cycles)

    def march_lanes(block: LaneBlock, part: Array, block_record: Array | None) -> int:
        return run.march(block, part, cycles, block_record, statistics)

    new, codes = march_blocks(blocks, state, record, march_lanes, threads, brief=brief)
    if max(codes) >= 0:
        run.report(blocks[int(np.argmax(codes))], max(codes), elapsed)
    return new


class Run:
    """Lanes with all arrays that the kernel needs for each of them."""

    def __init__(
        self,
        compiled: Compiled,
        method: RungeKutta4 | Newmark,
        parameters: LaneParameters | None,
        period: Array,
        state: Array,
        extra_force: Array | None,
    ) -> None:
        lanes, double = state.shape
        self.compiled, self.method, self.period, self.state = compiled, method, period, state
        extra = np.zeros((lanes, double // 2)) if extra_force is None else extra_force
        # A lane has the terms of what it scales itself, whatever the others do.
        self.kind = np.zeros(lanes, np.int64) if parameters is None else kinds_of(parameters, lanes)
        programs = next(map(compiled.programs, np.unique(self.kind).tolist()))
        self.member = np.zeros(lanes, dtype=np.int64)
        self.scales = np.ones((lanes, 6)) if parameters is None else parameters.table(lanes)
        self.load = np.empty((lanes, double // 2))
        self.members = compiled.each(lanes)
        for number, member in enumerate(self.members):
            lane_numbers = member.lanes
            self.member[lane_numbers] = number
            self.load[lane_numbers] = lane_load(
                programs[number], member.system, extra[lane_numbers], self.scales[lane_numbers, 5]
            )
        if parameters is not None:
            self.load = np.hstack((self.load, self.scales))

    def programs(self, index: Index) -> tuple[Program, ...]:
        """Programs of all members for lanes that are integrated together."""
        return self.compiled.programs(int(np.bitwise_or.reduce(self.kind[index])))

    def march(
        self,
        block: LaneBlock,
        state: Array,
        cycles: int,
        record: Array | None = None,
        statistics: Statistics | None = None,
    ) -> int:
        """Integrate the lanes of one block; returns the code of :func:`march_block`."""
        from tribodyn.dynamics._engine.marching import march_block

        index = block.index
        programs = self.programs(index)
        program = programs[self.member[index[0]]]
        rows: Array | LaneRows = program.rows
        width, double = state.shape
        if self.compiled.members and width > 1:
            tables = [programs[number].rows for number in self.member[index]]
            rows = LaneRows.of(tables, int(program.code[2]))
        states = np.zeros((0, double, width)) if record is None else record
        sums = BlockMoments(statistics, block)
        lanes = (0.0,) * width, self.method, program, rows, self.period[index], self.load[index]
        code = march_block(*lanes, state, cycles, states, sums.gathered, stop_flag())
        sums.put()
        return refuse_stopped(int(code))

    def gather(self, block: LaneBlock, record: Array, statistics: Statistics, cycles: int) -> None:
        """Add a recorded mesh cycle of a block of lanes of one system to the statistics."""
        from tribodyn.dynamics._engine.marching import gather_record

        sums, index = BlockMoments(statistics, block), block.index
        program = self.programs(index)[self.member[index[0]]]
        lanes = (0.0,) * index.size, program, self.period[index], self.load[index]
        gather_record(*lanes, record, cycles, sums.gathered)
        sums.put()

    def report(self, block: LaneBlock, code: int, elapsed: int) -> None:
        """Raise the reason why a block failed."""
        from tribodyn.dynamics._engine.marching import CHATTERING, UNCONVERGED

        grid, several = self.compiled.grid, self.period.size > 1
        if CHATTERING <= code < UNCONVERGED:
            place, item = divmod(code - CHATTERING, block.index.size)
            contacts = len(self.compiled.system.contacts)
            cycle, number = divmod(place // contacts, grid.steps)
            lane = int(block.index[item])
            at = elapsed + cycle + float(grid.left[number])
            time, who = at * float(self.period[lane]), lane if several else None
            raise chattering_step(place % contacts, contacts, at, time, who)
        lane, before, record, last = self._again(block, code % CHATTERING)
        done = last % CHATTERING if last >= 0 else grid.steps
        member, rate = self.members[self.member[lane]], self.compiled.step_number
        phase = before + elapsed + np.append(grid.left, 1.0)
        facts = float(self.period[lane]), lane if several else None, self.scales[lane], rate
        failed = Failed(member.system, member.nodes, record[:done, :, 0], phase, *facts)
        if isinstance(self.method, Newmark):
            raise newmark_failure(failed, last >= UNCONVERGED, self.method[:3])
        raise runaway(failed, f"omega_max*dt = {rate:.3g}, limit 2.7 of the integrator")

    def _again(self, block: LaneBlock, step: int) -> tuple[int, int, Array, int]:
        """Repeat the failed lane; returns its number, cycles before, last cycle and its code."""
        # The step counted from the start is at the end of a mesh cycle. A lane integrated alone is
        # rounded differently, so that it may take a cycle more or less.
        steps = self.compiled.grid.steps
        record, last, lane = np.zeros((steps + 1, self.state.shape[1], 1)), -1, block.index[0]
        before = max((step - 1) // steps, 0)
        for lane in block.lanes:
            alone = LaneBlock(np.array([lane]), 1)
            state, before = self.state[alone.index].copy(), max((step - 1) // steps, 0)
            early = self.march(alone, state, before) if before else -1
            if early >= 0:
                before, state = max((early - 1) // steps, 0), self.state[alone.index].copy()
                if before:
                    self.march(alone, state, before)
            for _ in range(2):
                last = self.march(alone, state, 1, record)
                if last >= 0:
                    return int(lane), before, record, last
                before += 1
        return int(lane), before, record, last
