"""Motion of a machine with faults: on one clock where all repeats soon, or over phases."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from typing import TYPE_CHECKING

from tribodyn.errors import collected
from tribodyn.faults import Fault, ShaftExcitation, drive
from tribodyn.interrupt import single_blas_thread
from tribodyn.machine.static.supports import clearance_supports, without_clearance_supports
from tribodyn.progress import SILENT, Progress
from tribodyn.study.faults.clock import (
    FaultyTeeth,
    check_motion,
    excitations_of,
    fault_cost,
    phases_with_faults,
    rate_of,
    time_of_teeth,
)
from tribodyn.study.faults.driven_shafts import (
    LooseSeat,
    drive_machine_over_phases,
    driven_rotation,
    loose_seats,
    with_lifted_forces,
    with_loose_seats,
)
from tribodyn.study.faults.machine_signals import MachineTurningMotion, RingPlace
from tribodyn.study.faults.motion import contacts_over_turns, turning_mesh_of
from tribodyn.study.faults.sensors import MachineSensors, seat_accelerance
from tribodyn.study.faults.turning import (
    Accuracy,
    lead_on_clock,
    steady_over_turns,
)
from tribodyn.study.machine.first_look import PhaseCost, over_phases
from tribodyn.study.machine.motion import (
    MachineMotion,
    machine_motion,
    phase_names,
    phase_units,
    unit_of,
)
from tribodyn.study.mesh_inputs import mesh_inputs, named_mesh
from tribodyn.study.pipeline.motion import by_engine
from tribodyn.types import Tree

if TYPE_CHECKING:
    from tribodyn.dynamics import Response, System
    from tribodyn.dynamics.harmonic.phase_grid import Work
    from tribodyn.dynamics.harmonic.radial_clearance import RadialClearance
    from tribodyn.faults.driven import Lead
    from tribodyn.machine import Machine, MachineStructure
    from tribodyn.study.machine.case import MachineCase
    from tribodyn.study.machine.result import LoadResult
    from tribodyn.study.machine.run import Balanced

_ACCURACY = Accuracy((128, 256), 1e-4)


def rehearse_faults(case: MachineCase, state: Balanced) -> list[str]:
    """Costs of the motions; refuse faulty teeth that cannot run, and what takes too much."""
    with collected():
        check_motion(case)  # refuses what takes too much, before teeth are computed
    structure = faulty_structure = state.structure(case)
    teeth = {n: f for n, f in case.faults.items() if f.gear and f.kind != "crack"}  # elements
    if teeth:
        cracked = [f"faults.{name}" for name in case.faults if name not in teeth]
        plain = case.replace(dict.fromkeys(cracked)) if cracked else case
        meshes = turning_machine(plain, state).meshes
        machine = structure.machine._with(meshes=meshes)
        faulty_structure = replace(structure, machine=machine)
    sound = faulty = None
    if over_phases(case.solver, state.machine):
        sound = _work(structure)
    if case.faults:
        faulty = _work(faulty_structure, excitations_of(case))
    return check_motion(case, sound, faulty, _time_of_teeth(case, state))


def _work(structure: MachineStructure, excited: Sequence[ShaftExcitation] = ()) -> Work:
    """What the motion over phases takes, from a trial; cracks are left out."""
    from tribodyn.dynamics.harmonic.phase_balance import work_of
    from tribodyn.dynamics.harmonic.phase_grid import Work

    system, supports, frequency, _ = _system_over_phases(structure, {}, excited)
    return work_of(system, frequency, supports) if system.phases else Work(size=system.size)


def _time_of_teeth(case: MachineCase, state: Balanced) -> float:
    """Seconds of the force laws of teeth that differ."""
    return sum(
        time_of_teeth(
            case.pair(name, state.load, state.misalignment[name]),
            FaultyTeeth.of(case, state.machine, name).others,
        )
        for name in state.tables
    )


def turning_machine(case: MachineCase, sound: LoadResult | Balanced) -> Machine:
    """The machine with force laws of teeth that differ, and waves that turn with their gears."""
    machine = sound.machine
    changed = {}
    for name in machine.meshes:
        faulty = FaultyTeeth.of(case, machine, name)
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
) -> Tree:
    """Fields of a mesh with faults; empty where all its teeth are equal."""
    from tribodyn.study.pipeline.assembly import mesh_contacts, mesh_damping
    from tribodyn.study.pipeline.tooth_contact import load_friction_of

    if name not in sound.tables:
        return {}  # teeth of a constant stiffness do not differ
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


#: A steady motion with faults, and how far the rotation is ahead in it.
_Steady = tuple["Response", MachineMotion, "Lead | None"]


def machine_turning_motion(
    case: MachineCase, sound: LoadResult, progress: Progress = SILENT
) -> MachineTurningMotion:
    """Compute the steady motion with faults; with equal teeth it is that of the result."""
    with single_blas_thread():
        progress.start("Teeth over whole turns")
        over_phases = isinstance(fault_cost(case, sound.machine), PhaseCost)
        structure = replace(sound.structure, machine=turning_machine(case, sound))
        machine, excited = structure.machine, excitations_of(case)
        seats = loose_seats(case, structure, sound.motion)
        if machine.meshes == sound.machine.meshes and not (excited or seats):
            structure, machine = sound.structure, sound.machine
            response, motion, ahead = sound.response, sound.motion, None
        else:
            find = _over_phases if over_phases else _on_clock
            response, motion, ahead = find(case, sound, structure, seats, progress)
            by_engine(case.solver.engine, response)
    clock, cycles, frequency = machine.clock, motion.cycles.max(), motion.mesh_frequency.max()
    periods = Fraction(cycles * clock.frequency / frequency)
    if motion.phase_turns is None:
        periods = Fraction(round(periods))
    over = map(tuple, motion._phases[0].astype(int).tolist())
    rates = {n: float(turns) * clock.frequency for n, turns in clock.turns.items() if turns}
    return MachineTurningMotion(
        cycles=int(cycles),
        mesh_frequency=float(frequency),
        places=MachineSensors(machine, seat_accelerance(case.motion)),
        turns={shaft: periods * turns for shaft, turns in clock.turns.items()},
        tacho=machine.operation.input,
        response=response,
        ahead=ahead,
        meshes=dict(zip(motion.mesh, over, strict=True)),
        units=motion.units or (unit_of(rates, motion.frequency),),
        sound=sound,
        structure=structure,
        motion=motion,
        ring=RingPlace(),
        seats=seats,
    )


def _over_phases(
    case: MachineCase, sound: LoadResult, structure: MachineStructure,
    seats: dict[str, LooseSeat], progress: Progress,
) -> _Steady:  # fmt: skip
    """Motion over phases of the meshes and of what turns with shafts and drives them."""
    from tribodyn.dynamics import clearance_motion, harmonic_balance

    machine, excited = structure.machine, excitations_of(case)
    system, supports, frequency, ahead = _system_over_phases(structure, seats, excited)
    phases, shafts = phases_with_faults(machine, excited), [each.gear for each in excited]
    system = replace(system, phase_names=phase_names(machine, phases, shafts))
    if supports:
        response = clearance_motion(system, supports, frequency)
    else:
        response = harmonic_balance(system, frequency, progress=progress)
    motion = with_lifted_forces(machine_motion(structure, response, phases), response, seats)
    units = phase_units(machine, phases, shafts)
    return response, replace(motion, units=units), ahead


def _system_over_phases(
    structure: MachineStructure, seats: dict[str, LooseSeat], excited: Sequence[ShaftExcitation]
) -> tuple[System, list[RadialClearance], tuple[float, ...], Lead | None]:
    """A driven system over its phases, bearings with a clearance, frequencies, and its lead."""
    from tribodyn.machine import system as system_of

    machine = structure.machine
    phases, supports = phases_with_faults(machine, excited), clearance_supports(structure)
    system = with_loose_seats(system_of(structure, phases=phases), seats)
    if supports:
        system = without_clearance_supports(structure, system)
    driven = [(each, phases.driven[rate_of(machine.clock, each)]) for each in excited]
    system, ahead = drive_machine_over_phases(structure, system, driven)
    return system, [*supports.values()], phases.frequency, ahead


def _on_clock(
    case: MachineCase, sound: LoadResult, structure: MachineStructure,
    seats: dict[str, LooseSeat], progress: Progress,
) -> _Steady:  # fmt: skip
    """Motion on the clock of all that repeats."""
    from tribodyn.machine import system as system_of

    machine, excited = structure.machine, excitations_of(case)
    clock, phases = machine.clock, machine.phases_with(together=True)
    system = with_loose_seats(system_of(structure, phases=phases), seats)
    cycles, period = system.cycles, 1.0 / phases.frequency[0]
    torques, rotation = driven_rotation(structure, system, excited)
    longer = round(clock.frequency * period)
    driven = drive(
        system, cycles, excited, mesh_frequency=cycles / period,
        teeth={n: Fraction(cycles) / (longer * turns) for n, turns in clock.turns.items() if turns},
        coordinates=torques, rotation=rotation * (period / cycles),
    )  # fmt: skip
    frequency = cycles / period / driven.cycles
    response = steady_over_turns(driven, frequency, _ACCURACY, progress)
    motion = with_lifted_forces(machine_motion(structure, response), response, seats)
    longer = round(clock.frequency / frequency)
    motion = replace(motion, cycles=longer * motion.cycles, frequency=frequency)
    return response, motion, lead_on_clock(driven, cycles / period)
