"""Correction of a linear solver on a coarse grid: the tangent there, dense and factored once.

It catches what the band of the fine tangent misses, the smooth part of the elastic deflection.
The state of the fine grid is injected; linear interpolation leads up and its transpose down.
"""

from __future__ import annotations

from typing import Any

import numba as nb
import numpy as np

from tribodyn.ehl.kernel.dense import lu_factor, lu_solve
from tribodyn.ehl.kernel.film_sum import film_plan, film_sum, influence
from tribodyn.ehl.kernel.oil import oil_state
from tribodyn.ehl.kernel.options import BURIED
from tribodyn.ehl.kernel.reynolds import coefficients, mobility
from tribodyn.types import Array


@nb.njit(**BURIED)
def no_coarse() -> Any:
    """No coarse grid."""
    return (np.empty((0, 0)), np.empty(0, np.int64), np.empty(0), np.empty(0), np.empty((0, 0)))


@nb.njit(**BURIED)
def coarse_tangent(
    n: int, dx: float, k: int, ratio: int, lam: float, u: float, squeeze: float, imposed: bool,
    oil: Array, P: Array, H: Array,
) -> Any:  # fmt: skip
    """Factor the tangent on the grid of ``n / ratio`` intervals about a state of the fine grid."""
    m, wide, last = n // ratio, ratio * dx, k // ratio
    rows = np.empty((7, m + 2))
    for i in range(m + 1):
        rows[0, i], rows[1, i] = P[ratio * i], H[ratio * i]
    p, h = rows[0, : m + 1], rows[1, : m + 1]
    cH, cP = np.empty((m + 1, 4)), np.empty((m + 1, 4))
    oil_state(m, p, oil, rows[2], rows[3], rows[4], rows[5])
    mobility(m, h, lam, rows[2], rows[4], rows[6])
    coefficients(m, wide, lam, u, squeeze, p, h, rows[3], rows[4], rows[5], rows[6], cH, cP)
    K = influence(m, wide)
    size = last + 1 if imposed else last
    a, pivot = np.zeros((size, size)), np.empty(m + 2, np.int64)
    for i in range(1, last + 1):
        row = a[i - 1]
        for s in range(4):
            node, factor = i - 2 + s, cH[i, s]
            if node < 0:
                continue
            for j in range(1, last + 1):
                row[j - 1] += factor * K[abs(node - j)]
            if 1 <= node <= last:
                row[node - 1] += cP[i, s]
            if imposed:
                row[last] += factor
    if imposed:
        for j in range(last):
            a[last, j] = wide
    if not lu_factor(size, a, pivot):
        return no_coarse()
    pivot[m + 1] = last
    return (a, pivot, K, film_plan(m, K), rows)


@nb.njit(inline="always", **BURIED)
def correct(
    n: int, dx: float, k: int, imposed: bool, cH: Array, cP: Array, scale: Array, target: float,
    coarse: Any, work: Array, z: Array, x: Array,
) -> float:  # fmt: skip
    """Coarse correction ``x`` of the scaled rows ``z``, which keep what it leaves over."""
    a, pivot, K, plan, rows = coarse
    m = K.size - 1
    ratio, last = n // m, pivot[m + 1]
    inverse = 1.0 / ratio
    r, p, h = rows[0], rows[1], rows[2]
    # Transposed interpolation of the unscaled rows.
    for i in range(m + 1):
        r[i] = 0.0
    for i in range(1, k + 1):
        c = i // ratio
        share = (i - c * ratio) * inverse
        value = z[i - 1] / scale[i - 1]
        r[c] += (1.0 - share) * value
        r[c + 1] += share * value
    for i in range(last):
        r[i] = r[i + 1]
    if imposed:
        r[last] = target
    lu_solve(last + 1 if imposed else last, a, pivot, r)
    p[0] = 0.0
    for i in range(last):
        p[i + 1] = r[i]
    for i in range(last + 1, m + 1):
        p[i] = 0.0
    film_sum(m, K, plan, p, work, h)
    offset = r[last] if imposed else 0.0
    for i in range(m + 1):
        h[i] += offset
    total = 0.0
    h0 = h1 = h[0]
    p0 = p1 = 0.0
    h2, p2 = h[0] + (h[1] - h[0]) * inverse, p[1] * inverse
    if ratio == 1:
        h2, p2 = h[1], p[1]
    for i in range(1, k + 1):
        c = (i + 1) // ratio
        share = (i + 1 - c * ratio) * inverse
        h3, p3 = h[c] + (h[min(c + 1, m)] - h[c]) * share, p[c] + (p[min(c + 1, m)] - p[c]) * share
        if i == k:
            p3 = 0.0
        x[i - 1] = p2
        total += p2
        z[i - 1] -= scale[i - 1] * (
            cH[i, 0] * h0 + cH[i, 1] * h1 + cH[i, 2] * h2 + cH[i, 3] * h3
            + cP[i, 0] * p0 + cP[i, 1] * p1 + cP[i, 2] * p2 + cP[i, 3] * p3
        )  # fmt: skip
        h0, h1, h2 = h1, h2, h3
        p0, p1, p2 = p1, p2, p3
    if imposed:
        x[k] = offset
    return dx * total
