"""Stiffness of the oil film: of its approach, tangent, secant, and a sum as one source prints it.

The bodies of a lubricated contact are further apart than those of a dry one under the same load:
by the distance that :func:`film_distance` finds. Its fall with the load is the compliance that the
film has in series with Hertz's.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from tribodyn.ehl.steady.contact_problem import SolvedContact
from tribodyn.ehl.steady.grid import estimate_film
from tribodyn.errors import ComputationError, require_one_of, require_positive, warn

#: Change of ln(w) for the slope of the estimated film.
_STEP = 1e-4
#: Offset of a dry contact in b^2/R, ``(ln(1/2) - 1/2)/2`` by the logarithmic potential of Hertz's
#: pressure in its middle, and its slope over ln(w), bodies held.
_DRY_OFFSET, _DRY_SLOPE = -0.5 * (math.log(2.0) + 0.5), -0.5 * math.log(2.0)


class InletChange(NamedTuple):
    """Derivatives by the logarithm of the load, in ``p_h`` and ``b p_h``; zero without an inlet."""

    pressure: float  #: of the pressure at the first node
    load: float  #: of the load before the first node
    pressure_film: float
    load_film: float


def inlet_change(solution: SolvedContact) -> InletChange:
    """How pressure and load of the inlet follow the load, as in the solver."""
    from tribodyn.ehl._kernel.inlet import inlet_slopes

    grid = solution._grid
    if grid.tail == 0.0:
        return InletChange(0.0, 0.0, 0.0, 0.0)

    def film(change: float) -> float:
        """Estimated film in the held unit b^2/R when ln(w) changes."""
        pressure = math.exp(0.5 * change)
        density = 1.0 + grid.oil[4] * pressure / (1.0 + grid.oil[5] * pressure)
        load = solution.moes_load * math.exp(change)
        return estimate_film(load, solution.moes_viscosity, density) * math.exp(change)

    slope = (film(_STEP) - film(-_STEP)) / (2.0 * _STEP)
    pressure_film, load_film, pressure_load, load_load = inlet_slopes(
        float(grid.X[0]), film(0.0), grid.lam
    )
    return InletChange(
        pressure_load + pressure_film * slope,
        load_load + load_film * slope,
        pressure_film,
        load_film,
    )


class FilmSlopes(NamedTuple):
    """Slopes over ``ln(w)`` [m], bodies, speed and oil held."""

    central: float  #: of the central film
    distance: float  #: of the distance that the film keeps, see :func:`film_distance`


def film_slopes(solution: SolvedContact) -> FilmSlopes:
    """How central film and distance follow the load, by one linear solve with the tangent."""
    from tribodyn.ehl._kernel.steady import tangent_of_film

    grid, inlet = solution._grid, inlet_change(solution)
    central, offset, products = tangent_of_film(
        grid.n,
        float(grid.X[0]),
        grid.dx,
        grid.lam,
        grid.oil,
        grid.free,
        inlet.pressure,
        0.5 * np.pi - inlet.load,
        grid.P,
        grid.H,
    )
    if products < 0:
        raise ComputationError(
            f"The tangent of the film was not found in {-products} steps of GMRES",
            why=f"the solution has {grid.n + 1} nodes and M = {solution.moes_load:.4g}",
            remedy="Use another number of nodes, or two solutions at 0.1 % more and less load",
        )
    unit = solution.film_unit
    change = float(offset) - _DRY_SLOPE + _by_inlet(solution, inlet.load)
    return FilmSlopes(float(central) * unit, change * unit)


def film_distance(solution: SolvedContact) -> float:
    """Distance that the film keeps between the bodies: Hertz's approach less theirs [m]."""
    grid = solution._grid
    before = _by_inlet(solution, 0.5 * np.pi - grid.load)
    return (grid.H0 - _DRY_OFFSET + before) * solution.film_unit


def _by_inlet(solution: SolvedContact, load: float) -> float:
    """Offset that a load before the first node adds: there the pressure falls as 1/x^3."""
    return load / math.pi * (math.log(-float(solution._grid.X[0])) + 0.5)


def approach_stiffness(solution: SolvedContact, length: float = 1.0) -> float:
    """Slope of the load over the approach of the bodies less Hertz's."""
    what = "distance that the film keeps", "stiffness", "secant"
    return _stiffness(solution, film_slopes(solution).distance, length, *what)


def tangent_stiffness(solution: SolvedContact, length: float = 1.0) -> float:
    """Slope of the load over the central film, ``K = -l dw/dh_c``."""
    what = "central film", "tangent stiffness", "approach"
    return _stiffness(solution, film_slopes(solution).central, length, *what)


def _stiffness(
    solution: SolvedContact, slope: float, length: float, distance: str, name: str, other: str
) -> float:
    """Stiffness from the slope of a distance over ln(w) [m]; warn if it is negative."""
    if slope >= 0.0:
        warn(
            "film-stiffness",
            f"The {distance} rises with the load by {slope:.3g} m per unit of ln(w), so that its "
            f"{name} is negative. {_reason(solution, other)}",
            stacklevel=3,
        )
    require_positive("length", length, "m")
    return -0.5 * np.pi * solution.hertz_pressure * solution.half_width * length / slope


def _reason(solution: SolvedContact, other: str) -> str:
    """Why a film rises with the load, and another kind of stiffness."""
    if solution.inlet == "flooded":
        return (
            f"With M = {solution.moes_load:.3g} and L = {solution.moes_viscosity:.3g} the contact "
            "turns from rigid to elastic: there the film barely depends on the load, and counts "
            f'as rigid among springs. Use kind = "{other}" there'
        )
    return (
        f"The inlet at X = {solution._grid.X[0]:.3g} starves it: take the flooded inlet or an "
        "earlier first node"
    )


def secant_stiffness(solution: SolvedContact, length: float = 1.0) -> float:
    """Sum of the nodal forces over their films, ``K = sum p_i A_i/h_i``."""
    require_positive("length", length, "m")
    grid, stiffness = solution._grid, solution.hertz_pressure / solution.film_unit
    return float(np.sum(grid.P / grid.H)) * grid.dx * solution.half_width * length * stiffness


def seed_stiffness(solution: SolvedContact, length: float = 1.0) -> float:
    """Sum as printed in the study "vibration-with-film" of the sources; not a stiffness."""
    require_positive("length", length, "m")
    grid = solution._grid
    # Under a light load no node lies within Hertz's width: those next to the middle count.
    inside = grid.H[np.abs(grid.X) <= max(1.0, 2.0 * grid.dx)]
    spread = float(inside.max() - inside.min())
    radius_over_width = solution.half_width / solution.film_unit
    total = float(np.sum(grid.P / grid.H)) * grid.n * grid.dx
    value = total * length * radius_over_width / spread
    warn(
        "seed-film-stiffness",
        f"The sum as printed gives {value:.4g} m, which is a length and doubles when the "
        f"{grid.n + 1} nodes are doubled: it counts the nodes twice and has no pressure in "
        'it. Use kind = "approach", or "secant" for a consistent sum',
    )
    return value


#: What the stiffness of a film can be.
KINDS = {
    "approach": approach_stiffness,
    "tangent": tangent_stiffness,
    "secant": secant_stiffness,
    "seed": seed_stiffness,
}


def film_stiffness(solution: SolvedContact, length: float, kind: str) -> float:
    """Stiffness of one kind over the length of the contact line."""
    require_one_of("kind", kind, KINDS)
    return float(KINDS[kind](solution, length))
