"""Measured heights of the surfaces in the gap, at rest or carried along."""

from __future__ import annotations

import numba as nb
import numpy as np

from tribodyn.ehl.kernel.options import BURIED
from tribodyn.types import Array


@nb.njit(**BURIED)
def add_profile(
    n: int, start: float, dx: float, shift: float, factor: float, heights: Array, first: float,
    spacing: float, periodic: bool, shape: Array,
) -> None:  # fmt: skip
    """Add the heights of a profile that has moved by ``shift`` to the gap."""
    size = heights.size
    if size < 4:
        return
    for i in range(n + 1):
        place = (start + i * dx - shift - first) / spacing
        if not periodic and (place < 0.0 or place > size - 1.0):
            continue
        j = int(np.floor(place))
        if not periodic:
            j = min(max(j, 1), size - 3)
        f = place - j
        a = heights[(j - 1) % size]
        b = heights[j % size]
        c = heights[(j + 1) % size]
        d = heights[(j + 2) % size]
        shape[i] += factor * (
            b * (f + 1.0) * (f - 1.0) * (f - 2.0) * 0.5
            - c * (f + 1.0) * f * (f - 2.0) * 0.5
            + d * (f + 1.0) * f * (f - 1.0) / 6.0
            - a * f * (f - 1.0) * (f - 2.0) / 6.0
        )
