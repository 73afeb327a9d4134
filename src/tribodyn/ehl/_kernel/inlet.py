"""The flooded inlet before the grid, and the wedge of Grubin that a solver starts from."""

from __future__ import annotations

import numba as nb
import numpy as np

from tribodyn.ehl._kernel.elementary import INNER
from tribodyn.ehl._kernel.film_sum import Grid, film_sum
from tribodyn.ehl._kernel.grid_transfer import scale_to_load
from tribodyn.ehl._kernel.newton import Equation, NewtonWork
from tribodyn.ehl._kernel.reynolds import BARUS, ROELANDS
from tribodyn.types import Array

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(40)


@nb.njit(**INNER)
def _wedge(
    x: float, film: float, lam: float, curvature: float, s: float
) -> tuple[float, float, float]:
    """Integrand of the pressure at distances from the centre, with its slopes over film and load.

    Compiled for a number, and in Python for an array.
    """
    root = np.sqrt(np.maximum(x * x - s * s, 0.0))
    logarithm = s * s * np.log((x + root) / s) if s > 0.0 else 0.0 * x
    dry = 0.5 * curvature * (x * root - logarithm)
    gap = dry + film
    weight = lam * x * x / (gap * gap * gap)
    by_film = -3.0 * dry / gap
    # A tenth more load widens s^2 by a tenth: d D/d ln(w) = -(c/2) s^2 ln((x + r)/s).
    by_load = -0.5 * curvature * logarithm * (1.0 + by_film)
    return weight * dry, weight * by_film, weight * by_load


@nb.njit(**INNER)
def flooded_inlet(
    start: float, film: float, lam: float, curvature: float, s: float
) -> tuple[float, float, float, float, float, float]:
    """Pressure at the first node and load before it, with their slopes."""
    edge = 1.0 / abs(start)
    pressure = load = pressure_film = load_film = pressure_load = load_load = 0.0
    for q in range(_NODES.size):
        x = 2.0 / (edge * (1.0 + _NODES[q]))
        weight, arm = 0.5 * edge * _WEIGHTS[q], x - 1.0 / edge
        wedge_pressure, by_film, by_load = _wedge(x, film, lam, curvature, s)
        pressure += weight * wedge_pressure
        load += weight * wedge_pressure * arm
        pressure_film += weight * by_film
        load_film += weight * by_film * arm
        pressure_load += weight * by_load
        load_load += weight * by_load * arm
    return pressure, load, pressure_film, load_film, pressure_load, load_load


def inlet_slopes(start: float, film: float, lam: float) -> tuple[float, float, float, float]:
    """The same slopes in Python, at the reference load: over the film, then over the load."""
    edge = 1.0 / abs(start)
    x = 2.0 / (edge * (1.0 + _NODES))
    _, by_film, by_load = _wedge.py_func(x, film, lam, 1.0, 1.0)
    weight = 0.5 * edge * _WEIGHTS
    lever = weight * (x - 1.0 / edge)
    slopes = weight @ by_film, lever @ by_film, weight @ by_load, lever @ by_load
    return float(slopes[0]), float(slopes[1]), float(slopes[2]), float(slopes[3])


#: Film of Grubin: the reduced pressure reaches this part of its bound at the edge of the contact.
_GRUBIN = 0.97
#: Part of the bound at which the pressure of the inlet is cut, and the greatest such pressure.
_BOUND, _HIGHEST = 0.985, 0.5
#: Position where the inlet pressure has faded under that of the dry contact.
_FADED = -0.5
#: Film [b^2/R] beyond which the bodies are taken as rigid, and the position in sqrt(2 R h) at
#: which the film between rigid cylinders parts.
_RIGID, _PARTING = 2.0, 0.4754


@nb.njit(**INNER)
def dry_gap(x: float) -> float:
    """Gap of the dry contact outside of it, in b^2/R."""
    a = abs(x)
    if a <= 1.0:
        return 0.0
    root = np.sqrt(a * a - 1.0)
    return 0.5 * (a * root - np.log(a + root))


@nb.njit(**INNER)
def piezoviscosity(oil: Array) -> float:
    """Slope of ln(viscosity) over the dimensionless pressure at ambient pressure."""
    if oil[0] == ROELANDS:
        return oil[1] * oil[3] / oil[2]
    return oil[1] if oil[0] == BARUS else 0.0


@nb.njit(**INNER)
def free_nodes(n: int, P: Array) -> int:
    """Last node with pressure."""
    k = n - 1
    while k > 2 and not P[k] > 0.0:
        k -= 1
    return k


@nb.njit(**INNER)
def _reduced_pressure(
    n: int, start: float, dx: float, lam: float, film: float, tail: float, q: Array
) -> float:
    """Isoviscous pressure of the inlet wedge at X <= -1, and its value at the edge."""
    q[0] = tail
    gradient_before = lam * dry_gap(start) / (film + dry_gap(start)) ** 3
    last = tail
    for i in range(1, n + 1):
        x = start + i * dx
        if x > -1.0:
            break
        d = dry_gap(x)
        gradient = lam * d / (film + d) ** 3
        last += 0.5 * dx * (gradient_before + gradient)
        q[i] = last
        gradient_before = gradient
    return last


@nb.njit(**INNER)
def _rigid_pressure(
    n: int, start: float, dx: float, lam: float, film: float, tail: float, q: Array
) -> None:
    """Isoviscous pressure between rigid cylinders, which ends with its gradient."""
    end = _PARTING * np.sqrt(2.0 * film)
    leaving, last, gradient_before = film + 0.5 * end * end, tail, 0.0
    for i in range(n + 1):
        x = start + i * dx
        h = film + 0.5 * x * x
        gradient = lam * (h - leaving) / (h * h * h)
        if i > 0:
            last = last + 0.5 * dx * (gradient_before + gradient) if x < end else 0.0
        q[i] = max(last, 0.0)
        gradient_before = gradient


@nb.njit(**INNER)
def _thickened(q: float, slope: float) -> float:
    """Pressure of the reduced pressure ``q`` under Barus' law."""
    if slope > 2.0:
        q = -np.log(1.0 - min(slope * q, _BOUND)) / slope
    return min(q, _HIGHEST)


@nb.njit(inline="always", **INNER)
def cold_start(
    grid: Grid, start: float, equation: Equation, film: float, work: NewtonWork, P: Array, H: Array
) -> float:
    """Fill pressure and film without an earlier solution; the rigid offset.

    Grubin (1949): the oil thickens until the reduced pressure of the inlet wedge nears 1/alpha
    at the edge of the contact; bisected for the film where the oil is piezoviscous. Thick films
    start from rigid cylinders.
    """
    n, dx, lam, oil, tail = grid.n, grid.dx, equation.lam, equation.oil, equation.tail
    q = work.fields.lneta
    slope = piezoviscosity(oil)
    wedge = film
    if slope > 2.0:
        low, high = film, 10.0 * film
        for _ in range(20):
            wedge = np.sqrt(low * high)
            if slope * _reduced_pressure(n, start, dx, lam, wedge, tail, q) > _GRUBIN:
                low = wedge
            else:
                high = wedge
    edge = _reduced_pressure(n, start, dx, lam, wedge, tail, q)
    edge = _thickened(edge, slope)
    rigid = film > _RIGID
    if rigid:
        _rigid_pressure(n, start, dx, lam, film, tail, q)
    for i in range(n + 1):
        x = start + i * dx
        if rigid or x <= -1.0:
            P[i] = _thickened(q[i], slope)
        else:
            inside = np.sqrt(max(1.0 - x * x, 0.0))
            faded = edge * max(_FADED - x, 0.0) / (_FADED + 1.0)
            P[i] = max(inside, faded)
    P[n] = 0.0
    k = free_nodes(n, P)
    scale_to_load(n, dx, k, equation.target, tail, P)
    film_sum(n, grid.influence, grid.plan, P, work.linear.transform, H)
    least = np.inf
    for i in range(n + 1):
        H[i] += equation.shape[i]
        if abs(start + i * dx) < max(0.9, dx):
            least = min(least, H[i])
    offset = film - least
    for i in range(n + 1):
        H[i] += offset
    return offset
