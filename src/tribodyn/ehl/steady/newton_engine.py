"""The engine ``newton``: nested iteration with Newton's method and a Krylov linear solver."""

from __future__ import annotations

import numpy as np

from tribodyn.ehl.steady.contact_problem import ContactProblem, DiscreteContact, Outcome
from tribodyn.types import Array

#: Intervals of the coarsest grid at least, and interval that resolves an inlet, whose length
#: goes with the film to the power 2/3, between rigid bodies with its root.
_LEAST, _RESOLVED, _RESOLVED_RIGID = 64, 0.7, 0.35
#: Newton steps on a grid, and tolerance of the linear solver.
_STEPS, _LINEAR, _LINEAR_TIGHT = 40, 3e-2, 1e-2
#: Greatest change of a nodal pressure in a step, in Hertz pressures.
_CAP = 0.3

_REASONS = {
    1: "not converged in {steps} Newton steps",
    2: "no step of Newton's method kept the gap open",
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
    from tribodyn.ehl._kernel.steady import newton_solve

    n = problem.nodes - 1
    first = first_intervals(problem)
    start, end = problem.domain
    P, H = np.zeros(n + 1), np.zeros(n + 1)
    state, films = np.zeros(12), np.zeros(20)
    warm = problem.start is not None
    if problem.start is not None:
        grid = problem.start
        first = max(first, grid.n) if n % grid.n == 0 else first
        state[0], state[1] = _warm_start(problem, grid, first, P)
    tight = min(problem.tolerance, 0.1 * problem.flux_tolerance) < 1e-6
    limits = np.array(
        [
            problem.tolerance,
            problem.flux_tolerance,
            _STEPS,
            _LINEAR_TIGHT if tight else _LINEAR,
            _CAP,
            0.0,
        ]
    )
    profile = np.zeros(n + 1) if problem.profile is None else problem.profile
    status = newton_solve(
        n, first, warm, start, end, problem.lam, problem.oil, problem.film, problem.load,
        problem.tail, profile, limits, problem.film_tolerance, P, H, state, films,
    )  # fmt: skip
    m, grids = int(state[8]), int(state[10])
    message = ""
    if status != 0:
        reason = _REASONS[status].format(steps=int(state[2]), flux=state[4])
        message = f"newton from {int(state[9])} intervals: {reason} on {m} intervals"
    found = films[: grids if status == 0 else grids - 1]
    return Outcome(
        converged=status == 0,
        grid=_record(problem, m, P, H, state, profile),
        iterations=int(state[2]),
        films=tuple(float(film) for film in found),
        message=message,
    )


def _record(
    problem: ContactProblem, m: int, P: Array, H: Array, state: Array, profile: Array
) -> DiscreteContact:
    start, end = problem.domain
    dx = (end - start) / m
    X = np.asarray(start + dx * np.arange(m + 1))
    factor = (problem.nodes - 1) // m
    heights = profile
    if factor > 1:
        # As the compiled solver takes a profile on a coarser grid: its local mean.
        hat = 1.0 - np.abs(np.arange(1 - factor, factor)) / factor
        weight = np.convolve(np.ones_like(profile), hat, mode="same")
        heights = (np.convolve(profile, hat, mode="same") / weight)[::factor]
    return DiscreteContact(
        n=m, dx=dx, X=X, P=P[: m + 1].copy(), H=H[: m + 1].copy(), H0=float(state[0]),
        lam=problem.lam, oil=problem.oil, free=int(state[1]), load=problem.load,
        tail=problem.tail, shape=0.5 * X**2 + heights,
    )  # fmt: skip


def resample(grid: DiscreteContact, X: Array) -> tuple[Array, int]:
    """Pressure of a solution at other positions."""
    P = np.interp(X, grid.X, grid.P, left=0.0, right=0.0)
    P[-1] = 0.0
    positive = np.flatnonzero(P[:-1] > 0.0)
    return P, int(positive[-1]) if positive.size else 2


def _warm_start(
    problem: ContactProblem, grid: DiscreteContact, first: int, P: Array
) -> tuple[float, int]:
    """Fill ``P`` on the first grid from an earlier solution; offset and last free node."""
    start, end = problem.domain
    X = np.linspace(start, end, first + 1)
    values, free = resample(grid, X)
    values[0] = problem.tail
    total = float(np.sum(values[1:])) * (end - start) / first
    share = problem.load - 0.5 * problem.tail * (end - start) / first
    values[1:] *= share / total
    P[: first + 1] = values
    return grid.H0, free
