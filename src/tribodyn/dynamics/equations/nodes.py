"""The rows of a system on its grid, with names.

Every entry is evaluated at the left end, the middle and the right end of each step. Friction that
follows the load of a contact, ``F = N sum_k c_k(phi) x^k`` with ``x = min(|N|/load, limit)``, acts
along ``-direction(phi)``. Its coefficients carry the sign of sliding: a friction coefficient and a
load share that depend on the tooth force become one polynomial for each row of the table.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from tribodyn.dynamics.equations.entry import entry_values, varies
from tribodyn.dynamics.equations.grid import (
    Grid,
    RowEvaluator,
    build_grid,
    system_events,
    unrepeated,
)
from tribodyn.dynamics.equations.phases import same_entry, table_of
from tribodyn.dynamics.equations.system import (
    CONTACT_ENTRIES,
    FRICTION_ENTRIES,
    Contact,
    LoadFriction,
    System,
    no_direction,
)
from tribodyn.errors import InputError, real_numbers
from tribodyn.types import Array, Index, Mask

#: Phases at which a function is probed for its number of coefficients; no likely number of these.
_PROBE = 37


def coefficient_count(where: str, friction: LoadFriction) -> int:
    """Number of coefficients of one row."""
    return _row_length(where, friction.coefficients)


def _row_length(where: str, entry: object, least: int = 1) -> int:
    """Number of values of an entry at one phase."""
    looked_up = table_of(entry)
    if looked_up is not None and (values := looked_up[0].values).ndim == 2:
        return int(values.shape[1])
    probe = (np.arange(_PROBE) + 0.5) / _PROBE
    values = real_numbers(where, entry(probe) if callable(entry) else entry, "rows of numbers")
    shape = values.shape
    if callable(entry) and _PROBE in shape:
        shape = tuple(np.delete(shape, shape.index(_PROBE)).tolist())
    if len(shape) > 1 or (shape and shape[0] < least):
        why = f"A row of numbers for each mesh phase: ({_PROBE}, m) for {_PROBE} phases"
        remedy = "Return a row of numbers for each phase that is passed to the function"
        raise InputError(f"{where} returns the shape {values.shape}", where, why, remedy)
    return int(shape[0]) if shape else 1


def ramp_count(where: str, contact: Contact) -> int:
    """Number of ramps of a contact."""
    names = ("ramp_stiffness", "ramp_gap")
    count, gaps = (_row_length(f"{where}.{name}", getattr(contact, name), 0) for name in names)
    if count != gaps:
        what, why = f"{count} stiffnesses and {gaps} gaps", "Every ramp has a stiffness and a gap"
        raise InputError(what, f"{where}.ramp_gap", why, "Give as many gaps as stiffnesses")
    return count


def friction_directions(system: System, rows: RowEvaluator) -> Array:
    """Directions of all frictions on the rows."""
    out = np.zeros((*rows.nodes.shape, len(system.frictions), system.size))
    for f, friction in enumerate(system.clocked_frictions):
        out[:, :, f] = rows.values(f"frictions[{f}].direction", friction.direction, system.size)
    return out


def friction_coefficients(system: System, rows: RowEvaluator) -> Array:
    """Coefficients of all frictions on the rows, filled up with zeros."""
    names = [f"frictions[{f}].coefficients" for f in range(len(system.frictions))]
    pairs = list(zip(names, system.clocked_frictions, strict=True))
    counts = [coefficient_count(name, friction) for name, friction in pairs]
    out = np.zeros((*rows.nodes.shape, len(pairs), max(counts, default=1)))
    for f, (name, friction) in enumerate(pairs):
        out[:, :, f, : counts[f]] = rows.values(name, friction.coefficients, counts[f])
    return out


def carried_load(system: System, contact_force: Array) -> Array:
    """Force N that each friction follows."""
    columns = [
        contact_force[..., list(friction.contacts)].sum(axis=-1) for friction in system.frictions
    ]
    return np.stack(columns, axis=-1) if columns else np.zeros((*contact_force.shape[:-1], 0))


def _ratio(system: System, load: Array) -> tuple[Array, Mask]:
    """Load over the nominal load, and whether it is below the limit."""
    nominal = np.array([friction.load for friction in system.frictions])
    limit = np.array([friction.limit for friction in system.frictions])
    x = np.abs(load) * (1.0 / nominal)
    return np.minimum(x, limit), x < limit


def _polynomial(coefficients: Array, x: Array) -> Array:
    total = np.zeros(np.broadcast_shapes(coefficients.shape[:-1], x.shape))
    for item in range(coefficients.shape[-1] - 1, -1, -1):
        total = total * x + coefficients[..., item]
    return total


def friction_secant(system: System, coefficients: Array, load: Array) -> Array:
    """Friction over contact force, ``F/N``."""
    return _polynomial(coefficients, _ratio(system, load)[0])


def friction_force(system: System, coefficients: Array, contact_force: Array) -> Array:
    """Force of each friction."""
    load = carried_load(system, contact_force)
    return load * friction_secant(system, coefficients, load)


def friction_tangent(system: System, coefficients: Array, load: Array) -> Array:
    """Change of friction with contact force, ``dF/dN``."""
    x, below = _ratio(system, load)
    # d(x P)/dx = sum (k + 1) c_k x^k; beyond the limit P stays.
    rising = _polynomial(coefficients * np.arange(1, coefficients.shape[-1] + 1), x)
    return np.where(below, rising, _polynomial(coefficients, x))


def push_with_friction(system: System, nodes: Nodes, ratio: Array) -> Array:
    """Generalized force per unit force of each contact, all friction included."""
    push = nodes.force_direction
    for f, friction in enumerate(system.frictions):
        push = push.copy() if f == 0 else push
        for j in friction.contacts:
            push[..., j, :] += ratio[..., f, None] * nodes.friction_direction[..., f, :]
    return push


def nominal_push(system: System, nodes: Nodes) -> Array:
    """Generalized force per contact force; frictions as they change about their nominal load."""
    if not system.frictions:
        return nodes.force_direction
    nominal = np.array([friction.load for friction in system.frictions])
    ratio = friction_tangent(system, nodes.friction_coefficients, nominal)
    return push_with_friction(system, nodes, ratio)


#: Sums of stiffnesses below zero by less than this part of the largest are rounding.
_ROUNDING = 1e-9
#: Gaps below zero by less than this are rounding [m].
GAP_ROUNDING = 1e-15


#: Weights of both ends and the middle of a step.
_SIMPSON = np.array([1.0, 4.0, 1.0]) / 6.0


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
    ramp_stiffness: Array  #: (..., contacts, m)
    ramp_gap: Array


def springs(nodes: Nodes) -> tuple[Array, Array]:
    """Stiffness and gap of the first spring and the ramps of each contact, (..., contacts, m)."""
    if not nodes.ramp_gap.shape[-1]:
        return nodes.stiffness[..., None], nodes.gap[..., None]
    first = ((nodes.stiffness, nodes.ramp_stiffness), (nodes.gap, nodes.ramp_gap))
    stiffness, gap = (np.concatenate((a[..., None], b), axis=-1) for a, b in first)
    return stiffness, gap


def ramp_force(nodes: Nodes, deflection: Array) -> Array:
    """Force of the ramps of every contact at a compression (..., contacts)."""
    beyond = np.maximum(np.abs(deflection)[..., None] - nodes.ramp_gap, 0.0)
    return np.asarray(np.sign(deflection) * (nodes.ramp_stiffness * beyond).sum(axis=-1))


def evaluate_nodes(system: System, grid: Grid) -> Nodes:
    """Evaluate every entry on a grid; checks on a grid at most twice as wide are not repeated."""
    widest = float(grid.width.max())
    nodes = evaluate_rows(system, RowEvaluator(grid, checks=widest < 0.49 * system._checked))
    fractions = grid.width[:, None] * np.array([0.0, 0.5, 1.0])
    nodes = nodes._replace(phase=grid.left[:, None] + fractions, weight=step_weights(grid))
    refuse_falling_force(nodes)
    if grid.width.sum() > 0.99:
        object.__setattr__(system, "_checked", min(widest, system._checked))
    return nodes


def over_spanned(system: System, evaluate: Callable[[System], Nodes]) -> Nodes:
    """Entries whose directions are over the few coordinates that they span, or over all."""
    if system._narrow is None:
        return evaluate(system)
    nodes = evaluate(system._narrow[0])
    force = entry_values("force", system.force, np.zeros(1), system.size)[0]
    return nodes._replace(force=_one_row(force, nodes.phase.shape))


def spanned_coordinates(system: System, nodes: Nodes) -> Array | None:
    """Coordinates over which the directions of entries are (c, n); None where these are all."""
    narrow = system._narrow if nodes.direction.shape[-1] != system.size else None
    return None if narrow is None else narrow[1]


def evaluate_rows(system: System, rows: RowEvaluator) -> Nodes:
    """Evaluate every entry at the nodes of an evaluator; equal weights."""
    size, shape = system.size, rows.nodes.shape
    contacts = system.clocked_contacts
    parts = ((contacts, CONTACT_ENTRIES), (system.clocked_frictions, FRICTION_ENTRIES))
    rows.look_up(getattr(part, name) for each, names in parts for part in each for name in names)

    def vector(name: str, take: Callable[..., Array], size: int = size) -> Array:
        if len(contacts) == 1 and (entry := getattr(contacts[0], name)) is not None:
            return take(f"contacts[0].{name}", entry, size)[:, :, None]
        entries = [getattr(contact, name) for contact in contacts]
        still = not any(map(varies, entries))
        table = np.zeros((1 if still else shape[0], shape[1], len(entries), size))
        for j, entry in enumerate(entries):
            if (same := _evaluated_before(entries, j)) is not None:
                table[:, :, j] = table[:, :, same]
            elif entry is not None and (varies(entry) or take == rows.values):
                table[:, :, j] = take(f"contacts[{j}].{name}", entry, size)[: len(table)]
        return _one_row(table[0, 0], shape) if still else table

    def scalar(name: str, take: Callable[..., Array]) -> Array:
        return vector(name, take, 1)[..., 0]

    direction = vector("direction", rows.values)
    for j in np.flatnonzero(~unrepeated(direction, 2).any(axis=(0, 1, 3))):
        raise no_direction(f"contacts[{j}].direction")
    gap, rub = positive_gap(scalar("gap", rows.values)), vector("friction", rows.values)
    return Nodes(
        phase=rows.nodes,
        stiffness=scalar("stiffness", rows.values),
        damping=scalar("damping", rows.values),
        error=scalar("error", rows.values),
        error_slope=scalar("error", rows.derivatives),
        gap=gap,
        direction=direction,
        direction_slope=vector("direction", rows.derivatives),
        force_direction=combined(np.add, direction, rub)
        if np.any(unrepeated(rub, 2))
        else direction,
        force=rows.values("force", system.force, size),
        weight=np.full(shape, 1.0 / rows.nodes.size),
        friction_direction=friction_directions(system, rows),
        friction_coefficients=friction_coefficients(system, rows),
        **_ramps(system, rows),
    )


def _evaluated_before(entries: list[Any], number: int) -> int | None:
    """Number of an earlier entry that is the same function, as for the ramps of a force law."""
    return next((i for i in range(number) if same_entry(entries[i], entries[number])), None)


def _ramps(system: System, rows: RowEvaluator) -> dict[str, Array]:
    """Stiffness and gap of the ramps of all contacts, filled up with ramps that carry nothing."""
    counts = [ramp_count(f"contacts[{j}]", each) for j, each in enumerate(system.contacts)]
    most = max(counts, default=0)
    out: dict[str, Array] = {}
    for name, filler in (("ramp_stiffness", 0.0), ("ramp_gap", 1.0)):
        still = np.full((len(counts), most), filler)
        table = np.broadcast_to(still, (*rows.nodes.shape, *still.shape))
        for j, contact in enumerate(system.clocked_contacts):
            if counts[j]:
                table = table if table.flags.writeable else table.copy()
                where = f"contacts[{j}].{name}"
                table[:, :, j, : counts[j]] = rows.values(where, getattr(contact, name), counts[j])
        least = table.min(initial=0.0)
        if least < -_ROUNDING * table.max(initial=0.0):
            what, why = f"{name} = {least:.6g}", "Ramps add stiffness beyond a dead zone"
            raise InputError(what, f"Contact.{name}", why, "Give no negative values")
        out[name] = table if least == 0.0 else np.maximum(table, 0.0)
    return out


def combined(operation: Callable[[Array, Array], Array], first: Array, second: Array) -> Array:
    """Combine values at all nodes of a grid, those that are the same at all of them only once."""
    if first.strides[:2] == second.strides[:2] == (0, 0):
        return np.broadcast_to(operation(first[:1, :1], second[:1, :1]), first.shape)
    return operation(first, second)


def _one_row(row: Array, shape: tuple[int, ...]) -> Array:
    """A row that is the same at all nodes."""
    return np.broadcast_to(row, (*shape, *row.shape))


def positive_gap(gap: Array) -> Array:
    """Dead zone with rounding below zero as zero; a negative one is refused."""
    values = unrepeated(gap)
    least = values.min(initial=0.0)
    if least == 0.0:
        return gap
    if least < -GAP_ROUNDING:
        what = f"gap = {least:.6g} m"
        why = "The gap is half the dead zone and cannot be negative"
        raise InputError(what, "Contact.gap", why, "Use `error` for an interference")
    return np.broadcast_to(np.maximum(values, 0.0), gap.shape)


def halved_grid(grid: Grid) -> Grid:
    """The grid with every step halved."""
    half, first = np.repeat(0.5 * grid.width, 2), np.arange(2 * grid.steps) % 2 == 0
    left = np.repeat(grid.left, 2) + np.where(first, 0.0, half)
    events = np.repeat(grid.after_event, 2) & first
    segments = (np.repeat(part, 2) for part in (grid.segment_left, grid.segment_right))
    return Grid(left, half, events, *segments)


def halved_nodes(system: System, grid: Grid, nodes: Nodes) -> tuple[Grid, Nodes]:
    """The grid with every step halved, and its rows, two thirds of which are reused."""
    half, count, fine = 0.5 * grid.width, grid.steps, halved_grid(grid)
    segments = grid.segment_left, grid.segment_right
    between = evaluate_nodes(
        system, Grid(grid.left + 0.5 * half, half, grid.after_event, *segments)
    )

    def joined(old: Array, new: Array) -> Array:
        if old.strides[:2] == new.strides[:2] == (0, 0):
            return _one_row(old[0, 0], (fine.steps, 3))
        rows = np.empty((count, 2, *old.shape[1:]))
        rows[:, 0, 0], rows[:, 0, 1], rows[:, 0, 2] = old[:, 0], new[:, 0], old[:, 1]
        rows[:, 1, 0], rows[:, 1, 1], rows[:, 1, 2] = old[:, 1], new[:, 2], old[:, 2]
        return rows.reshape(2 * count, *old.shape[1:])

    rows = Nodes(*(joined(old, new) for old, new in zip(nodes, between, strict=True)))
    return fine, rows._replace(weight=step_weights(fine))


def step_weights(grid: Grid) -> Array:
    """Weights of both ends and the middle of every step, (steps, 3)."""
    return grid.width[:, None] * _SIMPSON


def sampled(system: System, steps: int) -> tuple[Grid, Nodes]:
    """The grid of a system with ``steps`` steps in a period of the clock, and its rows."""
    grid = build_grid(system_events(system), steps)
    return grid, evaluate_nodes(system, grid)


def refuse_falling_force(nodes: Nodes) -> None:
    """Refuse dead zones beyond which the force of a mesh falls with compression."""
    phase, stiffness, gap = nodes.phase, nodes.stiffness, nodes.gap
    dead = np.flatnonzero(np.any(unrepeated(gap, 1) > 0.0, axis=(0, 1)))
    if not np.any(unrepeated(stiffness, 1)[:, :, dead] < 0.0):
        return
    floor, laws = -_ROUNDING * float(np.abs(stiffness).max()), force_laws(nodes)
    for j in dead:
        total = np.zeros(phase.shape)
        for i in np.flatnonzero(laws == laws[j]):
            total += np.where(gap[:, :, i] <= gap[:, :, j], stiffness[:, :, i], 0.0)
        if total.min() < floor:
            at = np.unravel_index(int(np.argmin(total)), total.shape)
            raise InputError(
                f"the force falls by {-total[at]:.4g} N per m of compression beyond "
                f"{1e6 * gap[(*at, j)]:.4g} um, at the mesh phase {phase[at]:.4g}",
                where=f"contacts[{j}].stiffness",
                why="The force of a contact rises with its compression: a falling force law has "
                "several compressions for one load",
                remedy="Give contacts with a dead zone stiffnesses whose sum, from the lowest "
                "to any other, is not negative",
            )


def force_laws(nodes: Nodes) -> Index:
    """Number of the force law of each contact: one direction and error belong to one law."""
    numbers = np.arange(nodes.stiffness.shape[2])
    for j in numbers:
        for i in range(j):
            rows = (nodes.direction, nodes.error)
            if all(np.array_equal(part[:, :, i], part[:, :, j]) for part in rows):
                numbers[j] = numbers[i]
                break
    return numbers


def lowest_of_each_law(nodes: Nodes) -> Mask:
    """Mark the contacts that no spring with a lower gap shares its compression with."""
    laws, places = force_laws(nodes), np.einsum("rs,rsj->j", nodes.weight, nodes.gap)
    stiff = nodes.stiffness.any(axis=(0, 1))
    lowest = np.ones(places.size, dtype=bool)
    for j in range(places.size):
        for i in np.flatnonzero(stiff & (laws == laws[j])):
            lowest[j] &= (places[i], i) >= (places[j], j)
    return lowest
