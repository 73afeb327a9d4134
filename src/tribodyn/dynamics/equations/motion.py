"""The equation of motion in NumPy, for rows of the table of any shape.

``M q'' = f + extra - K q - C v - sum_j h_j N_j - sum_j s_j N_j - friction that follows its load``,
``N_j = k_j (d_j - side_j gap_j) + c_j d_j'`` on a side of the dead zone, ``d_j = h_j.q - e_j``.
The compiled law is :mod:`tribodyn.dynamics._engine.contact_forces`.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from tribodyn.arrays.linear_algebra import times
from tribodyn.dynamics.equations.grid import Grid, unrepeated
from tribodyn.dynamics.equations.nodes import Nodes, friction_force, ramp_force, spanned_coordinates
from tribodyn.dynamics.equations.system import System
from tribodyn.types import Array, Index, Mask, Numbers


class Scales(NamedTuple):
    """Factors of the parts of a system, numbers or arrays that go with the rows [1]."""

    stiffness: Numbers = 1.0
    damping: Numbers = 1.0
    friction: Numbers = 1.0
    error: Numbers = 1.0
    gap: Numbers = 1.0
    force: Numbers = 1.0

    @classmethod
    def of_lanes(cls, table: Array) -> Scales:
        """Factors of lanes (lanes, 6) that go with rows (steps, 3, ...)."""
        return cls(*(column[:, None, None, None] for column in table.T))


class Forces(NamedTuple):
    """Result of the equation of motion."""

    deflection: Array  #: compression of every contact [m]
    contact: Array  #: force of every contact [N]
    side: Array  #: side of the dead zone of every contact
    acceleration: Array  #: [m/s^2 or rad/s^2]


_SAME = Scales()


def has_gap(nodes: Nodes) -> Mask:
    """Contacts with a dead zone."""
    gap = unrepeated(nodes.gap, 1)
    return np.asarray(np.any(gap > 0.0, axis=tuple(range(gap.ndim - 1))))


def _constant(direction: Array) -> Array | None:
    """Directions (contacts, n) if they are the same in all rows, else None."""
    distinct = unrepeated(direction, 2)
    shape = distinct.shape[-2:]
    return distinct.reshape(shape) if distinct.size == math.prod(shape) else None


def _along(direction: Array, vectors: Array) -> Array:
    """Parts of vectors (..., n) along directions (..., contacts, n)."""
    if (constant := _constant(direction)) is not None:
        return times(vectors, constant)
    return np.asarray(np.einsum("...ji,...i->...j", direction, vectors))


def _with_parts(
    matrix: Array, direction: Array, vectors: Array, onto: Array | None
) -> tuple[Array, Array, Array]:
    """Matrix times vectors (..., n), their parts along directions, and what these are parts of."""
    also = _constant(direction) if onto is None else onto
    if also is None:
        return times(vectors, matrix), _along(direction, vectors), vectors
    moved, parts = np.split(times(vectors, np.concatenate((matrix, also))), [len(matrix)], axis=-1)
    return (moved, parts, vectors) if onto is None else (moved, _along(direction, parts), parts)


def _pushed(push: Array, force: Array) -> Array:
    """Sum of directions (..., contacts, n), each times its force (..., contacts)."""
    if force.shape[-1] == 1:
        return push[..., 0, :] * force
    return np.asarray(np.einsum("...ji,...j->...i", push, force))


def compression(rows: Nodes, q: Array, error: Numbers = 1.0) -> Array:
    """Compression of every contact."""
    return np.asarray(_along(rows.direction, q) - error * unrepeated(rows.error, 1))


def compression_rate(rows: Nodes, beat: Numbers, q: Array, v: Array) -> Array:
    """Rate of every compression at the mesh frequency ``beat``."""
    return np.asarray(_along(rows.direction, v) + _turning(rows, beat, q))


def _turning(rows: Nodes, beat: Numbers, q: Array, error: Numbers = 1.0) -> Array:
    """Rate of every compression because the mesh turns at the mesh frequency ``beat``."""
    turning = -error * unrepeated(rows.error_slope, 1)
    slope = unrepeated(rows.direction_slope, 2)
    if slope.any():
        turning = turning + _along(rows.direction_slope, q)
    return np.asarray(beat * turning)


def sides(deflection: Array, gap: Array, dead: Mask) -> Array:
    """Side of its dead zone on which every contact is; 1 where it has none."""
    beyond = np.where(deflection > gap, 1.0, np.where(deflection < -gap, -1.0, 0.0))
    return np.where(dead, beyond, 1.0)


def clearance(deflection: Array, gap: Array, side: Array, leaving: Array) -> Array:
    """Distance to the boundary of a side; in the gap, to the boundary in direction ``leaving``."""
    return np.where(side != 0.0, side * deflection - gap, gap - leaving * deflection)


def forces(
    system: System,
    rows: Nodes,
    beat: Numbers,
    q: Array,
    v: Array,
    side: Array | None = None,
    scales: Scales = _SAME,
    extra: Numbers = 0.0,
) -> Forces:
    """Contact forces and accelerations; without ``side`` the sides follow from the compressions."""
    onto, inverse = spanned_coordinates(system, rows), system.inverse_mass
    stiffness, damping = system.over_mass
    pushed = inverse if onto is None else inverse @ onto.T
    elastic, along, position = _with_parts(stiffness, rows.direction, q, onto)
    damped, speed, _ = _with_parts(damping, rows.direction, v, onto)
    d = along - scales.error * unrepeated(rows.error, 1)
    rate = speed + _turning(rows, beat, position, scales.error)
    gap = scales.gap * unrepeated(rows.gap, 1)
    if side is None and np.all(d > gap):
        side = np.broadcast_to(1.0, d.shape)
        contact = scales.stiffness * rows.stiffness * (d - gap)
        contact = contact + scales.damping * unrepeated(rows.damping, 1) * rate
    else:
        side = sides(d, gap, has_gap(rows)) if side is None else side
        contact = np.abs(side) * scales.stiffness * rows.stiffness * (d - side * gap)
        acting = (side != 0.0) | system._damped_in_gap
        contact = contact + acting * scales.damping * rows.damping * rate
    if rows.ramp_gap.shape[-1]:
        contact = contact + ramp_force(rows, d)
    total = times(scales.force * unrepeated(rows.force, 1) + extra, inverse) - elastic
    total -= damped
    if scales is _SAME:
        directions = unrepeated(rows.force_direction, 2)
        if len(directions) == 1:
            total -= _pushed(times(directions, pushed), contact)
        else:
            total -= times(_pushed(directions, contact), pushed)
    else:
        total -= _pushed(times(unrepeated(rows.direction, 2), pushed), contact)
        rub = times(rows.force_direction - rows.direction, pushed)
        total = total - scales.friction * _pushed(rub, contact)
    if system.frictions:
        drag = friction_force(system, rows.friction_coefficients, contact)
        drag = _pushed(rows.friction_direction, drag)
        total = total - scales.friction * times(drag, pushed)
    return Forces(d, contact, side, total)


def quadratic_weights(tau: Array) -> tuple[Array, Array, Array]:
    """Weights of the left end, the middle and the right end of a step at its fraction ``tau``."""
    return (1.0 - tau) * (1.0 - 2.0 * tau), 4.0 * tau * (1.0 - tau), tau * (2.0 * tau - 1.0)


def cubic_middle(
    h: Array, inverse: Array, q0: Array, v0: Array, q1: Array, v1: Array
) -> tuple[Array, Array]:
    """Middle of the cubic through position and velocity at both ends; ``inverse`` is 1/h."""
    return 0.5 * (q0 + q1) + 0.125 * h * (v0 - v1), 1.5 * inverse * (q1 - q0) - 0.25 * (v0 + v1)


def quintic_place(s: Array) -> tuple[Array, ...]:
    """Weights of mean velocity, both velocities and both accelerations in the place at ``s``.

    The quintic through position, velocity and acceleration at both ends of a step ``h`` is
    ``q0 + h (b . (mean, v0, v1) + h (b . (a0, a1)))``.
    """
    s2, s3 = s * s, s * s * s
    return (
        s3 * (10.0 - s * (15.0 - 6.0 * s)),
        s - s3 * (6.0 - s * (8.0 - 3.0 * s)),
        s3 * (s * (7.0 - 3.0 * s) - 4.0),
        0.5 * s2 - s3 * (1.5 - s * (1.5 - 0.5 * s)),
        s3 * (0.5 - s * (1.0 - 0.5 * s)),
    )


def quintic_speed(s: Array) -> tuple[Array, ...]:
    """The same weights in its velocity ``d . (mean, v0, v1) + h (d . (a0, a1))``."""
    s2 = s * s
    return (
        s2 * (30.0 - s * (60.0 - 30.0 * s)),
        1.0 - s2 * (18.0 - s * (32.0 - 15.0 * s)),
        s2 * (s * (28.0 - 15.0 * s) - 12.0),
        s - s2 * (4.5 - s * (6.0 - 2.5 * s)),
        s2 * (1.5 - s * (4.0 - 2.5 * s)),
    )


def with_middles(duration: Array, state: Array) -> tuple[Array, Array]:
    """Position and velocity at both ends and in the middle of steps, (..., steps, 3, n).

    ``state`` (..., steps + 1, 2 n) holds the ends, ``duration`` (..., steps) is in s.
    """
    size, h = state.shape[-1] // 2, duration[..., None, :]
    # Steps along the last axis, so that the inner loops are long.
    rows = np.ascontiguousarray(np.swapaxes(state, -1, -2))
    left, right = rows[..., :-1], rows[..., 1:]
    values = np.empty((*left.shape, 3))
    values[..., 0], values[..., 2] = left, right
    ends = left[..., :size, :], left[..., size:, :], right[..., :size, :], right[..., size:, :]
    values[..., :size, :, 1], values[..., size:, :, 1] = cubic_middle(h, 1.0 / h, *ends)
    values = np.moveaxis(values, -3, -1)
    return values[..., :size], values[..., size:]


def quadratic(rows: Array, step: Index, tau: Array) -> Array:
    """Rows (steps, 3, ...) at fractions of steps, as the integrators interpolate them."""
    values = rows[step % rows.shape[0]]
    at = tau.reshape((*tau.shape, *(1,) * (rows.ndim - 2)))
    left, middle, right = quadratic_weights(at)
    three = np.moveaxis(values, tau.ndim, 0)
    return np.asarray(left * three[0] + middle * three[1] + right * three[2])


def rows_within(nodes: Nodes, step: Index, tau: Array) -> Nodes:
    """Every row at fractions of steps."""
    return Nodes(*(quadratic(part, step, tau) for part in nodes))


def within_steps(grid: Grid, cycle: Index, phase: Array) -> tuple[Index, Array]:
    """Steps in which triples of samples lie, and the fraction of the step of each."""
    edges = np.concatenate((grid.left, [1.0]))
    cycle_phase = phase - cycle[:, None]
    inner = cycle_phase + np.array([1e-12, 0.0, -1e-12])
    number = np.clip(np.searchsorted(edges, inner, side="right") - 1, 0, grid.steps - 1)
    return number, np.clip((cycle_phase - grid.left[number]) / grid.width[number], 0.0, 1.0)


class WithinSteps:
    """Motions within steps of the grid, with fixed sides of all contacts."""

    def __init__(self, system: System, nodes: Nodes, grid: Grid, beat: float, extra: Array) -> None:
        self.system, self.nodes, self.grid = system, nodes, grid
        self.beat, self.extra, self._onto = beat, extra, spanned_coordinates(system, nodes)

    def duration(self, step: Index) -> Array:
        """Time of whole steps [s]."""
        return self.grid.width[step % self.grid.steps] / self.beat

    def forces(self, step: Index, tau: Array, q: Array, v: Array, side: Array) -> Forces:
        """Forces and accelerations at fractions of steps."""
        rows = rows_within(self.nodes, step, tau)
        return forces(self.system, rows, self.beat, q, v, side, extra=self.extra)

    def _few(self, q: Array) -> Array:
        """Positions over the coordinates of directions."""
        return q if self._onto is None else q @ self._onto.T

    def contacts(self, step: Index, tau: Array, q: Array) -> tuple[Array, Array]:
        """Compressions and gaps of all contacts at fractions of steps."""
        direction, error, gap = (
            quadratic(rows, step, tau)
            for rows in (self.nodes.direction, self.nodes.error, self.nodes.gap)
        )
        rows = self.nodes._replace(direction=direction, error=error)
        return compression(rows, self._few(q)), gap

    def contact_of_each(
        self, step: Index, contact: Index
    ) -> Callable[[Array, Array], tuple[Array, Array]]:
        """Function for compression and gap of one contact per step at fractions of the steps."""
        every = np.arange(step.size)
        direction, error, gap = (
            rows[step % self.grid.steps, :, contact]
            for rows in (self.nodes.direction, self.nodes.error, self.nodes.gap)
        )

        def at(tau: Array, q: Array) -> tuple[Array, Array]:
            along, off, play = (quadratic(rows, every, tau) for rows in (direction, error, gap))
            contact_rows = self.nodes._replace(direction=along[:, None], error=off[:, None])
            return compression(contact_rows, self._few(q))[:, 0], play

        return at

    def advance(self, step: Index, begin: Array, end: Array, y: Array, side: Array) -> Array:
        """Integrate states (m, 2 n) over parts of steps by one Runge-Kutta step each."""
        taus = np.stack((begin, 0.5 * (begin + end), end), axis=1)
        rows = rows_within(self.nodes, step[:, None], taus)
        h = (self.duration(step) * (end - begin))[:, None]

        def slope(node: int, y: Array) -> Array:
            q, v = np.split(y, 2, axis=1)
            node_rows = Nodes(*(part[:, node] for part in rows))
            law = forces(self.system, node_rows, self.beat, q, v, side, extra=self.extra)
            return np.concatenate((v, law.acceleration), axis=1)

        k1 = slope(0, y)
        k2 = slope(1, y + 0.5 * h * k1)
        k3 = slope(1, y + 0.5 * h * k2)
        k4 = slope(2, y + h * k3)
        return np.asarray(y + h / 6.0 * (k1 + 2.0 * (k2 + k3) + k4))
