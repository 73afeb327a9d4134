"""Cubics through points and cubic B-splines; scipy.interpolate takes half a second to load."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from tribodyn.types import Array

DEGREE = 3


def clamped_knots(breaks: Array) -> Array:
    """Knots of the cubics that end at the first and last of increasing breakpoints."""
    return np.concatenate([np.full(DEGREE, breaks[0]), breaks, np.full(DEGREE, breaks[-1])])


def bspline_values(knots: Array, x: Array, degree: int = DEGREE) -> Array:
    """Values (x.size, count) of all B-splines of a knot sequence at places within it."""
    x = np.asarray(x, dtype=float)
    first, last = DEGREE, knots.size - DEGREE - 2
    piece = np.clip(np.searchsorted(knots, x, side="right") - 1, first, last)
    values = np.zeros((x.size, knots.size - 1))
    values[np.arange(x.size), piece] = 1.0
    for k in range(1, degree + 1):
        span = knots[k:-1] - knots[: -k - 1], knots[k + 1 :] - knots[1:-k]
        rise, fall = (np.divide(1.0, s, out=np.zeros_like(s), where=s > 0.0) for s in span)
        left = (x[:, None] - knots[: -k - 1]) * rise * values[:, :-1]
        values = left + (knots[k + 1 :] - x[:, None]) * fall * values[:, 1:]
    return values


def bspline_slopes(knots: Array, x: Array) -> Array:
    """Slopes of all cubic B-splines of a knot sequence at places within it."""
    lower = bspline_values(knots, x, DEGREE - 1)
    span = knots[DEGREE:] - knots[:-DEGREE]
    scaled = lower * np.divide(DEGREE, span, out=np.zeros_like(span), where=span > 0.0)
    return np.asarray(scaled[:, :-1] - scaled[:, 1:])


def interpolation_knots(x: Array) -> Array:
    """Knots of the spline through values at four or more places, the end pieces one cubic."""
    if x.size < DEGREE + 1:
        raise ValueError("a spline needs four places or more")
    return clamped_knots(np.concatenate([x[:1], x[2:-2], x[-1:]]))


def bspline_integrals(knots: Array, edges: Array) -> Array:
    """Integrals (edges.size - 1, count) of all cubic B-splines between increasing edges."""
    cuts = np.unique(np.concatenate([knots[(knots > edges[0]) & (knots < edges[-1])], edges]))
    place, weight = np.polynomial.legendre.leggauss(2)
    middle, half = 0.5 * (cuts[1:] + cuts[:-1]), 0.5 * np.diff(cuts)
    points = middle[:, None] + half[:, None] * place
    values = bspline_values(knots, points.ravel()).reshape(*points.shape, -1)
    pieces = np.einsum("pgb,g,p->pb", values, weight, half)
    return np.add.reduceat(pieces, np.searchsorted(cuts, edges[:-1]), axis=0)


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
    total = first / np.where(level, 1.0, before) + second / np.where(level, 1.0, after)
    mean = total / (first + second)
    ends = [_end(step[0], step[1], secant[0], secant[1])]
    ends += [_end(step[-1], step[-2], secant[-1], secant[-2])]
    return np.concatenate([ends[:1], np.where(level, 0.0, 1.0 / mean), ends[1:]])


def _end(step: Array, next_step: Array, secant: Array, next_secant: Array) -> Array:
    """Slope at an end with the sign of its interval, limited so that there is no overshoot."""
    slope = ((2.0 * step + next_step) * secant - step * next_secant) / (step + next_step)
    turned = (np.sign(secant) != np.sign(next_secant)) & (np.abs(slope) > 3.0 * np.abs(secant))
    limited = np.where(turned, 3.0 * secant, slope)
    return np.asarray(np.where(np.sign(slope) != np.sign(secant), 0.0, limited))
