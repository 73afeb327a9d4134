"""The map whose fixed point is a periodic orbit: the reduced state over one period.

With a balancing torque its size is one more unknown: the torque has to compensate the velocity that
the free motion of the drive gains over the period. Points, and periods where they differ, are
integrated together as lanes.
"""

from __future__ import annotations

from copy import copy
from typing import Any, NamedTuple

import numpy as np

from tribodyn.dynamics._engine.blocks import WIDTH, march
from tribodyn.dynamics.equations.compiled import Compiled
from tribodyn.dynamics.equations.orbit_coordinates import (
    Balance,
    OrbitCoordinates,
    orbit_coordinates,
    refuse_disconnected,
)
from tribodyn.errors import InputError
from tribodyn.types import Array, ComplexArray, Index

#: Lanes that are integrated at a time: more do not fit into the cache.
_LANES = 16384
#: Lanes from which on the integration chooses the width of its blocks.
_MANY = 32
#: Disturbance for the matrix of a map with dead zones relative to the motion, iterations of
#: Newton's method, and the factor by which an iteration has to reduce the error.
_DISTURBANCE, _ROUNDS, _CONTRACTION = 1e-6, 8, 0.7
#: A matrix evaluated farther than this from the orbit, over its size, is evaluated again.
_FAR = 1e-3


def image_of(
    coordinates: OrbitCoordinates, balance: Balance | None, points: Array, state: Array
) -> Array:
    """Image of points (..., k) whose motions end in states (..., 2 n) after the period."""
    reduced = coordinates.reduce(state)
    if balance is None:
        return reduced
    # The torque has to compensate what the free motion gained over the period.
    gained = balance.gain(state)
    return np.concatenate((reduced, points[..., -1:] - gained[..., None]), axis=-1)


class OrbitMap:
    """Map of the reduced state, and of the balancing torque if there is one, over one period.

    With several mesh frequencies it maps points (frequencies, ..., k), each at its frequency.
    """

    def __init__(
        self,
        compiled: Compiled,
        mesh_frequency: float | Array,
        periods: int,
        coordinates: OrbitCoordinates | None = None,
        width: int | None = 1,
    ) -> None:
        self.width, self.threads = width, None if width else 1
        self.compiled = compiled
        refuse_disconnected(compiled)
        lowest = float(np.min(mesh_frequency))
        self.coordinates = coordinates or orbit_coordinates(compiled, lowest)
        self.period = 1.0 / mesh_frequency
        self.periods = periods
        self.cycles = 0
        self.contacts = len(compiled.system.contacts)
        self.balance = Balance.of(compiled.system, self.coordinates)

    def over(self, periods: int) -> OrbitMap:
        """The map over another number of mesh cycles."""
        other = copy(self)
        other.periods, other.cycles = periods, 0
        return other

    def at(self, which: Index) -> OrbitMap:
        """The map at selected mesh frequencies."""
        other = copy(self)
        if np.ndim(self.period):
            other.period = np.asarray(self.period)[which]
        return other

    def rescaled(self, y: Array, periods: int) -> Array:
        """Convert a point of the map over ``periods`` mesh cycles, with the same torque."""
        if self.balance is None:
            return y
        return np.append(y[:-1], y[-1] * self.periods / periods)

    def states(self, y: Array) -> Array:
        """Points without the balancing torque."""
        return y if self.balance is None else y[..., :-1]

    def start(self, state: Array) -> Array:
        """Reduced vector of a state, without a balancing torque."""
        y = self.coordinates.reduce(state)
        if y.size == 0:
            what = "no coordinate has a spring, a damper or a contact"
            why = "Nothing vibrates, so that no periodic orbit exists"
            raise InputError(what, "System.stiffness", why, "Use simulate for a free motion")
        return y if self.balance is None else np.append(y, 0.0)

    def split(self, y: Array) -> tuple[Array, Array]:
        """State and balancing force of points (lanes, k)."""
        y = np.atleast_2d(y)
        if self.balance is None:
            return self.coordinates.expand(y), np.zeros((len(y), self.compiled.system.size))
        extra = self.balance.torque(y[:, -1], self._lane_periods(len(y)) * self.periods)
        return self.coordinates.expand(y[:, :-1]), extra

    def _lane_periods(self, lanes: int) -> Array:
        each = np.atleast_1d(self.period)
        return np.repeat(each, lanes // each.size)

    def __call__(self, y: Array) -> Array:
        """Map (..., k)."""
        points = y.reshape(-1, y.shape[-1])
        state, extra = self.split(points)
        lanes, period = len(points), self._lane_periods(len(points))
        new = np.empty_like(state)
        for first in range(0, lanes, _LANES):
            block = slice(first, first + _LANES)
            new[block] = march(
                self.compiled,
                period[block],
                state[block],
                self.periods,
                extra_force=extra[block],
                width=self.width if lanes < _MANY else None,
                threads=self.threads,
            )
        self.cycles += self.periods
        return image_of(self.coordinates, self.balance, points, new).reshape(y.shape)

    def follow(self, y: Array) -> tuple[Array, Array]:
        """Map points (..., k) and record all states, (..., rows, 2 n)."""
        points = y.reshape(-1, y.shape[-1])
        images, record = self._recorded(points)
        states = np.ascontiguousarray(np.moveaxis(record, 2, 0))
        return images.reshape(y.shape), states.reshape(*y.shape[:-1], *states.shape[1:])

    def _recorded(self, points: Array) -> tuple[Array, Array]:
        """Images of points (lanes, k), and all states (rows, 2 n, lanes)."""
        state, extra = self.split(points)
        rows = self.periods * self.compiled.grid.steps + 1
        record = np.empty((rows, state.shape[1], len(points)))
        period = self._lane_periods(len(points))
        new = march(
            self.compiled, period, state, self.periods, extra_force=extra, record=record, threads=1
        )
        self.cycles += self.periods
        return image_of(self.coordinates, self.balance, points, new), record

    def differences(self, y: Array, step: float) -> tuple[Array, Array, Array, Array]:
        """Image and states of a point (k,), and their derivatives by its coordinates.

        The states have the shape (rows, 2 n), their derivatives (rows, 2 n, k).
        """
        lanes = -(-(y.size + 1) // WIDTH) * WIDTH  # Whole blocks need no copies.
        images, record = self._recorded(y + step * np.eye(lanes, y.size, -1))
        (image, *disturbed), states = images[: y.size + 1], np.ascontiguousarray(record[:, :, 0])
        slopes = (record[:, :, 1 : y.size + 1] - record[:, :, :1]) / step
        return image, (np.array(disturbed) - image).T / step, states, slopes

    def matrix(
        self, y: Array, step: Array | float, *, central: bool = False
    ) -> tuple[Array, Array]:
        """Images and matrices of the map at points (..., k), by differences of a ``step`` (...)."""
        if self.compiled.engine is not None:
            return self._tangents(y)
        eye, step = np.eye(y.shape[-1]), np.asarray(step)[..., None, None]
        moves = np.vstack((0.0 * eye[:1], eye, -eye if central else eye[:0]))
        images = self(y[..., None, :] + step * moves)
        disturbed = images[..., 1:, :]
        if central:
            plus, minus = np.split(disturbed, 2, axis=-2)
            slope = (plus - minus) / (2.0 * step)
        else:
            slope = (disturbed - images[..., :1, :]) / step
        return images[..., 0, :], np.swapaxes(slope, -1, -2)

    def _tangents(self, y: Array) -> tuple[Array, Array]:
        """Images and matrices at points (..., k), by the tangent of the engine."""
        points = y.reshape(-1, y.shape[-1])
        every = np.repeat(self._lane_periods(1), len(points)) if np.ndim(self.period) == 0 else (
            self._lane_periods(len(points)))  # fmt: skip
        parts = [
            self._tangent(point, float(span)) for point, span in zip(points, every, strict=True)
        ]
        images, matrices = (np.array(part) for part in zip(*parts, strict=True))
        return images.reshape(y.shape), matrices.reshape(*y.shape, y.shape[-1])

    def _tangent(self, y: Array, period: float) -> tuple[Array, Array]:
        from tribodyn.dynamics.orbits.modal_tangent import ModalTangent

        motion, c = self.compiled.engine.motion, self.coordinates
        states, extra = self.split(y)
        tangent = ModalTangent(motion, 1.0 / period, extra[0])
        w = motion.state(*np.split(states[0], 2))[0]
        matrix: Any = np.eye(w.size)
        gains: Array = np.zeros((c.free.shape[1], w.size))
        for _ in range(self.periods):
            part = tangent.at(w)
            w, change = part.state, part.matrix - np.eye(w.size)
            gains = np.asarray(gains + motion.gained(change.T, part.sums[0].T)[1].T @ matrix)
            matrix = np.asarray(part.matrix @ matrix)
        self.cycles += self.periods
        scale = engine_scaling(self.compiled, c)
        matrix, gains = np.linalg.solve(scale, matrix @ scale), gains @ scale
        if self.balance is None:
            return np.asarray(np.linalg.solve(scale, w)), matrix
        # The torque acts by the differences of two motions.
        step = 1e-6 * float(np.linalg.norm(y)) * np.eye(y.size)[-1]
        plus, minus = self(np.stack((y + step, y - step)))
        column = (plus - minus) / (2.0 * step[-1])
        rows = np.vstack((matrix, -self.balance.direction @ gains))
        return 0.5 * (plus + minus), np.column_stack((rows, column))

    @property
    def affine(self) -> bool:
        """Whether the map is affine: no dead zone, no nonlinear friction."""
        if self.compiled.engine is not None:
            return not self.compiled.engine.motion.contacts.dead.any()
        code = self.compiled.program.code
        if self.compiled.nodes.friction_coefficients.shape[-1] > 1:
            return False
        return not any(code[4 + 4 * j + 2] for j in range(self.contacts))

    def multipliers(self, matrix: Array) -> ComplexArray:
        """Floquet multipliers under constant torque, the largest first."""
        inner = matrix if self.balance is None else matrix[:-1, :-1]
        values = np.linalg.eigvals(inner).astype(complex)
        return np.asarray(values[np.argsort(-np.abs(values), kind="stable")])

    def record(self, y: Array) -> tuple[Array, Array]:
        """Integrate one period and record all states."""
        _, states = self.follow(y)
        self.cycles -= self.periods
        return self.without_drift(states), self.split(y)[1][0]

    def without_drift(self, states: Array) -> Array:
        """Remove mean speed and mean acceleration from the free motions, in place."""
        left = self.compiled.nodes.phase[:, 0]
        phase = np.append(np.add.outer(np.arange(self.periods), left), float(self.periods))
        return take_drift_out(self.coordinates, phase[:, None] * self.period, states)


def engine_scaling(compiled: Compiled, coordinates: OrbitCoordinates) -> Array:
    """Matrix (m, m) from reduced vectors to states of the closed structure of an engine."""
    structure = compiled.engine.structure
    places = structure.root @ structure.coordinates.elastic.T @ coordinates.elastic
    speeds = structure.coordinates.moving.T @ coordinates.moving
    count = len(places)
    matrix = np.zeros((count + len(speeds), count + len(speeds)))
    matrix[:count, :count], matrix[count:, count:] = places / coordinates.rate, speeds
    return matrix


def take_drift_out(c: OrbitCoordinates, time: Array, states: Array) -> Array:
    """Remove mean speed and acceleration of free motions from states (..., rows, 2 n), in place.

    ``time`` (..., rows, 1) begins at zero.
    """
    size, end = states.shape[-1] // 2, time[..., -1:, :]
    for basis in (c.free, c.moving @ c.braked):
        if basis.shape[1] == 0:
            continue
        along = c.lower @ basis
        speed, place = states[..., size:] @ along, states[..., :size] @ along
        rise = (speed[..., -1:, :] - speed[..., :1, :]) / end
        still = place - 0.5 * rise * time**2
        drift = (still[..., -1:, :] - still[..., :1, :]) / end
        still -= drift * time
        middle = still[..., :-1, :].mean(axis=-2, keepdims=True)
        back = basis.T @ c.inverse
        moved = still - middle - place
        for i in np.flatnonzero(back.any(axis=0)):  # the coordinates of the free motion
            states[..., i] += moved @ back[:, i]
        if basis is c.free:
            drift = rise * time + drift
            for i in np.flatnonzero(back.any(axis=0)):
                states[..., size + i] -= drift @ back[:, i]
    return states


class Orbits(NamedTuple):
    """Fixed points of a map, one for each start."""

    point: Array  #: (m, k) [m/s]
    matrix: Array  #: derivative of the map there, (m, k, k) [-]
    error: Array  #: distance to the orbit over its size, (m,) [-]


def newton_step(matrix: Array, residual: Array) -> tuple[Array, float]:
    """Step to the fixed point of a map, and the distance to it."""
    slope = np.eye(matrix.shape[0]) - matrix
    step = np.asarray(np.linalg.lstsq(slope, residual, rcond=None)[0], dtype=float)
    return step, float(np.linalg.norm(step) + np.linalg.norm(residual - slope @ step))


def newton(mapping: OrbitMap, points: Array, tolerance: float, rounds: int = _ROUNDS) -> Orbits:
    """Newton's method from points (m, k); the matrix of a point near its orbit is reused."""
    count, size = points.shape
    orbits = Orbits(points.copy(), np.zeros((count, size, size)), np.full(count, np.inf))
    left, far = np.arange(count), np.ones(count, dtype=bool)
    for _ in range(rounds):
        scale = np.linalg.norm(orbits.point[left], axis=1) + 1e-300
        residual = np.empty((left.size, size))
        for rows in (np.flatnonzero(far[left]), np.flatnonzero(~far[left])):
            if rows.size:
                residual[rows] = _residuals(
                    mapping, orbits, left[rows], scale[rows], far[left[rows[0]]]
                )
        steps = [newton_step(orbits.matrix[i], r) for i, r in zip(left, residual, strict=True)]
        error = np.array([distance for _, distance in steps]) / scale
        going = np.flatnonzero((error > tolerance) & (error < _CONTRACTION * orbits.error[left]))
        orbits.error[left] = error
        left = left[going]
        if not left.size:
            break
        orbits.point[left] += np.array([steps[i][0] for i in going])
        far[left] = error[going] > _FAR
    return orbits


def _residuals(mapping: OrbitMap, orbits: Orbits, which: Index, scale: Array, fresh: bool) -> Array:
    """Residuals of some points; with ``fresh`` their matrices are evaluated as well."""
    y, submap = orbits.point[which], mapping.at(which)
    if not fresh:
        return np.asarray(submap(y) - y)
    # Of a linear map any difference is exact, and a large one loses no digits.
    image, orbits.matrix[which] = submap.matrix(
        y, (1.0 if mapping.affine else _DISTURBANCE) * scale
    )
    return np.asarray(image - y)
