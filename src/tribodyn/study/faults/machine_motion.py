"""Motion of a machine with faults over whole turns of the shafts that have them."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.faults import Fault, Waviness
from tribodyn.interrupt import single_blas_thread
from tribodyn.progress import SILENT, Progress
from tribodyn.study.faults.clock import (
    MOST_CYCLES,
    FaultyTeeth,
    check_motion,
    fault_cost,
    teeth_of,
)
from tribodyn.study.faults.driven_shafts import drive_machine
from tribodyn.study.faults.loose_seat import (
    loose_seats,
    with_lifted_forces,
    with_loose_seats,
)
from tribodyn.study.faults.machine_signals import MachineTurningMotion, RingPlace
from tribodyn.study.faults.motion import contacts_over_turns, turning_mesh_of
from tribodyn.study.faults.phase_motion import phase_motion
from tribodyn.study.faults.sensors import MachineSensors, seat_accelerance
from tribodyn.study.faults.turning import (
    Accuracy,
    refuse_long_period,
    repeated,
    steady_over_turns,
)
from tribodyn.study.machine.first_look import warn_of_orders
from tribodyn.study.mesh_inputs import mesh_inputs, named_mesh
from tribodyn.study.planetary.common import only_stage
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.machine import Machine, MachineStructure
    from tribodyn.study.machine.case import MachineCase
    from tribodyn.study.machine.motion import MachineMotion
    from tribodyn.study.machine.result import LoadResult
    from tribodyn.study.machine.run import Balanced

_ACCURACY = Accuracy((128, 256), 1e-4)
#: Most mesh cycles of a signal of a ring.
_MOST_OF_RING = 20_000
_SHORTER = (
    'Set solver.phases = "auto", which needs no period unless bearings have a clearance, or give '
    "faults of one gear of the mesh only"
)


def rehearse_faults(case: MachineCase, state: Balanced) -> list[str]:
    """Costs of the motions over phases; refuse faulty teeth that cannot run, and too much."""
    costs = check_motion(case)
    teeth = {n: f for n, f in case.faults.items() if f.gear and f.kind != "crack"}  # elements
    if teeth:
        cracked = [f"faults.{name}" for name in case.faults if name not in teeth]
        plain = case.replace(dict.fromkeys(cracked)) if cracked else case
        turning_machine(plain, state, phases=fault_cost(case, state.machine) is not None)
    return costs


def turning_machine(
    case: MachineCase, sound: LoadResult | Balanced, *, phases: bool = False
) -> Machine:
    """The machine with force laws over whole turns; over phases, waves turn with their gears."""
    machine = sound.machine
    changed = {}
    for name in machine.meshes:
        faulty = FaultyTeeth.of(case, machine, name, phases=phases)
        with named_mesh(name):
            fields = _mesh_over_turns(case, sound, name, faulty.others)
        mesh = machine.meshes[name]
        if fields:
            entries = {"stiffness": mesh.stiffness, **fields}
            mesh = case.machine(sound.load, **{name: entries}).meshes[name]
        if fields or faulty.turns:
            changed[name] = replace(mesh, turning=tuple(faulty.turns))
    return machine._with(meshes=changed)


def _mesh_over_turns(
    case: MachineCase, sound: LoadResult | Balanced, name: str, faults: list[Fault]
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
    teeth = teeth_of(case, machine, name)
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
    with single_blas_thread():
        progress.start("Teeth over whole turns")
        over_phases = fault_cost(case, sound.machine) is not None
        machine = turning_machine(case, sound, phases=over_phases)
        if over_phases:
            return phase_motion(case, sound, replace(sound.structure, machine=machine), progress)
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
