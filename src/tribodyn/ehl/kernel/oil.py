"""Viscosity and density of the oil over the dimensionless pressure, with their derivatives.

``oil`` holds six numbers: the law (0 isoviscous, 1 Barus, 2 Roelands), ``a``, ``p_r``, ``z``,
``d_1`` and ``d_2``. Pressures are in units of the Hertz pressure.
"""

from __future__ import annotations

import numba as nb

from tribodyn.ehl.kernel.elementary import exp_, log_
from tribodyn.ehl.kernel.options import INNER
from tribodyn.types import Array

ISOVISCOUS, BARUS, ROELANDS = 0.0, 1.0, 2.0
#: Roelands' law ends where its base vanishes; an iterate below is taken as being there.
LOWEST = -0.3


@nb.njit(**INNER)
def oil_state(
    n: int, P: Array, oil: Array, lneta: Array, dlneta: Array, rho: Array, drho: Array
) -> None:
    """Logarithm of the viscosity ratio, density ratio and their derivatives at the nodes 0..n."""
    a, reference, z, d1, d2 = oil[1], oil[2], oil[3], oil[4], oil[5]
    if oil[0] == ROELANDS:
        inverse, lowest = 1.0 / reference, LOWEST * reference
        for i in range(n + 1):
            base = 1.0 + max(P[i], lowest) * inverse
            growth = a * exp_(z * log_(base))
            lneta[i] = growth - a
            dlneta[i] = growth * z * inverse / base
    else:
        slope = a if oil[0] == BARUS else 0.0
        for i in range(n + 1):
            lneta[i], dlneta[i] = slope * P[i], slope
    for i in range(n + 1):
        share = 1.0 / (1.0 + d2 * max(P[i], 0.0))
        rho[i] = 1.0 + d1 * P[i] * share
        drho[i] = d1 * share * (share if P[i] > 0.0 else 1.0)
