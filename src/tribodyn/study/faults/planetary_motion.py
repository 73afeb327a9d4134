"""Motion of a planetary stage with faults, and what a sensor on its ring receives."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from tribodyn.dynamics.equations.clock import on_clock
from tribodyn.dynamics.equations.system import CONTACT_ENTRIES, FRICTION_ENTRIES
from tribodyn.interrupt import single_blas_thread
from tribodyn.machine.planetary.ring_sensor import passing_weights
from tribodyn.study.faults.driven_shafts import drive_stage
from tribodyn.study.faults.section import part_of
from tribodyn.study.faults.sensors import SensorPlace, stage_sensors
from tribodyn.study.faults.turning import (
    SAMPLES,
    Accuracy,
    PeriodicMotion,
    even_samples,
    refuse_long_period,
    repeated,
    steady_over_turns,
)
from tribodyn.study.machine.first_look import warn_of_orders
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.dynamics import System
    from tribodyn.study.planetary.case import PlanetaryCase
    from tribodyn.study.planetary.motion import PlanetaryMotion
    from tribodyn.study.planetary.result import PlanetaryLoadResult

_ACCURACY = Accuracy((200,), 1e-3)
#: Most mesh cycles of a motion, and of a signal of the ring.
_MOST, _MOST_OF_RING = 2000, 20_000
_SHORTER = "Give faults of one gear only, and orders that repeat after few turns"


class RingSensor(NamedTuple):
    """Where a sensor is on the ring, and how it feels a passing planet."""

    angle: float  #: [rad]
    window: float | Callable[[Array], Array] | None  #: as of ``ring_sensor_signal``


@dataclass(frozen=True, eq=False)
class PlanetaryTurningMotion(PeriodicMotion):
    """Motion of a stage over whole turns of its gears, and what its sensors receive."""

    case: PlanetaryCase
    sound: PlanetaryLoadResult
    motion: PlanetaryMotion  #: over the mesh cycles after which the teeth repeat
    repeat: int  #: these mesh cycles
    sensor: RingSensor

    def series(self, place: SensorPlace) -> Array:
        """Force of a mesh, or those of all planets that pass the ring."""
        count, motion = SAMPLES * self.repeat, self.motion
        if place.part == "ring":
            columns = motion.ring_mesh_force
        else:
            number = int(place.part.removeprefix("planet_"))
            columns = getattr(motion, place.quantity)[:, number - 1 : number]
        clock = motion.phase / self.repeat
        even = np.tile(even_samples(clock, count)(columns), (self.cycles // self.repeat, 1))
        if place.part == "ring":
            even = even * self._weights(len(even))
        return np.asarray(even.sum(axis=1))

    def sensed_from(self, tacho: str | None, angle: float, window: Any) -> PlanetaryTurningMotion:
        """The motion with its sensor at an angle of the ring, and its tacho on another member."""
        place = RingSensor(angle, window)
        return replace(self, sensor=place, tacho=self.tacho if tacho is None else tacho)

    def _weights(self, count: int) -> Array:
        """Weight of each planet at the sensor on the samples (count, N)."""
        stage, load = self.sound.kinematics, self.sound
        turn = 1.0 if stage.torques["sun"] > 0.0 else -1.0
        at = np.arange(count) / SAMPLES
        ring = abs(self.case.gears[self.case.table.ring].teeth)
        turns = (at + self.lead(at / self.repeat % 1.0)) / ring
        carrier = -np.sign(stage.relative_speeds["ring"]) * turns  # relative to the ring
        return passing_weights(turn * load.phases.angles, carrier, *self.sensor)

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
    frequency, passing = sound.kinematics.mesh_frequency, math.lcm(cycles, ring)
    for count, most in ((cycles, _MOST), (passing, _MOST_OF_RING)):
        refuse_long_period(count, count / frequency, most, _SHORTER)
    motion = sound.motion
    if driven.lead.lines.any():
        warn_of_orders(cycles, cycles / frequency)
    if case.faults:
        start = repeated(sound.response, frequency, frequency / cycles)
        with single_blas_thread():
            response = steady_over_turns(driven, frequency / cycles, _ACCURACY, start)
        motion = planetary_motion(response, sound.data, case.turn(sound.load))
        motion = replace(motion, phase=motion.phase * cycles, mesh_frequency=frequency)
    stage, period = sound.kinematics, passing / frequency
    speeds = {name: stage.speeds[role] for role, name in case.members.items()}
    speeds[case.table.planet] = stage.relative_speeds["planet"]  # about its pin
    return PlanetaryTurningMotion(
        cycles=passing,  # until the planets pass the sensor with the same teeth again
        mesh_frequency=frequency,
        places=stage_sensors(case),
        turns={name: abs(speed) / (2.0 * math.pi) * period for name, speed in speeds.items()},
        tacho=case.ends[0],
        lead=driven.lead,
        case=case,
        sound=sound,
        motion=motion,
        repeat=cycles,
        sensor=RingSensor(0.0, None),
    )
