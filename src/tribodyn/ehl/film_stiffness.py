"""Stiffness of the oil film: of its approach, tangent, secant, and a sum as one source prints it.

The bodies of a lubricated contact are further apart than those of a dry one under the same load:
by the distance that :func:`film_distance` finds. Its fall with the load is the compliance that the
film has in series with Hertz's.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.ehl.solver.contact_case import ContactProblem, DiscreteContact, SolvedContact
from tribodyn.ehl.solver.fallbacks import solve_problem
from tribodyn.ehl.solver.grid import estimate_film
from tribodyn.errors import (
    ComputationError,
    require_between,
    require_one_of,
    require_positive,
    warn,
)
from tribodyn.record import from_parts
from tribodyn.types import Array, ComplexArray

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


#: Intervals of the grid of the linearized equations.
_INTERVALS = 512
#: Frequency, in u_e/b, at which the damping limit for zero frequency is evaluated.
_SLOW = 1e-5


def frequency_response(
    solution: SolvedContact,
    frequencies: ArrayLike,
    length: float = 1.0,
    *,
    deflection: Literal["approach", "central"] = "approach",
) -> tuple[Array, Array]:
    """Stiffness and damping of the oil film against small vibrations."""
    values = np.asarray(frequencies, dtype=float)
    _, rate = _units(solution, length)
    slow = _SLOW / (2.0 * np.pi) * rate
    every = film_compliance(
        solution, np.append(values.reshape(-1), slow), length, deflection=deflection
    )
    inverse = (1.0 / every[:-1]).reshape(values.shape)
    limit = (1.0 / every[-1]).imag / (2.0 * np.pi * slow)
    is_static = values == 0.0
    damping = np.where(
        is_static, limit, inverse.imag / (2.0 * np.pi * np.where(is_static, 1.0, values))
    )
    return np.asarray(inverse.real)[()], np.asarray(damping)[()]


def film_compliance(
    solution: SolvedContact,
    frequencies: ArrayLike,
    length: float = 1.0,
    *,
    deflection: Literal["approach", "central"] = "approach",
) -> ComplexArray:
    """ComplexArray compliance of the oil film against a load ``w + dw exp(i omega t)``."""
    values = np.asarray(frequencies, dtype=float)
    require_between("frequencies", values, 0.0, 1e12, "Hz")
    require_positive("length", length, "m")
    require_one_of("deflection", deflection, ("approach", "central"))
    unit, rate = _units(solution, length)
    linear = _linearize(_on_coarse_grid(solution), inlet_change(solution))
    central, offset = linear.answer(0.0, None)
    at_rest = -film_slopes(solution).central / solution.film_unit
    result = np.empty(values.size, dtype=complex)
    for i, frequency in enumerate(values.reshape(-1)):
        film, rigid = linear.answer(2.0 * np.pi * frequency / rate, central)
        change = film - central if deflection == "central" else rigid - offset
        result[i] = at_rest - change
    return np.asarray(unit * result.reshape(values.shape), dtype=complex)[()]


def _units(solution: SolvedContact, length: float) -> tuple[float, float]:
    """Deflection over load at a unit change of film over ln(w), and ``u_e/b``."""
    load = 0.5 * np.pi * solution.hertz_pressure * solution.half_width
    return (solution.film_unit / (load * length), solution.entrainment_speed / solution.half_width)


@dataclass(frozen=True)
class _Linear:
    """Linearized equations: unknowns P_0, the free pressures and the offset."""

    steady: Array
    squeeze: Array
    film: Array
    inlet: InletChange

    def answer(self, omega: float, at_rest: complex | None) -> tuple[complex, complex]:
        """Change of central film and offset at a unit change of ln(w)."""
        inlet = self.inlet
        matrix = self.steady + 1j * omega * self.squeeze
        size = matrix.shape[0]
        right = np.zeros((size, 2))
        # First column: unit change of ln(w); second: of the film in the law of the inlet.
        right[0] = inlet.pressure, inlet.pressure_film
        right[-1] = 0.5 * np.pi - inlet.load, -inlet.load_film
        scale = np.abs(matrix).max(axis=1)
        direct, back = np.linalg.solve(matrix / scale[:, None], right / scale[:, None]).T
        change = direct
        if at_rest is not None:
            film, answer = self.film @ direct, self.film @ back
            change = direct + back * (film - at_rest) / (1.0 - answer)
        return complex(self.film @ change), complex(change[-1])


def _linearize(grid: DiscreteContact, inlet: InletChange) -> _Linear:
    from tribodyn.ehl._kernel.steady import linear_parts

    n, k, dx, start = grid.n, grid.free, grid.dx, float(grid.X[0])
    parts = linear_parts(n, start, dx, grid.lam, grid.oil, k, grid.P, grid.H)
    cH, cP, rho, drho, film, middle = parts
    film = film.T
    rows = np.arange(1, k + 1)
    steady, squeeze = np.zeros((2, k + 2, k + 2))
    for s in range(4):
        at = np.maximum(rows - 2 + s, 0)  # node -1 has coefficient zero
        steady[1:-1] += cH[rows, s, None] * film[at]
        inner = (rows - 2 + s >= 0) & (at <= k)
        steady[rows[inner], at[inner]] += cP[rows[inner], s]
    squeeze[1:-1] = dx * rho[rows, None] * film[rows]
    squeeze[rows, rows] += dx * (drho * grid.H)[rows]
    steady[0, 0] = 1.0
    steady[-1, : k + 1] = dx
    steady[-1, 0] = 0.5 * dx
    return _Linear(steady, squeeze, middle, inlet)


def _on_coarse_grid(solution: SolvedContact) -> DiscreteContact:
    """Steady state on a grid of at most 512 intervals."""
    grid = solution._grid
    if grid.n <= _INTERVALS:
        return grid
    X = np.linspace(grid.X[0], grid.X[-1], _INTERVALS + 1)
    problem = from_parts(
        ContactProblem,
        grid,
        nodes=_INTERVALS + 1,
        domain=(float(grid.X[0]), float(grid.X[-1])),
        film=float(np.interp(0.0, grid.X, grid.H)),
        moes_load=solution.moes_load,
        profile=np.interp(X, grid.X, grid.shape - 0.5 * grid.X**2),
        tolerance=1e-8,
        flux_tolerance=1e-7,
    )
    coarse = solve_problem(problem, "newton").outcome.grid
    assert coarse is not None  # a solved problem has its grid
    return coarse
