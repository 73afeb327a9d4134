"""From a system to adaptively marched lanes: tolerances, blocks, threads, failures."""

from __future__ import annotations

import math
import os
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.dynamics._engine.blocks import BlockRecord, LaneBlock, lane_blocks
from tribodyn.dynamics._engine.phase_table import PhaseTable, build_table
from tribodyn.dynamics._engine.tolerance import (
    SMALL,
    Tolerance,
    read_atol,
    static_scale,
    step_share,
)
from tribodyn.dynamics.equations.compiled import Compiled
from tribodyn.dynamics.equations.divergence import adaptive_failure
from tribodyn.dynamics.equations.lane_parameters import LaneParameters
from tribodyn.dynamics.equations.program import compile_system, lane_load
from tribodyn.dynamics.equations.step_limit import largest_rate
from tribodyn.dynamics.equations.system import System
from tribodyn.errors import InputError, require_between
from tribodyn.interrupt import in_threads, refuse_stopped, stop_flag
from tribodyn.types import Array, Index

_SAMPLE = 64


class AdaptiveRun(NamedTuple):
    """What a march gives."""

    state: Array  #: position and velocity at the end
    steps: int
    rejections: int
    crossings: int
    widest: float  #: widest step in mesh phase [-]
    trail: Array


@dataclass(frozen=True)
class AdaptiveEngine:
    """A system with its phase table and tolerances."""

    system: System
    table: PhaseTable
    rtol: float  #: error over the largest size so far of each state [-]
    atol: Array  #: error allowed on top of that [m or rad, m/s or rad/s]
    rate: float  #: fastest motion of the system [rad/s]
    safety: float  #: error of a step over the tolerance [-]

    def march(self, period: Array, state: Array, cycles: int, **options: Any) -> AdaptiveRun:
        """March lanes by whole mesh cycles, with the options of :class:`AdaptiveLanes`."""
        facts = {name: options.pop(name) for name in ("extra_force", "scales") if name in options}
        return AdaptiveLanes(self, period, **facts).march(state, cycles, **options)


class AdaptiveLanes:
    """Lanes of one system that march on from call to call, block by block."""

    def __init__(
        self,
        engine: AdaptiveEngine,
        period: Array,
        *,
        extra_force: Array | None = None,
        scales: Array | None = None,
        numbers: Index | None = None,
    ) -> None:
        lanes, n = period.size, engine.system.size
        extra = np.zeros((lanes, n)) if extra_force is None else extra_force
        factors = np.ones((lanes, 6)) if scales is None else scales
        steady = lane_load(engine.table.program, engine.system, extra, factors[:, 5])
        self.engine, self.period = engine, np.asarray(period, dtype=float)
        self.load, self.numbers = np.hstack((steady, factors)), numbers
        self.blocks = lane_blocks(lanes)
        width = self.blocks[0].index.size
        #: Next step and last error of each block, and largest sizes of all states so far.
        self.memory = np.zeros((len(self.blocks), 2 + 2 * n * width))
        rate = max(engine.rate * float(np.max(period)), 1e-9)
        self.memory[:, 0] = min(0.1 * engine.rtol**0.2 / rate, 0.1)
        self.memory[:, 1] = 1.0

    def march(
        self,
        state: Array,
        cycles: int,
        *,
        points: Array | None = None,
        record: Array | None = None,
        room: int = 0,
        threads: int | None = None,
        elapsed: int = 0,
    ) -> AdaptiveRun:
        """March all lanes by whole mesh cycles, after ``elapsed`` others."""
        new = np.empty_like(state)
        trail = np.zeros((room, 2 + 3 * state.shape[1]))
        grid = np.zeros(1) if points is None else np.ascontiguousarray(points)

        def march_lanes(place: int) -> Array:
            block = self.blocks[place]
            part = np.ascontiguousarray(state[block.index])
            kept = BlockRecord(record, block.lanes, block.index.size)
            report = self.march_block(place, part, cycles, grid, kept.states, trail, elapsed)
            kept.put()
            new[block.lanes] = part[: block.count]
            return report

        count = threads or os.cpu_count() or 1
        reports = np.array(in_threads(march_lanes, range(len(self.blocks)), count))
        total = reports.sum(axis=0)
        return AdaptiveRun(
            new, int(total[0]), int(total[1]), int(total[2]), float(reports[:, 3].max()),
            trail[: int(reports[0, 8])],
        )  # fmt: skip

    def march_block(
        self,
        place: int,
        state: Array,
        cycles: int,
        points: Array,
        record: Array | None,
        trail: Array,
        elapsed: int,
    ) -> Array:
        """March one block, whose states are overwritten; returns its report."""
        from tribodyn.dynamics._engine.adaptive import Kept, march_adaptive_block

        engine, block = self.engine, self.blocks[place]
        width, double = state.shape
        kept = np.zeros((0, double, width)) if record is None else record
        report = np.zeros(10)
        slots = march_adaptive_block(
            (0.0,) * width, engine.table, self.period[block.index], self.load[block.index], state,
            self.memory[place], engine.safety * engine.rtol, engine.safety * engine.atol, cycles,
            Kept(points, kept, trail, report), stop_flag(),
        )  # fmt: skip
        refuse_stopped(int(report[4]))
        if report[4]:
            self._report(block, report, slots[:double], elapsed)
        return report

    def _report(self, block: LaneBlock, report: Array, state: Array, elapsed: int) -> None:
        engine, lane = self.engine, int(block.index[int(report[6])])
        number = lane if self.period.size > 1 else None
        if self.numbers is not None:
            number = int(self.numbers[lane])
        report[9] += elapsed
        # The state at the failed step, and its largest sizes before.
        raise adaptive_failure(
            report, float(self.period[lane]), state, engine.atol / (SMALL * engine.rtol),
            engine.system, self.load[lane, engine.system.size :], number,
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
            f"rtol = {rtol:.1e}, and the entries of the system are known over the mesh "
            f"phase to {table.error:.1e}",
            where="argument rtol",
            why="Their kinks or noise cannot be followed any closer",
            remedy=f"Give rtol of at least {table.error:.0e}, or smoother entries",
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
