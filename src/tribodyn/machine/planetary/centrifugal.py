"""Centrifugal forces of planets that a carrier carries around."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.machine.machine import Machine
    from tribodyn.machine.structure import MachineStructure


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
