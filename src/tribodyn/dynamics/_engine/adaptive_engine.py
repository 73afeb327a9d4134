"""Prepare adaptive integration: tolerances, one trajectory after another, report of failures."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cache, partial

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.dynamics._engine.row_table import RowTable, build_table
from tribodyn.dynamics.equations.divergence import (
    CHATTERS,
    Failed,
    adaptive_failure,
    chattering_step,
)
from tribodyn.dynamics.equations.grid import system_events
from tribodyn.dynamics.equations.lane_parameters import LaneParameters, kinds_of
from tribodyn.dynamics.equations.nodes import sampled
from tribodyn.dynamics.equations.orbit_coordinates import static_start
from tribodyn.dynamics.equations.program import lane_load
from tribodyn.dynamics.equations.step_limit import largest_rate, state_roots
from tribodyn.dynamics.equations.system import System
from tribodyn.errors import ComputationError, InputError, real_numbers, require_between
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
#: Lanes of a block; fewer than some are integrated one by one. Most trajectories that one thread
#: integrates at a time: their tables are joined.
_WIDTH, _FEW, _MOST = 8, 3, 256


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
        load = lane_load(table.program, system, extra_force, factors[5])
        self.load = np.concatenate((load, factors))

    def failure(self, course: np.recarray, state: Array, elapsed: int) -> ComputationError:
        """Reason of a failure; ``state`` is that at the failed step."""
        phase = elapsed + course.cycle + course.phase
        if course.reason == CHATTERS:
            contact = int(course.contact), len(self.examined.system.contacts)
            at = phase, phase * self.period
            return chattering_step(*contact, *at, self.number, adaptive=True)
        place = self.examined.system, self.examined.nodes, state[None], np.array([phase])
        failed = Failed(*place, self.period, self.number, self.factors, 0.0)
        return adaptive_failure(failed, self.atol / (SMALL * self.rtol))


class LaneGroup:
    """Trajectories of one structure that are integrated together."""

    def __init__(self, lanes: Sequence[AdaptiveLane], numbers: Index) -> None:
        from tribodyn.dynamics._engine.adaptive import JoinedTables

        self.lanes, self.numbers = [lanes[number] for number in numbers], numbers
        tables = {id(lane.table): lane.table for lane in self.lanes}
        # Where the arrays of each table begin in those of all.
        sizes = {key: [array.size for array in _arrays(table)] for key, table in tables.items()}
        ends = np.cumsum(list(sizes.values()), axis=0)
        begins = dict(zip(tables, ends - list(sizes.values()), strict=True))
        keys = [id(lane.table) for lane in self.lanes]
        self._parts = np.array([(*begins[key], *sizes[key]) for key in keys])
        self._tables = JoinedTables(
            *map(np.concatenate, zip(*map(_arrays, tables.values()), strict=True))
        )
        self._load = np.stack([lane.load for lane in self.lanes])
        parts = [lane.safety * np.append(lane.atol, lane.rtol) for lane in self.lanes]
        self._tolerance = np.stack(parts)

    def march(
        self,
        state: Array,
        cycles: int,
        points: Array,
        elapsed: int,
        record: Array | None = None,
        trail: Array | None = None,
    ) -> np.recarray:
        """Integrate states (c, 2 n) in place; fills record (c, rows, 2 n), trail (c, steps, m)."""
        from tribodyn.dynamics._engine.adaptive import Output, march_adaptive
        from tribodyn.dynamics._engine.dormand_prince import COURSE

        courses: np.recarray = np.zeros(len(self.lanes), COURSE).view(np.recarray)
        begin, size = np.split(self._parts, 2, axis=1)
        courses.row, courses.first, _, courses.varying, courses.origin = begin.T
        courses.segment, courses.last = begin[:, 1], begin[:, 1] + size[:, 1] - 1
        courses.columns, courses.period = size[:, 3], [lane.period for lane in self.lanes]
        memory = np.stack([lane.memory for lane in self.lanes])
        courses.plan, courses.error, largest = memory[:, 0], memory[:, 1], memory[:, 2:].copy()
        empty = np.zeros((len(self.lanes), 0, 2 + 3 * state.shape[1]))
        arrays = (empty if array is None else array for array in (record, trail))
        code = march_adaptive(
            (0.0,) * (1 if len(self.lanes) < _FEW else _WIDTH), self.lanes[0].table.program,
            self._tables, self._load, (state, largest), self._tolerance, courses, cycles,
            Output(points, *arrays), stop_flag(),
        )  # fmt: skip
        refuse_stopped(int(code))
        for lane, course, last, sizes in zip(self.lanes, courses, state, largest, strict=True):
            if course.reason:
                raise lane.failure(course, last, elapsed)
            lane.memory = np.concatenate(([course.plan, course.error], sizes))
        return courses


def _arrays(table: RowTable) -> tuple[Array | Index, ...]:
    """Arrays of a table, in the order of the joined ones."""
    return table.program.rows, table.events, table.first, table.varying, table.powers.reshape(-1)


def lane_groups(lanes: Sequence[AdaptiveLane], threads: int) -> list[LaneGroup]:
    """Divide trajectories into groups, each of one structure, some per thread."""
    kinds: dict[bytes, list[int]] = {}
    for number, lane in enumerate(lanes):
        program = lane.table.program
        kinds.setdefault(program.code.tobytes() + program.reads.tobytes(), []).append(number)
    counts = [max(min(threads, len(e) // _WIDTH), len(e) // _MOST, 1) for e in kinds.values()]
    parts = map(np.array_split, kinds.values(), counts)
    return [LaneGroup(lanes, numbers) for part in parts for numbers in part]


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
