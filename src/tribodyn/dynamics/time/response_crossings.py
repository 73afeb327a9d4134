"""Samples of a response where a contact opens or closes within a step.

The damping force jumps there, and Simpson's rule over the step would be off by the jump times the
step. The step and a neighbour without crossing are sampled anew, as the part before the crossing
and the part after it: as many samples, none of them across the jump.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tribodyn.dynamics.equations.compiled import Compiled
from tribodyn.dynamics.equations.motion import (
    Forces,
    clearance,
    forces,
    quadratic,
    rows_within,
    with_middles,
    within_steps,
)
from tribodyn.dynamics.equations.step_limit import LIMIT
from tribodyn.types import Array, Index, Mask

_HALVINGS = 48
#: Contacts that cross nearer to each other, as parts of a step, cross together.
_TOGETHER = 1e-9


class Resampled(NamedTuple):
    """Three samples of each of some steps, in place of those that they had."""

    step: Index  #: numbers of the steps, counted from the beginning
    phase: Array  #: [-]
    weight: Array  #: [-]
    position: Array  #: [m or rad, ...]
    velocity: Array  #: [m or rad, ...]
    forces: Forces


class _Points:
    """The equation of motion at points within steps, each with the sides of its contacts."""

    def __init__(self, compiled: Compiled, frequency: float, extra: Array) -> None:
        self.compiled, self.frequency, self.extra = compiled, frequency, extra

    def at(self, step: Index, tau: Array, q: Array, v: Array, side: Array) -> Forces:
        """Forces and accelerations."""
        rows = rows_within(self.compiled.nodes, step, tau)
        return forces(self.compiled.system, rows, self.frequency, q, v, side=side, extra=self.extra)

    def duration(self, step: Index) -> Array:
        """Time of whole steps."""
        grid = self.compiled.grid
        return grid.width[step % grid.steps] / self.frequency

    def advance(self, step: Index, tau: Array, state: Array, side: Array) -> Array:
        """March from the beginning of a step to a fraction of it by one Runge-Kutta step."""
        h = (tau * self.duration(step))[:, None]

        def slope(part: float, y: Array) -> Array:
            q, v = np.split(y, 2, axis=1)
            return np.hstack((v, self.at(step, part * tau, q, v, side).acceleration))

        k1 = slope(0.0, state)
        k2 = slope(0.5, state + 0.5 * h * k1)
        k3 = slope(0.5, state + 0.5 * h * k2)
        k4 = slope(1.0, state + h * k3)
        return np.asarray(state + h / 6.0 * (k1 + 2.0 * (k2 + k3) + k4))


def resample_crossings(
    compiled: Compiled, mesh_frequency: float, states: Array, extra_force: Array, sides: Array
) -> Resampled | None:
    """Sample steps in which a contact opens or closes, and a neighbour of each, anew."""
    crossed = np.any(sides[:, 0] != sides[:, 1], axis=1)
    if not crossed.any() or compiled.step_number > LIMIT:
        return None
    step, forward = _with_neighbours(crossed, compiled.grid.after_event)
    points = _Points(compiled, mesh_frequency, extra_force)
    tau = _crossing(points, step, states[step], sides[step, 0], sides[step, 1])
    kept = (tau > 1e-6) & (tau < 1.0 - 1e-6)
    step, forward, tau = step[kept], forward[kept], tau[kept]
    if step.size == 0:
        return None
    before, after = sides[step, 0], sides[step, 1]
    middle = points.advance(step, tau, states[step], before)
    grid = compiled.grid
    at = np.concatenate((grid.left, [1.0]))[step % grid.steps]
    whole = step // grid.steps
    cut = whole + at + tau * grid.width[step % grid.steps]
    first = np.where(forward, step, step - 1)
    outer = grid.left[first % grid.steps]
    end = whole + outer + grid.width[first % grid.steps] + grid.width[(first + 1) % grid.steps]
    left = _part(points, step, (whole + outer, cut), (states[first], middle), before)
    right = _part(points, step, (cut, end), (middle, states[first + 2]), after)
    phase, q, v = (np.concatenate(pair) for pair in zip(left[:3], right[:3], strict=True))
    joined = Forces(*(np.concatenate(pair) for pair in zip(left[3], right[3], strict=True)))
    weight = np.multiply.outer(phase[:, 2] - phase[:, 0], [1.0, 4.0, 1.0])
    weight *= grid.steps / (6.0 * sides.shape[0])
    return Resampled(np.concatenate((first, first + 1)), phase, weight, q, v, joined)


def _with_neighbours(crossed: Mask, after_event: Mask) -> tuple[Index, Mask]:
    """Steps with a crossing that have a free neighbour, and whether it is the next one."""
    count, steps = crossed.size, after_event.size
    taken = crossed.copy()
    chosen, forward = [], []
    for step in np.flatnonzero(crossed):
        following = step + 1
        if following < count and not after_event[following % steps] and not taken[following]:
            taken[following] = True
            chosen.append(step)
            forward.append(True)
        elif step > 0 and not after_event[step % steps] and not taken[step - 1]:
            taken[step - 1] = True
            chosen.append(step)
            forward.append(False)
    return np.array(chosen, dtype=np.int64), np.array(forward, dtype=bool)


def _crossing(points: _Points, step: Index, state: Array, before: Array, after: Array) -> Array:
    """Fraction of each step at which its contacts leave their sides; 0 if not one place."""
    nodes = points.compiled.nodes
    end = points.advance(step, np.ones(step.size), state, before)
    (q0, v0), (q1, v1) = np.split(state, 2, axis=1), np.split(end, 2, axis=1)
    h = points.duration(step)[:, None]

    def distance(j: int, of: Index, tau: Array) -> Array:
        """Clearance of one contact at fractions of the steps in which it crosses."""
        t, part = tau[:, None], step[of]
        q = (1.0 + 2.0 * t) * (1.0 - t) ** 2 * q0[of] + t**2 * (3.0 - 2.0 * t) * q1[of]
        q = q + h[of] * t * (1.0 - t) * ((1.0 - t) * v0[of] - t * v1[of])
        direction, error, gap = (
            quadratic(rows[:, :, j], part, tau)
            for rows in (nodes.direction, nodes.error, nodes.gap)
        )
        pressed = np.einsum("ri,ri->r", direction, q) - error
        return clearance(pressed, gap, before[of, j], after[of, j])

    places = np.full(before.shape, np.nan)
    for j in map(int, np.flatnonzero(np.any(before != after, axis=0))):
        of = np.flatnonzero(before[:, j] != after[:, j])
        low, high = np.zeros(of.size), np.ones(of.size)
        beyond = distance(j, of, low) <= 0.0
        for _ in range(_HALVINGS):
            tau = 0.5 * (low + high)
            inside = distance(j, of, tau) > 0.0
            low, high = np.where(inside, tau, low), np.where(inside, high, tau)
        places[of, j] = np.where(beyond, 0.0, low)
    first, last = np.nanmin(places, axis=1), np.nanmax(places, axis=1)
    return np.where(last - first < _TOGETHER, first, 0.0)


def _part(
    points: _Points, step: Index, phase: tuple[Array, Array], ends: tuple[Array, Array],
    side: Array,
) -> tuple[Array, Array, Array, Forces]:  # fmt: skip
    """Both ends and the middle of a part of two steps, on one side of the contacts."""
    grid = points.compiled.grid
    duration = (phase[1] - phase[0])[:, None] / points.frequency
    q, v = (item[:, 0] for item in with_middles(duration, np.stack(ends, axis=1)))
    at = np.stack((phase[0], 0.5 * (phase[0] + phase[1]), phase[1]), axis=1)
    number, tau = within_steps(grid, step // grid.steps, at)
    return at, q, v, points.at(number, tau, q, v, side[:, None])
