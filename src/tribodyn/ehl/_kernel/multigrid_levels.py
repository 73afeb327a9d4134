"""What a V cycle of full multigrid does on one of its grids.

Relaxation is distributive and by lines: one banded solve over all free nodes. Where the oil is
stiff a change of the pressure at one node bends the film everywhere, so that a band cannot hold
its effect. There a node takes its change half from each of its neighbours: the film of such a
dipole fades with the square of the distance. The coarsest grid is solved for pressure and rigid
offset under the load by dense factors.
"""

from __future__ import annotations

from typing import NamedTuple

import numba as nb
import numpy as np

from tribodyn.ehl._kernel.elementary import INNER, STRICT
from tribodyn.ehl._kernel.factors import lu_factor, lu_solve
from tribodyn.ehl._kernel.film_sum import Grid, film_sum, film_work_size, influence
from tribodyn.ehl._kernel.newton import CONVERGED, GAP, SINGULAR
from tribodyn.ehl._kernel.reynolds import Fields, fill_oil, fill_tangent, make_fields, residual
from tribodyn.types import Array, Index

#: Intervals to which a change of the pressure bends the film within the sweep.
NEAR = 5
#: Half bandwidths: the residual of a node has the films of i-2 to i+1.
LEFT, RIGHT = NEAR + 2, NEAR + 1
_WIDTH = LEFT + RIGHT + 1


#: Steps on the coarsest grid at most, greatest change in a step, and part of the first correction
#: that ends them.
_STEPS, _CAP, _ENOUGH = 12, 0.2, 1e-2
#: Factor by which a step with old factors has to shrink, or they are computed again.
_SHRINK = 0.2


class Level(NamedTuple):
    """One grid of the cycle."""

    grid: Grid
    P: Array
    H: Array
    injected: Array  #: pressure that came from the finer grid
    target: Array  #: residual to be reached
    excess: Array  #: film beyond that of the pressure, from the finer grid
    shape: Array  #: gap of the undeformed bodies
    near_films: Array  #: films of a node and of a dipole, of :func:`near_influence`


class CoarsestWork(NamedTuple):
    """Factors of the tangent on the coarsest grid, and vectors of its solve."""

    factors: Array
    pivot: Index
    scale: Array
    delta: Array
    pressure: Array
    factored: Index  #: free nodes for which the factors hold, zero for none


class LevelWork(NamedTuple):
    """Arrays that the grids of a cycle use in turn, and what they share."""

    lam: float
    oil: Array
    fields: Fields
    none: Array  #: no history
    by_film: Array  #: tangent
    by_pressure: Array
    transform: Array  #: of the film sum
    band: Array
    dipole: Array
    delta: Array
    before: Array  #: pressure before the cycle
    offset: Array  #: rigid offset of the film, one number
    coarsest: CoarsestWork


@nb.njit(**INNER)
def level_work(n: int, coarsest: int, lam: float, oil: Array) -> LevelWork:
    """Arrays for the finest grid of ``n`` intervals and the coarsest one."""
    a, m = np.zeros((4, n + 2)), coarsest + 1
    pivot, numbers, factored = np.empty(m, np.int64), np.empty((3, m)), np.zeros(1, np.int64)
    dense = CoarsestWork(np.empty((m, m)), pivot, numbers[0], numbers[1], numbers[2], factored)
    return LevelWork(
        lam, oil, make_fields(n), a[0], np.empty((n + 1, 4)), np.empty((n + 1, 4)),
        np.empty(film_work_size(n)), np.empty((n, LEFT + RIGHT + 1)), a[1], a[2], a[3],
        np.zeros(1), dense,
    )  # fmt: skip


@nb.njit(**INNER)
def fill_film(level: Level, offset: float, work: LevelWork) -> None:
    """Film, oil, mobility, fluxes and residual of the pressure of a grid."""
    grid, H = level.grid, level.H
    film_sum(grid.n, grid.influence, grid.plan, level.P, work.transform, H)
    for i in range(grid.n + 1):
        H[i] += offset + level.shape[i] + level.excess[i]
    fill_balance(level, work)


@nb.njit(**INNER)
def fill_balance(level: Level, work: LevelWork) -> None:
    """Oil, mobility, fluxes and residual of pressure and film of a grid."""
    n, f = level.grid.n, work.fields
    fill_oil(n, work.lam, work.oil, level.P, level.H, f)
    residual(n, level.grid.dx, 1.0, 0.0, work.none, level.P, level.H, f)


@nb.njit(**INNER)
def fill_level_tangent(level: Level, work: LevelWork) -> None:
    """Tangent about pressure and film of a grid."""
    n, dx, H, fields = level.grid.n, level.grid.dx, level.H, work.fields
    fill_tangent(n, dx, 1.0, 0.0, level.P, H, fields, work.by_film, work.by_pressure)


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


@nb.njit(**INNER)
def near_influence(dx: float, films: Array) -> None:
    """Film of a single node and of a dipole, up to ``NEAR`` intervals away and zero beyond."""
    K = influence(NEAR + 1, dx)
    for s in range(4):
        for c in range(_WIDTH):
            d = abs(s - 2 - c + LEFT)
            films[0, s, c] = K[d] if d <= NEAR else 0.0
            films[1, s, c] = K[d] - 0.5 * (K[abs(d - 1)] + K[d + 1]) if d <= NEAR else 0.0


@nb.njit(**INNER)
def assemble_band(k: int, dipole: Array, films: Array, cH: Array, cP: Array, band: Array) -> None:
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
            film = films[1] if inside > 0.0 else films[0]
            for c in range(_WIDTH):
                row[c] = h0 * film[0, c] + h1 * film[1, c] + h2 * film[2, c] + h3 * film[3, c]
        else:
            for c in range(_WIDTH):
                j = i + c - LEFT
                film = films[1] if 1 <= j <= k and dipole[j] > 0.0 else films[0]
                row[c] = h0 * film[0, c] + h1 * film[1, c] + h2 * film[2, c] + h3 * film[3, c]
        if inside == _WIDTH:
            # Every node of the row takes its change half from each of its neighbours.
            p0, p1, p2, p3 = cP[i, 0], cP[i, 1], cP[i, 2], cP[i, 3]
            row[LEFT - 3] -= 0.5 * p0
            row[LEFT - 2] += p0 - 0.5 * p1
            row[LEFT - 1] += p1 - 0.5 * (p0 + p2)
            row[LEFT] += p2 - 0.5 * (p1 + p3)
            row[LEFT + 1] += p3 - 0.5 * p2
            row[LEFT + 2] -= 0.5 * p3
            continue
        for s in range(4):
            j, value = i - 2 + s, cP[i, s]
            c = LEFT - 2 + s
            if 1 <= j <= k:
                row[c] += value
            # The dipoles next to node j take half of their strength from it.
            if j >= 1:
                row[c - 1] -= 0.5 * value * dipole[min(j - 1, k)]
            if 0 <= j < k:
                row[c + 1] -= 0.5 * value * dipole[j + 1]


@nb.njit(**INNER)
def _less(
    f: float, u: Array, a: float, b: float, c: float, d: float, e: float, g: float
) -> tuple[float, float, float, float, float, float]:
    """Six numbers of a row less ``f`` times those behind the diagonal of an earlier row."""
    return a - f * u[1], b - f * u[2], c - f * u[3], d - f * u[4], e - f * u[5], g - f * u[6]


@nb.njit(**INNER)
def _eliminate(k: int, band: Array, x: Array) -> None:
    """Subtract the seven rows before from every row, which leaves the inverse of its diagonal.

    A row stays in variables: in its array every step would wait for the one before to be stored.
    """
    for i in range(min(LEFT, k)):
        for c in range(LEFT - i):
            band[i, c] = 0.0
    for i in range(k):
        r, y = band[i], x[i]
        a0, a1, a2, a3, a4, a5, a6, a7 = r[0], r[1], r[2], r[3], r[4], r[5], r[6], r[7]
        b1, b2, b3, b4, b5 = r[8], r[9], r[10], r[11], r[12]
        # Before the first row there is none, and nothing to subtract.
        p7, p6, p5, p4 = max(i - 7, 0), max(i - 6, 0), max(i - 5, 0), max(i - 4, 0)
        p3, p2, p1 = max(i - 3, 0), max(i - 2, 0), max(i - 1, 0)
        f = a0 * band[p7, LEFT]
        y -= f * x[p7]
        a1, a2, a3, a4, a5, a6 = _less(f, band[p7, LEFT:], a1, a2, a3, a4, a5, a6)
        f = a1 * band[p6, LEFT]
        y -= f * x[p6]
        a2, a3, a4, a5, a6, a7 = _less(f, band[p6, LEFT:], a2, a3, a4, a5, a6, a7)
        f = a2 * band[p5, LEFT]
        y -= f * x[p5]
        a3, a4, a5, a6, a7, b1 = _less(f, band[p5, LEFT:], a3, a4, a5, a6, a7, b1)
        f = a3 * band[p4, LEFT]
        y -= f * x[p4]
        a4, a5, a6, a7, b1, b2 = _less(f, band[p4, LEFT:], a4, a5, a6, a7, b1, b2)
        f = a4 * band[p3, LEFT]
        y -= f * x[p3]
        a5, a6, a7, b1, b2, b3 = _less(f, band[p3, LEFT:], a5, a6, a7, b1, b2, b3)
        f = a5 * band[p2, LEFT]
        y -= f * x[p2]
        a6, a7, b1, b2, b3, b4 = _less(f, band[p2, LEFT:], a6, a7, b1, b2, b3, b4)
        f = a6 * band[p1, LEFT]
        a7, b1, b2, b3, b4, b5 = _less(f, band[p1, LEFT:], a7, b1, b2, b3, b4, b5)
        r[7], x[i] = 1.0 / a7, y - f * x[p1]
        r[8], r[9], r[10], r[11], r[12] = b1, b2, b3, b4, b5


@nb.njit(**STRICT)
def _substitute(k: int, band: Array, x: Array) -> None:
    """Find the unknowns from the last to the first; the sum ends with the one found last."""
    x1 = x2 = x3 = x4 = x5 = x6 = 0.0
    for i in range(k - 1, -1, -1):
        r = band[i, LEFT:]
        outer_terms = r[6] * x6 + r[5] * x5 + r[4] * x4
        value = (((x[i] - outer_terms) - (r[3] * x3 + r[2] * x2)) - r[1] * x1) * r[0]
        x[i] = value
        x6, x5, x4, x3, x2, x1 = x5, x4, x3, x2, x1, value


@nb.njit(**INNER)
def solve_band(k: int, band: Array, x: Array) -> None:
    """Gaussian elimination in node order; ``x`` is the right side, then the solution."""
    _eliminate(k, band, x)
    _substitute(k, band, x)


@nb.njit(**INNER)
def relax(level: Level, k: int, least: float, damping: float, cap: float, work: LevelWork) -> float:
    """One sweep: pressures that meet the residual within the band; the greatest change."""
    P, G, eps, right = level.P, work.fields.G, work.fields.eps, level.target
    dipole, delta, band = work.dipole, work.delta, work.band
    for j in range(k + 2):
        dipole[j] = 1.0 if 2 <= j < k and eps[j] < least else 0.0
    assemble_band(k, dipole, level.near_films, work.by_film, work.by_pressure, band)
    x = delta[1:]
    for i in range(1, k + 1):
        delta[i] = right[i] - G[i]
    solve_band(k, band, x)
    largest, before = 0.0, 0.0
    for i in range(1, k + 1):
        correction = delta[i]
        # Half of the dipoles on both sides; the one behind is still as solved.
        after = 0.5 * dipole[i + 1] * delta[i + 1] if i < k else 0.0
        delta[i] = correction - before - after
        before = 0.5 * dipole[i] * correction
        largest = max(largest, abs(delta[i]))
    step = damping if damping * largest <= cap else cap / largest
    for i in range(1, k + 1):
        P[i] += step * delta[i]
    return step * largest


@nb.njit(**INNER)
def _factor(k: int, level: Level, work: LevelWork) -> bool:
    """Factor the tangent with the offset as last unknown and the load as last row."""
    K, cH, cP = level.grid.influence, work.by_film, work.by_pressure
    a, pivot, scale = work.coarsest.factors, work.coarsest.pivot, work.coarsest.scale
    for i in range(1, k + 1):
        row = a[i - 1]
        h0, h1, h2, h3 = cH[i, 0], cH[i, 1], cH[i, 2], cH[i, 3]
        for j in range(1, k + 1):
            d = i - j
            inner_terms = h1 * K[abs(d - 1)] + h2 * K[abs(d)]
            row[j - 1] = inner_terms + (h0 * K[abs(d - 2)] + h3 * K[abs(d + 1)])
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
def solve_coarsest(level: Level, k: int, load: float, work: LevelWork) -> int:
    """Newton's method for pressure and offset at fixed free nodes; factors are reused."""
    n, dx, P, H, right = level.grid.n, level.grid.dx, level.P, level.H, level.target
    dense, offset, G = work.coarsest, work.offset, work.fields.G
    scale, delta, before, factored = dense.scale, dense.delta, dense.pressure, dense.factored
    first, last = -1.0, -1.0
    for _ in range(_STEPS):
        if factored[0] != k:
            fill_level_tangent(level, work)
            factored[0] = 0
            if not _factor(k, level, work):
                return SINGULAR
            factored[0] = k
        total = 0.5 * P[0]
        for i in range(1, n):
            total += P[i]
        for i in range(1, k + 1):
            delta[i - 1] = scale[i] * (right[i] - G[i])
        delta[k] = load / dx - total
        lu_solve(k + 1, dense.factors, dense.pivot, delta)
        size, least = 0.0, H[0]
        for i in range(k + 1):
            size = max(size, abs(delta[i]))
        for i in range(n + 1):
            least = min(least, H[i])
            before[i] = P[i]
        step = 1.0 if size <= _CAP else _CAP / size
        rigid, is_open = offset[0], False
        for _trial in range(8):
            for i in range(1, k + 1):
                P[i] = before[i] + step * delta[i - 1]
            offset[0] = rigid + step * delta[k]
            fill_film(level, offset[0], work)
            thinnest = H[0]
            for i in range(n + 1):
                thinnest = min(thinnest, H[i])
            if thinnest > 0.3 * least or least <= 0.0:
                is_open = True
                break
            step *= 0.5
        if not is_open:
            factored[0] = 0
            return GAP
        if first < 0.0:
            first = size
        if size <= _ENOUGH * first or size < 1e-13:
            return CONVERGED
        if step < 1.0 or (last >= 0.0 and size > _SHRINK * last):
            factored[0] = 0
        last = size
    return CONVERGED
