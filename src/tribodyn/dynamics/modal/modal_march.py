"""Time integration of machines in modal coordinates.

The linear structure with its contacts closed at their mean stiffness is integrated exactly, mode by
mode (:class:`~tribodyn.dynamics.modal.closed_structure.ClosedStructure`). Its modes are the
complex ones of the first-order form: they take damping that is not proportional and gyroscopic
moments without an explicit force. Free rotations of the drive follow from integrals of the forces.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from tribodyn.dynamics.equations.compiled import Compiled
from tribodyn.dynamics.equations.nodes import Nodes, springs
from tribodyn.dynamics.modal.closed_structure import ClosedStructure
from tribodyn.dynamics.modal.contact_equations import close_contacts, with_dead_zone
from tribodyn.dynamics.modal.modal_kernel import (
    CHATTER,
    UNSETTLED,
    Contacts,
    Modes,
    Trace,
    march_modes,
)
from tribodyn.errors import ComputationError, InputError, Problem
from tribodyn.types import Array, ComplexArray

#: Coordinates up to which all multipliers are computed, and number of the leading ones beyond.
_DENSE, _LEADING = 24, 4


class ModalMotion:
    """Integrate one system in modal coordinates at any frequency of the clock."""

    def __init__(self, compiled: Compiled, structure: ClosedStructure) -> None:
        if structure.modes is None:
            what = "the damped modes of the structure do not span its motions"
            why = "Two modes coincide, for example at critical damping"
            remedy = 'Use method = "rk4", or change the damping slightly'
            raise InputError(what, "System.damping", why, remedy)
        self.compiled, self.structure = compiled, structure
        values, right, left = structure.modes
        chosen = values.imag >= 0.0
        weight = np.where(values.imag[chosen] > 0.0, 2.0, 1.0)
        self._right, self._left = right[:, chosen] * weight, left[chosen]
        self.modes = Modes(
            np.ascontiguousarray(values[chosen]),
            self._left @ structure.input,
            structure.output @ self._right,
            np.ascontiguousarray(structure.contact_stiffness),
            np.ascontiguousarray(structure.contact_damping),
        )
        system = compiled.system
        frictions, count = system.frictions, len(system.contacts)
        members = np.zeros((len(frictions), count))
        for f, friction in enumerate(frictions):
            members[f, list(friction.contacts)] = 1.0
        self.contacts = Contacts(
            with_dead_zone(compiled.nodes).astype(np.int64),
            np.array([float(contact.damping_in_gap) for contact in system.contacts]),
            members,
            np.array([friction.load for friction in frictions], dtype=float),
            np.array([friction.limit for friction in frictions], dtype=float),
        )
        self._rows, self._rates = self._table(compiled.nodes)
        self.inverse = np.linalg.inv(structure.matrix)

    def _table(self, nodes: Nodes) -> tuple[Array, Array]:
        """Rows of the kernel (steps, 3, row), and which entries count per time (row,)."""
        structure, system = self.structure, self.compiled.system
        inverse = structure.coordinates.inverse.T
        into_along, into_push = inverse @ structure.along, inverse @ structure.push
        stiffness, gap = springs(nodes)
        parts = [
            stiffness,
            nodes.damping,
            nodes.error,
            nodes.error_slope,
            gap,
            nodes.direction @ into_along,
            nodes.direction_slope @ into_along,
            nodes.force_direction @ into_push,
            nodes.force @ into_push,
        ]
        if system.frictions:
            parts += [nodes.friction_direction @ into_push, nodes.friction_coefficients]
        flat = [part.reshape(*nodes.phase.shape, -1) for part in parts]
        marks = [np.full(part.shape[2], i in (3, 6)) for i, part in enumerate(flat)]
        return np.concatenate(flat, axis=2), np.concatenate(marks)

    def state(self, q: Array, v: Array) -> tuple[Array, Array]:
        """State (m,) of elastic positions and velocities, and free motions, from a position."""
        structure, c = self.structure, self.structure.coordinates
        x, rate = q @ c.lower, v @ c.lower
        elastic = structure.root @ (c.elastic.T @ x)
        braked = (c.moving @ c.braked).T @ x
        free = np.concatenate((braked, c.free.T @ x, c.free.T @ rate))
        return np.concatenate((elastic, c.moving.T @ rate)), free

    def motion(
        self, state: Array, free: Array, time: Array, first: Array, sums: Array
    ) -> tuple[Array, Array]:
        """Positions and velocities (rows, n); ``first`` (m,) and ``free`` are those at time 0."""
        structure, c = self.structure, self.structure.coordinates
        count, blocked = structure.root.shape[0], c.braked.shape[1]
        # The integral of a state follows from its equation of motion.
        gain, twice = sums[:, 0] @ structure.input.T, sums[:, 1] @ structure.input.T
        once = (state - first - gain) @ self.inverse.T
        double = (once - np.outer(time, first) - twice) @ self.inverse.T
        turned = free[:blocked] + once[:, count:] @ c.braked
        place, speed = np.split(free[blocked:], 2)
        push, rows = c.free.T @ structure.push, structure.free_rows.copy()
        rows[:, :count] = rows[:, :count] @ np.linalg.inv(structure.root)
        speeds = speed + sums[:, 0] @ push.T - once @ rows.T
        places = place + np.outer(time, speed) + sums[:, 1] @ push.T - double @ rows.T
        x = state[:, :count] @ structure.places.T
        x = x + turned @ (c.moving @ c.braked).T + places @ c.free.T
        rate = state[:, count:] @ c.moving.T + speeds @ c.free.T
        return x @ c.inverse, rate @ c.inverse

    def advance(
        self, state: Array, frequency: float, cycles: int, extra: Array, recorded: bool = False
    ) -> tuple[Array, Array, Trace]:
        """States and sums of forces at the ends of all steps, or the last, from a state (m,)."""
        structure, grid = self.structure, self.compiled.grid
        rows = self._rows.copy()
        rows[..., self._rates] *= frequency
        width = self.modes.input.shape[1]
        if extra.any():
            count, each = self.contacts.dead.shape
            at = (3 + 2 * each + 2 * structure.along.shape[1] + width) * count
            rows[..., at : at + width] += extra @ structure.coordinates.inverse.T @ structure.push
        widths, kind = np.unique(np.round(grid.width, 15), return_inverse=True)
        z = self._left @ state
        output = np.concatenate((self.modes.output, self.modes.output * self.modes.values))
        count = cycles * grid.steps + 1 if recorded else 0
        trace = Trace(
            np.empty((count, 2, z.size)),
            np.empty((count, 2, width)),
            np.empty((grid.steps, 2, structure.along.shape[1])),
            np.zeros(5),
        )
        parts = np.stack((z.real, z.imag))
        sums = march_modes(
            self.modes,
            self.contacts,
            rows,
            widths / frequency,
            kind.astype(np.int64).reshape(-1),
            grid.after_event.astype(np.int64),
            np.ascontiguousarray((output @ z).real),
            parts,
            cycles,
            trace,
        )
        self._refuse_failure(trace, frequency)
        ends, totals = (trace.modes, trace.sums) if recorded else (parts[None], sums[None])
        return ((ends[:, 0] + 1j * ends[:, 1]) @ self._right.T).real, totals, trace

    def march(
        self, q: Array, v: Array, frequency: float, cycles: int, extra: Array, recorded: bool
    ) -> Array:
        """Positions and velocities (rows, 2 n) at the ends of all steps, or the last."""
        first, free = self.state(q, v)
        state, sums, _ = self.advance(first, frequency, cycles, extra, recorded)
        time = np.array([cycles / frequency])
        if recorded:
            left = np.add.outer(np.arange(cycles), self.compiled.grid.left).reshape(-1)
            time = np.append(left, cycles) / frequency
        return np.concatenate(self.motion(state, free, time, first, sums), axis=1)

    def multipliers(self, state: Array, frequency: float, extra: Array) -> ComplexArray:
        """Floquet multipliers of a periodic motion, the largest first."""
        size = state.size
        end = self.advance(state, frequency, 1, extra)[0][0]
        step = 1e-6 * float(np.linalg.norm(state))

        def difference(direction: Array) -> Array:
            moved = self.advance(state + step * direction, frequency, 1, extra)[0][0]
            return np.asarray((moved - end) / step)

        if size <= _DENSE:
            values = np.linalg.eigvals(np.stack([difference(row) for row in np.eye(size)], axis=1))
        else:
            from scipy.sparse.linalg import LinearOperator, eigs

            operator = LinearOperator((size, size), matvec=difference, dtype=float)
            start = np.random.default_rng(0).standard_normal(size)
            values = eigs(operator, _LEADING, v0=start, tol=1e-3, return_eigenvectors=False)
        return np.asarray(values[np.argsort(-np.abs(values), kind="stable")], dtype=complex)

    def _refuse_failure(self, trace: Trace, frequency: float) -> None:
        reason, step, contact = (int(value) for value in trace.report[:3])
        if not reason:
            return
        at = step / self.compiled.grid.steps / frequency
        causes = {
            UNSETTLED: ("the contact forces of a step do not settle", "Use more steps"),
            CHATTER: (f"contact {contact} opens and closes without end", "Use more steps"),
        }
        default = "the motion grows without bounds", "Check damping, friction and the step"
        what, remedy = causes.get(reason, default)
        why = "The step is too long, or the motion is unstable"
        raise ComputationError(Problem(f"{what}, at {at:.6g} s", "the modal engine", why, remedy))


class ModalMarcher:
    """Integrate lanes of one system in modal coordinates, one after the other."""

    def __init__(self, compiled: Compiled, frequency: Array, extra_force: Array) -> None:
        self.frequency, self.extra_force = frequency, extra_force
        structure, _ = close_contacts(compiled, extra_force)
        number = structure.rate * float(compiled.grid.width.max() / frequency.min())
        self.compiled = replace(compiled, step_number=number)
        self._motion = ModalMotion(compiled, structure)

    def march(
        self, state: Array, cycles: int, *, record: Array | None = None, **options: Any
    ) -> Array:
        """Integrate over ``cycles`` periods of the clock."""
        if options.get("statistics") is not None:
            why = "It integrates one motion at a time"
            remedy = 'Use method = "rk4" or "dormand-prince"'
            raise InputError('method = "modal" in an ensemble', "argument method", why, remedy)
        size, new = self.compiled.system.size, np.empty_like(state)
        for lane, start in enumerate(state):
            forces = float(self.frequency[lane]), cycles, self.extra_force[lane]
            states = self._motion.march(start[:size], start[size:], *forces, record is not None)
            new[lane] = states[-1]
            if record is not None:
                record[:, :, lane] = states
        return new
