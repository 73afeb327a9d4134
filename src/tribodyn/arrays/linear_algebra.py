"""Products with many vectors, eigenvectors that rounding does not choose, and fast transforms."""

from __future__ import annotations

from collections.abc import Callable
from itertools import count
from typing import Any

import numpy as np

from tribodyn.types import Array, ComplexArray, Index

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
    """Vectors (..., n) times a matrix (n, m), each rounded the same whatever their number."""
    # BLAS chooses its kernels by the number of vectors, and these round differently.
    product = vectors[..., :1] * matrix[0]
    for i in np.flatnonzero(matrix[1:].any(axis=1)) + 1:
        product += vectors[..., i : i + 1] * matrix[i]
    return np.asarray(product)


def lengths(vectors: Array) -> Array:
    """Euclidean lengths of vectors (..., n), however large."""
    largest = np.abs(vectors).max(axis=-1, initial=1e-300)
    return np.asarray(largest * np.linalg.norm(vectors / largest[..., None], axis=-1))


def fast_length(least: int) -> int:
    """Least length from ``least`` on without prime factors above 5: its transform is fast."""
    return next(length for length in count(least) if not 30 ** length.bit_length() % length)


def periodic(at: Array, place: Array, values: Array, period: float = 1.0) -> Array:
    """Values (p, c) at places (p,), linear between samples (s, c) that repeat after a period."""
    return np.stack([np.interp(at, place, column, period=period) for column in values.T], axis=1)


def modes_of(stiffness: Array, mass: Array) -> tuple[Array, Array]:
    """Ascending squared frequencies and columns of shapes of unit mass, of symmetric matrices."""
    lower = np.linalg.cholesky(mass)
    reduced = np.linalg.solve(lower, np.linalg.solve(lower, stiffness).T)
    squares, columns = np.linalg.eigh(reduced)
    return squares, np.linalg.solve(lower.T, columns)


#: Residual of an eigenvalue over what is left to a limit.
_FAR = 0.02


def leading_eigenvalues(
    product: Callable[[Array], Array], start: Array, count: int, accuracy: float,
    none: float = 0.0, limit: float = 0.0,
) -> ComplexArray:  # fmt: skip
    """Eigenvalues of largest size of a linear map of vectors. Source: Arnoldi (1951).

    Residuals are less than a part of their size, than ``none``, an eigenvalue as good as none, or
    than a part of what is left to ``limit``.
    """
    size = start.size
    basis, upper = np.zeros((size + 1, size)), np.zeros((size + 1, size))
    basis[0] = start / np.linalg.norm(start)
    for k in range(1, size + 1):
        vector = product(basis[k - 1])
        for _ in range(2):  # twice is enough for orthogonality
            along = basis[:k] @ vector
            vector = vector - along @ basis[:k]
            upper[:k, k - 1] += along
        upper[k, k - 1] = length = np.linalg.norm(vector)
        values, vectors = np.linalg.eig(upper[:k, :k])
        first = np.argsort(-np.abs(values), kind="stable")[:count]
        left = length * np.abs(vectors[-1, first])
        size_of = np.abs(values[first])
        enough = np.maximum(np.maximum(accuracy * size_of, none), _FAR * (limit - size_of))
        settled = np.all(left <= enough)
        if k == size or (k > count and settled):
            break
        basis[k] = vector / (length or 1.0)
    return np.asarray(values[first], dtype=complex)


#: Distance of equal eigenvalues over their size, and over the largest one of all.
_EQUAL, _NOISE = 1e-9, 1e-13
#: Entries that differ by less than this part are equally large.
_ALIKE = 1e-6


def groups_of_equal(values: Array) -> list[Index]:
    """Numbers of the equal ones among ascending values, group by group."""
    distance = _EQUAL * np.abs(values[1:]) + _NOISE * np.abs(values).max(initial=0.0)
    return np.split(np.arange(values.size), np.flatnonzero(np.diff(values) > distance) + 1)


def leading(vectors: Any) -> Any:
    """First of the largest entries of each row (m, n), as a column (m, 1)."""
    size = np.abs(vectors)
    first = (size >= (1.0 - _ALIKE) * size.max(axis=1, keepdims=True)).argmax(axis=1)
    return np.take_along_axis(vectors, first[:, None], axis=1)


def standard_rotation(values: Array, vectors: Any) -> Any:
    """Rotation (m, m) of eigenvectors, rows (m, n), to a basis of equal ascending values (m,)."""
    # The first row of a group gets all of the column in which the group is largest, as a positive
    # entry, the next one of what is left, and so on: whatever their basis was.
    first = leading(vectors)[:, 0].conj()
    rotation = np.diag(first / np.where(first == 0.0, 1.0, np.abs(first)))
    for group in (each for each in groups_of_equal(values) if len(each) > 1):
        left = vectors[group]
        for row in group:
            size = np.linalg.norm(left, axis=0)
            column = int((size >= (1.0 - _ALIKE) * size.max()).argmax())
            rotation[row, group] = part = left[:, column].conj() / (size[column] or 1.0)
            left = left - np.outer(part.conj(), part @ left)
    return rotation
