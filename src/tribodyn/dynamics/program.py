"""A system turned into the flat arrays that the kernels read.

The equations are divided by the mass matrix once, so that the loop works on accelerations:
``a = f - K q - C v - sum_j g_j N_j`` with ``K = M^-1 K``, ``g_j = M^-1 (h_j + s_j)``. Only the
entries that are not zero are kept; those that change over the mesh cycle live in the row table.
Lanes that scale their contacts have the same rows: the factors are numbers of the lane.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from tribodyn.dynamics.falling_force import refuse_falling_force
from tribodyn.dynamics.grid import Grid, RowEvaluator, build_grid, system_events
from tribodyn.dynamics.load_friction import (
    coefficient_count,
    friction_coefficients,
    friction_directions,
)
from tribodyn.dynamics.system import System
from tribodyn.errors import InputError, Problem
from tribodyn.types import Array, Index, Mask


class Program(NamedTuple):
    """Everything that the kernel reads, in flat arrays, in the order in which it reads."""

    code: Index  #: coordinates, contacts, columns of the row table, reads per buffer
    reads: Index  #: slot that each term reads, for each of the three state buffers
    rows: Array  #: factor of each term at the left end, middle and right end of each step
    width: Array  #: phase width of each step [-]
    restart: Mask  #: whether a step begins at an event
    constant_load: Array  #: part of the load that does not vary, as an acceleration
    pattern: Mask  #: which of all possible terms are there

    @property
    def slots(self) -> Slots:
        """Where a lane keeps what in the work buffer."""
        contacts = int(self.code[1])
        return Slots(int(self.code[0]), contacts, int(self.code[4 + 4 * contacts]))


class Slots:
    """Slots of the work buffer: one number per lane in each."""

    def __init__(self, n: int, contacts: int, frictions: int) -> None:
        self.force = 8 * n
        self.one = self.force + 2 * contacts + n
        self.friction = self.one + 9
        self.count = self.friction + frictions


class Nodes(NamedTuple):
    """The same rows with names, for evaluation outside the loop; all at (steps, 3)."""

    phase: Array
    stiffness: Array
    damping: Array
    error: Array
    error_slope: Array
    gap: Array
    direction: Array
    direction_slope: Array
    force_direction: Array
    force: Array
    weight: Array
    friction_direction: Array
    friction_coefficients: Array


def compile_system(
    system: System, steps: int, events: tuple[float, ...] | None = None
) -> tuple[Grid, Nodes, Program]:
    """Evaluate a system on its event-aligned grid."""
    grid = build_grid(events or system_events(system), steps)
    return grid, *compile_on(system, grid)


def compile_on(system: System, grid: Grid) -> tuple[Nodes, Program]:
    """Evaluate a system on any grid."""
    nodes = _evaluate(system, grid)
    return nodes, build_program(system, grid, nodes)


def _evaluate(system: System, grid: Grid) -> Nodes:
    rows = RowEvaluator(grid)
    size = system.size
    contacts = tuple(system.contacts)

    def scalar(name: str, take: Callable[..., Array]) -> Array:
        columns = [
            take(f"contacts[{j}].{name}", getattr(contact, name))[..., 0]
            for j, contact in enumerate(contacts)
        ]
        return np.stack(columns, axis=-1) if columns else np.zeros((grid.steps, 3, 0))

    def vector(name: str, take: Callable[..., Array]) -> Array:
        out = np.zeros((grid.steps, 3, len(contacts), size))
        for j, contact in enumerate(contacts):
            entry = getattr(contact, name)
            if entry is not None:
                out[:, :, j] = take(f"contacts[{j}].{name}", entry, size)
        return out

    direction = vector("direction", rows.values)
    gap = scalar("gap", rows.values)
    if np.any(gap < 0.0):
        raise InputError(
            Problem(
                what=f"gap = {gap.min():.6g} m",
                where="Contact.gap",
                why="The gap is half the dead zone and cannot be negative",
                remedy="Use `error` for an interference",
            )
        )
    nodes = Nodes(
        phase=grid.left[:, None] + grid.width[:, None] * np.array([0.0, 0.5, 1.0]),
        stiffness=scalar("stiffness", rows.values),
        damping=scalar("damping", rows.values),
        error=scalar("error", rows.values),
        error_slope=scalar("error", rows.derivatives),
        gap=gap,
        direction=direction,
        direction_slope=vector("direction", rows.derivatives),
        force_direction=direction + vector("friction", rows.values),
        force=rows.values("force", system.force, size),
        weight=grid.width[:, None] * np.array([1.0, 4.0, 1.0]) / 6.0,
        friction_direction=friction_directions(system, rows),
        friction_coefficients=friction_coefficients(system, rows),
    )
    refuse_falling_force(nodes.phase, nodes.stiffness, nodes.gap, nodes.direction, nodes.error)
    return nodes


class _Terms:
    """Collects factors and the slots that they multiply, in reading order."""

    def __init__(self, steps: int, pattern: Mask | None) -> None:
        self.shape = (steps, 3)
        self.factors: list[Array] = []
        self.slots: list[int] = []
        self.pattern = pattern
        self.kept: list[bool] = []

    def factor(self, values: Array | float) -> None:
        """Append a factor without a slot."""
        self.factors.append(np.broadcast_to(values, self.shape))

    def keeps(self, wanted: Any) -> bool:
        """Whether a possible term is there: as wanted, or as in the pattern that was given."""
        given = bool(wanted) if self.pattern is None else bool(self.pattern[len(self.kept)])
        self.kept.append(given)
        return given

    def term(self, values: Array | float, slot: int) -> int:
        """Append a term unless it is zero throughout; returns how many were appended."""
        if not self.keeps(np.any(values)):
            return 0
        self.factor(np.asarray(values))
        self.slots.append(slot)
        return 1


def _contact_terms(system: System, nodes: Nodes, terms: _Terms, scaled: int) -> list[int]:
    code: list[int] = []
    for j, contact in enumerate(system.contacts):
        scalars = (nodes.stiffness, nodes.damping, nodes.error, nodes.error_slope, nodes.gap)
        for item in scalars:
            terms.factor(item[:, :, j])
        for part in (nodes.direction, nodes.direction_slope):
            code.append(sum(terms.term(part[:, :, j, i], i) for i in range(system.size)))
        code += [int(np.any(nodes.gap[:, :, j])), int(contact.damping_in_gap) + scaled]
    return code


def _friction_terms(
    system: System, nodes: Nodes, terms: _Terms, slots: Slots, split: bool
) -> list[int]:
    code = [slots.count - slots.friction]
    for f, one in enumerate(system.frictions):
        count = coefficient_count(f"frictions[{f}].coefficients", one)
        code += [len(one.contacts), count]
        terms.slots += [slots.force + j for j in one.contacts]
        terms.factor(1.0 / one.load)
        terms.factor(one.limit)
        for item in range(count):
            terms.factor(nodes.friction_coefficients[:, :, f, item])
    for j in range(len(system.contacts) if split else 0):
        # The friction of a contact as one with the coefficient 1, to be scaled by itself.
        code += [1, 1]
        terms.slots.append(slots.force + j)
        for value in (1.0, 1.0, 1.0):
            terms.factor(value)
    return code


def _coordinate_terms(
    system: System, nodes: Nodes, terms: _Terms, slots: Slots, split: bool
) -> tuple[list[int], Mask]:
    """Number of terms of every coordinate, and whether its load varies."""
    inverse = np.linalg.inv(np.asarray(system.mass))
    along = nodes.direction if split else nodes.force_direction
    rub = nodes.friction_direction
    if split:
        rub = np.concatenate((rub, nodes.force_direction - nodes.direction), axis=2)
    reaction, drag = (-np.einsum("ik,rsjk->rsji", inverse, part) for part in (along, rub))
    load = np.einsum("ik,rsk->rsi", inverse, nodes.force)
    state = -np.hstack([inverse @ np.asarray(part) for part in (system.stiffness, system.damping)])
    state[np.abs(state) <= 1e-15 * np.abs(state).max(axis=1, keepdims=True)] = 0.0
    code: list[int] = []
    varies = np.zeros(system.size, dtype=bool)
    for i in range(system.size):
        count = sum(terms.term(state[i, k], k) for k in range(2 * system.size))
        count += sum(
            terms.term(reaction[:, :, j, i], slots.force + j) for j in range(reaction.shape[2])
        )
        count += sum(terms.term(drag[:, :, f, i], slots.friction + f) for f in range(drag.shape[2]))
        varies[i] = terms.keeps(np.ptp(load[:, :, i]) > 0.0)
        if varies[i]:
            terms.factor(load[:, :, i])
            terms.slots.append(slots.one)
            count += 1
        code.append(count)
    return code, varies


def build_program(
    system: System,
    grid: Grid,
    nodes: Nodes,
    *,
    scaled: bool = False,
    split: bool = False,
    pattern: Mask | None = None,
) -> Program:
    """Flatten a system on its grid."""
    size, contacts = system.size, len(system.contacts)
    slots = Slots(size, contacts, len(system.frictions) + (contacts if split else 0))
    terms = _Terms(grid.steps, pattern)
    lists = _contact_terms(system, nodes, terms, 2 * int(scaled))
    lists += _friction_terms(system, nodes, terms, slots, split)
    own, varies = _coordinate_terms(system, nodes, terms, slots, split)
    factors = terms.factors or [np.zeros(terms.shape)]
    relative = np.array(terms.slots, dtype=np.int64)
    # State slots move with the buffer that a stage reads; all others stay.
    moving = (relative < 2 * size).astype(np.int64)
    reads = np.concatenate([relative + moving * buffer * 2 * size for buffer in range(3)])
    load = np.linalg.inv(np.asarray(system.mass)) @ nodes.force[0, 0]
    return Program(
        code=np.array([size, contacts, len(factors), relative.size, *lists, *own], dtype=np.int64),
        reads=reads,
        rows=np.ascontiguousarray(np.stack(factors, axis=-1)).reshape(-1),
        width=grid.width,
        restart=grid.after_event,
        constant_load=np.where(varies, 0.0, load),
        pattern=np.array(terms.kept, dtype=bool),
    )


def lane_load(program: Program, system: System, extra: Any, factor: Any = 1.0) -> Array:
    """Constant acceleration of each lane: the constant part of the load plus an extra force."""
    inverse = np.linalg.inv(np.asarray(system.mass))
    own = np.multiply.outer(np.asarray(factor, dtype=float), program.constant_load)
    return np.asarray(own + np.asarray(extra, dtype=float) @ inverse.T)
