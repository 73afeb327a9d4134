"""Temperature of a surface that moves under a source of heat."""

from __future__ import annotations

import math

import numpy as np

from tribodyn.types import Array

#: Euler's constant.
_EULER = 0.5772156649015329


def slowest_speed(diffusivity: float, reach: float) -> float:
    """Speed [m/s] below which a surface counts as one at rest, cooled at a distance ``reach``."""
    # A line source on a half-space at rest heats it without end. About a source at the speed u the
    # surface is as warm as if it were cooled at the distance 4 kappa exp(-gamma)/u.
    return 4.0 * diffusivity * math.exp(-_EULER) / reach


def surface_response(
    nodes: int, interval: float, speed: float, conductivity: float, diffusivity: float
) -> Array:
    """Rise of the surface temperature [K m^2/W] by even heat over one interval about a node."""
    # T = 1/(pi k) int q exp(u s/2 kappa) K_0(|u s|/2 kappa) ds, with s the distance behind the
    # source, integrated exactly; by the distance of node and source, from -(nodes - 1) intervals
    # on. Carslaw and Jaeger, Conduction of Heat in Solids (1959), section 10.7.
    from scipy.special import k0e, k1e

    ratio = abs(speed) / (2.0 * diffusivity)
    edges = ratio * interval * np.arange(0.5, nodes)
    behind = edges * (k0e(edges) + k1e(edges)) - 1.0
    # Far before the source the difference of two ones would be all that is left.
    before = 1.0 + edges * np.exp(-2.0 * edges) * (k0e(edges) - k1e(edges))
    integral = np.concatenate([-before[::-1], behind])
    response = np.diff(integral) / (math.pi * conductivity * ratio)
    return np.ascontiguousarray(response if speed > 0.0 else response[::-1])
