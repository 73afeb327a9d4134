"""Solving against all odds: other starts, the other engine, continuation, and then the truth."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import partial

from tribodyn.ehl.automatic import MOST
from tribodyn.ehl.continuation import continue_to
from tribodyn.ehl.discrete import ContactProblem, Outcome
from tribodyn.ehl.newton_engine import first_intervals, newton_engine
from tribodyn.ehl.verification import Verification, verify
from tribodyn.errors import ComputationError, Problem
from tribodyn.model import Registry

#: A solver of steady contacts.
Engine = Callable[[ContactProblem], Outcome]

#: The solvers by name.
ENGINES: Registry[Engine] = Registry("film solver", "tribodyn.film_solver")
ENGINES.register("newton")(newton_engine)


@ENGINES.register("multigrid")
def _multigrid(problem: ContactProblem) -> Outcome:
    from tribodyn.ehl.multigrid_engine import multigrid_engine

    outcome: Outcome = multigrid_engine(problem)
    return outcome


class Solved:
    """A verified solution and how it was found."""

    def __init__(
        self, outcome: Outcome, check: Verification, method: str, attempts: tuple[str, ...]
    ) -> None:
        self.outcome = outcome
        self.check = check
        self.method = method
        self.attempts = attempts


def solve_problem(problem: ContactProblem, method: str) -> Solved:
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
                return Solved(outcome, check, name, tuple(log))
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
