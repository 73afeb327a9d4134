"""Elimination of the freedoms of a solid, group of elements by group of elements."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tribodyn.interrupt import single_blas_thread
from tribodyn.stiffness.fe3d.face import FaceBasis
from tribodyn.stiffness.fe3d.sections import SectionMatrices, SolidMatrices
from tribodyn.types import Array, Index


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
