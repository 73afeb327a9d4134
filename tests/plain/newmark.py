"""Newmark's scheme in plain NumPy: Newton's method on all accelerations of a step."""

from __future__ import annotations

import numpy as np

from plain.lane import Motion, PlainLane
from tribodyn.dynamics import System
from tribodyn.dynamics.equations.grid import Grid
from tribodyn.dynamics.equations.motion import forces
from tribodyn.dynamics.equations.nodes import (
    Nodes,
    carried_load,
    friction_tangent,
    push_with_friction,
)
from tribodyn.types import Array

_PASSES = 25


class _Lane(PlainLane):
    gamma, beta = 0.5, 0.25

    def tangent(self, row: Nodes, contact: Array, side: Array) -> tuple[Array, Array]:
        """Derivatives of the generalized force by position and velocity."""
        system = self.system
        free = np.array([part.damping_in_gap for part in system.contacts], dtype=bool)
        damping = np.where((side != 0.0) | free, row.damping, 0.0)[:, None]
        by_q = (np.abs(side) * row.stiffness)[:, None] * row.direction
        by_q = by_q + self.beat * damping * row.direction_slope
        push = row.force_direction
        if system.frictions:
            load = carried_load(system, contact)
            slope = friction_tangent(system, row.friction_coefficients, load)
            push = push_with_friction(system, row, slope)
        stiffness, viscous = np.asarray(system.stiffness), np.asarray(system.damping)
        return -stiffness - push.T @ by_q, -viscous - push.T @ (damping * row.direction)

    def advance(self, step: int, begin: float, end: float, old: Motion, side: Array) -> Motion:
        h = self.grid.width[step] / self.beat * (end - begin)
        row, mass = self.row(step, end), np.asarray(self.system.mass)
        q0 = old.q + h * old.v + (0.5 - self.beta) * h * h * old.a
        v0 = old.v + (1.0 - self.gamma) * h * old.a
        late, fast = self.beta * h * h, self.gamma * h
        a = old.a
        for _ in range(_PASSES):
            law = forces(self.system, row, self.beat, q0 + late * a, v0 + fast * a, side)
            by_q, by_v = self.tangent(row, law.contact, side)
            matrix = mass - fast * by_v - late * by_q
            correction = np.linalg.solve(matrix, mass @ (law.acceleration - a))
            a = a + correction
            if np.abs(correction).max() <= 1e-9 * np.abs(a).max():
                break
        return Motion(q0 + late * a, v0 + fast * a, a)


def newmark_plain(
    system: System, grid: Grid, nodes: Nodes, mesh_frequency: float, cycles: int, state: Array,
    gamma: float = 0.5, beta: float = 0.25,
) -> Array:  # fmt: skip
    """March one trajectory."""
    lane = _Lane(system, grid, nodes, mesh_frequency)
    lane.gamma, lane.beta = gamma, beta
    return lane.march(cycles, state)
