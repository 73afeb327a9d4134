"""One instant of a transient contact: Newton's method with cavities anywhere.

A steady film parts once, at the outlet. A film that is unloaded quickly also ruptures inside: the
nodes of such a cavity have the pressure zero, and their mass balance leaves oil missing.
"""

from __future__ import annotations

from typing import Any

import numba as nb
import numpy as np

from tribodyn.ehl._kernel.elementary import BURIED
from tribodyn.ehl._kernel.film_sum import film_sum
from tribodyn.ehl._kernel.linear_solver import linear_solve, newton_work, no_coarse, prepare
from tribodyn.ehl._kernel.newton import (
    CONVERGED,
    GAP,
    NOT_FINITE,
    ROUNDED,
    SINGULAR,
    STALLED,
)
from tribodyn.ehl._kernel.reynolds import coefficients, mobility, oil_state, residual
from tribodyn.ehl._kernel.transfer import extend
from tribodyn.types import Array

# Rows of the scratch array.
_LNETA, _DLNETA, _RHO, _DRHO, _EPS, _F, _G, _RHS, _DELTA, _VECTOR, _RISE, _VISITS = range(12)
#: Change of the pressure that rounding alone makes.
_ROUNDING = 1e-13
#: How often a node may fill again before it stays in its cavity.
_RETURNS = 10.0
#: Least part of the thinnest film that a step leaves.
_LEFT = 0.3


@nb.njit(**BURIED)
def instant_work(n: int) -> Any:
    """Room for :func:`solve_instant` on ``n`` intervals."""
    return (newton_work(n), np.zeros((12, n + 2)))


@nb.njit(**BURIED)
def _step_length(n: int, k: int, cap: float, delta: Array, rise: Array, H: Array) -> float:
    """Greatest step that changes no pressure by more than ``cap`` and keeps the gap open."""
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
        if thinnest > _LEFT * least:
            return step
        step *= 0.5
    return 0.0


@nb.njit(**BURIED)
def _balance_error(
    k: int, squeeze: float, cavity: Array, rho: Array, H: Array, rows: Array
) -> float:
    """Sum of the mass balances of the free nodes over the mean flux, or over the squeezed oil."""
    wrong, flux, squeezed = 0.0, 0.0, 0.0
    for i in range(1, k + 1):
        flux += abs(rows[_F, i])
        squeezed += squeeze * rho[i] * H[i]
        if cavity[i] == 0.0 or rows[_G, i] < 0.0:
            wrong += abs(rows[_G, i])
    return wrong / max(flux / k, 1e-3 * squeezed)


@nb.njit(**BURIED)
def _refill(k: int, streak: int, cavity: Array, visits: Array, G: Array) -> bool:
    """Fill cavities from those of their nodes where oil is left over: one more node, two, four."""
    filled, i = False, 1
    while i <= k:
        if cavity[i] == 0.0 or G[i] >= 0.0 or visits[i] >= _RETURNS:
            i += 1
            continue
        # The cavity fills from the side of its free neighbour.
        way = -1 if cavity[i - 1] > 0.0 and cavity[i + 1] == 0.0 else 1
        node, left = i, min(2**streak, k)
        while left > 0 and 1 <= node <= k and cavity[node] > 0.0 and visits[node] < _RETURNS:
            cavity[node], filled = 0.0, True
            visits[node] += 1.0
            node += way
            left -= 1
        i = max(i, node) + 1 if way > 0 else i + 1
    return filled


@nb.njit(**BURIED)
def solve_instant(
    n: int, dx: float, lam: float, u: float, squeeze: float, load: float, imposed: bool,
    tail: float, oil: Array, shape: Array, history: Array, K: Array, plan: Array, limits: Array,
    work: Any, P: Array, H: Array, cavity: Array, state: Array,
) -> int:  # fmt: skip
    """Solve one instant from a state nearby."""
    krylov, rows = work
    cH, cP = krylov[1], krylov[2]
    rho, drho, eps, F, G = rows[_RHO], rows[_DRHO], rows[_EPS], rows[_F], rows[_G]
    rhs, delta, vector, rise = rows[_RHS], rows[_DELTA], rows[_VECTOR], rows[_RISE]
    visits = rows[_VISITS]
    H0, k = state[0], min(max(int(state[1]), 2), n - 1)
    P[0] = tail
    for i in range(n + 1):
        visits[i] = 0.0
        if i > k:
            P[i], cavity[i] = 0.0, 0.0
    streak, refills, moved, change, step, fresh = 0, 0, False, 1.0, 1.0, True
    status = STALLED
    for steps in range(int(limits[2]) + 1):
        if fresh:
            film_sum(n, K, plan, P, krylov[5], H)
            for i in range(n + 1):
                H[i] += H0 + shape[i]
        oil_state(n, P, oil, rows[_LNETA], rows[_DLNETA], rho, drho)
        mobility(n, H, lam, rows[_LNETA], rho, eps)
        residual(n, dx, u, squeeze, history, P, H, rho, eps, F, G)
        if steps > 0:
            if not moved and change < 0.1:
                if _refill(k, refills, cavity, visits, G):
                    moved = True
                    refills += 1
                if k < n - 1 and G[k + 1] < 0.0:
                    further = extend(n, k, streak)
                    if visits[further] < 2.0:
                        k, moved = further, True
                        streak += 1
                        visits[k] += 1.0
            state[3] = change
            state[4] = _balance_error(k, squeeze, cavity, rho, H, rows)
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
        coefficients(n, dx, lam, u, squeeze, P, H, rows[_DLNETA], rho, drho, eps, cH, cP)
        total = 0.5 * P[0]
        for i in range(1, k + 1):
            rhs[i - 1] = -G[i]
            total += P[i]
            if cavity[i] > 0.0:
                rhs[i - 1] = -P[i]
                for s in range(4):
                    cH[i, s] = cP[i, s] = 0.0
                cP[i, 2] = 1.0
        # An imposed offset is approached together with the pressure that keeps the film open.
        shift = 0.0 if imposed else load - H0
        if shift != 0.0:
            for i in range(1, k + 1):
                rhs[i - 1] -= shift * (cH[i, 0] + cH[i, 1] + cH[i, 2] + cH[i, 3])
        rhs[k] = load - dx * total
        if not prepare(n, dx, k, imposed, K, cH, cP, krylov):
            status = SINGULAR
            break
        products = linear_solve(
            n, dx, k, imposed, K, plan, cH, cP, limits[3], no_coarse(), krylov, rhs, delta
        )
        state[6] += abs(products)
        # Film of the whole step: the line search and the next film need no further sum.
        vector[0] = 0.0
        for i in range(k):
            vector[i + 1] = delta[i]
        for i in range(k + 1, n + 1):
            vector[i] = 0.0
        film_sum(n, K, plan, vector, krylov[5], rise)
        if imposed:
            shift = delta[k]
        for i in range(n + 1):
            rise[i] += shift
        step = _step_length(n, k, limits[4], delta, rise, H)
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
        H0 = load if not imposed and step == 1.0 else H0 + step * shift
        moved = False
        for i in range(1, k + 1):
            if P[i] < 0.0:
                cavity[i], P[i], moved, refills = 1.0, 0.0, True, 0
        while k > 2 and cavity[k] > 0.0:
            cavity[k], streak = 0.0, 0
            k -= 1
        fresh = moved
        if not moved:
            for i in range(n + 1):
                H[i] += step * rise[i]
    total = 0.5 * P[0]
    for i in range(1, k + 1):
        total += P[i]
    state[0], state[1], state[5] = H0, float(k), dx * total
    return status
