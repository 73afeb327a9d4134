"""Systems alike on one grid: what they share is evaluated once, what differs in one pass.

Systems are alike if they have the same matrices, and one contact of the same direction that touches
at the same events. Rows in which they differ have a first axis more, for the systems.
"""

from __future__ import annotations

from collections.abc import Hashable, Iterator, Sequence
from contextlib import suppress
from functools import partial
from typing import Any

import numpy as np

from tribodyn.arrays.products import Room, times
from tribodyn.arrays.workspace import Memory, new_memory
from tribodyn.dynamics.equations.entry import Entry, entry_values, varies
from tribodyn.dynamics.equations.grid import Grid, RowEvaluator, build_grid, once, system_events
from tribodyn.dynamics.equations.nodes import (
    Nodes,
    refuse_falling_force,
    refuse_negative_gap,
    step_weights,
)
from tribodyn.dynamics.equations.step_limit import FEWEST, look_at, rates_at
from tribodyn.dynamics.equations.system import System
from tribodyn.types import Array

#: Rows of systems alike that have no axis for the systems.
_SHARED = "weight", "direction_slope", "friction_direction", "friction_coefficients"


def groups_alike(systems: Sequence[System]) -> Iterator[list[int]]:
    """Numbers of the systems that are alike; without those that have no others like them."""
    groups: dict[Hashable, list[int]] = {}
    for number, system in enumerate(systems):
        if (key := _structure(system)) is not None:
            groups.setdefault(key, []).append(number)
    yield from groups.values()


def _structure(system: System) -> Hashable:
    """What systems alike have in common; None of those that are like no others."""
    contacts = system.contacts
    if len(contacts) != 1 or system.frictions or varies(system.force):
        return None
    if varies(contacts[0].direction):
        return None
    parts = system.mass, system.damping, system.stiffness, system.balance, contacts[0].direction
    numbers = tuple(None if part is None else np.asarray(part).tobytes() for part in parts)
    return numbers, tuple(system.names), contacts[0].events, contacts[0].damping_in_gap


def evaluate_alike(systems: Sequence[System], grid: Grid, memory: Memory = new_memory) -> Nodes:
    """Evaluate every entry of systems alike, as :func:`evaluate_nodes` does of one system.

    What becomes another matrix on the way is in the memory that is given.
    """
    widest, size = float(grid.width.max()), systems[0].size
    checked = max(system._checked for system in systems)
    rows = RowEvaluator(grid, checks=widest < 0.49 * checked)
    contacts = [system.contacts[0] for system in systems]
    shape = len(systems), grid.steps, 3

    def own(name: str, size: int = 1) -> Array:
        entries = [getattr(contact, name) for contact in contacts]
        return _values(rows, f"contacts[0].{name}", entries, size, partial(memory, name))

    gap = own("gap")
    refuse_negative_gap(gap)
    direction = rows.values("contacts[0].direction", contacts[0].direction, size)
    force = _constants("force", [system.force for system in systems], rows.nodes[:1, 0], size)
    push = own("friction", size)
    if push.flags.writeable:  # the rows of each, to which little is to be added
        for item in np.flatnonzero(direction.any(axis=(0, 1))):
            push[..., item] += direction[..., item]
    else:
        push = once(direction, 1) + once(push, 1)
    nodes = Nodes(
        phase=np.broadcast_to(grid.left[:, None] + grid.width[:, None] * [0.0, 0.5, 1.0], shape),
        stiffness=own("stiffness"),
        damping=own("damping"),
        error=own("error"),
        error_slope=_error_slopes(rows, [contact.error for contact in contacts]),
        gap=gap,
        direction=np.broadcast_to(direction[:, :, None], (*shape, 1, size)),
        direction_slope=np.broadcast_to(0.0, (*shape[1:], 1, size)),
        force_direction=np.broadcast_to(push[..., None, :], (*shape, 1, size)),
        force=np.broadcast_to(force, (*shape, size)),
        weight=step_weights(grid),
        friction_direction=np.zeros((grid.steps, 3, 0, size)),
        friction_coefficients=np.zeros((grid.steps, 3, 0, 1)),
    )
    if np.any(once(nodes.stiffness) < 0.0):
        for number in range(len(systems)):
            one = rows_of(nodes, number)
            refuse_falling_force(one.phase, one.stiffness, one.gap, one.direction, one.error)
    if grid.width.sum() > 0.99:
        for system in systems:
            object.__setattr__(system, "_checked", min(widest, system._checked))
    return nodes


def rows_of(nodes: Nodes, number: int) -> Nodes:
    """Rows of one of several systems alike."""
    own = {name: getattr(nodes, name)[number] for name in Nodes._fields if name not in _SHARED}
    return nodes._replace(**own)


def _values(
    rows: RowEvaluator, where: str, entries: Sequence[Any], size: int, room: Room = np.empty
) -> Array:
    """Values (systems, steps, 3, size) of an entry of each system."""
    first, shape = entries[0], (len(entries), *rows.nodes.shape, size)
    if all(each is first or (isinstance(each, float) and each == first) for each in entries):
        return np.broadcast_to(rows.values(where, 0.0 if first is None else first, size), shape)
    if not any(varies(each) for each in entries):
        return np.broadcast_to(_constants(where, entries, rows.nodes[:1, 0], size), shape)
    joined = _joined(rows, entries, size, room)
    if joined is not None:
        return joined
    return np.stack([rows.values(where, 0.0 if e is None else e, size) for e in entries])


def _constants(where: str, entries: Sequence[Any], at: Array, size: int) -> Array:
    """Values (systems, 1, 1, size) of entries that do not vary."""
    with suppress(ValueError):  # where their shapes differ
        values = np.array(entries).reshape(len(entries), -1)
        if values.dtype == float and values.shape[1] in (1, size) and np.isfinite(values).all():
            return np.broadcast_to(values, (len(entries), size))[:, None, None]
    return np.stack([entry_values(where, each, at, size) for each in entries])[:, None]


def _joined(rows: RowEvaluator, entries: Sequence[Any], size: int, room: Room) -> Array | None:
    """Values of tables on the same knots, looked up together; None of other entries."""
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
    if not np.all(np.isfinite(knots)):  # which is told of each by itself
        return None
    table = kind(first.grid, knots)
    found = np.moveaxis(table(rows.nodes.reshape(-1)), 1, 0)
    found = found if first.onto is None else times(found, first.onto.T, 1, room)
    return np.asarray(found).reshape(len(entries), *rows.nodes.shape, size)


def _error_slopes(rows: RowEvaluator, entries: Sequence[Entry]) -> Array:
    if not any(varies(each) for each in entries):
        return np.broadcast_to(0.0, (len(entries), *rows.nodes.shape, 1))
    return np.stack([rows.derivatives("contacts[0].error", each) for each in entries])


def every_other(nodes: Nodes, grid: Grid) -> Nodes:
    """Rows on a grid, from those of systems alike on the grid with every step cut in two."""

    def taken(name: str, values: Array) -> Array:
        lead = 0 if name in _SHARED else 1
        shape = *values.shape[:lead], grid.steps, 3, *values.shape[lead + 2 :]
        few = once(values, values.ndim - lead - 2)
        if few.shape[lead : lead + 2] == (1, 1):
            return np.broadcast_to(few, shape)
        return rows_of_every_other(values, grid.steps, lead)

    rows = {name: taken(name, values) for name, values in nodes._asdict().items()}
    return Nodes(**rows)._replace(weight=step_weights(grid))


def rows_of_every_other(values: Array, steps: int, lead: int, room: Room = np.empty) -> Array:
    """Values (..., 2 steps, 3, ...) at both ends and the middle of pairs of steps."""
    # What there is of each row lies behind one another, as its items are taken one by one.
    last = tuple(range(lead + 2, values.ndim))
    first = tuple(range(lead, lead + len(last)))
    apart = np.moveaxis(values, last, first)
    pairs = apart.reshape(*apart.shape[:-2], steps, 6)
    taken = room((*pairs.shape[:-1], 3))
    return np.moveaxis(pairs.take([0, 2, 5], axis=-1, out=taken, mode="clip"), first, last)


def rates_alike(systems: Sequence[System], nodes: Nodes) -> Array:
    """Largest modulus of an eigenvalue of each of systems alike, as :func:`largest_rate`."""
    rows, stages = look_at(nodes.stiffness.sum(axis=-1))
    return rates_at(systems[0], nodes, (np.arange(len(systems))[:, None], rows, stages))


def remember_rates(systems: Sequence[System], steps: int = FEWEST) -> None:
    """Let systems alike know their rates on a grid of as many steps, as :func:`rate_on_grid`."""
    systems = [system for system in systems if steps not in system._rates]
    if not systems:
        return
    grid = build_grid(system_events(systems[0]), steps)
    entries = [system.contacts[0].stiffness for system in systems]
    stiffness = _values(RowEvaluator(grid, checks=False), "contacts[0].stiffness", entries, 1)
    rows, stages = look_at(stiffness[..., 0])
    # All else is needed on the rows alone that are examined.
    some = np.unique(rows)
    nodes = evaluate_alike(systems, grid.rows(some))
    index = np.arange(len(systems))[:, None], np.searchsorted(some, rows), stages
    for system, rate in zip(systems, rates_at(systems[0], nodes, index), strict=True):
        system._rates[steps] = float(rate)
