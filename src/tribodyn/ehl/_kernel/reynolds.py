"""The discrete contact: oil, fluxes, residual and exact tangent of the Reynolds equation.

Second-order upstream Couette flux, central Poiseuille flux, conservative; a squeeze term of any
backward formula enters as ``squeeze * rho H`` minus a history. Nodes 0..n.

``oil`` holds six numbers: the law (0 isoviscous, 1 Barus, 2 Roelands), ``a``, ``p_r``, ``z``,
``d_1`` and ``d_2``. Pressures are in units of the Hertz pressure. A film that is heated or thins
under shear has two columns more, over the same domain: at evenly spaced nodes the logarithm of a
factor on the viscosity, then a factor on the density.
"""

from __future__ import annotations

from typing import NamedTuple

import numba as nb
import numpy as np

from tribodyn.ehl._kernel.elementary import INNER, exp_, log_
from tribodyn.types import Array

ISOVISCOUS, BARUS, ROELANDS = 0.0, 1.0, 2.0
#: Roelands' law ends where its base vanishes; an iterate below is taken as being there.
LOWEST = -0.3
#: Numbers of an oil without the columns of a heated film.
PLAIN = 6


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
    if oil.size > PLAIN:
        last = (oil.size - PLAIN) // 2 - 1
        for i in range(n + 1):
            at = PLAIN + min(i * last // n, last - 1)
            share = (i * last - (at - PLAIN) * n) / n
            lneta[i] += (1.0 - share) * oil[at] + share * oil[at + 1]
            at += last + 1
            factor = (1.0 - share) * oil[at] + share * oil[at + 1]
            rho[i] *= factor
            drho[i] *= factor


class Fields(NamedTuple):
    """What follows from pressure and film at the nodes, and its balance."""

    lneta: Array  #: logarithm of the viscosity ratio
    dlneta: Array  #: its slope over the pressure
    rho: Array  #: density ratio
    drho: Array  #: its slope over the pressure
    eps: Array  #: mobility
    F: Array  #: flux through the face behind each node
    G: Array  #: residual of the mass balance


@nb.njit(**INNER)
def make_fields(n: int) -> Fields:
    """Fields of a grid of ``n`` intervals, not yet filled."""
    a = np.zeros((7, n + 2))
    return Fields(a[0], a[1], a[2], a[3], a[4], a[5], a[6])


#: Least film in the mobility, so that an iterate with overlapping flanks stays computable.
THINNEST = 1e-10


@nb.njit(**INNER)
def mobility(n: int, H: Array, lam: float, lneta: Array, rho: Array, eps: Array) -> None:
    """``eps = rho H^3 / (eta lambda)``: flux per pressure gradient."""
    inverse = 1.0 / lam
    for i in range(n + 1):
        h = max(H[i], THINNEST)
        eps[i] = inverse * rho[i] * h * h * h * exp_(-lneta[i])


@nb.njit(**INNER)
def residual(
    n: int, dx: float, u: float, squeeze: float, history: Array, P: Array, H: Array, f: Fields
) -> None:
    """Flux ``F[i]`` through the face between nodes i and i+1, and residual ``G[1..n-1]``."""
    half, rho, eps, F, G = 0.5 / dx, f.rho, f.eps, f.F, f.G
    F[0] = 0.5 * u * (rho[0] * H[0] + rho[1] * H[1]) - half * (eps[0] + eps[1]) * (P[1] - P[0])
    for i in range(1, n):
        C = 1.5 * rho[i] * H[i] - 0.5 * rho[i - 1] * H[i - 1]
        F[i] = u * C - half * (eps[i] + eps[i + 1]) * (P[i + 1] - P[i])
    G[0] = G[n] = 0.0
    for i in range(1, n):
        G[i] = F[i] - F[i - 1] + squeeze * rho[i] * H[i] - history[i]


@nb.njit(**INNER)
def fill_oil(n: int, lam: float, oil: Array, P: Array, H: Array, f: Fields) -> None:
    """Oil and mobility of a pressure and a film."""
    oil_state(n, P, oil, f.lneta, f.dlneta, f.rho, f.drho)
    mobility(n, H, lam, f.lneta, f.rho, f.eps)


@nb.njit(**INNER)
def fill_tangent(
    n: int, dx: float, u: float, squeeze: float, P: Array, H: Array, f: Fields, cH: Array, cP: Array
) -> None:
    """Derivatives of ``G_i`` by film and, at fixed film, by pressure at the nodes i-2..i+1."""
    half, dlneta, rho, drho, eps = 0.5 / dx, f.dlneta, f.rho, f.drho, f.eps
    for s in range(4):
        cH[0, s] = cP[0, s] = cH[n, s] = cP[n, s] = 0.0
    for i in range(1, n):
        a, o, b = i - 1, i, i + 1
        # Poiseuille flux of the faces i-1/2 and i+1/2.
        left, right = half * (P[o] - P[a]), half * (P[b] - P[o])
        mean_left, mean_right = half * (eps[a] + eps[o]), half * (eps[o] + eps[b])
        # d eps/dH = 3 eps/H, zero where the film is held.
        ha = 3.0 * eps[a] / H[a] if H[a] > THINNEST else 0.0
        ho = 3.0 * eps[o] / H[o] if H[o] > THINNEST else 0.0
        hb = 3.0 * eps[b] / H[b] if H[b] > THINNEST else 0.0
        pa = eps[a] * (drho[a] / rho[a] - dlneta[a])
        po = eps[o] * (drho[o] / rho[o] - dlneta[o])
        pb = eps[b] * (drho[b] / rho[b] - dlneta[b])
        if i > 1:
            wa2, wa, wo = 0.5 * u, -2.0 * u, 1.5 * u + squeeze
            cH[i, 0] = wa2 * rho[i - 2]
            cP[i, 0] = wa2 * drho[i - 2] * H[i - 2]
        else:
            # The first face takes the mean of its two nodes.
            wa, wo = -1.0 * u, 1.0 * u + squeeze
            cH[i, 0] = cP[i, 0] = 0.0
        cH[i, 1] = wa * rho[a] + ha * left
        cH[i, 2] = wo * rho[o] + ho * (left - right)
        cH[i, 3] = -hb * right
        cP[i, 1] = wa * drho[a] * H[a] + pa * left - mean_left
        cP[i, 2] = wo * drho[o] * H[o] + po * (left - right) + mean_left + mean_right
        cP[i, 3] = -pb * right - mean_right
