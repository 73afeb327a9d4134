"""The engine ``newton``: nested iteration with Newton's method and a Krylov linear solver."""

from __future__ import annotations

from typing import Any

import numpy as np

from tribodyn.ehl.steady.contact_problem import ContactProblem, DiscreteContact, Outcome
from tribodyn.interrupt import stoppable
from tribodyn.types import Array

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


def steady_contact(problem: ContactProblem, factor: int = 1) -> Any:
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
