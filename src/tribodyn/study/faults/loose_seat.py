"""Loose seats of bearings: a support that is softer while the shaft lifts from it."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from tribodyn.dynamics import Contact, System
from tribodyn.study.faults.section import part_of
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.dynamics import Response
    from tribodyn.machine import MachineStructure
    from tribodyn.study.machine.case import MachineCase
    from tribodyn.study.machine.motion import MachineMotion

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
    clock: dict[str, Any] = {"cycles": contacts[0].cycles} if system.phases else {}
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
