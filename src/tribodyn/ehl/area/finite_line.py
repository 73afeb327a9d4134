"""Rollers of finite length: their profile, and pressure and film of the contact."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from tribodyn.ehl.area.area_case import Grid
from tribodyn.ehl.area.multigrid import AreaProblem, Outcome, solve_area
from tribodyn.ehl.area.point_contact import STATED_LIMIT, requested_nodes
from tribodyn.ehl.area.solution import FiniteLineSolution
from tribodyn.ehl.solver.contact_case import ContactCase, require_kind, si_case
from tribodyn.ehl.solver.grid import estimate_film
from tribodyn.ehl.steady.line_contact import solve_line_contact
from tribodyn.errors import (
    ComputationError,
    InputError,
    quiet,
    require_between,
    require_positive,
    warn,
)
from tribodyn.lubricant import Lubricant
from tribodyn.nomenclature import require_number
from tribodyn.record import from_parts
from tribodyn.types import Array


@dataclass(frozen=True)
class RollerProfile:
    """Drop of a roller's surface over the distance from its middle; see the constructors.

    Parameters
    ----------
    drop : callable
        Drop [m] at distances [m] from the middle, an array of the same shape.
    name : str
        What it is called.

    Examples
    --------
    >>> profile = RollerProfile.crowned(2.0)
    >>> profile.drop(np.array([0.0, 5e-3])).tolist()
    [0.0, 6.25e-06]
    """

    drop: Callable[[Array], Array] = field(repr=False)
    name: str

    @classmethod
    def straight(cls) -> RollerProfile:
        """No drop but the rounded edges."""
        return cls(np.zeros_like, "straight")

    @classmethod
    def crowned(cls, crown_radius: float) -> RollerProfile:
        """Crown of a constant radius over the full length.

        Parameters
        ----------
        crown_radius : float [m]

        Returns
        -------
        RollerProfile

        Raises
        ------
        InputError
            If the radius is not positive.
        """
        require_positive("crown_radius", crown_radius, "m")
        return cls(lambda y: 0.5 * y**2 / crown_radius, f"crowned, radius {crown_radius:.4g} m")

    @classmethod
    def dub_off(cls, straight_length: float, radius: float) -> RollerProfile:
        """Straight in the middle, then an arc that starts without an edge.

        Parameters
        ----------
        straight_length, radius : float [m]
            Length of the straight part, and radius of the arcs.

        Returns
        -------
        RollerProfile

        Raises
        ------
        InputError
            If one of them is not positive.
        """
        require_positive("straight_length", straight_length, "m")
        require_positive("radius", radius, "m", remedy="A rounded edge has about 1e-3 m")
        half = 0.5 * straight_length

        def drop(y: Array) -> Array:
            """Drop of the arc, which ends where it is steep."""
            beyond = np.minimum(np.maximum(np.abs(y) - half, 0.0) / radius, 0.99)
            return np.asarray(radius * (1.0 - np.sqrt(1.0 - beyond**2)))

        return cls(drop, f"straight over {straight_length * 1e3:.4g} mm, then {radius:.4g} m")

    @classmethod
    def logarithmic(
        cls, length: float, load_per_length: float, effective_modulus: float, half_width: float
    ) -> RollerProfile:
        """Profile after Lundberg, which makes the dry pressure even at one load.

        ``2 w/(pi E') ln(1/[1 - (1 - 0.3033 b/a) (y/a)^2])`` with half the length a and the half
        width b of the contact, in the form of Johns and Gohar.

        Parameters
        ----------
        length : float [m]
            Length of the roller.
        load_per_length : float [N/m]
            Load for which the profile is made.
        effective_modulus : float [Pa]
            ``2/E' = (1-nu1^2)/E1 + (1-nu2^2)/E2``.
        half_width : float [m]
            Half width of the dry contact at that load.

        Returns
        -------
        RollerProfile

        Raises
        ------
        InputError
            If a value is out of range.

        Source: Lundberg (1939); Johns and Gohar, Tribology International 14 (1981).
        """
        require_positive("length", length, "m")
        require_positive("load_per_length", load_per_length, "N/m")
        require_positive("effective_modulus", effective_modulus, "Pa")
        require_between("half_width", half_width, 1e-9, 0.5 * length, "m")
        half = 0.5 * length
        rounding = 1.0 - 0.3033 * half_width / half
        height = 2.0 * load_per_length / (math.pi * effective_modulus)

        def drop(y: Array) -> Array:
            """Drop of the curve, which goes on as steeply beyond the end."""
            inside = np.minimum(np.abs(y) / half, 1.0)
            slope = 2.0 * rounding / (1.0 - rounding)
            outside = np.maximum(np.abs(y) / half - 1.0, 0.0)
            return np.asarray(height * (-np.log1p(-rounding * inside**2) + slope * outside))

        return cls(drop, f"logarithmic for {load_per_length * 1e-3:.4g} N/mm")


#: Cell along the roller on the first grid [b], most cells, and drop [b^2/R] that an edge reaches.
_CELL, _MOST_CELLS, _ROUNDED = 0.25, 1024, 4.0
#: Overlap of the bodies at the ends that still counts as a film of zero, over the estimated film.
_OVERLAP = 1.0
#: Greatest gap [b^2/R] beyond the ends: the oil carries nothing there.
_OPEN = 40.0
#: Roller length over the half width of the contact that a grid resolves.
_LENGTHS = (4.0, 400.0)
#: Nodes across with which automatic grids begin and end.
_FIRST, _LAST = 65, 257


def solve_finite_line_contact(
    normal_force: float,
    length: float,
    equivalent_radius: float,
    entrainment_speed: float,
    lubricant: Lubricant,
    effective_modulus: float,
    *,
    profile: RollerProfile,
    edge_radius: float = 1e-3,
    nodes: str | int = "auto",
    viscosity_law: str = "roelands",
    compressible: bool = True,
    tolerance: float = 1e-4,
    film_tolerance: float = 0.01,
) -> FiniteLineSolution:
    """Pressure and film of a lubricated roller of finite length: steady, isothermal, Newtonian.

    Parameters
    ----------
    normal_force : float [N]
        Load of the roller, in its middle.
    length : float [m]
        Length of the roller between its rounded edges.
    equivalent_radius : float [m]
        Reduced radius of curvature.
    entrainment_speed : float [m/s]
        HALF the sum of the surface speeds.
    lubricant : Lubricant
        Oil at the temperature of the inlet.
    effective_modulus : float [Pa]
        ``2/E' = (1-nu1^2)/E1 + (1-nu2^2)/E2``.
    profile : RollerProfile
        Shape over the length: straight, crowned, dub-off or logarithmic.
    edge_radius : float [m]
        Radius of the edges, which begin at the ends of the length.
    nodes : "auto" or int
        Nodes of the grid in the direction of rolling: 2^k + 1 from 33 to 257; those along the
        roller follow, four for every half width of the contact. Automatic: 65, refined until the
        estimated error of the film at mid length meets ``film_tolerance``.
    viscosity_law, compressible, tolerance, film_tolerance
        As for :func:`tribodyn.ehl.solve_point_contact`.

    Returns
    -------
    FiniteLineSolution

    Raises
    ------
    InputError
        If a value is out of range; the message names it, its limits and a remedy.
    ComputationError
        If the solver does not converge.

    Warns
    -----
    ModelWarning
        Code ``film-resolution`` as for :func:`tribodyn.ehl.solve_point_contact`.

    Both bodies are half-spaces, the roller too: its free end faces, which lower the pressure at
    sharp ends, are not counted. Source: as :func:`tribodyn.ehl.solve_point_contact`; Park and Kim,
    Wear 223 (1998), and Zhu, Wang, Ren and Wang (2012) for rollers.

    Examples
    --------
    >>> from tribodyn.lubricant import Lubricant
    >>> roller = solve_finite_line_contact(
    ...     400.0, 4e-3, 8e-3, 2.0, Lubricant(0.05, 880.0, 2e-8), 2.2e11,
    ...     profile=RollerProfile.crowned(1.0), nodes=65,
    ... )
    >>> round(roller.edge_pressure_ratio, 1), roller.line_is_enough
    (0.8, False)
    """
    force = require_number("normal_force", normal_force)
    extent = require_number("length", length)
    require_positive("normal_force", force, "N", remedy="1 kN is 1000 N")
    require_positive("length", extent, "m", remedy="20 mm are 20e-3 m")
    case = si_case(
        force / extent, equivalent_radius, entrainment_speed, lubricant, effective_modulus,
        viscosity_law, compressible,
    )  # fmt: skip
    ratio = extent / case.half_width
    remedy = "Use solve_line_contact for a longer one, solve_point_contact for a shorter one"
    require_between("length over half width", ratio, *_LENGTHS, remedy=remedy)
    _check_profile(profile)
    edge, limit = _checked_numbers(edge_radius, tolerance, film_tolerance)
    automatic, count = requested_nodes(nodes, _FIRST, _LAST)
    attempts: list[str] = []
    while True:
        grid, problem = _problem(case, extent, (profile, edge), count - 1, tolerance)
        outcome = solve_area(problem)
        if not automatic or count >= _LAST or (outcome.converged and outcome.film_error <= limit):
            break
        error = f"film error {outcome.film_error:.2g}"
        attempts.append(f"{count} nodes: {outcome.message or error}")
        count = 2 * count - 1
    if not outcome.converged:
        raise ComputationError(
            f"no film found for M = {case.scales.moes_load:.4g}, L = "
            f"{case.scales.moes_viscosity:.4g} ({'; '.join([*attempts, outcome.message])})",
            "solve_finite_line_contact",
            "the grid must resolve inlet and film: the thinner the film, the finer",
            f"Use more nodes than {count}" if count < _LAST else "Check load, speed and profile",
        )
    wanted = limit if automatic else STATED_LIMIT
    if outcome.film_error > wanted:
        warn(
            "film-resolution",
            f"With {count} nodes across the contact the film at mid length has an estimated error "
            f"of {outcome.film_error:.2g} of it; the limit is {wanted:g}. Use more nodes, or the "
            "extrapolated value",
            stacklevel=2,
        )
    _warn_of_ends(outcome)
    return _assemble(case, grid, problem, outcome, (force, extent, profile, tuple(attempts)))


def _checked_numbers(
    edge_radius: float, tolerance: float, film_tolerance: float
) -> tuple[float, float]:
    """Edge radius and tolerance of the film in their ranges."""
    edge = require_number("edge_radius", edge_radius)
    require_between("edge_radius", edge, 1e-4, 1.0, "m", remedy="Rollers have about 1e-3 m")
    require_between("tolerance", require_number("tolerance", tolerance), 1e-8, 1e-2)
    limit = require_number("film_tolerance", film_tolerance)
    require_between("film_tolerance", limit, 1e-4, 0.1)
    return edge, limit


def _warn_of_ends(outcome: Outcome) -> None:
    """Warn of a film at the ends that the grid does not resolve."""
    if float(outcome.film.min()) <= 0.0:
        warn(
            "film-resolution",
            "The film at the ends of the roller is thinner than the grid resolves, and counts as "
            "zero there. Use more nodes, a profile that drops further at its ends, or a greater "
            "edge_radius",
            stacklevel=3,
        )


def _check_profile(profile: object) -> None:
    why = "the shape of the roller decides how its ends are loaded"
    remedy = "Give tribodyn.ehl.RollerProfile.straight(), .crowned(...) or .logarithmic(...)"
    require_kind("profile", profile, isinstance(profile, RollerProfile), why, remedy)


def _dry_gap(x: Array) -> Array:
    """Gap of the dry line contact."""
    u = np.maximum(np.abs(x), 1.0)
    root = np.sqrt(u * u - 1.0)
    return np.asarray(0.5 * (u * root - np.log(u + root)))


def _problem(
    case: ContactCase,
    length: float,
    shape: tuple[RollerProfile, float],
    intervals: int,
    tolerance: float,
) -> tuple[Grid, AreaProblem]:
    """Dimensionless problem of a roller, and its grid in half widths."""
    scales, b = case.scales, case.half_width
    film = float(estimate_film(scales.moes_load, scales.moes_viscosity, scales.density_ratio))
    s = math.sqrt(2.0 * film)
    inlet, outlet = 1.0 + max(1.4, 4.0 * s), 1.0 + max(0.35, 0.8 * s)
    hx = (inlet + outlet) / intervals
    x: Array = hx * (np.arange(intervals + 1.0) - 2 * round(inlet / (2.0 * hx)))
    profile, edge_radius = shape
    unit = b**2 / case.equivalent_radius
    reach = 0.5 * length / b + 1.0 + math.sqrt(2.0 * _ROUNDED * edge_radius * unit) / b
    cells = min(16 * math.ceil(2.0 * reach / (_CELL * _FIRST / intervals) / 16.0), _MOST_CELLS)
    hy = 2.0 * reach / cells
    y: Array = hy * (np.arange(cells + 1.0) - cells // 2)
    beyond = np.maximum(np.abs(y * b) - 0.5 * length, 0.0)
    drop = (np.asarray(profile.drop(y * b), dtype=float) + 0.5 * beyond**2 / edge_radius) / unit
    if drop.shape != y.shape or not np.all(np.isfinite(drop)):
        what = f"profile.drop returns the shape {drop.shape} for {y.size} positions, or no numbers"
        raise InputError(what, "argument profile", "every position needs a drop", "Return it in m")
    drop = np.minimum(drop - drop.min(), _OPEN)
    X, _ = np.meshgrid(x, y)
    gap = 0.5 * X**2 + drop[:, None]
    start = np.sqrt(np.maximum(1.0 - X**2 / (1.0 + film), 0.0)) * (drop < 0.5)[:, None]
    # Far inlet: the oil of the line ahead of the grid, see ``far_field``.
    ahead = float(_dry_gap(x[:1])[0]) + film + drop
    start[:, 0] = scales.lam * inlet / (3.0 * ahead**2)
    start[0], start[-1], start[:, -1] = 0.0, 0.0, 0.0
    load = 0.5 * math.pi * length / b - hy * float(np.sum(scales.lam / (3.0 * ahead)))
    middle = (cells // 2, int(np.argmin(np.abs(x))))
    problem = AreaProblem(
        gap, hx, hy, 1.0, 0.0, scales.lam, scales.oil, 0.5 / math.pi, load, start, film, middle,
        tolerance, _OVERLAP,
    )  # fmt: skip
    return Grid(x, y), problem


#: Force, length, profile, and what failed before.
_Stated = tuple[float, float, RollerProfile, tuple[str, ...]]


def _assemble(
    case: ContactCase, grid: Grid, problem: AreaProblem, outcome: Outcome, stated: _Stated
) -> FiniteLineSolution:
    """Solution in SI, with the infinite line at the load of mid length."""
    force, length, profile, attempts = stated
    b, pressure = case.half_width, case.hertz_pressure
    unit = b**2 / case.equivalent_radius
    x, y = b * grid.x, b * grid.y
    p, film = pressure * outcome.pressure, unit * np.maximum(outcome.film, 0.0)
    per_length = p.sum(axis=1) * (x[1] - x[0])
    middle = y.size // 2
    assert case.lubricant is not None  # the contact is given in SI
    with quiet("film-resolution"):
        line = solve_line_contact(
            float(per_length[middle]), case.equivalent_radius, case.entrainment_speed,
            case.lubricant, case.effective_modulus, viscosity_law=case.scales.viscosity_law,
            compressible=case.compressible,
        )  # fmt: skip
    on_grid = problem.load
    step = (outcome.central_film - outcome.coarse_central_film) / 3.0
    return from_parts(
        FiniteLineSolution,
        *(case, case.scales, outcome),
        x=x,
        y=y,
        pressure=p,
        film=film,
        load_per_length=per_length,
        central_film=outcome.central_film * unit,
        central_film_error=outcome.film_error * outcome.central_film * unit,
        central_film_extrapolated=(outcome.central_film + step) * unit,
        minimum_film=max(float(film[p > 0.0].min()), 0.0),
        maximum_pressure=float(p.max()),
        line_central_film=line.central_film,
        line_minimum_film=line.minimum_film,
        line_maximum_pressure=float(line.pressure.max()),
        outside_load=force * (1.0 - on_grid / (0.5 * math.pi * length / b)),
        nodes_x=x.size,
        nodes_y=y.size,
        attempts=attempts,
        profile=profile.name,
        normal_force=force,
        length=length,
    )
