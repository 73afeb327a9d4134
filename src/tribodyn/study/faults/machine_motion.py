"""Motion of a machine with faults over whole turns of the shafts that have them."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.dynamics import harmonic_balance
from tribodyn.errors import InputError, collected, warn
from tribodyn.faults import BearingForce, BearingImpacts, Fault, Waviness
from tribodyn.interrupt import single_blas_thread
from tribodyn.progress import SILENT, Progress
from tribodyn.study.faults.clock import MOST_CYCLES
from tribodyn.study.faults.driven_shafts import drive_machine
from tribodyn.study.faults.impact_transfer import FreeStructure, ImpactResponse, impact_response
from tribodyn.study.faults.loose_seat import (
    loose_seats,
    with_lifted_forces,
    with_loose_seats,
)
from tribodyn.study.faults.machine_section import faults_of_mesh
from tribodyn.study.faults.motion import SAMPLES, even_samples, signal_lines, turning_system_of
from tribodyn.study.faults.sensors import MachineSensors, SensorPlace, seat_accelerance
from tribodyn.study.machine.first_look import warn_of_orders, warn_of_period
from tribodyn.types import Array, ComplexArray

if TYPE_CHECKING:
    from tribodyn.dynamics import Response
    from tribodyn.machine import Machine, MachineStructure
    from tribodyn.study.machine.case import MachineCase
    from tribodyn.study.machine.motion import MachineMotion
    from tribodyn.study.machine.result import LoadResult

#: Steps of a cycle of the fastest mesh, tried in turn.
_STEPS = (128, 256)
#: Change of the motion with half the steps, over its size, that is small enough.
_ACCURATE = 2e-3
#: Certified error that suffices beside it.
_CERTIFIED = 1e-4


@dataclass(frozen=True, eq=False)
class MachineTurningMotion:
    """Motion of a machine over whole turns of its shafts, and what its sensors receive."""

    sound: LoadResult  #: with equal teeth under the same load
    structure: MachineStructure  #: with the force laws of all teeth over the turns
    motion: MachineMotion
    seat: Callable[[Array], ComplexArray] | None  #: accelerance of a seat [1/kg] over [Hz]
    tacho: str  #: shaft with the tacho
    #: Cycles of the fastest mesh by which the rotation is ahead of its mean, over the period.
    lead: Callable[[Array], Array]

    @cached_property
    def splines(self) -> dict[Any, Any]:
        """Signals as smooth functions, by sensor and sampling rate; filled where they are used."""
        return {}

    @property
    def machine(self) -> Machine:
        """The machine with the force laws over the turns."""
        return self.structure.machine

    @property
    def period(self) -> float:
        """Time after which all repeats [s]."""
        return 1.0 / self.motion.frequency

    @property
    def cycles(self) -> int:
        """Cycles of the fastest mesh in the period."""
        return int(self.motion.cycles.max())

    @property
    def mesh_frequency(self) -> float:
        """Cycles of the fastest mesh per second [Hz]."""
        return self.cycles * self.motion.frequency

    def rotation_frequency(self, shaft: str) -> float:
        """Turns of a shaft per second [Hz]."""
        MachineSensors(self.machine, self.seat).check_tacho(shaft)
        clock = self.machine.clock
        return float(clock.turns[shaft]) * clock.frequency

    @property
    def sensors(self) -> tuple[str, ...]:
        """Signals of :meth:`signal`; an angle from y towards z may stand for x, y or z."""
        return MachineSensors(self.machine, self.seat).names

    def signal(self, sensor: str) -> tuple[Array, str]:
        """Acceleration, force or transmission error on even samples of a period, with its unit."""
        place = read_sensor(self, sensor)
        motion = self.motion
        if place.quantity == "force":
            values = motion.bearing_force[:, motion.bearing.index(place.part), :3] @ place.direction
        elif place.quantity == "acceleration":
            values = motion.acceleration[:, motion.node.index(place.part)] @ place.direction
        else:
            values = getattr(motion, place.quantity)[:, motion.mesh.index(place.part)]
        count = SAMPLES * self.cycles
        even = even_samples(motion.clock, count)(values)
        if place.seat is not None:
            lines = np.fft.rfft(even)
            lines *= place.seat(np.arange(lines.size, dtype=float) * motion.frequency)
            even = np.fft.irfft(lines, count)
        return np.asarray(even), place.unit

    @cached_property
    def free_structure(self) -> FreeStructure:
        """The machine with closed meshes, through which impacts of bearings reach the sensors."""
        return FreeStructure(self.sound.system)

    def impacts(
        self, sensor: str, defect: tuple[str, BearingImpacts], time: Array, seed: int
    ) -> Array:
        """What a sensor receives of the defect of a bearing, which is named, in its unit."""
        bearing, impacts = defect
        assert isinstance(impacts, BearingForce)
        rate, half_sine = 1.0 / float(time[1] - time[0]), (impacts.force, impacts.duration)
        key = sensor, bearing, rate, half_sine
        if key not in self.splines:
            place = read_sensor(self, sensor)
            self.splines[key] = impact_response(self, bearing, place, half_sine, rate)
        shaft = self.rotation_frequency(self.machine.bearings[bearing].shaft)
        response: ImpactResponse = self.splines[key]
        return impacts.superposed(response.at, response.duration, shaft, time, seed)

    def harmonics(self, sensor: str) -> tuple[Array, ComplexArray]:
        """Frequencies (k,) [Hz] and complex peak amplitudes (k,) of a signal, from its mean on."""
        return signal_lines(self.signal(sensor)[0], self.period)

    def __repr__(self) -> str:
        """One line."""
        clock = self.machine.clock
        periods = round(clock.frequency / self.motion.frequency)
        turns = ", ".join(f"{shaft} {periods * turns}" for shaft, turns in clock.turns.items())
        return f"MachineTurningMotion({self.period:.5g} s, turns of the shafts: {turns})"


def read_sensor(motion: MachineTurningMotion, sensor: str) -> SensorPlace:
    """Place of a sensor by its name."""
    return MachineSensors(motion.machine, motion.seat).place(sensor)


def turning_machine(case: MachineCase, sound: LoadResult) -> Machine:
    """The machine whose meshes with differing teeth have a force law over whole turns."""
    machine = sound.machine
    changed = {}
    for name in machine.meshes:
        faults = faults_of_mesh(case, machine, name)
        fields = _mesh_over_turns(case, sound, name, faults)
        if fields:
            entries = {"stiffness": machine.meshes[name].stiffness, **fields}
            changed[name] = case.machine(sound.load, **{name: entries}).meshes[name]
    return replace(machine, meshes={**machine.meshes, **changed})


def _mesh_over_turns(
    case: MachineCase, sound: LoadResult, name: str, faults: list[Fault]
) -> dict[str, Any]:
    """Fields of a mesh with faults; empty where all its teeth are equal."""
    from tribodyn.faults import turning_mesh
    from tribodyn.study.pipeline.assembly import damping_of
    from tribodyn.study.pipeline.tooth_contact import loaded_settings

    if name not in sound.tables:
        return _error_over_turns(case, sound.machine, name, faults) if faults else {}
    pair, table = case.pair(name, sound.load, sound.misalignment[name]), sound.tables[name]
    if pair.spur_pair is None or not (faults or pair.spur_pair.teeth_differ):
        return {}
    settings = loaded_settings(pair)
    gears, torque = pair.gear_pair, abs(pair.pinion_torque)
    turning = turning_mesh(gears, torque, faults, **settings)
    equal = not pair.spur_pair.teeth_differ
    if equal and turning.repeats(turning_mesh(gears, torque, **settings)):
        return {}  # faults of no size leave the mesh as it is, at its finer phases
    system = turning_system_of(pair, table, damping_of(pair, table), turning)
    events = turning.functions(table.functions()).event_phases
    laws = {"contacts": system.contacts, "frictions": system.frictions, "events": events}
    return {**laws, "period": turning.cycles}


def _error_over_turns(
    case: MachineCase, machine: Machine, name: str, faults: list[Fault]
) -> dict[str, Any]:
    """Error of a mesh with a constant stiffness, whose teeth all share a wave."""
    sound = machine.meshes[name].error
    names = dict(zip(("pinion", "wheel"), case._pinion_and_wheel(name), strict=True))
    teeth = {role: abs(machine.gears[gear].teeth) for role, gear in names.items()}
    waves = [fault for fault in faults if isinstance(fault, Waviness)]
    period = math.lcm(*(teeth[wave.gear] for wave in waves))

    def error(phase: Array) -> Array:
        cycles = np.asarray(phase, dtype=float) * period
        total = sound(cycles % 1.0) if callable(sound) else np.full(cycles.shape, sound)
        for wave in waves:
            angle = wave.order * 2.0 * np.pi * cycles / teeth[wave.gear] + wave.phase
            total = total - wave.amplitude * np.cos(angle)
        return np.asarray(total)

    return {"error": error, "period": period}


def _refuse_long_period(cycles: int, seconds: float) -> None:
    """Refuse a motion that would need more memory than a notebook has."""
    if cycles > MOST_CYCLES:
        what = f"the machine repeats only after {cycles} mesh cycles, {seconds:.4g} s"
        why = f"At most {MOST_CYCLES} mesh cycles are computed"
        remedy = (
            "Give faults of one gear only, numbers of teeth with common factors, or orders that "
            "repeat after fewer turns"
        )
        raise InputError(what, "faults", why, remedy)


def repeated(response: Response, frequency: float, slower: float) -> Response:
    """A periodic motion over the longer period of a slower clock."""
    count, last = round(frequency / slower), -1
    start = response.time - response.time[0]
    times = [start[:last] + turn / frequency for turn in range(count)]
    position = np.concatenate([*count * [response.position[:last]], response.position[last:]])
    time = np.concatenate([*times, [count / frequency]])
    return replace(response, time=time, position=position, mesh_frequency=slower)


def machine_turning_motion(
    case: MachineCase, sound: LoadResult, progress: Progress = SILENT
) -> MachineTurningMotion:
    """Compute the steady motion over whole turns; with equal teeth it is that of the result."""
    from tribodyn.machine import system as system_of
    from tribodyn.study.machine.motion import machine_motion

    with single_blas_thread():
        progress.start("Teeth over whole turns")
        machine = turning_machine(case, sound)
        tacho, seat = machine.operation.input, seat_accelerance(case)
        of_teeth = all(
            fault.gear or fault.kind == "bearing-defect" for fault in case.faults.values()
        )
        if of_teeth and machine.meshes == sound.machine.meshes:
            same = sound.structure, sound.motion
            return MachineTurningMotion(sound, *same, seat, tacho, np.zeros_like)
        warn_of_period(machine)
        clock = machine.clock
        mesh_frequency = max(clock.cycles.values()) * clock.frequency
        _refuse_long_period(max(clock.cycles.values()), 1.0 / clock.frequency)
        structure = replace(sound.structure, machine=machine)
        seats = loose_seats(case, structure, sound.motion)
        system = with_loose_seats(system_of(structure), seats)
        driven = drive_machine(structure, system, case.faults)
        frequency = mesh_frequency / driven.cycles
        _refuse_long_period(driven.cycles, 1.0 / frequency)
        if frequency < clock.frequency:
            warn_of_orders(driven.cycles, 1.0 / frequency)
        response = repeated(sound.response, sound.motion.frequency, frequency)
        for steps in _STEPS:
            per_period = math.ceil(steps * driven.cycles / driven.system.cycles)
            with collected() as model_warnings:
                response = harmonic_balance(
                    driven.system, frequency, steps=per_period, start=response,
                    tolerance=_CERTIFIED, progress=progress,
                )  # fmt: skip
            if not response.step_error > _ACCURATE:
                break
        for warning in model_warnings:
            warn(warning.code, warning.message)
        motion = with_lifted_forces(machine_motion(structure, response), response, seats)
        periods = round(clock.frequency / frequency)
        motion = replace(motion, cycles=periods * motion.cycles, frequency=frequency)
    return MachineTurningMotion(sound, structure, motion, seat, tacho, driven.lead)
