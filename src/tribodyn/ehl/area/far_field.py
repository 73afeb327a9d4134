"""Pressure of the oil outside the grid of a flooded contact.

Far from the contact the oil is isoviscous and the gap a paraboloid. There
``p = -[X ux/(3 + 2 D) + Y uy D/(2 + 3 D)] lam/h^2`` with ``h = H + X^2/2 + D Y^2/2`` solves the
equation of Reynolds exactly (Kapitza 1955 for a point). Its positive part is the pressure on the
edges of the grid, and its integral outside them the load that the grid does not carry.
"""

from __future__ import annotations

import math

import numpy as np

from tribodyn.types import Array

#: Directions and points along each in the integral of the pressure.
_DIRECTIONS, _POINTS = 720, 12


def far_pressure(
    x: Array, y: Array, h: Array, curvature: float, direction: tuple[float, float], lam: float
) -> Array:
    """Pressure at positions with the gap ``h``; ``curvature`` is ``D``."""
    along = direction[0] * x / (3.0 + 2.0 * curvature)
    across = direction[1] * curvature * y / (2.0 + 3.0 * curvature)
    return np.asarray(lam * np.maximum(-along - across, 0.0) / h**2)


def outside_load(
    edges: tuple[float, float, float, float], offset: float, curvature: float,
    direction: tuple[float, float], lam: float,
) -> float:  # fmt: skip
    """Integral of the pressure outside of a rectangle (x from, to, y from, to)."""
    angle = 2.0 * math.pi * (np.arange(_DIRECTIONS) + 0.5) / _DIRECTIONS
    c, s = np.cos(angle), np.sin(angle)
    reach = np.minimum(
        np.where(c > 0.0, edges[1], edges[0]) / c, np.where(s > 0.0, edges[3], edges[2]) / s
    )
    points, weights = np.polynomial.legendre.leggauss(_POINTS)
    share = 0.5 * (points + 1.0)
    # With t = reach/r the integral over the radius has the limits 0 and 1.
    square = 0.5 * (c**2 + curvature * s**2) * reach**2
    gap = offset * share[:, None] ** 2 + square
    radial = 0.5 * weights @ (reach**3 / gap**2)
    source = far_pressure(c, s, np.ones_like(c), curvature, direction, lam)
    return float(np.sum(source * radial)) * 2.0 * math.pi / _DIRECTIONS
