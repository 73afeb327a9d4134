"""Prepare adaptive integration of a system: tolerances, blocks of lanes, report of failures."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.dynamics._engine.blocks import LaneBlock, lane_blocks
from tribodyn.dynamics._engine.phase_table import PhaseTable, build_table
from tribodyn.dynamics.equations.compiled import Compiled
from tribodyn.dynamics.equations.divergence import Failed, adaptive_failure, chattering_step
from tribodyn.dynamics.equations.grid import system_events
from tribodyn.dynamics.equations.lane_parameters import LaneParameters
from tribodyn.dynamics.equations.nodes import sampled
from tribodyn.dynamics.equations.program import compile_system, lane_load
from tribodyn.dynamics.equations.step_limit import largest_rate, state_roots
from tribodyn.dynamics.equations.system import System
from tribodyn.dynamics.orbits.coordinates import static_start
from tribodyn.errors import InputError, real_numbers, require_between
from tribodyn.interrupt import refuse_stopped, stop_flag
from tribodyn.types import Array, Index

#: An absolute tolerance: one number, one for positions and one for velocities, or one per state.
Tolerance = float | Sequence[float] | ArrayLike

#: Default absolute tolerance, over the relative one and the size of the static state.
SMALL = 1e-3
#: Error of a step over the requested tolerance, and the same times the memory of the motion [rad].
#: Errors of steps add up over the memory; so their sum stayed below half of the tolerance in all
#: reference cases, up to a hundred undamped periods. Impacts spread neighbouring motions, hence the
#: smaller share where flanks can separate: with it the error of two masses that spread small
#: differences 450-fold equals the tolerance.
_SHARE, _SHARE_WITH_GAP, _BUDGET, _LEAST = 0.015, 0.001, 3.0, 1e-5


def read_atol(atol: Tolerance, size: int) -> Array:
    """Absolute tolerance of each state."""
    values = np.atleast_1d(real_numbers("argument atol", atol))
    if values.shape == (2,):
        values = np.repeat(values, size)
    if values.shape not in ((1,), (2 * size,)) or not np.all(np.isfinite(values) & (values > 0.0)):
        raise InputError(
            f"atol = {atol!r}",
            where="argument atol",
            why="One positive number, one for positions and one for velocities, or one for "
            f"each of the {2 * size} states",
            remedy="Give 1e-9, or one tolerance for each state",
        )
    return np.array(np.broadcast_to(values, (2 * size,)))


def static_scale(compiled: Compiled, mesh_frequency: float) -> Array:
    """Sizes of positions and velocities in the static state, in the metric of the mass."""
    system, nodes = compiled.system, compiled.nodes
    mass = np.sqrt(np.diag(np.asarray(system.mass)))
    position = static_start(compiled)[: system.size]
    size = float(np.max(mass * np.abs(position)))
    if not size > 0.0:
        inside = [np.abs(item).max(initial=0.0) for item in (nodes.error, nodes.gap)]
        size = float(mass.max() * (max(inside) or 1e-6))
    load = np.tensordot(nodes.weight, nodes.force, axes=2)
    speed = math.sqrt(max(float(load @ position), 0.0)) or 2.0 * math.pi * mesh_frequency * size
    return np.concatenate((size / mass, speed / mass))


def step_share(
    compiled: Compiled, duration: float, stiffness_scale: float = 1.0, damping_scale: float = 1.0
) -> float:
    """Allowed error of a step over the tolerance of the motion."""
    system, nodes = compiled.system, compiled.nodes
    inverse = system.inverse_mass
    longest = 0.0
    pairs = (
        (stiffness_scale * nodes.stiffness, system.stiffness),
        (damping_scale * nodes.damping, system.rate_matrix),
    )
    for share in (0.0, 1.0):
        parts = []
        for values, structure_matrix in pairs:
            contact = np.einsum(
                "rs,rsj,rsji,rsjk->ik", nodes.weight, values, nodes.direction, nodes.direction
            )
            parts.append(inverse @ (np.asarray(structure_matrix) + share * contact))
        roots = state_roots(*parts)
        time = np.minimum(duration, 1.0 / np.maximum(-roots.real, 1e-3 / duration))
        longest = max(longest, float((np.abs(roots.imag) * time).max(initial=0.0)))
    share = _SHARE_WITH_GAP if np.any(nodes.gap > 0.0) else _SHARE
    return max(min(share, _BUDGET / max(longest, 1.0)), _LEAST)


_SAMPLE = 64


@dataclass(frozen=True)
class AdaptiveEngine:
    """A system with its phase table and tolerances."""

    system: System
    table: PhaseTable
    rtol: float  #: error over the largest size so far of each state [-]
    atol: Array  #: error allowed on top of that [m or rad, m/s or rad/s]
    rate: float  #: fastest motion of the system [rad/s]
    safety: float  #: error of a step over the tolerance [-]


@dataclass(frozen=True)
class AdaptiveBlock(LaneBlock):
    """Lanes of one system that share their steps."""

    engine: AdaptiveEngine
    memory: Array  #: next step, last error, and largest size so far of every state


class AdaptiveLanes:
    """Lanes whose integration continues from call to call, in blocks of lanes of one engine."""

    def __init__(
        self,
        engines: Sequence[tuple[AdaptiveEngine, Index]],
        period: Array,
        extra_force: Array,
        scales: Array | None = None,
    ) -> None:
        lanes, n = extra_force.shape
        self.period = np.asarray(period, dtype=float)
        self.factors = np.ones((lanes, 6)) if scales is None else scales
        steady, self.blocks = np.empty((lanes, n)), []
        for engine, lane_numbers in engines:
            force = self.factors[lane_numbers, 5]
            steady[lane_numbers] = lane_load(
                engine.table.program, engine.system, extra_force[lane_numbers], force
            )
            rate = max(engine.rate * float(np.max(self.period[lane_numbers])), 1e-9)
            for block in lane_blocks(lane_numbers.size):
                memory = np.zeros(2 + 2 * n * block.index.size)
                memory[:2] = min(0.1 * engine.rtol**0.2 / rate, 0.1), 1.0
                adaptive_block = AdaptiveBlock(
                    lane_numbers[block.index], block.count, engine, memory
                )
                self.blocks.append(adaptive_block)
        self.load = np.hstack((steady, self.factors))

    def march_block(
        self,
        block: AdaptiveBlock,
        state: Array,
        cycles: int,
        points: Array,
        record: Array | None,
        trail: Array,
        elapsed: int,
    ) -> Array:
        """Integrate one block, whose states are overwritten; returns its report."""
        from tribodyn.dynamics._engine.adaptive import MarchOutput, march_adaptive_block

        engine, (width, double) = block.engine, state.shape
        states = np.zeros((0, double, width)) if record is None else record
        report = np.zeros(10)
        lanes = (0.0,) * width, engine.table, self.period[block.index], self.load[block.index]
        tolerances = engine.safety * engine.rtol, engine.safety * engine.atol
        output = MarchOutput(points, states, trail, report)
        slots = march_adaptive_block(
            *lanes, state, block.memory, *tolerances, cycles, output, stop_flag()
        )
        refuse_stopped(int(report[4]))
        if report[4]:
            self._report(block, report, slots[:double], elapsed)
        return report

    def _report(self, block: AdaptiveBlock, report: Array, state: Array, elapsed: int) -> None:
        """Raise the reason why a block failed; ``state`` is that of its lane at the failed step."""
        system, lane = block.engine.system, int(block.index[int(report[6])])
        phase, period = elapsed + report[9] + report[5], float(self.period[lane])
        who = lane if self.period.size > 1 else None
        if report[4] == 2.0:
            place = int(report[7]), len(system.contacts), phase, phase * period, who
            raise chattering_step(*place, adaptive=True)
        nodes = sampled(system, max(_SAMPLE, 2 * len(system_events(system))))[1]
        scale = block.engine.atol / (SMALL * block.engine.rtol)
        facts = period, who, self.factors[lane], 0.0
        failed = Failed(system, nodes, state[None], np.array([phase]), *facts)
        raise adaptive_failure(failed, scale)


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
            f"rtol = {rtol:.1e} is below {table.error:.1e}, the accuracy to which the entries "
            "of the system are resolved over the mesh phase",
            where="argument rtol",
            why="Their kinks or noise cannot be resolved any further",
            remedy=f"Give rtol of at least {table.error:.0e}, or smoother entries",
        )
    grid, nodes, program = compile_system(system, max(_SAMPLE, 2 * table.events.size))
    compiled = Compiled(system, grid, nodes, program, math.nan)
    slowest = float(np.min(np.asarray(mesh_frequency, dtype=float)))
    if atol is None:
        absolute_tolerance = SMALL * rtol * static_scale(compiled, slowest)
    else:
        absolute_tolerance = read_atol(atol, system.size)
    factors = np.ones((1, 6)) if parameters is None else parameters.table(parameters.count)
    most, least = factors.max(axis=0), factors.min(axis=0)
    safety = step_share(compiled, cycles / slowest, float(most[0]), float(least[1]))
    rate = largest_rate(system, nodes, tuple(most[:3]))
    return AdaptiveEngine(system, table, float(rtol), absolute_tolerance, rate, safety)
