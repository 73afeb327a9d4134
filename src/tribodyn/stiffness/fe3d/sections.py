"""Elements of a twisted solid: one section, turned along the face by the helix.

In the frame that turns with the section the strain is ``L0 u + L1 du/dzeta`` with matrices that do
not depend on the face position, so that three matrices of the section and three of the face give
the stiffness of the solid:
``K = B0 x mass + B1 x slope + B1' x slope' + B2 x bending``.

Functions over the face width are cubic B-splines, closer together towards both free ends.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from tribodyn.arrays.splines import bspline_slopes, bspline_values, clamped_knots
from tribodyn.interrupt import single_blas_thread
from tribodyn.stiffness.fe2d.ring import quadratic_shapes, weighted_slopes
from tribodyn.types import Array, Index


@dataclass(frozen=True)
class FaceSize:
    """Sizes of the elements over the face width over the module."""

    end: float = 0.5  #: size at a free end
    largest: float = 1.4  #: largest size on a face of up to ``least_count`` of them
    growth: float = 1.5  #: ratio of neighbouring elements
    least_count: int = 14  #: elements of the largest size on longer faces

    def breaks(self, width: float) -> Array:
        """Ends of the elements from 0 to ``width``, both in modules."""
        edges, step = [0.0], self.end
        largest = max(self.largest, width / self.least_count)
        while edges[-1] < 0.5 * width:
            edges.append(edges[-1] + step)
            step = min(step * self.growth, largest)
        half = np.array(edges) * (0.5 * width / edges[-1])
        return np.concatenate([half[:-1], width - half[::-1]])


@dataclass(frozen=True, eq=False)
class FaceBasis:
    """Splines over the face and the integrals of their products, lengths in modules."""

    knots: Array
    mass: Array  #: integrals of ``value value``
    slope: Array  #: integrals of ``value slope``
    bending: Array  #: integrals of ``slope slope``

    @property
    def count(self) -> int:
        """Number of functions."""
        return len(self.mass)


def face_basis(breaks: Array) -> FaceBasis:
    """Splines on breakpoints."""
    knots = clamped_knots(breaks)
    place, weight = np.polynomial.legendre.leggauss(4)
    half = 0.5 * np.diff(breaks)
    points = (0.5 * (breaks[1:] + breaks[:-1])[:, None] + half[:, None] * place).ravel()
    weights = (half[:, None] * weight).ravel()
    value, slope = bspline_values(knots, points), bspline_slopes(knots, points)
    weighted = value.T * weights
    return FaceBasis(knots, weighted @ value, weighted @ slope, (slope.T * weights) @ slope)


_PLACES, _WEIGHTS = np.polynomial.legendre.leggauss(3)


class SectionMatrices(NamedTuple):
    """Matrices ``B0``, ``B1``, ``B2`` of a section or of each of its elements."""

    none: Array  #: no slope over the face
    single: Array  #: slope of the second displacement
    double: Array  #: slopes of both

    def of_solid(self, face: FaceBasis | None) -> Array:
        """Stiffness (f, z, f, z) of the solid of a section with ``f`` freedoms."""
        assert face is not None  # A section alone is no solid.
        parts = self.none, self.single, np.conj(self.single.T), self.double
        faces = face.mass, face.slope, face.slope.T, face.bending
        # [f, 1, g, part] times [z, part, w]
        return np.asarray(np.stack(parts, axis=-1)[:, None] @ np.stack(faces, axis=1))


class SolidMatrices(NamedTuple):
    """Matrix of a solid, or of each of its elements."""

    stiffness: Array

    def of_solid(self, face: FaceBasis | None) -> Array:
        """Stiffness (f, 1, f, 1) in the shape of that over a face."""
        assert face is None  # The freedoms of a solid stand for themselves.
        return self.stiffness[:, None, :, None]


def elasticity(poissons_ratio: float) -> Array:
    """Matrix from strains (xx, yy, zz, yz, xz, xy) to stresses for a Young's modulus of one."""
    nu = poissons_ratio
    matrix = np.zeros((6, 6))
    matrix[:3, :3] = nu / ((1.0 + nu) * (1.0 - 2.0 * nu))
    matrix[:3, :3] += np.eye(3) / (1.0 + nu)
    matrix[3:, 3:] = np.eye(3) / (2.0 * (1.0 + nu))
    return matrix


def _products(first: Array, second: Array, stress: Array) -> SectionMatrices:
    """Integrals of strains ``first`` and ``second`` (..., g, 6, f), weighted by their roots."""
    turned = np.conj(np.swapaxes(first, -1, -2))
    right = stress @ second
    none = (turned @ (stress @ first)).sum(axis=-3)
    single = (turned @ right).sum(axis=-3)
    double = (np.swapaxes(second, -1, -2) @ right).sum(axis=-3)
    return SectionMatrices(none, single, double)


def _over_face(values: Array) -> Array:
    """Strain matrix (..., 6, n, 3) of the slope over the face of three displacements."""
    strain = np.zeros((*values.shape[:-1], 6, values.shape[-1], 3), dtype=values.dtype)
    for row, axis in ((2, 2), (3, 1), (4, 0)):
        strain[..., row, :, axis] = values
    return strain


def element_matrices(corners: Array, twist: float, stress: Array) -> SectionMatrices:
    """Matrices (e, 27, 27) of nine-node quadrilaterals that turn anticlockwise along the face."""
    value, _ = quadratic_shapes(_PLACES)
    values = np.einsum("pa,qb->pqab", value, value).reshape(9, 9)
    slopes, root = weighted_slopes(corners)
    points = np.einsum("gn,enx->egx", values, corners)
    along, across = slopes[..., 0, :], slopes[..., 1, :]
    still = values * root[..., None]
    strain = np.zeros((*still.shape[:2], 6, 9, 3))
    strain[..., 0, :, 0] = strain[..., 5, :, 1] = along
    strain[..., 1, :, 1] = strain[..., 5, :, 0] = across
    strain[..., 4, :, 2] = along
    strain[..., 3, :, 2] = across
    # slope over the face at a fixed place: -twist times the turning part, plus the turned frame
    turning = -twist * (points[..., :1] * across - points[..., 1:] * along)
    strain[..., 2, :, 2] += turning
    for row, axis, sign in ((3, 1, 1.0), (4, 0, -1.0)):
        strain[..., row, :, axis] += turning
        strain[..., row, :, 1 - axis] += sign * twist * still
    shape = (*still.shape[:2], 6, 27)
    return _products(strain.reshape(shape), _over_face(still).reshape(shape), stress)


def annulus_matrices(radii: Array, order: int, twist: float, stress: Array) -> SectionMatrices:
    """Matrices (e, 9, 9) per radian of a ring of elements under loads ``exp(i order angle)``."""
    # displacements are radial, tangential and axial
    value, slope = quadratic_shapes(_PLACES)
    half = 0.5 * (radii[:, 2] - radii[:, 0])[:, None]
    radius = np.einsum("gn,en->eg", value, radii)[..., None]
    root = np.sqrt(np.abs(half) * _WEIGHTS * radius[..., 0])[..., None]
    still, grown = value * root, slope / half[..., None] * root
    wave, hoop = 1j * order * still, still / radius
    strain = np.zeros((*still.shape[:2], 6, 3, 3), dtype=complex)
    strain[..., 0, :, 0] = strain[..., 4, :, 2] = grown
    strain[..., 1, :, 0] = hoop
    strain[..., 1, :, 1] = strain[..., 3, :, 2] = strain[..., 5, :, 0] = wave / radius
    strain[..., 5, :, 1] = grown - hoop
    for row, axis in ((2, 2), (3, 1), (4, 0)):
        strain[..., row, :, axis] -= twist * wave
    shape = (*still.shape[:2], 6, 9)
    return _products(strain.reshape(shape), _over_face(still).reshape(shape), stress)


@single_blas_thread()
def eliminated(matrix: Array, count: int) -> Array:
    """Stiffness of the freedoms after the first ``count``, which are free of loads."""
    from scipy.linalg import cholesky, solve_triangular

    if count == 0:
        return matrix
    lower = cholesky(matrix[:count, :count], lower=True, check_finite=False)
    half = solve_triangular(lower, matrix[:count, count:], lower=True, check_finite=False)
    # real: the product of a matrix with itself is recognised, and costs half
    turned = np.conj(half.T) if np.iscomplexobj(half) else half.T
    return np.asarray(matrix[count:, count:] - turned @ half)


def condensed(
    freedoms: Index,
    matrices: SectionMatrices | SolidMatrices,
    groups: Sequence[Index],
    retained: Index,
    face: FaceBasis | None,
) -> Array:
    """Stiffness (f, z, f, z) of the retained freedoms, the others free of loads."""
    # Elements (e, n) whose negative freedoms cannot move are assembled in groups, in this order.
    last = np.full(freedoms.max() + 1, -1)
    for step, group in enumerate(groups):
        members = freedoms[group]
        last[members[members >= 0]] = step
    last[retained] = len(groups)
    count, front = face.count if face else 1, np.empty(0, dtype=int)
    stiffness = np.zeros((0, count, 0, count))
    for step, group in enumerate(groups):
        members = freedoms[group]
        joined = np.union1d(front, members[members >= 0])
        leaving = last[joined] == step
        order = np.concatenate([joined[leaving], joined[~leaving]])
        place = np.full(freedoms.max() + 2, -1)
        place[order] = np.arange(order.size)
        sums = _assembled(place[members], [parts[group] for parts in matrices], order.size)
        full = type(matrices)(*sums).of_solid(face)
        at = place[front]
        full[at[:, None], :, at[None, :], :] += stiffness.transpose(0, 2, 1, 3)
        size = int(leaving.sum()) * count
        flat = eliminated(full.reshape(order.size * count, -1), size)
        front = order[int(leaving.sum()) :]
        stiffness = flat.reshape(front.size, count, front.size, count)
    place = np.argsort(front)[np.searchsorted(np.sort(front), retained)]
    return np.ascontiguousarray(stiffness[place][:, :, place])


def _assembled(place: Index, parts: Sequence[Array], size: int) -> list[Array]:
    """Sum of element matrices, the freedoms that cannot move left out."""
    rows = np.broadcast_to(place[:, :, None], parts[0].shape)
    columns = np.swapaxes(rows, 1, 2)
    valid = (rows >= 0) & (columns >= 0)
    sums = []
    for matrix in parts:
        total = np.zeros((size, size))
        np.add.at(total, (rows[valid], columns[valid]), matrix[valid])
        sums.append(total)
    return sums
