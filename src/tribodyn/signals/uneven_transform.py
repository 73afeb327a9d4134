"""Fourier sums over uneven places, for all orders at once."""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np

from tribodyn.compiled.cache import cached_njit
from tribodyn.types import Array, ComplexArray

#: Half width of the kernel in grid points, and its shape: relative error about 1e-12 with a grid
#: twice as fine as needed (2.30 times the width: Barnett et al. 2019, section 3.2).
_HALF = 7
_SHAPE = 2.30 * 2 * _HALF


def uneven_transform(strength: Array, position: Array, count: int) -> ComplexArray:
    """Sums of strength times exp(-2 pi i k position) for k from 0 to count - 1."""
    from scipy.fft import rfft

    # The strengths are spread onto an even grid by a kernel whose transform is divided out after
    # the fast Fourier transform: A. H. Barnett, J. Magland and L. af Klinteberg, SIAM J. Sci.
    # Comput. 41 (2019) C479, equations (1.8) and (3.12).
    size, kernel_transform = _grid(count)
    grid = np.zeros(size)
    _spread(strength, position, grid)
    return np.asarray(rfft(grid)[:count] / kernel_transform)


@lru_cache(maxsize=16)
def _grid(count: int) -> tuple[int, Array]:
    """Size of the even grid for so many sums, and the transform of the kernel."""
    from scipy.fft import next_fast_len

    # Twice as fine as lines and their mirror images need.
    size, total = int(next_fast_len(4 * count + 4 * _HALF, real=True)), np.zeros(count)
    for node, share in zip(*np.polynomial.legendre.leggauss(64), strict=True):
        weight = _HALF * share * math.exp(_SHAPE * (math.sqrt(1.0 - node**2) - 1.0))
        total += weight * np.cos(2.0 * np.pi / size * _HALF * node * np.arange(count))
    return size, total


@cached_njit(nogil=True)
def _spread(strength: Array, place: Array, grid: Array) -> None:
    """Add each strength to the points of a periodic grid around its place, which is 0 to 1."""
    size = grid.size
    for index in range(strength.size):
        on_grid = place[index] * size
        first = math.ceil(on_grid - _HALF)
        for step in range(2 * _HALF):
            away = (first + step - on_grid) / _HALF
            inner = 1.0 - away * away
            if inner > 0.0:
                share = math.exp(_SHAPE * (math.sqrt(inner) - 1.0))
                grid[(first + step) % size] += strength[index] * share
