"""Line contacts solved in ways that share nothing with the discretisation of tribodyn.

``known_film`` follows Okamura (1982) and Houpert and Hamrock (1986): the first integral of the
Reynolds equation, ``rho H^3/(eta lambda) dP/dX = rho H - m``, at the middle of every interval, the
pressure linear in between and its deflection integrated exactly, the outlet an unknown where
``dP/dX = 0``. The nodes are spaced at will: far into the inlet, and densely at the spike.

``rigid_film`` is the closed solution of rigid bodies with the outlet of Reynolds, Swift and
Stieber.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

_P0 = 1.0 / 5.1e-9


@dataclass(frozen=True)
class KnownFilm:
    """Solved contact in b, p_h and b^2/R; ``mass`` is the flux over the entrainment speed."""

    X: np.ndarray
    P: np.ndarray
    H: np.ndarray
    mass: float

    @property
    def central(self):
        from scipy.interpolate import CubicSpline

        return float(CubicSpline(self.X, self.H)(0.0))

    @property
    def minimum(self):
        """From the parabola through the three lowest nodes."""
        i = int(np.argmin(self.H))
        a, b, c = np.polyfit(self.X[i - 1 : i + 2] - self.X[i], self.H[i - 1 : i + 2], 2)
        return float(c - b * b / (4.0 * a))

    @property
    def spike(self):
        """Position and height of the pressure maximum next to the outlet."""
        rising = np.diff(self.P) > 0.0
        i = 1 + int(np.flatnonzero(rising[:-1] & ~rising[1:])[-1])
        return float(self.X[i]), float(self.P[i])


def spaced(inlet, outlet, spike, nodes, width):
    """Nodes whose density grows from the far inlet towards the spike and the outlet."""
    far = -np.geomspace(-inlet, 2.0, 2000)[:-1] if inlet < -2.0 else np.empty(0)
    X = np.concatenate((far, np.linspace(max(inlet, -2.0), outlet, 20001)))
    density = 1.0 / np.maximum(1.0, 0.5 * np.abs(X)) + 0.15 / (width + np.abs(X - spike))
    density += 0.05 / (width + np.abs(X - outlet)) + 0.1 / (0.05 + np.abs(X + 1.0))
    total = np.concatenate(([0.0], np.cumsum(0.5 * (density[1:] + density[:-1]) * np.diff(X))))
    return np.interp(np.linspace(0.0, total[-1], nodes), total, X)


def deflection(X, at):
    """Matrix of ``-(1/pi) int P ln|X - at| dX`` for pressure linear between the nodes."""
    a, c = (side - at[:, None] for side in (X[:-1], X[1:]))

    def logarithm(t):
        return np.log(np.maximum(np.abs(t), 1e-300))

    plain = c * (logarithm(c) - 1.0) - a * (logarithm(a) - 1.0)
    weighted = 0.5 * (c**2 * (logarithm(c) - 0.5) - a**2 * (logarithm(a) - 0.5))
    matrix = np.zeros((len(at), len(X)))
    matrix[:, 1:] += (weighted - a * plain) / (c - a)
    matrix[:, :-1] += (c * plain - weighted) / (c - a)
    return -matrix / math.pi


class _Oil:
    def __init__(self, M, L, alpha, z, compressible):
        self.hertz = L * math.sqrt(M / (2.0 * math.pi)) / alpha
        self.alpha, self.z, self.compressible = alpha, z, compressible

    def __call__(self, P):
        """Logarithm of the viscosity and density, each with its slope."""
        p = np.maximum(P, -0.01) * self.hertz
        viscous = self.alpha * _P0 / self.z * ((1.0 + p / _P0) ** self.z - 1.0)
        slope = self.alpha * self.hertz * (1.0 + p / _P0) ** (self.z - 1.0)
        if not self.compressible:
            return viscous, slope, np.ones_like(P), np.zeros_like(P)
        below = 1.0 + 1.7e-9 * p
        return viscous, slope, 1.0 + 0.6e-9 * p / below, 0.6e-9 * self.hertz / below**2


def _equations(lam, oil, load, X, P, mass, offset):
    """Residuals at the middles, of the outlet and of the load; derivatives by P, mass, offset."""
    n, at = len(X) - 1, np.append(0.5 * (X[1:] + X[:-1]), X[-1])
    influence = deflection(X, at)
    H = offset + 0.5 * at**2 + influence @ P
    p, width, row = 0.5 * (P[1:] + P[:-1]), np.diff(X), np.arange(n)
    viscous, viscous_slope, rho, rho_slope = oil(p)
    h, slope = H[:-1], np.diff(P) / width
    mobility = h**3 * np.exp(-viscous) / lam
    value = np.append(mobility * slope - (h - mass / rho), [H[-1] - mass, width @ p - load])
    jacobian = np.zeros((n + 2, n + 3))
    by_h = 3.0 * mobility / h * slope - 1.0
    by_p = 0.5 * (-mobility * slope * viscous_slope - mass * rho_slope / rho**2)
    jacobian[:n, : n + 1] = by_h[:, None] * influence[:-1]
    jacobian[row, row] += by_p - mobility / width
    jacobian[row, row + 1] += by_p + mobility / width
    jacobian[:n, n + 1], jacobian[:n, n + 2] = 1.0 / rho, by_h
    jacobian[n, : n + 1], jacobian[n, n + 1 :] = influence[-1], (-1.0, 1.0)
    jacobian[n + 1, :n] += 0.5 * width
    jacobian[n + 1, 1 : n + 1] += 0.5 * width
    return value, jacobian


def known_film(M, L, start, *, inlet, alpha=2.2e-8, z=0.68, compressible=True, nodes=500,
               width=1e-3, load=math.pi / 2.0):  # fmt: skip
    """Solve, beginning at a neighbouring film ``start`` (X, P, H up to its outlet)."""
    lam, oil = 3.0 * math.pi**2 / (8.0 * M**2), _Oil(M, L, alpha, z, compressible)
    X = spaced(inlet, start.X[-1], start.spike[0], nodes, width)
    P = np.interp(X, start.X, start.P, left=0.0)
    P[0] = P[-1] = 0.0
    share, outlet, mass = (X - inlet) / (X[-1] - inlet), float(X[-1]), start.mass
    offset = float(np.interp(0.0, start.X, start.H))
    offset -= float((deflection(X, np.zeros(1)) @ P)[0])
    for _ in range(100):
        X = inlet + (outlet - inlet) * share
        value, full = _equations(lam, oil, load, X, P, mass, offset)
        moved = inlet + (outlet + 1e-6 - inlet) * share
        by_outlet = (_equations(lam, oil, load, moved, P, mass, offset)[0] - value) / 1e-6
        jacobian = np.column_stack((full[:, 1:-3], by_outlet, full[:, -2:]))
        size = np.abs(jacobian).max(axis=1)
        move = np.linalg.solve(jacobian / size[:, None], -value / size)
        step = min(1.0, 0.1 / np.abs(move[:-3]).max(), 0.02 / abs(move[-3]))
        P[1:-1] += step * move[:-3]
        outlet, mass, offset = np.array([outlet, mass, offset]) + step * move[-3:]
        if np.abs(move[:-3]).max() < 1e-8:
            X = inlet + (outlet - inlet) * share
            H = offset + 0.5 * X**2 + deflection(X, X) @ P
            return KnownFilm(X, P, H, float(mass))
    raise RuntimeError("the known film did not converge")


def wetted(solution):
    """A dimensionless solution of tribodyn up to its outlet, to begin ``known_film`` with."""
    end = int(np.flatnonzero(solution.pressure)[-1]) + 2
    X, P, H = solution.position[:end], solution.pressure[:end].copy(), solution.film[:end]
    P[-1] = 0.0
    return KnownFilm(X, P, H, float(H[-1]))


def _between(t, end):
    """``int (h - h_m)/h^3 dx`` from 0 to tan t, where ``h = 1 + x^2`` and h_m that at the end."""
    fourth = 0.375 * t + 0.25 * np.sin(2.0 * t) + np.sin(4.0 * t) / 32.0
    return 0.5 * t + 0.25 * np.sin(2.0 * t) - fourth / math.cos(end) ** 2


@dataclass(frozen=True)
class RigidFilm:
    """Rigid bodies: least film and film at the pressure maximum, in b^2/R; outlet in b."""

    minimum: float
    at_maximum: float
    outlet: float
    greatest_reduced_pressure: float


def rigid_film(M, inlet, *, piezoviscosity=0.0):
    """Film under the load of the Moes number M; ``piezoviscosity`` is alpha p_h (Barus)."""
    from scipy.integrate import quad
    from scipy.optimize import brentq

    lam = 3.0 * math.pi**2 / (8.0 * M**2)

    def contact(film):
        """Load and outlet angle of a film, with X = sqrt(2 film) tan(angle)."""
        unit = math.sqrt(2.0 * film)
        first = math.atan(inlet / unit)
        last = brentq(lambda t: _between(t, t) - _between(first, t), 0.0, -first, xtol=1e-15)
        scale = lam * unit / film**2
        top = scale * (_between(-last, last) - _between(first, last))
        if piezoviscosity * top >= 1.0:
            return math.inf, last, top

        def pressure(t):
            q = scale * (_between(t, last) - _between(first, last))
            if piezoviscosity:
                q = -math.log1p(-piezoviscosity * q) / piezoviscosity
            return q * unit / math.cos(t) ** 2

        load = quad(pressure, first, last, points=[-last], epsabs=0.0, epsrel=1e-11, limit=500)[0]
        return load, last, top

    film = 1.0
    while contact(film)[0] > math.pi / 2.0:
        film *= 2.0
    while contact(film)[0] < math.pi / 2.0:
        film *= 0.5
    film = brentq(
        lambda h: min(contact(h)[0], 1e6) - math.pi / 2.0, film, 2.0 * film, xtol=1e-13 * film
    )
    _, last, top = contact(film)
    return RigidFilm(
        film, film / math.cos(last) ** 2, math.sqrt(2.0 * film) * math.tan(last), float(top)
    )


def limiting_film():
    """Rigid Barus film at an endless load: least film and that at the maximum, H_Moes/L^(2/3)."""
    from scipy.optimize import brentq

    first = -math.pi / 2.0
    last = brentq(lambda t: _between(t, t) - _between(first, t), 0.1, 1.5, xtol=1e-15)
    top = _between(-last, last) - _between(first, last)
    # alpha q reaches 1: lambda sqrt(2) H^(-3/2) top alpha p_h = 1, at any M and L
    film = (0.375 * math.pi**1.5 * top) ** (2.0 / 3.0) * 8.0 / math.pi
    return film, film / math.cos(last) ** 2
