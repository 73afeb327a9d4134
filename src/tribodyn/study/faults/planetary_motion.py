"""Motion of a planetary stage with faults, and what a sensor on its ring receives."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from tribodyn.dynamics import harmonic_balance
from tribodyn.dynamics.equations.clock import on_clock
from tribodyn.dynamics.equations.system import CONTACT_ENTRIES, FRICTION_ENTRIES
from tribodyn.errors import InputError, collected, warn
from tribodyn.interrupt import single_blas_thread
from tribodyn.machine.planetary.ring_sensor import passing_weights
from tribodyn.study.faults.driven_shafts import drive_stage
from tribodyn.study.faults.machine_motion import repeated
from tribodyn.study.faults.motion import SAMPLES, even_samples, signal_lines
from tribodyn.study.faults.section import part_of
from tribodyn.study.faults.sensors import (
    check_stage_sensor,
    check_stage_tacho,
    seat_accelerance,
    stage_sensors,
)
from tribodyn.study.machine.first_look import warn_of_orders
from tribodyn.types import Array, ComplexArray

if TYPE_CHECKING:
    from tribodyn.dynamics import System
    from tribodyn.faults import BearingImpacts
    from tribodyn.study.planetary.case import PlanetaryCase
    from tribodyn.study.planetary.motion import PlanetaryMotion
    from tribodyn.study.planetary.result import PlanetaryLoadResult

#: Steps of a mesh cycle, samples of which all signals are made, and the certified error.
_STEPS, _CERTIFIED = 200, 1e-3
#: Most mesh cycles of a motion, and of a signal of the ring.
_MOST, _MOST_OF_RING = 2000, 20_000


class RingSensor(NamedTuple):
    """Where a sensor is on the ring, and how it feels a passing planet."""

    angle: float  #: [rad]
    window: float | Callable[[Array], Array] | None  #: as of ``ring_sensor_signal``


@dataclass(frozen=True, eq=False)
class PlanetaryTurningMotion:
    """Motion of a stage over whole turns of its gears, and what its sensors receive."""

    case: PlanetaryCase
    sound: PlanetaryLoadResult
    motion: PlanetaryMotion  #: over the mesh cycles after which the teeth repeat
    repeat: int  #: these mesh cycles
    sensor: RingSensor
    tacho: str  #: member with the tacho
    #: Mesh cycles by which the rotation is ahead of its mean, over the cycles of the motion.
    lead: Callable[[Array], Array]

    @cached_property
    def splines(self) -> dict[Any, Any]:
        """Signals as smooth functions, by sensor and sampling rate; filled where they are used."""
        return {}

    @property
    def cycles(self) -> int:
        """Mesh cycles until the planets pass the sensor with the same teeth again."""
        return math.lcm(self.repeat, self._teeth("ring"))

    @property
    def mesh_frequency(self) -> float:
        """Mesh cycles per second [Hz]."""
        return self.sound.kinematics.mesh_frequency

    @property
    def period(self) -> float:
        """Time after which all repeats [s]."""
        return self.cycles / self.mesh_frequency

    def _teeth(self, role: str) -> int:
        return abs(self.case.gears[getattr(self.case.table, role)].teeth)

    def rotation_frequency(self, shaft: str) -> float:
        """Turns of a member per second, or of a planet about its pin [Hz]."""
        check_stage_tacho(self.case, shaft)
        members = {name: role for role, name in self.case.members.items()}
        planet = self.case.table.planet
        stage = self.sound.kinematics
        speed = stage.relative_speeds["planet"] if shaft == planet else stage.speeds[members[shaft]]
        if speed == 0.0:
            what, why = f"{shaft} stands", "A tacho counts the turns of a member"
            raise InputError(what, "argument tacho", why, "Name another member")
        return abs(speed) / (2.0 * math.pi)

    @property
    def sensors(self) -> tuple[str, ...]:
        """Signals of :meth:`signal`."""
        return stage_sensors(self.case)

    def signal(self, sensor: str) -> tuple[Array, str]:
        """Force or acceleration on even samples of the period, with its unit."""
        check_stage_sensor(self.case, sensor)
        count, motion = SAMPLES * self.repeat, self.motion
        rounds = self.cycles // self.repeat
        if sensor.startswith("planet_"):
            number, _, name = sensor.removeprefix("planet_").partition(".")
            columns = getattr(motion, name)[:, int(number) - 1 : int(number)]
        else:
            columns = motion.ring_mesh_force
        clock = motion.phase / self.repeat
        even = np.tile(even_samples(clock, count)(columns), (rounds, 1))
        if not sensor.startswith("planet_"):
            even = even * self._weights(len(even))
        values = even.sum(axis=1)
        seat = seat_accelerance(self.case)
        if sensor == "ring.acceleration" and seat is not None:
            lines = np.fft.rfft(values)
            lines *= seat(np.arange(lines.size, dtype=float) / self.period)
            return np.fft.irfft(lines, values.size), "m/s^2"
        return np.asarray(values), "N"

    def _weights(self, count: int) -> Array:
        """Weight of each planet at the sensor on the samples (count, N)."""
        stage, load = self.sound.kinematics, self.sound
        turn = 1.0 if stage.torques["sun"] > 0.0 else -1.0
        at = np.arange(count) / SAMPLES
        turns = (at + self.lead(at / self.repeat % 1.0)) / self._teeth("ring")
        carrier = -np.sign(stage.relative_speeds["ring"]) * turns  # relative to the ring
        return passing_weights(turn * load.phases.angles, carrier, *self.sensor)

    def harmonics(self, sensor: str) -> tuple[Array, ComplexArray]:
        """Frequencies (k,) [Hz] and complex peak amplitudes (k,) of a signal, from its mean on."""
        return signal_lines(self.signal(sensor)[0], self.period)

    def impacts(
        self, sensor: str, defect: tuple[str, BearingImpacts], time: Array, seed: int
    ) -> float:
        """Nothing: the bearings of a stage have no geometry."""
        return 0.0

    def __repr__(self) -> str:
        """One line."""
        return (
            f"PlanetaryTurningMotion(teeth repeat after {self.repeat} mesh cycles, the signal of "
            f"the ring after {self.cycles}, {self.period:.5g} s)"
        )


class Wave(NamedTuple):
    """Deviation of one mesh, ``-amplitude cos(order turns + phase)``."""

    amplitude: float  #: [m]
    order: int
    teeth: int
    phase: float  #: [rad]

    def at(self, cycles: Array) -> Array:
        """Gap at mesh cycles since the clock began [m]."""
        angle = self.order * 2.0 * np.pi * cycles / self.teeth + self.phase
        return np.asarray(-self.amplitude * np.cos(angle))


def mesh_waves(case: PlanetaryCase, sound: PlanetaryLoadResult) -> dict[int, list[Wave]]:
    """Waves of each contact of the stage: sun meshes of all planets, then ring meshes."""
    waves: dict[int, list[Wave]] = {}
    table, angles = case.table, sound.phases.angles
    sense = 1.0 if case.sun_drives(sound.load) else -1.0  # of the sun relative to the carrier
    between = sum(pair.gear_pair.operating_pressure_angle for pair in case.pairs.values())
    for fault in case.faults.values():
        if fault.shaft:
            continue
        gear, order = part_of(fault.gear), fault.order or 1
        teeth = abs(case.gears[gear].teeth)
        if gear == table.planet:
            planet = (fault.planet or 1) - 1
            lags = {planet: 0.0}
            if fault.kind == "eccentricity":  # the other flank has no waves of its own
                lags[len(angles) + planet] = -sense * between
        elif gear == table.sun:
            lags = {i: sense * float(angle) for i, angle in enumerate(angles)}
        else:
            lags = {len(angles) + i: -sense * float(angle) for i, angle in enumerate(angles)}
        for contact, lag in lags.items():
            phase = (fault.phase or 0.0) - order * lag
            waves.setdefault(contact, []).append(Wave(fault.amplitude, order, teeth, phase))
    return waves


def with_waves(system: System, waves: dict[int, list[Wave]], cycles: int) -> System:
    """A stage whose clock runs over many mesh cycles, with waves at some of its contacts."""
    contacts = []
    for number, contact in enumerate(system.contacts):
        if number not in waves:
            contacts.append(replace(contact, cycles=cycles))
            continue
        over = on_clock(contact, CONTACT_ENTRIES, cycles, contact.offset)
        contacts.append(replace(over, error=_error(over.error, waves[number], cycles)))
    frictions = [
        on_clock(friction, FRICTION_ENTRIES, cycles, system.contacts[friction.contacts[0]].offset)
        if friction.contacts[0] in waves
        else friction
        for friction in system.frictions
    ]
    return replace(system, contacts=contacts, frictions=frictions)


def _error(sound: Any, waves: list[Wave], cycles: int) -> Callable[[Array], Array]:
    def error(clock: Array) -> Array:
        at = np.asarray(clock, dtype=float) * cycles
        total = sound(clock) if callable(sound) else np.full(at.shape, float(sound))
        return np.asarray(total + sum(wave.at(at) for wave in waves))

    return error


def planetary_turning_motion(
    case: PlanetaryCase, sound: PlanetaryLoadResult
) -> PlanetaryTurningMotion:
    """Compute the steady motion of a stage over whole turns of the gears with faults."""
    from tribodyn.study.planetary.motion import planetary_motion

    waves = mesh_waves(case, sound)
    cycles = math.lcm(*(wave.teeth for each in waves.values() for wave in each))
    driven = drive_stage(case, sound, with_waves(sound.system, waves, cycles), cycles)
    cycles = driven.cycles
    ring = abs(case.gears[case.table.ring].teeth)
    if cycles > _MOST or math.lcm(cycles, ring) > _MOST_OF_RING:
        what = f"the stage repeats only after {math.lcm(cycles, ring)} mesh cycles"
        why = f"At most {_MOST} of the motion and {_MOST_OF_RING} of the ring are computed"
        remedy = "Give faults of one gear only, and orders that repeat after few turns"
        raise InputError(what, "faults", why, remedy)
    motion = sound.motion
    if driven.lead.lines.any():
        warn_of_orders(cycles, cycles / sound.kinematics.mesh_frequency)
    if case.faults:
        frequency, system = sound.kinematics.mesh_frequency, driven.system
        start = repeated(sound.response, frequency, frequency / cycles)
        with single_blas_thread(), collected() as model_warnings:
            response = harmonic_balance(
                system, frequency / cycles, steps=math.ceil(_STEPS * cycles / system.cycles),
                start=start, tolerance=_CERTIFIED,
            )  # fmt: skip
        for warning in model_warnings:
            warn(warning.code, warning.message)
        motion = planetary_motion(response, sound.data, case.turn(sound.load))
        motion = replace(motion, phase=motion.phase * cycles, mesh_frequency=frequency)
    sensor, tacho = RingSensor(0.0, None), case.ends[0]
    return PlanetaryTurningMotion(case, sound, motion, cycles, sensor, tacho, driven.lead)
