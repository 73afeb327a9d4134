"""Stiffness of any block of hexahedra with 27 nodes, quadratic in all three directions."""

from __future__ import annotations

import numpy as np

from tribodyn.errors import ComputationError
from tribodyn.stiffness.fe2d.ring import quadratic_shapes
from tribodyn.types import Array, Index

_PLACES, _WEIGHTS = np.polynomial.legendre.leggauss(3)


def stacked_elements(section: Index, layer: int, count: int) -> Index:
    """Elements (count, e, 27) from those of one section (e, 9), ``layer`` nodes per section."""
    first = 2 * layer * np.arange(count)[:, None, None, None]
    nodes = first + layer * np.arange(3)[:, None] + section[:, None, :]
    return np.asarray(nodes.reshape(count, len(section), 27))


def _shapes() -> tuple[Array, Array]:
    """Slopes (g, 3, 27) of the shape functions at the Gauss points, and the weights."""
    value, slope = quadratic_shapes(_PLACES)
    slopes = [
        np.einsum("pa,qb,rc->pqrabc", *(slope if k == axis else value for k in range(3)))
        for axis in range(3)
    ]
    weights = np.einsum("p,q,r->pqr", _WEIGHTS, _WEIGHTS, _WEIGHTS)
    return np.stack([each.reshape(27, 27) for each in slopes], axis=1), weights.ravel()


def hexahedra_stiffness(corners: Array, stress: Array) -> Array:
    """Stiffness (e, 81, 81) of elements with nodes (e, 27, 3), the last direction fastest."""
    local, weights = _shapes()
    jacobian = np.einsum("gdn,enx->egdx", local, corners)
    determinant = np.linalg.det(jacobian)
    if determinant.min() * determinant.max() <= 0.0:
        raise ComputationError(
            "the finite element mesh of the tooth has an element that is turned inside out",
            why="Flanks, fillets and body of this tooth do not fit into the mesh",
            remedy='Choose the stiffness model "line", which has one for the contact line',
        )
    slopes = np.linalg.solve(jacobian, np.broadcast_to(local, (*jacobian.shape[:2], 3, 27)))
    slopes = slopes * np.sqrt(np.abs(determinant) * weights)[..., None, None]
    strain = np.zeros((*slopes.shape[:2], 6, 27, 3))
    for axis in range(3):
        strain[..., axis, :, axis] = slopes[..., axis, :]
    for row, (first, second) in enumerate(((1, 2), (0, 2), (0, 1)), start=3):
        strain[..., row, :, first] = slopes[..., second, :]
        strain[..., row, :, second] = slopes[..., first, :]
    rows = strain.reshape(len(corners), -1, 81)
    stressed = (stress @ strain.reshape(*slopes.shape[:2], 6, 81)).reshape(rows.shape)
    return np.asarray(np.swapaxes(rows, 1, 2) @ stressed)
