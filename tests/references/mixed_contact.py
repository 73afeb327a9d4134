"""Film and asperities at one gap once more: quadrature and bisection, asperity by asperity."""

from __future__ import annotations

import math

from scipy.integrate import dblquad, quad
from scipy.optimize import brentq

ROOT = math.sqrt(2.0 * math.pi)


def integral(u, n):
    """F_n(u) of Gaussian heights, with the size of the integrand taken out."""
    scale = math.exp(-0.5 * u * u) if u > 0.0 else 1.0
    top = 40.0 if u > 0.0 else 12.0 - u

    def integrand(t):
        return t**n * math.exp(-u * t - 0.5 * t * t - (0.0 if u > 0.0 else 0.5 * u * u))

    return scale / ROOT * quad(integrand, 0.0, top, epsabs=0.0, epsrel=1e-12, limit=400)[0]


def asperity_pressure(separation, rms, radius, density, modulus):
    """Every summit meets every other: two spheres of one radius, r apart sideways, overlap by w."""
    reduced = 0.5 * modulus  # Hertz of two spheres: 4/3 E* sqrt(R*) d^(3/2)

    def pairs(side, w):
        depth = w - side**2 / (4.0 * radius)
        hertz = 4.0 / 3.0 * reduced * math.sqrt(0.5 * radius) * max(depth, 0.0) ** 1.5
        height = math.exp(-0.5 * ((w + separation) / rms) ** 2) / (ROOT * rms)
        return density**2 * 2.0 * math.pi * side * hertz * height

    top = 12.0 * rms + max(-separation, 0.0)
    return dblquad(pairs, 0.0, top, 0.0, lambda w: 2.0 * math.sqrt(radius * w), epsrel=1e-9)[0]


def shared(film, hertz_pressure, modulus, asperities, exponent=0.13):
    """Share of the film and mean gap, by bisection over the separation of the mean planes."""
    rms, mean = asperities.rms_height, 0.25 * math.pi * hertz_pressure
    factor = 8.0 * math.sqrt(2.0) * math.pi / 15.0 * math.sqrt(rms / asperities.summit_radius)
    factor *= (asperities.summit_density * asperities.summit_radius * rms) ** 2 * modulus

    def film_share(u):
        return 1.0 - factor * integral(u, 2.5) / mean

    def gap(u):
        return (
            rms
            * quad(
                lambda z: (u - z) * math.exp(-0.5 * z * z) / ROOT,
                -12.0,
                u,
                epsrel=1e-12,
                epsabs=0.0,
            )[0]
        )

    dry = brentq(film_share, -11.0, 30.0, xtol=1e-14)

    def excess(u):
        return math.log(film) - exponent * math.log(film_share(u)) - math.log(gap(u))

    u = brentq(excess, dry + 1e-12, max(film / rms, dry) + 3.0, xtol=1e-14)
    return film_share(u), gap(u)
