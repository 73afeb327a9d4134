"""Prepare adaptive integration: tolerances, one trajectory after another, report of failures."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cache, partial

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.dynamics._engine.row_table import RowTable, build_table
from tribodyn.dynamics.equations.divergence import Failed, adaptive_failure, chattering_step
from tribodyn.dynamics.equations.grid import system_events
from tribodyn.dynamics.equations.lane_parameters import LaneParameters, kinds_of
from tribodyn.dynamics.equations.nodes import sampled
from tribodyn.dynamics.equations.orbit_coordinates import static_start
from tribodyn.dynamics.equations.program import lane_load
from tribodyn.dynamics.equations.step_limit import largest_rate, state_roots
from tribodyn.dynamics.equations.system import System
from tribodyn.errors import InputError, real_numbers, require_between
from tribodyn.interrupt import refuse_stopped, stop_flag
from tribodyn.types import Array, Index

#: An absolute tolerance: one number, one for positions and one for velocities, or one per state.
Tolerance = float | Sequence[float] | ArrayLike

#: Default absolute tolerance, over the relative one and the size of the static state.
SMALL = 1e-3
#: Initial steps of a mesh cycle in which the system is examined.
_SAMPLE = 64
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


def static_scale(examined: ExaminedSystem, mesh_frequency: float) -> Array:
    """Sizes of positions and velocities in the static state, in the metric of the mass."""
    system, nodes = examined.system, examined.nodes
    mass = np.sqrt(np.diag(np.asarray(system.mass)))
    position = static_start(examined)[: system.size]
    size = float(np.max(mass * np.abs(position)))
    if not size > 0.0:
        inside = [np.abs(item).max(initial=0.0) for item in (nodes.error, nodes.gap)]
        size = float(mass.max() * (max(inside) or 1e-6))
    load = np.tensordot(nodes.weight, nodes.force, axes=2)
    speed = math.sqrt(max(float(load @ position), 0.0)) or 2.0 * math.pi * mesh_frequency * size
    return np.concatenate((size / mass, speed / mass))


def step_share(examined: ExaminedSystem, duration: float, factors: Array) -> float:
    """Allowed error of a step over the tolerance of the motion, for the factors of a lane."""
    system, nodes = examined.system, examined.nodes
    inverse = system.inverse_mass
    longest = 0.0
    pairs = (
        (factors[0] * nodes.stiffness, system.stiffness),
        (factors[1] * nodes.damping, system.rate_matrix),
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


class ExaminedSystem:
    """A system with what its trajectories of any factors share."""

    def __init__(self, system: System, kinds: Index, rtol: float) -> None:
        self.system = system
        self.tables = {kind: _table(system, rtol, kind) for kind in np.unique(kinds).tolist()}
        self.nodes = sampled(system, max(_SAMPLE, 2 * len(system_events(system))))[1]
        self.rate = cache(partial(largest_rate, system, self.nodes))


class AdaptiveLane:
    """A trajectory whose integration continues from call to call in steps of its own."""

    def __init__(
        self,
        examined: ExaminedSystem,
        table: RowTable,
        operation: tuple[float, int],
        tolerance: tuple[float, Tolerance | None],
        extra_force: Array,
        factors: Array,
        number: int | None,
    ) -> None:
        self.examined, self.table, self.factors, self.number = examined, table, factors, number
        system, n, (frequency, cycles) = examined.system, examined.system.size, operation
        self.rtol, atol = tolerance
        self.period, rtol = 1.0 / frequency, self.rtol
        self.rate = examined.rate(tuple(factors[:3].tolist()))
        if atol is None:
            self.atol = SMALL * rtol * static_scale(examined, frequency)
        else:
            self.atol = read_atol(atol, n)
        self.safety = step_share(examined, cycles / frequency, factors)
        first = min(0.1 * rtol**0.2 / max(self.rate * self.period, 1e-9), 0.1)
        #: Next step, last error, and largest size so far of every state.
        self.memory = np.concatenate(([first, 1.0], np.zeros(2 * n)))
        self.load = lane_load(table.program, system, extra_force, factors[5])
        if np.any(factors != 1.0):
            self.load = np.concatenate((self.load, factors))

    def march(
        self,
        state: Array,
        cycles: int,
        points: Array,
        record: Array | None,
        trail: Array,
        elapsed: int,
    ) -> Array:
        """Integrate a state (2 n,), which is overwritten; returns the report."""
        from tribodyn.dynamics._engine.adaptive import MarchOutput, march_adaptive

        states = np.zeros((0, state.size)) if record is None else record
        report = np.zeros(9)
        tolerances = self.safety * self.rtol, self.safety * self.atol
        output = MarchOutput(points, states, trail, report)
        period, load, lane = np.array([self.period]), self.load[None], state[None]
        march_adaptive(
            self.table, period, load, lane, self.memory, *tolerances, cycles, output, stop_flag()
        )
        refuse_stopped(int(report[4]))
        if report[4]:
            self._report(report, state, elapsed)
        return report

    def _report(self, report: Array, state: Array, elapsed: int) -> None:
        """Raise the reason of a failure; ``state`` is that at the failed step."""
        phase = elapsed + report[8] + report[5]
        if report[4] == 2.0:
            contact = int(report[6]), len(self.examined.system.contacts), phase, phase * self.period
            raise chattering_step(*contact, self.number, adaptive=True)
        place = self.examined.system, self.examined.nodes, state[None], np.array([phase])
        failed = Failed(*place, self.period, self.number, self.factors, 0.0)
        raise adaptive_failure(failed, self.atol / (SMALL * self.rtol))


def adaptive_lanes(
    systems: Sequence[tuple[System, Index]],
    frequency: Array,
    cycles: int,
    extra_force: Array,
    rtol: float = 1e-6,
    atol: Tolerance | None = None,
    parameters: LaneParameters | None = None,
) -> list[AdaptiveLane]:
    """Prepare the trajectories of systems, each with the numbers of its lanes."""
    require_between("rtol", rtol, 1e-12, 1e-2)
    lanes = frequency.size
    factors = np.ones((lanes, 6)) if parameters is None else parameters.table(lanes)
    kinds = np.zeros(lanes, np.int64) if parameters is None else kinds_of(parameters, lanes)
    prepared: dict[int, AdaptiveLane] = {}
    for system, numbers in systems:
        examined = ExaminedSystem(system, kinds[numbers], rtol)
        for lane in numbers.tolist():
            prepared[lane] = AdaptiveLane(
                examined, examined.tables[int(kinds[lane])], (float(frequency[lane]), cycles),
                (float(rtol), atol), extra_force[lane], factors[lane], lane if lanes > 1 else None,
            )  # fmt: skip
    return [prepared[lane] for lane in range(lanes)]


def _table(system: System, rtol: float, kind: int) -> RowTable:
    """Table of a kind of factors; refuse a tolerance that it does not resolve."""
    table = build_table(system, rtol, scaled=bool(kind & 1), split=bool(kind & 2))
    if table.error > rtol:
        raise InputError(
            f"rtol = {rtol:.1e} is below {table.error:.1e}, the accuracy to which the entries "
            "of the system are resolved over the mesh phase",
            where="argument rtol",
            why="Their kinks or noise cannot be resolved any further",
            remedy=f"Give rtol of at least {table.error:.0e}, or smoother entries",
        )
    return table
