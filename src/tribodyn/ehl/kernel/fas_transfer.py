"""Between two grids of the full approximation scheme: state down, correction up."""

from __future__ import annotations

import numba as nb

from tribodyn.ehl.kernel.options import INNER
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
