"""Motion of a machine with faults over independent phases, and the lines that sensors receive."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from tribodyn.machine.planetary.ring_sensor import passing_weights
from tribodyn.progress import SILENT, Progress
from tribodyn.signals.lines import sum_of_lines
from tribodyn.study.faults.clock import excitations_of, phases_with_faults, rate_of
from tribodyn.study.faults.driven_shafts import drive_machine_over_phases
from tribodyn.study.faults.loose_seat import (
    LooseSeat,
    loose_seats,
    with_lifted_forces,
    with_loose_seats,
)
from tribodyn.study.faults.machine_signals import MachineTurningMotion, RingPlace
from tribodyn.study.faults.sensors import MachineSensors, SensorPlace, seat_accelerance
from tribodyn.study.faults.turning import SAMPLES
from tribodyn.study.machine.motion import (
    MotionLine,
    line_cause,
    machine_motion,
    mesh_rotation,
    phase_units,
)
from tribodyn.study.planetary.stage_result import planetary_angles
from tribodyn.types import Array, ComplexArray, Index

if TYPE_CHECKING:
    from tribodyn.dynamics import PhaseResponse
    from tribodyn.dynamics.harmonic.phase_response import Lines
    from tribodyn.faults.driven import Lead
    from tribodyn.machine import MachineStructure
    from tribodyn.study.machine.case import MachineCase
    from tribodyn.study.machine.result import LoadResult

#: Samples of a turn of a carrier for the weights of its planets at the ring, and part of the
#: strongest line below which lines are left out.
_PASSING, _LEAST = 1024, 1e-10


class SensedLines:
    """Lines of a sensor: frequency [Hz], amplitude of cosines, and cycles of each phase."""

    def __init__(self, frequency: Array, amplitude: ComplexArray, numbers: Index) -> None:
        strong = np.abs(amplitude) > _LEAST * np.abs(amplitude).max(initial=0.0)
        strong[:1] = True
        order = np.flatnonzero(strong)[np.argsort(frequency[strong], kind="stable")]
        self.frequency, self.amplitude = frequency[order], amplitude[order]
        self.numbers = numbers[order]


@dataclass(frozen=True, eq=False, repr=False)
class MachinePhaseMotion(MachineTurningMotion):
    """Motion of a machine over independent phases: a period is that of a piece of it alone."""

    response: PhaseResponse
    seats: dict[str, LooseSeat]
    ahead: Lead | None  #: time by which the rotation is ahead of its mean

    @cached_property
    def _position(self) -> Lines:
        return self.response.lines("position")

    @cached_property
    def _contact(self) -> Lines:
        return self.response.lines("contact_force")

    def sensed(self, sensor: str) -> SensedLines:
        """Lines that a sensor receives."""
        place = self.places.place(sensor)
        passing = place.quantity == "passing_force"
        lines = self._passing_lines(place) if passing else self._linear(place)
        if place.seat is not None:
            seat = place.seat(lines.frequency)
            lines = SensedLines(lines.frequency, lines.amplitude * seat, lines.numbers)
        return lines

    def lines(self, sensor: str, count: int = 20) -> list[MotionLine]:
        """Strongest lines of a sensor by rising frequency, with their causes in words."""
        lines, motion = self.sensed(sensor), self.motion
        assert motion.mesh_phases is not None
        meshes = dict(zip(motion.mesh, motion.mesh_phases.astype(int).tolist(), strict=True))
        strongest = np.argsort(-np.abs(lines.amplitude), kind="stable")
        chosen = np.sort(strongest[lines.frequency[strongest] > 0.0][:count])
        phases = len(self.response.frequencies)
        listed = []
        for at in chosen.tolist():
            numbers = tuple(lines.numbers[at].tolist())
            cause = line_cause(numbers[:phases], meshes, motion.units)
            for turns in numbers[phases:]:
                sign = "-" if turns < 0 else "+"
                cause += f" {sign} {abs(turns)} x carrier" if turns else ""
            amplitude = complex(lines.amplitude[at])
            listed.append(MotionLine(float(lines.frequency[at]), amplitude, numbers, cause))
        return listed

    def harmonics(self, sensor: str) -> tuple[Array, ComplexArray]:
        """Frequencies (k,) [Hz] and complex peak amplitudes (k,) of a signal, from its mean on."""
        lines = self.sensed(sensor)
        return lines.frequency, lines.amplitude

    def signal(self, sensor: str) -> tuple[Array, str]:
        """What a sensor receives on even samples of a piece of the motion, with its unit."""
        count = SAMPLES * self.cycles
        lines = self.harmonics(sensor)
        values = sum_of_lines(*lines, 0.0, self.period / count, count)
        return values, self.places.place(sensor).unit

    def lead_at(self, time: Array) -> Array:
        """Mesh cycles by which the rotation is ahead of its mean at times [s]."""
        if self.ahead is None:
            return np.zeros(time.shape)
        points = time[:, None] * self.response.frequencies % 1.0
        return np.asarray(self.ahead(points)[0] * self.mesh_frequency)

    def _linear(self, place: SensorPlace) -> SensedLines:
        """Lines of a signal that the positions and forces give linearly."""
        structure = self.structure
        if place.quantity == "mesh_force":
            lines = self._contact
            amplitude = lines.amplitude[:, self._contacts_of(place.part)].sum(axis=1)
            return SensedLines(lines.frequency, amplitude, lines.numbers)
        lines = self._position
        position, rate = lines.amplitude, 2j * np.pi * lines.frequency[:, None]
        if place.quantity == "acceleration":
            row = structure.housing_node(place.part)[:3].T @ place.direction
            amplitude = (rate**2 * position) @ row
        elif place.quantity == "force":
            still = np.zeros(position.shape[1])
            preload = structure.bearing_load(place.part, still, still)
            parts = [
                structure.bearing_load(place.part, get(position), get(rate * position)) - preload
                for get in (np.real, np.imag)
            ]
            loads = parts[0] + 1j * parts[1]
            loads[0] += preload
            amplitude = loads[:, :3] @ place.direction
            if place.part in self.seats:
                force = SensedLines(lines.frequency, amplitude, lines.numbers)
                return self._lifted(place, force)
        else:
            amplitude = position @ mesh_rotation(structure, place.part)
        return SensedLines(lines.frequency, amplitude, lines.numbers)

    def _contacts_of(self, mesh: str) -> Index:
        """Numbers of the contacts of a mesh."""
        counts = [max(len(each.contacts), 1) for each in self.machine.meshes.values()]
        at = [*self.machine.meshes].index(mesh)
        return np.arange(sum(counts[:at]), sum(counts[: at + 1]))

    def _lifted(self, place: SensorPlace, force: SensedLines) -> SensedLines:
        """Lines of the force of a loose bearing: that of the pressed seat less what it lacks."""
        seat, position, contact = self.seats[place.part], self._position, self._contact
        first = sum(max(len(each.contacts), 1) for each in self.machine.meshes.values())
        number = first + [*self.seats].index(place.part)
        lift = seat.lost * (position.amplitude @ seat.row)
        lift[0] -= seat.lost * seat.lifted
        share = float(seat.direction @ place.direction)
        return joined(
            force,
            SensedLines(position.frequency, -share * lift, position.numbers),
            SensedLines(contact.frequency, share * contact.amplitude[:, number], contact.numbers),
        )

    def _passing_lines(self, place: SensorPlace) -> SensedLines:
        """Lines at the ring: forces of its meshes times the weights of the passing planets."""
        machine, parts, lines = self.machine, self.machine.planets[place.part], self._contact
        names = parts.mesh_names(place.part)["ring"]
        flow, ring = machine.kinematics.shafts, machine.gears[parts.ring]
        turn = float(np.sign(flow[parts.carrier].speed - flow[ring.shaft].speed))
        mesh = self.motion.mesh.index(names[0])
        rate = self.motion.mesh_frequency[mesh] / abs(ring.teeth)
        at = turn * np.arange(_PASSING) / _PASSING
        weights = np.fft.fft(passing_weights(planetary_angles(parts), at, *self.ring), axis=0)
        weights /= _PASSING
        significant = np.abs(weights).max(axis=1) > _LEAST * np.abs(weights).max()
        count = np.rint(np.fft.fftfreq(_PASSING) * _PASSING).astype(np.int64)[significant]
        force = np.stack(
            [lines.amplitude[:, self._contacts_of(name)].sum(axis=1) for name in names], axis=1
        )
        amplitude = (force @ weights[significant].T).reshape(-1)
        frequency = np.add.outer(lines.frequency, rate * count).reshape(-1)
        numbers = np.concatenate(
            [np.repeat(lines.numbers, count.size, axis=0),
             np.tile(count, len(lines.frequency))[:, None]], axis=1,
        )  # fmt: skip
        back = frequency < 0.0
        amplitude = np.where(back, amplitude.conj(), amplitude)
        numbers = np.where(back[:, None], -numbers, numbers)
        return joined(SensedLines(np.abs(frequency), amplitude, numbers))


def joined(*parts: SensedLines) -> SensedLines:
    """Sum of lines, each number once, the mean first."""
    numbers, first, place = np.unique(
        np.concatenate([part.numbers for part in parts]), axis=0, return_index=True,
        return_inverse=True,
    )  # fmt: skip
    amplitude = np.zeros(len(numbers), dtype=complex)
    np.add.at(amplitude, place.reshape(-1), np.concatenate([part.amplitude for part in parts]))
    frequency = np.concatenate([part.frequency for part in parts])[first]
    still = ~numbers.any(axis=1)
    amplitude[still] = amplitude[still].real
    return SensedLines(frequency, amplitude, numbers)


def phase_motion(
    case: MachineCase, sound: LoadResult, structure: MachineStructure, progress: Progress = SILENT
) -> MachinePhaseMotion:
    """Find the motion of a machine with faults over phases of its meshes and shafts."""
    from tribodyn.dynamics import PhaseResponse, harmonic_balance
    from tribodyn.machine import system as system_of

    machine, excited = structure.machine, excitations_of(case)
    phases = phases_with_faults(machine, excited)
    seats, response, ahead = loose_seats(case, structure, sound.motion), sound.response, None
    same = machine.meshes == sound.machine.meshes and not (excited or seats)
    if not (same and isinstance(response, PhaseResponse)):
        system = with_loose_seats(system_of(structure, phases=phases), seats)
        driven = [(each, phases.driven[rate_of(machine, each)]) for each in excited]
        system, ahead = drive_machine_over_phases(structure, system, driven)
        response = harmonic_balance(system, phases.frequency, progress=progress)
    assert isinstance(response, PhaseResponse)
    motion = with_lifted_forces(machine_motion(structure, response, phases), response, seats)
    units = phase_units(machine, phases, [each.gear for each in excited])
    motion = replace(motion, units=units)
    fastest, clock = int(motion.cycles.max()), machine.clock
    frequency = float(motion.mesh_frequency.max())
    turns = {n: float(t) * clock.frequency * fastest / frequency for n, t in clock.turns.items()}
    return MachinePhaseMotion(
        cycles=fastest,
        mesh_frequency=frequency,
        places=MachineSensors(machine, seat_accelerance(case.motion)),
        turns=turns,
        tacho=machine.operation.input,
        lead=np.zeros_like,
        sound=sound,
        structure=structure,
        motion=motion,
        ring=RingPlace(),
        response=response,
        seats=seats,
        ahead=ahead,
    )
