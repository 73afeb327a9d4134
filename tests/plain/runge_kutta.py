"""The classical Runge-Kutta scheme in plain NumPy."""

from __future__ import annotations

import numpy as np

from plain.lane import Motion, PlainLane
from tribodyn.dynamics import System
from tribodyn.dynamics.equations.grid import Grid
from tribodyn.dynamics.equations.nodes import Nodes
from tribodyn.types import Array


class _Lane(PlainLane):
    def advance(self, step: int, begin: float, end: float, old: Motion, side: Array) -> Motion:
        h = self.grid.width[step] / self.beat * (end - begin)
        rows = [self.row(step, tau) for tau in (begin, 0.5 * (begin + end), end)]

        def rate(row: Nodes, y: Array) -> Array:
            q, v = np.split(y, 2)
            return np.concatenate((v, self.acceleration(row, q, v, side)))

        y = np.concatenate((old.q, old.v))
        k1 = rate(rows[0], y)
        k2 = rate(rows[1], y + 0.5 * h * k1)
        k3 = rate(rows[1], y + 0.5 * h * k2)
        k4 = rate(rows[2], y + h * k3)
        q, v = np.split(y + h / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4), 2)
        return Motion(q, v, old.a)


def march_plain(
    system: System, grid: Grid, nodes: Nodes, mesh_frequency: float, cycles: int, state: Array
) -> Array:
    """March one trajectory."""
    return _Lane(system, grid, nodes, mesh_frequency).march(cycles, state)
