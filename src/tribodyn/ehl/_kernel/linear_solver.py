"""Linear systems with the tangent of the discrete contact: GMRES, preconditioned.

The unknowns are the changes of pressure at the nodes 1..k and, where the load is imposed, of the
rigid offset H0. The influence decays away from the diagonal, so that the tangent cut to a band is
a good preconditioner. On fine grids it is joined by the tangent on a coarse grid, dense and
factored once, which catches what the band misses: the smooth part of the elastic deflection. The
load row is exact in both and holds after every iteration.
"""

from __future__ import annotations

from typing import NamedTuple

import numba as nb
import numpy as np

from tribodyn.ehl._kernel.elementary import INNER
from tribodyn.ehl._kernel.factors import (
    BAND_ROW,
    HALF_BAND,
    band_factor,
    band_solve,
    lu_factor,
    lu_solve,
)
from tribodyn.ehl._kernel.film_sum import Grid, film_sum, film_work_size, make_grid
from tribodyn.ehl._kernel.reynolds import fill_oil, fill_tangent, make_fields
from tribodyn.types import Array, Index

#: Vectors of the Krylov space before it is restarted, and how often it is.
BASIS, RESTARTS = 30, 6


class CoarseTangent(NamedTuple):
    """Factors of the tangent on a coarse grid, and vectors for its correction."""

    grid: Grid
    last: int  #: last free node
    factors: Array  #: empty: no coarse grid
    pivot: Index
    right: Array
    pressure: Array
    film: Array


class LinearWork(NamedTuple):
    """Tangent, its factored band, and vectors of the linear solver."""

    by_film: Array  #: slopes of the balance over the film at four nodes
    by_pressure: Array  #: and over the pressure
    band: Array
    pivot: Index
    scale: Array  #: factors of the rows
    border: Array  #: inverse of the band times the column of the offset
    pressure: Array  #: a change of the pressure at all nodes
    film: Array  #: and of the film that it makes
    correction: Array  #: that of the coarse grid
    basis: Array  #: Krylov vectors
    small: Array  #: Hessenberg columns, rotations, right-hand side
    transform: Array  #: of :func:`film_sum`


class System(NamedTuple):
    """A tangent after :func:`prepare`."""

    grid: Grid
    k: int  #: last free node
    imposed: bool  #: whether the load is imposed
    coarse: CoarseTangent
    work: LinearWork


@nb.njit(**INNER)
def linear_work(n: int) -> LinearWork:
    """Arrays of the linear solver on ``n`` intervals."""
    a = np.zeros((5, n + 2))
    return LinearWork(
        np.empty((n + 1, 4)), np.empty((n + 1, 4)), np.empty((n + 1, BAND_ROW)),
        np.empty(n + 1, np.int64), a[0], a[1], a[2], a[3], a[4],
        np.zeros((BASIS + 1, n + 2)), np.empty((BASIS + 4, BASIS + 2)),
        np.empty(film_work_size(n)),
    )  # fmt: skip


@nb.njit(**INNER)
def no_coarse() -> CoarseTangent:
    """No coarse grid."""
    none, zero = np.empty(0), nb.int64(0)
    grid = Grid(zero, nb.float64(0.0), none, none)
    return CoarseTangent(grid, zero, np.empty((0, 0)), np.empty(0, np.int64), none, none, none)


@nb.njit(**INNER)
def coarse_tangent(
    n: int, dx: float, k: int, ratio: int, lam: float, u: float, squeeze: float, imposed: bool,
    oil: Array, P: Array, H: Array,
) -> CoarseTangent:  # fmt: skip
    """Factor the tangent on the grid of ``n / ratio`` intervals about a state of the fine grid."""
    m, last = n // ratio, k // ratio
    grid = make_grid(m, ratio * dx)
    p, h, f = np.empty(m + 2), np.empty(m + 2), make_fields(m)
    for i in range(m + 1):
        p[i], h[i] = P[ratio * i], H[ratio * i]
    cH, cP = np.empty((m + 1, 4)), np.empty((m + 1, 4))
    fill_oil(m, lam, oil, p, h, f)
    fill_tangent(m, grid.dx, u, squeeze, p, h, f, cH, cP)
    K = grid.influence
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
            a[last, j] = grid.dx
    if not lu_factor(size, a, pivot):
        return no_coarse()
    return CoarseTangent(grid, last, a, pivot, np.empty(m + 2), p, h)


@nb.njit(**INNER)
def _correct(system: System, target: float, z: Array) -> float:
    """Coarse correction of the scaled rows ``z``, which keep what it leaves over; its load."""
    fine, k, imposed, coarse, work = system
    cH, cP, scale, x = work.by_film, work.by_pressure, work.scale, work.correction
    r, p, h = coarse.right, coarse.pressure, coarse.film
    m, last = coarse.grid.n, coarse.last
    ratio = fine.n // m
    inverse = 1.0 / ratio
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
    lu_solve(last + 1 if imposed else last, coarse.factors, coarse.pivot, r)
    p[0] = 0.0
    for i in range(last):
        p[i + 1] = r[i]
    for i in range(last + 1, m + 1):
        p[i] = 0.0
    film_sum(m, coarse.grid.influence, coarse.grid.plan, p, work.transform, h)
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
            cH[i, 0] * h0
            + cH[i, 1] * h1
            + cH[i, 2] * h2
            + cH[i, 3] * h3
            + cP[i, 0] * p0
            + cP[i, 1] * p1
            + cP[i, 2] * p2
            + cP[i, 3] * p3
        )
        h0, h1, h2 = h1, h2, h3
        p0, p1, p2 = p1, p2, p3
    if imposed:
        x[k] = offset
    return fine.dx * total


@nb.njit(**INNER)
def prepare(grid: Grid, k: int, imposed: bool, work: LinearWork) -> bool:
    """Scale the rows of the tangent and factor its band; False if that is singular."""
    cH, cP, band, pivot = work.by_film, work.by_pressure, work.band, work.pivot
    scale, border = work.scale, work.border
    K, w = grid.influence, HALF_BAND
    # Influence of the node in column c on the film at the node i-2+s, the same in every row.
    node_film = np.empty((4, 2 * w + 1))
    for s in range(4):
        for c in range(2 * w + 1):
            node_film[s, c] = K[min(abs(w - c + s - 2), grid.n)]
    for i in range(1, k + 1):
        a = band[i - 1]
        h0, h1, h2, h3 = cH[i, 0], cH[i, 1], cH[i, 2], cH[i, 3]
        for c in range(2 * w + 1):
            a[c] = (
                h0 * node_film[0, c]
                + h1 * node_film[1, c]
                + h2 * node_film[2, c]
                + h3 * node_film[3, c]
            )
        for s in range(4):
            a[w - 2 + s] += cP[i, s]
        largest = 0.0
        for c in range(2 * w + 1):
            largest = max(largest, abs(a[c]))
        if not largest > 0.0:
            return False
        factor = 1.0 / largest
        scale[i - 1] = factor
        for c in range(2 * w + 1):
            a[c] *= factor
        border[i - 1] = factor * (h0 + h1 + h2 + h3)
    if not band_factor(k, band, pivot):
        return False
    if imposed:
        band_solve(k, band, pivot, border)
        total = 0.0
        for i in range(k):
            total += border[i]
        border[k] = grid.dx * total
        return border[k] != 0.0 and np.isfinite(border[k])
    return True


@nb.njit(**INNER)
def _precondition(system: System, target: float, z: Array) -> None:
    """Overwrite scaled rows 1..k by the correction; ``target`` is its share of the load."""
    grid, k, imposed, coarse, work = system
    border, correction = work.border, work.correction
    if coarse.factors.size > 0:
        target -= _correct(system, target, z)
    band_solve(k, work.band, work.pivot, z)
    if imposed:
        total = 0.0
        for i in range(k):
            total += z[i]
        offset = (grid.dx * total - target) / border[k]
        for i in range(k):
            z[i] -= offset * border[i]
        z[k] = offset
    if coarse.factors.size > 0:
        for i in range(k + 1 if imposed else k):
            z[i] += correction[i]


@nb.njit(**INNER)
def film_change(grid: Grid, k: int, first: float, x: Array, work: LinearWork) -> None:
    """Film of a change of the pressures: that of node 0, then ``x`` at the nodes 1..k."""
    p = work.pressure
    p[0] = first
    for i in range(k):
        p[i + 1] = x[i]
    for i in range(k + 1, grid.n + 1):
        p[i] = 0.0
    film_sum(grid.n, grid.influence, grid.plan, p, work.transform, work.film)


@nb.njit(**INNER)
def _apply(system: System, x: Array, y: Array) -> None:
    """Rows 1..k of the tangent times ``x``, scaled."""
    grid, k, imposed, _, work = system
    cH, cP, p, h, scale = work.by_film, work.by_pressure, work.pressure, work.film, work.scale
    film_change(grid, k, 0.0, x, work)
    if imposed:
        offset = x[k]
        for i in range(grid.n + 1):
            h[i] += offset
    y[0] = scale[0] * (
        cH[1, 1] * h[0] + cH[1, 2] * h[1] + cH[1, 3] * h[2] + cP[1, 2] * p[1] + cP[1, 3] * p[2]
    )
    for i in range(2, k + 1):
        y[i - 1] = scale[i - 1] * (
            cH[i, 0] * h[i - 2]
            + cH[i, 1] * h[i - 1]
            + cH[i, 2] * h[i]
            + cH[i, 3] * h[i + 1]
            + cP[i, 0] * p[i - 2]
            + cP[i, 1] * p[i - 1]
            + cP[i, 2] * p[i]
            + cP[i, 3] * p[i + 1]
        )


@nb.njit(**INNER)
def linear_solve(system: System, tolerance: float, rhs: Array, x: Array) -> int:
    """Solve ``J x = rhs`` by GMRES after :func:`prepare`; products, negative where it fails.

    ``rhs`` has the rows 1..k of the mass balance first, then the load row; ``x`` receives the
    pressures at the nodes 1..k, then the offset. The tolerance is the norm of the preconditioned
    residual over that of the first correction. Classical Gram-Schmidt, done twice.
    Source: Saad and Schultz, GMRES, 1986.
    """
    _, k, imposed, _, work = system
    scale, basis, small, shares = work.scale, work.basis, work.small, work.correction
    # Hessenberg columns in small[:, j]; rotations, right-hand side.
    cosine, sine, g = small[BASIS + 1], small[BASIS + 2], small[BASIS + 3]
    size = k + 1 if imposed else k
    products, used, goal, started = 0, 0, 0.0, False
    for _ in range(RESTARTS * (BASIS + 1)):
        # The first correction, which alone meets the load row; then the residual where a space
        # begins, or the product with its last vector.
        v = basis[used] if started else x
        if started:
            old = x if used == 0 else basis[used - 1]
            _apply(system, old, v)
            products += 1
        if used == 0:
            for i in range(k):
                v[i] = scale[i] * rhs[i] - (v[i] if started else 0.0)
        target = 0.0 if started else rhs[k]
        _precondition(system, target, v)
        if not started:
            started = True
            for i in range(size):
                goal += x[i] * x[i]
            goal = tolerance * np.sqrt(goal)
            if goal == 0.0:
                return 0
            continue
        j = used - 1
        for i in range(used):
            small[i, j] = 0.0
        for _twice in range(2):
            for m in range(used):
                older, share = basis[m], 0.0
                for i in range(size):
                    share += older[i] * v[i]
                shares[m] = share
            for m in range(used):
                older, share = basis[m], shares[m]
                for i in range(size):
                    v[i] -= share * older[i]
                small[m, j] += share
        length = 0.0
        for i in range(size):
            length += v[i] * v[i]
        length = np.sqrt(length)
        if not np.isfinite(length):
            return -products
        if length > 0.0:
            inverse = 1.0 / length
            for i in range(size):
                v[i] *= inverse
        if used == 0:
            left = g[0] = length
        else:
            for i in range(j):
                a, b = small[i, j], small[i + 1, j]
                small[i, j] = cosine[i] * a + sine[i] * b
                small[i + 1, j] = cosine[i] * b - sine[i] * a
            diagonal = np.sqrt(small[j, j] * small[j, j] + length * length)
            if diagonal == 0.0:
                return -products
            cosine[j], sine[j] = small[j, j] / diagonal, length / diagonal
            small[j, j] = diagonal
            g[used] = -sine[j] * g[j]
            g[j] *= cosine[j]
            left = abs(g[used])
        if left <= goal or used == BASIS or length == 0.0:
            for i in range(used - 1, -1, -1):
                value = g[i]
                for m in range(i + 1, used):
                    value -= small[i, m] * shares[m]
                shares[i] = value / small[i, i]
            for m in range(used):
                older, share = basis[m], shares[m]
                for i in range(size):
                    x[i] += share * older[i]
            if left <= goal:
                return products
            used = 0
        else:
            used += 1
    return -products
