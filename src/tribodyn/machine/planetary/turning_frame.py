"""Coriolis and centripetal forces in coordinates that turn with a carrier."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from tribodyn.errors import Argument, InputError
from tribodyn.machine.graph.placement import pin_lever
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.machine.structure import MachineStructure

#: A quarter turn about x of displacements and rotations.
_QUARTER = np.zeros((6, 6))
_QUARTER[[2, 5], [1, 4]], _QUARTER[[1, 4], [2, 5]] = 1.0, -1.0


def frame_terms(structure: MachineStructure, speed: float) -> tuple[Array, Array]:
    """Gyroscopic matrix and stiffness (n, n) that the frame of the coordinates adds at a speed."""
    gyroscopic, stiffness = np.zeros((2, structure.size, structure.size))
    turning, machine = 0.0, structure.machine
    if structure.frame is not None:
        carriers = {bearing.carrier for bearing in machine.bearings.values() if bearing.carrier}
        if structure.frame not in carriers:
            why = f"Carriers: {', '.join(sorted(carriers)) or 'none'}"
            what, place = f'"{structure.frame}" carries no planets', Argument("frame")
            raise InputError(what, place, why, "Name the carrier of a stage")
        turning = speed * float(machine.kinematics.shafts[structure.frame].ratio)
    for rows, against_carrier, mass, spin in _bodies(structure, speed) if turning else ():
        quarter = np.kron(np.eye(len(mass) // 6), _QUARTER)
        gyroscopic += 2.0 * turning * rows.T @ mass @ quarter @ rows
        pulled = quarter @ against_carrier
        stiffness -= turning**2 * pulled.T @ mass @ pulled
        stiffness += turning * rows.T @ spin @ quarter @ rows
    return gyroscopic, stiffness


def _bodies(
    structure: MachineStructure, speed: float
) -> Iterator[tuple[Array, Array, Array, Array]]:
    """Displacement, also against a turning carrier, mass and gyroscopic matrix of all bodies."""
    machine = structure.machine
    spins = {n: speed * float(load.ratio) for n, load in machine.kinematics.shafts.items()}
    for name, matrices in structure.shafts.items():
        if matrices.mass.any():
            rows = structure.basis[structure._rows[name]]
            yield rows, rows, matrices.mass, spins[name] * matrices.gyroscopic
    pins = {b.shaft: b for b in machine.bearings.values() if b.carrier is not None}
    for shaft, body, rows in structure._bodies():
        across = body.transverse_moment_of_inertia
        mass = np.diag([*3 * [body.mass], body.moment_of_inertia, across, across])
        spin = np.zeros((6, 6))
        spin[4, 5] = spins[shaft] * body.moment_of_inertia
        pulled = rows
        if (pin := pins.get(shaft)) is not None and pin.carrier is not None:
            # Pulled outwards, planets hold the carrier: what is free to turn turns without force.
            lever = pin_lever(machine.placement, pin)[:, 3:4]
            pulled = rows - lever @ structure.at(pin.carrier, pin.carrier_position)[3:4]
        yield rows, pulled, mass, spin - spin.T
