"""The linear structure with its contacts closed at their mean stiffness, by its modes.

In coordinates ``x`` of unit mass the structure is a first-order system ``w' = A w + B u``,
``y = C w`` of the elastic positions and all velocities that a spring, damper or contact feels. The
free rotation of the drive is left out. ``u`` are the components of the generalized force along the
directions in which the contacts and the loads push, ``y`` those of the motion along the directions
that compress contacts. Contacts are part of ``A`` with a mean stiffness and damping, so that ``A``
is regular; the rest of their forces is part of ``u``.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property

import numpy as np

from tribodyn.dynamics.equations.orbit_coordinates import Balance, OrbitCoordinates
from tribodyn.dynamics.equations.system import System
from tribodyn.errors import ComputationError, Problem
from tribodyn.types import Array, ComplexArray

#: Condition of the matrix of modes above which equations are solved per frequency instead.
_ILL_CONDITIONED = 1e8
#: Damping ratio, and distance of a mode from a harmonic over its frequency, that are none.
_UNDAMPED = 1e-12
#: Frequencies whose matrices are factorized together.
_CHUNK = 64


class ClosedStructure:
    """Receptances and motions of a structure under forces at its contacts."""

    # push (n, s), along (n, r): orthonormal bases of forces and compressions; stiffness and damping
    # (s, r): means of the contacts between the two, in coordinates of unit mass [1/s^2, 1/s].
    def __init__(
        self,
        system: System,
        coordinates: OrbitCoordinates,
        push: Array,
        along: Array,
        stiffness: Array,
        damping: Array,
    ) -> None:
        inverse = coordinates.inverse
        self.coordinates, self.push, self.along = coordinates, push, along
        self.contact_stiffness, self.contact_damping = stiffness, damping
        spring = inverse @ np.asarray(system.stiffness) @ inverse.T + push @ stiffness @ along.T
        damper = inverse @ system.rate_matrix @ inverse.T + push @ damping @ along.T
        elastic, moving = coordinates.elastic, coordinates.moving
        self.free_rows = coordinates.free.T @ np.hstack((spring @ elastic, damper @ moving))
        stored = elastic.T @ spring @ elastic
        self.root = _energy_root(stored)  # positions in the metric of the elastic energy
        unscaled = np.linalg.inv(self.root)
        self.places = elastic @ unscaled
        size, count = moving.shape[1], elastic.shape[1]
        self.matrix = np.zeros((count + size, count + size))
        self.matrix[:count, count:] = self.root @ elastic.T @ moving
        self.matrix[count:, :count] = -moving.T @ spring @ self.places
        self.matrix[count:, count:] = -moving.T @ damper @ moving
        self.input = np.vstack((np.zeros((count, push.shape[1])), moving.T @ push))
        self.output = np.hstack((along.T @ self.places, np.zeros((along.shape[1], size))))
        self.balance = Balance.of(system, coordinates)

    @cached_property
    def modes(self) -> tuple[ComplexArray, ComplexArray, ComplexArray] | None:
        """Eigenvalues, right modes and left modes; None if they do not span all motions."""
        values, right = np.linalg.eig(self.matrix)
        try:
            left = np.linalg.inv(right)
        except np.linalg.LinAlgError:
            return None
        if not np.linalg.norm(right, 1) * np.linalg.norm(left, 1) < _ILL_CONDITIONED:
            return None
        return values.astype(complex), right.astype(complex), left.astype(complex)

    @cached_property
    def rate(self) -> float:
        """Largest rate of the motion [rad/s]."""
        values = np.linalg.eigvals(self.matrix) if self.modes is None else self.modes[0]
        return float(np.abs(values).max(initial=0.0))

    @cached_property
    def decay(self) -> float:
        """Rate at which the slowest motion decays [1/s]; negative if it grows."""
        values = np.linalg.eigvals(self.matrix) if self.modes is None else self.modes[0]
        return -float(values.real.max(initial=-np.inf))

    def respond(
        self, omega: Array, force: ComplexArray, output: Array | None = None
    ) -> ComplexArray:
        """Amplitudes of the state, or of rows of it (c, m), under forces (k, s)."""
        if self.modes is None:
            state = self._solve(omega, (force @ self.input.T)[..., None])[..., 0]
            return state if output is None else np.asarray(state @ output.T)
        values, right, left = self.modes
        modal = force @ (left @ self.input).T / (1j * omega[:, None] - values)
        return np.asarray(modal @ (right if output is None else output @ right).T, dtype=complex)

    def _solve(self, omega: Array, loads: ComplexArray) -> ComplexArray:
        """Amplitudes under loads on the state (k or 1, m, c), without modes."""
        eye = np.eye(len(self.matrix))
        loads = np.broadcast_to(loads, (omega.size, *loads.shape[1:]))
        parts = [
            np.linalg.solve(1j * omega[at, None, None] * eye - self.matrix, loads[at])
            for at in np.split(np.arange(omega.size), np.arange(_CHUNK, omega.size, _CHUNK))
        ]
        return np.concatenate(parts)

    def refuse_resonance(
        self, omega: Array, names: Callable[[int], str] = "harmonic {} of the clock".format
    ) -> None:
        """Refuse a mode without damping whose frequency is one of these lines."""
        values = np.linalg.eigvals(self.matrix) if self.modes is None else self.modes[0]
        still = np.abs(values.real) <= _UNDAMPED * np.abs(values)
        for value in np.abs(values[still & (values.imag > 0.0)]):
            line = int(np.argmin(np.abs(np.abs(omega) - value)))
            if abs(abs(omega[line]) - value) <= _UNDAMPED * value:
                what = f"a mode of {value / (2.0 * np.pi):.6g} Hz has no damping"
                why = f"It is {names(line)}, so that its motion grows without bounds"
                remedy = "Give System.damping or Contact.damping, or another frequency"
                raise ComputationError(Problem(what, "System.damping", why, remedy))

    def receptances(
        self, omega: Array, along: Array | None = None, push: Array | None = None
    ) -> ComplexArray:
        """Motions at the contacts per force there, (k, r, s) [s^2]; the first frequency is zero."""
        # along, push: directions within those of all contacts and loads, all by default.
        output, into = self.output, self.input
        if along is not None:
            output = along.T @ self.along @ self.output
        if push is not None:
            into = self.input @ (self.push.T @ push)
        matrices = self._receptances(omega, output, into)
        if self.balance is not None:
            still = self._at_rest
            still = still if along is None else along.T @ self.along @ still
            matrices[0] = still if push is None else still @ (self.push.T @ push)
        return matrices

    def _receptances(self, omega: Array, output: Array, into: Array) -> ComplexArray:
        if self.modes is None:
            return np.asarray(output @ self._solve(omega, into[None].astype(complex)))
        values, right, left = self.modes
        shares = (output @ right).T[:, :, None] * (left @ into)[:, None, :]
        flat = (1.0 / (1j * omega[:, None] - values)) @ shares.reshape(values.size, -1)
        return np.asarray(flat.reshape(omega.size, *shares.shape[1:]), dtype=complex)

    @cached_property
    def _at_rest(self) -> ComplexArray:
        """Motions at all contacts per constant force (r, s) with the balancing torque."""
        torque, gain = self._balancing()
        still = np.eye(len(gain)) - np.outer(torque, gain)
        # The torque balances all forces on the drive, those of the closed contacts included.
        matrix = self._receptances(np.zeros(1), self.output, self.input)[0]
        loop = matrix @ np.outer(torque, gain @ self.contact_stiffness)
        return np.asarray(np.linalg.solve(np.eye(len(loop)) - loop, matrix @ still))

    def _balancing(self) -> tuple[Array, Array]:
        """Components of the balancing torque for a unit gain, and the gain by forces (s,)."""
        assert self.balance is not None
        coordinates = self.coordinates
        torque = self.push.T @ (coordinates.inverse @ self.balance.force)
        return torque, self.balance.direction @ coordinates.free.T @ self.push

    def balanced(self, force: ComplexArray, closing: Array) -> tuple[ComplexArray, Array]:
        """Amplitudes of forces (k, s) with the balancing torque, and this torque (n,)."""
        # closing (s,): mean force of the closed contacts in opposite sense, a part of the first.
        if self.balance is None:
            return force, np.zeros(len(self.push))
        torque, gain = self._balancing()
        size = -float(gain @ (force[0].real - closing))
        total = force.copy()
        total[0] += size * torque
        return total, size * self.balance.force

    def motion(self, omega: Array, force: ComplexArray) -> tuple[ComplexArray, ComplexArray]:
        """Amplitudes (k, n) of positions and velocities under forces (k, s)."""
        c, (size, count) = self.coordinates, self.places.shape
        free_rows = self.free_rows.copy()
        free_rows[:, :count] = free_rows[:, :count] @ np.linalg.inv(self.root)
        zero = np.zeros
        output = np.vstack((
            np.hstack((c.inverse.T @ self.places, zero((size, len(self.matrix) - count)))),
            np.hstack((zero((c.braked.shape[1], count)), c.braked.T)),
            free_rows,
        ))  # fmt: skip
        moved = self.respond(omega, force, output)
        elastic, braked, resisting = np.split(moved, [size, size + c.braked.shape[1]], axis=1)
        still = omega == 0.0
        per_omega = np.divide(1.0, 1j * omega, where=~still, out=zero(omega.size, complex))[:, None]
        pushed = (force @ (c.free.T @ self.push).T - resisting) * per_omega**2
        turned = (c.moving @ c.braked).T @ c.inverse
        x = elastic + (braked * per_omega) @ turned + pushed @ (c.free.T @ c.inverse)
        rate = 1j * omega[:, None] * x
        rate[still] = self.respond(omega[still], force[still])[:, count:] @ (c.moving.T @ c.inverse)
        return x, rate


def _energy_root(stored: Array) -> Array:
    """Square root R of a stiffness, ``R^T R``, or of its size where it is not positive."""
    even = 0.5 * (stored + stored.T)
    try:
        return np.asarray(np.linalg.cholesky(even).T)
    except np.linalg.LinAlgError:
        return np.asarray(np.sqrt(np.linalg.norm(even, 2)) * np.eye(len(even)))
