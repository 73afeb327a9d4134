"""Newmark's scheme in plain NumPy: every line of the physics readable, nothing compiled.

The compiled engine is tested against it. One trajectory, the same grid, the same splitting of
steps in which a contact changes its side; Newton's method on all accelerations with the tangent
of the contacts that touch.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tribodyn.dynamics.grid import Grid
from tribodyn.dynamics.program import Nodes
from tribodyn.dynamics.system import System
from tribodyn.errors import ComputationError
from tribodyn.types import Array

_PASSES = 25


class _Row(NamedTuple):
    """Everything that varies, at one mesh phase."""

    stiffness: Array
    damping: Array
    error: Array
    error_slope: Array
    gap: Array
    direction: Array
    direction_slope: Array
    force_direction: Array
    force: Array
    friction_direction: Array
    friction_coefficients: Array


class _Motion(NamedTuple):
    """Position, velocity and acceleration."""

    q: Array
    v: Array
    a: Array


def _row_within(rows: list[_Row], tau: float) -> _Row:
    weights = ((1 - tau) * (1 - 2 * tau), 4 * tau * (1 - tau), tau * (2 * tau - 1))
    return _Row(*(sum(w * part for w, part in zip(weights, parts, strict=True))
                  for parts in zip(*rows, strict=True)))  # fmt: skip


class _Lane:
    """One trajectory."""

    def __init__(self, system: System, mesh_frequency: float, gamma: float, beta: float) -> None:
        self.mass, self.damping, self.stiffness = (
            np.asarray(part) for part in (system.mass, system.damping, system.stiffness)
        )
        self.beat, self.gamma, self.beta = mesh_frequency, gamma, beta
        self.free = np.array([contact.damping_in_gap for contact in system.contacts], dtype=bool)
        self.frictions = system.frictions

    def force(self, row: _Row, q: Array, v: Array, side: Array) -> tuple[Array, Array, Array]:
        """Generalized force, and its derivatives by position and velocity."""
        stiffness = np.abs(side) * row.stiffness
        damping = np.where((side != 0.0) | self.free, row.damping, 0.0)
        compression = row.direction @ q - row.error
        rate = row.direction @ v + self.beat * (row.direction_slope @ q - row.error_slope)
        contact = stiffness * (compression - side * row.gap) + damping * rate
        push = row.force_direction.T
        friction = np.zeros(row.force.size)
        for f, one in enumerate(self.frictions):
            carried = contact[list(one.contacts)].sum()
            x, bends = min(abs(carried) / one.load, one.limit), abs(carried) < one.limit * one.load
            law = np.polynomial.Polynomial(row.friction_coefficients[f])
            friction = friction + row.friction_direction[f] * carried * law(x)
            push = push.copy()
            slope = law(x) + (x * law.deriv()(x) if bends else 0.0)
            push[:, list(one.contacts)] += (row.friction_direction[f] * slope)[:, None]
        by_q = stiffness[:, None] * row.direction
        by_q = by_q + self.beat * damping[:, None] * row.direction_slope
        by_v = damping[:, None] * row.direction
        inner = self.stiffness @ q + self.damping @ v
        total = row.force - inner - row.force_direction.T @ contact - friction
        return total, -self.stiffness - push @ by_q, -self.damping - push @ by_v

    def start(self, row: _Row, q: Array, v: Array, side: Array) -> _Motion:
        """Acceleration found anew."""
        return _Motion(q, v, np.linalg.solve(self.mass, self.force(row, q, v, side)[0]))

    def step(self, row: _Row, h: float, old: _Motion, side: Array) -> _Motion:
        """One step; ``row`` is that of its end."""
        q0 = old.q + h * old.v + (0.5 - self.beta) * h * h * old.a
        v0 = old.v + (1.0 - self.gamma) * h * old.a
        a = old.a
        for _ in range(_PASSES):
            q, v = q0 + self.beta * h * h * a, v0 + self.gamma * h * a
            force, by_q, by_v = self.force(row, q, v, side)
            matrix = self.mass - self.gamma * h * by_v - self.beta * h * h * by_q
            correction = np.linalg.solve(matrix, force - self.mass @ a)
            a = a + correction
            if np.abs(correction).max() <= 1e-9 * np.abs(a).max():
                break
        return _Motion(q0 + self.beta * h * h * a, v0 + self.gamma * h * a, a)

    def part(
        self, rows: list[_Row], begin: float, end: float, h: float, old: _Motion, side: Array
    ) -> _Motion:
        return self.step(_row_within(rows, end), h * (end - begin), old, side)

    @staticmethod
    def compression(row: _Row, q: Array, j: int) -> float:
        return float(row.direction[j] @ q - row.error[j])

    def clearance(self, row: _Row, q: Array, side: Array, j: int, leaving: float) -> float:
        """Distance to the boundary of a side; in the gap, to the one in direction ``leaving``."""
        d = self.compression(row, q, j)
        return float(side[j] * d - row.gap[j] if side[j] else row.gap[j] - leaving * d)

    def beyond(self, row: _Row, q: Array, side: Array, j: int) -> bool:
        leaving = float(np.sign(self.compression(row, q, j)))
        return self.clearance(row, q, side, j, leaving) < 0.0

    def crossing(
        self, rows: list[_Row], begin: float, h: float, old: _Motion, side: Array, j: int
    ) -> float:
        """Fraction of the step at which contact ``j`` leaves its side, 2 if it does not."""
        end = self.part(rows, begin, 1.0, h, old, side)
        if not self.beyond(rows[2], end.q, side, j):
            return 2.0
        from scipy.optimize import brentq

        leaving = float(np.sign(self.compression(rows[2], end.q, j)))

        def at(tau: float) -> float:
            moved = self.part(rows, begin, tau, h, old, side) if tau > begin else old
            return self.clearance(_row_within(rows, tau), moved.q, side, j, leaving)

        for inside in begin + (1.0 - begin) * np.arange(8) / 8.0:
            if at(inside) > 0.0:
                return float(brentq(at, inside, 1.0, xtol=1e-15, rtol=1e-14))
        return begin

    def split(self, rows: list[_Row], h: float, old: _Motion, side: Array, dead: Array) -> _Motion:
        begin = 0.0
        for _ in range(17 + 4 * len(side)):
            found = [
                (self.crossing(rows, begin, h, old, side, int(j)), int(j))
                for j in np.flatnonzero(dead)
            ]
            end, j = min(found)
            if end > 1.0:
                return self.part(rows, begin, 1.0, h, old, side)
            row = _row_within(rows, end)
            new = self.part(rows, begin, end, h, old, side)
            side[j] = 0.0 if side[j] else np.sign(self.compression(row, new.q, j))
            old, begin = self.start(row, new.q, new.v, side), end
        raise ComputationError(f"contact {j} opens and closes without end within one step")

    def sides(self, row: _Row, q: Array, dead: Array) -> Array:
        d = row.direction @ q - row.error
        inside = np.where(d > row.gap, 1.0, np.where(d < -row.gap, -1.0, 0.0))
        return np.where(dead, inside, 1.0)


def newmark_plain(
    system: System, grid: Grid, nodes: Nodes, mesh_frequency: float, cycles: int, state: Array,
    gamma: float = 0.5, beta: float = 0.25,
) -> Array:  # fmt: skip
    """March one trajectory."""
    lane = _Lane(system, mesh_frequency, gamma, beta)
    dead = np.any(nodes.gap > 0.0, axis=(0, 1))
    q, v = np.split(np.asarray(state, dtype=float), 2)
    now, side = _Motion(q, v, np.zeros_like(q)), np.ones(len(system.contacts))
    record = [np.concatenate((now.q, now.v))]
    for _ in range(cycles):
        for step in range(grid.steps):
            rows = [
                _Row(*(getattr(nodes, name)[step, node] for name in _Row._fields))
                for node in range(3)
            ]
            h = grid.width[step] / mesh_frequency
            if grid.after_event[step]:
                side = lane.sides(rows[0], now.q, dead)
                now = lane.start(rows[0], now.q, now.v, side)
            new = lane.step(rows[2], h, now, side)
            if any(lane.beyond(rows[2], new.q, side, int(j)) for j in np.flatnonzero(dead)):
                new = lane.split(rows, h, now, side, dead)
            now = new
            record.append(np.concatenate((now.q, now.v)))
    return np.array(record)
