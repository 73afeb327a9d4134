"""Coordinates of a machine in static balance, and the laws of its meshes and bearings."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.machine.bearing import HELD
from tribodyn.machine.graph.kinematics import mean_of, mean_stiffness
from tribodyn.machine.machine import Machine
from tribodyn.machine.shaft_matrices import ShaftMatrices
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
        places: dict[str, list[float]] = {name: [] for name in machine.shafts}
        for gear in machine.gears.values():
            places[gear.shaft].append(gear.node_position)
        for bearing in machine.bearings.values():
            places[bearing.shaft].append(bearing.position)
        self.shafts = {
            name: ShaftMatrices(shaft, tuple(places[name]), shaft.length or None)
            for name, shaft in machine.shafts.items()
        }
        ends = np.cumsum([0, *(shaft.size for shaft in self.shafts.values())]).tolist()
        self.slices = {
            name: slice(*pair) for name, pair in zip(self.shafts, pairwise(ends), strict=True)
        }
        housing = machine.housing
        self.size = ends[-1] + (housing.size if housing else 0)
        self.housing = slice(ends[-1], self.size)
        self.stiffness = np.zeros((self.size, self.size))
        for name, shaft in self.shafts.items():
            self.stiffness[self.slices[name], self.slices[name]] = shaft.stiffness
        if housing:
            self.stiffness[self.housing, self.housing] = housing.stiffness
        self.scale = np.ones(self.size)
        for part in self.slices.values():
            self.scale[part].reshape(-1, 6)[:, 3:] = 1.0 / _LEVER

    def at(self, shaft: str, position: float) -> Array:
        """Displacement of a point of a shaft per coordinate, (6, size)."""
        out = np.zeros((6, self.size))
        out[:, self.slices[shaft]] = self.shafts[shaft].at(position)
        return out

    @cached_property
    def gears(self) -> dict[str, Array]:
        """Displacement of each gear per coordinate."""
        return {n: self.at(g.shaft, g.node_position) for n, g in self.machine.gears.items()}

    @cached_property
    def bearings(self) -> dict[str, Array]:
        """Displacement of the shaft against the housing at each bearing, per coordinate."""
        rows = {}
        for name, bearing in self.machine.bearings.items():
            row = self.at(bearing.shaft, bearing.position)
            if bearing.node is not None and self.machine.housing is not None:
                for k, number in enumerate((self.machine.housing.nodes or {})[bearing.node]):
                    if number >= 0:
                        row[k, self.housing.start + number] -= 1.0
            rows[name] = row
        return rows

    @cached_property
    def meshes(self) -> dict[str, Array]:
        """Compression at mid face and its slope over the face, per coordinate, (2, size)."""
        rows = {}
        for name, mesh in self.machine.meshes.items():
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

    def law(self, name: str) -> MeshLaw:
        """Law of a mesh: the caller's, or a constant stiffness."""
        if name in self.laws:
            return self.laws[name]
        mesh = self.machine.meshes[name]
        first, second = (self.machine.gears[gear] for gear in mesh.gears)
        stiffness, error = mean_stiffness(mesh, (first, second)), mean_of(mesh.error)

        def linear(compression: float, slope: float) -> tuple[float, float, ArrayLike]:
            return stiffness * (compression - error), 0.0, ((stiffness, 0.0), (0.0, 0.0))

        return linear

    def face_width(self, name: str) -> float:
        """Common face width of a mesh."""
        return min(self.machine.gears[gear].face_width for gear in self.machine.meshes[name].gears)

    def bearing(self, name: str, displacement: Array) -> tuple[Array, Array]:
        """Load and stiffness of a bearing."""
        part = self.machine.bearings[name]
        if part.rolling is None:
            matrix = part.stiffness_matrix
            return matrix @ displacement, matrix
        load, matrix = np.zeros(6), np.zeros((6, 6))
        _, load[list(HELD)], matrix[np.ix_(HELD, HELD)] = part.rolling.response(
            displacement[list(HELD)]
        )
        return load, matrix
