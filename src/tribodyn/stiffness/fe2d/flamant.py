"""Loads on the flank whose singular part is taken out before the finite elements are asked.

Within the tooth the displacement is that of a point load on a half plane plus a smooth remainder.
The elements carry the remainder only: their loads are the tractions by which the half plane misses
the free outline of the tooth, and the jump across the foot of the tooth, under which the elements
carry the whole displacement.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tribodyn.stiffness.fe2d.element import element_stiffness, quadratic_shapes
from tribodyn.stiffness.fe2d.sector_mesh import SectorMesh, grid_elements

__all__ = ["half_plane_displacement", "remainder_loads"]

FloatArray = NDArray[np.float64]

_GAUSS = np.polynomial.legendre.leggauss(5)


def half_plane_displacement(
    away: FloatArray, direction: FloatArray, depth: FloatArray, poissons_ratio: float
) -> FloatArray:
    """Displacement of a half plane of Young's modulus one under a unit point load.

    Parameters
    ----------
    away : array (..., 2)
        Place, from the point of the load.
    direction : array (..., 2)
        Unit vector of the load, the inward normal of the edge.
    depth : array (...)
        Depth under the load where the displacement is zero.
    poissons_ratio : float
        Poisson's ratio; plane stress.

    Returns
    -------
    array (..., 2)

    Notes
    -----
    Source: Flamant; Timoshenko and Goodier, Theory of Elasticity, section on the concentrated
    force at a point of a straight boundary.
    """
    nu = poissons_ratio
    along = np.stack([-direction[..., 1], direction[..., 0]], axis=-1)
    x = np.einsum("...i,...i->...", away, direction)
    y = np.einsum("...i,...i->...", away, along)
    angle, log = np.arctan2(y, x), np.log(np.hypot(x, y) / depth)
    cosine, sine = np.cos(angle), np.sin(angle)
    radial = -2.0 * cosine * log - (1.0 - nu) * angle * sine
    around = 2.0 * nu * sine + 2.0 * sine * log + (1.0 - nu) * (sine - angle * cosine)
    inward, sideways = cosine * radial - sine * around, sine * radial + cosine * around
    found: FloatArray = (inward[..., None] * direction + sideways[..., None] * along) / np.pi
    return found


def remainder_loads(
    mesh: SectorMesh,
    place: FloatArray,
    direction: FloatArray,
    depth: FloatArray,
    elasticity: FloatArray,
) -> FloatArray:
    """Nodal forces for the remainder under unit loads on the flank.

    Parameters
    ----------
    mesh : SectorMesh
        Sector.
    place : array (K, 2)
        Where the loads act.
    direction : array (K, 2)
        Unit vectors of the loads.
    depth : array (K,)
        Depth under the load where the displacement of the half plane is zero.
    elasticity : array (3, 3)
        From strain to stress, Young's modulus of one, plane stress.

    Returns
    -------
    array (2 nodes, K)
        Forces in x and y. The solution is the remainder in the tooth, the whole displacement on
        its foot and below.
    """
    forces = np.zeros((len(mesh.nodes), 2, len(place)))
    _add_missed_tractions(forces, mesh, place, direction)
    _add_jump(forces, mesh, place, direction, depth, elasticity)
    return forces.reshape(-1, len(place))


def _add_missed_tractions(
    forces: FloatArray, mesh: SectorMesh, place: FloatArray, direction: FloatArray
) -> None:
    """Take the tractions of the half plane off the whole boundary of the tooth."""
    grid = mesh.tooth
    # clockwise, so that the outward normal is to the left of the way
    loop = np.concatenate([grid[::-1, 0], grid[0, 1:], grid[1:, -1], grid[-1, -2::-1]])
    edges = np.stack([loop[:-2:2], loop[1:-1:2], loop[2::2]], axis=1)
    values, slopes = quadratic_shapes(_GAUSS[0])
    corners = mesh.nodes[edges]
    points = np.einsum("ga,eax->egx", values, corners)
    tangent = np.einsum("ga,eax->egx", slopes, corners)
    normal = np.stack([-tangent[..., 1], tangent[..., 0]], axis=-1)
    away = points[..., None, :] - place
    inward = np.einsum("egkx,kx->egk", away, direction)
    facing = np.einsum("egkx,egx->egk", away, normal)
    square = np.maximum(np.einsum("egkx,egkx->egk", away, away), 1e-24)
    traction = (-2.0 / np.pi * inward * facing / square**2)[..., None] * away
    nodal = -np.einsum("g,ga,egkx->eaxk", _GAUSS[1], values, traction)
    np.add.at(forces, edges, nodal)


def _add_jump(
    forces: FloatArray,
    mesh: SectorMesh,
    place: FloatArray,
    direction: FloatArray,
    depth: FloatArray,
    elasticity: FloatArray,
) -> None:
    """Give the elements above the foot the displacement of the half plane there."""
    nu = float(elasticity[0, 1] / elasticity[0, 0])
    elements = grid_elements(mesh.tooth[:, -3:])
    foot = elements[:, [2, 5, 8]]
    away = mesh.nodes[foot][:, :, None] - place
    jump = half_plane_displacement(away, direction, depth, nu)
    stiffness = element_stiffness(mesh.nodes[elements], elasticity).reshape(-1, 9, 2, 9, 2)
    nodal = np.einsum("eaxby,ebky->eaxk", stiffness[:, :, :, [2, 5, 8]], jump)
    np.add.at(forces, elements, nodal)
