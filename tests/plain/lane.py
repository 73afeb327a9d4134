"""One trajectory in plain NumPy: events, and steps in which a contact changes its side.

The compiled engines are tested against it: the same grid and the same parts of steps, every line of
the physics readable, slower by a factor of thousands.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq

from tribodyn.dynamics import System
from tribodyn.dynamics.equations.grid import Grid
from tribodyn.dynamics.equations.motion import (
    clearance,
    compression,
    forces,
    has_gap,
    rows_within,
    sides,
)
from tribodyn.dynamics.equations.nodes import Nodes
from tribodyn.errors import ComputationError
from tribodyn.types import Array


class Motion(NamedTuple):
    """Position, velocity and acceleration."""

    q: Array
    v: Array
    a: Array


class PlainLane(ABC):
    """Splits steps; a method gives ``advance``."""

    def __init__(self, system: System, grid: Grid, nodes: Nodes, mesh_frequency: float) -> None:
        self.system, self.grid, self.nodes, self.beat = system, grid, nodes, mesh_frequency
        self.dead = has_gap(nodes)

    def row(self, step: int, tau: float) -> Nodes:
        return rows_within(self.nodes, np.array(step), np.array(tau))

    def acceleration(self, row: Nodes, q: Array, v: Array, side: Array) -> Array:
        return forces(self.system, row, self.beat, q, v, side=side).acceleration

    @abstractmethod
    def advance(self, step: int, begin: float, end: float, old: Motion, side: Array) -> Motion:
        """Step from one fraction of a step to another, with one force law."""

    def distances(self, step: int, tau: float, q: Array, side: Array, leaving: Array) -> Array:
        row = self.row(step, tau)
        return clearance(compression(row, q), row.gap, side, leaving)

    def crossing(
        self, step: int, begin: float, old: Motion, side: Array, j: int, end: Motion
    ) -> float:
        """Fraction of the step at which contact ``j`` leaves its side, 2 if it does not."""
        leaving = np.sign(compression(self.row(step, 1.0), end.q))
        if not self.distances(step, 1.0, end.q, side, leaving)[j] < 0.0:
            return 2.0

        def at(tau: float) -> float:
            moved = self.advance(step, begin, tau, old, side) if tau > begin else old
            return float(self.distances(step, tau, moved.q, side, leaving)[j])

        for inside in begin + (1.0 - begin) * np.arange(8) / 8.0:
            if at(inside) > 0.0:
                return float(brentq(at, inside, 1.0, xtol=1e-15, rtol=1e-14))
        return begin

    def step(self, step: int, old: Motion, side: Array) -> Motion:
        """March over one step in parts from crossing to crossing."""
        begin = 0.0
        for _ in range(17 + 4 * len(side)):
            new = self.advance(step, begin, 1.0, old, side)
            crossings = [
                (self.crossing(step, begin, old, side, int(j), new), int(j))
                for j in np.flatnonzero(self.dead)
            ]
            end, j = min(crossings, default=(2.0, -1))
            if end > 1.0:
                return new
            row = self.row(step, end)
            new = self.advance(step, begin, end, old, side)
            side[j] = 0.0 if side[j] else np.sign(compression(row, new.q)[j])
            old, begin = new._replace(a=self.acceleration(row, new.q, new.v, side)), end
        raise ComputationError(f"contact {j} opens and closes without end within one step")

    def march(self, cycles: int, state: Array) -> Array:
        """States before every step and at the end."""
        q, v = np.split(np.asarray(state, dtype=float), 2)
        now, side = Motion(q, v, np.zeros_like(q)), np.ones(len(self.system.contacts))
        record = [np.concatenate((now.q, now.v))]
        for step in list(range(self.grid.steps)) * cycles:
            if self.grid.after_event[step]:
                row = self.row(step, 0.0)
                side = sides(compression(row, now.q), row.gap, self.dead)
                now = now._replace(a=self.acceleration(row, now.q, now.v, side))
            now = self.step(step, now, side)
            record.append(np.concatenate((now.q, now.v)))
        return np.array(record)
