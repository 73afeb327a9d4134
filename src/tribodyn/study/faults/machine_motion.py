"""Motion of a machine with faults over whole turns of the shafts that have them."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from tribodyn.errors import InputError
from tribodyn.faults import BearingForce, BearingImpacts, Fault, Waviness
from tribodyn.interrupt import single_blas_thread
from tribodyn.machine.planetary.ring_sensor import passing_weights
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
from tribodyn.study.faults.motion import contacts_over_turns, turning_mesh_of
from tribodyn.study.faults.sensors import MachineSensors, SensorPlace, seat_accelerance
from tribodyn.study.faults.turning import (
    SAMPLES,
    Accuracy,
    PeriodicMotion,
    even_samples,
    refuse_long_period,
    repeated,
    steady_over_turns,
)
from tribodyn.study.machine.first_look import warn_of_orders, warn_of_period
from tribodyn.study.mesh_inputs import mesh_inputs
from tribodyn.study.planetary.common import only_stage
from tribodyn.study.planetary.stage_result import planetary_angles
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.machine import Machine, MachineStructure
    from tribodyn.study.machine.case import MachineCase
    from tribodyn.study.machine.motion import MachineMotion
    from tribodyn.study.machine.result import LoadResult

_ACCURACY = Accuracy((128, 256), 1e-4)
#: Most mesh cycles of a signal of a ring.
_MOST_OF_RING = 20_000
_SHORTER = (
    "Give faults of one gear only, numbers of teeth with common factors, or orders that repeat "
    "after fewer turns"
)


class RingPlace(NamedTuple):
    """Where a sensor is on a ring, and how it feels a passing planet."""

    angle: float = 0.0  #: from y towards z [rad]
    window: float | Callable[[Array], Array] | None = None  #: as of ``ring_sensor_signal``


@dataclass(frozen=True, eq=False)
class MachineTurningMotion(PeriodicMotion):
    """Motion of a machine over whole turns of its shafts, and what its sensors receive."""

    sound: LoadResult  #: with equal teeth under the same load
    structure: MachineStructure  #: with the force laws of all teeth over the turns
    motion: MachineMotion
    ring: RingPlace

    @property
    def machine(self) -> Machine:
        """The machine with the force laws over the turns."""
        return self.structure.machine

    def series(self, place: SensorPlace) -> Array:
        """Acceleration, force or transmission error."""
        motion = self.motion
        if place.quantity == "force":
            values = motion.bearing_force[:, motion.bearing.index(place.part), :3] @ place.direction
        elif place.quantity == "acceleration":
            values = motion.acceleration[:, motion.node.index(place.part)] @ place.direction
        elif place.quantity == "passing_force":
            names = self.machine.planets[place.part].mesh_names(place.part)["ring"]
            values = motion.mesh_force[:, [motion.mesh.index(name) for name in names]]
        else:
            values = getattr(motion, place.quantity)[:, motion.mesh.index(place.part)]
        fastest = int(motion.cycles.max())
        even = even_samples(motion.clock, SAMPLES * fastest)(values)
        even = np.tile(even, (self.cycles // fastest, *[1] * (even.ndim - 1)))
        if place.quantity == "passing_force":
            even = (even * self._passing(place.part, fastest, len(even))).sum(axis=1)
        return np.asarray(even)

    def _passing(self, stage: str, fastest: int, count: int) -> Array:
        """Weight of each planet at the sensor on the ring, on even samples (count, N)."""
        machine, parts = self.machine, self.machine.planets[stage]
        flow, ring = machine.kinematics.shafts, machine.gears[parts.ring]
        mesh = self.motion.mesh.index(parts.mesh_names(stage)["ring"][0])
        share = float(self.motion.cycles[mesh]) / fastest
        at = np.arange(count) / SAMPLES
        turns = share * (at + self.lead(at / fastest % 1.0)) / abs(ring.teeth)
        relative = np.sign(flow[parts.carrier].speed - flow[ring.shaft].speed)
        return passing_weights(planetary_angles(parts), relative * turns, *self.ring)

    def sensed_from(self, tacho: str | None, angle: float, window: Any) -> MachineTurningMotion:
        """The motion with its tacho on another shaft, and its sensor at an angle of the ring."""
        if only_stage(self.machine) is None:
            return PeriodicMotion.sensed_from(self, tacho, angle, window)  # type: ignore[no-any-return]
        place = RingPlace(angle, window)
        return replace(self, ring=place, tacho=self.tacho if tacho is None else tacho)

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
            place = self.places.place(sensor)
            self.splines[key] = impact_response(self, bearing, place, half_sine, rate)
        shaft = self.rotation_frequency(self.machine.bearings[bearing].shaft)
        response: ImpactResponse = self.splines[key]
        return impacts.superposed(response.at, response.duration, shaft, time, seed)

    def __repr__(self) -> str:
        """One line."""
        turns = ", ".join(f"{shaft} {turns}" for shaft, turns in self.turns.items())
        return f"MachineTurningMotion({self.period:.5g} s, turns of the shafts: {turns})"


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
    return machine._with(meshes=changed)


def _mesh_over_turns(
    case: MachineCase, sound: LoadResult, name: str, faults: list[Fault]
) -> dict[str, Any]:
    """Fields of a mesh with faults; empty where all its teeth are equal."""
    from tribodyn.study.pipeline.assembly import mesh_contacts, mesh_damping
    from tribodyn.study.pipeline.tooth_contact import load_friction_of

    if name not in sound.tables:
        return _error_over_turns(case, sound.machine, name, faults) if faults else {}
    pair, table = case.pair(name, sound.load, sound.misalignment[name]), sound.tables[name]
    differ = pair.spur_pair is not None and pair.spur_pair.teeth_differ
    if not (faults or differ):
        return {}
    turning = turning_mesh_of(pair, table, faults)
    if not differ and turning.error is None and turning.repeats(turning_mesh_of(pair, table, [])):
        return {}  # faults of no size leave the mesh as it is, at its finer phases
    inputs, functions = mesh_inputs(pair), turning.functions(table.functions())
    names, sound_teeth = mesh_contacts(inputs, functions, mesh_damping(inputs, table), "stiffness")
    friction = load_friction_of(inputs, table)
    contacts, frictions = contacts_over_turns(names, sound_teeth, turning, friction)
    laws = {"contacts": contacts, "frictions": frictions, "events": functions.event_phases}
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
        return np.asarray(total + sum(wave._gap_after(cycles / teeth[wave.gear]) for wave in waves))

    return {"error": error, "period": period}


def machine_turning_motion(
    case: MachineCase, sound: LoadResult, progress: Progress = SILENT
) -> MachineTurningMotion:
    """Compute the steady motion over whole turns; with equal teeth it is that of the result."""
    if sound.motion.phase_turns is not None:
        what, why = "the motion has no common period", "A recording repeats the period of a motion"
        remedy = (
            "Use result.operation.response.at(time), or compute the stage by itself or with "
            'solver.phases = "off"'
        )
        raise InputError(what, "solver.phases", why, remedy)
    with single_blas_thread():
        progress.start("Teeth over whole turns")
        machine = turning_machine(case, sound)
        structure, motion, lead = sound.structure, sound.motion, np.zeros_like
        kinds = case.faults.values()
        of_teeth = all(fault.gear or fault.kind == "bearing-defect" for fault in kinds)
        if not of_teeth or machine.meshes != sound.machine.meshes:
            structure = replace(structure, machine=machine)
            motion, lead = _searched(case, sound, structure, progress)
    clock, rounds = structure.machine.clock, _rounds(structure.machine, motion)
    cycles = rounds * int(motion.cycles.max())
    periods = round(rounds * clock.frequency / motion.frequency)
    return MachineTurningMotion(
        cycles=cycles,
        mesh_frequency=cycles * motion.frequency / rounds,
        places=MachineSensors(structure.machine, seat_accelerance(case.motion)),
        turns={shaft: periods * turns for shaft, turns in clock.turns.items()},
        tacho=machine.operation.input,
        lead=lead,
        sound=sound,
        structure=structure,
        motion=motion,
        ring=RingPlace(),
    )


def _rounds(machine: Machine, motion: MachineMotion) -> int:
    """Periods of a motion until the planets of a stage pass the sensor with the same teeth."""
    stage = only_stage(machine)
    if stage is None:
        return 1
    parts = machine.planets[stage]
    teeth = abs(machine.gears[parts.ring].teeth)
    mesh = motion.mesh.index(parts.mesh_names(stage)["ring"][0])
    rounds = teeth // math.gcd(int(motion.cycles[mesh]), teeth)
    cycles = rounds * int(motion.cycles.max())
    seconds = rounds / motion.frequency
    refuse_long_period(cycles, seconds, _MOST_OF_RING, _SHORTER)
    return rounds


def _searched(
    case: MachineCase, sound: LoadResult, structure: MachineStructure, progress: Progress
) -> tuple[MachineMotion, Any]:
    """Motion of a machine with faults, and by how much its rotation is ahead of its mean."""
    from tribodyn.machine import system as system_of
    from tribodyn.study.machine.motion import machine_motion

    warn_of_period(structure.machine)
    clock = structure.machine.clock
    fastest = int(max(clock.cycles.values()))
    refuse_long_period(fastest, 1.0 / clock.frequency, MOST_CYCLES, _SHORTER)
    seats = loose_seats(case, structure, sound.motion)
    system = with_loose_seats(system_of(structure), seats)
    driven = drive_machine(structure, system, case.faults)
    frequency = fastest * clock.frequency / driven.cycles
    refuse_long_period(driven.cycles, 1.0 / frequency, MOST_CYCLES, _SHORTER)
    if frequency < clock.frequency:
        warn_of_orders(driven.cycles, 1.0 / frequency)
    start = repeated(sound.response, sound.motion.frequency, frequency)
    response = steady_over_turns(driven, frequency, _ACCURACY, start, progress)
    motion = with_lifted_forces(machine_motion(structure, response), response, seats)
    periods = round(clock.frequency / frequency)
    return replace(motion, cycles=periods * motion.cycles, frequency=frequency), driven.lead
