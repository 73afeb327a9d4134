"""From a compiled system to marched lanes: blocks, threads, and a step that is stable."""

from __future__ import annotations

import os
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.dynamics.divergence import report_divergence
from tribodyn.dynamics.grid import Grid
from tribodyn.dynamics.lane_parameters import LaneParameters
from tribodyn.dynamics.program import Nodes, Program, build_program, compile_system, lane_load
from tribodyn.dynamics.step_limit import refuse_unstable_lanes, refuse_unstable_step
from tribodyn.dynamics.system import System
from tribodyn.dynamics.unparted import unparted_step
from tribodyn.errors import InputError, Problem, require_positive
from tribodyn.interrupt import in_threads, refuse_stopped, stop_flag
from tribodyn.types import Array, Index, Mask

#: Lanes of one block. A single lane keeps everything in scalar registers; the state of many has to
#: stay in the first cache, which 64 lanes of a pair of gears overflow.
_WIDTHS = (1, 16)
#: Lanes of one block whose rows differ: these stream from memory, which more lanes do not help.
_OWN_ROWS = 4
#: Steps of all lanes, times coordinates and contacts, that take a few milliseconds together.
_BRIEF = 200_000


@dataclass(frozen=True)
class Member:
    """One of several systems on a common grid, with the lanes that march it."""

    system: System
    nodes: Nodes
    lanes: Index  #: numbers of its lanes


@dataclass(frozen=True)
class Compiled:
    """A system on its grid, checked for one highest step size."""

    system: System
    grid: Grid
    nodes: Nodes
    program: Program
    step_number: float  #: ``omega_max * dt`` of the slowest mesh frequency [-]
    members: tuple[Member, ...] = ()  #: systems of the lanes where these differ
    parameters: LaneParameters | None = None  #: factors of the lanes for which the step was checked
    _programs: dict[tuple[bool, bool], tuple[Program, ...]] = field(
        default_factory=dict, init=False, repr=False, compare=False
    )

    def programs(self, parameters: LaneParameters | None = None) -> tuple[Program, ...]:
        """Programs of all members, or of the one system, all with the same terms."""
        scaled = parameters is not None and parameters.scales_contacts
        split = parameters is not None and parameters.scales_friction
        if not (scaled or split or self.members):
            return (self.program,)
        if (scaled, split) not in self._programs:
            pairs = [(one.system, one.nodes) for one in self.members]
            pairs = pairs or [(self.system, self.nodes)]

            def build(pattern: Mask | None) -> tuple[Program, ...]:
                return tuple(
                    build_program(pair[0], self.grid, pair[1], scaled=scaled, split=split,
                                  pattern=pattern)
                    for pair in pairs
                )  # fmt: skip

            made = build(None)
            if len(made) > 1:
                made = build(np.any([one.pattern for one in made], axis=0))
            self._programs[scaled, split] = made
        return self._programs[scaled, split]


def compile_for(
    system: System,
    mesh_frequency: ArrayLike,
    steps: int,
    parameters: LaneParameters | None = None,
) -> Compiled:
    """Compile a system and refuse a step that the integrator cannot follow."""
    require_positive("mesh_frequency", mesh_frequency, "Hz")
    if int(steps) != steps or steps < 1:
        raise InputError(
            Problem(what=f"steps = {steps}", where="argument steps", why="A whole number >= 1")
        )
    grid, nodes, program = compile_system(system, int(steps))
    beat = np.atleast_1d(np.asarray(mesh_frequency, dtype=float))
    if parameters is None:
        number = refuse_unstable_step(system, nodes, grid, float(beat.min()))
    else:
        number = refuse_unstable_lanes(system, nodes, grid, beat, parameters)
    return Compiled(system, grid, nodes, program, number, parameters=parameters)


def march(
    compiled: Compiled,
    period: Array,
    state: Array,
    cycles: int,
    *,
    extra_force: Array | None = None,
    parameters: LaneParameters | None = None,
    record: Array | None = None,
    outputs: Array | None = None,
    waves: Array | None = None,
    moments: Array | None = None,
    width: int | None = None,
    threads: int | None = None,
    any_step: bool = False,
    elapsed: int = 0,
) -> Array:
    """March lanes by whole mesh cycles; returns their new state."""
    lanes = state.shape[0]
    if not any_step and parameters is not None and parameters is not compiled.parameters:
        _check_parameters(compiled, 1.0 / period, parameters)
    run = _Run(compiled, parameters, period, state, extra_force)
    width = width or _choose_width(lanes, bool(compiled.members))
    new = np.empty_like(state)
    fresh = None if moments is None else moments[:, 0].copy()

    def block(first: int) -> int:
        # Lanes past the end repeat the last one, so that a block is always full.
        index = np.minimum(np.arange(first, first + width), lanes - 1)
        part = np.ascontiguousarray(state[index])
        own = None if fresh is None else np.repeat(fresh, width)
        failed = run.block(index, part, cycles, record, outputs, waves, own)
        count = min(width, lanes - first)
        new[first : first + count] = part[:count]
        if own is not None and moments is not None:
            moments[:, first : first + count] = own.reshape(-1, width)[:, :count]
        return failed

    starts = range(0, lanes, width)
    threads = threads or os.cpu_count() or 1
    failures = in_threads(block, starts, threads, brief=is_brief(compiled, lanes, cycles))
    if max(failures) >= 0:
        first = starts[int(np.argmax(failures))]
        _refuse_unparted(run, first, width, max(failures), elapsed)
        _report(run, np.arange(first, min(first + width, lanes)), max(failures), elapsed)
    return new


def is_brief(compiled: Compiled, lanes: int, cycles: int) -> bool:
    """Tell whether a march is over before an interruption is missed."""
    size = compiled.system.size + len(compiled.system.contacts)
    return lanes * cycles * compiled.grid.steps * size <= _BRIEF


def _choose_width(lanes: int, own_rows: bool) -> int:
    if lanes < _OWN_ROWS:
        return _WIDTHS[0]
    return _OWN_ROWS if own_rows else _WIDTHS[1]


def _check_parameters(compiled: Compiled, beat: Array, parameters: LaneParameters) -> None:
    for one in compiled.members or (Member(compiled.system, compiled.nodes, np.arange(beat.size)),):
        refuse_unstable_lanes(
            one.system, one.nodes, compiled.grid, beat, parameters, lanes=one.lanes
        )


class _Run:
    """Lanes with everything that the kernel wants to know about each of them."""

    def __init__(
        self,
        compiled: Compiled,
        parameters: LaneParameters | None,
        period: Array,
        state: Array,
        extra_force: Array | None,
    ) -> None:
        lanes, double = state.shape
        self.compiled, self.period, self.state = compiled, period, state
        self.extra = np.zeros((lanes, double // 2)) if extra_force is None else extra_force
        self.programs = compiled.programs(parameters)
        self.member = np.zeros(lanes, dtype=np.int64)
        for number, one in enumerate(compiled.members):
            self.member[one.lanes] = number
        self.scales = np.ones((lanes, 6)) if parameters is None else parameters.table(lanes)
        systems = [one.system for one in compiled.members] or [compiled.system]
        self.load = np.empty((lanes, double // 2))
        for number, (program, system) in enumerate(zip(self.programs, systems, strict=True)):
            own = self.member == number
            self.load[own] = lane_load(program, system, self.extra[own], self.scales[own, 5])
        if parameters is not None:
            self.load = np.hstack((self.load, self.scales))

    def block(
        self,
        index: Index,
        state: Array,
        cycles: int,
        record: Array | None,
        outputs: Array | None,
        waves: Array | None,
        moments: Array | None,
    ) -> int:
        """March the lanes ``index`` in one block; returns what :func:`march_block` does."""
        from tribodyn.dynamics.marching import march_block

        program = self.programs[self.member[index[0]]]
        rows = program.rows
        width, double = state.shape
        if self.compiled.members and width > 1:
            rows = np.stack([self.programs[number].rows for number in self.member[index]], axis=-1)
        keep = np.zeros((0, double, width)) if record is None else record
        table = np.zeros(0) if waves is None else np.ascontiguousarray(waves).reshape(-1)
        linear = np.zeros((0, double)) if outputs is None else outputs
        harmonics = 0 if waves is None else waves.shape[2]
        work = np.zeros(program.slots.count * (width + 1) + 6 * int(program.code[2]))
        code = march_block(
            (0.0,) * width, program.code, program.reads, rows, program.width, program.restart,
            work, self.period[index], self.load[index], state, cycles, keep, linear, table,
            harmonics, moments, stop_flag(),
        )  # fmt: skip
        return refuse_stopped(int(code))


def _refuse_unparted(run: _Run, first: int, width: int, code: int, elapsed: int) -> None:
    """Tell of a step that comes to no end, if that is what ended the block from lane ``first``."""
    from tribodyn.dynamics.marching import UNPARTED

    if code < UNPARTED:
        return
    grid, contacts = run.compiled.grid, len(run.compiled.system.contacts)
    place, lane = divmod(code - UNPARTED, width)
    cycle, step = divmod(place // contacts, grid.steps)
    phase = elapsed + cycle + float(grid.left[step])
    lane = min(first + lane, run.period.size - 1)
    raise unparted_step(
        place % contacts, contacts, phase, phase * float(run.period[lane]),
        lane if run.period.size > 1 else None,
    )  # fmt: skip


def _report(run: _Run, lanes: Index, step: int, elapsed: int) -> None:
    """Find the lane that ran away, march it once more and tell how it did."""
    compiled, steps = run.compiled, run.compiled.grid.steps
    # The step counted from the start is at the end of a mesh cycle. A lane marched by itself is
    # rounded differently, so that it may take a cycle more or less.
    before, last, lane = max(step // steps - 1, 0), -1, int(lanes[0])
    record = np.zeros((steps + 1, run.state.shape[1], 1))
    for lane in lanes:
        index = np.array([lane])
        state = run.state[index].copy()
        early = run.block(index, state, before, None, None, None, None) if before else -1
        if early >= 0:
            before = early // steps - 1
            state = run.state[index].copy()
            if before:
                run.block(index, state, before, None, None, None, None)
        for _ in range(2):
            last = run.block(index, state, 1, record, None, None, None)
            if last >= 0:
                break
            before += 1
        if last >= 0:
            break
        before = max(step // steps - 1, 0)
    member = compiled.members[run.member[lane]] if compiled.members else compiled
    report_divergence(
        member.system, member.nodes, compiled.grid, compiled.step_number, record[:, :, 0],
        1.0 / float(run.period[lane]), before + elapsed, int(lane) if run.period.size > 1 else None,
        run.scales[lane],
    )  # fmt: skip
