"""Between two grids of the full approximation scheme: state down, correction up."""

from __future__ import annotations

import numba as nb
import numpy as np
from numpy.typing import NDArray

from tribodyn.ehl.kernel.options import INNER

__all__ = ["add_correction", "inject", "mean_gap", "restrict_defect"]

Array = NDArray[np.float64]


@nb.njit(**INNER)
def inject(m: int, fine: Array, coarse: Array) -> None:
    """Take every other node: nodes 0..m of the coarse grid."""
    for i in range(m + 1):
        coarse[i] = fine[2 * i]


@nb.njit(**INNER)
def mean_gap(m: int, fine: Array, coarse: Array) -> None:
    """Heights on the coarse grid: a quarter, a half and a quarter of those of the fine one.

    Over several grids this is the mean under a hat as wide as an interval on either side.
    """
    coarse[0] = (2.0 * fine[0] + fine[1]) / 3.0
    coarse[m] = (2.0 * fine[2 * m] + fine[2 * m - 1]) / 3.0
    for i in range(1, m):
        coarse[i] = 0.25 * (fine[2 * i - 1] + fine[2 * i + 1]) + 0.5 * fine[2 * i]


@nb.njit(**INNER)
def restrict_defect(m: int, k: int, right: Array, G: Array, coarse: Array) -> None:
    """Defect of the fine grid on the coarse one.

    A residual is the mass balance of its interval, so that the coarse one is the sum: half of
    each neighbour belongs to it. Behind the free nodes of the fine grid there is no defect.

    Parameters
    ----------
    m : int
        Intervals of the coarse grid.
    k : int
        Last free node of the fine grid.
    right, G : (2 m + 1,) arrays
        Right side and residual of the fine grid.
    coarse : (m + 1,) array
        Receives the defect.
    """
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
    """Add what the coarse grid changed to the free nodes of the fine one, linearly between.

    Parameters
    ----------
    m : int
        Intervals of the coarse grid.
    k : int
        Last free node of the fine grid.
    P, injected : (m + 1,) arrays
        Pressure of the coarse grid now, and as it was injected.
    fine : (2 m + 1,) array
        Pressure of the fine grid; overwritten.
    """
    before = P[0] - injected[0]
    for i in range(m):
        after = P[i + 1] - injected[i + 1]
        if 1 <= 2 * i <= k:
            fine[2 * i] += before
        if 2 * i + 1 <= k:
            fine[2 * i + 1] += 0.5 * (before + after)
        before = after
