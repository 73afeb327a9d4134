"""Elastic deflection of the line contact: the sum of pressures with logarithmic influence.

``sum_j K_|i-j| P_j`` is a product with a Toeplitz matrix. On short grids it is summed as it
stands, on longer ones it becomes a product of Fourier transforms.
"""

from __future__ import annotations

import math

import numba as nb
import numpy as np

from tribodyn.ehl.kernel.options import INNER
from tribodyn.ehl.kernel.transform import transform, twiddles
from tribodyn.types import Array

#: Intervals up to which the direct sum is faster.
DIRECT = 64


@nb.njit(**INNER)
def _antiderivative(x: float) -> float:
    """Integral of ln|x|: zero at zero."""
    return x * (math.log(abs(x)) - 1.0) if x != 0.0 else 0.0


@nb.njit(**INNER)
def influence(n: int, dx: float) -> Array:
    """Deflection at a distance of 0..n intervals from one node under unit pressure."""
    kernel = np.empty(n + 1)
    for m in range(n + 1):
        difference = _antiderivative((m + 0.5) * dx) - _antiderivative((m - 0.5) * dx)
        kernel[m] = -difference / math.pi
    return kernel


@nb.njit(**INNER)
def _half_size(n: int) -> int:
    """Half the length of the circular sum: the nodes 0..n-1 do not reach round it."""
    size = 4
    while size < n:
        size *= 2
    return size


@nb.njit(**INNER)
def film_work_size(n: int) -> int:
    """Numbers of working room that :func:`film_sum` needs."""
    return 1 if n <= DIRECT else 4 * _half_size(n)


@nb.njit(**INNER)
def film_plan(n: int, kernel: Array) -> Array:
    """Prepare :func:`film_sum` for one grid: rotations and the transform of the influence."""
    if n <= DIRECT:
        return np.empty(0)
    half = _half_size(n)
    plan = np.empty(2 * half + 2 * half + 2 * half + 2)
    table = plan[: 2 * half].reshape(2, half)
    twiddles(half, table)
    turn = plan[2 * half : 4 * half].reshape(2, half)
    for k in range(half):
        angle = math.pi * k / half
        turn[0, k], turn[1, k] = math.cos(angle), -math.sin(angle)
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
        apart = 0.5 * (spectrum[k] - spectrum[o])
        er, ei = 0.5 * (z[0, k] + z[0, o]), 0.5 * (z[1, k] - z[1, o])
        dr, di = 0.5 * (z[0, k] - z[0, o]), 0.5 * (z[1, k] + z[1, o])
        wr, wi = turn[0, k], turn[1, k]
        # E' = mean E - i apart w D and D' = i apart conj(w) E + mean D
        pr, pi = wr * dr - wi * di, wr * di + wi * dr
        qr, qi = wr * er + wi * ei, wr * ei - wi * er
        fr, fi = mean * er + apart * pi, mean * ei - apart * pr
        gr, gi = mean * dr - apart * qi, mean * di + apart * qr
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
    z, room = (x, y) if in_x else (y, x)
    _multiply(half, z, turn, spectrum)
    result = z if transform(half, z, room, table) else room
    scale = 1.0 / half
    for j in range(n // 2):
        out[2 * j], out[2 * j + 1] = scale * result[1, j], scale * result[0, j]
    if n % 2 == 1:
        out[n - 1] = scale * result[1, n // 2]
    total = 0.0
    for j in range(n):
        total += kernel[n - j] * P[j]
    out[n] = total
