"""The lubricated point or elliptical contact solved: pressure and film over its area."""

from __future__ import annotations

import math

import numpy as np

from tribodyn.ehl.area.area_case import Grid, PointCase, point_case, point_grid
from tribodyn.ehl.area.multigrid import AreaProblem, Outcome, solve_area
from tribodyn.ehl.area.solution import PointContactSolution
from tribodyn.errors import ComputationError, InputError, require_between, warn
from tribodyn.lubricant import Lubricant
from tribodyn.nomenclature import require_number, require_whole
from tribodyn.record import from_parts
from tribodyn.types import Array

#: Nodes along the lines with which automatic grids begin and end.
_FIRST, _LAST = 129, 513
#: Estimated relative error of the central film above which stated nodes give a warning.
STATED_LIMIT = 0.02


def solve_point_contact(
    normal_force: float,
    radius_x: float,
    radius_y: float,
    entrainment_speed: float,
    lubricant: Lubricant,
    effective_modulus: float,
    *,
    entrainment_angle: float = 0.0,
    nodes: str | int = "auto",
    viscosity_law: str = "roelands",
    compressible: bool = True,
    tolerance: float = 1e-4,
    film_tolerance: float = 0.01,
) -> PointContactSolution:
    """Pressure and film of a lubricated point or elliptical contact: steady, isothermal, Newtonian.

    Parameters
    ----------
    normal_force : float [N]
        Load of the contact.
    radius_x, radius_y : float [m]
        Principal radii of the gap, ``1/R = 1/R_1 + 1/R_2`` along each of its axes.
    entrainment_speed : float [m/s]
        HALF the sum of the surface speeds.
    lubricant : Lubricant
        Oil at the temperature of the inlet.
    effective_modulus : float [Pa]
        ``2/E' = (1-nu1^2)/E1 + (1-nu2^2)/E2``.
    entrainment_angle : float [rad]
        Angle from the x axis to the direction of entrainment, towards y.
    nodes : "auto" or int
        Nodes of the grid along the axis that the entrainment passes faster: 2^k + 1 from 33 to 513;
        those across follow from the shape of the contact. Automatic: 129, refined until the
        estimated error of the central film meets ``film_tolerance``.
    viscosity_law : {"roelands", "barus", "isoviscous"}
        How the viscosity rises with pressure.
    compressible : bool
        Whether the density rises with pressure, after Dowson and Higginson.
    tolerance, film_tolerance : float
        Relative change of the pressure in the last cycle; relative error of the central film by
        the grid, for automatic nodes.

    Returns
    -------
    PointContactSolution

    Raises
    ------
    InputError
        If a value is out of range; the message names it, its limits and a remedy.
    ComputationError
        If the solver does not converge, with a log of all attempts.

    Warns
    -----
    ModelWarning
        Code ``film-resolution`` where the finest grid does not meet ``film_tolerance``, or where
        stated nodes leave an estimated error above 2 % of the central film.

    Valid for smooth bodies of a linear elastic material, half-spaces against the contact, flooded.
    Source: Venner and Lubrecht, Multilevel Methods in Lubrication (2000); Love (1929) for the
    influence of the cells, summed by FFT.

    Examples
    --------
    >>> from tribodyn.lubricant import Lubricant
    >>> oil = Lubricant(0.05, 880.0, 2e-8)
    >>> contact = solve_point_contact(100.0, 0.01, 0.01, 1.0, oil, 2.2e11, nodes=65)
    >>> round(contact.hertz_pressure * 1e-9, 3), round(contact.central_film * 1e6, 2)
    (1.328, 0.22)
    """
    case = point_case(
        normal_force, (radius_x, radius_y), entrainment_speed, lubricant, effective_modulus,
        entrainment_angle, viscosity_law, compressible,
    )  # fmt: skip
    require_between("tolerance", require_number("tolerance", tolerance), 1e-8, 1e-2)
    limit = require_number("film_tolerance", film_tolerance)
    require_between("film_tolerance", limit, 1e-4, 0.1)
    automatic, count = requested_nodes(nodes, _FIRST, _LAST)
    attempts: list[str] = []
    while True:
        grid = point_grid(case, count - 1)
        problem = point_problem(case, grid, tolerance)
        outcome = solve_area(problem)
        error = outcome.film_error
        fine = outcome.converged and error <= limit
        if fine or not automatic or count >= _LAST:
            break
        attempts.append(f"{count} nodes: {outcome.message or f'film error {error:.2g}'}")
        count = 2 * count - 1
    if not outcome.converged:
        raise _unsolved(case, count, [*attempts, f"{count} nodes: {outcome.message}"])
    solution = assemble(case, grid, problem.load, outcome, tuple(attempts))
    wanted = limit if automatic else STATED_LIMIT
    if error > wanted:
        remedy = "use the extrapolated value" if count >= _LAST else 'use nodes = "auto" or more'
        warn(
            "film-resolution",
            f"With {count} nodes along the contact the central film has an estimated error of "
            f"{error:.2g} of it; the limit is {wanted:g}: {remedy}",
            stacklevel=2,
        )
    return solution


def requested_nodes(nodes: object, first: int, last: int) -> tuple[bool, int]:
    """Whether the grid is automatic, and its nodes."""
    if nodes == "auto":
        return True, first
    count = require_whole("nodes", nodes, 33)
    if count > last or (count - 1) & (count - 2):
        raise InputError(
            f"nodes = {count}",
            "argument nodes",
            f"multigrid halves the grid: 2^k + 1 nodes from 33 to {last}",
            'Use 65, 129 or 257, or nodes = "auto"',
        )
    return False, count


def _unsolved(case: PointCase, count: int, attempts: list[str]) -> ComputationError:
    return ComputationError(
        f"no film found for M = {case.moes_load:.4g}, L = {case.moes_viscosity:.4g}, half axes "
        f"{case.axes[0] * 1e3:.3g} and {case.axes[1] * 1e3:.3g} mm ({'; '.join(attempts)})",
        "solve_point_contact",
        "the grid must resolve inlet and film: the thinner the film, the finer",
        f"Use more nodes than {count}"
        if count < _LAST
        else "Check speed, viscosity and load, or "
        "use a film formula (tribodyn.ehl.nijenbanning_central)",
    )


def point_problem(case: PointCase, grid: Grid, tolerance: float) -> AreaProblem:
    """Dimensionless problem of a contact on its grid."""
    a, b = case.axes
    hx, hy = grid.steps
    curvature, ratio = case.radii[0] / case.radii[1], b / a
    X, Y = np.meshgrid(grid.x, grid.y)
    gap = 0.5 * X**2 + 0.5 * curvature * Y**2
    film, load = case.film_estimate, 2.0 * np.pi / 3.0 * ratio
    # Offset of the film: the dry contact approaches by its elastic deflection.
    offset = film - float(case.hertz.approach) / case.film_unit
    far = gap + offset + case.elasticity * load / np.maximum(np.hypot(X, Y), 1e-9)
    # A thick film spreads the pressure over the inlet.
    spread = 1.0 + film
    start = np.sqrt(np.maximum(1.0 - (X**2 + (Y / ratio) ** 2) / spread, 0.0))
    for edge in np.s_[0, :], np.s_[-1, :], np.s_[:, 0], np.s_[:, -1]:
        start[edge] = far_pressure(
            X[edge], Y[edge], np.maximum(far[edge], film), curvature, case.direction, case.lam
        )
    x, y = grid.x, grid.y
    edges = x[0] + hx / 2, x[-1] - hx / 2, y[0] + hy / 2, y[-1] - hy / 2
    load -= outside_load(edges, offset, curvature, case.direction, case.lam)
    return AreaProblem(
        gap, hx, hy, *case.direction, case.lam, case.oil, case.elasticity, load, start, film,
        (int(np.argmin(np.abs(y))), int(np.argmin(np.abs(x)))), tolerance,
    )  # fmt: skip


def assemble(
    case: PointCase, grid: Grid, load: float, outcome: Outcome, attempts: tuple[str, ...]
) -> PointContactSolution:
    """Solution in SI along the axes of the user."""
    a, unit, pressure = case.axes[0], case.film_unit, float(case.hertz.maximum_pressure)
    x, y = a * grid.x, a * grid.y
    fields = [pressure * outcome.pressure, unit * outcome.film]
    angle = case.entrainment_angle
    if case.swapped:
        x, y = y, x
        fields = [field.T for field in fields]
    # The solver entrains towards the positive axes.
    if np.cos(angle) < -1e-9:
        x, fields = -x[::-1], [field[:, ::-1] for field in fields]
    if np.sin(angle) < -1e-9:
        y, fields = -y[::-1], [field[::-1] for field in fields]
    fields = [np.ascontiguousarray(field) for field in fields]
    central = outcome.central_film
    coarse = outcome.coarse_central_film
    step = (central - coarse) / 3.0
    outside = 1.0 - load / (2.0 * np.pi / 3.0 * case.axes[1] / a)
    return from_parts(
        PointContactSolution,
        *(case, outcome),
        x=x,
        y=y,
        pressure=fields[0],
        film=fields[1],
        central_film=central * unit,
        minimum_film=float(outcome.film[outcome.pressure > 0.0].min()) * unit,
        central_film_error=outcome.film_error * central * unit,
        central_film_extrapolated=(central + step) * unit,
        hertz_pressure=pressure,
        semi_axis_x=float(case.hertz.first_semi_axis),
        semi_axis_y=float(case.hertz.second_semi_axis),
        hertz_approach=float(case.hertz.approach),
        maximum_pressure=float(outcome.pressure.max()) * pressure,
        approach=-outcome.offset * unit,
        ellipticity=float(case.hertz.second_semi_axis / case.hertz.first_semi_axis),
        outside_load=outside * case.normal_force,
        load_error=outcome.load_error * (1.0 - outside),
        nodes_x=x.size,
        nodes_y=y.size,
        attempts=attempts,
    )


#: Directions and points along each in the integral of the pressure.
_DIRECTIONS, _POINTS = 720, 12


def far_pressure(
    x: Array, y: Array, h: Array, curvature: float, direction: tuple[float, float], lam: float
) -> Array:
    """Pressure at positions with the gap ``h``; ``curvature`` is ``D``."""
    along = direction[0] * x / (3.0 + 2.0 * curvature)
    across = direction[1] * curvature * y / (2.0 + 3.0 * curvature)
    return np.asarray(lam * np.maximum(-along - across, 0.0) / h**2)


def outside_load(
    edges: tuple[float, float, float, float], offset: float, curvature: float,
    direction: tuple[float, float], lam: float,
) -> float:  # fmt: skip
    """Integral of the pressure outside of a rectangle (x from, to, y from, to)."""
    angle = 2.0 * math.pi * (np.arange(_DIRECTIONS) + 0.5) / _DIRECTIONS
    c, s = np.cos(angle), np.sin(angle)
    reach = np.minimum(
        np.where(c > 0.0, edges[1], edges[0]) / c, np.where(s > 0.0, edges[3], edges[2]) / s
    )
    points, weights = np.polynomial.legendre.leggauss(_POINTS)
    share = 0.5 * (points + 1.0)
    # With t = reach/r the integral over the radius has the limits 0 and 1.
    square = 0.5 * (c**2 + curvature * s**2) * reach**2
    gap = offset * share[:, None] ** 2 + square
    radial = 0.5 * weights @ (reach**3 / gap**2)
    source = far_pressure(c, s, np.ones_like(c), curvature, direction, lam)
    return float(np.sum(source * radial)) * 2.0 * math.pi / _DIRECTIONS
