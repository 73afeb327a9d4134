"""A system turned into the flat arrays that the kernels read.

The equations are divided by the mass matrix once, so that the loop works on accelerations:
``a = f - K q - C v - sum_j g_j N_j`` with ``K = M^-1 K``, ``g_j = M^-1 (h_j + s_j)``. Only the
entries that are not zero are stored; those that change over the mesh cycle are in the row table.
Lanes that scale their contacts share the rows: the factors are numbers of the lane.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from tribodyn.arrays.linear_algebra import Allocator, each_times, times
from tribodyn.arrays.memory import Memory, new_memory
from tribodyn.dynamics.equations.entry import varies as depends_on_phase
from tribodyn.dynamics.equations.grid import Grid, build_grid, system_events, unrepeated
from tribodyn.dynamics.equations.nodes import Nodes, coefficient_count, evaluate_nodes
from tribodyn.dynamics.equations.ramps import refuse_ramps
from tribodyn.dynamics.equations.system import System
from tribodyn.types import Array, Index, Mask


class Program(NamedTuple):
    """All data that the kernel reads, in flat arrays in reading order."""

    code: Index  #: coordinates, contacts, columns of the row table, reads per buffer
    reads: Index  #: slot that each term reads, for each of the three state buffers
    rows: Array  #: factor of each term at the left end, middle and right end of each step
    width: Array  #: phase width of each step [-]
    restart: Mask  #: whether a step begins at an event
    constant_load: Array  #: part of the load that does not vary, as an acceleration
    pattern: Mask  #: which of all possible terms are present

    @property
    def slots(self) -> Slots:
        """Layout of the work buffer of a lane."""
        contacts = int(self.code[1])
        return lay_out(int(self.code[0]), contacts, int(self.code[4 + 4 * contacts]))


class LaneRows(NamedTuple):
    """Rows of a block of lanes with different rows, in the order in which the kernel reads.

    Columns that are constant over the cycle are stored once, as the rows stream from memory.
    """

    first: Array  #: a row of every lane, (columns, lanes)
    places: Index  #: columns that vary
    varying: Array  #: their factors, (nodes, places, lanes)
    nodes: Index  #: nodes until their order repeats, and those of the one or two steps until then

    @classmethod
    def of(cls, tables: Sequence[Array], columns: int) -> LaneRows:
        """Combine the tables of the lanes."""
        rows = [table.reshape(-1, columns) for table in tables]
        places = np.flatnonzero(
            np.any([np.any(lane_rows != lane_rows[0], axis=0) for lane_rows in rows], axis=0)
        )
        first = np.stack([lane_rows[0] for lane_rows in rows], axis=-1)
        varying = np.stack([lane_rows[:, places] for lane_rows in rows], axis=-1)
        return cls(first.ravel(), places, varying.ravel(), _ORDER)

    def full_steps(self) -> LaneRows:
        """Rows of the full steps, from those of their halves."""
        return self._replace(varying=self.varying[: self.varying.size // 2], nodes=_ORDER)

    def take(self, lanes: Index, width: int) -> LaneRows:
        """Rows of the selected lanes of ``width``."""
        first, varying = (part.reshape(-1, width)[:, lanes] for part in (self.first, self.varying))
        return self._replace(first=first.ravel(), varying=varying.ravel())

    def table(self, steps: int) -> Array:
        """Full row table of a single lane."""
        rows = np.empty((steps, 3, self.first.size))
        rows[...] = self.first
        number = np.arange(steps)[:, None]
        order = self.nodes[1:].reshape(-1, 3)
        node = number // len(order) * self.nodes[0] + order[number[:, 0] % len(order)]
        rows[..., self.places] = self.varying.reshape(-1, self.places.size)[node]
        return rows.reshape(-1)


#: Order of consecutive nodes, and nodes of two halves of a step: those of the full step, stored
#: contiguously, and the others.
_ORDER, _HALVES = np.array([3, 0, 1, 2]), ((0, 2, 5), (1, 3, 4))


class Slots(NamedTuple):
    """Slots of the work buffer: one number per lane in each.

    Three states (position, velocity) begin at 0, 2 n and 4 n. Factors of a lane are stored such
    that zeros, and 1 for ``force_scale``, leave the system unscaled.
    """

    n: int  #: coordinates
    contacts: int
    first: int  #: acceleration of every coordinate
    second: int  #: a second acceleration of every coordinate
    force: int  #: force of every contact
    side: int  #: side of every contact: 1, 0 in the gap, -1
    load: int  #: constant acceleration of every coordinate
    force_scale: int  #: factor of the external force
    h: int  #: duration of the step [s]
    beat: int  #: mesh frequency [Hz]
    error: int  #: 1 less the factor of the error
    inverse: int  #: 1/h
    gap: int  #: factor of the dead zones less 1
    stiffness: int  #: factor of the stiffness less 1
    damping: int  #: factor of the damping less 1
    rub: int  #: factor of the friction less 1
    friction: int  #: force of every friction that follows its load
    end: int  #: number of slots; those of a method begin here


def lay_out(n: int, contacts: int, frictions: int) -> Slots:
    """Lay out the work buffer, in Python and, compiled, in the kernels."""
    force, side, load = 8 * n, 8 * n + contacts, 8 * n + 2 * contacts
    lane = load + n
    friction = lane + 9
    return Slots(
        n, contacts, 6 * n, 7 * n, force, side, load,
        lane, lane + 1, lane + 2, lane + 3, lane + 4, lane + 5, lane + 6, lane + 7, lane + 8,
        friction, friction + frictions,
    )  # fmt: skip


def compile_system(
    system: System, steps: int, events: tuple[float, ...] | None = None
) -> tuple[Grid, Nodes, Program]:
    """Evaluate a system on its event-aligned grid."""
    grid = build_grid(events or system_events(system), steps * system.cycles)
    nodes = evaluate_nodes(system, grid)
    return grid, nodes, build_program(system, grid, nodes)


class _Terms:
    """Collect factors and the slots that they multiply, in reading order."""

    def __init__(self, shape: tuple[int, ...], pattern: Mask | None) -> None:
        self.shape = shape
        self.factors: list[Array | float] = []
        self.slots: list[int] = []
        self.pattern = pattern
        self.presence: list[bool] = []

    def factor(self, values: Array | float) -> None:
        """Append a factor without a slot."""
        self.factors.append(values)

    def keeps(self, wanted: Any) -> bool:
        """Whether a possible term is present: as wanted, or as in the prescribed pattern."""
        present = bool(wanted) if self.pattern is None else bool(self.pattern[len(self.presence)])
        self.presence.append(present)
        return present

    def terms(self, values: Array, slot: int) -> int:
        """Append a term for each last item that is not zero throughout; returns how many."""
        present = [i for i in range(values.shape[-1]) if self.keeps(_holds(values[..., i]))]
        for item in present:
            self.factor(values[..., item])
            self.slots.append(slot + item)
        return len(present)

    def rows(self) -> Array:
        """Row table with all factors of a row in adjacent columns."""
        columns = [np.broadcast_to(values, self.shape) for values in self.factors or [0.0]]
        table = np.empty((*self.shape, len(columns)))
        varying = [item for item, values in enumerate(columns) if any(values.strides)]
        # Fill complete rows with the constants first.
        table.reshape(3 * len(table), -1)[...] = [values[0, 0] for values in columns]
        for item in varying:
            table[:, :, item] = columns[item]
        return table.reshape(-1)

    def rows_of_halves(self, blocks: Sequence[Index], allocate: Allocator) -> list[LaneRows]:
        """Row tables of halved steps for blocks of lanes with one system per lane."""
        columns = [
            unrepeated(np.broadcast_to(values, self.shape)) for values in self.factors or [0.0]
        ]
        places = np.flatnonzero([_varies(values) for values in columns])
        steps, width = self.shape[1] // 2, len(blocks[0])
        wide = [columns[place].reshape(-1, steps, 6) for place in places]
        tables = allocate((len(blocks), 2, steps, 3, places.size, width))
        rows = []
        for table, lanes in zip(tables, blocks, strict=True):
            selection = slice(lanes[0], lanes[-1] + 1) if np.all(np.diff(lanes) == 1) else lanes
            for item, values in enumerate(wide):
                selected = values[selection] if len(values) > 1 else values
                for part, nodes in zip(table, _HALVES, strict=True):
                    for number, node in enumerate(nodes):
                        part[:, number, item] = selected[..., node].T
            first = [np.broadcast_to(values[:, 0, 0], self.shape[:1])[lanes] for values in columns]
            order = np.array([3, 0, 3 * steps, 1, 3 * steps + 1, 3 * steps + 2, 2])
            rows.append(LaneRows(np.concatenate(first), places, table.reshape(-1), order))
        return rows


def _holds(values: Array) -> bool:
    """Whether any of the factors (..., steps, 3) of a term is not zero."""
    return any(sample.any() for sample in _sample_first(unrepeated(values)))


def _varies(values: Array) -> bool:
    """Whether factors (systems, steps, 3) of a term change along the cycle."""
    return any(bool(np.any(sample != values[:, :1, :1])) for sample in _sample_first(values))


def _sample_first(values: Array) -> Iterator[Array]:
    """Yield some rows of factors (..., steps, 3), which decide most tests, then all."""
    if values.ndim > 1:
        yield values[..., :: max(1, values.shape[-2] // 16), :]
    yield values


def _contact_terms(system: System, nodes: Nodes, terms: _Terms, scaled: int) -> list[int]:
    code: list[int] = []
    for j, contact in enumerate(system.contacts):
        scalars = (nodes.stiffness, nodes.damping, nodes.error, nodes.error_slope, nodes.gap)
        for item in scalars:
            terms.factor(item[..., j])
        for part in (nodes.direction, nodes.direction_slope):
            code.append(terms.terms(part[..., j, :], 0))
        code += [
            int(np.any(unrepeated(nodes.gap[..., j]))),
            int(contact.damping_in_gap) + scaled,
        ]
    return code


def _friction_terms(
    system: System, nodes: Nodes, terms: _Terms, slots: Slots, split: bool
) -> list[int]:
    code = [slots.end - slots.friction]
    for f, friction in enumerate(system.frictions):
        count = coefficient_count(f"frictions[{f}].coefficients", friction)
        code += [len(friction.contacts), count]
        terms.slots += [slots.force + j for j in friction.contacts]
        terms.factor(1.0 / friction.load)
        terms.factor(friction.limit)
        for item in range(count):
            terms.factor(nodes.friction_coefficients[..., f, item])
    for j in range(len(system.contacts) if split else 0):
        # The friction of a contact with the coefficient 1, to be scaled separately.
        code += [1, 1]
        terms.slots.append(slots.force + j)
        for value in (1.0, 1.0, 1.0):
            terms.factor(value)
    return code


def _coordinate_terms(
    system: System, nodes: Nodes, terms: _Terms, slots: Slots, split: bool, memory: Memory
) -> tuple[list[int], Mask]:
    """Number of terms of every coordinate, and whether its load varies."""
    inverse = system.inverse_mass
    along = unrepeated(nodes.direction if split else nodes.force_direction, 2)
    rub = nodes.friction_direction
    if split:
        rub = np.concatenate((rub, nodes.force_direction - nodes.direction), axis=-2)
    reaction = times(along, -inverse, along.ndim - 4, partial(memory, "reaction"))
    drag = times(rub, -inverse, rub.ndim - 4)
    steps = slice(None if depends_on_phase(system.force) else 1)
    load = np.einsum("ik,...k->...i", inverse, unrepeated(nodes.force[..., steps, :, :], 1))
    state = -np.hstack(
        [inverse @ np.asarray(part) for part in (system.stiffness, system.rate_matrix)]
    )
    state[np.abs(state) <= 1e-15 * np.abs(state).max(axis=1, keepdims=True)] = 0.0
    code: list[int] = []
    varies = np.zeros(system.size, dtype=bool)
    for i in range(system.size):
        count = terms.terms(state[i], 0)
        count += terms.terms(reaction[..., i], slots.force)
        count += terms.terms(drag[..., i], slots.friction)
        varies[i] = terms.keeps(np.any(np.ptp(load[..., i], axis=(-2, -1)) > 0.0))
        if varies[i]:
            terms.factor(load[..., i])
            terms.slots.append(slots.force_scale)
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
    terms, program = _flattened(system, grid, nodes, scaled, split, pattern)
    return program._replace(rows=terms.rows())


def program_of_lanes(
    system: System, grid: Grid, nodes: Nodes, blocks: Sequence[Index], memory: Memory
) -> tuple[Program, list[LaneRows]]:
    """Flatten a batch of systems on halved steps; ``memory`` allocates the large arrays.

    The program has no rows and one constant load per system; each block has the rows of its lanes,
    whose systems are numbered in ``blocks``. Rows of ``nodes`` have a leading axis for the systems.
    """
    terms, program = _flattened(system, grid, nodes, False, False, None, memory)
    return program, terms.rows_of_halves(blocks, partial(memory, "rows"))


def _flattened(
    system: System,
    grid: Grid,
    nodes: Nodes,
    scaled: bool,
    split: bool,
    pattern: Mask | None,
    memory: Memory = new_memory,
) -> tuple[_Terms, Program]:
    """Terms of a system or of a batch, and the program without its rows."""
    refuse_ramps(system)
    size, contacts = system.size, len(system.contacts)
    slots = lay_out(size, contacts, len(system.frictions) + (contacts if split else 0))
    terms = _Terms(nodes.phase.shape, pattern)
    lists = _contact_terms(system, nodes, terms, 2 * int(scaled))
    lists += _friction_terms(system, nodes, terms, slots, split)
    coordinate_code, varies = _coordinate_terms(system, nodes, terms, slots, split, memory)
    relative = np.array(terms.slots, dtype=np.int64)
    # State slots move with the buffer that a stage reads; all others stay.
    moving = (relative < 2 * size).astype(np.int64)
    reads = np.concatenate([relative + moving * buffer * 2 * size for buffer in range(3)])
    load = nodes.force[..., 0, 0, :] @ system.inverse_mass.T
    return terms, Program(
        code=np.array(
            [size, contacts, max(len(terms.factors), 1), relative.size, *lists, *coordinate_code],
            dtype=np.int64,
        ),
        reads=reads,
        rows=np.empty(0),
        width=grid.width,
        restart=grid.after_event,
        constant_load=np.where(varies, 0.0, load),
        pattern=np.array(terms.presence, dtype=bool),
    )


def lane_load(program: Program, system: System, extra: Any, factor: Any = 1.0) -> Array:
    """Constant acceleration of each lane: the constant part of the load plus an extra force."""
    load = np.multiply.outer(np.asarray(factor, dtype=float), program.constant_load)
    return np.asarray(load + each_times(np.asarray(extra, dtype=float), system.inverse_mass.T))
