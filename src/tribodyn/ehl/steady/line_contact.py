"""The lubricated line contact solved: pressure and film from load, radius, speed and oil."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.ehl.flow_factors import FlowFactors
from tribodyn.ehl.solver.contact_case import (
    ContactCase,
    ContactProblem,
    moes_case,
    require_kind,
    si_case,
)
from tribodyn.ehl.solver.engines import GridError, grid_error
from tribodyn.ehl.solver.fallbacks import Verified, solve_problem, solve_rough
from tribodyn.ehl.solver.grid import choose_domain, choose_nodes, cut_error, estimate_film
from tribodyn.ehl.steady.solution import LineContactSolution, assemble, with_heat
from tribodyn.ehl.thermal.thermal_contact import HeatedFilm, solve_heated
from tribodyn.ehl.thermal.thermal_model import ThermalModel, read_thermal
from tribodyn.errors import InputError, real_numbers, require_between, warn
from tribodyn.interrupt import aside
from tribodyn.lubricant import Lubricant
from tribodyn.nomenclature import require_number, require_whole
from tribodyn.record import from_parts
from tribodyn.types import Array, ByName

#: Heights that are added to the gap, at the nodes or over the position.
Profile = Callable[[Array], ArrayLike]

#: Relative film error on a prescribed grid above which a warning is issued.
STATED_LIMIT = 0.02


@dataclass(frozen=True, eq=False)
class SolverOptions:
    """How a contact is solved; see :func:`solve_line_contact`."""

    nodes: Any = "auto"  #: nodes of the grid
    method: str = "newton"  #: engine
    domain: Any = "auto"  #: extent of the grid, in half widths
    inlet: str = "flooded"  #: ``"flooded"`` or ``"zero"``
    tolerance: float = 1e-4
    flux_tolerance: float = 3e-4
    film_tolerance: float = 5e-4
    levels: int | None = None  #: number of grids
    start: LineContactSolution | None = None  #: solution to start from
    profile: Profile | None = None  #: heights that are added to the gap
    thermal: bool | ThermalModel = False  #: whether and how the film is heated
    sliding_speed: float = 0.0  #: speed of surface 1 less that of surface 2
    flow_factors: FlowFactors | None = None  #: of rough surfaces

    @property
    def heat(self) -> ThermalModel | None:
        """How the film is heated; None where it is not."""
        model = read_thermal(self.thermal)
        if model is not None and self.flow_factors is not None:
            what, why = "thermal and flow_factors", "the heat between rough surfaces is not solved"
            raise InputError(what, "argument flow_factors", why, "Leave one of them out")
        if model is None and self.flow_factors is None and self.sliding_speed != 0.0:
            what = f"sliding_speed = {self.sliding_speed:g} m/s without thermal"
            why = "the film at one temperature does not depend on the sliding"
            remedy = "Add thermal=True, or flow_factors of rough surfaces"
            raise InputError(what, "argument sliding_speed", why, remedy)
        return model

    @classmethod
    def among(cls, arguments: ByName) -> SolverOptions:
        """Options among the arguments of a function, by their names."""
        return cls(**{name: arguments[name] for name in _OPTIONS if name in arguments})


_OPTIONS = tuple(each.name for each in fields(SolverOptions))


def solve_line_contact(
    load_per_width: float,
    equivalent_radius: float,
    entrainment_speed: float,
    lubricant: Lubricant,
    effective_modulus: float,
    *,
    nodes: str | int = "auto",
    method: str = "newton",
    domain: str | tuple[float, float] = "auto",
    inlet: str = "flooded",
    viscosity_law: str = "roelands",
    compressible: bool = True,
    tolerance: float = 1e-4,
    flux_tolerance: float = 3e-4,
    film_tolerance: float = 5e-4,
    levels: int | None = None,
    start: LineContactSolution | None = None,
    profile: Profile | None = None,
    thermal: bool | ThermalModel = False,
    sliding_speed: float = 0.0,
    flow_factors: FlowFactors | None = None,
) -> LineContactSolution:
    """Pressure and film of a lubricated line contact: steady, isothermal and Newtonian, or heated.

    Parameters
    ----------
    load_per_width : float [N/m]
        Normal load per face width.
    equivalent_radius : float [m]
        Reduced radius of curvature.
    entrainment_speed : float [m/s]
        HALF the sum of the surface speeds.
    lubricant : Lubricant
        Oil at the temperature of the inlet.
    effective_modulus : float [Pa]
        ``2/E' = (1-nu1^2)/E1 + (1-nu2^2)/E2``.
    nodes : "auto" or int
        Nodes of the grid, 65 to 16385, preferably 2^k + 1. Automatic: refined until the estimated
        error of the central film meets ``film_tolerance``. A grid on which so thin a film has no
        solution is refined too; ``nodes`` and ``attempts`` of the solution tell.
    method : {"newton", "multigrid"}
        Multilevel Newton-Krylov, or full multigrid. If it fails, the other one is tried.
    domain : "auto" or (float, float) [-]
        First and last position, in half widths of the dry contact.
    inlet : {"flooded", "zero"}
        Oil everywhere before the contact, or pressure zero at the first position of a stated
        domain: a contact that is starved from there.
    viscosity_law : {"roelands", "barus", "isoviscous"}
        How the viscosity rises with pressure.
    compressible : bool
        Whether the density rises with pressure, after Dowson and Higginson.
    tolerance, flux_tolerance, film_tolerance : float
        Relative change of the pressure in the last step; greatest relative deviation of the mass
        flux from its mean; relative error of the central film by the grid, for automatic nodes.
    levels : int, optional
        Number of grids, each half as fine as the next; by the film if absent.
    start : LineContactSolution, optional
        Solution of a similar contact to start from.
    profile : callable, optional
        Heights [m] that are added to the gap, as a function of the position [m].
    thermal : bool or ThermalModel
        Solve the energy equation with it: oil and surfaces are heated by shear and compression.
        ``True`` is a Newtonian oil between bodies of steel; a :class:`ThermalModel` says how the
        oil shears. The solution is a :class:`ThermalLineContactSolution`.
    sliding_speed : float [m/s]
        Speed of surface 1 less that of surface 2, for ``thermal`` and ``flow_factors``.
    flow_factors : FlowFactors, optional
        Roughness by its mean effect on the flow; the film is then the distance of the mean
        surfaces.

    Raises
    ------
    InputError
        If a value is out of range; the message names it, its limits and a remedy.
    ComputationError
        If no solver finds the solution, with a log of all attempts; if film and temperatures do
        not settle, with their last changes.

    Warns
    -----
    ModelWarning
        Code ``starved-inlet`` for ``inlet="zero"``; ``film-resolution`` where the finest grid
        does not meet ``film_tolerance``, where stated nodes leave an estimated error above 2 % of
        the central or the least film, or were raised; ``outlet-cut`` where the domain ends before
        the film.

    Valid for smooth bodies of a linear elastic material and a film that is thin against the
    radius. Source: Reynolds (1886); Dowson and Higginson (1966); Venner and Lubrecht (2000).

    Examples
    --------
    >>> from tribodyn.lubricant import Lubricant
    >>> oil = Lubricant(0.082, 880.0, 2.19e-8)
    >>> contact = solve_line_contact(147802.0, 8e-3, 3.0722, oil, 2.2e11)
    >>> round(contact.central_film * 1e6, 3), round(contact.hertz_pressure * 1e-9, 4)
    (1.024, 0.8043)
    """
    options = SolverOptions.among(locals())
    numbers = load_per_width, equivalent_radius, entrainment_speed
    case = si_case(*numbers, lubricant, effective_modulus, viscosity_law, compressible)
    solution = solve_case(case, options)
    if inlet == "zero":
        _warn_starved(solution)
    _warn_cut(solution)
    _warn_accuracy(solution, options)
    return solution


def solve_line_contact_moes(
    M: float,
    L: float,
    *,
    pressure_viscosity_index: float = 0.68,
    pressure_viscosity_coefficient: float = 2.2e-8,
    compressible: bool = True,
    domain: str | tuple[float, float] = (-4.5, 1.5),
    inlet: str = "zero",
    nodes: str | int = 1025,
    method: str = "newton",
    viscosity_law: str = "roelands",
    tolerance: float = 1e-4,
    flux_tolerance: float = 3e-4,
    film_tolerance: float = 5e-4,
    levels: int | None = None,
    start: LineContactSolution | None = None,
    profile: Profile | None = None,
) -> LineContactSolution:
    """Pressure and film of the line contact with the numbers M and L of Moes.

    Parameters
    ----------
    M : float [-]
        Load number ``w/(E'R) (2U)^(-1/2)``.
    L : float [-]
        Material number ``alpha E' (2U)^(1/4)``; zero for an isoviscous oil.
    pressure_viscosity_index : float
        Index z of Roelands.
    pressure_viscosity_coefficient : float [1/Pa]
        Slope of ln(viscosity) over pressure; it sets the Hertz pressure
        ``L sqrt(M/2pi)/alpha``, on which Roelands' law and the density depend.
    compressible, domain, inlet, nodes, method, viscosity_law
        As for :func:`solve_line_contact`; the domain in half widths [-].
    tolerance, flux_tolerance, film_tolerance, levels, start
        As there.
    profile : callable, optional
        Heights in b^2/R that are added to the gap, as a function of the position in b.

    Returns
    -------
    LineContactSolution
        Position in half widths b, pressure in Hertz pressures, film in b^2/R.

    Raises
    ------
    InputError
        If a value is out of range; the message names it, its limits and a remedy.
    ComputationError
        If no solver finds the solution, with a log of all attempts.

    Valid as :func:`solve_line_contact`. Source: Moes (1965).

    Examples
    --------
    >>> contact = solve_line_contact_moes(20, 10, nodes=513)
    >>> round(contact.central_film, 5), round(contact.central_film_extrapolated, 4)
    (0.08492, 0.0852)
    """
    options = SolverOptions.among(locals())
    case = moes_case(
        M, L, pressure_viscosity_index, pressure_viscosity_coefficient, viscosity_law, compressible
    )
    solution = solve_case(case, options)
    _warn_accuracy(solution, options)
    return solution


def solve_case(case: ContactCase, options: SolverOptions) -> LineContactSolution:
    """Solve a checked contact without warnings."""
    for name in ("tolerance", "flux_tolerance", "film_tolerance"):
        require_number(name, getattr(options, name))
    require_between("tolerance", options.tolerance, 1e-13, 1e-2)
    require_between("flux_tolerance", options.flux_tolerance, 1e-11, 0.1)
    require_between("film_tolerance", options.film_tolerance, 1e-6, 0.1)
    if options.levels is not None:
        require_whole("levels", options.levels, 2)
    count, automatic = choose_nodes(options.nodes)
    scales = case.scales
    film = estimate_film(scales.moes_load, scales.moes_viscosity, scales.density_ratio)
    tolerance, flooded = options.film_tolerance, options.inlet == "flooded"
    # Stated nodes are not spread further out: their own error is the greater one.
    within = tolerance if automatic else math.inf
    domain = choose_domain(options.domain, options.inlet, film, scales, within)
    if flooded:
        tolerance -= min(cut_error(domain.start, film), 0.5 * tolerance)
    problem = from_parts(
        ContactProblem,
        *(scales, domain, options),
        nodes=count,
        domain=(domain.start, domain.end),
        film=film,
        load=0.5 * math.pi - domain.tail_load,
        film_tolerance=tolerance if automatic else 0.0,
        profile=None,
        start=None if options.start is None else _start(options.start),
    )
    if options.profile is not None:
        problem = replace(problem, profile=_heights(options.profile, case, problem))

    heat = options.heat

    def solve() -> tuple[Verified, GridError, HeatedFilm | None]:
        solved = solve_problem(problem, options.method)
        error = grid_error(problem, solved.outcome, flooded)
        if (rough := options.flow_factors) is not None:
            solved = solve_rough(case, problem, solved, rough, options.sliding_speed)
        if heat is None:
            return solved, error, None
        hot, film = solve_heated(case, problem, solved, heat, options.sliding_speed)
        return hot, error, film

    solved, error, heated = aside(solve)
    solution = assemble(case, domain, solved, error)
    if heat is None or heated is None:
        return solution
    return with_heat(solution, heated, heat, options.sliding_speed)


def _heights(profile: Any, case: ContactCase, problem: ContactProblem) -> Array:
    """Heights at the nodes of the finest grid, in b^2/R."""
    start, end = problem.domain
    position = np.linspace(start, end, problem.nodes) * case.half_width
    why = "it must give the heights over the position"
    remedy = "Make it by tribodyn.ehl.RoughnessProfile, or give a function"
    require_kind("profile", profile, callable(profile), why, remedy)
    heights = real_numbers("argument profile", profile(position), "heights [m]")
    if heights.shape != position.shape or not np.all(np.isfinite(heights)):
        raise InputError(
            f"profile returns heights of shape {heights.shape} for {position.size} "
            "positions, or heights that are not finite",
            where="argument profile",
            why="every node of the grid needs a height",
            remedy="Return one finite height in m for each position",
        )
    return np.ascontiguousarray(heights * case.equivalent_radius / case.half_width**2)


def _start(start: Any) -> Any:
    why = "it must be a solution of a similar contact"
    remedy = "Give what this solver returned before, or None"
    require_kind("start", start, isinstance(start, LineContactSolution), why, remedy)
    return start._grid


def _warn_starved(solution: LineContactSolution) -> None:
    edge = solution.domain[0]
    warn(
        "starved-inlet",
        f"The oil begins at X = {edge:g} half widths ({edge * solution.half_width * 1e3:.3g} mm): "
        f"the central film of {solution.central_film * 1e6:.4g} um is that of a starved contact. "
        'Use inlet="flooded" for a contact with oil everywhere before it',
        stacklevel=3,
    )


def _warn_accuracy(solution: LineContactSolution, options: SolverOptions) -> None:
    error = solution.central_film_error / solution.central_film
    least = solution.minimum_film_error / solution.minimum_film
    automatic = isinstance(options.nodes, str)
    requested = solution.nodes if automatic else int(options.nodes)
    raised = "" if solution.nodes == requested else f", since {requested} nodes gave no solution,"
    if automatic and error > options.film_tolerance:
        limit, remedy = f"film_tolerance = {options.film_tolerance:g}", "a larger tolerance"
    elif not automatic and (max(error, least) > STATED_LIMIT or raised):
        limit, remedy = f"{STATED_LIMIT:g}" if error > STATED_LIMIT else "", 'nodes = "auto"'
    else:
        return
    warn(
        "film-resolution",
        f"With {solution.nodes} nodes{raised} the central film has an estimated error of "
        f"{error:.2g} of it, the least one of {least:.2g}; the limit is "
        f"{limit or format(STATED_LIMIT, 'g')}. Use "
        + (f"the extrapolated value, or {remedy}" if automatic else f"{remedy} or more nodes"),
        stacklevel=3,
    )


def _warn_cut(solution: LineContactSolution) -> None:
    if solution._grid.free >= solution._grid.n - 1:
        warn(
            "outlet-cut",
            f"The oil film reaches the end of the domain, X = {solution.domain[1]:g} half widths, "
            "where its pressure is forced to zero. Let the domain end further out, or take "
            'domain="auto"',
            stacklevel=3,
        )
