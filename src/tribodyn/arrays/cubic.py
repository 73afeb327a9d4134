"""Cubics through points, without the half second that scipy.interpolate loads in."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from tribodyn.types import Array


def cubic(x: Array, y: Array, slope: Array) -> Callable[[Array], Array]:
    """Cubics through values (n, ...) with slopes (n, ...) at increasing places (n).

    Beyond its ends the outer pieces go on.
    """
    step = np.diff(x).reshape(-1, *[1] * (np.ndim(y) - 1))
    secant = np.diff(y, axis=0) / step
    bend = (slope[:-1] + slope[1:] - 2.0 * secant) / step
    square, cube = (secant - slope[:-1]) / step - bend, bend / step

    def at(places: Array) -> Array:
        piece = np.clip(np.searchsorted(x, places, side="right") - 1, 0, x.size - 2)
        s = np.reshape(places - x[piece], (*np.shape(places), *[1] * (np.ndim(y) - 1)))
        value = y[piece] + slope[piece] * s + square[piece] * (s * s) + cube[piece] * (s * s * s)
        return np.asarray(value)

    return at


def spline(x: Array, y: Array) -> Callable[[Array], Array]:
    """Cubic through values (n, ...) at increasing places (n,), four or more, with steady bends.

    The two pieces at each end are one cubic. Source: de Boor (1978), A practical guide to splines,
    chapter IV.
    """
    if x.size < 4:
        raise ValueError("a spline needs four places or more")
    h, rows, right = np.diff(x), np.zeros((x.size, x.size)), np.zeros((x.size, x.size - 1))
    inner = np.arange(1, x.size - 1)
    rows[inner, inner - 1], rows[inner, inner + 1] = h[1:], h[:-1]
    rows[inner, inner] = 2.0 * (h[:-1] + h[1:])
    right[inner, inner - 1], right[inner, inner] = 3.0 * h[1:], 3.0 * h[:-1]
    first, last = x[2] - x[0], x[-1] - x[-3]
    rows[0, :2], rows[-1, -2:] = (h[1], first), (last, h[-2])
    right[0, :2] = (h[0] + 2.0 * first) * h[1] / first, h[0] ** 2 / first
    right[-1, -2:] = h[-1] ** 2 / last, (2.0 * last + h[-1]) * h[-2] / last
    secant = (np.diff(y, axis=0).T / h).T
    return cubic(x, y, np.asarray(np.linalg.solve(rows, right @ secant)))
