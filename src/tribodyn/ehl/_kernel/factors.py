"""LU factors of band and dense matrices, inside compiled kernels that hold no lock."""

from __future__ import annotations

import numba as nb

from tribodyn.ehl._kernel.elementary import INNER
from tribodyn.types import Array, Index


@nb.njit(**INNER)
def band_factor(n: int, w: int, a: Array, pivot: Index) -> bool:
    """Factor a matrix of half bandwidth ``w`` in place."""
    for i in range(n):
        for c in range(2 * w + 1, 3 * w + 1):
            a[i, c] = 0.0
    for k in range(n):
        below = min(w, n - 1 - k)
        best, largest = k, abs(a[k, w])
        for r in range(k + 1, k + below + 1):
            size = abs(a[r, k - r + w])
            if size > largest:
                best, largest = r, size
        if not largest > 0.0:
            return False
        pivot[k] = best
        span = min(2 * w, n - 1 - k) + 1
        row = a[k, w : w + span]
        if best != k:
            other = a[best, k - best + w : k - best + w + span]
            for c in range(span):
                row[c], other[c] = other[c], row[c]
        inverse = 1.0 / row[0]
        multipliers = a[k, 3 * w + 1 :]
        for r in range(k + 1, k + below + 1):
            low = a[r, k - r + w : k - r + w + span]
            factor = low[0] * inverse
            multipliers[r - k - 1] = factor
            if factor != 0.0:
                for c in range(1, span):
                    low[c] -= factor * row[c]
    return True


@nb.njit(**INNER)
def band_solve(n: int, w: int, a: Array, pivot: Index, b: Array) -> None:
    """Solve with the factors of :func:`band_factor`; ``b`` becomes the solution."""
    for k in range(n):
        best = pivot[k]
        value = b[best]
        b[best] = b[k]
        b[k] = value
        span = min(w, n - 1 - k)
        below, multipliers = b[k + 1 : k + 1 + span], a[k, 3 * w + 1 : 3 * w + 1 + span]
        for r in range(span):
            below[r] -= multipliers[r] * value
    for k in range(n - 1, -1, -1):
        span = min(2 * w, n - 1 - k)
        known, row = b[k + 1 : k + 1 + span], a[k, w + 1 : w + 1 + span]
        value = b[k]
        for c in range(span):
            value -= row[c] * known[c]
        b[k] = value / a[k, w]


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
