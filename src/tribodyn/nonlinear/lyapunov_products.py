"""Products of the matrices of many steps: after how many cycles they repeat, and their growth."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from tribodyn.types import Array

#: Mesh cycles after which matrices may repeat, and how closely.
_PERIODS, _REPEATS = 16, 1e-8
#: Blocks of the frame are apart when they exchange less than this.
_APART = 1e-10
#: A product whose singular values differ by more loses the small disturbances to rounding.
SPREAD = 1e6


def share_in(directions: Array, disturbances: Array) -> Array:
    """Part of the square of each disturbance (k, m) along orthonormal directions (k, b)."""
    inside = np.abs(directions.T @ disturbances) ** 2
    return np.asarray(inside.sum(axis=0) / (np.abs(disturbances) ** 2).sum(axis=0))


def repeats_after(cycles: Sequence[Array]) -> tuple[int, float]:
    """Return the number of mesh cycles after which the matrices repeat, and the difference."""
    matrices = np.asarray(cycles)
    size = np.linalg.norm(matrices, axis=(-2, -1))
    for period in range(1, min(_PERIODS, len(matrices) // 2) + 1):
        distance = (
            np.linalg.norm(matrices[period:] - matrices[:-period], axis=(-2, -1)) / size[period:]
        )
        if distance.max() <= _REPEATS:
            return period, float(distance.max())
    return 0, float("nan")


def floquet_growth(cycles: Sequence[Array], frame: Array, directions: Array) -> tuple[Array, Array]:
    """Growth of disturbances over one period, in the order of the frame; shares in directions."""
    old, uppers = frame, []
    for product in (product for groups in cycles for product in groups):
        frame, upper = np.linalg.qr(product @ frame)
        uppers.append(upper)
    turn = old.T @ frame
    size = turn.shape[0]
    edges = [0, *(i for i in range(1, size) if np.abs(turn[i:, :i]).max() < _APART), size]
    growth, share = np.zeros(size), np.zeros(size)
    for first, last in pairwise(edges):
        block, scale = np.eye(last - first), 0.0
        for upper in uppers:
            block = upper[first:last, first:last] @ block
            norm = float(np.linalg.norm(block))
            block, scale = block / norm, scale + float(np.log(norm))
        values, vectors = np.linalg.eig(turn[first:last, first:last] @ block)
        order = np.argsort(-np.abs(values), kind="stable")
        growth[first:last] = np.log(np.abs(values[order])) + scale
        share[first:last] = share_in(directions, old[:, first:last] @ vectors[:, order])
    return growth, share


def _pairwise(matrices: Array) -> Array:
    """Products of neighbours (cycles, steps, k, k), the later step on the left."""
    if matrices.shape[1] % 2:
        unit = np.broadcast_to(np.eye(matrices.shape[-1]), (len(matrices), 1, *matrices.shape[2:]))
        matrices = np.concatenate((matrices, unit), axis=1)
    return np.asarray(matrices[:, 1::2] @ matrices[:, ::2])


def safe_length(matrices: Array) -> int:
    """Steps that may be multiplied before disturbances are made orthogonal again."""
    product, length = matrices[None], 1
    while product.shape[1] > 1:
        longer = _pairwise(product)
        if not np.all(np.linalg.cond(longer) <= SPREAD):
            break
        product, length = longer, 2 * length
    return length


def grouped_products(matrices: Array, length: int) -> Array:
    """Products of every ``length`` steps of every mesh cycle."""
    while length > 1:
        matrices, length = _pairwise(matrices), length // 2
    return matrices
