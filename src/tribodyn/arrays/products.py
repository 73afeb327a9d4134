"""Products of a small matrix and many vectors."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from tribodyn.types import Array

#: Returns an array of a shape with undefined content.
Allocator = Callable[[tuple[int, ...]], Array]


def times(vectors: Array, matrix: Array, lead: int = 0, allocate: Allocator = np.empty) -> Array:
    """Matrix (m, n) times vectors (..., n); the first components of all results are contiguous.

    Sums and scalings of many vectors then run in long loops. The first ``lead`` axes are not
    interleaved; ``allocate`` provides the memory.
    """
    flat = vectors.reshape(*vectors.shape[:lead], -1, vectors.shape[-1])
    memory = allocate((*flat.shape[:-2], len(matrix), flat.shape[-2]))
    product = np.swapaxes(np.matmul(matrix, np.swapaxes(flat, -1, -2), out=memory), -1, -2)
    return np.asarray(product.reshape(*vectors.shape[:-1], len(matrix)))


def each_times(vectors: Array, matrix: Array) -> Array:
    """Vectors (..., n) times a matrix (n, m), each rounded alike whatever their number."""
    # BLAS chooses its kernels by the number of vectors, and these round differently.
    product = vectors[..., :1] * matrix[0]
    for i in np.flatnonzero(matrix[1:].any(axis=1)) + 1:
        product += vectors[..., i : i + 1] * matrix[i]
    return np.asarray(product)


def lengths(vectors: Array) -> Array:
    """Euclidean lengths of vectors (..., n), however large."""
    largest = np.abs(vectors).max(axis=-1, initial=1e-300)
    return np.asarray(largest * np.linalg.norm(vectors / largest[..., None], axis=-1))
