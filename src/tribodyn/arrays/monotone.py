"""Monotone cubics through points."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from tribodyn.arrays.cubic import cubic
from tribodyn.types import Array


def monotone_cubic(x: Array, y: Array) -> Callable[[Array], Array]:
    """Cubic through values (n, ...) at increasing places (n), which swings beyond none of them.

    Beyond its ends the outer pieces go on. Source: Fritsch and Carlson (1980), SIAM J. Numer.
    Anal. 17, 238-246; slopes at the ends: Moler (2004), Numerical Computing with MATLAB, 3.6.
    """
    step = np.diff(x).reshape(-1, *[1] * (np.ndim(y) - 1))
    if x.size < 2 or not (np.all(step > 0.0) and np.isfinite(y).all()):
        raise ValueError("a curve needs two places or more that increase, and finite values")
    secant = np.diff(y, axis=0) / step
    slope = np.repeat(secant[:1], x.size, axis=0) if x.size == 2 else _slopes(step, secant)
    return cubic(x, y, slope)


def _slopes(step: Array, secant: Array) -> Array:
    """Slopes at the points: harmonic means inside, of three points at the ends."""
    before, after = secant[:-1], secant[1:]
    first, second = 2.0 * step[1:] + step[:-1], step[1:] + 2.0 * step[:-1]
    level = np.sign(before) * np.sign(after) <= 0.0
    mean = (first / np.where(level, 1.0, before) + second / np.where(level, 1.0, after)) / (
        first + second
    )
    ends = [_end(step[0], step[1], secant[0], secant[1])]
    ends += [_end(step[-1], step[-2], secant[-1], secant[-2])]
    return np.concatenate([ends[:1], np.where(level, 0.0, 1.0 / mean), ends[1:]])


def _end(step: Array, next_step: Array, secant: Array, next_secant: Array) -> Array:
    """Slope at an end with the sign of its interval, limited so that there is no overshoot."""
    slope = ((2.0 * step + next_step) * secant - step * next_secant) / (step + next_step)
    turned = (np.sign(secant) != np.sign(next_secant)) & (np.abs(slope) > 3.0 * np.abs(secant))
    limited = np.where(turned, 3.0 * secant, slope)
    return np.asarray(np.where(np.sign(slope) != np.sign(secant), 0.0, limited))
