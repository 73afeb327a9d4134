"""What sensors of a machine receive of its motion with faults, and of an impact in a bearing."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from tribodyn.arrays.linear_algebra import modes_of
from tribodyn.dynamics.harmonic.phase_response import Lines
from tribodyn.dynamics.linear.linear_system import linear_system
from tribodyn.faults import BearingForce, BearingImpacts
from tribodyn.machine.planetary.ring_sensor import passing_weights
from tribodyn.study.faults.driven_shafts import LooseSeat
from tribodyn.study.faults.recording import anti_alias
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
from tribodyn.types import Array, ComplexArray, Index, Tree

if TYPE_CHECKING:
    from tribodyn.dynamics import System
    from tribodyn.machine import Machine, MachineStructure
    from tribodyn.study.machine.motion import MachineMotion
    from tribodyn.study.machine.result import LoadResult

#: Eigenvalues below this share of the largest are those of free motions.
_FREE = 1e-12
#: Size to which a response decays, and its longest duration [s].
_DECAYED, _LONGEST = 1e-3, 4.0
#: Samples of a response for each of the recording, and those before the impact: the filter is not
#: causal.
_OVERSAMPLED, _BEFORE = 16, 64


class FreeStructure:
    """A machine with closed meshes at their mean stiffness, under forces on its coordinates."""

    def __init__(self, system: System) -> None:
        linear = linear_system(system)
        squares, shape = modes_of(linear.stiffness, linear.mass)
        swings = squares > _FREE * squares.max()
        damping = linear.damping + (0.0 if linear.gyroscopic is None else linear.gyroscopic)
        # Free rotations have velocities alone: their positions act on nothing.
        self.shape, self.swings = shape, swings
        self.rate = float(np.sqrt(squares.max()))
        count, size = int(swings.sum()), len(squares)
        state = np.zeros((count + size, count + size))
        state[:count, count:] = self.rate * np.eye(size)[swings]
        state[count:, :count] = -np.diag(squares)[:, swings] / self.rate
        state[count:, count:] = -shape.T @ damping @ shape
        self.values, self.right = np.linalg.eig(state)
        self.left = np.linalg.inv(self.right)

    @property
    def duration(self) -> float:
        """Time after which the slowest vibration has decayed [s]."""
        rates = -self.values.real[np.abs(self.values.imag) > 0.0]
        slowest = float(rates.min(initial=np.inf))
        return min(-math.log(_DECAYED) / slowest, _LONGEST) if slowest > 0.0 else _LONGEST

    def motion(self, frequency: Array, force: Array) -> tuple[ComplexArray, ComplexArray]:
        """Positions, without free rotations, and velocities (k, n) under a unit force (n,)."""
        count = int(self.swings.sum())
        loads = self.left[:, count:] @ (self.shape.T @ force)
        state = (loads / (2j * np.pi * frequency[:, None] - self.values)) @ self.right.T
        position = (state[:, :count] / self.rate) @ self.shape[:, self.swings].T
        return position, state[:, count:] @ self.shape.T


def impact_spectrum(
    motion: MachineTurningMotion, bearing: str, place: SensorPlace, frequency: Array
) -> ComplexArray:
    """Signal of a sensor per newton of a force that presses the rings of a bearing apart (k,)."""
    structure, free = motion.sound.structure, motion.free_structure
    relative = structure.bearing(bearing)
    along = np.zeros(6)
    along[:3] = load_direction(motion, bearing)
    position, velocity = free.motion(frequency, -relative.T @ along)
    omega = 2.0 * np.pi * frequency
    if place.quantity == "acceleration":
        row = place.direction @ structure.housing_node(place.part)[:3]
        return np.asarray(1j * omega * (velocity @ row))
    if place.quantity == "force":
        part = motion.machine.bearings[place.part]
        move = structure.bearing(place.part).T
        springs = (position @ move @ part.stiffness_matrix)[:, :3] @ place.direction
        dampers = (velocity @ move @ part.damping_matrix)[:, :3] @ place.direction
        direct = float(along[:3] @ place.direction) if place.part == bearing else 0.0
        force = springs + dampers + direct
        return np.asarray(force if place.seat is None else force * place.seat(frequency))
    if place.quantity == "mesh_force":
        return np.asarray(position @ structure.mesh(place.part)) * structure.mesh_stiffness(
            place.part
        )
    return np.asarray(position @ mesh_rotation(structure, place.part))


def load_direction(motion: MachineTurningMotion, bearing: str) -> Array:
    """Direction in which the shaft presses on a bearing across its axis; y without a load."""
    sound = motion.sound.motion
    force = sound.mean(sound.bearing_force[:, sound.bearing.index(bearing)])[:3]
    force[0] = 0.0
    size = float(np.linalg.norm(force))
    return np.asarray(force / size) if size > 0.0 else np.array([0.0, 1.0, 0.0])


def pulse(frequency: Array, force: float, duration: float) -> ComplexArray:
    """Spectrum of half a sine of a force [N*s]."""
    turns = frequency * duration
    offset = 1.0 - (2.0 * turns) ** 2
    pole = np.abs(offset) < 1e-9
    size = np.where(pole, 0.25 * np.pi, np.cos(np.pi * turns) / np.where(pole, 1.0, offset))
    return np.asarray(2.0 / np.pi * force * duration * size * np.exp(-1j * np.pi * turns))


class ImpactResponse(NamedTuple):
    """Response of a sensor to an impact, filtered as the recording is."""

    at: Callable[[Array], Array]  #: over the time since a little before the impact [s]
    duration: float  #: [s]


def impact_response(
    motion: MachineTurningMotion,
    bearing: str,
    place: SensorPlace,
    half_sine: tuple[float, float],
    sample_rate: float,
) -> ImpactResponse:
    """Response of a sensor to half a sine of force and duration in a bearing."""
    count = int(2 ** np.ceil(np.log2(motion.free_structure.duration * sample_rate + 4 * _BEFORE)))
    frequency: Array = np.arange(count // 2 + 1, dtype=float) * (sample_rate / count)
    lines = impact_spectrum(motion, bearing, place, frequency) * pulse(frequency, *half_sine)
    lines *= anti_alias(frequency / sample_rate)
    lines *= np.exp(-2j * np.pi * frequency * (_BEFORE / sample_rate))
    dense = _OVERSAMPLED * sample_rate
    values = np.fft.irfft(lines, _OVERSAMPLED * count) * dense
    length: Index = np.arange(values.size)

    def at(since: Array) -> Array:
        return np.interp(since * dense, length, values)

    return ImpactResponse(at, count / sample_rate)


#: Samples of a turn of a carrier for the weights of its planets at the ring, and part of the
#: strongest line below which lines are left out.
_PASSING, _LEAST = 1024, 1e-10


class RingPlace(NamedTuple):
    """Where a sensor is on a ring, and how it feels a passing planet."""

    angle: float = 0.0  #: from y towards z [rad]
    window: float | Callable[[Array], Array] | None = None  #: as of ``ring_sensor_signal``


@dataclass(frozen=True, eq=False, repr=False)
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


def on_mesh_cycles(system: System) -> System:
    """The system for means over mesh cycles, which contacts over phases have too."""
    if not system.phases:
        return system
    clock: Tree = {"cycles": 1, "offset": 0.0, "turning_error": (), "turning_cycles": ()}
    return replace(system, contacts=[replace(each, **clock) for each in system.contacts])
