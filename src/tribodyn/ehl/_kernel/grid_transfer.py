"""The free outlet, and a solution carried to other grids."""

from __future__ import annotations

import numba as nb
import numpy as np

from tribodyn.ehl._kernel.elementary import INNER
from tribodyn.types import Array


@nb.njit(**INNER)
def cut_negative(n: int, k: int, change: float, P: Array) -> int:
    """Last free node after all from the first negative pressure near the outlet are released."""
    first = k + 1
    for i in range(max(2, k - n // 16), k + 1):
        if P[i] < 0.0:
            first = i
            break
    last = first - 1
    if change > 0.3:
        last = max(last, k - max(1, n // 64))
    for i in range(last + 1, n + 1):
        P[i] = 0.0
    return last


@nb.njit(**INNER)
def extend(n: int, k: int, streak: int) -> int:
    """Last free node after the outlet has moved on: one node, then two, then four."""
    return min(n - 1, k + min(2**streak, max(1, n // 16)))


@nb.njit(**INNER)
def outlet_position(k: int, n: int, P: Array) -> float:
    """Index, with fraction, at which the pressure ends."""
    if k < 2 or not P[k] > 0.0 or not P[k - 1] > P[k]:
        return float(min(k + 1, n))
    root_here, root_before = np.sqrt(P[k]), np.sqrt(P[k - 1])
    return min(k + root_here / (root_before - root_here), float(n))


@nb.njit(**INNER)
def scale_to_load(n: int, dx: float, k: int, load: float, tail: float, P: Array) -> None:
    """Scale the pressure behind the first node to the load, the first node counted half."""
    total = 0.0
    for i in range(1, k + 1):
        total += P[i]
    P[0] = tail
    if total > 0.0:
        factor = (load / dx - 0.5 * tail) / total
        for i in range(1, k + 1):
            P[i] *= factor


@nb.njit(**INNER)
def refine(n: int, dx: float, P: Array, k: int, load: float, tail: float, fine: Array) -> int:
    """Interpolate a pressure to the grid of half the interval."""
    m = 2 * n
    out = 2.0 * outlet_position(k, n, P)
    last = min(max(int(np.ceil(out)) - 1, 2), m - 1)
    for i in range(k + 1):
        fine[2 * i] = P[i]
    for i in range(k):
        if 1 <= i < k - 1:
            middle = (9.0 * (P[i] + P[i + 1]) - P[i - 1] - P[i + 2]) / 16.0
            fine[2 * i + 1] = max(middle, 0.0)
        else:
            fine[2 * i + 1] = 0.5 * (P[i] + P[i + 1])
    for j in range(2 * k + 1, m + 1):
        share = (out - j) / (out - 2 * k) if j <= last else 0.0
        fine[j] = P[k] * share * share
    for j in range(last + 1, m + 1):
        fine[j] = 0.0
    scale_to_load(m, 0.5 * dx, last, load, tail, fine)
    return last


@nb.njit(**INNER)
def central(n: int, start: float, dx: float, H: Array) -> float:
    """Film at X = 0 by cubic interpolation on a grid that begins at ``start``."""
    t = -start / dx
    i = min(max(int(np.floor(t)), 1), n - 2)
    t -= i
    a, b, c, d = H[i - 1], H[i], H[i + 1], H[i + 2]
    return (
        -t * (t - 1.0) * (t - 2.0) / 6.0 * a
        + (t + 1.0) * (t - 1.0) * (t - 2.0) / 2.0 * b
        - (t + 1.0) * t * (t - 2.0) / 2.0 * c
        + (t + 1.0) * t * (t - 1.0) / 6.0 * d
    )
