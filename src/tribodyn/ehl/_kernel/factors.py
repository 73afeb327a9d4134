"""Factors of a band and of a dense matrix, by elimination with partial pivoting.

A step of a band's elimination needs what the one before has just written. In arrays that would
have to be stored and read again, one place further on, for which a processor waits longer than it
computes. So the solution keeps what it still needs in variables, and is written out for one band.
"""

from __future__ import annotations

import numba as nb

from tribodyn.ehl._kernel.elementary import INNER, STRICT
from tribodyn.types import Array, Index

#: Half bandwidth, for which :func:`band_solve` is written out.
HALF_BAND = 7
#: Numbers in a row: the band with the margin for pivoting, and multipliers of the rows below.
BAND_ROW = 4 * HALF_BAND + 1


@nb.njit(**INNER)
def band_factor(n: int, a: Array, pivot: Index) -> bool:
    """Factor a matrix of half bandwidth :data:`HALF_BAND` in place; the diagonal is inverted."""
    w = HALF_BAND
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
        row[0] = inverse
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
def _forward(n: int, a: Array, pivot: Index, b: Array) -> None:
    """Eliminate the right-hand side as the rows were."""
    last = n - 1
    b0, b1, b2, b3 = b[0], b[min(1, last)], b[min(2, last)], b[min(3, last)]
    b4, b5, b6, b7 = b[min(4, last)], b[min(5, last)], b[min(6, last)], b[min(7, last)]
    for k in range(n):
        # Mostly the row below is the pivot, or the row itself.
        ahead = pivot[k] - k
        if ahead == 1:
            b0, b1 = b1, b0
        elif ahead == 2:
            b0, b2 = b2, b0
        elif ahead == 3:
            b0, b3 = b3, b0
        elif ahead == 4:
            b0, b4 = b4, b0
        elif ahead == 5:
            b0, b5 = b5, b0
        elif ahead == 6:
            b0, b6 = b6, b0
        elif ahead == 7:
            b0, b7 = b7, b0
        b[k] = b0
        # What comes in behind the last row is never a pivot, and goes out unused.
        m, following = a[k, 3 * HALF_BAND + 1 :], b[min(k + 8, last)]
        b1, b2, b3 = b1 - m[0] * b0, b2 - m[1] * b0, b3 - m[2] * b0
        b4, b5, b6 = b4 - m[3] * b0, b5 - m[4] * b0, b6 - m[5] * b0
        b7 -= m[6] * b0
        b0, b1, b2, b3, b4, b5, b6, b7 = b1, b2, b3, b4, b5, b6, b7, following


@nb.njit(**STRICT)
def _backward(n: int, a: Array, b: Array) -> None:
    """Find the unknowns from the last to the first; the sum ends with the one found last."""
    x1 = x2 = x3 = x4 = x5 = x6 = x7 = x8 = x9 = x10 = x11 = x12 = x13 = x14 = 0.0
    for k in range(n - 1, -1, -1):
        r = a[k, HALF_BAND:]
        value = b[k] - r[14] * x14 - r[13] * x13 - r[12] * x12 - r[11] * x11
        outer_terms = r[10] * x10 + r[9] * x9 + r[8] * x8 + r[7] * x7
        middle_terms = r[6] * x6 + r[5] * x5 + r[4] * x4 + r[3] * x3
        x = ((value - outer_terms) - (middle_terms + r[2] * x2) - r[1] * x1) * r[0]
        b[k] = x
        x14, x13, x12, x11, x10, x9, x8 = x13, x12, x11, x10, x9, x8, x7
        x7, x6, x5, x4, x3, x2, x1 = x6, x5, x4, x3, x2, x1, x


@nb.njit(**INNER)
def band_solve(n: int, a: Array, pivot: Index, b: Array) -> None:
    """Solve with the factors of :func:`band_factor`; ``b`` becomes the solution."""
    _forward(n, a, pivot, b)
    _backward(n, a, b)


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
