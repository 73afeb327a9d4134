"""A system turned into the flat arrays that the kernels read.

The equations are divided by the mass matrix once, so that the loop works on accelerations:
``a = f - K q - C v - sum_j g_j N_j`` with ``K = M^-1 K``, ``g_j = M^-1 (h_j + s_j)``. Only the
entries that are not zero are kept; those that change over the mesh cycle live in the row table.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tribodyn.dynamics.grid import Grid, RowEvaluator, build_grid, system_events
from tribodyn.dynamics.system import System
from tribodyn.errors import InputError, Problem

__all__ = ["Nodes", "Program", "Slots", "compile_system", "lane_load"]

Array = NDArray[np.float64]
Index = NDArray[np.int64]


class Program(NamedTuple):
    """Everything that the kernel reads, in flat arrays, in the order in which it reads.

    Parameters
    ----------
    code : (m,) int array
        Coordinates, contacts, columns of the row table, reads per buffer; then four numbers per
        contact (terms of its direction, terms of its slope, has a dead zone, damping acts in the
        gap); then the number of terms of each coordinate's acceleration.
    reads : (3 * stride,) int array
        Slot that each term reads, for each of the three state buffers.
    rows : (steps * 3 * columns,) array
        Factor of each term at the left end, middle and right end of each step; every contact
        begins with stiffness, damping, error, its slope and the gap.
    width : (steps,) array
        Phase width of each step [-].
    restart : (steps,) bool array
        Whether a step begins at an event.
    constant_load : (n,) array
        Part of the load that does not vary, as an acceleration.
    """

    code: Index
    reads: Index
    rows: Array
    width: Array
    restart: NDArray[np.bool_]
    constant_load: Array

    @property
    def slots(self) -> Slots:
        """Where a lane keeps what in the work buffer."""
        return Slots(int(self.code[0]), int(self.code[1]))


class Slots:
    """Slots of the work buffer: one number per lane in each.

    Three state buffers (q, v) at 0, 2n and 4n, two sums, contact forces, sides of the dead
    zones, constant accelerations, then single slots.

    Parameters
    ----------
    n, contacts : int
        Coordinates and contacts.
    """

    def __init__(self, n: int, contacts: int) -> None:
        self.new = 4 * n
        self.force = 8 * n
        self.side = self.force + contacts
        self.load = self.side + contacts
        self.one = self.load + n
        self.step = self.one + 1
        self.beat = self.one + 2
        self.zero = self.one + 3
        self.inverse_step = self.one + 4
        self.count = self.one + 5


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


def compile_system(system: System, steps: int) -> tuple[Grid, Nodes, Program]:
    """Evaluate a system on its event-aligned grid.

    Parameters
    ----------
    system : System
    steps : int
        Steps per mesh cycle.

    Returns
    -------
    tuple of Grid, Nodes, Program

    Raises
    ------
    InputError
        If an entry has the wrong shape or is not finite, or a gap is negative.

    Examples
    --------
    >>> from tribodyn.dynamics import Contact, System
    >>> contact = Contact(direction=[1.0], stiffness=1.0)
    >>> system = System([[1.0]], [[0.0]], [[1.0]], [0.0], [contact])
    >>> int(compile_system(system, 16)[2].code[0])
    1
    """
    grid = build_grid(system_events(system), steps)
    nodes = _evaluate(system, grid)
    return grid, nodes, _flatten(system, grid, nodes)


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
    return Nodes(
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
    )


class _Terms:
    """Collects factors and the slots that they multiply, in reading order."""

    def __init__(self, steps: int) -> None:
        self.shape = (steps, 3)
        self.factors: list[Array] = []
        self.slots: list[int] = []

    def factor(self, values: Array) -> None:
        """Append a factor without a slot."""
        self.factors.append(np.broadcast_to(values, self.shape))

    def term(self, values: Array | float, slot: int) -> int:
        """Append a term unless it is zero throughout; returns how many were appended."""
        if not np.any(values):
            return 0
        self.factor(np.asarray(values))
        self.slots.append(slot)
        return 1


def _contact_terms(system: System, nodes: Nodes, terms: _Terms) -> list[int]:
    code: list[int] = []
    for j, contact in enumerate(system.contacts):
        scalars = (nodes.stiffness, nodes.damping, nodes.error, nodes.error_slope, nodes.gap)
        for item in scalars:
            terms.factor(item[:, :, j])
        for part in (nodes.direction, nodes.direction_slope):
            code.append(sum(terms.term(part[:, :, j, i], i) for i in range(system.size)))
        code += [int(np.any(nodes.gap[:, :, j])), int(contact.damping_in_gap)]
    return code


def _coordinate_terms(system: System, nodes: Nodes, terms: _Terms, slots: Slots) -> list[int]:
    inverse = np.linalg.inv(np.asarray(system.mass))
    reaction = -np.einsum("ik,rsjk->rsji", inverse, nodes.force_direction)
    load = np.einsum("ik,rsk->rsi", inverse, nodes.force)
    state = -np.hstack([inverse @ np.asarray(part) for part in (system.stiffness, system.damping)])
    state[np.abs(state) <= 1e-15 * np.abs(state).max(axis=1, keepdims=True)] = 0.0
    code: list[int] = []
    for i in range(system.size):
        count = sum(terms.term(state[i, k], k) for k in range(2 * system.size))
        count += sum(
            terms.term(reaction[:, :, j, i], slots.force + j) for j in range(len(system.contacts))
        )
        if np.ptp(load[:, :, i]) > 0.0:
            count += terms.term(load[:, :, i], slots.one)
        code.append(count)
    return code


def _flatten(system: System, grid: Grid, nodes: Nodes) -> Program:
    size, contacts = system.size, len(system.contacts)
    slots = Slots(size, contacts)
    terms = _Terms(grid.steps)
    lists = _contact_terms(system, nodes, terms) + _coordinate_terms(system, nodes, terms, slots)
    factors = terms.factors or [np.zeros(terms.shape)]
    relative = np.array(terms.slots, dtype=np.int64)
    # State slots move with the buffer that a stage reads; all others stay.
    moving = (relative < 2 * size).astype(np.int64)
    reads = np.concatenate([relative + moving * buffer * 2 * size for buffer in range(3)])
    return Program(
        code=np.array([size, contacts, len(factors), relative.size, *lists], dtype=np.int64),
        reads=reads,
        rows=np.ascontiguousarray(np.stack(factors, axis=-1)).reshape(-1),
        width=grid.width,
        restart=grid.after_event,
        constant_load=_constant_load(system, nodes),
    )


def _constant_load(system: System, nodes: Nodes) -> Array:
    load = np.einsum("ik,rsk->rsi", np.linalg.inv(np.asarray(system.mass)), nodes.force)
    constant = np.ptp(load.reshape(-1, system.size), axis=0) == 0.0
    return np.where(constant, load[0, 0], 0.0)


def lane_load(program: Program, system: System, extra: Any) -> Array:
    """Constant acceleration of each lane: the constant part of the load plus an extra force.

    Parameters
    ----------
    program : Program
    system : System
    extra : (lanes, n) array
        Extra generalized force of each lane [N or N*m].

    Returns
    -------
    (lanes, n) array
        In m/s^2 or rad/s^2.
    """
    inverse = np.linalg.inv(np.asarray(system.mass))
    return np.asarray(program.constant_load + np.asarray(extra, dtype=float) @ inverse.T)
