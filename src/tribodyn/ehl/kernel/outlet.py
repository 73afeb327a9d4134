"""The free outlet: where the oil film parts, moved between the steps of a solver."""

from __future__ import annotations

import numba as nb
import numpy as np

from tribodyn.ehl.kernel.options import BURIED
from tribodyn.types import Array


@nb.njit(**BURIED)
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


@nb.njit(**BURIED)
def extend(n: int, k: int, streak: int) -> int:
    """Last free node after the outlet has moved on: one node, then two, then four."""
    return min(n - 1, k + min(2**streak, max(1, n // 16)))


@nb.njit(**BURIED)
def outlet_position(k: int, n: int, P: Array) -> float:
    """Index, with fraction, at which the pressure ends."""
    if k < 2 or not P[k] > 0.0 or not P[k - 1] > P[k]:
        return float(min(k + 1, n))
    near, far = np.sqrt(P[k]), np.sqrt(P[k - 1])
    return min(k + near / (far - near), float(n))
