"""One adaptive step in plain NumPy: every line readable, nothing compiled.

The compiled step is tested against it. One trajectory, entries evaluated directly, each contact
on a given side of its dead zone.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tribodyn.dynamics import System
from tribodyn.dynamics._engine.dormand_prince import MATRIX, NODES, WEIGHT_ERROR
from tribodyn.dynamics.equations.grid import Grid
from tribodyn.dynamics.equations.motion import forces
from tribodyn.dynamics.equations.nodes import Nodes, evaluate_nodes
from tribodyn.types import Array


class PlainStep(NamedTuple):
    """A step and its error."""

    state: Array  #: position and velocity at the end [m or rad, m/s or rad/s]
    error: Array  #: difference between the solutions of fifth and fourth order, in the same units
    middle: Array  #: dense output in the middle of the step, in the same units


def _acceleration(system: System, phase: float, beat: float, y: Array, side: Array) -> Array:
    point = Grid(np.array([phase]), np.zeros(1), np.zeros(1, dtype=bool), np.zeros(1), np.ones(1))
    row = Nodes(*(values[0, 0] for values in evaluate_nodes(system, point)))
    q, v = np.split(y, 2)
    return forces(system, row, beat, q, v, side=side).acceleration


def step_plain(
    system: System, mesh_frequency: float, phase: float, width: float, state: Array, side: Array
) -> PlainStep:
    """Step one trajectory within a segment between two events."""
    n, h = system.size, width / mesh_frequency
    slopes = np.zeros((7, 2 * n))
    y = np.asarray(state, dtype=float)
    for s in range(7):
        y = state + h * MATRIX[s] @ slopes[:6]
        place = phase + NODES[s] * width
        slopes[s] = np.concatenate((y[n:], _acceleration(system, place, mesh_frequency, y, side)))
    return PlainStep(y, h * WEIGHT_ERROR @ slopes, _middle(state, y, slopes[0], slopes[6], h))


def _middle(start: Array, end: Array, first: Array, last: Array, h: float) -> Array:
    """Middle of the quintic through position, velocity and acceleration at both ends."""
    n = start.size // 2
    q0, q1, v0, v1, a0, a1 = start[:n], end[:n], first[:n], last[:n], first[n:], last[n:]
    position = 0.5 * (q0 + q1) + 5.0 / 32.0 * h * (v0 - v1) + h**2 / 64.0 * (a0 + a1)
    velocity = 15.0 / 8.0 * (q1 - q0) / h - 7.0 / 16.0 * (v0 + v1) + h / 32.0 * (a1 - a0)
    return np.concatenate((position, velocity))
