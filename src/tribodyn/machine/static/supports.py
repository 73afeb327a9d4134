"""Bearings under the load: clearances, floating rings, and loads too small to hold a shaft."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.dynamics.equations.system import System
from tribodyn.dynamics.harmonic.radial_clearance import RadialClearance
from tribodyn.machine.bearing import HELD, Bearing
from tribodyn.machine.machine import Machine
from tribodyn.machine.rolling.element_ring import RollingElementBearing
from tribodyn.machine.shaft import Shaft
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.machine.structure import MachineStructure


#: Standard gravity [m/s^2].
_GRAVITY = 9.80665
#: Radial stiffness over that under the weight below which a bearing without load is loose.
_LOOSE = 1e-2


def _mass(shaft: Shaft) -> float:
    """Mass of the sections of a shaft and of the body that turns with it [kg]."""
    volume = 0.0
    for section in shaft.sections:
        for (first, last), sign in zip(
            zip(section.diameters(0.0), section.diameters(1.0), strict=True), (1, -1), strict=True
        ):
            area = math.pi / 12.0 * (first**2 + first * last + last**2)
            volume += sign * area * section.length
    return shaft.mass + shaft.material.density * volume


def weight_share(machine: Machine, bearing: str) -> float:
    """Share of a bearing in the weight of its shaft with its gears [N]."""
    shaft = machine.bearings[bearing].shaft
    gears = [n for n, gear in machine.gears.items() if gear.shaft == shaft]
    mass = _mass(machine.shafts[shaft]) + sum(machine.gear_bodies[n].mass for n in gears)
    return _GRAVITY * mass / sum(b.shaft == shaft for b in machine.bearings.values())


def stiffness_under(rolling: RollingElementBearing, force: float) -> Array:
    """Stiffness (6, 6) under a radial force, the mean over its directions along y and z."""
    from scipy.optimize import brentq

    stiffness = np.zeros((6, 6))
    for axis in (1, 2):
        for sign in (1.0, -1.0):
            way = np.zeros(5)
            way[axis] = sign

            def excess(size: float, way: Array = way) -> float:
                return float(rolling.response(size * way)[1] @ way) - force

            far = 1e-6
            while excess(far) < 0.0:
                far *= 2.0
            size = brentq(excess, 0.0, far, xtol=1e-15, rtol=1e-12)
            stiffness[np.ix_(HELD, HELD)] += 0.25 * rolling.response(size * way)[2]
    return stiffness


def least_stiffness(machine: Machine, bearing: str, load: Array) -> tuple[Array, float] | None:
    """Stiffness of a rolling bearing under its share of the weight, and that share [N]."""
    # None of a bearing that carries more, or that is held by its preload.
    rolling = machine.bearings[bearing].rolling
    weight = weight_share(machine, bearing)
    if rolling is None or not weight > 0.0 or float(np.linalg.norm(load[:3])) >= weight:
        return None
    least = stiffness_under(rolling, weight)
    at_rest = rolling.response(np.zeros(5))[2]
    if at_rest[1, 1] + at_rest[2, 2] > _LOOSE * (least[1, 1] + least[2, 2]):
        return None
    return least, weight


#: Reach of the first search for the place without axial force, in diameters of an element.
_REACH = 1e-4


def seated(bearing: RollingElementBearing, displacement: Array) -> Array:
    """Displacement (5,) of the ring after it has slid to where it takes no axial force."""
    from scipy.optimize import brentq

    position = displacement.copy()

    def force(axial: float) -> float:
        position[0] = axial
        return float(bearing.response(position)[1][0])

    first, reach = force(0.0), _REACH * bearing.element_diameter
    # Contacts only press: the axial force rises with the axial displacement.
    while first * force(-float(np.copysign(reach, first))) > 0.0:
        reach *= 2.0
    end = -float(np.copysign(reach, first))
    position[0] = brentq(force, 0.0, end, xtol=1e-18, rtol=1e-14) if first else 0.0
    return position


def floating_response(
    bearing: RollingElementBearing, displacement: Array
) -> tuple[float, Array, Array]:
    """Energy, load (5,) and stiffness (5, 5), as of a response, without axial force."""
    energy, load, stiffness = bearing.response(seated(bearing, displacement))
    if (axial := stiffness[0, 0]) > 0.0:
        stiffness = stiffness - np.outer(stiffness[0], stiffness[0]) / axial
    load[0], stiffness[0], stiffness[:, 0] = 0.0, 0.0, 0.0
    return energy, load, stiffness


#: Radial coordinates of a bearing: y and z.
_RADIAL = slice(1, 3)


def radial_law(bearing: Bearing, directions: ArrayLike | None = None) -> RadialClearance:
    """Law of a bearing with clearance in its radial coordinates."""
    stiffness = float(bearing.stiffness_matrix[1, 1])
    rows = np.eye(2) if directions is None else directions
    return RadialClearance(rows, stiffness, bearing.clearance, np.asarray(bearing.offset)[_RADIAL])


def clearance_load(bearing: Bearing, displacement: Array) -> tuple[Array, Array]:
    """Load and stiffness of a bearing with clearance; the displacement is from its seat."""
    law, matrix = radial_law(bearing), bearing.stiffness_matrix
    matrix[_RADIAL, _RADIAL] = 0.0
    load = matrix @ displacement
    load[_RADIAL] += law.force(displacement[_RADIAL])
    matrix[_RADIAL, _RADIAL] = law.tangent(displacement[_RADIAL])
    return load, matrix


def clearance_supports(structure: MachineStructure) -> dict[str, RadialClearance]:
    """Supports with clearance of a machine that is linear about its working load."""
    return {
        name: radial_law(bearing.unloaded, structure.bearing(name)[_RADIAL])
        for name, bearing in structure.machine.bearings.items()
        if bearing.unloaded is not None
    }


def without_clearance_supports(structure: MachineStructure, system: System) -> System:
    """System without the springs that stand for supports with clearance."""
    stiffness, force = np.array(system.stiffness), np.array(system.force)
    for name in clearance_supports(structure):
        rows, bearing = structure.bearing(name)[_RADIAL], structure.machine.bearings[name]
        stiffness -= rows.T @ bearing.stiffness_matrix[_RADIAL, _RADIAL] @ rows
        force += rows.T @ bearing.rest_load[_RADIAL]
    return replace(system, stiffness=stiffness, force=force)


def linear_load(bearing: Bearing, displacement: Array) -> Array:
    """Force and moment on a bearing about its working load, of displacements (..., 6)."""
    load = displacement @ bearing.stiffness_matrix + bearing.rest_load
    if bearing.unloaded is not None:
        law = radial_law(bearing.unloaded)
        load[..., _RADIAL] = law.force(law.displacement(displacement[..., _RADIAL]))
    return np.asarray(load)
