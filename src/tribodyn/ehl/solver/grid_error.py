"""How far a contact is from an infinitely fine grid, by a grid half or twice as fine.

The errors of both films and of the pressure go with the square of the interval once the inlet is
resolved. Three films of the nested grids tell whether it is: the differences then fall fourfold. A
contact that does so is compared with half of its nodes, any other one with twice as many.
"""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from tribodyn.ehl.solver.contact_problem import ContactProblem, DiscreteContact, Outcome
from tribodyn.ehl.solver.engines import newton_engine
from tribodyn.ehl.solver.grid import FEWEST, MOST, cut_error
from tribodyn.types import Array

#: Fall of the differences that shows that the inlet is resolved, and that of the theory.
_RESOLVED, _FOURFOLD = 0.33, 0.25
#: Slowest assumed convergence, and safety factor of the estimate.
_SLOWEST, _MARGIN = 0.75, 1.3
#: Further margins of the least film: for its place, and for where the grid begins.
_BETWEEN, _CUT_LEAST = 1.15, 1.5


class GridError(NamedTuple):
    """Errors by the grid over film or greatest pressure; 1 where no other grid has a solution."""

    central: float
    minimum: float
    pressure: float


def grid_error(problem: ContactProblem, outcome: Outcome, cut: bool) -> GridError:
    """Estimate the errors of a solution by one more grid, and by where a flooded one begins."""
    grid = outcome.grid
    assert grid is not None  # a verified outcome has a grid
    domain_error = cut_error(grid.X[0], float(np.interp(0.0, grid.X, grid.H))) if cut else 0.0
    central, least, pressure = _of_intervals(problem, grid, outcome.films)
    return GridError(
        central + domain_error, least + _CUT_LEAST * domain_error, pressure + domain_error
    )


def _of_intervals(
    problem: ContactProblem, grid: DiscreteContact, films: tuple[float, ...]
) -> GridError:
    steps = np.abs(np.diff(films))
    fall = float(steps[-1] / steps[-2]) if steps.size > 1 and steps[-2] > 0.0 else 1.0
    n = grid.n
    first = (n // 2, 2 * n) if fall < _RESOLVED or 2 * n >= MOST else (2 * n, n // 2)
    for intervals in first:
        other = _on(problem, grid, intervals)
        if other is not None:
            figures, other_figures = _figures(grid), _figures(other)
            differences = np.abs(other_figures - figures) / figures
            if intervals < n:
                slow = min(max(fall, _FOURFOLD), _SLOWEST)
                factor = slow / (1.0 - slow)
            else:
                fall = (
                    differences[0] / (steps[-1] / figures[0])
                    if steps.size and steps[-1] > 0.0
                    else 1.0
                )
                factor = 1.0 / (1.0 - min(max(float(fall), _FOURFOLD), _SLOWEST))
            # The least film lies between nodes, and is never better known than the central one.
            differences[1] = _BETWEEN * max(differences[0], differences[1])
            central, least, pressure = (_MARGIN * factor * differences).tolist()
            if problem.film_tolerance > 0.0 and steps.size:
                central = float(steps[-1]) / (3.0 * films[-1])
            return GridError(central, least, pressure)
    return GridError(1.0, 1.0, 1.0)


def _figures(grid: DiscreteContact) -> Array:
    """Central and least film, and the greatest pressure."""
    central = float(np.interp(0.0, grid.X, grid.H))
    return np.array([central, np.min(grid.H[: grid.free + 1]), np.max(grid.P)])


def _on(problem: ContactProblem, grid: DiscreteContact, intervals: int) -> DiscreteContact | None:
    """The same contact on another grid, from its solution; None where that fails."""
    if not FEWEST - 1 <= intervals < MOST or (intervals < grid.n and grid.n % 2):
        return None
    profile = problem.profile
    if profile is not None:
        points, other_points = (np.linspace(0.0, 1.0, count + 1) for count in (grid.n, intervals))
        profile = np.ascontiguousarray(
            np.interp(other_points, points, profile[:: (profile.size - 1) // grid.n])
        )
    outcome = newton_engine(
        replace(
            problem,
            nodes=intervals + 1,
            profile=profile,
            start=grid,
            film_tolerance=0.0,
            coarsest=min(intervals, grid.n),
        )
    )
    return outcome.grid if outcome.converged else None
