"""Linear systems with the tangent."""

from __future__ import annotations

from typing import Any

import numba as nb
import numpy as np

from tribodyn.ehl._kernel.elementary import BURIED
from tribodyn.ehl._kernel.factors import band_factor, band_solve, lu_factor, lu_solve
from tribodyn.ehl._kernel.film_sum import film_plan, film_sum, film_work_size, influence
from tribodyn.ehl._kernel.reynolds import coefficients, mobility, oil_state
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


#: Half bandwidth of the preconditioner.
HALF_BAND = 7
#: Vectors of the Krylov space before it is restarted, and how often it is.
BASIS, RESTARTS = 30, 6
# Rows of the scratch array: the first eight belong to Newton's method; scale of the rows, band
# inverse of the column of H0, a vector on all nodes and its film, room; three more of Newton's
# method; then the Krylov vectors.
_SCALE, _BORDER, _VECTOR, _RISE, _ROOM = 8, 9, 10, 11, 12
_FIRST = 16


@nb.njit(**BURIED)
def newton_work(n: int) -> Any:
    """Room for :func:`~tribodyn.ehl._kernel.newton.newton_level` on ``n`` intervals."""
    return (
        np.zeros((_FIRST + BASIS + 1, n + 2)),
        np.empty((n + 1, 4)),
        np.empty((n + 1, 4)),
        np.empty((n + 1, 4 * HALF_BAND + 1)),
        np.empty(n + 1, np.int64),
        np.empty(film_work_size(n)),
        np.empty((BASIS + 4, BASIS + 2)),
    )


@nb.njit(**BURIED)
def prepare(
    n: int, dx: float, k: int, imposed: bool, K: Array, cH: Array, cP: Array, work: Any
) -> bool:
    """Scale the rows of the tangent and factor its band; False if that is singular."""
    rows, band, pivot = work[0], work[3], work[4]
    scale, border = rows[_SCALE], rows[_BORDER]
    w = HALF_BAND
    # Influence of the node in column c on the film at the node i-2+s, the same in every row.
    near = np.empty((4, 2 * w + 1))
    for s in range(4):
        for c in range(2 * w + 1):
            near[s, c] = K[min(abs(w - c + s - 2), n)]
    for i in range(1, k + 1):
        a = band[i - 1]
        h0, h1, h2, h3 = cH[i, 0], cH[i, 1], cH[i, 2], cH[i, 3]
        for c in range(2 * w + 1):
            a[c] = h0 * near[0, c] + h1 * near[1, c] + h2 * near[2, c] + h3 * near[3, c]
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
    if not band_factor(k, w, band, pivot):
        return False
    if imposed:
        band_solve(k, w, band, pivot, border)
        total = 0.0
        for i in range(k):
            total += border[i]
        border[k] = dx * total
        return border[k] != 0.0 and np.isfinite(border[k])
    return True


@nb.njit(inline="always", **BURIED)
def _precondition(
    n: int, dx: float, k: int, imposed: bool, cH: Array, cP: Array, target: float, coarse: Any,
    work: Any, z: Array,
) -> None:  # fmt: skip
    """Overwrite scaled rows 1..k by the correction; ``target`` is its share of the load."""
    rows = work[0]
    border, room = rows[_BORDER], rows[_ROOM]
    if coarse[0].size > 0:
        target -= correct(n, dx, k, imposed, cH, cP, rows[_SCALE], target, coarse, work[5], z, room)
    band_solve(k, HALF_BAND, work[3], work[4], z)
    if imposed:
        total = 0.0
        for i in range(k):
            total += z[i]
        offset = (dx * total - target) / border[k]
        for i in range(k):
            z[i] -= offset * border[i]
        z[k] = offset
    if coarse[0].size > 0:
        for i in range(k + 1 if imposed else k):
            z[i] += room[i]


@nb.njit(inline="always", **BURIED)
def _apply(
    n: int, k: int, imposed: bool, K: Array, plan: Array, cH: Array, cP: Array, work: Any,
    x: Array, y: Array,
) -> None:  # fmt: skip
    """Rows 1..k of the tangent times ``x``, scaled."""
    rows = work[0]
    p, h, scale = rows[_VECTOR], rows[_RISE], rows[_SCALE]
    p[0] = 0.0
    for i in range(k):
        p[i + 1] = x[i]
    for i in range(k + 1, n + 1):
        p[i] = 0.0
    film_sum(n, K, plan, p, work[5], h)
    if imposed:
        offset = x[k]
        for i in range(n + 1):
            h[i] += offset
    y[0] = scale[0] * (
        cH[1, 1] * h[0] + cH[1, 2] * h[1] + cH[1, 3] * h[2] + cP[1, 2] * p[1] + cP[1, 3] * p[2]
    )
    for i in range(2, k + 1):
        y[i - 1] = scale[i - 1] * (
            cH[i, 0] * h[i - 2] + cH[i, 1] * h[i - 1] + cH[i, 2] * h[i] + cH[i, 3] * h[i + 1]
            + cP[i, 0] * p[i - 2] + cP[i, 1] * p[i - 1] + cP[i, 2] * p[i] + cP[i, 3] * p[i + 1]
        )  # fmt: skip


@nb.njit(**BURIED)
def linear_solve(
    n: int, dx: float, k: int, imposed: bool, K: Array, plan: Array, cH: Array, cP: Array,
    tolerance: float, coarse: Any, work: Any, rhs: Array, x: Array,
) -> int:  # fmt: skip
    """Solve ``J x = rhs`` by GMRES after :func:`prepare`.

    Parameters
    ----------
    n, dx : int, float
        Grid.
    k : int
        Last free node.
    imposed : bool
        Whether the offset is an unknown and the load a row.
    K, plan : array
        Influence, see :mod:`tribodyn.ehl._kernel.film_sum`.
    cH, cP : (n + 1, 4) arrays
        Tangent.
    tolerance : float
        Norm of the preconditioned residual over that of the first correction.
    coarse : tuple
        Tangent of a coarse grid, see :mod:`tribodyn.ehl._kernel.linear_solver`.
    work : tuple
        From :func:`newton_work`.
    rhs, x : (n + 2,) arrays
        Right-hand side, rows 1..k of the mass balance first, then the load row; solution, the
        pressures at the nodes 1..k first, then the offset.

    Returns
    -------
    int
        Products with the tangent, negative if the tolerance is not reached.

    Notes
    -----
    Saad and Schultz, GMRES, 1986; classical Gram-Schmidt, done twice.
    """
    rows, small = work[0], work[6]
    scale, room = rows[_SCALE], rows[_ROOM]
    # Hessenberg columns in small[:, j]; rotations, right-hand side.
    cosine, sine, g = small[BASIS + 1], small[BASIS + 2], small[BASIS + 3]
    size = k + 1 if imposed else k
    products, used, goal, begun = 0, 0, 0.0, False
    for _ in range(RESTARTS * (BASIS + 1)):
        # The first correction, which alone meets the load row; then the residual where a space
        # begins, or the product with its last vector.
        v = rows[_FIRST + used] if begun else x
        if begun:
            old = x if used == 0 else rows[_FIRST + used - 1]
            _apply(n, k, imposed, K, plan, cH, cP, work, old, v)
            products += 1
        if used == 0:
            for i in range(k):
                v[i] = scale[i] * rhs[i] - (v[i] if begun else 0.0)
        target = 0.0 if begun else rhs[k]
        _precondition(n, dx, k, imposed, cH, cP, target, coarse, work, v)
        if not begun:
            begun = True
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
                older, share = rows[_FIRST + m], 0.0
                for i in range(size):
                    share += older[i] * v[i]
                room[m] = share
            for m in range(used):
                older, share = rows[_FIRST + m], room[m]
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
                    value -= small[i, m] * room[m]
                room[i] = value / small[i, i]
            for m in range(used):
                older, share = rows[_FIRST + m], room[m]
                for i in range(size):
                    x[i] += share * older[i]
            if left <= goal:
                return products
            used = 0
        else:
            used += 1
    return -products
