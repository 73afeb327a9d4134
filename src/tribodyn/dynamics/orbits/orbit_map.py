"""The map whose fixed point is a periodic orbit: the reduced state over one period.

With a balancing torque its size is one more unknown: what the free motion of the drive gains over
the period is what the torque has to take away.
"""

from __future__ import annotations

import numpy as np

from tribodyn.dynamics._engine.blocks import march
from tribodyn.dynamics.equations.compiled import Compiled
from tribodyn.dynamics.equations.system import System
from tribodyn.dynamics.orbits.coordinates import (
    OrbitCoordinates,
    orbit_coordinates,
    refuse_disconnected,
)
from tribodyn.errors import InputError, Problem
from tribodyn.types import Array, ComplexArray


class OrbitMap:
    """The reduced state, and the balancing torque if there is one, over one period."""

    def __init__(
        self,
        compiled: Compiled,
        mesh_frequency: float,
        periods: int,
        coordinates: OrbitCoordinates | None = None,
        width: int | None = 1,
    ) -> None:
        self.width, self.threads = width, None if width else 1
        self.compiled = compiled
        refuse_disconnected(compiled)
        self.coordinates = coordinates or orbit_coordinates(compiled, mesh_frequency)
        self.period = 1.0 / mesh_frequency
        self.periods = periods
        self.cycles = 0
        self.contacts = len(compiled.system.contacts)
        self.balance = _balance_direction(compiled.system, self.coordinates)

    def split(self, y: Array) -> tuple[Array, Array]:
        """Take a reduced vector apart."""
        y = np.atleast_2d(y)
        if self.balance is None:
            return self.coordinates.expand(y), np.zeros((y.shape[0], self.compiled.system.size))
        _, force, _ = self.balance
        return self.coordinates.expand(y[:, :-1]), y[:, -1:] * force / self._span

    @property
    def _span(self) -> float:
        return self.period * self.periods

    def __call__(self, y: Array) -> Array:
        """Map (k,) or (m, k)."""
        state, extra = self.split(y)
        period = np.full(state.shape[0], self.period)
        new = march(
            self.compiled, period, state, self.periods, extra_force=extra,
            width=self.width if state.shape[0] < 32 else None, threads=self.threads,
        )  # fmt: skip
        self.cycles += self.periods
        reduced = self._image(np.atleast_2d(y), new)
        return reduced[0] if y.ndim == 1 else reduced

    def _image(self, y: Array, new: Array) -> Array:
        reduced = self.coordinates.reduce(new)
        if self.balance is None:
            return reduced
        direction, _, _ = self.balance
        # What the free motion gained over the period is what the torque has to take away.
        gained = self.coordinates.free_velocity(new) @ direction
        return np.column_stack((reduced, y[:, -1] - gained))

    def follow(self, y: Array) -> tuple[Array, Array]:
        """Map one vector and keep every state on the way."""
        state, extra = self.split(y)
        record = np.empty((self.periods * self.compiled.grid.steps + 1, state.shape[1], 1))
        new = march(
            self.compiled, np.array([self.period]), state, self.periods, extra_force=extra,
            record=record, threads=1,
        )  # fmt: skip
        self.cycles += self.periods
        return self._image(y[None], new)[0], record[:, :, 0]

    @property
    def affine(self) -> bool:
        """Whether the map is linear but for a constant: no dead zone, no friction that bends."""
        code = self.compiled.program.code
        if self.compiled.nodes.friction_coefficients.shape[-1] > 1:
            return False
        return not any(code[4 + 4 * j + 2] for j in range(self.contacts))

    def multipliers(self, matrix: Array) -> ComplexArray:
        """Floquet multipliers under a held torque, the largest first."""
        inner = matrix if self.balance is None else matrix[:-1, :-1]
        values = np.linalg.eigvals(inner).astype(complex)
        return np.asarray(values[np.argsort(-np.abs(values), kind="stable")])

    def record(self, y: Array) -> tuple[Array, Array]:
        """March one period and keep every state."""
        state, extra = self.split(y)
        steps = self.compiled.grid.steps
        record = np.empty((self.periods * steps + 1, state.shape[1], 1))
        march(
            self.compiled, np.array([self.period]), state, self.periods, extra_force=extra,
            record=record,
        )  # fmt: skip
        return self.without_drift(record[:, :, 0]), extra[0]

    def without_drift(self, states: Array) -> Array:
        """Take the mean speed and mean acceleration out of the free motions, in place."""
        c, size = self.coordinates, self.compiled.system.size
        phase = np.concatenate(
            [cycle + self.compiled.nodes.phase[:, 0] for cycle in range(self.periods)]
            + [np.array([float(self.periods)])]
        )
        time = phase[:, None] * self.period
        end = time[-1]
        unmoved = np.linalg.solve(c.lower.T, np.eye(size))
        for basis in (c.free, _complement(c.elastic, c.free)):
            if basis.shape[1] == 0:
                continue
            speed = states[:, size:] @ c.lower @ basis
            place = states[:, :size] @ c.lower @ basis
            rise = (speed[-1] - speed[0]) / end
            speed = speed - rise * time
            place = place - 0.5 * rise * time**2
            drift = (place[-1] - place[0]) / end
            place = place - drift * time
            middle = place[:-1].mean(axis=0)
            kept = states[:, :size] @ c.lower @ basis
            states[:, :size] += (place - middle - kept) @ basis.T @ unmoved.T
            if basis is c.free:
                kept = states[:, size:] @ c.lower @ basis
                states[:, size:] += (speed - drift - kept) @ basis.T @ unmoved.T
        return states


def _complement(elastic: Array, free: Array) -> Array:
    """Motions whose speed matters but whose place does not."""
    both = np.hstack((elastic, free))
    size = both.shape[0]
    if both.shape[1] == size:
        return np.zeros((size, 0))
    _, _, rows = np.linalg.svd(both.T)
    return np.asarray(rows[both.shape[1] :].T)


def _balance_direction(
    system: System, coordinates: OrbitCoordinates
) -> tuple[Array, Array, float] | None:
    """Direction of the free motion that the balancing torque drives, and the torque for 1 m/s."""
    if system.balance is None:
        return None
    force = np.asarray(system.balance)
    push = coordinates.free.T @ np.linalg.solve(coordinates.lower, force)
    strength = float(np.linalg.norm(push))
    if strength < 1e-12 * float(np.linalg.norm(np.linalg.solve(coordinates.lower, force))):
        raise InputError(
            Problem(
                what="balance does not drive any free motion",
                where="System.balance",
                why="The structure holds the drive in place, so no torque needs balancing",
                remedy="Leave balance out",
            )
        )
    return push / strength, force / strength, strength
