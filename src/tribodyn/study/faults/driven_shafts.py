"""Torques of shafts and supports of bearings in loose seats, which vary over the motion."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from tribodyn.arrays.linear_algebra import modes_of
from tribodyn.dynamics import Contact, System
from tribodyn.faults.driven import drive_over_phases
from tribodyn.study.faults.section import part_of
from tribodyn.types import Array, Tree

if TYPE_CHECKING:
    from tribodyn.dynamics import Response
    from tribodyn.faults import ShaftExcitation
    from tribodyn.faults.driven import Lead
    from tribodyn.machine import MachineStructure
    from tribodyn.study.machine.case import MachineCase
    from tribodyn.study.machine.motion import MachineMotion

#: Eigenvalues below this share of the largest are those of free motions.
_FREE = 1e-12
#: Share up to which turns of shafts are those of one free motion.
_SAME = 1e-6
#: Mesh phases at which directions of contacts are read.
_PHASES = np.arange(8) / 8.0


def free_motions(system: System) -> Array:
    """Motions of the coordinates in which no spring and no contact is strained (n, k)."""
    stiffness = np.array(system.stiffness, dtype=float)
    size = float(np.abs(stiffness).max()) or 1.0
    for contact in system.contacts:
        along = contact.direction
        rows = np.atleast_2d(along(_PHASES) if callable(along) else np.asarray(along))
        stiffness += size * rows.T @ rows
    squares, shapes = modes_of(stiffness, np.asarray(system.mass))
    return np.asarray(shapes[:, np.abs(squares) < _FREE * squares.max()])


def free_rotation(system: System, torques: Sequence[Array], turned: Sequence[float]) -> Array:
    """Free motion in which shafts with unit torques turn by these angles; zero without one."""
    free = free_motions(system)
    rows = np.asarray(torques) @ free
    shares = np.linalg.lstsq(rows, np.asarray(turned), rcond=_SAME)[0]
    fits = np.allclose(rows @ shares, turned, atol=_SAME * np.abs(turned).max())
    return np.asarray(free @ shares if fits else np.zeros(system.size))


def shaft_torques(structure: MachineStructure) -> dict[str, Array]:
    """Forces on the coordinates per torque on each shaft in its running sense (n,)."""
    machine = structure.machine
    loads, run, torques = machine.kinematics.shafts, machine.operation, {}
    for name, shaft in machine.shafts.items():
        place = shaft.length if name == run.output else 0.0
        torques[name] = np.asarray(np.sign(loads[name].speed) * structure.at(name, place)[3])
    return torques


def drive_machine_over_phases(
    structure: MachineStructure,
    system: System,
    excited: Sequence[tuple[ShaftExcitation, tuple[int, ...]]],
) -> tuple[System, Lead | None]:
    """A machine with excitations of its shafts, each with its cycles over the phases."""
    if not excited:
        return system, None
    torques, rotation = driven_rotation(structure, system, [each for each, _ in excited])
    clock = structure.machine.clock
    driven = [
        (each, cycles, float(clock.turns[each.gear]) * clock.frequency, torques[each.gear])
        for each, cycles in excited
    ]
    return drive_over_phases(system, driven, rotation)


def driven_rotation(
    structure: MachineStructure, system: System, excited: Sequence[ShaftExcitation]
) -> tuple[dict[str, Array], Array]:
    """Forces per torque on each shaft, and the speed of the coordinates if shafts are driven."""
    torques, clock = shaft_torques(structure), structure.machine.clock
    speeds = [2.0 * np.pi * float(clock.turns[shaft]) * clock.frequency for shaft in torques]
    rotation = np.zeros(system.size)
    if excited:
        rotation = free_rotation(system, list(torques.values()), speeds)
    return torques, rotation


#: Distance to the other side of a spring, which acts on one side alone [m].
_FAR = 1e-3


class LooseSeat(NamedTuple):
    """A seat whose radial stiffness is lost in part beyond a displacement of the shaft."""

    direction: Array  #: in which the shaft presses on the seat (3,)
    row: Array  #: displacement of the shaft in this direction per coordinate (n,)
    lost: float  #: stiffness that the lifted seat does not have [N/m]
    lifted: float  #: displacement at which the seat has no force [m]


def loose_seats(
    case: MachineCase, structure: MachineStructure, motion: MachineMotion
) -> dict[str, LooseSeat]:
    """Loose seats by the name of their bearing; ``motion`` is that of the sound machine."""
    seats = {}
    for fault in case.faults.values():
        if fault.kind != "looseness":
            continue
        name = part_of(fault.bearing)
        load = motion.mean(motion.bearing_force[:, motion.bearing.index(name)])[1:3]
        angle = math.atan2(load[1], load[0]) if fault.press_angle is None else fault.press_angle
        along = np.array([0.0, math.cos(angle), math.sin(angle), 0.0, 0.0, 0.0])
        bearing = structure.machine.bearings[name]
        stiffness = float(along @ bearing.stiffness_matrix @ along)
        lost = (1.0 - (fault.stiffness_share or 0.0)) * stiffness
        if lost > 0.0:
            lifted = -float(along @ np.asarray(bearing.rest_load)) / stiffness
            seats[name] = LooseSeat(along[:3], along @ structure.bearing(name), lost, lifted)
    return seats


def with_loose_seats(system: System, seats: dict[str, LooseSeat]) -> System:
    """The system whose seats are softer, with springs that act while they are pressed."""
    stiffness, force = np.array(system.stiffness), np.array(system.force, dtype=float)
    contacts = list(system.contacts)
    clock: Tree = {"cycles": contacts[0].cycles} if system.phases else {}
    for seat in seats.values():
        stiffness -= seat.lost * np.outer(seat.row, seat.row)
        force -= seat.lost * seat.lifted * seat.row
        contacts.append(Contact(seat.row, seat.lost, error=seat.lifted - _FAR, gap=_FAR, **clock))
    return replace(system, stiffness=stiffness, force=force, contacts=contacts) if seats else system


def with_lifted_forces(
    motion: MachineMotion, response: Response, seats: dict[str, LooseSeat]
) -> MachineMotion:
    """Motion whose forces of loose bearings are those of the lifted seats."""
    forces = motion.bearing_force.copy()
    for name, seat in seats.items():
        lift = np.minimum(response.fine.position @ seat.row - seat.lifted, 0.0)
        forces[:, motion.bearing.index(name), :3] -= np.outer(seat.lost * lift, seat.direction)
    return replace(motion, bearing_force=forces)
