"""What is tried when an engine fails, what is logged, and that wrong solutions are not returned."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tribodyn.ehl import solve_line_contact_moes
from tribodyn.ehl.solver import fallbacks as attempts
from tribodyn.ehl.solver.contact_case import ContactProblem, Outcome, moes_case
from tribodyn.ehl.solver.engines import first_intervals, newton_engine
from tribodyn.ehl.solver.fallbacks import ENGINES, continue_to, solve_problem, verify
from tribodyn.ehl.solver.grid import choose_domain, estimate_film
from tribodyn.errors import ComputationError


def problem(M=20.0, L=10.0, nodes=257, **changes):
    scales = moes_case(M, L, 0.68, 2.2e-8, "roelands", True).scales
    film = estimate_film(M, L, scales.density_ratio)
    domain = choose_domain("auto", "flooded", film, scales)
    return replace(
        ContactProblem(
            nodes=nodes, domain=(domain.start, domain.end), lam=scales.lam, oil=scales.oil,
            film=film, load=0.5 * np.pi - domain.tail_load, tail=domain.tail, moes_load=M,
        ),
        **changes,
    )  # fmt: skip


def broken(_):
    return Outcome(False, None, 0, (), "it is broken")


def test_fallback_engine_is_used_and_reported(monkeypatch):
    monkeypatch.setitem(ENGINES._items, "multigrid", broken)
    solution = solve_problem(problem(), "multigrid")
    assert solution.method == "newton"
    assert solution.attempts[0] == "it is broken"
    assert solution.check.complaint(1e-3) == ""


def test_error_lists_all_attempts(monkeypatch):
    for name in ("newton", "multigrid"):
        monkeypatch.setitem(ENGINES._items, name, broken)
    stuck = Outcome(False, None, 0, (), "continuation stopped at 0.3 of the way")
    monkeypatch.setattr(attempts, "continue_to", lambda _: stuck)
    with pytest.raises(ComputationError) as caught:
        solve_problem(problem(), "newton")
    message = str(caught.value)
    assert message.count("it is broken") >= 2
    assert "stopped at 0.3" in message
    assert "M = 20" in message


@pytest.mark.parametrize(
    ("spoil", "message"),
    [
        (lambda g: replace(g, P=np.where(g.X > 0.9, 0.9 * g.P, g.P)), "flux error"),
        (lambda g: replace(g, P=np.where(np.arange(g.n + 1) == 9, -1e-3, g.P)), "negative"),
        (lambda g: replace(g, load=1.001 * g.load), "load error"),
        (lambda g: replace(g, H=g.H + 1e-4), "film differs"),
        (lambda g: replace(g, H0=g.H0 + 1e-3), "flux error"),
        (lambda g: replace(g, lam=1.01 * g.lam), "flux error"),
    ],
)
def test_wrong_solutions_are_detected(monkeypatch, spoil, message):
    right = newton_engine(problem())
    assert verify(right.grid).complaint(1e-3) == ""
    wrong = replace(right, grid=spoil(right.grid))
    assert message in verify(wrong.grid).complaint(1e-3)
    for name in ("newton", "multigrid"):
        monkeypatch.setitem(ENGINES._items, name, lambda _: wrong)
    monkeypatch.setattr(attempts, "continue_to", lambda _: wrong)
    with pytest.raises(ComputationError, match=message):
        solve_problem(problem(), "newton")


def test_outlet_in_the_wrong_place_is_detected():
    right = newton_engine(problem())
    early = problem(tail=right.grid.tail)
    k = right.grid.free - 6
    P = right.grid.P.copy()
    P[k + 1 :] = 0.0
    wrong = replace(right.grid, P=P, free=k)
    assert verify(wrong).cavity_residual < -1e-8
    assert "behind the outlet" in verify(wrong).complaint(1e3, 1e3)
    assert early.nodes == 257


def test_continuation_reaches_the_contact():
    direct = newton_engine(problem(100.0, 10.0, 513))
    along = continue_to(problem(100.0, 10.0, 513))
    assert along.converged
    assert along.films[-1] == pytest.approx(direct.films[-1], rel=1e-4)


def test_grid_without_a_solution_is_refined():
    # with an interval of twice the length of the inlet the discrete equations have no solution
    thin = solve_line_contact_moes(300, 0.5, nodes=257, domain="auto", inlet="flooded")
    assert thin.nodes > 257
    assert thin.attempts
    assert "gap" in thin.attempts[0]


def test_first_grid_resolves_the_inlet():
    thick, thin = problem(2.0, 10.0, 4097), problem(250.0, 0.5, 4097)
    assert first_intervals(thick) == 64
    m = first_intervals(thin)
    width = thin.domain[1] - thin.domain[0]
    assert width / m < 0.7 * thin.film ** (2 / 3) < 2.0 * width / m
    assert first_intervals(problem(20.0, 10.0, 1001)) == 125


def test_rounding_is_reported():
    with pytest.raises(ComputationError, match="rounding keeps the flux error"):
        solve_line_contact_moes(
            300, 4, nodes=8193, domain="auto", inlet="flooded", flux_tolerance=1e-11,
            tolerance=1e-8,
        )  # fmt: skip
