"""Coordinates of a machine in static balance, and the laws of its meshes and bearings."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, is_dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.arrays.memory import Arrays
from tribodyn.errors import ComputationError, InputError
from tribodyn.gear import Misalignment
from tribodyn.machine.bearing import HELD, Bearing, takes_axial_force
from tribodyn.machine.graph.kinematics import mean_stiffness
from tribodyn.machine.machine import Machine
from tribodyn.machine.mesh import mean_over_phase
from tribodyn.machine.plane_law import mean_in_space
from tribodyn.machine.rolling.element_ring import BearingState
from tribodyn.machine.static.supports import clearance_load, floating_response, seated
from tribodyn.machine.structure import MachineStructure
from tribodyn.types import Array

#: Force and moment of a mesh over the face, and their derivatives (2, 2), of the compression [m]
#: at mid face and its slope over the face [1].
MeshLaw = Callable[[float, float], tuple[float, float, ArrayLike]]
#: Lever that makes moments and rotations comparable with forces and displacements [m].
_LEVER = 0.05


class StaticModel:
    """Coordinates and matrices of a machine, and the laws of its meshes and bearings."""

    def __init__(self, machine: Machine, laws: Mapping[str, MeshLaw]) -> None:
        self.machine, self.laws = machine, laws
        # Beam elements are exact under forces at their ends, however long they are.
        longest = max(shaft.length for shaft in machine.shafts.values()) or 1.0
        springs = {name: _as_spring(bearing) for name, bearing in machine.bearings.items()}
        self.structure = MachineStructure(machine._with(bearings=springs), 0.0, longest)
        self.size = self.structure.size
        parts = self.structure.elements.items()
        matrices = [matrix for name, matrix in parts if not name.startswith("bearings.")]
        self.stiffness = sum(matrices, np.zeros((self.size, self.size)))
        turns = ["_theta_" in name for name in self.structure.names]
        self.scale = np.where(turns, 1.0 / _LEVER, 1.0)
        self.gears = {name: self.structure.gear(name) for name in machine.gears}
        self.bearings = {name: self.structure.bearing(name) for name in machine.bearings}

    def nodes(self, shaft: str) -> Array:
        """Displacement of all nodes of a shaft per coordinate, (nodes, 6, size)."""
        places = self.structure.shafts[shaft].nodes
        return np.array([self.structure.at(shaft, place) for place in places])

    @cached_property
    def meshes(self) -> dict[str, Array]:
        """Compression at mid face and its slope over the face, per coordinate, (2, size)."""
        rows = {}
        for name, mesh in self.machine.meshes.items():
            if mesh.crossing is not None:
                gears = np.vstack([self.gears[gear] for gear in mesh.gears])
                mean = mean_in_space(self.machine, name) @ gears
                rows[name] = np.array([mean, np.zeros(self.size)])
                continue
            direction = self.machine.directions[name]
            first, second = (self.gears[gear] for gear in mesh.gears)
            turn = np.cross([1.0, 0.0, 0.0], direction.normal)
            rows[name] = np.array(
                [
                    direction.direction[:6] @ first + direction.direction[6:] @ second,
                    turn @ (first[3:] - second[3:]),
                ]
            )
        return rows

    def mounting(self, name: str, displacement: Array) -> Misalignment | None:
        """Mounting errors of a mesh on crossed axes by a displacement of all coordinates."""
        mesh = self.machine.meshes[name]
        if mesh.crossing is None:
            return None
        moved = np.array([self.gears[gear] @ displacement for gear in mesh.gears])
        try:
            return mesh.crossing.misalignment(moved)
        except InputError as error:
            what = f"the deflection displaces its gears too far: {error.problems[0].what}"
            why = "The teeth are computed for small displacements of the gears"
            remedy = "Reduce the torque, or stiffen shafts and bearings"
            raise ComputationError(what, f"meshes.{name}", why, remedy) from None

    def law(self, name: str) -> MeshLaw:
        """Law of a mesh: the caller's, or a constant stiffness."""
        if name in self.laws:
            return self.laws[name]
        mesh = self.machine.meshes[name]
        first, second = (self.machine.gears[gear] for gear in mesh.gears)
        stiffness, error = mean_stiffness(mesh, (first, second)), mean_over_phase(mesh.error)

        return _LinearLaw(stiffness, error)

    @property
    def content(self) -> Arrays:
        """What the balance under given forces follows from: arrays, and bearings and laws."""
        laws: list[object] = [self.law(name) for name in self.meshes]
        numbers = [np.ravel(v) for law in laws if is_dataclass(law) for v in vars(law).values()]
        parts: list[object] = [*self.machine.bearings.values(), *map(type, laws)]
        parts += [law for law in laws if not is_dataclass(law)]
        objects = np.empty(len(parts), dtype=object)
        objects[:] = parts
        rows = np.concatenate([*self.meshes.values(), *self.bearings.values()])
        return self.stiffness, self.scale, rows, np.concatenate([[0.0], *numbers]), objects

    def face_width(self, name: str) -> float:
        """Common face width of a mesh."""
        return min(self.machine.gears[gear].face_width for gear in self.machine.meshes[name].gears)

    def bearing(self, name: str, displacement: Array) -> tuple[Array, Array]:
        """Load and stiffness of a bearing."""
        part = self.machine.bearings[name]
        displacement = displacement - np.asarray(part.offset)
        if part.clearance:
            return clearance_load(part, displacement)
        if part.rolling is None:
            matrix = part.stiffness_matrix
            return matrix @ displacement, matrix
        load, matrix = np.zeros(6), np.zeros((6, 6))
        ring, moved = part.rolling, displacement[list(HELD)]
        response = floating_response(ring, moved) if part.floating else ring.response(moved)
        _, load[list(HELD)], matrix[np.ix_(HELD, HELD)] = response
        return load, matrix

    def ring_state(self, name: str, displacement: Array) -> BearingState | None:
        """Loads and pressures of the rolling elements of a bearing; None of a linear one."""
        part = self.machine.bearings[name]
        if part.rolling is None:
            return None
        moved = (displacement - np.asarray(part.offset))[list(HELD)]
        return part.rolling.state(seated(part.rolling, moved) if part.floating else moved)


@dataclass(frozen=True)
class _LinearLaw:
    """Constant stiffness of a mesh."""

    stiffness: float
    error: float

    def __call__(self, compression: float, slope: float) -> tuple[float, float, ArrayLike]:
        """Force, moment about mid face, and their derivatives."""
        stiff = self.stiffness
        return stiff * (compression - self.error), 0.0, ((stiff, 0.0), (0.0, 0.0))


def _as_spring(bearing: Bearing) -> Bearing:
    """Stand-in for a rolling bearing that holds what it can hold under some load."""
    if bearing.rolling is None:
        return replace(bearing, clearance=0.0)
    holds = np.diag([float(takes_axial_force(bearing)), 1.0, 1.0, 1.0, 1.0])
    return replace(bearing, rolling=None, stiffness=holds)
