"""The last resort of the solvers: from an easy contact to the one asked for, step by step."""

from __future__ import annotations

from dataclasses import replace

from tribodyn.ehl.discrete import ContactProblem, DiscreteContact, Outcome
from tribodyn.ehl.newton_engine import newton_engine

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
