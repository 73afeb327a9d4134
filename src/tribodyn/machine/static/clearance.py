"""Bearings with a radial clearance: load at rest, supports of the motion, and their loads in it."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.dynamics.equations.system import System
from tribodyn.dynamics.harmonic.radial_clearance import RadialClearance
from tribodyn.machine.bearing import Bearing
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.machine.structure import MachineStructure

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
