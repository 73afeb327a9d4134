"""The part of a flooded inlet that lies before the first node: its pressure and its load."""

from __future__ import annotations

import numba as nb
import numpy as np

from tribodyn.ehl.kernel.options import INNER

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(40)


@nb.njit(**INNER)
def flooded_inlet(
    start: float, film: float, lam: float, curvature: float, s: float
) -> tuple[float, float, float, float, float, float]:
    """Pressure at the first node and load before it, with their slopes."""
    edge = 1.0 / abs(start)
    pressure = load = pressure_film = load_film = pressure_load = load_load = 0.0
    for q in range(_NODES.size):
        t = 0.5 * edge * (1.0 + _NODES[q])
        x = 1.0 / t
        root = np.sqrt(max(x * x - s * s, 0.0))
        logarithm = s * s * np.log((x + root) / s) if s > 0.0 else 0.0
        dry = 0.5 * curvature * (x * root - logarithm)
        gap = dry + film
        weight = 0.5 * edge * _WEIGHTS[q] * lam * x * x / (gap * gap * gap)
        arm = x - 1.0 / edge
        # A tenth more load widens s^2 by a tenth: d D/d ln(w) = -(c/2) s^2 ln((x + r)/s).
        by_film = -3.0 * dry / gap
        by_load = -0.5 * curvature * logarithm * (1.0 - 3.0 * dry / gap)
        pressure += weight * dry
        load += weight * dry * arm
        pressure_film += weight * by_film
        load_film += weight * by_film * arm
        pressure_load += weight * by_load
        load_load += weight * by_load * arm
    return pressure, load, pressure_film, load_film, pressure_load, load_load
