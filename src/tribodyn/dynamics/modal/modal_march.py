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

from tribodyn.arrays.linear_algebra import leading_eigenvalues
from tribodyn.dynamics._engine.statistics import Statistics
from tribodyn.dynamics.equations.compiled import Compiled, compile_lanes, sample_system
from tribodyn.dynamics.equations.motion import forces, has_gap, with_middles
from tribodyn.dynamics.equations.nodes import Nodes, ramp_count, spanned_coordinates, springs
from tribodyn.dynamics.equations.orbit_coordinates import OverBases
from tribodyn.dynamics.equations.system import System, contact_label
from tribodyn.dynamics.modal.closed_structure import ClosedStructure
from tribodyn.dynamics.modal.contact_equations import close_contacts, with_dead_zone
from tribodyn.dynamics.modal.modal_tables import CHATTER, UNSETTLED, Contacts, Modes, Trace
from tribodyn.errors import ComputationError, InputError, Problem, require_positive
from tribodyn.types import Array, ComplexArray

#: Coordinates up to which all multipliers are computed, and number of the leading ones beyond.
_DENSE, _LEADING = 24, 4
#: Coordinates above which the automatic choice integrates in modal coordinates.
SMALL = 24


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
        values, place = values[chosen], structure.output @ self._right
        #: Of forces in modes (m, s), and of modes in motion and rate at the contacts (2 r, m).
        self.input, self.output = self._left @ structure.input, np.vstack((place, place * values))
        self.modes = Modes(
            np.ascontiguousarray(values),
            np.array((self.input.T.real, self.input.T.imag), order="C"),
            np.array((self.output.T.real, -self.output.T.imag), order="C"),
            np.hstack((structure.contact_stiffness, structure.contact_damping)).T.copy("C"),
        )
        system = compiled.system
        frictions, count = system.frictions, len(system.contacts)
        members = np.zeros((len(frictions), count))
        for f, friction in enumerate(frictions):
            members[f, list(friction.contacts)] = 1.0
        self.contacts = Contacts(
            with_dead_zone(compiled.nodes).astype(np.int64),
            system._damped_in_gap.astype(float),
            members,
            np.array([friction.load for friction in frictions], dtype=float),
            np.array([friction.limit for friction in frictions], dtype=float),
        )
        self._rows, self._rates = self._table(compiled.nodes)
        self.inverse = np.linalg.inv(structure.matrix)
        count, rows = structure.root.shape[0], structure.free_rows
        root = np.linalg.inv(structure.root)
        self._free_rows = np.hstack((rows[:, :count] @ root, rows[:, count:]))

    def _table(self, nodes: Nodes) -> tuple[Array, Array]:
        """Rows of the kernel (steps, 3, row), and which entries count per time (row,)."""
        structure, system = self.structure, self.compiled.system
        inverse = structure.coordinates.inverse.T
        into_load, onto = inverse @ structure.push, spanned_coordinates(system, nodes)
        directed = inverse if onto is None else onto @ inverse
        into_along, into_push = directed @ structure.along, directed @ structure.push
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
            nodes.force @ into_load,
        ]
        if system.frictions:
            parts += [nodes.friction_direction @ into_push, nodes.friction_coefficients]
        self.shapes = [part.shape[2:] for part in parts]
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

    def gained(self, change: Array, sums: Array) -> tuple[Array, Array]:
        """Integrals of states, and gains of free motions, by changes of state and sums of force."""
        # The integral of a state follows from its equation of motion.
        structure, c = self.structure, self.structure.coordinates
        once = (change - sums @ structure.input.T) @ self.inverse.T
        return once, sums @ (c.free.T @ structure.push).T - once @ self._free_rows.T

    def motion(
        self, state: Array, free: Array, time: Array, first: Array, sums: Array
    ) -> tuple[Array, Array]:
        """Positions and velocities (rows, n); ``first`` (m,) and ``free`` are those at time 0."""
        structure, c = self.structure, self.structure.coordinates
        count, blocked = structure.root.shape[0], c.braked.shape[1]
        once, gained = self.gained(state - first, sums[:, 0])
        twice = sums[:, 1] @ structure.input.T
        double = (once - np.outer(time, first) - twice) @ self.inverse.T
        turned = free[:blocked] + once[:, count:] @ c.braked
        place, speed = np.split(free[blocked:], 2)
        speeds = speed + gained
        places = place + np.outer(time, speed) + sums[:, 1] @ (c.free.T @ structure.push).T
        places = places - double @ self._free_rows.T
        x = state[:, :count] @ structure.places.T
        x = x + turned @ (c.moving @ c.braked).T + places @ c.free.T
        rate = state[:, count:] @ c.moving.T + speeds @ c.free.T
        return x @ c.inverse, rate @ c.inverse

    def split(self, states: Array) -> ComplexArray:
        """Modes (m, k) of states (m, k), one of each conjugate pair."""
        return np.asarray(self._left @ states, dtype=complex)

    def joined(self, modes: ComplexArray) -> Array:
        """States (m, k) of modes."""
        return np.asarray((self._right @ modes).real)

    def rows(self, frequency: float, extra: Array) -> Array:
        """Rows of the kernel (steps, 3, row) at a frequency, under an additional force (n,)."""
        structure, rows = self.structure, self._rows.copy()
        rows[..., self._rates] *= frequency
        width = self.input.shape[1]
        if extra.any():
            count, each = self.contacts.dead.shape
            at = (3 + 2 * each + 2 * structure.along.shape[1] + width) * count
            rows[..., at : at + width] += extra @ structure.coordinates.inverse.T @ structure.push
        return rows

    def advance(
        self,
        state: Array,
        frequency: float,
        cycles: int,
        extra: Array,
        recorded: bool = False,
        log: int = 0,
    ) -> tuple[Array, Array, Trace]:
        """States and sums of forces at the ends of all steps, or the last, from a state (m,)."""
        # log: most changes of side that the trace keeps
        from tribodyn.dynamics.modal.modal_kernel import march_modes

        grid, rows, output = self.compiled.grid, self.rows(frequency, extra), self.output
        widths, kind = np.unique(np.round(grid.width, 15), return_inverse=True)
        z = self.split(state)
        count = cycles * grid.steps + 1 if recorded else 0
        trace = Trace(
            np.empty((count, 2, z.size)),
            np.empty((count, 2, self.input.shape[1])),
            np.empty((grid.steps, 2, len(output))),
            np.zeros(6),
            np.empty((log, 5 + len(output))),
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
            start = np.random.default_rng(0).standard_normal(size)
            values = leading_eigenvalues(difference, start, _LEADING, 1e-3)
        return np.asarray(values[np.argsort(-np.abs(values), kind="stable")], dtype=complex)

    def _refuse_failure(self, trace: Trace, frequency: float) -> None:
        reason, step, contact = (int(value) for value in trace.report[:3])
        if not reason:
            return
        at = step / self.compiled.grid.steps / frequency
        label = contact_label(self.compiled.system, contact)
        causes = {
            UNSETTLED: ("the contact forces of a step do not settle", "Use more steps"),
            CHATTER: (f"{label} opens and closes without end", "Use more steps"),
        }
        default = "the motion grows without bounds", "Check damping, friction and the step"
        what, remedy = causes.get(reason, default)
        why = "The step is too long, or the motion is unstable"
        raise ComputationError(Problem(f"{what}, at {at:.6g} s", "the modal engine", why, remedy))


class ModalEngine:
    """Integrate lanes of one system in modal coordinates, one after the other."""

    def __init__(self, compiled: Compiled, extra_force: Array) -> None:
        self.structure, _ = close_contacts(OverBases.of(compiled, extra_force))
        self.motion = ModalMotion(compiled, self.structure)

    def step_number(self, frequency: float) -> float:
        """``omega_max * dt`` of the widest step; its steps have no such limit."""
        return self.structure.rate * float(self.motion.compiled.grid.width.max()) / frequency

    def march(
        self,
        period: Array,
        state: Array,
        cycles: int,
        extra_force: Array | None = None,
        record: Array | None = None,
        statistics: Statistics | None = None,
    ) -> Array:
        """Integrate lanes over ``cycles`` periods of the clock; returns their new states."""
        size, new, needed = state.shape[1] // 2, np.empty_like(state), record is not None
        for lane, start in enumerate(state):
            extra = np.zeros(size) if extra_force is None else extra_force[lane]
            frequency = 1.0 / float(period[lane])
            forces = frequency, cycles, extra, needed or statistics is not None
            states = self.motion.march(start[:size], start[size:], *forces)
            new[lane] = states[-1]
            if record is not None:
                record[:, :, lane] = states
            if statistics is not None:
                self._gather(states, frequency, extra, statistics, lane)
        return new

    def _gather(
        self, states: Array, frequency: float, extra: Array, statistics: Statistics, lane: int
    ) -> None:
        """Add the plain moments of a recorded motion to those of a lane."""
        compiled, nodes = self.motion.compiled, self.motion.compiled.nodes
        steps = compiled.grid.steps
        cycles = len(states) // steps
        parts = np.stack([states[c * steps : (c + 1) * steps + 1] for c in range(cycles)])
        q, v = with_middles(compiled.grid.width / frequency, parts)
        moved = forces(compiled.system, nodes, frequency, q, v, extra=extra)
        outputs = np.concatenate((q, v), axis=-1) @ statistics.outputs.T
        open_contacts = (moved.deflection <= nodes.gap) & has_gap(nodes)
        weight, share = nodes.weight / cycles, statistics.of_contacts[statistics.contacts :, 4]
        signals = (moved.deflection, moved.contact), (moved.acceleration, outputs)
        for rows, of_kind in zip((statistics.of_contacts, statistics.others), signals, strict=True):
            values = np.concatenate(of_kind, axis=-1)
            rows[:, 0, lane] += np.einsum("rs,crsj->j", weight, values)
            rows[:, 1, lane] += np.einsum("rs,crsj->j", weight, values**2)
            rows[:, 2, lane] = np.minimum(rows[:, 2, lane], values.min(axis=(0, 1, 2)))
            rows[:, 3, lane] = np.maximum(rows[:, 3, lane], values.max(axis=(0, 1, 2)))
        share[:, lane] += np.einsum("rs,crsj->j", weight, 1.0 * open_contacts)


class ModalMarcher:
    """Integrate lanes at their frequencies, under their forces."""

    def __init__(self, compiled: Compiled, frequency: Array, extra_force: Array) -> None:
        self.frequency, self.extra_force = frequency, extra_force
        self._engine = ModalEngine(compiled, extra_force)
        number = self._engine.step_number(float(frequency.min()))
        self.compiled = replace(compiled, step_number=number)

    def march(
        self, state: Array, cycles: int, *, record: Array | None = None, **options: Any
    ) -> Array:
        """Integrate over ``cycles`` periods of the clock."""
        if options.get("statistics") is not None:
            why = "It integrates one motion at a time"
            remedy = 'Use method = "rk4" or "dormand-prince"'
            raise InputError('method = "modal" in an ensemble', "argument method", why, remedy)
        return self._engine.march(1.0 / self.frequency, state, cycles, self.extra_force, record)


def compile_motion(
    system: System, mesh_frequency: float, steps: int, *, any_step: bool = False
) -> Compiled:
    """Compile a system for many motions: in modal coordinates if it is large or has ramps."""
    if not is_modal(system):
        return compile_lanes(system, mesh_frequency, steps, any_step=any_step)
    return compile_modal(system, mesh_frequency, steps)


def compile_modal(system: System, mesh_frequency: float, steps: int) -> Compiled:
    """Compile a system for the integration in modal coordinates."""
    require_positive("mesh_frequency", mesh_frequency, "Hz")
    return with_engine(sample_system(system, steps), float(mesh_frequency))


def with_engine(compiled: Compiled, mesh_frequency: float) -> Compiled:
    """Integrate a sampled system in modal coordinates."""
    engine = ModalEngine(compiled, np.zeros((0, compiled.system.size)))
    return replace(compiled, engine=engine, step_number=engine.step_number(mesh_frequency))


def is_modal(system: System) -> bool:
    """Whether motions are integrated in modal coordinates where nothing else is chosen."""
    ramps = any(ramp_count(f"contacts[{j}]", each) for j, each in enumerate(system.contacts))
    return ramps or (system.size > SMALL and bool(system.contacts))
