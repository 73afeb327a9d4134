"""Samples of a response where a contact opens or closes within a step.

The damping force jumps there, and Simpson's rule over the step would be off by the jump times the
step. The step and a neighbour without crossing are sampled anew, as the part before the crossing
and the part after it: as many samples, none of them across the jump.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from tribodyn.dynamics.grid import Grid
from tribodyn.dynamics.load_friction import friction_force
from tribodyn.dynamics.march import Compiled
from tribodyn.dynamics.step_limit import LIMIT
from tribodyn.types import Array, Index, Mask

_ROWS = (
    "stiffness", "damping", "error", "error_slope", "gap", "direction", "direction_slope",
    "force_direction", "force", "friction_direction", "friction_coefficients",
)  # fmt: skip
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
    acceleration: Array  #: [m or rad, ...]
    deflection: Array
    force: Array


def interpolate_rows(rows: Array, step: Index, tau: Array) -> Array:
    """Interpolate rows quadratically within their steps, as the integrator does."""
    values = rows[step % rows.shape[0]]
    at = tau.reshape(-1, *(1,) * (values.ndim - 2))
    left, middle = (1.0 - at) * (1.0 - 2.0 * at), 4.0 * at * (1.0 - at)
    return np.asarray(
        left * values[:, 0] + middle * values[:, 1] + at * (2.0 * at - 1.0) * values[:, 2]
    )


def within_steps(grid: Grid, cycle: Index, phase: Array) -> tuple[Index, Array]:
    """Find the steps in which triples of samples lie."""
    edges = np.concatenate((grid.left, [1.0]))
    own = phase - cycle[:, None]
    inner = own + np.array([1e-12, 0.0, -1e-12])
    number = np.clip(np.searchsorted(edges, inner, side="right") - 1, 0, grid.steps - 1)
    return number, np.clip((own - grid.left[number]) / grid.width[number], 0.0, 1.0)


class _Points:
    """The equations of motion at points within steps, each with the sides of its contacts."""

    def __init__(self, compiled: Compiled, frequency: float, extra: Array) -> None:
        self.compiled, self.frequency, self.extra = compiled, frequency, extra
        self.system = compiled.system
        self.inverse = np.linalg.inv(np.asarray(self.system.mass)).T
        self.in_gap = np.array([one.damping_in_gap for one in self.system.contacts])

    def row(self, name: str, step: Index, tau: Array) -> Array:
        """Interpolate rows of the table within steps."""
        return interpolate_rows(getattr(self.compiled.nodes, name), step, tau)

    def compression(self, step: Index, tau: Array, q: Array) -> Array:
        """Compression of the contacts, (m, contacts)."""
        direction = self.row("direction", step, tau)
        place = np.einsum("mji,mi->mj", direction, q)
        return np.asarray(place - self.row("error", step, tau))

    def at(self, step: Index, tau: Array, state: Array, side: Array) -> tuple[Array, ...]:
        """Compression and force of the contacts, acceleration."""
        rows: dict[str, Any] = {name: self.row(name, step, tau) for name in _ROWS}
        q, v = np.split(state, 2, axis=1)
        d = np.einsum("mji,mi->mj", rows["direction"], q) - rows["error"]
        rate = np.einsum("mji,mi->mj", rows["direction"], v) - self.frequency * rows["error_slope"]
        rate += self.frequency * np.einsum("mji,mi->mj", rows["direction_slope"], q)
        force = np.abs(side) * rows["stiffness"] * (d - side * rows["gap"])
        force = force + ((side != 0.0) | self.in_gap) * rows["damping"] * rate
        total = rows["force"] + self.extra - q @ np.asarray(self.system.stiffness).T
        total = total - v @ np.asarray(self.system.damping).T
        total = total - np.einsum("mji,mj->mi", rows["force_direction"], force)
        if self.system.frictions:
            rub = friction_force(self.system, rows["friction_coefficients"], force)
            total = total - np.einsum("mfi,mf->mi", rows["friction_direction"], rub)
        return d, force, total @ self.inverse

    def advance(self, step: Index, tau: Array, state: Array, side: Array) -> Array:
        """March from the beginning of a step to a fraction of it by one Runge-Kutta step."""
        width = self.compiled.grid.width[step % self.compiled.grid.steps]
        h = (tau * width / self.frequency)[:, None]

        def slope(part: float, y: Array) -> Array:
            acceleration = self.at(step, part * tau, y, side)[2]
            return np.concatenate((y[:, y.shape[1] // 2 :], acceleration), axis=1)

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
    before, after = sides[step, 0], sides[step, 1]
    start = states[step]
    tau = _crossing(points, step, start, before, after)
    kept = (tau > 1e-6) & (tau < 1.0 - 1e-6)
    step, forward, before, after = step[kept], forward[kept], before[kept], after[kept]
    tau = tau[kept]
    if step.size == 0:
        return None
    middle = points.advance(step, tau, start[kept], before)
    grid = compiled.grid
    at = np.concatenate((grid.left, [1.0]))[step % grid.steps]
    width = grid.width[step % grid.steps]
    whole = step // grid.steps
    cut = whole + at + tau * width
    first = np.where(forward, step, step - 1)
    outer = grid.left[first % grid.steps]
    end = whole + outer + grid.width[first % grid.steps] + grid.width[(first + 1) % grid.steps]
    parts = [
        _part(points, step, (whole + outer, cut), (states[first], middle), before),
        _part(points, step, (cut, end), (middle, states[first + 2]), after),
    ]
    joined = [np.concatenate(pair) for pair in zip(*parts, strict=True)]
    weight = np.multiply.outer(joined[0][:, 2] - joined[0][:, 0], [1.0, 4.0, 1.0])
    weight *= grid.steps / (6.0 * sides.shape[0])
    return Resampled(np.concatenate((first, first + 1)), joined[0], weight, *joined[1:])


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
    size = state.shape[1] // 2
    end = points.advance(step, np.ones(step.size), state, before)
    h = (points.compiled.grid.width[step % points.compiled.grid.steps] / points.frequency)[:, None]

    def clearance(tau: Array, j: int) -> Array:
        t = tau[:, None]
        q = (1.0 + 2.0 * t) * (1.0 - t) ** 2 * state[:, :size] + t**2 * (3.0 - 2.0 * t) * end[
            :, :size
        ]
        q = q + h * t * (1.0 - t) * ((1.0 - t) * state[:, size:] - t * end[:, size:])
        d = points.compression(step, tau, q)[:, j]
        gap = points.row("gap", step, tau)[:, j]
        return np.where(before[:, j] != 0.0, before[:, j] * d - gap, gap - after[:, j] * d)

    places = np.full(before.shape, np.nan)
    for j in map(int, np.flatnonzero(np.any(before != after, axis=0))):
        low, high = np.zeros(step.size), np.ones(step.size)
        beyond = clearance(low, j) <= 0.0
        for _ in range(_HALVINGS):
            tau = 0.5 * (low + high)
            inside = clearance(tau, j) > 0.0
            low, high = np.where(inside, tau, low), np.where(inside, high, tau)
        places[:, j] = np.where(before[:, j] != after[:, j], np.where(beyond, 0.0, low), np.nan)
    first, last = np.nanmin(places, axis=1), np.nanmax(places, axis=1)
    return np.where(last - first < _TOGETHER, first, 0.0)


def _part(
    points: _Points, step: Index, phase: tuple[Array, Array], ends: tuple[Array, Array],
    side: Array,
) -> tuple[Array, ...]:  # fmt: skip
    """Both ends and the middle of a part of two steps, on one side of the contacts."""
    grid, size = points.compiled.grid, ends[0].shape[1] // 2
    h = ((phase[1] - phase[0]) / points.frequency)[:, None]
    (q0, v0), (q1, v1) = (np.split(end, 2, axis=1) for end in ends)
    between = np.concatenate(
        (0.5 * (q0 + q1) + 0.125 * h * (v0 - v1), 1.5 * (q1 - q0) / h - 0.25 * (v0 + v1)), axis=1
    )
    at = np.stack((phase[0], 0.5 * (phase[0] + phase[1]), phase[1]), axis=1)
    number, tau = within_steps(grid, step // grid.steps, at)
    samples = []
    for node, state in enumerate((ends[0], between, ends[1])):
        d, force, acceleration = points.at(number[:, node], tau[:, node], state, side)
        samples.append((state[:, :size], state[:, size:], acceleration, d, force))
    return (at, *(np.stack(values, axis=1) for values in zip(*samples, strict=True)))
