"""What sensors of a machine receive of its motion with faults."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from tribodyn.dynamics.harmonic.phase_response import Lines
from tribodyn.faults import BearingForce, BearingImpacts
from tribodyn.machine.planetary.ring_sensor import passing_weights
from tribodyn.study.faults.impact_transfer import FreeStructure, ImpactResponse, impact_response
from tribodyn.study.faults.loose_seat import LooseSeat
from tribodyn.study.faults.sensors import SensorPlace
from tribodyn.study.faults.turning import (
    SAMPLES,
    PeriodicMotion,
    SensedLines,
    even_samples,
    joined,
    positive,
    signal_lines,
)
from tribodyn.study.machine.motion import mesh_rotation
from tribodyn.study.planetary.common import only_stage
from tribodyn.study.planetary.stage_result import planetary_angles
from tribodyn.types import Array, ComplexArray, Index

if TYPE_CHECKING:
    from tribodyn.dynamics import System
    from tribodyn.machine import Machine, MachineStructure
    from tribodyn.study.machine.motion import MachineMotion
    from tribodyn.study.machine.result import LoadResult


#: Samples of a turn of a carrier for the weights of its planets at the ring, and part of the
#: strongest line below which lines are left out.
_PASSING, _LEAST = 1024, 1e-10


class RingPlace(NamedTuple):
    """Where a sensor is on a ring, and how it feels a passing planet."""

    angle: float = 0.0  #: from y towards z [rad]
    window: float | Callable[[Array], Array] | None = None  #: as of ``ring_sensor_signal``


@dataclass(frozen=True, eq=False)
class MachineTurningMotion(PeriodicMotion):
    """Motion of a machine with faults, and what its sensors receive."""

    sound: LoadResult  #: with equal teeth under the same load
    structure: MachineStructure  #: with the force laws of all teeth over the turns
    motion: MachineMotion
    ring: RingPlace
    seats: dict[str, LooseSeat]

    @property
    def machine(self) -> Machine:
        """The machine with the force laws over the turns."""
        return self.structure.machine

    def _linear(self, place: SensorPlace) -> SensedLines:
        if place.quantity == "passing_force":
            return self._passing_lines(place)
        clocked = self.motion.phase_turns is None
        return self._of_clock(place) if clocked else self._of_phases(place)

    def _of_clock(self, place: SensorPlace) -> SensedLines:
        """Lines of the samples of a motion on one clock."""
        motion = self.motion
        if place.quantity == "force":
            values = motion.bearing_force[:, motion.bearing.index(place.part), :3] @ place.direction
        elif place.quantity == "acceleration":
            values = motion.acceleration[:, motion.node.index(place.part)] @ place.direction
        else:
            values = getattr(motion, place.quantity)[:, motion.mesh.index(place.part)]
        even = even_samples(motion.clock, SAMPLES * self.cycles)(values)
        frequency, lines = signal_lines(even, self.period)
        return SensedLines(frequency, lines, np.arange(lines.size)[:, None])

    def _of_phases(self, place: SensorPlace) -> SensedLines:
        """Lines that the positions and forces of a motion over phases give linearly."""
        structure = self.structure
        if place.quantity == "mesh_force":
            lines = Lines(*self._lines("contact_force"))
            amplitude = lines.amplitude[:, self._contacts_of(place.part)].sum(axis=1)
            return SensedLines(lines.frequency, amplitude, lines.numbers)
        lines = Lines(*self._lines("position"))
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
        seat = self.seats[place.part]
        position, contact = (Lines(*self._lines(name)) for name in ("position", "contact_force"))
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
        names = self.machine.planets[place.part].mesh_names(place.part)["ring"]
        forces = [self._linear(SensorPlace("mesh_force", name, "N")) for name in names]
        frequency, weight, numbers = self._weights(place.part)
        parts = []
        for planet, force in enumerate(forces):
            turned = np.tile(numbers, (len(force.frequency), 1))
            turned[:, :-1] += np.repeat(force.numbers, len(frequency), axis=0)
            moved = np.add.outer(force.frequency, frequency).reshape(-1)
            lines = np.multiply.outer(force.amplitude, weight[:, planet]).reshape(-1)
            parts.append(positive(moved, lines, turned))
        return joined(*parts)

    def _weights(self, stage: str) -> tuple[Array, ComplexArray, Index]:
        """Lines (k,) of the weights of the planets (k, N) that pass a place of the ring."""
        machine, parts = self.machine, self.machine.planets[stage]
        flow, ring = machine.kinematics.shafts, machine.gears[parts.ring]
        turn = float(np.sign(flow[parts.carrier].speed - flow[ring.shaft].speed))
        mesh = self.motion.mesh.index(parts.mesh_names(stage)["ring"][0])
        rate = float(self.motion.mesh_frequency[mesh]) / abs(ring.teeth)
        at = turn * np.arange(_PASSING) / _PASSING
        weights = np.fft.fft(passing_weights(planetary_angles(parts), at, *self.ring), axis=0)
        weights /= _PASSING
        lines = []
        for place in np.flatnonzero(np.abs(weights).max(axis=1) > _LEAST * np.abs(weights).max()):
            count = int(place) - _PASSING * (2 * int(place) >= _PASSING)
            wave, numbers = self._rotated(count * rate)
            turned = np.concatenate([numbers, np.full((len(numbers), 1), count)], axis=1)
            frequency = numbers @ self.frequencies + rate * count
            lines.append((frequency, np.multiply.outer(wave, weights[place]), turned))
        frequency, weight, turned = (np.concatenate(part) for part in zip(*lines, strict=True))
        return frequency, weight, turned

    def _rotated(self, rate: float) -> tuple[ComplexArray, Index]:
        """Lines of ``exp(2 pi i rate lead)`` of a rotation that is ahead, and their numbers."""
        wave, numbers = np.ones(1, complex), np.zeros((1, len(self.frequencies)), dtype=np.int64)
        for cycles, series in self.ahead.parts if self.ahead is not None else ():
            points = np.arange(_PASSING) / _PASSING
            lines = np.fft.fft(np.exp(2j * np.pi * rate * (series(points) - series(0.0))))
            strong = np.flatnonzero(np.abs(lines) > _LEAST * np.abs(lines).max())
            count = strong - _PASSING * (2 * strong >= _PASSING)
            wave = np.multiply.outer(wave, lines[strong] / _PASSING).reshape(-1)
            turned = np.multiply.outer(count, cycles)
            numbers = (numbers[:, None] + turned).reshape(-1, numbers.shape[1])
        return wave, numbers

    def sensed_from(self, tacho: str | None, angle: float, window: Any) -> MachineTurningMotion:
        """The motion with its tacho on another shaft, and its sensor at an angle of the ring."""
        if only_stage(self.machine) is None:
            return PeriodicMotion.sensed_from(self, tacho, angle, window)  # type: ignore[no-any-return]
        place = RingPlace(angle, window)
        return replace(self, ring=place, tacho=self.tacho if tacho is None else tacho)

    @cached_property
    def free_structure(self) -> FreeStructure:
        """The machine with closed meshes, through which impacts of bearings reach the sensors."""
        return FreeStructure(on_mesh_cycles(self.sound.system))

    def impacts(
        self, sensor: str, defect: tuple[str, BearingImpacts], time: Array, seed: int
    ) -> Array:
        """What a sensor receives of the defect of a bearing, which is named, in its unit."""
        bearing, impacts = defect
        assert isinstance(impacts, BearingForce)
        rate, half_sine = 1.0 / float(time[1] - time[0]), (impacts.force, impacts.duration)
        key = sensor, bearing, rate, half_sine
        if key not in self.splines:
            place = self.places.place(sensor)
            self.splines[key] = impact_response(self, bearing, place, half_sine, rate)
        shaft = self.rotation_frequency(self.machine.bearings[bearing].shaft)
        response: ImpactResponse = self.splines[key]
        return impacts.superposed(response.at, response.duration, shaft, time, seed)

    def __repr__(self) -> str:
        """One line."""
        turns = ", ".join(f"{shaft} {turns}" for shaft, turns in self.turns.items())
        return f"MachineTurningMotion({self.period:.5g} s, turns of the shafts: {turns})"


def on_mesh_cycles(system: System) -> System:
    """The system for means over mesh cycles, which contacts over phases have too."""
    if not system.phases:
        return system
    clock: dict[str, Any] = {"cycles": 1, "offset": 0.0, "turning_error": (), "turning_cycles": ()}
    return replace(system, contacts=[replace(each, **clock) for each in system.contacts])
