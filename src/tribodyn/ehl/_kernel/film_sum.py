"""Elastic deflection of the line contact: the sum of pressures with logarithmic influence.

``sum_j K_|i-j| P_j`` is a product with a Toeplitz matrix. On short grids it is summed
directly, on longer ones it becomes a product of Fourier transforms. A library transform would need
the interpreter, and with it the lock that keeps threads apart; the one here takes radix-4 passes
of Stockham, which need no reordering, with real and imaginary parts in arrays of their own, so
that the passes become vector instructions.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numba as nb
import numpy as np

from tribodyn.ehl._kernel.elementary import INNER
from tribodyn.types import Array


@nb.njit(**INNER)
def _half_circle(size: int, cosine: Array, sine: Array) -> None:
    """Fill in cosine and minus sine of pi j/size: the first quarter, and what reflects it."""
    quarter, half = size // 4, size // 2
    for j in range(quarter + 1):
        angle = math.pi * j / size
        cosine[j], sine[j] = math.cos(angle), -math.sin(angle)
    for j in range(quarter + 1, half + 1):
        cosine[j], sine[j] = -sine[half - j], -cosine[half - j]
    for j in range(half + 1, size):
        cosine[j], sine[j] = -cosine[size - j], sine[size - j]


@nb.njit(**INNER)
def _first_pass(size: int, x: Array, y: Array, table: Array) -> None:
    """Radix-4 pass with stride 1."""
    m = size // 4
    xr, xi, yr, yi = x[0], x[1], y[0], y[1]
    for p in range(m):
        ar, ai = xr[p], xi[p]
        br, bi = xr[p + m], xi[p + m]
        cr, ci = xr[p + 2 * m], xi[p + 2 * m]
        dr, di = xr[p + 3 * m], xi[p + 3 * m]
        sr, si, tr, ti = ar + cr, ai + ci, ar - cr, ai - ci
        ur, ui, vr, vi = br + dr, bi + di, bi - di, dr - br
        yr[4 * p], yi[4 * p] = sr + ur, si + ui
        er, ei = tr + vr, ti + vi
        fr, fi = sr - ur, si - ui
        gr, gi = tr - vr, ti - vi
        cosine, sine = table[0, p], table[1, p]
        yr[4 * p + 1] = er * cosine - ei * sine
        yi[4 * p + 1] = er * sine + ei * cosine
        cosine, sine = table[0, 2 * p], table[1, 2 * p]
        yr[4 * p + 2] = fr * cosine - fi * sine
        yi[4 * p + 2] = fr * sine + fi * cosine
        cosine, sine = table[0, 3 * p], table[1, 3 * p]
        yr[4 * p + 3] = gr * cosine - gi * sine
        yi[4 * p + 3] = gr * sine + gi * cosine


@nb.njit(**INNER)
def _pass(m: int, stride: int, x: Array, y: Array, table: Array) -> None:
    """Radix-4 pass: the inner loop runs over neighbours that share their rotation."""
    quarter = m * stride
    for p in range(m):
        w1r, w1i = table[0, p * stride], table[1, p * stride]
        w2r, w2i = table[0, 2 * p * stride], table[1, 2 * p * stride]
        w3r, w3i = table[0, 3 * p * stride], table[1, 3 * p * stride]
        a = p * stride
        ar_, ai_ = x[0, a : a + stride], x[1, a : a + stride]
        a += quarter
        br_, bi_ = x[0, a : a + stride], x[1, a : a + stride]
        a += quarter
        cr_, ci_ = x[0, a : a + stride], x[1, a : a + stride]
        a += quarter
        dr_, di_ = x[0, a : a + stride], x[1, a : a + stride]
        a = 4 * p * stride
        y0r, y0i = y[0, a : a + stride], y[1, a : a + stride]
        a += stride
        y1r, y1i = y[0, a : a + stride], y[1, a : a + stride]
        a += stride
        y2r, y2i = y[0, a : a + stride], y[1, a : a + stride]
        a += stride
        y3r, y3i = y[0, a : a + stride], y[1, a : a + stride]
        for q in range(stride):
            ar, ai, br, bi = ar_[q], ai_[q], br_[q], bi_[q]
            cr, ci, dr, di = cr_[q], ci_[q], dr_[q], di_[q]
            sr, si, tr, ti = ar + cr, ai + ci, ar - cr, ai - ci
            ur, ui, vr, vi = br + dr, bi + di, bi - di, dr - br
            y0r[q], y0i[q] = sr + ur, si + ui
            er, ei = tr + vr, ti + vi
            fr, fi = sr - ur, si - ui
            gr, gi = tr - vr, ti - vi
            y1r[q], y1i[q] = er * w1r - ei * w1i, er * w1i + ei * w1r
            y2r[q], y2i[q] = fr * w2r - fi * w2i, fr * w2i + fi * w2r
            y3r[q], y3i[q] = gr * w3r - gi * w3i, gr * w3i + gi * w3r


@nb.njit(**INNER)
def _last_pass(stride: int, x: Array, y: Array) -> None:
    """Radix-2 pass without rotation, for sizes that are no power of four."""
    for q in range(stride):
        ar, ai, br, bi = x[0, q], x[1, q], x[0, q + stride], x[1, q + stride]
        y[0, q], y[1, q] = ar + br, ai + bi
        y[0, q + stride], y[1, q + stride] = ar - br, ai - bi


@nb.njit(**INNER)
def transform(size: int, x: Array, y: Array, table: Array) -> bool:
    """Forward transform of ``x[0] + i x[1]`` for a size of 4 or more."""
    _first_pass(size, x, y, table)
    # Typed: a literal would make the compiler specialise the pass again.
    left, stride, in_x = size // 4, nb.int64(4), False
    while left >= 4:
        if in_x:
            _pass(left // 4, stride, x, y, table)
        else:
            _pass(left // 4, stride, y, x, table)
        left //= 4
        stride *= 4
        in_x = not in_x
    if left == 2:
        if in_x:
            _last_pass(stride, x, y)
        else:
            _last_pass(stride, y, x)
        in_x = not in_x
    return in_x


#: Intervals up to which the direct sum is faster.
DIRECT = 64


@nb.njit(**INNER)
def _antiderivative(x: float) -> float:
    """Integral of ln|x|: zero at zero."""
    return x * (math.log(abs(x)) - 1.0) if x != 0.0 else 0.0


@nb.njit(**INNER)
def influence(n: int, dx: float) -> Array:
    """Deflection at a distance of 0..n intervals from one node under unit pressure."""
    kernel, before = np.empty(n + 1), _antiderivative(-0.5 * dx)
    for m in range(n + 1):
        after = _antiderivative((m + 0.5) * dx)
        kernel[m] = -(after - before) / math.pi
        before = after
    return kernel


@nb.njit(**INNER)
def _half_size(n: int) -> int:
    """Half the length of the circular sum: long enough that nodes 0..n-1 do not wrap around."""
    size = 4
    while size < n:
        size *= 2
    return size


@nb.njit(**INNER)
def film_work_size(n: int) -> int:
    """Size of the work array of :func:`film_sum`."""
    return 1 if n <= DIRECT else 4 * _half_size(n)


@nb.njit(**INNER)
def film_plan(n: int, kernel: Array) -> Array:
    """Prepare :func:`film_sum` for one grid: rotations and the transform of the influence."""
    if n <= DIRECT:
        return np.empty(0)
    half = _half_size(n)
    plan = np.empty(2 * half + 2 * half + 2 * half + 2)
    table = plan[: 2 * half].reshape(2, half)
    turn = plan[2 * half : 4 * half].reshape(2, half)
    _half_circle(half, turn[0], turn[1])
    # The rotations of the transform go twice as far in each step: once round.
    for k in range(half // 2):
        table[0, k], table[1, k] = turn[0, 2 * k], turn[1, 2 * k]
        table[0, k + half // 2], table[1, k + half // 2] = -turn[0, 2 * k], -turn[1, 2 * k]
    # The influence is even: its transform of twice the length is real, and follows from the
    # packed transform of half of it.
    work = np.empty(4 * half)
    x, y = work[: 2 * half].reshape(2, half), work[2 * half :].reshape(2, half)
    for j in range(half):
        first, second = 2 * j, 2 * j + 1
        x[0, j] = kernel[min(min(first, 2 * half - first), n)]
        x[1, j] = kernel[min(min(second, 2 * half - second), n)]
    z = x if transform(half, x, y, table) else y
    spectrum = plan[4 * half : 6 * half + 1]
    spectrum[0], spectrum[half] = z[0, 0] + z[1, 0], z[0, 0] - z[1, 0]
    for k in range(1, half):
        # Even part plus rotated odd part; the imaginary part vanishes by symmetry.
        even = 0.5 * (z[0, k] + z[0, half - k])
        odd_r = 0.5 * (z[1, k] + z[1, half - k])
        odd_i = -0.5 * (z[0, k] - z[0, half - k])
        spectrum[k] = even + odd_r * turn[0, k] - odd_i * turn[1, k]
    return plan


@nb.njit(**INNER)
def _multiply(half: int, z: Array, turn: Array, spectrum: Array) -> None:
    """Multiply the packed transform of real numbers with a real spectrum, and swap its parts."""
    zero, last = spectrum[0] * (z[0, 0] + z[1, 0]), spectrum[half] * (z[0, 0] - z[1, 0])
    z[0, 0], z[1, 0] = 0.5 * (zero - last), 0.5 * (zero + last)
    for k in range(1, half // 2 + 1):
        o = half - k
        mean = 0.5 * (spectrum[k] + spectrum[o])
        half_difference = 0.5 * (spectrum[k] - spectrum[o])
        er, ei = 0.5 * (z[0, k] + z[0, o]), 0.5 * (z[1, k] - z[1, o])
        dr, di = 0.5 * (z[0, k] - z[0, o]), 0.5 * (z[1, k] + z[1, o])
        wr, wi = turn[0, k], turn[1, k]
        # E' = mean E - i d w D and D' = i d conj(w) E + mean D with the half difference d
        pr, pi = wr * dr - wi * di, wr * di + wi * dr
        qr, qi = wr * er + wi * ei, wr * ei - wi * er
        fr, fi = mean * er + half_difference * pi, mean * ei - half_difference * pr
        gr, gi = mean * dr - half_difference * qi, mean * di + half_difference * qr
        z[1, k], z[0, k] = fr + gr, fi + gi
        z[1, o], z[0, o] = fr - gr, gi - fi


@nb.njit(**INNER)
def film_sum(n: int, kernel: Array, plan: Array, P: Array, work: Array, out: Array) -> None:
    """Sum of the pressures with their influence at every node."""
    if plan.size == 0:
        for i in range(n + 1):
            total = 0.0
            for j in range(i):
                total += kernel[i - j] * P[j]
            for j in range(i, n):
                total += kernel[j - i] * P[j]
            out[i] = total
        return
    half = (plan.size - 2) // 6
    table = plan[: 2 * half].reshape(2, half)
    turn = plan[2 * half : 4 * half].reshape(2, half)
    spectrum = plan[4 * half : 6 * half + 1]
    x, y = work[: 2 * half].reshape(2, half), work[2 * half : 4 * half].reshape(2, half)
    for j in range(n // 2):
        x[0, j], x[1, j] = P[2 * j], P[2 * j + 1]
    for j in range(n // 2, half):
        x[0, j], x[1, j] = 0.0, 0.0
    if n % 2 == 1:
        x[0, n // 2] = P[n - 1]
    in_x = transform(half, x, y, table)
    z, scratch = (x, y) if in_x else (y, x)
    _multiply(half, z, turn, spectrum)
    result = z if transform(half, z, scratch, table) else scratch
    scale = 1.0 / half
    for j in range(n // 2):
        out[2 * j], out[2 * j + 1] = scale * result[1, j], scale * result[0, j]
    if n % 2 == 1:
        out[n - 1] = scale * result[1, n // 2]
    total = 0.0
    for j in range(n):
        total += kernel[n - j] * P[j]
    out[n] = total


class Grid(NamedTuple):
    """A uniform grid, and how its pressures bend the film."""

    n: int  #: intervals
    dx: float  #: width of an interval
    influence: Array  #: deflection at a distance of 0..n intervals under unit pressure
    plan: Array  #: of :func:`film_sum`


@nb.njit(**INNER)
def make_grid(n: int, dx: float) -> Grid:
    """Grid of ``n`` intervals."""
    kernel = influence(n, dx)
    return Grid(n, dx, kernel, film_plan(n, kernel))
