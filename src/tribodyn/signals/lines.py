"""Sums of spectral lines at any frequencies, on even times."""

from __future__ import annotations

import numpy as np

from tribodyn.types import Array, ComplexArray, Index

#: Places of the grid over which a line is spread, and the width of the kernel's decay.
_SPREAD, _DECAY = 14, 2.3 * 14
#: Products of lines and samples that are summed directly.
_DIRECT = 2**20


def sum_of_lines(
    frequency: Array, amplitude: ComplexArray, start: float, step: float, count: int
) -> Array:
    """Sum of ``Re(amplitude_k exp(2 pi i frequency_k t))`` on even times, exact to 1e-11."""
    # Lines are spread over the grid of a fast Fourier transform by a short kernel, the transform of
    # which is divided off: Barnett, Magland, af Klinteberg (2019), SIAM J. Sci. Comput. 41, C479.
    from scipy.fft import ifft, next_fast_len

    turns = frequency * step % 1.0
    shifted = amplitude * np.exp(2j * np.pi * (frequency * start % 1.0))
    if turns.size * count <= _DIRECT:
        waves = np.exp(2j * np.pi * np.multiply.outer(np.arange(count), turns))
        return np.asarray((waves @ shifted).real)
    size, middle, half = next_fast_len(2 * count), count // 2, 0.5 * _SPREAD
    shifted = shifted * np.exp(2j * np.pi * (turns * middle % 1.0))
    first: Index = np.ceil(turns * size - half).astype(np.int64)
    grid = np.zeros(size, dtype=complex)
    for place in range(_SPREAD):
        away = (turns * size - (first + place)) / half
        weight = np.exp(_DECAY * (np.sqrt(np.maximum(1.0 - away**2, 0.0)) - 1.0))
        at = (first + place) % size
        grid += np.bincount(at, weight * shifted.real, size)
        grid += 1j * np.bincount(at, weight * shifted.imag, size)
    number = np.arange(count) - middle
    values = ifft(grid)[number % size] * size
    return np.asarray((values / _kernel(number * (half / size))).real * (1.0 / half))


def _kernel(turns: Array) -> Array:
    """Fourier transform of the kernel over its half width."""
    nodes, weights = np.polynomial.legendre.leggauss(2 * _SPREAD)
    size = weights * np.exp(_DECAY * (np.sqrt(1.0 - nodes**2) - 1.0))
    total = np.zeros(turns.shape)
    for node, weight in zip(nodes, size, strict=True):
        total += weight * np.cos(2.0 * np.pi * node * turns)
    return total
