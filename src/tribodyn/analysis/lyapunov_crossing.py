"""Disturbances carried over steps in which a contact opens or closes.

A disturbed motion reaches the boundary of the dead zone at another time, and the damping force
jumps there: the disturbance jumps too, by the saltation matrix
``I + (f_after - f_before) grad(g)^T / (dg/dt)`` of the boundary ``g(q, t) = 0``.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tribodyn.analysis.lyapunov_tangent import TangentTables, within
from tribodyn.dynamics.crossing_search import most_splits
from tribodyn.dynamics.unparted import unparted_step
from tribodyn.errors import ComputationError
from tribodyn.types import Array, Index, Mask

_ROOT_LIMIT = 60
_NAMES = (
    "stiffness", "damping", "error", "error_slope", "gap", "direction", "direction_slope",
    "force_direction", "force",
)  # fmt: skip


class _Lanes(NamedTuple):
    """Motions within one step each: step, fraction done, state, sides of the dead zones."""

    steps: Index
    begin: Array
    state: Array
    side: Array

    def take(self, which: Index) -> _Lanes:
        return _Lanes(self.steps[which], self.begin[which], self.state[which], self.side[which])


class _Engine:
    """The Runge-Kutta step in plain NumPy, for many parts of steps at once."""

    def __init__(self, tables: TangentTables, extra_force: Array) -> None:
        self.tables = tables
        system = tables.compiled.system
        self.nodes = tables.nodes
        self.inverse = np.linalg.inv(np.asarray(system.mass))
        self.spring, self.damper = np.asarray(system.stiffness), np.asarray(system.damping)
        self.extra = extra_force
        self.beat = tables.mesh_frequency

    def compression(self, lanes: _Lanes, tau: Array) -> tuple[Array, Array]:
        """Compression and gap of every contact at a fraction of the step, (m, contacts)."""
        at = tau[:, None]
        direction, error, gap = (
            within(getattr(self.nodes, name), lanes.steps, at)[:, 0]
            for name in ("direction", "error", "gap")
        )
        place = lanes.state[:, : direction.shape[-1]]
        return np.einsum("mji,mi->mj", direction, place) - error, gap

    def forces(self, rows: dict[str, Array], node: int, state: Array, side: Array) -> Array:
        size = self.spring.shape[0]
        q, v = state[:, :size], state[:, size:]
        row = {name: values[:, node] for name, values in rows.items()}
        d = np.einsum("mji,mi->mj", row["direction"], q) - row["error"]
        rate = np.einsum("mji,mi->mj", row["direction"], v)
        rate += self.beat * np.einsum("mji,mi->mj", row["direction_slope"], q)
        rate -= self.beat * row["error_slope"]
        carried = np.abs(side) * row["stiffness"] * (d - side * row["gap"])
        carried += ((side != 0.0) | self.tables.in_gap) * row["damping"] * rate
        total = row["force"] + self.extra - q @ self.spring.T - v @ self.damper.T
        total = total - np.einsum("mji,mj->mi", row["force_direction"], carried)
        return np.concatenate((v, total @ self.inverse.T), axis=1)

    def advance(self, lanes: _Lanes, end: Array) -> _Lanes:
        """March every lane to a fraction of its step."""
        taus = np.stack((lanes.begin, 0.5 * (lanes.begin + end), end), axis=1)
        rows = {name: within(getattr(self.nodes, name), lanes.steps, taus) for name in _NAMES}
        h = (self.tables.width[lanes.steps] * (end - lanes.begin))[:, None]
        y, side = lanes.state, lanes.side
        k1 = self.forces(rows, 0, y, side)
        k2 = self.forces(rows, 1, y + 0.5 * h * k1, side)
        k3 = self.forces(rows, 1, y + 0.5 * h * k2, side)
        k4 = self.forces(rows, 2, y + h * k3, side)
        return lanes._replace(begin=end, state=y + h / 6.0 * (k1 + 2.0 * (k2 + k3) + k4))

    def clearance(self, lanes: _Lanes, leaving: Array) -> Array:
        """Distance of every contact to the boundary of its side, (m, contacts)."""
        d, gap = self.compression(lanes, lanes.begin)
        return np.where(lanes.side != 0.0, lanes.side * d - gap, gap - leaving * d)


def carry_over_crossings(
    tables: TangentTables, extra_force: Array, steps: Index, state: Array, side: Array
) -> tuple[Array, Array]:
    """Matrices that carry a disturbance over steps in which contacts open or close."""
    engine = _Engine(tables, extra_force)
    count = steps.size
    matrix = np.broadcast_to(np.eye(tables.size), (count, tables.size, tables.size)).copy()
    trace = np.zeros(count)
    lanes = _Lanes(steps, np.zeros(count), state, side.copy())
    waiting = np.arange(count)
    most = most_splits.py_func(tables.dead.size)  # compiled for compiled callers only
    for number in range(most + 1):
        ends = engine.advance(lanes, np.ones(waiting.size))
        place, _ = engine.compression(ends, ends.begin)
        leaving = np.where(place > 0.0, 1.0, -1.0)
        beyond = tables.dead & (engine.clearance(ends, leaving) < 0.0)
        stop, contact = _first_crossing(engine, lanes, leaving, beyond)
        crossed = stop <= 1.0
        if number == most and crossed.any():
            raise _unparted(tables, int(lanes.steps[crossed][0]), int(contact[crossed][0]))
        stop = np.where(crossed, stop, 1.0)
        part, gained = tables.part_steps(lanes.steps, lanes.begin, stop, lanes.side != 0.0)
        matrix[waiting] = part @ matrix[waiting]
        trace[waiting] += gained
        which = np.flatnonzero(crossed)
        if which.size == 0:
            break
        waiting = waiting[which]
        lanes = engine.advance(lanes.take(which), stop[which])
        jump = _saltation(tables, engine, lanes, contact[which])
        matrix[waiting] = jump @ matrix[waiting]
        row = np.arange(which.size)
        old = lanes.side[row, contact[which]]
        new = leaving[which, contact[which]]
        lanes.side[row, contact[which]] = np.where(old != 0.0, 0.0, new)
    return matrix, trace


def _unparted(tables: TangentTables, step: int, contact: int) -> ComputationError:
    phase = float(tables.compiled.grid.left[step])
    return unparted_step(contact, tables.dead.size, phase, phase / tables.mesh_frequency, None)


def _first_crossing(
    engine: _Engine, lanes: _Lanes, leaving: Array, beyond: Mask
) -> tuple[Array, Index]:
    """Fraction at which the first contact leaves its side (2 if none does), and which it is."""
    found = np.full(beyond.shape, 2.0)
    for j in range(beyond.shape[1]):
        which = np.flatnonzero(beyond[:, j])
        if which.size:
            found[which, j] = _root(engine, lanes.take(which), leaving[which], j)
    first = np.asarray(np.argmin(found, axis=1), dtype=np.int64)
    return np.asarray(np.min(found, axis=1)), first


def _root(engine: _Engine, lanes: _Lanes, leaving: Array, contact: int) -> Array:
    """Fraction at which one contact leaves its side, by the Illinois method."""

    def clear(tau: Array) -> Array:
        return engine.clearance(engine.advance(lanes, tau), leaving)[:, contact]

    high = np.ones(lanes.begin.size)
    g_high, low, g_low = clear(high), lanes.begin.copy(), clear(lanes.begin)
    scale = np.abs(g_high - g_low)
    # A contact just made begins on its boundary, to rounding: look for a place inside.
    for eighth in range(1, 8):
        outside = g_low <= 1e-9 * scale
        if not outside.any():
            break
        tau = np.where(outside, lanes.begin + 0.125 * eighth * (1.0 - lanes.begin), low)
        low, g_low = tau, np.where(outside, clear(tau), g_low)
    never = g_low <= 1e-9 * scale
    for _ in range(_ROOT_LIMIT):
        width = np.where(g_high != g_low, g_high - g_low, 1.0)
        tau = (low * g_high - high * g_low) / width
        g = clear(tau)
        if np.all(never | (np.abs(g) <= 1e-14 * scale) | (np.abs(high - low) < 1e-14)):
            break
        flips = g * g_high < 0.0
        low, g_low = np.where(flips, high, low), np.where(flips, g_high, 0.5 * g_low)
        high, g_high = tau, g
    return np.where(never, lanes.begin, tau)


def _saltation(tables: TangentTables, engine: _Engine, lanes: _Lanes, contact: Index) -> Array:
    """Matrix of the jump of a disturbance where a contact opens or closes."""
    row, at = np.arange(contact.size), lanes.begin[:, None]

    def own(values: Array) -> Array:
        return np.asarray(within(values, lanes.steps, at)[row, 0, contact])

    nodes, size = engine.nodes, engine.spring.shape[0]
    q, v = lanes.state[:, :size], lanes.state[:, size:]
    side = lanes.side[row, contact]
    direction, slope = own(nodes.direction), own(nodes.direction_slope)
    rate = np.einsum("mi,mi->m", direction, v)
    rate += engine.beat * (np.einsum("mi,mi->m", slope, q) - own(nodes.error_slope))
    # The clearance changes by the compression and by the gap itself.
    place = np.einsum("mi,mi->m", direction, q) - own(nodes.error)
    flank = np.where(side != 0.0, side, np.where(place > 0.0, 1.0, -1.0))
    relative = rate - flank * _gap_rate(engine, lanes.steps, at)[row, contact]
    ratio = np.divide(rate, relative, out=np.ones_like(rate), where=relative != 0.0)
    entering = np.where(side == 0.0, 1.0, -1.0) * ~tables.in_gap[contact]
    strength = entering * own(nodes.damping) * ratio
    push, feel = own(tables.push), own(tables.feel)
    jump = strength[:, None, None] * push[:, :, None] * feel[:, None, :]
    return np.asarray(np.eye(tables.size) - jump)


def _gap_rate(engine: _Engine, steps: Index, at: Array) -> Array:
    """Time derivative of the gaps within a step (m, contacts)."""
    left, middle, right = (engine.nodes.gap[steps, node] for node in range(3))
    slope = (4.0 * at - 3.0) * left + (4.0 - 8.0 * at) * middle + (4.0 * at - 1.0) * right
    return np.asarray(slope / engine.tables.width[steps][:, None])
