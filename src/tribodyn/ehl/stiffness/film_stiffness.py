"""Stiffness of the oil film: tangent, secant, and a sum as one source prints it."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from tribodyn.ehl.steady.contact_problem import SolvedContact
from tribodyn.ehl.steady.grid import estimate_film
from tribodyn.errors import ComputationError, require_one_of, require_positive, warn

#: Change of ln(w) for the slope of the estimated film.
_STEP = 1e-4


class InletChange(NamedTuple):
    """Derivatives by the logarithm of the load, in ``p_h`` and ``b p_h``; zero without an inlet."""

    pressure: float  #: of the pressure at the first node
    load: float  #: of the load before the first node
    pressure_film: float
    load_film: float


def inlet_change(solution: SolvedContact) -> InletChange:
    """How pressure and load of the inlet follow the load, as in the solver."""
    from tribodyn.ehl._kernel.inlet import flooded_inlet

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
    _, _, pressure_film, load_film, pressure_load, load_load = flooded_inlet(
        float(grid.X[0]), film(0.0), grid.lam, 1.0, 1.0
    )
    return InletChange(
        pressure_load + pressure_film * slope,
        load_load + load_film * slope,
        pressure_film,
        load_film,
    )


def central_film_slope(solution: SolvedContact) -> float:
    """Slope ``d h_c / d ln(w)`` of the central film over the logarithm of the load."""
    from tribodyn.ehl._kernel.steady import tangent_of_film

    grid, inlet = solution._grid, inlet_change(solution)
    slope, products = tangent_of_film(
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
            remedy="Take another number of nodes, or two solutions at 0.1 % more and less load",
        )
    return float(slope) * solution.film_unit


def tangent_stiffness(solution: SolvedContact, length: float = 1.0) -> float:
    """Slope of the load over the central film, ``K = -l dw/dh_c``."""
    require_positive("length", length, "m")
    slope = central_film_slope(solution)
    load = 0.5 * np.pi * solution.hertz_pressure * solution.half_width
    if slope >= 0.0:
        warn(
            "film-stiffness",
            f"The central film rises with the load by {slope:.3g} m per unit of ln(w), so that "
            f"its tangent stiffness is negative. {_reason(solution)}",
        )
    return -load * length / slope


def _reason(solution: SolvedContact) -> str:
    """Why a film rises with the load."""
    if solution.inlet == "flooded":
        return (
            f"With M = {solution.moes_load:.3g} the contact turns from rigid to elastic: there the "
            "film hardly depends on the load and counts as rigid in a series of springs"
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
    inside = grid.H[np.abs(grid.X) <= 1.0]
    spread = float(inside.max() - inside.min())
    radius_over_width = solution.half_width / solution.film_unit
    total = float(np.sum(grid.P / grid.H)) * grid.n * grid.dx
    value = total * length * radius_over_width / spread
    warn(
        "seed-film-stiffness",
        f"The sum as printed gives {value:.4g} m, which is a length and doubles when the "
        f"{grid.n + 1} nodes are doubled: it counts the nodes twice and has no pressure in "
        'it. Take kind = "tangent", or "secant" for a sum that is sound',
    )
    return value


#: What the stiffness of a film can be.
KINDS = {"tangent": tangent_stiffness, "secant": secant_stiffness, "seed": seed_stiffness}


def film_stiffness(solution: SolvedContact, length: float, kind: str) -> float:
    """Stiffness of one kind over the length of the contact line."""
    require_one_of("kind", kind, KINDS)
    return float(KINDS[kind](solution, length))
