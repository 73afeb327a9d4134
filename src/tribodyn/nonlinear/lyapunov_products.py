"""Products of the matrices of many steps, as long as rounding allows."""

from __future__ import annotations

import numpy as np

from tribodyn.types import Array

#: A product whose singular values differ by more loses the small disturbances to rounding.
_SPREAD = 1e6


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
        if not np.all(np.linalg.cond(longer) <= _SPREAD):
            break
        product, length = longer, 2 * length
    return length


def grouped_products(matrices: Array, length: int) -> Array:
    """Products of every ``length`` steps of every mesh cycle."""
    while length > 1:
        matrices, length = _pairwise(matrices), length // 2
    return matrices
