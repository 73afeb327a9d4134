"""From a system to adaptively marched lanes: tolerances, blocks, threads, failures."""

from __future__ import annotations

import math
import os
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.dynamics.dormand_prince_failure import report_failure
from tribodyn.dynamics.dormand_prince_table import PhaseTable, build_table
from tribodyn.dynamics.dormand_prince_tolerance import (
    SMALL,
    Tolerance,
    read_atol,
    static_scale,
    step_share,
)
from tribodyn.dynamics.lane_parameters import LaneParameters
from tribodyn.dynamics.march import Compiled, Member
from tribodyn.dynamics.program import compile_system, lane_load
from tribodyn.dynamics.step_limit import largest_rate
from tribodyn.dynamics.system import System
from tribodyn.errors import InputError, Problem, require_between
from tribodyn.interrupt import in_threads, refuse_stopped, stop_flag
from tribodyn.types import Array, Index

#: Lanes of one block.
_WIDTHS = (1, 16)
_SAMPLE = 64


@dataclass(frozen=True)
class AdaptiveRun:
    """What a march gives."""

    state: Array  #: position and velocity at the end
    steps: int
    rejections: int
    crossings: int
    widest: float  #: widest step in mesh phase [-]
    trail: Array
    memory: Array  #: step sizes and sizes of the state, to go on with


@dataclass(frozen=True)
class AdaptiveEngine:
    """A system with its phase table and tolerances."""

    system: System
    table: PhaseTable
    rtol: float  #: error over the largest size so far of each state [-]
    atol: Array  #: error allowed on top of that [m or rad, m/s or rad/s]
    rate: float  #: fastest motion of the system [rad/s]
    safety: float  #: error of a step over the tolerance [-]

    def march(
        self,
        period: Array,
        state: Array,
        cycles: int,
        *,
        extra_force: Array | None = None,
        points: Array | None = None,
        record: Array | None = None,
        memory: Array | None = None,
        room: int = 0,
        width: int | None = None,
        threads: int | None = None,
        scales: Array | None = None,
        numbers: Index | None = None,
        elapsed: int = 0,
    ) -> AdaptiveRun:
        """March lanes by whole mesh cycles."""
        lanes, double = state.shape
        width = width or (_WIDTHS[0] if lanes < 4 else _WIDTHS[1])
        extra = np.zeros((lanes, double // 2)) if extra_force is None else extra_force
        factors = np.ones((lanes, 6)) if scales is None else scales
        load = lane_load(self.table.program, self.system, extra, factors[:, 5])
        load = np.hstack((load, factors))
        called = (np.arange(lanes) if lanes > 1 else np.array([-1])) if numbers is None else numbers
        starts = range(0, lanes, width)
        memory = self._fresh(len(starts), 2 + double * width, period) if memory is None else memory
        memory, new = memory.copy(), np.empty_like(state)
        trail, reports = np.zeros((room, 2 + 3 * double)), np.zeros((len(starts), 10))
        grid = np.zeros(1) if points is None else np.ascontiguousarray(points)

        def block(number: int) -> None:
            # Lanes past the end repeat the last one, so that a block is always full.
            first = starts[number]
            index = np.minimum(np.arange(first, first + width), lanes - 1)
            count = min(width, lanes - first)
            part = np.ascontiguousarray(state[index])
            kept = np.zeros((0, double, width))
            if record is not None:
                kept = record if lanes == width else np.empty((*record.shape[:2], width))
            self._march_block(
                period[index], load[index], part, memory[number], cycles, grid, kept, trail,
                reports[number], called[index], elapsed,
            )  # fmt: skip
            new[first : first + count] = part[:count]
            if record is not None and kept is not record:
                record[:, :, first : first + count] = kept[:, :, :count]

        threads = threads or os.cpu_count() or 1
        in_threads(block, range(len(starts)), threads)
        total = reports.sum(axis=0)
        return AdaptiveRun(
            new, int(total[0]), int(total[1]), int(total[2]), float(reports[:, 3].max()),
            trail[: int(reports[0, 8])], memory,
        )  # fmt: skip

    def _fresh(self, blocks: int, length: int, period: Array) -> Array:
        """Memory before the first step: how long it may be."""
        memory = np.zeros((blocks, length))
        longest = float(np.max(period))
        memory[:, 0] = min(0.1 * self.rtol**0.2 / max(self.rate * longest, 1e-9), 0.1)
        memory[:, 1] = 1.0
        return memory

    def _march_block(
        self,
        period: Array,
        load: Array,
        state: Array,
        memory: Array,
        cycles: int,
        points: Array,
        record: Array,
        trail: Array,
        report: Array,
        index: Index,
        elapsed: int,
    ) -> None:
        from tribodyn.dynamics.dormand_prince_kernel import own_slots
        from tribodyn.dynamics.dormand_prince_marching import march_adaptive_block

        table, program = self.table, self.table.program
        width, n = len(state), self.system.size
        own = program.slots.count
        slots = own + own_slots(n, len(self.system.contacts))
        work = np.zeros(slots * (width + 1) + table.constant.size)
        march_adaptive_block(
            (0.0,) * width, program.code, program.reads, table.constant, table.edge, table.degree,
            table.start, table.coefficients, table.varying, table.events, table.first, work,
            own, slots, np.ascontiguousarray(period), np.ascontiguousarray(load), state, memory,
            self.safety * self.rtol, self.safety * self.atol, cycles, points, record, trail, report,
            stop_flag(),
        )  # fmt: skip
        refuse_stopped(int(report[4]))
        if report[4]:
            report[9] += elapsed
            lane = int(report[6])
            blocks = work[: slots * width].reshape(slots, width)[:, lane]
            single = work[slots * width : slots * (width + 1)]
            used = single if report[4] == 2.0 else blocks
            # The state at the failed step, and its largest sizes before.
            report_failure(
                report, float(period[lane]), used[: 2 * n], self.atol / (SMALL * self.rtol),
                self.system, load[lane, n:], int(index[lane]),
            )  # fmt: skip


def adaptive_engine(
    system: System,
    mesh_frequency: ArrayLike,
    cycles: int,
    *,
    rtol: float = 1e-6,
    atol: Tolerance | None = None,
    table: PhaseTable | None = None,
    parameters: LaneParameters | None = None,
) -> AdaptiveEngine:
    """Prepare a system for adaptive steps."""
    require_between("rtol", rtol, 1e-12, 1e-2)
    scaled = parameters is not None and parameters.scales_contacts
    split = parameters is not None and parameters.scales_friction
    table = build_table(system, scaled=scaled, split=split) if table is None else table
    if table.error > rtol:
        raise InputError(
            Problem(
                what=f"rtol = {rtol:.1e}, and the entries of the system are known over the mesh "
                f"phase to {table.error:.1e}",
                where="argument rtol",
                why="Their kinks or noise cannot be followed any closer",
                remedy=f"Give rtol of at least {table.error:.0e}, or smoother entries",
            )
        )
    grid, nodes, program = compile_system(system, max(_SAMPLE, 2 * table.events.size))
    compiled = Compiled(system, grid, nodes, program, math.nan)
    slowest = float(np.min(np.asarray(mesh_frequency, dtype=float)))
    if atol is None:
        given = SMALL * rtol * static_scale(compiled, slowest)
    else:
        given = read_atol(atol, system.size)
    factors = np.ones((1, 6)) if parameters is None else parameters.table(parameters.count)
    most, least = factors.max(axis=0), factors.min(axis=0)
    safety = step_share(compiled, cycles / slowest, float(most[0]), float(least[1]))
    rate = largest_rate(system, nodes, tuple(most[:3]))
    return AdaptiveEngine(system, table, float(rtol), given, rate, safety)


def march_adaptive(
    compiled: Compiled,
    period: Array,
    state: Array,
    cycles: int,
    *,
    rtol: float = 1e-6,
    atol: Tolerance | None = None,
    extra_force: Array | None = None,
    parameters: LaneParameters | None = None,
    record: Array | None = None,
    threads: int | None = None,
) -> Array:
    """March lanes by whole mesh cycles; returns their new state."""
    period = np.asarray(period, dtype=float)
    scales = None if parameters is None else parameters.table(period.size)
    everyone = np.arange(period.size)
    whole = Member(compiled.system, compiled.nodes, everyone)
    new = np.empty_like(state)
    for one in compiled.members or (whole,):
        own = one.lanes
        engine = adaptive_engine(
            one.system, 1.0 / period[own], cycles, rtol=rtol, atol=atol, parameters=parameters
        )
        kept = record if record is None or not compiled.members else record[:, :, own]
        new[own] = engine.march(
            period[own], state[own], cycles, points=compiled.grid.left, record=kept,
            extra_force=None if extra_force is None else extra_force[own], threads=threads,
            scales=None if scales is None else scales[own],
            numbers=everyone[own] if period.size > 1 else None,
        ).state  # fmt: skip
        if record is not None and kept is not None and kept is not record:
            record[:, :, own] = kept
    return new
