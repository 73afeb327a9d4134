"""A ring of equal sectors: one factorization of one sector, and a small system per harmonic.

The sectors couple through their cuts only. Eliminating the inside of one sector leaves a matrix
of its two cuts, and the discrete Fourier transform around the ring decouples the harmonics: the
result is that of the finite element mesh of the whole ring, to rounding.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache, cached_property
from typing import Any

import numpy as np

from tribodyn.errors import ComputationError
from tribodyn.stiffness.fe2d.tooth_mesh import SectorMesh
from tribodyn.types import Array, Index

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


def weighted_slopes(corners: Array) -> tuple[Array, Array]:
    """Slopes (e, g, 2, 9) in x and y times roots (e, g) of the weights, and these roots."""
    local, weights = shape_gradients()
    jacobian = np.einsum("gdn,enx->egdx", local, corners)
    determinant = np.linalg.det(jacobian)
    if determinant.min() <= 0.0:
        raise ComputationError(
            "the finite element mesh of the gear has an element that is turned inside out",
            why="Root and rim of this gear do not fit into the mesh",
            remedy="Give a larger bore-to-root distance, or choose another stiffness model",
        )
    slopes = np.linalg.solve(jacobian, np.broadcast_to(local, (*jacobian.shape[:2], 2, 9)))
    root = np.sqrt(determinant * weights)
    return slopes * root[..., None, None], root


def _block(corners: Array, factor: Array) -> Array:
    slopes, _ = weighted_slopes(corners)  # the square of the strain matrix is the integrand
    strain = np.zeros((*slopes.shape[:2], 3, 9, 2))
    strain[..., 0, :, 0] = slopes[..., 0, :]
    strain[..., 1, :, 1] = slopes[..., 1, :]
    strain[..., 2, :, 0] = slopes[..., 1, :]
    strain[..., 2, :, 1] = slopes[..., 0, :]
    root = np.matmul(factor, strain.reshape(*slopes.shape[:2], 3, 18)).reshape(-1, 27, 18)
    stiffness: Array = np.matmul(root.transpose(0, 2, 1), root)
    return stiffness


#: Right-hand sides solved together: more would be handed to a threaded library in bits too small.
_TOGETHER = 4


def assembled(matrices: Array, freedoms: Index, size: int) -> Any:
    """Sparse matrix of those (e, n, n) of elements with freedoms (e, n)."""
    from scipy.sparse import coo_array

    rows = np.broadcast_to(freedoms[:, :, None], matrices.shape)
    columns = np.broadcast_to(freedoms[:, None, :], matrices.shape)
    return coo_array((matrices.ravel(), (rows.ravel(), columns.ravel())), shape=(size, size))


def symmetric_factors(matrix: Any) -> Any:
    """Factors of a sparse symmetric positive matrix."""
    from scipy.sparse.linalg import splu

    options = {"SymmetricMode": True}
    order = "MMD_AT_PLUS_A"
    return splu(matrix.tocsc(), permc_spec=order, diag_pivot_thresh=0.0, options=options)


def plain_stiffness(mesh: SectorMesh, elasticity: Array) -> Any:
    """Stiffness matrix of a sector in x and y, nothing held."""
    matrices = element_stiffness(mesh.nodes[mesh.elements], elasticity)
    elements = plane_freedoms(mesh.elements.ravel()).reshape(len(mesh.elements), 18)
    return assembled(matrices, elements, 2 * len(mesh.nodes))


def sector_stiffness(mesh: SectorMesh, elasticity: Array) -> Any:
    """Stiffness matrix of a sector, nothing held, cuts in polar directions."""
    turn = _polar_on_cuts(mesh)
    return (turn.T @ plain_stiffness(mesh, elasticity).tocsc() @ turn).tocsc()


def _polar_on_cuts(mesh: SectorMesh) -> Any:
    """Matrix from the freedoms, polar on the cuts, to x and y."""
    blocks = np.tile(np.eye(2), (len(mesh.nodes), 1, 1))
    cuts = np.concatenate([mesh.right_cut, mesh.left_cut])
    outward = mesh.nodes[cuts] / np.hypot(*mesh.nodes[cuts].T)[:, None]
    blocks[cuts, :, 0] = outward
    blocks[cuts, :, 1] = outward[:, ::-1] * [-1.0, 1.0]
    freedoms = np.arange(2 * len(mesh.nodes))
    return assembled(blocks, freedoms.reshape(-1, 2), freedoms.size).tocsc()


def plane_freedoms(nodes: Index) -> Index:
    """Freedoms in x and y of nodes (n,)."""
    return (2 * nodes[:, None] + np.arange(2)).ravel()


def _summed(first: Array, sparse: Array) -> Array:
    """Product ``first.T @ sparse`` over the few rows where the second has entries."""
    rows = np.flatnonzero(np.any(sparse, axis=1))
    return np.asarray(first[rows].T @ sparse[rows])


@dataclass(frozen=True, eq=False)
class RingSolution:
    """Displacements of the ring under load cases that all act on the sector 0."""

    inside: Array  #: displacement of the inside of the sector 0 with the cuts held
    cuts: Array  #: displacement of the right cut of each sector, polar


class Ring:
    """Ring of equal sectors that is held along its inner circle."""

    def __init__(self, mesh: SectorMesh, elasticity: Array | None = None) -> None:
        self.mesh = mesh
        self._turn = _polar_on_cuts(mesh)
        matrix = sector_stiffness(
            mesh, plane_stress(1.0, 0.3) if elasticity is None else elasticity
        )
        boundary = np.concatenate([mesh.right_cut, mesh.left_cut])
        inner = np.setdiff1d(np.arange(len(mesh.nodes)), np.concatenate([boundary, mesh.fixed]))
        self._inner, self._boundary = plane_freedoms(inner), plane_freedoms(boundary)
        self._coupling = matrix[self._inner][:, self._boundary].toarray()
        self._edge = matrix[self._boundary][:, self._boundary].toarray()
        self._core = matrix[self._inner][:, self._inner]

    @cached_property
    def _factors(self) -> Any:
        return symmetric_factors(self._core)

    @cached_property
    def _inside_per_cut(self) -> Array:
        """Displacement of the inside per displacement of the cuts."""
        return self._solved(-self._coupling)

    def _solved(self, loads: Array) -> Array:
        """Displacement of the inside with the cuts held."""
        factors = self._factors
        parts = [
            factors.solve(np.ascontiguousarray(loads[:, first : first + _TOGETHER]))
            for first in range(0, loads.shape[1], _TOGETHER)
        ]
        return np.concatenate(parts, axis=1)

    def solve(self, loads: Array) -> RingSolution:
        """Displacements under loads on the sector 0."""
        inner = loads[self._inner]
        inside = self._solved(inner)
        force = _summed(self._inside_per_cut, inner) + (self._turn.T @ loads)[self._boundary]
        return RingSolution(inside, self._around(force))

    def _around(self, force: Array) -> Array:
        """Displacement of the right cut of each sector under forces on both cuts of sector 0."""
        condensed = self._edge + _summed(self._inside_per_cut, self._coupling)
        condensed = 0.5 * (condensed + condensed.T)
        half = condensed.shape[0] // 2
        right, left = slice(0, half), slice(half, None)
        count = self.mesh.count
        turn = np.exp(2j * np.pi * np.arange(count // 2 + 1) / count)[:, None, None]
        within = condensed[right, right] + condensed[left, left]
        onward = condensed[right, left]
        systems = within + onward * turn + onward.T * np.conj(turn)
        waves = np.linalg.solve(systems, force[right] + force[left] * np.conj(turn))
        return np.fft.irfft(waves, count, axis=0)

    def weighted_displacements(
        self, solution: RingSolution, weights: Array, sectors: Sequence[int]
    ) -> Array:
        """Weighted displacements of some sectors."""
        inner = weights[self._inner]
        on_cuts = (self._turn.T @ weights)[self._boundary]
        per_cut = _summed(self._inside_per_cut, inner) + on_cuts
        displacements = [self._both_cuts(solution, sector).T @ per_cut for sector in sectors]
        for place, sector in enumerate(sectors):
            if sector % self.mesh.count == 0:
                displacements[place] = displacements[place] + _summed(solution.inside, inner)
        return np.stack(displacements)

    def displacement(self, solution: RingSolution, sector: int) -> Array:
        """Displacements of all nodes of a sector in x and y of its own frame."""
        cuts = self._both_cuts(solution, sector)
        displacements = np.zeros((2 * len(self.mesh.nodes), cuts.shape[1]))
        displacements[self._boundary] = cuts
        displacements[self._inner] = self._inside_per_cut @ cuts
        if sector % self.mesh.count == 0:
            displacements[self._inner] += solution.inside
        return np.asarray(self._turn @ displacements)

    def _both_cuts(self, solution: RingSolution, sector: int) -> Array:
        count = self.mesh.count
        return np.concatenate([solution.cuts[sector % count], solution.cuts[(sector + 1) % count]])
