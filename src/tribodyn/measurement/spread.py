"""Spreading of samples at uneven places onto an even grid, compiled."""

from __future__ import annotations

import math

import numba as nb

from tribodyn.types import Array

#: Half width of the kernel in grid points, and its shape: relative error about 1e-12 with a grid
#: twice as fine as needed (2.30 times the width: Barnett et al. 2019, section 3.2).
HALF = 7
SHAPE = 2.30 * 2 * HALF


@nb.njit(cache=True, nogil=True)
def spread(strength: Array, place: Array, grid: Array) -> None:
    """Add each strength to the points of a periodic grid around its place, which is 0 to 1."""
    size = grid.size
    for index in range(strength.size):
        on_grid = place[index] * size
        first = math.ceil(on_grid - HALF)
        for step in range(2 * HALF):
            away = (first + step - on_grid) / HALF
            inner = 1.0 - away * away
            if inner > 0.0:
                share = math.exp(SHAPE * (math.sqrt(inner) - 1.0))
                grid[(first + step) % size] += strength[index] * share
