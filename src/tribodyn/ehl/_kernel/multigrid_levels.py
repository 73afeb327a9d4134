"""What a V cycle does on one grid."""

from __future__ import annotations

from typing import Any

import numba as nb
import numpy as np

from tribodyn.ehl._kernel.elementary import INNER
from tribodyn.ehl._kernel.factors import lu_factor, lu_solve
from tribodyn.ehl._kernel.film_sum import film_sum, influence
from tribodyn.ehl._kernel.newton import CONVERGED, GAP, SINGULAR
from tribodyn.ehl._kernel.reynolds import coefficients, mobility, oil_state, residual
from tribodyn.types import Array


@nb.njit(**INNER)
def inject(m: int, fine: Array, coarse: Array) -> None:
    """Take every other node: nodes 0..m of the coarse grid."""
    for i in range(m + 1):
        coarse[i] = fine[2 * i]


@nb.njit(**INNER)
def mean_gap(m: int, fine: Array, coarse: Array) -> None:
    """Heights on the coarse grid: a quarter, a half and a quarter of those of the fine one."""
    coarse[0] = (2.0 * fine[0] + fine[1]) / 3.0
    coarse[m] = (2.0 * fine[2 * m] + fine[2 * m - 1]) / 3.0
    for i in range(1, m):
        coarse[i] = 0.25 * (fine[2 * i - 1] + fine[2 * i + 1]) + 0.5 * fine[2 * i]


@nb.njit(**INNER)
def restrict_defect(m: int, k: int, right: Array, G: Array, coarse: Array) -> None:
    """Defect of the fine grid on the coarse one."""
    coarse[0] = coarse[m] = 0.0
    for i in range(1, m):
        j = 2 * i
        defect = 0.5 * (right[j - 1] - G[j - 1]) if j - 1 <= k else 0.0
        if j <= k:
            defect += right[j] - G[j]
        if j + 1 <= k:
            defect += 0.5 * (right[j + 1] - G[j + 1])
        coarse[i] = defect


@nb.njit(**INNER)
def add_correction(m: int, k: int, P: Array, injected: Array, fine: Array) -> None:
    """Add what the coarse grid changed to the free nodes of the fine one, linearly between."""
    before = P[0] - injected[0]
    for i in range(m):
        after = P[i + 1] - injected[i + 1]
        if 1 <= 2 * i <= k:
            fine[2 * i] += before
        if 2 * i + 1 <= k:
            fine[2 * i + 1] += 0.5 * (before + after)
        before = after


#: Intervals to which a change of the pressure bends the film within the sweep.
NEAR = 5
#: Half bandwidths: the residual of a node has the films of i-2 to i+1.
LEFT, RIGHT = NEAR + 2, NEAR + 1
_WIDTH = LEFT + RIGHT + 1


@nb.njit(**INNER)
def near_influence(dx: float, near: Array) -> None:
    """Film of a single node and of a dipole, up to ``NEAR`` intervals away and zero beyond."""
    K = influence(NEAR + 1, dx)
    for s in range(4):
        for c in range(_WIDTH):
            d = abs(s - 2 - c + LEFT)
            near[0, s, c] = K[d] if d <= NEAR else 0.0
            near[1, s, c] = K[d] - 0.5 * (K[abs(d - 1)] + K[d + 1]) if d <= NEAR else 0.0


@nb.njit(**INNER)
def assemble_band(k: int, dipole: Array, near: Array, cH: Array, cP: Array, band: Array) -> None:
    """Band of the tangent in the unknowns of the sweep, row ``i - 1`` for node i."""
    inside = 0.0
    for j in range(1, min(RIGHT, k) + 1):
        inside += dipole[j]
    for i in range(1, k + 1):
        # Dipoles within the band of this row.
        if i + RIGHT <= k:
            inside += dipole[i + RIGHT]
        if i - LEFT > 1:
            inside -= dipole[i - LEFT - 1]
        row = band[i - 1]
        h0, h1, h2, h3 = cH[i, 0], cH[i, 1], cH[i, 2], cH[i, 3]
        if inside == 0.0 or inside == _WIDTH:
            film = near[1] if inside > 0.0 else near[0]
            for c in range(_WIDTH):
                row[c] = h0 * film[0, c] + h1 * film[1, c] + h2 * film[2, c] + h3 * film[3, c]
        else:
            for c in range(_WIDTH):
                j = i + c - LEFT
                film = near[1] if 1 <= j <= k and dipole[j] > 0.0 else near[0]
                row[c] = h0 * film[0, c] + h1 * film[1, c] + h2 * film[2, c] + h3 * film[3, c]
        for s in range(4):
            j, value = i - 2 + s, cP[i, s]
            c = LEFT - 2 + s
            if 1 <= j <= k:
                row[c] += value
            # The dipoles beside node j take half of their strength from it.
            if j >= 1:
                row[c - 1] -= 0.5 * value * dipole[min(j - 1, k)]
            if 0 <= j < k:
                row[c + 1] -= 0.5 * value * dipole[j + 1]


@nb.njit(**INNER)
def solve_band(k: int, band: Array, x: Array) -> None:
    """Gaussian elimination in node order; ``x`` is the right side, then the solution."""
    for i in range(k):
        row = band[i]
        inverse, value = 1.0 / row[LEFT], x[i]
        for r in range(1, min(LEFT, k - 1 - i) + 1):
            low = band[i + r, LEFT - r :]
            factor = low[0] * inverse
            for c in range(1, RIGHT + 1):
                low[c] -= factor * row[LEFT + c]
            x[i + r] -= factor * value
    for i in range(k - 1, -1, -1):
        row, value = band[i], x[i]
        for c in range(1, min(RIGHT, k - 1 - i) + 1):
            value -= row[LEFT + c] * x[i + c]
        x[i] = value / row[LEFT]


@nb.njit(**INNER)
def relax(
    k: int, least: float, damping: float, cap: float, near: Array, cH: Array, cP: Array,
    eps: Array, G: Array, right: Array, dipole: Array, delta: Array, band: Array, P: Array,
) -> float:  # fmt: skip
    """One sweep: pressures that meet the residual within the band."""
    for j in range(k + 2):
        dipole[j] = 1.0 if 2 <= j < k and eps[j] < least else 0.0
    assemble_band(k, dipole, near, cH, cP, band)
    x = delta[1:]
    for i in range(1, k + 1):
        delta[i] = right[i] - G[i]
    solve_band(k, band, x)
    largest, before = 0.0, 0.0
    for i in range(1, k + 1):
        here = delta[i]
        # Half of the dipoles on both sides; the one behind is still as solved.
        after = 0.5 * dipole[i + 1] * delta[i + 1] if i < k else 0.0
        delta[i] = here - before - after
        before = 0.5 * dipole[i] * here
        largest = max(largest, abs(delta[i]))
    step = damping if damping * largest <= cap else cap / largest
    for i in range(1, k + 1):
        P[i] += step * delta[i]
    return step * largest


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
