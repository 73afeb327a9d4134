"""Loads on the flank: nodal forces, and their remainder without the singular part.

Within the tooth the displacement is that of a point load on a half plane plus a smooth remainder.
The elements carry the remainder only: their loads are the tractions by which the half plane misses
the free outline of the tooth, and the jump across the foot of the tooth, under which the elements
carry the whole displacement.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tribodyn.gear import SpurGear
from tribodyn.stiffness.fe2d.ring import element_stiffness, quadratic_shapes
from tribodyn.stiffness.fe2d.tooth_mesh import SectorMesh
from tribodyn.stiffness.teeth.tooth_bending import load_point
from tribodyn.types import Array

#: Points of the quadrature over a patch.
_POINTS = 512


class FlankLoads(NamedTuple):
    """Unit loads on the flank of a meshed tooth, lengths in modules."""

    place: Array  #: points of the flank
    direction: Array  #: unit vectors of the loads: inward normals of the flank
    depth: Array  #: distance from the flank to the tooth axis along the load
    forces: Array  #: nodal forces in x and y


def nodal_weights(mesh: SectorMesh, length: Array, half_width: Array) -> Array:
    """Weights (nodes, K) of the nodes for Hertzian pressure on patches of the flank, or points."""
    points = _POINTS if np.any(half_width) else 1
    turn = np.pi * ((np.arange(points) + 0.5) / points - 0.5)
    share = 2.0 * np.cos(turn) ** 2 / np.sum(2.0 * np.cos(turn) ** 2)
    place = length[:, None] + half_width[:, None] * np.sin(turn)
    edges = mesh.flank_length[::-2]
    cell = np.clip(np.searchsorted(edges, place) - 1, 0, edges.size - 2)
    local = 2.0 * (place - edges[cell]) / (edges[cell + 1] - edges[cell]) - 1.0
    values, _ = quadratic_shapes(local)
    nodes = mesh.tooth[0, ::-1][2 * cell[..., None] + np.arange(3)]
    weights = np.zeros((len(mesh.nodes), length.size))
    case = np.broadcast_to(np.arange(length.size)[:, None, None], nodes.shape)
    np.add.at(weights, (nodes, case), values * share[:, None])
    return weights


def flank_loads(
    gear: SpurGear,
    mesh: SectorMesh,
    curvature_radius: Array,
    half_width: float = 0.0,
    *,
    inside: bool = False,
) -> FlankLoads:
    """Unit loads along the inward normal of the flank."""
    module = gear.normal_module
    point = load_point(gear, curvature_radius)
    tip = mesh.flank_length[0] - (half_width if inside else 0.0)
    place = 0.5 * gear.sign * curvature_radius**2 / (gear.base_radius * module)
    length = np.minimum(place, tip)
    width = np.minimum(half_width, mesh.flank_length[0] - length)
    weights = nodal_weights(mesh, length, width)
    direction = -np.stack([np.cos(point.load_angle), np.sin(point.load_angle)], axis=-1)
    forces = weights[:, None, :] * direction.T
    return FlankLoads(
        place=weights.T @ mesh.nodes,
        direction=direction,
        depth=point.depth / module,
        forces=forces.reshape(-1, length.size),
    )


_GAUSS = np.polynomial.legendre.leggauss(5)


def half_plane_displacement(
    away: Array, direction: Array, depth: Array, poissons_ratio: float
) -> Array:
    """Displacement of a half plane of Young's modulus one under a unit point load."""
    nu = poissons_ratio
    along = np.stack([-direction[..., 1], direction[..., 0]], axis=-1)
    x = np.einsum("...i,...i->...", away, direction)
    y = np.einsum("...i,...i->...", away, along)
    angle, log = np.arctan2(y, x), np.log(np.hypot(x, y) / depth)
    cosine, sine = np.cos(angle), np.sin(angle)
    radial = -2.0 * cosine * log - (1.0 - nu) * angle * sine
    around = 2.0 * nu * sine + 2.0 * sine * log + (1.0 - nu) * (sine - angle * cosine)
    inward, sideways = cosine * radial - sine * around, sine * radial + cosine * around
    displacement: Array = (inward[..., None] * direction + sideways[..., None] * along) / np.pi
    return displacement


def remainder_loads(
    mesh: SectorMesh, place: Array, direction: Array, depth: Array, elasticity: Array
) -> Array:
    """Nodal forces for the remainder under unit loads on the flank."""
    forces = np.zeros((len(mesh.nodes), 2, len(place)))
    _add_missed_tractions(forces, mesh, place, direction)
    _add_jump(forces, mesh, place, direction, depth, elasticity)
    return forces.reshape(-1, len(place))


def _add_missed_tractions(forces: Array, mesh: SectorMesh, place: Array, direction: Array) -> None:
    """Take the tractions of the half plane off the whole boundary of the tooth."""
    grid = mesh.tooth
    # clockwise, so that the outward normal is to the left of the way; of a ring the other way round
    loop = np.concatenate([grid[::-1, 0], grid[0, 1:], grid[1:, -1], grid[-1, -2::-1]])
    edges = np.stack([loop[:-2:2], loop[1:-1:2], loop[2::2]], axis=1)
    values, slopes = quadratic_shapes(_GAUSS[0])
    corners = mesh.nodes[edges]
    points = np.einsum("ga,eax->egx", values, corners)
    tangent = np.einsum("ga,eax->egx", slopes, corners)
    normal = np.stack([-tangent[..., 1], tangent[..., 0]], axis=-1)
    normal *= mesh.sign
    away = points[..., None, :] - place
    inward = np.einsum("egkx,kx->egk", away, direction)
    facing = np.einsum("egkx,egx->egk", away, normal)
    square = np.maximum(np.einsum("egkx,egkx->egk", away, away), 1e-24)
    traction = (-2.0 / np.pi * inward * facing / square**2)[..., None] * away
    nodal = -np.einsum("g,ga,egkx->eaxk", _GAUSS[1], values, traction)
    np.add.at(forces, edges, nodal)


def _add_jump(
    forces: Array, mesh: SectorMesh, place: Array, direction: Array, depth: Array, elasticity: Array
) -> None:
    """Give the elements above the foot the displacement of the half plane there."""
    nu = float(elasticity[0, 1] / elasticity[0, 0])
    elements = mesh.tooth_elements(slice(-3, None))
    foot = elements[:, [2, 5, 8]]
    away = mesh.nodes[foot][:, :, None] - place
    jump = half_plane_displacement(away, direction, depth, nu)
    stiffness = element_stiffness(mesh.nodes[elements], elasticity).reshape(-1, 9, 2, 9, 2)
    nodal = np.einsum("eaxby,ebky->eaxk", stiffness[:, :, :, [2, 5, 8]], jump)
    np.add.at(forces, elements, nodal)
