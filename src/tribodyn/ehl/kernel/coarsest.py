"""The coarsest grid of the multigrid cycle: pressure and rigid offset under the load, dense."""

from __future__ import annotations

from typing import Any

import numba as nb
import numpy as np

from tribodyn.ehl.kernel.dense import lu_factor, lu_solve
from tribodyn.ehl.kernel.film_sum import film_sum
from tribodyn.ehl.kernel.newton import CONVERGED, GAP, SINGULAR
from tribodyn.ehl.kernel.oil import oil_state
from tribodyn.ehl.kernel.options import INNER
from tribodyn.ehl.kernel.reynolds import coefficients, mobility, residual
from tribodyn.types import Array

# Rows of the scratch array.
LNETA, DLNETA, RHO, DRHO, EPS, FLUX, BALANCE, NOUGHT = 0, 1, 2, 3, 4, 5, 6, 7
#: Steps at most, greatest change in a step, and part of the first correction that ends them.
_STEPS, _CAP, _ENOUGH = 12, 0.2, 1e-2
#: Factor by which a step with old factors has to shrink, lest they are made anew.
_SHRINK = 0.2


@nb.njit(**INNER)
def evaluate(
    n: int, dx: float, lam: float, oil: Array, offset: float, shape: Array, excess: Array,
    K: Array, plan: Array, rows: Array, room: Array, P: Array, H: Array,
) -> None:  # fmt: skip
    """Film, oil, mobility, fluxes and residual of a pressure on one grid."""
    film_sum(n, K, plan, P, room, H)
    for i in range(n + 1):
        H[i] += offset + shape[i] + excess[i]
    balance(n, dx, lam, oil, rows, P, H)


@nb.njit(**INNER)
def balance(n: int, dx: float, lam: float, oil: Array, rows: Array, P: Array, H: Array) -> None:
    """Oil, mobility, fluxes and residual of a pressure and a film; see :func:`evaluate`."""
    oil_state(n, P, oil, rows[LNETA], rows[DLNETA], rows[RHO], rows[DRHO])
    mobility(n, H, lam, rows[LNETA], rows[RHO], rows[EPS])
    residual(n, dx, 1.0, 0.0, rows[NOUGHT], P, H, rows[RHO], rows[EPS], rows[FLUX], rows[BALANCE])


@nb.njit(**INNER)
def coarsest_work(n: int) -> Any:
    """Room of :func:`solve_coarsest`: factors, row exchanges, row scales, correction, film."""
    return (
        np.empty((n + 1, n + 1)), np.empty(n + 1, np.int64), np.empty(n + 1), np.empty(n + 1),
        np.empty(n + 1), np.zeros(2, np.int64),
    )  # fmt: skip


@nb.njit(**INNER)
def _factor(k: int, K: Array, cH: Array, cP: Array, work: Any) -> bool:
    """Factor the tangent with the offset as last unknown and the load as last row."""
    a, pivot, scale = work[0], work[1], work[2]
    for i in range(1, k + 1):
        row = a[i - 1]
        h0, h1, h2, h3 = cH[i, 0], cH[i, 1], cH[i, 2], cH[i, 3]
        for j in range(1, k + 1):
            d = i - j
            near, far = h1 * K[abs(d - 1)] + h2 * K[abs(d)], h0 * K[abs(d - 2)] + h3 * K[abs(d + 1)]
            row[j - 1] = near + far
        for s in range(4):
            if 1 <= i - 2 + s <= k:
                row[i - 3 + s] += cP[i, s]
        row[k] = h0 + h1 + h2 + h3
        largest = 0.0
        for j in range(k + 1):
            largest = max(largest, abs(row[j]))
        if not largest > 0.0:
            return False
        scale[i] = 1.0 / largest
        for j in range(k + 1):
            row[j] *= scale[i]
    for j in range(k):
        a[k, j] = 1.0
    a[k, k] = 0.0
    return lu_factor(k + 1, a, pivot)


@nb.njit(**INNER)
def solve_coarsest(
    n: int, k: int, dx: float, lam: float, oil: Array, load: float, shape: Array, excess: Array,
    right: Array, K: Array, plan: Array, rows: Array, room: Array, cH: Array, cP: Array,
    work: Any, P: Array, H: Array, state: Array,
) -> int:  # fmt: skip
    """Newton's method for pressure and offset at fixed free nodes; factors kept while useful."""
    a, pivot, scale, delta, film, kept = work
    first, last = -1.0, -1.0
    for _ in range(_STEPS):
        if kept[0] != k:
            coefficients(
                n, dx, lam, 1.0, 0.0, P, H, rows[DLNETA], rows[RHO], rows[DRHO], rows[EPS], cH, cP
            )
            kept[0] = 0
            if not _factor(k, K, cH, cP, work):
                return SINGULAR
            kept[0] = k
            kept[1] += 1
        total = 0.5 * P[0]
        for i in range(1, n):
            total += P[i]
        for i in range(1, k + 1):
            delta[i - 1] = scale[i] * (right[i] - rows[BALANCE][i])
        delta[k] = load / dx - total
        lu_solve(k + 1, a, pivot, delta)
        size, least = 0.0, H[0]
        for i in range(k + 1):
            size = max(size, abs(delta[i]))
        for i in range(n + 1):
            least = min(least, H[i])
            film[i] = P[i]
        step = 1.0 if size <= _CAP else _CAP / size
        before, is_open = state[0], False
        for _trial in range(8):
            for i in range(1, k + 1):
                P[i] = film[i] + step * delta[i - 1]
            state[0] = before + step * delta[k]
            evaluate(n, dx, lam, oil, state[0], shape, excess, K, plan, rows, room, P, H)
            thinnest = H[0]
            for i in range(n + 1):
                thinnest = min(thinnest, H[i])
            if thinnest > 0.3 * least or least <= 0.0:
                is_open = True
                break
            step *= 0.5
        if not is_open:
            kept[0] = 0
            return GAP
        if first < 0.0:
            first = size
        if size <= _ENOUGH * first or size < 1e-13:
            return CONVERGED
        if step < 1.0 or (last >= 0.0 and size > _SHRINK * last):
            kept[0] = 0
        last = size
    return CONVERGED
