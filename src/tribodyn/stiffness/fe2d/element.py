"""The nine-node quadrilateral in plane stress: shape functions and stiffness of many at once."""

from __future__ import annotations

from functools import cache

import numpy as np

from tribodyn.errors import ComputationError
from tribodyn.types import Array

#: Points and weights of Gauss in one direction; exact for the constant-stress patch on any shape.
_GAUSS = np.polynomial.legendre.leggauss(3)
#: Elements whose matrices are formed at a time.
_BLOCK = 1024


def quadratic_shapes(place: Array) -> tuple[Array, Array]:
    """Quadratic Lagrange polynomials on the nodes -1, 0, 1 and their slopes."""
    x = np.asarray(place, dtype=float)
    values = np.stack([0.5 * x * (x - 1.0), 1.0 - x * x, 0.5 * x * (x + 1.0)], axis=-1)
    slopes = np.stack([x - 0.5, -2.0 * x, x + 0.5], axis=-1)
    return values, slopes


@cache
def shape_gradients() -> tuple[Array, Array]:
    """Slopes of the nine shape functions at the nine Gauss points, and the weights."""
    values, slopes = quadratic_shapes(_GAUSS[0])
    first = np.einsum("pa,qb->pqab", slopes, values).reshape(9, 9)
    second = np.einsum("pa,qb->pqab", values, slopes).reshape(9, 9)
    return np.stack([first, second], axis=1), np.outer(_GAUSS[1], _GAUSS[1]).ravel()


def plane_stress(youngs_modulus: float, poissons_ratio: float) -> Array:
    """Matrix from strains (xx, yy, engineering shear) to stresses in plane stress."""
    nu = poissons_ratio
    factor = youngs_modulus / (1.0 - nu * nu)
    return factor * np.array([[1.0, nu, 0.0], [nu, 1.0, 0.0], [0.0, 0.0, 0.5 * (1.0 - nu)]])


def element_stiffness(corners: Array, elasticity: Array) -> Array:
    """Stiffness of isoparametric nine-node quadrilaterals."""
    factor: Array = np.linalg.cholesky(elasticity).T.astype(float)
    parts = [
        _block(corners[first : first + _BLOCK], factor) for first in range(0, len(corners), _BLOCK)
    ]
    return np.concatenate(parts)


def _block(corners: Array, factor: Array) -> Array:
    local, weights = shape_gradients()
    jacobian = np.einsum("gdn,enx->egdx", local, corners)
    determinant = np.linalg.det(jacobian)
    if determinant.min() <= 0.0:
        raise ComputationError(
            "the finite element mesh of the gear has an element that is turned inside out"
        )
    # slopes in x and y, scaled so that the square of the strain matrix is the integrand
    slopes = np.linalg.solve(jacobian, np.broadcast_to(local, (*jacobian.shape[:2], 2, 9)))
    slopes = slopes * np.sqrt(determinant * weights)[..., None, None]
    strain = np.zeros((*slopes.shape[:2], 3, 9, 2))
    strain[..., 0, :, 0] = slopes[..., 0, :]
    strain[..., 1, :, 1] = slopes[..., 1, :]
    strain[..., 2, :, 0] = slopes[..., 1, :]
    strain[..., 2, :, 1] = slopes[..., 0, :]
    root = np.matmul(factor, strain.reshape(*slopes.shape[:2], 3, 18)).reshape(-1, 27, 18)
    stiffness: Array = np.matmul(root.transpose(0, 2, 1), root)
    return stiffness
