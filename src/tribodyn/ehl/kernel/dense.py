"""LU factors of a small dense matrix, inside a compiled kernel that holds no lock."""

from __future__ import annotations

import numba as nb

from tribodyn.ehl.kernel.options import INNER
from tribodyn.types import Array, Index


@nb.njit(**INNER)
def lu_factor(n: int, a: Array, pivot: Index) -> bool:
    """Factor a matrix in place with partial pivoting."""
    for k in range(n):
        best, largest = k, abs(a[k, k])
        for r in range(k + 1, n):
            size = abs(a[r, k])
            if size > largest:
                best, largest = r, size
        if not largest > 0.0:
            return False
        pivot[k] = best
        if best != k:
            for c in range(n):
                a[k, c], a[best, c] = a[best, c], a[k, c]
        row = a[k, k + 1 :]
        inverse = 1.0 / a[k, k]
        for r in range(k + 1, n):
            factor = a[r, k] * inverse
            a[r, k] = factor
            low = a[r, k + 1 :]
            for c in range(n - k - 1):
                low[c] -= factor * row[c]
    return True


@nb.njit(**INNER)
def lu_solve(n: int, a: Array, pivot: Index, b: Array) -> None:
    """Solve with the factors of :func:`lu_factor`; ``b`` becomes the solution."""
    for k in range(n):
        best = pivot[k]
        if best != k:
            b[k], b[best] = b[best], b[k]
    for k in range(n):
        value = b[k]
        for c in range(k):
            value -= a[k, c] * b[c]
        b[k] = value
    for k in range(n - 1, -1, -1):
        value = b[k]
        for c in range(k + 1, n):
            value -= a[k, c] * b[c]
        b[k] = value / a[k, k]
