"""Temperature of a surface that moves under a source of heat."""

from __future__ import annotations

import math

import numpy as np

from tribodyn.types import Array, Index

#: Euler's constant.
_EULER = 0.5772156649015329


def slowest_speed(diffusivity: float, reach: float) -> float:
    """Speed [m/s] below which a surface counts as one at rest, cooled at a distance ``reach``."""
    # A line source on a half-space at rest heats it without end. About a source at the speed u the
    # surface is as warm as if it were cooled at the distance 4 kappa exp(-gamma)/u.
    return 4.0 * diffusivity * math.exp(-_EULER) / reach


def surface_response(
    at: Index, edges: Array, interval: float, speed: float, conductivity: float, diffusivity: float
) -> Array:
    """Rise of a surface [K m^2/W] at each node by even heat between each two edges."""
    # T = 1/(pi k) int q exp(u s/2 kappa) K_0(|u s|/2 kappa) ds, with s the distance behind the
    # source, integrated exactly. Nodes and edges in intervals, in halves of them at least. Carslaw
    # and Jaeger, Conduction of Heat in Solids (1959), section 10.7.
    from scipy.special import k0e, k1e

    ratio = speed / (2.0 * diffusivity)
    reach = round(2.0 * float(edges[-1] - edges[0])) + 1
    distance = abs(ratio) * 0.5 * interval * np.arange(1, reach + 1)
    zeroth, first = k0e(distance), k1e(distance)
    behind = distance * (zeroth + first) - 1.0
    before = 1.0 + distance * np.exp(-2.0 * distance) * (zeroth - first)
    integral = np.concatenate([-before[::-1], [0.0], behind])
    if speed < 0.0:
        integral = -integral[::-1]
    places = np.rint(2.0 * (at[:, None] - edges[None, :])).astype(np.int64) + reach
    steps = integral[places]
    return np.ascontiguousarray(steps[:, :-1] - steps[:, 1:]) / (
        math.pi * conductivity * abs(ratio)
    )
