"""Pressure, film and temperatures of a line contact together.

The film is solved with factors on viscosity and density that stand for the heat and the shear
across it, the temperatures with that film; in turn, until neither changes.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace

import numpy as np

from tribodyn.ehl.solver.contact_case import ContactCase, ContactProblem, DiscreteContact, Outcome
from tribodyn.ehl.solver.fallbacks import ENGINES, Verified, fluxes, solve_problem, verify
from tribodyn.ehl.thermal.surface_history import slowest_speed, surface_response
from tribodyn.ehl.thermal.thermal_model import MODELS, ThermalModel
from tribodyn.errors import ComputationError, require_between
from tribodyn.types import Array, Index

#: Greatest sliding over the entrainment speed.
MOST_SLIDING = 20.0
#: Sweeps over the temperatures before the first film, and before each other one.
_FIRST, _OTHER = 2, 1
#: Distance of the columns in half widths, where it grows, and by which factor.
_FINE, _NEAR, _SPARSE = 0.025, -1.5, 4
#: Passes whose differences predict the next factors.
_MEMORY = 8
#: Change of the factors that does not move the film, and traction over the load that is none.
NO_CHANGE, IDLE = 1e-5, 1e-6
_EVEN = 0.5
#: Part of a change of the factors for which the film could not be solved; part of the heat that may
#: be missing, and how often it is sought.
PART, _MISSING, _BALANCING = 0.25, 5e-4, 15
#: Part of a change of the factors that the tolerance allows.
OF_FACTORS = 0.02
#: How strongly short waves of the factors are damped.
_SHORT = 0.06
#: Weight of nodes that pressure drives no oil through.
_LEAST_WEIGHT = 1e-3


@dataclass(frozen=True, eq=False)
class HeatedFilm:
    """Temperatures and shear of a film, on its nodes along and across."""

    temperature: Array = field(repr=False)  #: (nodes along, nodes across) [K]
    heat: Array = field(repr=False)  #: into both surfaces (2, nodes) [W/m^2]
    shear_stress: Array = field(repr=False)  #: in the middle of the film [Pa]
    viscosity: Array = field(repr=False)  #: harmonic mean over the film at low stress [Pa s]
    balance: Array  #: heat by shear and compression, into both bodies, carried out [W/m]
    passes: int  #: between film and temperatures
    traction: float  #: [N/m], of the sign of the sliding


class Temperatures:
    """Temperatures of one contact, which go on from one film to the next."""

    def __init__(
        self, case: ContactCase, grid: DiscreteContact, model: ThermalModel, sliding: float
    ) -> None:
        from tribodyn.ehl._kernel.heat import Storage
        from tribodyn.ehl._kernel.heated_shear import Across, Along, Sheared, carreau_table

        lubricant = case.lubricant
        assert lubricant is not None  # the dimensionless form has no heat
        self.case, self.step = case, grid.dx * case.half_width
        oil = model.oil(lubricant, case.compressible)
        speeds = case.entrainment_speed + 0.5 * sliding, case.entrainment_speed - 0.5 * sliding
        across = model.nodes_across
        far = [oil.temperature if b.temperature is None else b.temperature for b in model.bodies]
        self.oil = Sheared(
            speeds[0], speeds[1], lubricant.dynamic_viscosity, lubricant.density, oil.expansion,
            oil.temperature, oil.temperature_viscosity_coefficient,
            case.scales.viscosity_law == "roelands", oil.thermal_conductivity,
            oil.specific_heat, case.hertz_pressure, MODELS[model.shear_model],
            *_stresses(model), carreau_table(*_stresses(model)[2:4]),
        )  # fmt: skip
        self.at, self.edges = _columns(grid, case)
        self.width, columns = np.diff(self.edges) * self.step, self.at.size
        responses = []
        for speed, body in zip(speeds, model.bodies, strict=True):
            least = slowest_speed(body.diffusivity, case.equivalent_radius)
            moving = math.copysign(max(abs(speed), least), speed)
            conduction = body.thermal_conductivity, body.diffusivity
            responses.append(surface_response(self.at, self.edges, self.step, moving, *conduction))
        self.responses = responses[0], responses[1]
        fields = np.zeros((8, columns, across))
        self.across = Across(np.full((columns, across), oil.temperature), *fields)
        zeros, ones = np.zeros((5, columns)), np.ones((6, columns))
        unsettled, zero = np.full(columns, math.inf), np.zeros((2, columns))
        self.along = Along._make([zeros[:2], zeros[2], zeros[3:], *ones, unsettled, *zero])
        self.balance = np.zeros(5)
        self.base = np.repeat(np.array(far)[:, None], columns, axis=1)
        fields, rates = np.zeros((4, columns, across)), np.zeros((2, columns))
        self.storage = Storage(0.0, 0.0, fields[:2], fields[2:], rates[0], rates[1], np.zeros(1))

    def inflow(self, grid: DiscreteContact) -> float:
        """Flux at the first column, over ``b^2/R`` and the entrainment speed."""
        return float(np.mean(fluxes(grid, grid.H)[: grid.free + 1]))

    def solve(self, grid: DiscreteContact, sweeps: int) -> float:
        """Improve the temperatures of a film; greatest change of the last sweep [K]."""
        from tribodyn.ehl._kernel.heat import Stations, heat_film

        unit = self.case.half_width**2 / self.case.equivalent_radius
        flow = self.inflow(grid) * self.case.entrainment_speed * unit
        slope, film = np.gradient(grid.P, self.step)[self.at] * self.case.hertz_pressure, grid.H
        stations = Stations(
            self.width, grid.P[self.at], slope, film[self.at] * unit, self.base, self.responses
        )
        self.storage = self.storage._replace(inflow=flow)
        last = int(np.searchsorted(self.at, grid.free, side="right")) - 1
        return float(
            heat_film(
                last, grid.oil, stations, self.oil, self.storage, self.across, self.along, sweeps,
                self.balance,
            )
        )  # fmt: skip

    def everywhere(self, values: Array, nodes: int) -> Array:
        """Values (..., columns) of the columns at all nodes."""
        every = np.arange(nodes)
        rows = [np.interp(every, self.at, row) for row in values.reshape(-1, self.at.size)]
        return np.array(rows).reshape(*values.shape[:-1], nodes)

    def factors(self, nodes: int) -> tuple[Array, Array, Array]:
        """Logarithms of the factors on viscosity and density, steps and weights (2, nodes)."""
        viscosity, density = self.along.factors
        driven = np.minimum(self.along.driven, 1.0) + _LEAST_WEIGHT
        rows = np.stack([viscosity, np.log(density), self.along.share, driven])
        first, second, share, weight = self.everywhere(rows, nodes)
        ones = np.ones(nodes)
        return np.stack([first, second]), np.stack([share, share**_EVEN]), np.stack([weight, ones])

    def balance_heat(self, grid: DiscreteContact) -> None:
        """Improve the temperatures of a settled film until the heat made is that led away."""
        for _ in range(_BALANCING):
            if abs(self.missing) <= _MISSING * self.most_heat:
                break
            self.solve(grid, 4)

    @property
    def missing(self) -> float:
        """Heat made that is neither led away nor stored [W/m]."""
        signs = np.array([1.0, 1.0, -1.0, -1.0, -1.0])
        return float(signs @ self.balance - self.storage.heat[0])

    @property
    def most_heat(self) -> float:
        """Heat made by shear, which alone makes the heat of a steady film [W/m]."""
        return float(self.balance[0])

    @property
    def traction(self) -> float:
        """Traction of the sheared film, of the sign of the sliding [N/m]."""
        return -float(np.sum((self.along.stress * self.width)[1:]))

    def film(self, nodes: int, passes: int) -> HeatedFilm:
        """The heated film as it is now."""
        along = self.along
        rows = np.concatenate([along.heat, [along.stress, along.mean]])
        rows = self.everywhere(rows, nodes)
        temperature = np.ascontiguousarray(self.everywhere(self.across.temperature.T, nodes).T)
        return HeatedFilm(
            temperature, rows[:2], rows[2], rows[3], self.balance, passes, self.traction
        )


def _columns(grid: DiscreteContact, case: ContactCase) -> tuple[Index, Array]:
    """Nodes of the columns, sparse in the inlet, and the edges between them, in intervals."""
    fine = max(1, round(_FINE / grid.dx))
    fine_columns = np.arange(grid.n, int(np.searchsorted(grid.X, _NEAR)), -fine)
    far = np.arange(fine_columns[-1], -1, -_SPARSE * fine)[1:]
    at = np.concatenate([fine_columns, far])[::-1]
    edges = np.concatenate([[at[0]], 0.5 * (at[1:] + at[:-1]), [at[-1]]])
    return np.ascontiguousarray(at), edges


def _stresses(model: ThermalModel) -> tuple[float, float, float, float, float, float]:
    """Eyring's stress, Carreau's numbers, and the limit, infinite for none."""
    numbers = model.numbers
    return (
        numbers.get("eyring_stress", 1.0),
        numbers.get("carreau_stress", 1.0),
        numbers.get("carreau_exponent", 1.0),
        numbers.get("yasuda_exponent", 2.0),
        numbers.get("limiting_stress", math.inf),
        numbers.get("limiting_stress_slope", 0.0),
    )


class Prediction:
    """Next factors from the last passes, by extrapolation of their changes."""

    def __init__(self) -> None:
        self.points: list[Array] = []
        self.changes: list[Array] = []

    def next(self, point: Array, change: Array, weight: Array) -> Array:
        """Point at which the changes of the last passes, combined, would vanish."""
        self.points, self.changes = [*self.points, point], [*self.changes, change]
        del self.points[: -_MEMORY - 1], self.changes[: -_MEMORY - 1]
        if len(self.points) == 1:
            return point + change
        by_change, by_point = np.diff(self.changes, axis=0), np.diff(self.points, axis=0)
        rows, wanted = (by_change * weight).reshape(len(by_change), -1), (change * weight).ravel()
        products = rows @ rows.T
        products[np.diag_indices_from(products)] *= 1.0 + 1e-10
        shares = np.linalg.solve(products, rows @ wanted)
        return np.asarray(point + change - np.tensordot(shares, by_point + by_change, axes=1))


def solve_heated(
    case: ContactCase,
    problem: ContactProblem,
    cold: Verified,
    model: ThermalModel,
    sliding_speed: float,
) -> tuple[Verified, HeatedFilm]:
    """Heat a contact that is solved at one temperature."""
    most = MOST_SLIDING * case.entrainment_speed
    require_between("sliding_speed", sliding_speed, -most, most, "m/s")
    grid = cold.outcome.grid
    assert grid is not None  # a verified outcome has a grid
    temperatures = Temperatures(case, grid, model, sliding_speed)
    problem = replace(
        problem, nodes=grid.n + 1, film_tolerance=0.0, profile=_profile(problem, grid)
    )
    solved, point = cold.outcome, np.zeros((2, grid.n + 1))
    prediction, traction, film = Prediction(), math.inf, math.inf
    for passes in range(1, model.passes + 1):
        moved = temperatures.solve(grid, _FIRST if passes == 1 else _OTHER)
        factors, share, weight = temperatures.factors(grid.n + 1)
        change = factors - point
        drag = abs(temperatures.traction - traction) / max(
            abs(traction), IDLE * case.load_per_width
        )
        traction = temperatures.traction
        flow = float(np.max(np.abs(change * share * weight)))
        settled = flow < NO_CHANGE or max(film, drag, OF_FACTORS * flow) < model.tolerance
        if settled:
            temperatures.balance_heat(grid)
            hot = _verified(solved, replace(problem, oil=grid.oil, start=grid), cold)
            return hot, temperatures.film(grid.n + 1, passes)
        change = smooth(change * share, grid)
        last, point = point, prediction.next(point, change, weight)
        solved, point = _toward(replace(problem, start=grid), cold.method, last, point)
        before, grid = grid, solved.grid
        assert grid is not None
        film = float(np.max(np.abs(films_of(grid) / films_of(before) - 1.0)))
    raise _not_settled(case, model, sliding_speed, (film, drag, moved))


def _toward(
    problem: ContactProblem, method: str, last: Array, point: Array
) -> tuple[Outcome, Array]:
    """Solve the film with new factors, or with some between them and the last that have one."""
    while True:
        oil = np.concatenate([problem.oil[:6], point[0], np.exp(point[1])])
        heated = replace(problem, oil=oil)
        outcome = ENGINES[method](heated)
        if outcome.converged:
            return outcome, point
        try:
            return solve_problem(heated, method).outcome, point
        except ComputationError:
            if np.max(np.abs(point - last)) < NO_CHANGE:
                raise
        point = last + PART * (point - last)


def films_of(grid: DiscreteContact) -> Array:
    """Central and least film."""
    least = float(np.min(grid.H[: grid.free + 1]))
    return np.array([float(np.interp(0.0, grid.X, grid.H)), least])


def _verified(solved: Outcome, problem: ContactProblem, cold: Verified) -> Verified:
    """A heated solution, verified; the films of its coarser grids are in proportion to the cold."""
    grid, cold_grid, films = solved.grid, cold.outcome.grid, np.array(cold.outcome.films)
    assert grid is not None
    assert cold_grid is not None
    check = verify(grid)
    if check.complaint(1.05 * problem.flux_tolerance + 1e-9):
        hot = solve_problem(problem, cold.method)
        solved, check = hot.outcome, hot.check
    central, before = (float(np.interp(0.0, each.X, each.H)) for each in (grid, cold_grid))
    scaled = tuple((films * (central / before)).tolist())
    return replace(cold, outcome=replace(solved, films=scaled), check=check)


def smooth(change: Array, grid: DiscreteContact) -> Array:
    """Damp short waves of a change (2, nodes)."""
    # The pressure follows a wave of the film in proportion to its wave number and to the film, and
    # the temperature follows the pressure.
    from scipy.fft import dct, idct

    wave = np.pi / (grid.n * grid.dx) * np.arange(grid.n + 1)
    damped = 1.0 + _SHORT * float(np.interp(0.0, grid.X, grid.H)) * wave
    return np.asarray(idct(dct(change, type=1) / damped, type=1))


def _profile(problem: ContactProblem, grid: DiscreteContact) -> Array | None:
    """Heights on the nodes of a grid that may be coarser than that of the problem."""
    if problem.profile is None:
        return None
    return np.ascontiguousarray(problem.profile[:: (problem.nodes - 1) // grid.n])


def _not_settled(
    case: ContactCase, model: ThermalModel, sliding: float, last: tuple[float, float, float]
) -> ComputationError:
    film, drag, moved = last
    return ComputationError(
        f"film and temperatures did not settle in {model.passes} passes: in the last one the film "
        f"changed by {film:.2g} of it, the traction by {drag:.2g} and the temperature by "
        f"{moved:.2g} K",
        where="solve_line_contact(thermal=...)",
        why=f"at {case.load_per_width:.4g} N/m, {case.entrainment_speed:.4g} m/s and "
        f"{sliding:.4g} m/s of sliding with {model.shear_model} shear and a tolerance of "
        f"{model.tolerance:g}",
        remedy='Take shear_model = "ree-eyring" or give a limiting_stress: a Newtonian oil makes '
        "too much heat at high pressure; or allow more passes or a larger tolerance",
    )
