"""The engine ``multigrid``: full multigrid, full approximation scheme, distributive relaxation."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tribodyn.ehl.steady.contact_problem import ContactProblem, Outcome
from tribodyn.ehl.steady.newton_engine import (
    CAP,
    LINEAR,
    STEPS,
    first_intervals,
    state_on_grid,
    steady_contact,
    warm_start,
)
from tribodyn.errors import InputError
from tribodyn.interrupt import stoppable
from tribodyn.types import Array, Index

#: Intervals of the coarsest grid: as chosen here, and the fewest and most allowed.
_USUAL, _FEWEST, _MOST = 64, 32, 256
#: Tolerance of the load, cycles on the last grid, and lines of the record.
_LOAD, _CYCLES, _LINES = 1e-6, 60, 400
#: Tolerances of pressure and flux at the start.
_PASSING, _PASSING_FLUX = 1e-4, 1e-2

_REASONS = {
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
        reason = _REASONS[ended.status].format(
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
