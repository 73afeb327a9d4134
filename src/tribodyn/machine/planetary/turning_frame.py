"""Coordinates that turn with a carrier: their inertia, and the centrifugal forces of planets."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from tribodyn.errors import Argument, InputError
from tribodyn.machine.graph.placement import pin_lever
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.machine.machine import Machine
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


def centrifugal_accelerations(machine: Machine) -> dict[str, Array]:
    """Acceleration outwards along y and z of each planet shaft, by its name (2,) [m/s^2]."""
    place, speeds = machine.placement, machine.kinematics.shafts
    accelerations = {}
    for bearing in machine.bearings.values():
        if bearing.carrier is not None:
            between = np.subtract(place.shafts[bearing.shaft], place.shafts[bearing.carrier])
            outward = (between @ place.axes[bearing.carrier])[1:]
            accelerations[bearing.shaft] = speeds[bearing.carrier].speed ** 2 * outward
    return accelerations


def centrifugal_force(structure: MachineStructure) -> Array:
    """Generalized force of the planets of a machine, with the bodies on their shafts (n,)."""
    machine, force = structure.machine, np.zeros(structure.size)
    for shaft, acceleration in centrifugal_accelerations(machine).items():
        body = machine.shafts[shaft]
        force += body.mass * acceleration @ structure.at(shaft, body.mass_position)[1:3]
        for name, gear in machine.gears.items():
            if gear.shaft == shaft:
                mass = machine.gear_bodies[name].mass
                force += mass * acceleration @ structure.gear(name)[1:3]
    return force


def centrifugal_loads(machine: Machine) -> dict[str, float]:
    """Centrifugal force of all gears on each planet shaft, by its name [N]."""
    sizes = {name: float(np.hypot(*a)) for name, a in centrifugal_accelerations(machine).items()}
    masses = dict.fromkeys(sizes, 0.0)
    for name, body in machine.gear_bodies.items():
        if (shaft := machine.gears[name].shaft) in masses:
            masses[shaft] += body.mass
    return {name: size * masses[name] for name, size in sizes.items()}
