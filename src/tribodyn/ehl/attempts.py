"""Solving against all odds: other starts, the other engine, continuation, and then the truth."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from tribodyn.ehl.continuation import continue_to
from tribodyn.ehl.discrete import ContactProblem, Outcome
from tribodyn.ehl.newton_engine import first_intervals, newton_engine
from tribodyn.ehl.verification import Verification, verify
from tribodyn.errors import ComputationError, Problem
from tribodyn.registry import Registry

__all__ = ["ENGINES", "Engine", "Solved", "solve_problem"]

#: A solver of steady contacts.
Engine = Callable[[ContactProblem], Outcome]

#: The solvers by name.
ENGINES: Registry[Engine] = Registry("film solver", "tribodyn.film_solver")
ENGINES.register("newton")(newton_engine)


@ENGINES.register("multigrid")
def _multigrid(problem: ContactProblem) -> Outcome:
    from tribodyn.ehl.multigrid_engine import multigrid_engine

    return multigrid_engine(problem)


class Solved:
    """A verified solution and how it was found.

    Parameters
    ----------
    outcome : Outcome
        Solution.
    check : Verification
        How well it meets the equations.
    method : str
        Engine that found it.
    attempts : tuple of str
        What was tried in vain before.
    """

    def __init__(
        self, outcome: Outcome, check: Verification, method: str, attempts: tuple[str, ...]
    ) -> None:
        self.outcome = outcome
        self.check = check
        self.method = method
        self.attempts = attempts


def solve_problem(problem: ContactProblem, method: str) -> Solved:
    """Solve a contact with one engine, and with all other means where that fails.

    Parameters
    ----------
    problem : ContactProblem
        The contact.
    method : str
        Name in :data:`ENGINES`.

    Returns
    -------
    Solved
        Verified against the discrete equations.

    Raises
    ------
    InputError
        If no engine has that name.
    ComputationError
        With the log of all attempts, if none led to a solution.
    """
    engine = ENGINES[method]
    log: list[str] = []
    cold = replace(problem, start=None)
    other = "newton" if method == "multigrid" else "multigrid"
    finer = 4 * first_intervals(cold)

    def again() -> Outcome:
        return engine(replace(cold, coarsest=min(finer, problem.nodes - 1)))

    trials: list[tuple[str, Callable[[], Outcome]]] = [
        (method, lambda: engine(problem)),
        (method, lambda: engine(cold)),
        (method, again),
        (other, lambda: ENGINES[other](cold)),
        ("newton", lambda: continue_to(cold)),
    ]
    if problem.start is None:
        del trials[1]
    for name, trial in trials:
        outcome = trial()
        complaint = outcome.message
        if outcome.converged and outcome.grid is not None:
            check = verify(outcome.grid)
            complaint = check.complaint(1.05 * problem.flux_tolerance + 1e-9)
            if outcome.grid.free >= outcome.grid.n - 1:
                complaint = "the oil film reaches the end of the domain"
            if not complaint:
                return Solved(outcome, check, name, tuple(log))
            complaint = f"{name}: {complaint}"
        log.append(complaint)
    raise ComputationError(_failure(problem, log))


def _failure(problem: ContactProblem, log: list[str]) -> Problem:
    tried = "; ".join(f"({number}) {entry}" for number, entry in enumerate(log, 1))
    start, end = problem.domain
    if any("end of the domain" in entry for entry in log):
        remedy = f"Let the domain end beyond X = {end:g}"
    elif any("rounding" in entry for entry in log):
        remedy = "Take a greater flux_tolerance or fewer nodes"
    else:
        remedy = "Take more nodes; check load, radius, speed, viscosity and their units"
    return Problem(
        what=f"the contact with M = {problem.moes_load:.4g}, film about {problem.film:.3g} b^2/R, "
        f"{problem.nodes} nodes from X = {start:.4g} to {end:.4g} was not solved",
        why=f"Tried: {tried}",
        remedy=remedy,
    )
