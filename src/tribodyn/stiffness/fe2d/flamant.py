"""Loads on the flank whose singular part is taken out before the finite elements are asked.

Within the tooth the displacement is that of a point load on a half plane plus a smooth remainder.
The elements carry the remainder only: their loads are the tractions by which the half plane misses
the free outline of the tooth, and the jump across the foot of the tooth, under which the elements
carry the whole displacement.
"""

from __future__ import annotations

import numpy as np

from tribodyn.stiffness.fe2d.element import element_stiffness, quadratic_shapes
from tribodyn.stiffness.fe2d.sector_mesh import SectorMesh, grid_elements
from tribodyn.types import Array

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
    found: Array = (inward[..., None] * direction + sideways[..., None] * along) / np.pi
    return found


def remainder_loads(
    mesh: SectorMesh,
    place: Array,
    direction: Array,
    depth: Array,
    elasticity: Array,
) -> Array:
    """Nodal forces for the remainder under unit loads on the flank."""
    forces = np.zeros((len(mesh.nodes), 2, len(place)))
    _add_missed_tractions(forces, mesh, place, direction)
    _add_jump(forces, mesh, place, direction, depth, elasticity)
    return forces.reshape(-1, len(place))


def _add_missed_tractions(forces: Array, mesh: SectorMesh, place: Array, direction: Array) -> None:
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
    forces: Array,
    mesh: SectorMesh,
    place: Array,
    direction: Array,
    depth: Array,
    elasticity: Array,
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
