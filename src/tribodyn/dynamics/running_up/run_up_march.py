"""Integrate one lane over mesh cycles of varying speed, one cycle after the other."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from tribodyn.dynamics._engine.method import RungeKutta4
from tribodyn.dynamics._engine.statistics import Statistics
from tribodyn.dynamics.equations.compiled import Compiled, sample_system
from tribodyn.dynamics.equations.divergence import chattering_step
from tribodyn.dynamics.equations.motion import compression, forces, has_gap, sides
from tribodyn.dynamics.equations.nodes import Nodes
from tribodyn.dynamics.equations.orbit_coordinates import (
    Balance,
    OrbitCoordinates,
    orbit_coordinates,
)
from tribodyn.dynamics.equations.program import Program
from tribodyn.dynamics.equations.system import System
from tribodyn.dynamics.modal.modal_march import ModalMarcher
from tribodyn.dynamics.running_up.run_up_result import SpeedProfile
from tribodyn.dynamics.running_up.run_up_tables import Table, Tables, blend_weight
from tribodyn.dynamics.time.response import Response, build_response
from tribodyn.errors import ComputationError
from tribodyn.interrupt import refuse_stopped, stop_flag
from tribodyn.types import Array

#: Part of the unbalanced torque of a cycle that is compensated in the next, after the first cycles.
_SERVO = 0.125
#: Smallest relevant shift of the middle of a step, as a part of its width.
_SHIFT = 1e-8


@dataclass(frozen=True)
class Pace:
    """Speed within some mesh cycles on one grid."""

    time: Array  #: time at the ends of the steps [s]
    share: Array  #: duration of each step over that of its cycle [-]
    shift: Array  #: [-]
    ratio: Array  #: [-]

    @classmethod
    def over(cls, profile: SpeedProfile, table: Table, first: int, count: int) -> Pace:
        """Compute the pace of some cycles."""
        grid = table.grid
        cycle = first + np.arange(count)[:, None]
        time = profile.time_at(cycle + np.append(grid.left, 1.0))
        middle = 0.5 * (time[:, 1:] + time[:, :-1])
        period = time[:, -1:] - time[:, :1]
        centre = grid.left + 0.5 * grid.width
        shift = (profile.phase_at(middle) - cycle - centre) / grid.width
        places = np.stack((time[:, :-1], middle, time[:, 1:]), axis=-1)
        ratio = profile.frequency_at(places) * period[:, :, None]
        return cls(time, np.diff(time, axis=1) / period, shift, ratio)


class CycleMarcher:
    """Integrate one mesh cycle at a time, with a balanced drive."""

    def __init__(
        self, tables: Tables, frequency: Array, lowest: float, outputs: Array, inertia: Array
    ) -> None:
        table = tables.at(lowest)
        system = tables.systems[0]
        first = Compiled(system, table.grid, table.nodes[0], table.programs[0], 0.0)
        self.tables, self.systems = tables, tables.systems
        self.frequency, self.outputs, self.inertia = frequency, outputs, inertia
        self.size, self.contacts = system.size, len(system.contacts)
        self.coordinates: OrbitCoordinates = orbit_coordinates(first, lowest)
        self.inverse = system.inverse_mass
        lower, free = self.coordinates.lower, self.coordinates.free
        #: Free velocities of a velocity, and the velocity of one of them.
        self.down, self.up = lower @ free, free.T @ np.linalg.inv(lower)
        #: Free motion of a position or velocity.
        self.free = self.down @ self.up
        self.balance = Balance.of(system, self.coordinates)
        self.torque = np.zeros(self.size)
        #: Time at the beginning of the cycle, for messages.
        self.time = 0.0
        self.count = 0
        self._rows: Array = np.zeros(0)
        #: Steps, number of a system, and by how much the rows of the next one differ.
        self._between: tuple[int, int, Array] = (0, 0, self._rows)
        self._fresh = Statistics.of(first, outputs, 1).moments[:, 0]

    def weights(self, frequency: float) -> tuple[int, float]:
        """Number of the first of two neighbouring systems at a speed, and part of the second."""
        return blend_weight(self.frequency, frequency)

    def program(self, table: Table, pace: Pace, cycle: int, frequency: float) -> Program:
        """Program of one cycle."""
        left, part = self.weights(frequency)
        base = table.programs[left]
        steady = base.constant_load
        shape = (table.grid.steps, 3, int(base.code[2]))
        rows = base.rows.reshape(shape)
        level = not np.any(np.abs(pace.shift[cycle]) > _SHIFT)
        if level and part == 0.0 and np.ptp(pace.ratio[cycle]) < _SHIFT:
            return base._replace(width=np.ascontiguousarray(pace.share[cycle]))
        if self._rows.size != base.rows.size:
            self._rows = np.empty(base.rows.size)
        cycle_rows = self._rows.reshape(shape)
        if part > 0.0:
            other = table.programs[left + 1]
            if self._between[:2] != (table.grid.steps, left):
                change = other.rows.reshape(shape) - rows
                self._between = (table.grid.steps, left, change)
            np.multiply(self._between[2], part, out=cycle_rows)
            cycle_rows += rows
            steady = steady + part * (other.constant_load - steady)
        else:
            np.copyto(cycle_rows, rows)
        if not level:
            cycle_rows[:, 1] += pace.shift[cycle][:, None] * (cycle_rows[:, 2] - cycle_rows[:, 0])
        for column in table.slopes:
            cycle_rows[:, :, column] *= pace.ratio[cycle]
        width = np.ascontiguousarray(pace.share[cycle])
        return base._replace(rows=cycle_rows.reshape(-1), width=width, constant_load=steady)

    def hold(self, torque: Array) -> None:
        """Start with a known balancing torque."""
        self.torque, self.count = torque.copy(), int(1.0 / _SERVO)

    def without_free_motion(self, state: Array) -> Array:
        """Remove the free motion from a state."""
        n = self.size
        place, speed = state[:n], state[n:]
        return np.concatenate((place - place @ self.free, speed - speed @ self.free))

    def cycle(
        self, program: Program, period: float, change: float, state: Array, record: Array
    ) -> tuple[Array, Array, Array]:
        """Integrate one cycle: new state, moments and extra force."""
        from tribodyn.dynamics._engine.marching import CHATTERING, march_block
        from tribodyn.dynamics._engine.running_statistics import Gathered

        load = self.inertia * change
        extra = self.torque + load
        if self.balance is not None:
            direction, force, *_ = self.balance
            extra = extra - (self.up @ load) @ direction * force
        moments, lane = self._fresh.copy(), state[None, :].copy()
        load = (program.constant_load + extra @ self.inverse.T)[None, :]
        block = (0.0,), RungeKutta4(), program, program.rows, np.array([period]), load, lane, 1
        gathered = Gathered(self.outputs, np.zeros(0), 0, moments)
        failed = refuse_stopped(march_block(*block, record, gathered, stop_flag()))
        if failed >= CHATTERING:
            contacts = len(self.systems[0].contacts)
            step, contact = divmod(failed - CHATTERING, contacts)
            phase = float(program.width[:step].sum())
            raise chattering_step(contact, contacts, phase, self.time + phase * period, None)
        if failed >= 0:
            finite = np.isfinite(record[:failed, :, 0]).all(axis=1)
            last = max((failed if finite.all() else int(np.argmin(finite))) - 1, 0)
            weight = np.sqrt(np.diag(np.asarray(self.systems[0].mass)))
            with np.errstate(all="ignore"):
                speed = np.nan_to_num(np.abs(record[last, self.size :, 0]) * weight, nan=np.inf)
            name = self.systems[0].names[int(np.argmax(speed))]
            raise ComputationError(
                f"the motion grew beyond all bounds after {self.time:.5g} s, at "
                f"{1.0 / period:.5g} Hz, first in coordinate {name}",
                why="The step is within the stability limit of the integrator, so the system "
                "itself is unstable at this speed",
                remedy="Check for negative stiffness or damping, and for friction that feeds "
                "energy in",
            )
        new = lane[0]
        if self.balance is not None:
            direction, force, *_ = self.balance
            gained = float(((new - state)[self.size :] @ self.down) @ direction)
            self.count += 1
            part = max(_SERVO, 1.0 / self.count)
            self.torque = self.torque - part * gained / period * force
        return new, moments, extra


class Samples:
    """Collect the samples of all mesh cycles."""

    def __init__(
        self, systems: Sequence[System], frequency: Array, cycles: int, samples: int
    ) -> None:
        system = systems[0]
        self.system, self.size, self.several = system, system.size, frequency.size > 1
        shape = (cycles, samples)
        self.time, self.beat = np.empty(shape), np.empty(shape)
        self.state = np.empty((*shape, 2 * system.size))
        self.acceleration = np.empty((*shape, system.size))
        self.deflection = np.empty((*shape, len(system.contacts)))
        self.force = np.empty((*shape, len(system.contacts)))

    def add(
        self,
        table: Table,
        first: int,
        time: Array,
        frequency: Array,
        states: Array,
        weights: Sequence[tuple[int, float]],
        extra: Sequence[Array],
    ) -> None:
        """Add some mesh cycles."""
        part = slice(first, first + len(weights))
        q, v = states[..., : self.size], states[..., self.size :]

        rows = Nodes(*(self._rows(table, name, weights) for name in Nodes._fields))
        dead = np.any([has_gap(node) for node in table.nodes], axis=0)
        beat, pulled = frequency[..., None], np.array(extra)[:, None]
        d = compression(rows, q)
        moved = forces(self.system, rows, beat, q, v, side=sides(d, rows.gap, dead), extra=pulled)
        self.time[part], self.beat[part], self.state[part] = time, frequency, states
        self.acceleration[part] = moved.acceleration
        self.deflection[part], self.force[part] = d, moved.contact

    def _rows(self, table: Table, name: str, weights: Sequence[tuple[int, float]]) -> Array:
        """Values at the samples, (cycles or 1, samples, ...)."""
        values = [getattr(node, name)[table.sample_steps, 0] for node in table.nodes]
        if not self.several:
            return np.asarray(values[0][None])
        stacked = np.array(values)
        left = np.array([number for number, _ in weights])
        part = np.array([share for _, share in weights])
        part = part.reshape(-1, *(1,) * (stacked.ndim - 1))
        return np.asarray((1.0 - part) * stacked[left] + part * stacked[left + 1])

    def series(self, outputs: Array) -> dict[str, Array]:
        """All signals as series over time."""
        cycles, samples = self.time.shape
        flat = self.state.reshape(cycles * samples, -1)
        return {
            "time": self.time.reshape(-1),
            "phase": np.arange(cycles * samples) / samples,
            "mesh_frequency": self.beat.reshape(-1),
            "position": flat[:, : self.size],
            "velocity": flat[:, self.size :],
            "acceleration": self.acceleration.reshape(-1, self.size),
            "deflection": self.deflection.reshape(cycles * samples, -1),
            "contact_force": self.force.reshape(cycles * samples, -1),
            "output": flat @ outputs.T,
        }


def periods_at(
    system: System, frequencies: Iterable[float], start: Response, steps: int, every: int = 1
) -> Iterator[Response | None]:
    """Integrate in modal coordinates one period of the clock at each frequency [Hz].

    Each begins at the end of the one before, the first where ``start`` does, whose balancing torque
    acts all along. Of ``every`` so many periods one is recorded, others are None.
    """
    compiled = sample_system(system, steps)
    frequency, extra = np.array([start.mesh_frequency]), start.extra_force
    marcher = ModalMarcher(compiled, frequency, extra[None])
    state = np.concatenate((start.position[0], start.velocity[0]))[None]
    rate = marcher.compiled.step_number * start.mesh_frequency
    for number, hertz in enumerate(frequencies):
        frequency[0] = hertz
        if number % every:
            state = marcher.march(state, 1)
            yield None
            continue
        record = np.empty((compiled.grid.steps + 1, state.size, 1))
        state = marcher.march(state, 1, record=record)
        grid = replace(marcher.compiled, step_number=rate / hertz)
        yield build_response(grid, hertz, record[:, :, 0], extra, engine="modal")
