"""Loads on the flank as nodal forces: at a point, or the pressure of Hertz over a patch."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tribodyn.gear import SpurGear
from tribodyn.stiffness.fe2d.element import quadratic_shapes
from tribodyn.stiffness.fe2d.sector_mesh import SectorMesh
from tribodyn.stiffness.load_point import load_point
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
    """Weights of the nodes for a Hertzian pressure on the flank.

    Parameters
    ----------
    mesh : SectorMesh
        Sector.
    length : array (K,)
        Place of the middle along the flank.
    half_width : array (K,)
        Half width of the patch along the flank; zero for a point.

    Returns
    -------
    array (nodes, K)
        Columns that add up to one.

    Notes
    -----
    Source: semi-elliptic pressure of Hertz, Johnson, Contact Mechanics, 1985, equation 4.44.
    """
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
    length = np.minimum(0.5 * curvature_radius**2 / (gear.base_radius * module), tip)
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
