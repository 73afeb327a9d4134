"""The system of a machine: its matrices, and one contact per mesh."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np

from tribodyn.dynamics.equations.entry import Entry
from tribodyn.dynamics.equations.system import Contact, LoadFriction, System
from tribodyn.errors import InputError
from tribodyn.machine.graph.clock import Phases
from tribodyn.machine.machine import Machine
from tribodyn.machine.mesh import Turn
from tribodyn.machine.plane_law import (
    SPATIAL,
    coordinate_count,
    pair_coordinates,
    projected,
    run_back,
)
from tribodyn.machine.planetary.plane_model import without_free_rotation
from tribodyn.machine.planetary.turning_frame import frame_terms
from tribodyn.machine.reduction import machine_structure
from tribodyn.machine.structure import MachineStructure
from tribodyn.types import Array, Tree


def system(machine: Machine | MachineStructure, *, phases: bool | Phases = False) -> System:
    """Assemble the equations of motion of a machine.

    Parameters
    ----------
    machine : Machine or MachineStructure
        The machine, whose matrices :func:`machine_structure` computes, or its matrices.
    phases : bool or Phases
        Give the contacts their cycles over these phases, or ``machine.phases``, so that
        ``harmonic_balance(system, machine.phases.frequency)`` needs no common period.

    Returns
    -------
    System
        The contacts of the meshes in their order, one for each without computed teeth, with their
        mesh cycles in a period of ``machine.clock``; gyroscopic moments at the speed of the
        operation. The torque of the input is that of the operation, the torque of the output keeps
        the mean speed.

    Raises
    ------
    InputError
        If a mesh has no stiffness.

    Examples
    --------
    >>> from tribodyn.machine import Bearing, Gear, Mesh, Operation, Shaft
    >>> machine = Machine(
    ...     shafts={"input": Shaft(), "output": Shaft()},
    ...     gears={"z1": Gear("input", 0.0, 27, 0.05), "z2": Gear("output", 0.0, 51, 0.05)},
    ...     meshes={"first": Mesh(("z1", "z2"), normal_module=4.5e-3, stiffness=5e8)},
    ...     bearings={"A": Bearing("input", 0.0, radial_stiffness=4e8)},
    ...     operation=Operation("input", "output", speed=100.0, torque=400.0))
    >>> system(machine)
    System(4 coordinates, 1 contact)
    """
    structure = machine_structure(machine) if isinstance(machine, Machine) else machine
    machine = structure.machine
    gyroscopic = structure.gyroscopic()
    over = machine.phases if phases is True else phases or None
    contacts: list[Contact] = []
    frictions: list[LoadFriction] = []
    for name, mesh in machine.meshes.items():
        if mesh.contacts:
            law = _in_space(structure, name, len(contacts), over)
            contacts += law[0]
            frictions += law[1]
        else:
            contacts.append(_contact(structure, name, over))
    equations = System(
        mass=structure.mass,
        damping=structure.damping,
        stiffness=structure.stiffness + frame_terms(structure, machine.operation.speed)[1],
        force=structure.force,
        contacts=contacts,
        frictions=frictions,
        names=structure.names,
        balance=structure.balance,
        gyroscopic=gyroscopic if gyroscopic.any() else None,
    )
    return _without_drift(structure, equations) if structure.frame else equations


def _without_drift(structure: MachineStructure, equations: System) -> System:
    """System without the Coriolis forces of a free rotation, whose mean speed is that of a load."""
    springs = [
        Contact(structure.mesh(name), structure.mesh_stiffness(name))
        for name in structure.machine.meshes
    ]
    plain = without_free_rotation(replace(equations, contacts=springs, frictions=()))
    return replace(equations, gyroscopic=plain.gyroscopic)


def _contact(structure: MachineStructure, name: str, phases: Phases | None) -> Contact:
    mesh = structure.machine.meshes[name]
    return Contact(
        direction=structure.mesh(name),
        stiffness=structure.mesh_stiffness(name) if mesh.stiffness is None else mesh.stiffness,
        damping=_damping(structure, name),
        error=mesh.error,
        gap=mesh.gap,
        friction=None if mesh.friction is None else _friction(structure, name),
        events=mesh.events,
        **_clock(structure.machine, name, phases),
    )


def _clock(machine: Machine, name: str, phases: Phases | None) -> Tree:
    """Periods of a mesh in one of the clock or of each phase, and where its first begins."""
    mesh, cycles = machine.meshes[name], machine.clock.cycles[name]
    common = {"offset": mesh.offset / mesh.period, "period": mesh.period, "name": f"mesh {name}"}
    if phases is None:
        if mesh.turning:
            what, why = "errors turn with a gear", "They have phases of their own"
            remedy = "Use phases=True, or put them into the error of a mesh with a period"
            raise InputError(what, f"meshes.{name}.turning", why, remedy)
        return {"cycles": cycles // mesh.period, **common}
    return {
        "cycles": phases.cycles[name],
        "turning_error": [_turned(turn, mesh.offset) for turn in mesh.turning],
        "turning_cycles": [phases.turns[cycles * turn.waves] for turn in mesh.turning],
        **common,
    }


def _turned(turn: Turn, offset: float) -> Any:
    """Error over a phase that is zero where the clock is, not where tooth 1 comes into contact."""
    start = float(turn.waves) * offset
    return (lambda phase: turn.error((phase + start) % 1.0)) if start else turn.error


def mesh_contacts(structure: MachineStructure, system: System) -> list[tuple[Contact, ...]]:
    """Contacts of each mesh in the system of a machine."""
    counts = [max(len(mesh.contacts), 1) for mesh in structure.machine.meshes.values()]
    ends = np.cumsum([0, *counts]).tolist()
    return [tuple(system.contacts[i:j]) for i, j in pairwise(ends)]


def _in_space(
    structure: MachineStructure, name: str, first: int, phases: Phases | None
) -> tuple[list[Contact], list[LoadFriction]]:
    """Force law of computed teeth over the coordinates; its contacts are numbered from first."""
    machine, mesh = structure.machine, structure.machine.meshes[name]
    drives = machine.kinematics.meshes[name].driver == mesh.gears[0]
    size = coordinate_count(mesh.contacts[0])
    direction, crossing = machine.directions[name], mesh.crossing
    onto = pair_coordinates(direction, size, first_drives=drives, crossing=crossing)
    onto = onto @ np.vstack([structure.gear(gear) for gear in mesh.gears])
    clock = _clock(machine, name, phases)
    parts: tuple[Sequence[Contact], Sequence[LoadFriction]] = mesh.contacts, mesh.frictions
    if crossing is not None and not drives:
        parts = [run_back(each) for each in parts[0]], [run_back(each) for each in parts[1]]
    contacts = [projected(contact, onto, **clock) for contact in parts[0]]
    frictions = [
        projected(friction, onto, contacts=tuple(first + j for j in friction.contacts))
        for friction in parts[1]
    ]
    return contacts, frictions


def _damping(structure: MachineStructure, name: str) -> Entry:
    """Damping of a mesh: as given, or by its ratio for both shafts that turn rigidly."""
    machine, mesh = structure.machine, structure.machine.meshes[name]
    if mesh.damping_ratio is None:
        return mesh.damping
    mobility = 0.0
    for gear, radius in zip(mesh.gears, machine.directions[name].base_radius, strict=True):
        shaft = machine.gears[gear].shaft
        inertia = structure.shafts[shaft].mass[3::6, 3::6].sum()
        inertia += machine.shafts[shaft].moment_of_inertia + sum(
            machine.gear_bodies[other].moment_of_inertia
            for other, part in machine.gears.items()
            if part.shaft == shaft
        )
        mobility += radius**2 / inertia
    return 2.0 * mesh.damping_ratio * float(np.sqrt(structure.mesh_stiffness(name) / mobility))


def _friction(structure: MachineStructure, name: str) -> Any:
    mesh, direction = structure.machine.meshes[name], structure.machine.directions[name]
    functions = mesh.friction
    gears = np.vstack([structure.gear(gear) for gear in mesh.gears])
    if mesh.crossing is not None:
        return _crossed_friction(structure, name, gears)

    def friction(phase: Array) -> Array:
        forces = direction.friction(
            functions.friction_sum(phase),
            functions.friction_moment_pinion(phase),
            functions.friction_moment_wheel(phase),
        )
        return np.asarray(forces @ gears)

    return friction


def _crossed_friction(structure: MachineStructure, name: str, gears: Array) -> Any:
    """Friction of a mesh table in space; a driving wheel turns the driving pinion back in time."""
    machine, mesh = structure.machine, structure.machine.meshes[name]
    entry = getattr(mesh.friction, "friction", None)
    if not callable(entry) or np.shape(entry(np.zeros(1)))[-1] != SPATIAL:
        what, why = "friction has no components in space", "The axes of this mesh cross"
        remedy = "Give the functions of the mesh table of a hypoid pair"
        raise InputError(what, f"meshes.{name}.friction", why, remedy)
    drives = machine.kinematics.meshes[name].driver == mesh.gears[0]
    pair: Tree = {"first_drives": drives, "crossing": mesh.crossing}
    onto = pair_coordinates(machine.directions[name], SPATIAL, **pair) @ gears
    law = Contact(direction=np.ones(SPATIAL), stiffness=0.0, friction=entry)
    return projected(law if drives else run_back(law), onto).friction
