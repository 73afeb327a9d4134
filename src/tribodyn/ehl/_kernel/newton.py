"""Newton's method for the pressure on one grid, with the free outlet."""

from __future__ import annotations

from typing import Any

import numba as nb
import numpy as np

from tribodyn.ehl._kernel.elementary import BURIED
from tribodyn.ehl._kernel.film_sum import film_sum
from tribodyn.ehl._kernel.linear_solver import linear_solve, prepare
from tribodyn.ehl._kernel.reynolds import coefficients, mobility, oil_state, residual
from tribodyn.ehl._kernel.transfer import cut_negative, extend
from tribodyn.types import Array

CONVERGED, STALLED, GAP, SINGULAR, NOT_FINITE, ROUNDED = 0, 1, 2, 3, 4, 5

# Rows of the scratch array; 8 to 12 and those from 16 on belong to the linear solver, which
# leaves 10 and 11 to others between its calls.
_LNETA, _DLNETA, _RHO, _DRHO, _EPS, _F, _G, _RHS = 0, 1, 2, 3, 4, 5, 6, 7
_VECTOR, _RISE, _DELTA, _VISITS = 10, 11, 13, 14

#: A change of the pressure that rounding alone makes.
_ROUNDING = 1e-13


@nb.njit(**BURIED)
def flux_error(k: int, work: Any) -> float:
    """Greatest deviation of the summed mass balance from its mean, over the mean flux."""
    F, G = work[0][_F], work[0][_G]
    total, mean, flux, highest = 0.0, 0.0, 0.0, 0.0
    for i in range(k + 1):
        total += G[i]
        mean += total
        flux += F[i]
        highest = max(highest, abs(F[i]))
    mean /= k + 1
    # A contact that is only squeezed has no mean flux.
    unit = max(abs(flux) / (k + 1), 0.1 * highest)
    total, worst = 0.0, 0.0
    for i in range(k + 1):
        total += G[i]
        worst = max(worst, abs(total - mean))
    return worst / unit


@nb.njit(**BURIED)
def _step_length(n: int, k: int, cap: float, H: Array, work: Any) -> float:
    """Greatest step that changes no pressure by more than ``cap`` and keeps the gap open."""
    rows = work[0]
    delta, rise = rows[_DELTA], rows[_RISE]
    largest, least = 0.0, H[0]
    for i in range(k):
        largest = max(largest, abs(delta[i]))
    for i in range(n + 1):
        least = min(least, H[i])
    step = 1.0 if largest <= cap else cap / largest
    for _ in range(12):
        thinnest = H[0] + step * rise[0]
        for i in range(n + 1):
            thinnest = min(thinnest, H[i] + step * rise[i])
        if thinnest > 0.3 * least:
            return step
        step *= 0.5
    return 0.0


@nb.njit(**BURIED)
def newton_level(
    n: int, dx: float, lam: float, u: float, squeeze: float, load: float, imposed: bool,
    tail: float, oil: Array, shape: Array, history: Array, K: Array, plan: Array, limits: Array,
    coarse: Any, work: Any, P: Array, H: Array, state: Array,
) -> int:  # fmt: skip
    """Solve one grid from a given pressure."""
    rows, cH, cP = work[0], work[1], work[2]
    F, G, rhs, delta = rows[_F], rows[_G], rows[_RHS], rows[_DELTA]
    vector, rise, visits = rows[_VECTOR], rows[_RISE], rows[_VISITS]
    H0, k = state[0], min(max(int(state[1]), 2), n - 1)
    P[0] = tail
    for i in range(k + 1, n + 1):
        P[i] = 0.0
    for i in range(n + 1):
        visits[i] = 0.0
    # Typed: a literal would make the compiler translate the callee anew.
    streak: Any = np.int64(0)
    moved, change, step, status = False, 1.0, 1.0, STALLED
    fresh = True
    for steps in range(int(limits[2]) + 1):
        if fresh:
            film_sum(n, K, plan, P, work[5], H)
            state[7] += 1.0
            for i in range(n + 1):
                H[i] += H0 + shape[i]
        oil_state(n, P, oil, rows[_LNETA], rows[_DLNETA], rows[_RHO], rows[_DRHO])
        mobility(n, H, lam, rows[_LNETA], rows[_RHO], rows[_EPS])
        residual(n, dx, u, squeeze, history, P, H, rows[_RHO], rows[_EPS], F, G)
        if steps > 0:
            # No growth on to a node from which the outlet has already come back twice.
            if not moved and change < 0.1 and k < n - 1 and G[k + 1] < 0.0:
                further = extend(n, k, streak)
                if visits[further] < 2.0:
                    k, moved = further, True
                    streak += 1
            visits[k] += 1.0 if moved else 0.0
            state[3], state[4] = change, flux_error(k, work)
            if step == 1.0 and not moved and change < limits[0]:
                if state[4] < limits[1]:
                    status = CONVERGED
                    break
                if change < _ROUNDING:
                    status = ROUNDED
                    break
        if steps == int(limits[2]):
            break
        state[2] = steps + 1.0
        coefficients(
            n, dx, lam, u, squeeze, P, H, rows[_DLNETA], rows[_RHO], rows[_DRHO], rows[_EPS],
            cH, cP,
        )  # fmt: skip
        if not prepare(n, dx, k, imposed, K, cH, cP, work):
            status = SINGULAR
            break
        total = 0.5 * P[0]
        for i in range(k):
            rhs[i] = -G[i + 1]
            total += P[i + 1]
        rhs[k] = load - dx * total
        # Where many steps are needed, the linear solver is often what holds them up.
        tolerance = limits[3] * max(1e-4, 0.3 ** max(0, steps - 3))
        products = linear_solve(
            n, dx, k, imposed, K, plan, cH, cP, tolerance, coarse, work, rhs, delta
        )
        # Film of the whole step: the line search and the next film need no further sum.
        vector[0] = 0.0
        for i in range(k):
            vector[i + 1] = delta[i]
        for i in range(k + 1, n + 1):
            vector[i] = 0.0
        film_sum(n, K, plan, vector, work[5], rise)
        state[6] += abs(products)
        state[7] += abs(products) + 1.0
        if imposed:
            for i in range(n + 1):
                rise[i] += delta[k]
        step = _step_length(n, k, limits[4], H, work)
        if step == 0.0:
            status = GAP
            break
        change, total = 0.0, abs(P[0])
        for i in range(k):
            P[i + 1] += step * delta[i]
            change += abs(step * delta[i])
            total += abs(P[i + 1])
        change /= total
        if not np.isfinite(change):
            status = NOT_FINITE
            break
        if imposed:
            H0 += step * delta[k]
        before = k
        k = cut_negative(n, k, change, P)
        moved = fresh = k < before
        if moved:
            streak = np.int64(0)
        else:
            for i in range(n + 1):
                H[i] += step * rise[i]
    total = 0.5 * P[0]
    for i in range(1, k + 1):
        total += P[i]
    state[0], state[1], state[5] = H0, float(k), dx * total
    return status
