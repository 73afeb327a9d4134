"""Cubic B-splines on any breakpoints, without the half second that scipy.interpolate loads in."""

from __future__ import annotations

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
