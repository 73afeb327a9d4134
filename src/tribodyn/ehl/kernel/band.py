"""LU factors of a band matrix with partial pivoting, inside a compiled kernel."""

from __future__ import annotations

import numba as nb

from tribodyn.ehl.kernel.options import INNER
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
