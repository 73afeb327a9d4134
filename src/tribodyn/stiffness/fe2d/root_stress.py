"""Stress along the root fillet of a tooth by finite elements, for unit loads on the flanks."""

from __future__ import annotations

import math
from functools import partial
from typing import Final, NamedTuple

import numpy as np

from tribodyn.gear import SpurGear
from tribodyn.stiffness.fe2d.flank_load import flank_loads
from tribodyn.stiffness.fe2d.provider import _file_name, _places, held_radius, looked_up
from tribodyn.stiffness.fe2d.ring import Ring, plane_stress, quadratic_shapes
from tribodyn.stiffness.fe2d.tooth_mesh import MeshSize, SectorMesh, ToothSide, tooth_mesh
from tribodyn.types import Array, Index

#: Neighbours of the loaded tooth whose roots feel it, to the side of smaller and larger radii.
NEIGHBOURS: Final = (-1, 0, 1)
#: Elements over the fillet radius, and place of the smallest between form circle (0) and foot (1).
_ELEMENTS, _FINEST = 12, 0.7
#: Half width of the loads [modules].
_HALF_WIDTH = 0.05


class RootUnitStress(NamedTuple):
    """Stress along a fillet under unit loads; lengths in modules."""

    curvature_radius: Array  #: of the loaded places (places,) [m]
    stress: Array  #: (NEIGHBOURS, points, places): over the load per width and the module [-]
    position: Array  #: points (points, 2), the middle of the tooth on +y


def surface_stress(nodes: Array, line: Index, displacement: Array) -> tuple[Array, Array]:
    """Stress for Young's modulus one at the Gauss points of a free edge, and these points."""
    # The displacement has the shape (nodes, 2, cases). Strain along the edge alone makes stress.
    values, slopes = quadratic_shapes(np.polynomial.legendre.leggauss(2)[0])
    edges = line[np.arange(0, line.size - 2, 2)[:, None] + np.arange(3)]
    tangent = np.einsum("ga,eax->egx", slopes, nodes[edges]).reshape(-1, 2)
    moved = np.einsum("ga,eaxk->egxk", slopes, displacement[edges])
    moved = moved.reshape(len(tangent), 2, -1)
    strain = np.einsum("px,pxk->pk", tangent, moved) / (tangent**2).sum(axis=1)[:, None]
    return strain, np.einsum("ga,eax->egx", values, nodes[edges]).reshape(-1, 2)


def fillet_nodes(mesh: SectorMesh, side: ToothSide) -> Index:
    """Nodes of the loaded side from the middle of the root up to the form circle."""
    foot = int(np.flatnonzero(mesh.outline == mesh.tooth[0, -1])[0])
    below = int(np.count_nonzero(mesh.flank_length <= side.form_length + 1e-9))
    return mesh.outline[: foot + below - (foot + below + 1) % 2]


def computed_root_stress(
    gear: SpurGear, fillet_radius: float, refined: float = 1.0, poissons_ratio: float = 0.3
) -> RootUnitStress:
    """Stress along the fillet of a spur gear whose fillet radius is known in modules."""
    first, side = fillet_radius / (_ELEMENTS * refined), ToothSide(gear)
    size = MeshSize(flank=0.15, largest=1.01 * first, growth=1.0 + 0.25 / refined)
    ends = side.form_length - _FINEST * side.foot_length, first
    mesh = tooth_mesh(gear, held_radius(gear), size, ends)
    ring, radii = Ring(mesh, plane_stress(1.0, poissons_ratio)), _places(gear)[0]
    solution = ring.solve(flank_loads(gear, mesh, radii, _HALF_WIDTH, inside=True).forces)
    line, shape = fillet_nodes(mesh, side), (len(mesh.nodes), 2, radii.size)
    stress = []
    for neighbour in NEIGHBOURS:  # the loaded tooth lies to the side of larger radii of number 1
        moved = ring.displacement(solution, gear.sign * neighbour).reshape(shape)
        along, points = surface_stress(mesh.nodes, line, moved)
        stress.append(along)
    return RootUnitStress(radii, np.stack(stress), points)


def root_stress(
    gear: SpurGear, fillet_radius: float, poissons_ratio: float = 0.3
) -> RootUnitStress:
    """Stress along the fillet, stored in the folder of computed arrays."""
    size = MeshSize(largest=round(fillet_radius / _ELEMENTS, 12))
    name = _file_name(gear, poissons_ratio, 1, size)
    compute = partial(computed_root_stress, gear, fillet_radius, poissons_ratio=poissons_ratio)
    return looked_up(RootUnitStress, name, compute, method="root")


def at_places(unit: RootUnitStress, neighbour: int, curvature_radius: Array) -> Array:
    """Stress (..., points) of a neighbour of the tooth that is loaded at these places [m]."""
    from scipy.interpolate import CubicSpline

    order = np.argsort(unit.curvature_radius)
    radii = unit.curvature_radius[order]
    spline = CubicSpline(radii, unit.stress[NEIGHBOURS.index(neighbour)][:, order], axis=1)
    places = np.clip(curvature_radius, radii[0], radii[-1])
    return np.moveaxis(spline(places), 0, -1)


def virtual_spur_gear(gear: SpurGear, virtual_teeth: float) -> SpurGear:
    """Spur gear of the normal section with a whole number of teeth; a spur gear is its own."""
    if gear.helix_angle == 0.0:
        return gear
    teeth, module = round(virtual_teeth), gear.normal_module
    larger = (abs(teeth) - abs(gear.teeth) / math.cos(gear.helix_angle)) * module
    bore = 0.0 if gear.is_ring or not gear.bore_diameter else gear.bore_diameter + larger
    return SpurGear(
        teeth=teeth,
        normal_module=module,
        normal_pressure_angle=gear.normal_pressure_angle,
        profile_shift_coefficient=gear.generating_shift_coefficient,
        tip_diameter=gear.tip_diameter + larger,
        rack=gear.rack,
        face_width=gear.face_width,
        bore_diameter=bore,
        rim_diameter=2.0 * gear.rim_radius + larger if gear.is_ring else None,
    )
