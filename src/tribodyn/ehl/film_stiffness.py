"""Stiffness of the oil film: tangent, secant, and a sum as one source prints it."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tribodyn.ehl.inlet_change import inlet_change
from tribodyn.errors import ComputationError, Problem, require_positive, warn

if TYPE_CHECKING:
    from tribodyn.ehl.solution import LineContactSolution


def central_film_slope(solution: LineContactSolution) -> float:
    """Slope ``d h_c / d ln(w)`` of the central film over the logarithm of the load."""
    from tribodyn.ehl.kernel.march_entry import tangent_of_film

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
            Problem(
                what=f"The tangent of the film was not found in {-products} steps of GMRES",
                why=f"the solution has {solution.nodes} nodes and M = {solution.moes_load:.4g}",
                remedy="Take another number of nodes, or two solutions at 0.1 % more and less load",
            )
        )
    return float(slope) * solution.film_unit


def tangent_stiffness(solution: LineContactSolution, length: float = 1.0) -> float:
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


def _reason(solution: LineContactSolution) -> str:
    """Why a film rises with the load."""
    if solution.inlet == "flooded":
        return (
            f"With M = {solution.moes_load:.3g} the contact turns from rigid to elastic: there the "
            "film hardly depends on the load and counts as rigid in a series of springs"
        )
    return (
        f"The inlet at X = {solution.domain[0]:.3g} starves it: take the flooded inlet or an "
        "earlier first node"
    )


def secant_stiffness(solution: LineContactSolution, length: float = 1.0) -> float:
    """Sum of the nodal forces over their films, ``K = sum p_i A_i/h_i``."""
    require_positive("length", length, "m")
    width = float(solution.position[1] - solution.position[0])
    return float(np.sum(solution.pressure / solution.film)) * width * length


def seed_stiffness(solution: LineContactSolution, length: float = 1.0) -> float:
    """Sum as the first source document prints it; not a stiffness."""
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
        f"{solution.nodes} nodes are doubled: it counts the nodes twice and has no pressure in "
        'it. Take kind = "tangent", or "secant" for a sum that is sound',
    )
    return value
