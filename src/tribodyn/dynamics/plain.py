"""The kernel in plain NumPy: every line of the physics readable, nothing compiled.

Slow by a factor of thousands; the compiled kernel is tested against it. One trajectory, the same
grid, the same scheme, the same splitting of steps in which a contact changes its side.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tribodyn.dynamics.grid import Grid
from tribodyn.dynamics.program import Nodes
from tribodyn.dynamics.system import System
from tribodyn.errors import ComputationError
from tribodyn.types import Array


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


def _rows_of_step(nodes: Nodes, step: int) -> list[_Row]:
    return [_Row(*(getattr(nodes, name)[step, node] for name in _Row._fields)) for node in range(3)]


def _row_within(rows: list[_Row], tau: float) -> _Row:
    weights = ((1 - tau) * (1 - 2 * tau), 4 * tau * (1 - tau), tau * (2 * tau - 1))
    return _Row(*(sum(w * part for w, part in zip(weights, parts, strict=True))
                  for parts in zip(*rows, strict=True)))  # fmt: skip


class _Lane:
    """One trajectory."""

    def __init__(self, system: System, mesh_frequency: float) -> None:
        self.system = system
        self.beat = mesh_frequency
        self.inverse = np.linalg.inv(np.asarray(system.mass))
        self.free = np.array([contact.damping_in_gap for contact in system.contacts], dtype=bool)

    def acceleration(self, row: _Row, q: Array, v: Array, side: Array) -> Array:
        compression = row.direction @ q - row.error
        rate = row.direction @ v + self.beat * (row.direction_slope @ q - row.error_slope)
        spring = np.abs(side) * row.stiffness * (compression - side * row.gap)
        damper = np.where((side != 0.0) | self.free, row.damping * rate, 0.0)
        load = spring + damper
        contact = row.force_direction.T @ load
        for f, friction in enumerate(self.system.frictions):
            force = sum(load[j] for j in friction.contacts)
            x = min(abs(force) / friction.load, friction.limit)
            ratio = sum(c * x**k for k, c in enumerate(row.friction_coefficients[f]))
            contact = contact + row.friction_direction[f] * (force * ratio)
        inner = np.asarray(self.system.stiffness) @ q + np.asarray(self.system.damping) @ v
        return np.asarray(self.inverse @ (row.force - inner - contact))

    def runge_kutta(self, rows: list[_Row], h: float, y: Array, side: Array) -> Array:
        size = self.system.size

        def rate(row: _Row, y: Array) -> Array:
            q, v = y[:size], y[size:]
            return np.concatenate((v, self.acceleration(row, q, v, side)))

        k1 = rate(rows[0], y)
        k2 = rate(rows[1], y + 0.5 * h * k1)
        k3 = rate(rows[1], y + 0.5 * h * k2)
        k4 = rate(rows[2], y + h * k3)
        return np.asarray(y + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4))

    def part(
        self, rows: list[_Row], begin: float, end: float, h: float, y: Array, side: Array
    ) -> Array:
        own = [_row_within(rows, tau) for tau in (begin, 0.5 * (begin + end), end)]
        return self.runge_kutta(own, h * (end - begin), y, side)

    def compression(self, row: _Row, y: Array, j: int) -> float:
        return float(row.direction[j] @ y[: self.system.size] - row.error[j])

    def clearance(self, row: _Row, y: Array, side: Array, j: int, leaving: float) -> float:
        """Distance to the boundary of a side; in the gap, to the one in direction ``leaving``."""
        d = self.compression(row, y, j)
        return float(side[j] * d - row.gap[j] if side[j] else row.gap[j] - leaving * d)

    def beyond(self, row: _Row, y: Array, side: Array, j: int) -> bool:
        return self.clearance(row, y, side, j, np.sign(self.compression(row, y, j))) < 0.0

    def crossing(
        self, rows: list[_Row], begin: float, h: float, y: Array, side: Array, j: int
    ) -> float:
        """Fraction of the step at which contact ``j`` leaves its side, 2 if it does not."""
        end = self.part(rows, begin, 1.0, h, y, side)
        if not self.beyond(rows[2], end, side, j):
            return 2.0
        from scipy.optimize import brentq

        leaving = float(np.sign(self.compression(rows[2], end, j)))

        def at(tau: float) -> float:
            moved = self.part(rows, begin, tau, h, y, side) if tau > begin else y
            return self.clearance(_row_within(rows, tau), moved, side, j, leaving)

        for inside in begin + (1.0 - begin) * np.arange(8) / 8.0:
            if at(inside) > 0.0:
                return float(brentq(at, inside, 1.0, xtol=1e-15, rtol=1e-14))
        return begin

    def split(self, rows: list[_Row], h: float, y: Array, side: Array, dead: Array) -> Array:
        begin = 0.0
        for _ in range(17 + 4 * len(side)):
            found = [
                (self.crossing(rows, begin, h, y, side, int(j)), int(j))
                for j in np.flatnonzero(dead)
            ]
            end, j = min(found)
            if end > 1.0:
                return self.part(rows, begin, 1.0, h, y, side)
            y = self.part(rows, begin, end, h, y, side)
            side[j] = 0.0 if side[j] else np.sign(self.compression(_row_within(rows, end), y, j))
            begin = end
        raise ComputationError(f"contact {j} opens and closes without end within one step")

    def sides(self, row: _Row, y: Array, dead: Array) -> Array:
        compression = row.direction @ y[: self.system.size] - row.error
        inside = np.where(compression > row.gap, 1.0, np.where(compression < -row.gap, -1.0, 0.0))
        return np.where(dead, inside, 1.0)


def march_plain(
    system: System, grid: Grid, nodes: Nodes, mesh_frequency: float, cycles: int, state: Array
) -> Array:
    """March one trajectory."""
    lane = _Lane(system, mesh_frequency)
    dead = np.any(nodes.gap > 0.0, axis=(0, 1))
    y = np.asarray(state, dtype=float)
    side = np.ones(len(system.contacts))
    record = [y]
    for _ in range(cycles):
        for step in range(grid.steps):
            rows, h = _rows_of_step(nodes, step), grid.width[step] / mesh_frequency
            if grid.after_event[step]:
                side = lane.sides(rows[0], y, dead)
            new = lane.runge_kutta(rows, h, y, side)
            if any(lane.beyond(rows[2], new, side, int(j)) for j in np.flatnonzero(dead)):
                new = lane.split(rows, h, y, side, dead)
            y = new
            record.append(y)
    return np.array(record)
