"""Verification of solutions, fallbacks when an engine fails, and contacts of rough surfaces."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import lru_cache, partial

import numpy as np

from tribodyn.arrays.linear_algebra import fast_length
from tribodyn.ehl.flow_factors import FlowFactors
from tribodyn.ehl.solver.contact_case import (
    ContactCase,
    ContactProblem,
    DiscreteContact,
    Outcome,
    heat_factors,
)
from tribodyn.ehl.solver.engines import first_intervals, multigrid_engine, newton_engine
from tribodyn.ehl.solver.grid import MOST
from tribodyn.errors import ComputationError, InputError, Problem, require_between
from tribodyn.model import Registry
from tribodyn.types import Array, ComplexArray

#: Least value of the mass balance in the cavity that still counts as none.
_CAVITY = -1e-8


@dataclass(frozen=True)
class Verification:
    """How well a solution meets the equations."""

    flux_error: float
    load_error: float  #: relative difference between the sum of the pressure and the load
    cavity_residual: float  #: least mass balance per length behind the outlet
    lowest_pressure: float  #: least pressure, in Hertz pressures
    film_error: float  #: greatest difference from the film of the pressure, over the least film

    def complaint(self, flux_tolerance: float, load_tolerance: float = 1e-6) -> str:
        """What is wrong, or nothing."""
        complaints = []
        if not self.lowest_pressure >= 0.0:
            complaints.append(f"least pressure {self.lowest_pressure:.3g} p_h is negative")
        if not self.cavity_residual >= _CAVITY:
            complaints.append(
                f"mass balance behind the outlet {self.cavity_residual:.3g} is negative"
            )
        if not self.flux_error <= flux_tolerance:
            complaints.append(f"flux error {self.flux_error:.3g} exceeds {flux_tolerance:.3g}")
        if not self.load_error <= load_tolerance:
            complaints.append(f"load error {self.load_error:.3g} exceeds {load_tolerance:.3g}")
        if not self.film_error <= 1e-6:
            complaints.append(f"film differs from that of the pressure by {self.film_error:.3g}")
        return "; ".join(complaints)


@lru_cache(maxsize=16)
def _transform(n: int) -> tuple[int, ComplexArray]:
    """Length of the circular sum, and transform of the influence on intervals of length one."""
    size = fast_length(2 * n + 2)
    edge = np.arange(n + 2) - 0.5
    integral = edge * (np.log(np.abs(edge)) - 1.0)
    influence = -np.diff(integral) / np.pi
    circular = np.zeros(size)
    circular[: n + 1] = influence
    circular[size - n :] = influence[1 : n + 1][::-1]
    return size, np.fft.rfft(circular)


def _film(grid: DiscreteContact) -> Array:
    size, spectrum = _transform(grid.n)
    deflection = np.fft.irfft(np.fft.rfft(grid.P, size) * spectrum, size)[: grid.n + 1]
    # A logarithm of lengths in another unit differs by a constant.
    deflection -= math.log(grid.dx) / math.pi * float(np.sum(grid.P))
    return np.asarray(grid.H0 + grid.shape + grid.dx * deflection)


def fluxes(grid: DiscreteContact, H: Array) -> Array:
    """Mass flux through the faces between the nodes, over ``rho0 u_e b^2/R``."""
    P = grid.P
    law, a, reference, z, rise, bound = grid.oil[:6]
    heated, factor = heat_factors(grid.oil, grid.n)
    density = factor * (1.0 + rise * P / (1.0 + bound * P))
    if law == 2.0:
        growth = a * (np.maximum(1.0 + P / reference, 0.7) ** z - 1.0)
    else:
        growth = a * P if law == 1.0 else 0.0 * P
    fluidity = np.exp(-np.minimum(growth + heated, 700.0))
    mobility = density * np.maximum(H, 1e-10) ** 3 * fluidity / grid.lam
    mass = density * H
    carried = 1.5 * mass[:-1]
    carried[1:] -= 0.5 * mass[:-2]
    carried[0] = 0.5 * (mass[0] + mass[1])
    return np.asarray(carried - 0.5 * (mobility[:-1] + mobility[1:]) * np.diff(P) / grid.dx)


def verify(grid: DiscreteContact) -> Verification:
    """Check a solution against the discrete equations, from its pressure alone."""
    P, dx, k = grid.P, grid.dx, grid.free
    H = _film(grid)
    flux = fluxes(grid, H)
    wetted = flux[: k + 1]
    mean = float(np.mean(wetted))
    cavity = np.diff(flux)[k:] / dx
    total = dx * (float(np.sum(P)) - 0.5 * P[0])
    return Verification(
        flux_error=float(np.max(np.abs(wetted / mean - 1.0))),
        load_error=float(abs(total / grid.load - 1.0)),
        cavity_residual=float(np.min(cavity)) if cavity.size else 0.0,
        lowest_pressure=float(np.min(P)),
        film_error=float(np.max(np.abs(H - grid.H)) / np.min(H)),
    )


#: ``lam`` of the easy contact, its pressure over the requested one, and intervals of the path.
_EASY_LAM, _EASY_PRESSURE, _INTERVALS = 2.0, 0.05, 512
#: First step of the path, and the least before giving up.
_STEP, _LEAST_STEP = 0.125, 1e-3


def continue_to(problem: ContactProblem) -> Outcome:
    """Solve a contact by way of thicker films and lower pressures."""
    n = problem.nodes - 1
    while n % 2 == 0 and n // 2 >= _INTERVALS:
        n //= 2
    factor = (problem.nodes - 1) // n
    path = replace(
        problem,
        nodes=n + 1,
        profile=None if problem.profile is None else problem.profile[::factor],
        film_tolerance=0.0,
        flux_tolerance=1e-2,
        coarsest=n,
    )
    done, step = 0.0, _STEP
    outcome = newton_engine(_between(path, 0.0, None))
    grid = outcome.grid
    if not outcome.converged or grid is None:
        return replace(outcome, message=f"continuation: no start ({outcome.message})")
    while done < 1.0:
        share = min(1.0, done + step)
        outcome = newton_engine(_between(path, share, grid))
        if outcome.converged and outcome.grid is not None:
            done, grid, step = share, outcome.grid, 1.5 * step
        else:
            step *= 0.5
            if step < _LEAST_STEP:
                message = f"continuation stopped at {done:.3g} of the way ({outcome.message})"
                return replace(outcome, converged=False, message=message)
    outcome = newton_engine(replace(problem, start=grid))
    return replace(outcome, message=outcome.message and f"continuation: {outcome.message}")


def _between(problem: ContactProblem, share: float, grid: DiscreteContact | None) -> ContactProblem:
    """Contact at a share of the way from the easy one."""
    easy = max(_EASY_LAM, problem.lam)
    lam = easy ** (1.0 - share) * problem.lam**share
    pressure = _EASY_PRESSURE ** (1.0 - share)
    oil = problem.oil.copy()
    if oil[0] == 1.0:
        oil[1] *= pressure
    elif oil[0] == 2.0:
        oil[2] /= pressure
    oil[4:6] *= pressure
    tail = problem.tail * lam / problem.lam
    return replace(
        problem,
        lam=lam,
        oil=oil,
        tail=min(tail, 0.1),
        film=problem.film * (lam / problem.lam) ** 0.6,
        start=grid,
    )


#: A solver of steady contacts.
Engine = Callable[[ContactProblem], Outcome]

#: The solvers by name.
ENGINES: Registry[Engine] = Registry("film solver", "tribodyn.film_solver")
ENGINES.register("newton")(newton_engine)
ENGINES.register("multigrid")(multigrid_engine)


@dataclass(frozen=True, eq=False)
class Verified:
    """A verified solution and how it was reached."""

    outcome: Outcome
    check: Verification
    method: str  #: engine that found it
    attempts: tuple[str, ...]  #: what failed before


def solve_problem(problem: ContactProblem, method: str) -> Verified:
    """Solve a contact with one engine, and with all other means where that fails."""
    engine = ENGINES[method]
    log: list[str] = []
    for name, trial in _trials(problem, method, engine):
        outcome = trial()
        complaint = outcome.message
        if outcome.converged and outcome.grid is not None:
            check = verify(outcome.grid)
            complaint = check.complaint(1.05 * problem.flux_tolerance + 1e-9)
            if not complaint:
                return Verified(outcome, check, name, tuple(log))
            complaint = f"{name}: {complaint}"
        log.append(complaint)
        if "rounding" in complaint:
            break
    raise ComputationError(_failure(problem, log))


def _trials(
    problem: ContactProblem, method: str, engine: Engine
) -> Iterator[tuple[str, Callable[[], Outcome]]]:
    """What is tried, one after the other."""
    yield method, partial(engine, problem)
    cold = replace(problem, start=None)
    first, last = first_intervals(cold), problem.nodes - 1
    other = "newton" if method == "multigrid" else "multigrid"
    if problem.start is not None:
        yield method, partial(engine, cold)
    if first < last:
        yield method, partial(engine, replace(cold, coarsest=min(4 * first, last)))
    if first == last and problem.profile is None and not problem.heated:
        # A grid may be too coarse to have any solution: see the inlet in `first_intervals`. The
        # heat of a film stays on the grid of its temperatures.
        for factor in (2, 4, 8, 16):
            if factor * last < MOST:
                yield method, partial(engine, replace(cold, nodes=factor * last + 1))
    yield other, partial(ENGINES[other], cold)
    yield "newton", partial(continue_to, cold)


def _failure(problem: ContactProblem, log: list[str]) -> Problem:
    tried = "; ".join(f"({number}) {entry}" for number, entry in enumerate(log, 1))
    start, end = problem.domain
    if any("rounding" in entry for entry in log):
        remedy = "Use a larger flux_tolerance or fewer nodes"
    else:
        remedy = "Use more nodes; check load, radius, speed, viscosity and their units"
    return Problem(
        what=f"the contact with M = {problem.moes_load:.4g}, film about {problem.film:.3g} b^2/R, "
        f"{problem.nodes} nodes from X = {start:.4g} to {end:.4g} was not solved",
        why=f"Tried: {tried}",
        remedy=remedy,
    )


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
