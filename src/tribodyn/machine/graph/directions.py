"""Directions along which a mesh acts on its two gears, in space."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.machine.gear import Gear
from tribodyn.machine.graph.crossed import CrossedGeometry
from tribodyn.machine.graph.kinematics import base_radius
from tribodyn.machine.mesh import Mesh
from tribodyn.types import Array

_X = np.array([1.0, 0.0, 0.0])


@dataclass(frozen=True, eq=False)
class MeshDirection:
    """Line of action of a mesh, and what its force does to both gears.

    Parameters
    ----------
    base_radius : (float, float)
        Radii of the base circles [m].
    working_radius : (float, float)
        Distances of the pitch point from both axes, negative for a ring [m].
    working_pressure_angle : float
        Working transverse pressure angle [rad].
    base_helix_angle : float
        Helix angle at the base circle, without a sign [rad].
    normal : (3,) array
        Force on the second gear (x, y, z) per transverse force of the mesh [1].
    across : (3,) array
        Direction across the line of action, in which the flanks move: that of friction [1].
    direction : (12,) array
        Derivative of the compression with respect to (x, y, z, theta_x, theta_y, theta_z) of the
        first and of the second gear [1], rotations [m]. The mesh loads the gears by -direction
        times its transverse force.
    senses : (int, int)
        Signs of the speeds of both gears.
    sliding : (12,) array, optional
        On crossed axes, like ``direction``: of the way of the first flank over the second one,
        against which friction acts [1, rotations m]; zero where the axes intersect, so that the
        flanks roll there.

    Notes
    -----
    The force acts at the pitch point, at mid face; ``direction = [n, r_1 c x n, -n, r_2 c x n]``
    with c from the first axis to the pitch point. On crossed axes it acts in the calculation
    point, along the normal; base radii are levers of the normal, and each half of the entries
    is over the coordinates of its shaft, ``normal`` and ``across`` over those of the first.
    """

    base_radius: tuple[float, float]
    working_radius: tuple[float, float]
    working_pressure_angle: float
    base_helix_angle: float
    normal: Array
    across: Array
    direction: Array
    senses: tuple[int, int]
    sliding: Array | None = None

    def friction(
        self, friction_sum: ArrayLike, first_moment: ArrayLike, second_moment: ArrayLike
    ) -> Array:
        """Direction of friction over the 12 coordinates of both gears.

        Parameters
        ----------
        friction_sum : (p,) array
            Friction force over mesh force, summed over the tooth pairs, positive where it holds
            back the first gear.
        first_moment, second_moment : (p,) array
            Moment of friction over mesh force on either gear, as those of a mesh table [m].

        Returns
        -------
        (p, 12) array
            Generalized friction over mesh force, like :attr:`direction` [1 and m]; on crossed
            axes that of the sum in the calculation point.
        """
        if self.sliding is not None:
            return np.asarray(np.multiply.outer(friction_sum, self.sliding))
        force = np.multiply.outer(np.asarray(friction_sum, dtype=float), self.across)
        turns = [
            np.multiply.outer(np.asarray(moment, dtype=float), sign * _X)
            for moment, sign in (
                (first_moment, self.senses[0]),
                (second_moment, -self.senses[1]),
            )
        ]
        return np.concatenate([force, turns[0], -force, turns[1]], axis=-1)


def reference_center_distance(mesh: Mesh, gears: tuple[Gear, Gear]) -> float:
    """Centre distance without profile shift [m]; negative for internal gears."""
    return 0.5 * (gears[0].teeth + gears[1].teeth) * mesh.transverse_module


def center_distance(mesh: Mesh, gears: tuple[Gear, Gear]) -> float:
    """Centre distance, with the sign of ISO 21771: negative for internal gears [m]."""
    reference = reference_center_distance(mesh, gears)
    if mesh.center_distance is None:
        return reference
    return math.copysign(mesh.center_distance, reference)


def working_pressure_angle(mesh: Mesh, gears: tuple[Gear, Gear]) -> float:
    """Transverse pressure angle at the working pitch circles [rad]."""
    ratio = reference_center_distance(mesh, gears) / center_distance(mesh, gears)
    return math.acos(ratio * math.cos(mesh.transverse_pressure_angle))


def mesh_direction(
    mesh: Mesh, gears: tuple[Gear, Gear], sense: int, senses: tuple[int, int]
) -> MeshDirection:
    """Directions of a mesh whose first gear has a torque of sign ``sense`` about x."""
    if mesh.crossing is not None:
        return _crossed_direction(mesh.crossing, sense, senses)
    teeth = [gear.teeth for gear in gears]
    distance = center_distance(mesh, gears)
    radii = tuple(distance * z / sum(teeth) for z in teeth)
    angle = working_pressure_angle(mesh, gears)
    side = math.copysign(1.0, distance)
    toward = side * np.array([0.0, math.cos(mesh.angle), math.sin(mesh.angle)])
    tangent = np.cross(_X, toward)
    turn = sense * math.copysign(1.0, teeth[0])
    hand = 1.0 if mesh.hand == "right" else -1.0
    transverse = turn * math.cos(angle) * tangent + math.sin(angle) * toward
    normal = transverse - sense * hand * math.tan(mesh.base_helix_angle) * _X
    moments = [radius * np.cross(toward, normal) for radius in radii]
    return MeshDirection(
        base_radius=(base_radius(mesh, gears[0]), base_radius(mesh, gears[1])),
        working_radius=(radii[0], radii[1]),
        working_pressure_angle=angle,
        base_helix_angle=mesh.base_helix_angle,
        normal=normal,
        across=senses[0] * math.copysign(1.0, teeth[0]) * np.cross(_X, transverse),
        direction=np.concatenate([normal, moments[0], -normal, moments[1]]),
        senses=senses,
    )


def _crossed_direction(pair: CrossedGeometry, sense: int, senses: tuple[int, int]) -> MeshDirection:
    """Directions of a hypoid or bevel pair."""
    along, sliding = pair.along(sense), pair.sliding(sense, senses[0])
    return MeshDirection(
        base_radius=pair.levers(sense),
        working_radius=pair.working_radii,
        working_pressure_angle=pair.pressure_angle(sense),
        base_helix_angle=0.0,
        normal=along[:3],
        across=sliding[:3],
        direction=along,
        senses=senses,
        sliding=sliding,
    )
