"""The steady contact between rough surfaces, by the flow factors of their mean film.

The factors follow from the film and act on it: the contact is solved with those of the film before,
as factors on viscosity and density at the nodes, until they settle.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tribodyn.ehl.flow_factors import FlowFactors
from tribodyn.ehl.steady.contact_case import ContactCase
from tribodyn.ehl.steady.contact_problem import ContactProblem
from tribodyn.ehl.steady.fallbacks import Verified, solve_problem
from tribodyn.errors import ComputationError, InputError, require_between
from tribodyn.types import Array

#: Passes at most, and change of the logarithms of the factors that ends them.
_PASSES, _SETTLED = 40, 1e-6


def solve_rough(
    case: ContactCase,
    problem: ContactProblem,
    smooth: Verified,
    factors: FlowFactors,
    sliding_speed: float,
) -> Verified:
    """Solve the mean film of rough surfaces, from that of smooth ones."""
    speed, grid = case.entrainment_speed, smooth.outcome.grid
    assert grid is not None  # a verified outcome has a grid
    require_between("sliding_speed", sliding_speed, -2.0 * speed, 2.0 * speed, "m/s")
    heights = problem.profile
    if heights is not None:
        heights = np.ascontiguousarray(heights[:: (problem.nodes - 1) // grid.n])
    problem = replace(problem, nodes=grid.n + 1, film_tolerance=0.0, profile=heights)
    thickness, solved = case.half_width**2 / case.equivalent_radius, smooth
    point = np.zeros((2, grid.n + 1))
    for _ in range(_PASSES):
        by_pressure, by_speed = _flow(factors, grid.H * thickness, sliding_speed / speed)
        # Oil whose density has the factor of the entrainment, and so much more viscosity.
        before, point = point, np.log(np.stack([by_speed / by_pressure, by_speed]))
        if np.max(np.abs(point - before)) < _SETTLED:
            return _with_smooth_grids(solved, smooth)
        oil = np.concatenate([problem.oil[:6], point[0], np.exp(point[1])])
        solved = solve_problem(replace(problem, oil=oil, start=grid), smooth.method)
        grid = solved.outcome.grid
        assert grid is not None
    raise ComputationError(
        f"film and flow factors did not settle in {_PASSES} passes: the last one changed them by "
        f"{np.max(np.abs(point - before)):.2g}",
        where="argument flow_factors",
        why=f"rms roughness {factors.roughness * 1e6:.4g} um, least film "
        f"{np.min(grid.H) * thickness * 1e6:.4g} um",
        remedy="Use a smaller roughness or sliding speed, or more nodes",
    )


def _flow(factors: FlowFactors, film: Array, slide: float) -> tuple[Array, Array]:
    try:
        return factors.flow(film, slide)
    except InputError as error:
        raise ComputationError(
            f"a least film of {np.min(film) * 1e6:.4g} um, {np.min(film) / factors.roughness:.3g} "
            f"times the rms roughness of {factors.roughness * 1e6:.4g} um",
            where="argument flow_factors",
            why="The flow factors hold from a film ratio of 0.5 on, of ridges across the flow "
            "from 1 on; below, asperities carry a part of the load",
            remedy="Use mixed_line_contact, or smoother surfaces",
        ) from error


def _with_smooth_grids(solved: Verified, smooth: Verified) -> Verified:
    """Give the solution the films of coarser grids of the smooth one, in proportion."""
    grid, smooth_grid = solved.outcome.grid, smooth.outcome.grid
    assert grid is not None
    assert smooth_grid is not None
    films = np.array(smooth.outcome.films)
    central, smooth_central = (float(np.interp(0.0, g.X, g.H)) for g in (grid, smooth_grid))
    scaled = tuple((films * (central / smooth_central)).tolist())
    return replace(solved, outcome=replace(solved.outcome, films=scaled))
