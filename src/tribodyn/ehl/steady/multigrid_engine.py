"""The engine ``multigrid``: full multigrid, full approximation scheme, distributive relaxation."""

from __future__ import annotations

from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from tribodyn.ehl.steady.contact_problem import ContactProblem, DiscreteContact, Outcome
from tribodyn.ehl.steady.newton_engine import first_intervals, resample
from tribodyn.errors import InputError, Problem
from tribodyn.types import Array, Index

#: The set-up of the source documents: five grids, the finest with 1024 intervals, pressure to
#: 1e-4, a starved domain. Keyword arguments of
#: :func:`~tribodyn.ehl.line_contact.solve_line_contact`.
FIVE_LEVELS = MappingProxyType(
    {
        "method": "multigrid",
        "levels": 5,
        "nodes": 1025,
        "tolerance": 1e-4,
        "domain": (-2.5, 1.5),
        "inlet": "zero",
    }
)

#: Intervals of the coarsest grid: as chosen here, and the fewest and most that one may ask for.
_USUAL, _FEWEST, _MOST = 64, 32, 256
#: Newton steps of the start, tolerance of its linear solver, greatest change in a step.
_STEPS, _LINEAR, _NEWTON_CAP = 40, 3e-2, 0.3
#: Tolerance of the load, cycles on the last grid, and lines of the record.
_LOAD, _CYCLES, _LINES = 1e-6, 60, 400
#: Tolerances of pressure and flux at the start.
_PASSING, _PASSING_FLUX = 1e-4, 1e-2

_REASONS = {
    1: "not converged in {cycles} cycles (change of pressure {change:.2g}, flux error {flux:.2g})",
    2: "no correction on the coarsest grid kept the gap open",
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
            Problem(
                what=f"levels = {levels!r} with {intervals} intervals",
                where="argument levels",
                why=f"every grid has half the intervals of the next, the coarsest {_FEWEST} to "
                f"{_MOST} of them",
                remedy=f"Take levels = {fits}"
                if possible
                else "Take nodes = 2^k + 1, such as 1025 with levels = 5",
            )
        )
    return int(levels)


def multigrid_engine(problem: ContactProblem) -> Outcome:
    """Solve a steady contact by full multigrid."""
    return run_multigrid(problem)[0]


def run_multigrid(problem: ContactProblem) -> tuple[Outcome, Cycles]:
    """Solve a steady contact by full multigrid, with the record of its cycles."""
    from tribodyn.ehl._kernel.multigrid import RECORD, multigrid_solve

    n = problem.nodes - 1
    count = count_grids(n, problem.levels)
    record = np.zeros((_LINES, RECORD))
    if count < 2:
        message = f"multigrid: {n} intervals cannot be halved to {_FEWEST} or more"
        return Outcome(False, None, 0, (), message), _cycles(record[:0])
    P, H, shape = np.zeros(n + 1), np.zeros(n + 1), np.zeros(n + 1)
    state, films = np.zeros(8), np.zeros(20)
    first, message = _start(problem, n >> (count - 1), P, H, state)
    if message:
        return Outcome(False, None, 0, (), message), _cycles(record[:0])
    limits = np.array([problem.tolerance, problem.flux_tolerance, _LOAD, _CYCLES])
    profile = np.zeros(n + 1) if problem.profile is None else problem.profile
    start, end = problem.domain
    status = multigrid_solve(
        n, count, first, start, end, problem.lam, problem.oil, problem.load, problem.tail, profile,
        limits, problem.film_tolerance, P, H, shape, state, films, record,
    )  # fmt: skip
    m, grids = int(state[5]), int(state[6])
    if status != 0:
        reason = _REASONS[status].format(cycles=int(state[2]), change=state[3], flux=state[4])
        message = f"multigrid from {first} intervals: {reason} on {m} intervals"
    outcome = Outcome(
        converged=status == 0,
        grid=_record(problem, m, P, H, shape, state),
        iterations=int(state[2]),
        films=tuple(float(film) for film in films[: grids if status == 0 else grids - 1]),
        message=message,
    )
    return outcome, _cycles(record[: int(state[7])])


def _start(
    problem: ContactProblem, coarsest: int, P: Array, H: Array, state: Array
) -> tuple[int, str]:
    """Fill pressure and state on a first grid; its intervals, and what went wrong."""
    from tribodyn.ehl._kernel.steady import newton_solve

    n, warm = problem.nodes - 1, problem.start is not None
    m = max(first_intervals(problem), coarsest)
    if problem.start is not None:
        grid = problem.start
        m = max(m, grid.n) if n % grid.n == 0 else m
        state[0], state[1] = _resampled(problem, grid, m, P)
        if m > coarsest:
            return m, ""
    start, end = problem.domain
    while True:
        last = m == n or problem.film_tolerance > 0.0
        limits = np.array(
            [
                problem.tolerance if last else max(problem.tolerance, _PASSING),
                problem.flux_tolerance if last else max(problem.flux_tolerance, _PASSING_FLUX),
                _STEPS, _LINEAR, _NEWTON_CAP, 0.0,
            ]
        )  # fmt: skip
        found, films = np.zeros(12), np.zeros(20)
        found[:2] = state[:2]
        status = newton_solve(
            m, m, warm, start, end, problem.lam, problem.oil, problem.film, problem.load,
            problem.tail, _mean_heights(problem, n // m), limits, 0.0, P, H, found, films,
        )  # fmt: skip
        state[:2] = found[:2]
        if status == 0:
            return m, ""
        if m == n or warm:
            return m, f"multigrid: no start by Newton's method on {m} intervals"
        m *= 2


def _mean_heights(problem: ContactProblem, factor: int) -> Array:
    """Profile on the grid ``factor`` times as wide: the mean under a hat about every node."""
    if problem.profile is None:
        return np.zeros((problem.nodes - 1) // factor + 1)
    hat = 1.0 - np.abs(np.arange(1 - factor, factor)) / factor
    weight = np.convolve(np.ones(problem.nodes), hat, mode="same")
    mean = np.convolve(problem.profile, hat, mode="same") / weight
    return np.ascontiguousarray(mean[::factor])


def _cycles(record: Array) -> Cycles:
    return Cycles(
        intervals=record[:, 0].astype(np.int64),
        change=record[:, 1].copy(),
        flux_error=record[:, 2].copy(),
        load_error=record[:, 3].copy(),
        cavity_residual=record[:, 4].copy(),
        free=record[:, 5].astype(np.int64),
    )


def _record(
    problem: ContactProblem, m: int, P: Array, H: Array, shape: Array, state: Array
) -> DiscreteContact:
    start, end = problem.domain
    dx = (end - start) / m
    return DiscreteContact(
        n=m, dx=dx, X=np.asarray(start + dx * np.arange(m + 1)), P=P[: m + 1].copy(),
        H=H[: m + 1].copy(), H0=float(state[0]), lam=problem.lam, oil=problem.oil,
        free=int(state[1]), load=problem.load, tail=problem.tail, shape=shape[: m + 1].copy(),
    )  # fmt: skip


def _resampled(
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
