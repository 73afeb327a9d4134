"""Row tables of a batch of systems with the same structure, evaluated together.

Systems of a batch have the same matrices and one contact with the same direction and events. Rows
that differ between them have a leading axis for the systems; shared rows are evaluated once.
"""

from __future__ import annotations

from collections.abc import Hashable, Iterator, Sequence
from contextlib import suppress
from functools import partial
from typing import Any

import numpy as np

from tribodyn.arrays.linear_algebra import Allocator, times
from tribodyn.arrays.memory import Memory, new_memory
from tribodyn.dynamics.equations.entry import Entry, entry_values, varies
from tribodyn.dynamics.equations.grid import (
    Grid,
    RowEvaluator,
    build_grid,
    system_events,
    unrepeated,
)
from tribodyn.dynamics.equations.nodes import (
    Nodes,
    positive_gap,
    ramp_count,
    refuse_falling_force,
    step_weights,
)
from tribodyn.dynamics.equations.step_limit import FEWEST, examined_rows, rates_at
from tribodyn.dynamics.equations.system import System
from tribodyn.types import Array

#: Rows of a batch without an axis for the systems.
_SHARED = "weight", "direction_slope", "friction_direction", "friction_coefficients"


def group_by_structure(systems: Sequence[System]) -> Iterator[list[int]]:
    """Numbers of the systems of each batch; systems that cannot be batched are left out."""
    groups: dict[Hashable, list[int]] = {}
    for number, system in enumerate(systems):
        if (key := _structure(system)) is not None:
            groups.setdefault(key, []).append(number)
    yield from groups.values()


def _structure(system: System) -> Hashable:
    """Key of the structure that systems of a batch share; None for a system without a batch."""
    contacts = system.contacts
    if len(contacts) != 1 or system.frictions or varies(system.force) or system.cycles > 1:
        return None
    contact = contacts[0]
    if varies(contact.direction) or contact.offset or ramp_count("contacts[0]", contact):
        return None
    parts = system.mass, system.rate_matrix, system.stiffness, system.balance, contact.direction
    numbers = tuple(None if part is None else np.asarray(part).tobytes() for part in parts)
    return numbers, tuple(system.names), contact.events, contact.damping_in_gap


def evaluate_batch(systems: Sequence[System], grid: Grid, memory: Memory = new_memory) -> Nodes:
    """Evaluate every entry of a batch, as :func:`evaluate_nodes` does for one system.

    ``memory`` allocates the large arrays.
    """
    widest, size = float(grid.width.max()), systems[0].size
    checked = max(system._checked for system in systems)
    evaluator = RowEvaluator(grid, checks=widest < 0.49 * checked)
    contacts = [system.contacts[0] for system in systems]
    shape = len(systems), grid.steps, 3

    def entry_values_of(name: str, size: int = 1) -> Array:
        entries = [getattr(contact, name) for contact in contacts]
        return _values(evaluator, f"contacts[0].{name}", entries, size, partial(memory, name))

    gap = positive_gap(entry_values_of("gap"))
    direction = evaluator.values("contacts[0].direction", contacts[0].direction, size)
    force = _constants("force", [system.force for system in systems], evaluator.nodes[:1, 0], size)
    push = entry_values_of("friction", size)
    if push.flags.writeable:  # an array of its own: add the few entries that are not zero
        for item in np.flatnonzero(direction.any(axis=(0, 1))):
            push[..., item] += direction[..., item]
    else:
        push = unrepeated(direction, 1) + unrepeated(push, 1)
    nodes = Nodes(
        phase=np.broadcast_to(grid.left[:, None] + grid.width[:, None] * [0.0, 0.5, 1.0], shape),
        stiffness=entry_values_of("stiffness"),
        damping=entry_values_of("damping"),
        error=entry_values_of("error"),
        error_slope=_error_slopes(evaluator, [contact.error for contact in contacts]),
        gap=gap,
        direction=np.broadcast_to(direction[:, :, None], (*shape, 1, size)),
        direction_slope=np.broadcast_to(0.0, (*shape[1:], 1, size)),
        force_direction=np.broadcast_to(push[..., None, :], (*shape, 1, size)),
        force=np.broadcast_to(force, (*shape, size)),
        weight=step_weights(grid),
        friction_direction=np.zeros((grid.steps, 3, 0, size)),
        friction_coefficients=np.zeros((grid.steps, 3, 0, 1)),
        ramp_stiffness=np.zeros((*shape, 1, 0)),
        ramp_gap=np.zeros((*shape, 1, 0)),
    )
    if np.any(unrepeated(nodes.stiffness) < 0.0):
        for number in range(len(systems)):
            refuse_falling_force(rows_of_system(nodes, number))
    if grid.width.sum() > 0.99:
        for system in systems:
            object.__setattr__(system, "_checked", min(widest, system._checked))
    return nodes


def rows_of_system(nodes: Nodes, number: int) -> Nodes:
    """Rows of one system of a batch."""
    system_rows = {
        name: getattr(nodes, name)[number] for name in Nodes._fields if name not in _SHARED
    }
    return nodes._replace(**system_rows)


def _values(
    rows: RowEvaluator,
    where: str,
    entries: Sequence[Any],
    size: int,
    allocate: Allocator = np.empty,
) -> Array:
    """Values (systems, steps, 3, size) of an entry of each system."""
    first, shape = entries[0], (len(entries), *rows.nodes.shape, size)
    if all(each is first or (isinstance(each, float) and each == first) for each in entries):
        return np.broadcast_to(rows.values(where, 0.0 if first is None else first, size), shape)
    if not any(varies(each) for each in entries):
        return np.broadcast_to(_constants(where, entries, rows.nodes[:1, 0], size), shape)
    joined = _joined(rows, entries, size, allocate)
    if joined is not None:
        return joined
    return np.stack([rows.values(where, 0.0 if e is None else e, size) for e in entries])


def _constants(where: str, entries: Sequence[object], at: Array, size: int) -> Array:
    """Values (systems, 1, 1, size) of entries that do not vary."""
    with suppress(ValueError):  # where their shapes differ
        values = np.array(entries).reshape(len(entries), -1)
        if values.dtype == float and values.shape[1] in (1, size) and np.isfinite(values).all():
            return np.broadcast_to(values, (len(entries), size))[:, None, None]
    return np.stack([entry_values(where, each, at, size) for each in entries])[:, None]


def _joined(
    rows: RowEvaluator, entries: Sequence[Any], size: int, allocate: Allocator
) -> Array | None:
    """Values of tables on the same grid points, looked up together; None for other entries."""
    first, kind = entries[0], type(entries[0])
    if not hasattr(kind, "onto") or not all(type(each) is kind for each in entries):
        return None
    if not rows.is_smooth(first) or not all(
        each.grid is first.grid
        and each.values.shape == first.values.shape
        and np.array_equal(each.onto, first.onto)
        for each in entries
    ):
        return None
    knots = np.stack([each.values for each in entries], axis=1)
    if not np.all(np.isfinite(knots)):  # reported when each entry is evaluated alone
        return None
    table = kind(first.grid, knots)
    values = np.moveaxis(table(rows.nodes.reshape(-1)), 1, 0)
    values = values if first.onto is None else times(values, first.onto.T, 1, allocate)
    return np.asarray(values).reshape(len(entries), *rows.nodes.shape, size)


def _error_slopes(rows: RowEvaluator, entries: Sequence[Entry]) -> Array:
    if not any(varies(each) for each in entries):
        return np.broadcast_to(0.0, (len(entries), *rows.nodes.shape, 1))
    return np.stack([rows.derivatives("contacts[0].error", each) for each in entries])


def coarsen_nodes(nodes: Nodes, grid: Grid) -> Nodes:
    """Rows of a batch on a grid, from those on the grid with every step halved."""

    def coarsened(name: str, values: Array) -> Array:
        lead = 0 if name in _SHARED else 1
        shape = *values.shape[:lead], grid.steps, 3, *values.shape[lead + 2 :]
        distinct = unrepeated(values, values.ndim - lead - 2)
        if distinct.shape[lead : lead + 2] == (1, 1):
            return np.broadcast_to(distinct, shape)
        return coarsen_rows(values, grid.steps, lead)

    rows = {name: coarsened(name, values) for name, values in nodes._asdict().items()}
    return Nodes(**rows)._replace(weight=step_weights(grid))


def coarsen_rows(values: Array, steps: int, lead: int, allocate: Allocator = np.empty) -> Array:
    """Values at both ends and the middle of pairs of steps, from (..., 2 steps, 3, ...)."""
    # The steps become the last axis, so that their values are taken from contiguous memory.
    last = tuple(range(lead + 2, values.ndim))
    first = tuple(range(lead, lead + len(last)))
    row_major = np.moveaxis(values, last, first)
    pairs = row_major.reshape(*row_major.shape[:-2], steps, 6)
    coarsened = allocate((*pairs.shape[:-1], 3))
    return np.moveaxis(pairs.take([0, 2, 5], axis=-1, out=coarsened, mode="clip"), first, last)


def batch_rates(systems: Sequence[System], nodes: Nodes) -> Array:
    """Largest modulus of an eigenvalue of each system of a batch, as :func:`largest_rate`."""
    rows, stages = examined_rows(nodes.stiffness.sum(axis=-1))
    return rates_at(systems[0], nodes, (np.arange(len(systems))[:, None], rows, stages))


def cache_rates(systems: Sequence[System], steps: int = FEWEST) -> None:
    """Cache the largest rates of a batch on a grid of ``steps`` steps, as :func:`rate_on_grid`."""
    systems = [system for system in systems if steps not in system._rates]
    if not systems:
        return
    grid = build_grid(system_events(systems[0]), steps)
    entries = [system.contacts[0].stiffness for system in systems]
    stiffness = _values(RowEvaluator(grid, checks=False), "contacts[0].stiffness", entries, 1)
    rows, stages = examined_rows(stiffness[..., 0])
    # All other entries are needed on the examined rows only.
    examined = np.unique(rows)
    nodes = evaluate_batch(systems, grid.rows(examined))
    index = np.arange(len(systems))[:, None], np.searchsorted(examined, rows), stages
    for system, rate in zip(systems, rates_at(systems[0], nodes, index), strict=True):
        system._rates[steps] = float(rate)
