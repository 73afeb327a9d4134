"""Fallbacks when an engine fails: other starts, finer grids, the other engine, continuation."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

from tribodyn.ehl.steady.contact_problem import ContactProblem, DiscreteContact, Outcome
from tribodyn.ehl.steady.grid import MOST
from tribodyn.ehl.steady.multigrid_engine import multigrid_engine
from tribodyn.ehl.steady.newton_engine import first_intervals, newton_engine
from tribodyn.ehl.steady.verification import Verification, verify
from tribodyn.errors import ComputationError, Problem
from tribodyn.model import Registry

#: ``lam`` of the easy contact, its pressure over that asked for, and intervals of the path.
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
) -> list[tuple[str, Callable[[], Outcome]]]:
    """What is tried, one after the other."""
    cold = replace(problem, start=None)
    first, last = first_intervals(cold), problem.nodes - 1
    other = "newton" if method == "multigrid" else "multigrid"
    trials = [(method, lambda: engine(problem))]
    if problem.start is not None:
        trials.append((method, lambda: engine(cold)))
    if first < last:
        finer = replace(cold, coarsest=min(4 * first, last))
        trials.append((method, lambda: engine(finer)))
    if first == last and problem.profile is None:
        # A grid may be too coarse to have any solution: see the inlet in `first_intervals`.
        trials += [
            (method, partial(engine, replace(cold, nodes=factor * last + 1)))
            for factor in (2, 4, 8, 16)
            if factor * last < MOST
        ]
    trials.append((other, lambda: ENGINES[other](cold)))
    trials.append(("newton", lambda: continue_to(cold)))
    return trials


def _failure(problem: ContactProblem, log: list[str]) -> Problem:
    tried = "; ".join(f"({number}) {entry}" for number, entry in enumerate(log, 1))
    start, end = problem.domain
    if any("rounding" in entry for entry in log):
        remedy = "Take a greater flux_tolerance or fewer nodes"
    else:
        remedy = "Take more nodes; check load, radius, speed, viscosity and their units"
    return Problem(
        what=f"the contact with M = {problem.moes_load:.4g}, film about {problem.film:.3g} b^2/R, "
        f"{problem.nodes} nodes from X = {start:.4g} to {end:.4g} was not solved",
        why=f"Tried: {tried}",
        remedy=remedy,
    )
