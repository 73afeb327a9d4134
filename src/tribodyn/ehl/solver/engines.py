"""The engines ``newton`` (Newton with a Krylov linear solver) and ``multigrid``, and their error.

A grid half or twice as fine shows how far a contact is from an infinitely fine one.
The errors of both films and of the pressure go with the square of the interval once the inlet is
resolved. Three films of the nested grids tell whether it is: the differences then fall fourfold. A
contact that does so is compared with half of its nodes, any other one with twice as many.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from tribodyn.ehl.solver.contact_case import ContactProblem, DiscreteContact, Outcome
from tribodyn.ehl.solver.grid import FEWEST, MOST, cut_error
from tribodyn.errors import InputError
from tribodyn.interrupt import stoppable
from tribodyn.types import Array, Index

if TYPE_CHECKING:
    from tribodyn.ehl._kernel.steady import SteadyContact

#: Intervals of the coarsest grid at least, and interval that resolves an inlet, whose length
#: goes with the film to the power 2/3, between rigid bodies with its root.
_LEAST, _RESOLVED, _RESOLVED_RIGID = 64, 0.7, 0.35
#: Newton steps on a grid, and tolerance of the linear solver.
STEPS, LINEAR, _LINEAR_TIGHT = 40, 3e-2, 1e-2
#: Greatest change of a nodal pressure in a step, in Hertz pressures.
CAP = 0.3

_REASONS = {
    1: "not converged in {steps} Newton steps",
    2: "the gap closed with every step of Newton's method",
    3: "the tangent is singular",
    4: "the pressure is not finite",
    5: "rounding keeps the flux error at {flux:.2g}",
}


def first_intervals(problem: ContactProblem) -> int:
    """Intervals of the grid on which a cold start can resolve the inlet."""
    m = problem.nodes - 1
    width = problem.domain[1] - problem.domain[0]
    least = problem.coarsest or _LEAST
    film = problem.film
    resolved = min(_RESOLVED * film ** (2.0 / 3.0), _RESOLVED_RIGID * (2.0 * film) ** 0.5)
    if problem.coarsest:
        resolved = np.inf
    while m % 2 == 0 and m // 2 >= least and 2.0 * width / m <= resolved:
        m //= 2
    return m


def newton_engine(problem: ContactProblem) -> Outcome:
    """Solve a steady contact by multilevel Newton-Krylov."""
    from tribodyn.ehl._kernel.newton import Limits
    from tribodyn.ehl._kernel.steady import newton_solve

    n, first = problem.nodes - 1, first_intervals(problem)
    P, H, films = np.zeros(n + 1), np.zeros(n + 1), np.zeros(20)
    offset, free, warm = 0.0, 0, problem.start is not None
    if problem.start is not None:
        first = max(first, problem.start.n) if n % problem.start.n == 0 else first
        offset, free = warm_start(problem, problem.start, first, P)
    tight = min(problem.tolerance, 0.1 * problem.flux_tolerance) < 1e-6
    linear = _LINEAR_TIGHT if tight else LINEAR
    limits = Limits(problem.tolerance, problem.flux_tolerance, STEPS, linear, CAP)
    contact, film = steady_contact(problem), problem.film_tolerance
    # Never brief: Python makes the named tuple of the state within the compiled call, and there an
    # interruption of the main thread would end the process.
    solved, m, first, grids = stoppable(
        newton_solve, n, first, warm, contact, limits, film, offset, free, P, H, films
    )
    message = ""
    if solved.status != 0:
        reason = _REASONS[solved.status].format(steps=solved.steps, flux=solved.flux_error)
        message = f"newton from {first} intervals: {reason} on {m} intervals"
    shape = 0.5 * positions(problem, m) ** 2 + mean_heights(problem, n // m)
    return Outcome(
        converged=solved.status == 0,
        grid=state_on_grid(problem, m, P, H, shape, solved),
        iterations=solved.steps,
        films=tuple(films[: grids if solved.status == 0 else grids - 1].tolist()),
        message=message,
    )


def steady_contact(problem: ContactProblem, factor: int = 1) -> SteadyContact:
    """Contact for the kernels, with the profile on the grid ``factor`` times as wide."""
    from tribodyn.ehl._kernel.steady import SteadyContact

    start, end = problem.domain
    scales = problem.lam, problem.oil, problem.film, problem.load, problem.tail
    return SteadyContact(start, end, *scales, mean_heights(problem, factor))


def mean_heights(problem: ContactProblem, factor: int) -> Array:
    """Profile on the grid ``factor`` times as wide: the mean under a hat about every node."""
    if problem.profile is None:
        return np.zeros((problem.nodes - 1) // factor + 1)
    if factor == 1:
        return problem.profile
    hat = 1.0 - np.abs(np.arange(1 - factor, factor)) / factor
    weight = np.convolve(np.ones(problem.nodes), hat, mode="same")
    mean = np.convolve(problem.profile, hat, mode="same") / weight
    return np.ascontiguousarray(mean[::factor])


def positions(problem: ContactProblem, m: int) -> Array:
    """Nodes of the grid of ``m`` intervals, in half widths."""
    start, end = problem.domain
    return np.asarray(start + (end - start) / m * np.arange(m + 1))


def state_on_grid(
    problem: ContactProblem, m: int, P: Array, H: Array, shape: Array, solved: Any
) -> DiscreteContact:
    """State on the grid of ``m`` intervals on which an engine ended."""
    start, end = problem.domain
    return DiscreteContact(
        n=m, dx=(end - start) / m, X=positions(problem, m), P=P[: m + 1].copy(),
        H=H[: m + 1].copy(), H0=solved.offset, lam=problem.lam, oil=problem.oil,
        free=solved.free, load=problem.load, tail=problem.tail, shape=shape[: m + 1].copy(),
    )  # fmt: skip


def resample(grid: DiscreteContact, X: Array) -> tuple[Array, int]:
    """Pressure of a solution at other positions, and its last node."""
    P = np.interp(X, grid.X, grid.P, left=0.0, right=0.0)
    P[-1] = 0.0
    positive = np.flatnonzero(P[:-1] > 0.0)
    return P, int(positive[-1]) if positive.size else 2


def warm_start(
    problem: ContactProblem, grid: DiscreteContact, first: int, P: Array
) -> tuple[float, int]:
    """Fill ``P`` on the first grid from an earlier solution; offset and last free node."""
    start, end = problem.domain
    values, free = resample(grid, np.linspace(start, end, first + 1))
    dx = (end - start) / first
    values[0] = problem.tail
    values[1:] *= (problem.load - 0.5 * problem.tail * dx) / (dx * float(np.sum(values[1:])))
    P[: first + 1] = values
    return grid.H0, free


#: Intervals of the coarsest grid: as chosen here, and the fewest and most allowed.
_USUAL, _FEWEST, _MOST = 64, 32, 256
#: Tolerance of the load, cycles on the last grid, and lines of the record.
_LOAD, _CYCLES, _LINES = 1e-6, 60, 400
#: Tolerances of pressure and flux at the start.
_PASSING, _PASSING_FLUX = 1e-4, 1e-2

_MULTIGRID_REASONS = {
    1: "not converged in {cycles} cycles (change of pressure {change:.2g}, flux error {flux:.2g})",
    2: "the gap closed with every correction on the coarsest grid",
    3: "the tangent is singular",
    4: "the pressure is not finite",
    5: "rounding keeps the flux error at {flux:.2g}",
}


@dataclass(frozen=True, eq=False)
class Cycles:
    """What every V cycle left, on all grids in turn."""

    intervals: Index  #: intervals of the grid that the cycle belongs to
    change: Array  #: relative change of the pressure in the cycle
    flux_error: Array  #: greatest relative deviation of the mass flux from its mean
    load_error: Array  #: relative difference between the sum of the pressure and the load
    cavity_residual: Array
    free: Index  #: last node with pressure

    def rates(self, intervals: int) -> Array:
        """Factor by which each cycle shrinks the change of the one before."""
        change = self.change[self.intervals == intervals]
        return np.asarray(change[1:] / change[:-1])


def count_grids(intervals: int, levels: int | None = None) -> int:
    """Grids of the multigrid cycle, the finest included."""
    if levels is None:
        count, m = 1, intervals
        while m % 2 == 0 and m // 2 >= (_USUAL if count > 1 else _FEWEST):
            count, m = count + 1, m // 2
        return count
    possible = [
        count
        for count in range(2, 12)
        if intervals % 2 ** (count - 1) == 0 and _FEWEST <= intervals >> (count - 1) <= _MOST
    ]
    if isinstance(levels, bool) or levels not in possible:
        fits = ", ".join(str(count) for count in possible)
        raise InputError(
            f"levels = {levels!r} with {intervals} intervals",
            where="argument levels",
            why=f"every grid has half the intervals of the next, the coarsest {_FEWEST} to "
            f"{_MOST} of them",
            remedy=f"Use levels = {fits}"
            if possible
            else "Use nodes = 2^k + 1, such as 1025 with levels = 5",
        )
    return int(levels)


def multigrid_engine(problem: ContactProblem) -> Outcome:
    """Solve a steady contact by full multigrid."""
    return run_multigrid(problem)[0]


def run_multigrid(problem: ContactProblem) -> tuple[Outcome, Cycles]:
    """Solve a steady contact by full multigrid, with the record of its cycles."""
    from tribodyn.ehl._kernel.multigrid import RECORD, MultigridLimits, multigrid_solve

    n = problem.nodes - 1
    count, record = count_grids(n, problem.levels), np.zeros((_LINES, RECORD))
    if count < 2:
        message = f"multigrid: {n} intervals cannot be halved to {_FEWEST} or more"
        return Outcome(False, None, 0, (), message), _cycles(record[:0])
    P, H, shape, films = np.zeros(n + 1), np.zeros(n + 1), np.zeros(n + 1), np.zeros(20)
    first, offset, free, message = _start(problem, n >> (count - 1), P, H)
    if message:
        return Outcome(False, None, 0, (), message), _cycles(record[:0])
    flux, film = problem.flux_tolerance, problem.film_tolerance
    limits = MultigridLimits(problem.tolerance, flux, _LOAD, _CYCLES, film)
    contact, start = steady_contact(problem), (offset, free, P, H)
    ended = stoppable(
        multigrid_solve, n, count, first, contact, limits, *start, shape, films, record
    )
    if ended.status != 0:
        reason = _MULTIGRID_REASONS[ended.status].format(
            cycles=ended.cycles, change=ended.change, flux=ended.flux_error
        )
        message = f"multigrid from {first} intervals: {reason} on {ended.intervals} intervals"
    outcome = Outcome(
        converged=ended.status == 0,
        grid=state_on_grid(problem, ended.intervals, P, H, shape, ended),
        iterations=ended.cycles,
        films=tuple(films[: ended.grids if ended.status == 0 else ended.grids - 1].tolist()),
        message=message,
    )
    return outcome, _cycles(record[: ended.lines])


def _start(
    problem: ContactProblem, coarsest: int, P: Array, H: Array
) -> tuple[int, float, int, str]:
    """Fill the pressure of a first grid: its intervals, offset, last free node, complaint."""
    from tribodyn.ehl._kernel.newton import Limits
    from tribodyn.ehl._kernel.steady import newton_solve

    n, warm = problem.nodes - 1, problem.start is not None
    m, offset, free = max(first_intervals(problem), coarsest), 0.0, 0
    if problem.start is not None:
        m = max(m, problem.start.n) if n % problem.start.n == 0 else m
        offset, free = warm_start(problem, problem.start, m, P)
        if m > coarsest:
            return m, offset, free, ""
    while True:
        last = m == n or problem.film_tolerance > 0.0
        pressure, flux = problem.tolerance, problem.flux_tolerance
        if not last:
            pressure, flux = max(pressure, _PASSING), max(flux, _PASSING_FLUX)
        limits = Limits(pressure, flux, STEPS, LINEAR, CAP)
        contact, films = steady_contact(problem, n // m), np.zeros(20)
        start = 0.0, offset, free, P, H, films
        solved, *_ = stoppable(newton_solve, m, m, warm, contact, limits, *start)
        offset, free = solved.offset, solved.free
        if solved.status == 0:
            return m, offset, free, ""
        if m == n or warm:
            complaint = f"multigrid: no start by Newton's method on {m} intervals"
            return m, offset, free, complaint
        m *= 2


def _cycles(record: Array) -> Cycles:
    return Cycles(
        intervals=record[:, 0].astype(np.int64),
        change=record[:, 1].copy(),
        flux_error=record[:, 2].copy(),
        load_error=record[:, 3].copy(),
        cavity_residual=record[:, 4].copy(),
        free=record[:, 5].astype(np.int64),
    )


#: Fall of the differences that shows that the inlet is resolved, and that of the theory.
_INLET_FALL, _FOURFOLD = 0.33, 0.25
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
    first = (n // 2, 2 * n) if fall < _INLET_FALL or 2 * n >= MOST else (2 * n, n // 2)
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
