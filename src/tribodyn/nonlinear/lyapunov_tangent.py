"""Matrices that carry a small disturbance of a motion over one integration step.

Between two changes of contact a structure is linear in its state, so that these matrices depend
on the mesh phase and on which contacts carry, not on the motion. They are exponentials of the
Magnus series of fourth order (Blanes, Casas, Oteo and Ros, Physics Reports 470, 2009), whose
determinant is exact. Disturbances are taken in the coordinates in which an orbit closes: the free
rotation of the whole drive has no part in them.

Where a contact opens or closes, a disturbed motion reaches the boundary of the dead zone at another
time, and the damping force jumps there: the disturbance jumps too, by the saltation matrix
``I + (f_after - f_before) grad(g)^T / (dg/dt)`` of the boundary ``g(q, t) = 0``.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from tribodyn.dynamics.equations.compiled import Compiled
from tribodyn.dynamics.equations.divergence import chattering_step, most_splits
from tribodyn.dynamics.equations.motion import (
    WithinSteps,
    clearance,
    compression,
    compression_rate,
    has_gap,
    quadratic,
    rows_within,
)
from tribodyn.dynamics.equations.nodes import Nodes, push_with_friction
from tribodyn.dynamics.equations.orbit_coordinates import orbit_coordinates
from tribodyn.errors import ComputationError, InputError
from tribodyn.types import Array, Index, Mask

#: Terms of the exponential series of a matrix no larger than a quarter: exact to rounding.
_TAYLOR = 12
_ROOT_LIMIT = 60


class TangentTables:
    """Matrices of the disturbances of one system on its grid."""

    def __init__(self, compiled: Compiled, mesh_frequency: float) -> None:
        system, nodes = compiled.system, _with_friction(compiled)
        self.compiled = compiled
        self.nodes = nodes
        self.mesh_frequency = mesh_frequency
        self.coordinates = orbit_coordinates(compiled, mesh_frequency)
        self.width = compiled.grid.width / mesh_frequency
        self.dead = has_gap(nodes)
        self.in_gap = system._damped_in_gap
        c = self.coordinates
        place, speed = c.inverse.T @ c.elastic / c.rate, c.inverse.T @ c.moving
        self.size = place.shape[1] + speed.shape[1]
        still = np.zeros((*nodes.stiffness.shape, speed.shape[1]))
        self._rigid = np.zeros((self.size, self.size))
        count = place.shape[1]
        self._rigid[:count, count:] = c.rate * c.elastic.T @ c.moving
        self._rigid[count:, :count] = -speed.T @ np.asarray(system.stiffness) @ place
        self._rigid[count:, count:] = -speed.T @ system.rate_matrix @ speed
        #: How the compression of each contact feels a disturbance, (steps, 3, contacts, k).
        self.feel = np.concatenate((nodes.direction @ place, still), axis=-1)
        rate = np.concatenate(
            (mesh_frequency * nodes.direction_slope @ place, nodes.direction @ speed), axis=-1
        )
        self._spring = nodes.stiffness[..., None] * self.feel
        #: How its damping force does, and what a force does to the disturbance.
        self.damp = nodes.damping[..., None] * rate
        none = np.zeros((*nodes.stiffness.shape, count))
        self.push = np.concatenate((none, nodes.force_direction @ speed), axis=-1)
        self._known: dict[int, tuple[Array, Array]] = {}

    def rate_matrix(self, push: Array, spring: Array, damp: Array, touching: Mask) -> Array:
        """Matrix of the equations of a disturbance."""
        carried = touching[..., None] * spring + (touching | self.in_gap)[..., None] * damp
        return np.asarray(self._rigid - np.swapaxes(push, -1, -2) @ carried)

    def whole_steps(self, touching: Mask) -> tuple[Array, Array]:
        """Matrices of all steps of a mesh cycle for one set of contacts that carry."""
        key = int(sum(1 << j for j in np.flatnonzero(touching)))
        if key not in self._known:
            wide = np.broadcast_to(touching, self.push.shape[:3])
            rates = self.rate_matrix(self.push, self._spring, self.damp, wide)
            self._known[key] = _propagate(rates, self.width)
        return self._known[key]

    def part_steps(
        self, steps: Index, begin: Array, end: Array, touching: Mask
    ) -> tuple[Array, Array]:
        """Matrices of parts of steps."""
        taus = np.stack((begin, 0.5 * (begin + end), end), axis=1)
        push, spring, damp = (
            within(item, steps, taus) for item in (self.push, self._spring, self.damp)
        )
        wide = np.broadcast_to(touching[:, None], (*taus.shape, touching.shape[1]))
        return _propagate(
            self.rate_matrix(push, spring, damp, wide), self.width[steps] * (end - begin)
        )


def _with_friction(compiled: Compiled) -> Nodes:
    """Rows in which the frictions that are proportional to the load belong to the contacts."""
    system, nodes = compiled.system, compiled.nodes
    coefficients = nodes.friction_coefficients
    if not system.frictions:
        return nodes
    if np.any(coefficients[..., 1:]):
        bent = int(np.flatnonzero(np.any(coefficients[..., 1:], axis=(0, 1, 3)))[0])
        raise InputError(
            f"frictions[{bent}] has {coefficients.shape[-1]} coefficients",
            where=f"System.frictions[{bent}].coefficients",
            why="The tangent method carries disturbances with matrices that know only which "
            "contacts carry, and a coefficient that follows the load changes with the motion",
            remedy="Use a single coefficient, for example its value at the mean load, or look "
            "at the Floquet multipliers of steady_state, which include the whole friction",
        )
    return nodes._replace(force_direction=push_with_friction(system, nodes, coefficients[..., 0]))


def within(values: Array, steps: Index, taus: Array) -> Array:
    """Interpolate rows quadratically within their steps, as the integrator does."""
    return quadratic(values, steps[:, None], taus)


def _propagate(rates: Array, width: Array) -> tuple[Array, Array]:
    """Matrix of a step from those of the equations (m, 3, k, k); integral of their trace."""
    h = width[:, None, None]
    first, middle, last = rates[:, 0], rates[:, 1], rates[:, 2]
    mean = h / 6.0 * (first + 4.0 * middle + last)
    matrix = _exponential(mean - h * h / 12.0 * (first @ last - last @ first))
    return matrix, np.trace(mean, axis1=-2, axis2=-1)


def _exponential(matrices: Array) -> Array:
    """Exponentials of matrices (m, k, k) by scaling, Taylor series and squaring."""
    size = float(np.abs(matrices).sum(axis=-1).max(initial=0.0))
    halvings = max(0, math.ceil(math.log2(max(size, 1e-300) / 0.25)))
    small = matrices / 2.0**halvings
    unit = np.eye(matrices.shape[-1])
    result = np.broadcast_to(unit, matrices.shape)
    for order in range(_TAYLOR, 0, -1):
        result = unit + small @ result / order
    for _ in range(halvings):
        result = result @ result
    return np.asarray(result)


class _Lanes(NamedTuple):
    """Motions within one step each: step, fraction done, state, sides of the dead zones."""

    steps: Index
    begin: Array
    state: Array
    side: Array

    def take(self, which: Index) -> _Lanes:
        return _Lanes(self.steps[which], self.begin[which], self.state[which], self.side[which])


def _advance(engine: WithinSteps, lanes: _Lanes, end: Array) -> tuple[_Lanes, Array, Array]:
    """March every lane to a fraction of its step; also compressions and gaps there."""
    state = engine.advance(lanes.steps, lanes.begin, end, lanes.state, lanes.side)
    place, gap = engine.contacts(lanes.steps, end, state[:, : engine.system.size])
    return lanes._replace(begin=end, state=state), place, gap


def carry_over_crossings(
    tables: TangentTables, extra_force: Array, steps: Index, state: Array, side: Array
) -> tuple[Array, Array]:
    """Matrices that carry a disturbance over steps in which contacts open or close."""
    compiled = tables.compiled
    parts = compiled.system, compiled.nodes, compiled.grid
    engine = WithinSteps(*parts, tables.mesh_frequency, extra_force)
    count = steps.size
    matrix = np.broadcast_to(np.eye(tables.size), (count, tables.size, tables.size)).copy()
    trace = np.zeros(count)
    lanes = _Lanes(steps, np.zeros(count), state, side.copy())
    waiting = np.arange(count)
    most = most_splits(tables.dead.size)
    for number in range(most + 1):
        _, place, gap = _advance(engine, lanes, np.ones(waiting.size))
        leaving = np.where(place > 0.0, 1.0, -1.0)
        beyond = tables.dead & (clearance(place, gap, lanes.side, leaving) < 0.0)
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
        lanes = _advance(engine, lanes.take(which), stop[which])[0]
        jump = _saltation(tables, engine, lanes, contact[which])
        matrix[waiting] = jump @ matrix[waiting]
        row = np.arange(which.size)
        old = lanes.side[row, contact[which]]
        new = leaving[which, contact[which]]
        lanes.side[row, contact[which]] = np.where(old != 0.0, 0.0, new)
    return matrix, trace


def _unparted(tables: TangentTables, step: int, contact: int) -> ComputationError:
    phase = float(tables.compiled.grid.left[step])
    return chattering_step(contact, tables.dead.size, phase, phase / tables.mesh_frequency, None)


def _first_crossing(
    engine: WithinSteps, lanes: _Lanes, leaving: Array, beyond: Mask
) -> tuple[Array, Index]:
    """Fraction at which the first contact leaves its side (2 if none does), and which it is."""
    fractions = np.full(beyond.shape, 2.0)
    for j in range(beyond.shape[1]):
        which = np.flatnonzero(beyond[:, j])
        if which.size:
            fractions[which, j] = _root(engine, lanes.take(which), leaving[which], j)
    first = np.asarray(np.argmin(fractions, axis=1), dtype=np.int64)
    return np.asarray(np.min(fractions, axis=1)), first


def _root(engine: WithinSteps, lanes: _Lanes, leaving: Array, contact: int) -> Array:
    """Fraction at which one contact leaves its side, by the Illinois method."""

    def clear(tau: Array) -> Array:
        _, place, gap = _advance(engine, lanes, tau)
        return clearance(place, gap, lanes.side, leaving)[:, contact]

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


def _saltation(tables: TangentTables, engine: WithinSteps, lanes: _Lanes, contact: Index) -> Array:
    """Matrix of the jump of a disturbance where a contact opens or closes."""
    row, at = np.arange(contact.size), lanes.begin[:, None]
    rows = rows_within(engine.nodes, lanes.steps, lanes.begin)
    q, v = np.split(lanes.state, 2, axis=1)
    side = lanes.side[row, contact]
    rate = compression_rate(rows, engine.beat, q, v)[row, contact]
    # The clearance changes by the compression and by the gap itself.
    place = compression(rows, q)[row, contact]
    flank = np.where(side != 0.0, side, np.where(place > 0.0, 1.0, -1.0))
    relative = rate - flank * _gap_rate(engine, lanes.steps, at)[row, contact]
    ratio = np.divide(rate, relative, out=np.ones_like(rate), where=relative != 0.0)
    entering = np.where(side == 0.0, 1.0, -1.0) * ~tables.in_gap[contact]
    strength = entering * rows.damping[row, contact] * ratio
    push, feel = (
        within(item, lanes.steps, at)[row, 0, contact] for item in (tables.push, tables.feel)
    )
    jump = strength[:, None, None] * push[:, :, None] * feel[:, None, :]
    return np.asarray(np.eye(tables.size) - jump)


def _gap_rate(engine: WithinSteps, steps: Index, at: Array) -> Array:
    """Time derivative of the gaps within a step (m, contacts)."""
    left, middle, right = (engine.nodes.gap[steps, node] for node in range(3))
    slope = (4.0 * at - 3.0) * left + (4.0 - 8.0 * at) * middle + (4.0 * at - 1.0) * right
    return np.asarray(slope / engine.duration(steps)[:, None])
