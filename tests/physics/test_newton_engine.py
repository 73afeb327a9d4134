"""The Newton engine: its linear algebra against dense matrices, and what its films must obey."""

from __future__ import annotations

import math

import numba as nb
import numpy as np
import pytest

from tribodyn.ehl import solve_line_contact, solve_line_contact_moes
from tribodyn.ehl._kernel.film_sum import influence, make_grid
from tribodyn.ehl._kernel.grid_transfer import refine
from tribodyn.ehl._kernel.linear_solver import (
    System,
    coarse_tangent,
    linear_solve,
    linear_work,
    no_coarse,
    prepare,
)
from tribodyn.ehl._kernel.newton import Equation, Limits, newton_level, newton_work
from tribodyn.ehl._kernel.reynolds import fill_oil, fill_tangent, make_fields
from tribodyn.lubricant import Lubricant

OIL = Lubricant(0.082, 880.0, 2.19e-8)


@nb.njit
def solve_system(n, dx, k, imposed, lam, oil, P, H, cH, cP, ratio, rhs, x):
    grid, work, coarse = make_grid(n, dx), linear_work(n), no_coarse()
    work.by_film[:], work.by_pressure[:] = cH, cP
    if ratio > 0:
        coarse = coarse_tangent(n, dx, k, ratio, lam, 1.0, 0.0, imposed, oil, P, H)
    good = prepare(grid, k, imposed, work)
    return good, linear_solve(System(grid, k, imposed, coarse, work), 1e-11, rhs, x)


@nb.njit
def solve_level(n, dx, lam, target, imposed, tail, oil, shape, offset, free, P, H):
    equation = Equation(lam, oil, 1.0, 0.0, np.zeros(n + 1), shape, tail, imposed, target)
    return newton_level(
        make_grid(n, dx), equation, Limits(1e-10, 1e-9, 40, 1e-2, 0.3), offset, free, P, H,
        np.empty(0), no_coarse(), newton_work(n, np.zeros(1, np.int64)),
    )  # fmt: skip


@nb.njit
def refined(n, dx, P, k, load, tail, fine):
    return refine(n, dx, P, k, load, tail, fine)


@nb.njit
def _coefficients_of(n, dx, lam, oil, P, H):
    f, (cH, cP) = make_fields(n), np.empty((2, n + 1, 4))
    fill_oil(n, lam, oil, P, H, f)
    fill_tangent(n, dx, 1.0, 0.0, P, H, f, cH, cP)
    return cH, cP, f.eps, influence(n, dx)


@pytest.fixture(scope="module")
def contact():
    return solve_line_contact_moes(
        50, 10, nodes=513, domain="auto", inlet="flooded", tolerance=1e-10, flux_tolerance=1e-9
    )


def tangent(grid):
    """Coefficients, and the dense bordered tangent made of them."""
    n, k, dx = grid.n, grid.free, grid.dx
    cH, cP, _, K = _coefficients_of(n, dx, grid.lam, grid.oil, grid.P, grid.H)
    J = np.zeros((k + 1, k + 1))
    columns = np.arange(1, k + 1)
    for i in range(1, k + 1):
        for s in range(4):
            node = i - 2 + s
            if node >= 0:
                J[i - 1, :k] += cH[i, s] * K[np.abs(node - columns)]
                J[i - 1, k] += cH[i, s]
                if 1 <= node <= k:
                    J[i - 1, node - 1] += cP[i, s]
    J[k, :k] = dx
    return cH, cP, J


@pytest.mark.slow
@pytest.mark.parametrize("imposed", [True, False])
@pytest.mark.parametrize("ratio", [0, 4])
def test_linear_solver_equals_the_dense_matrix(contact, imposed, ratio):
    grid = contact._grid
    n, k = grid.n, grid.free
    cH, cP, J = tangent(grid)
    size = k + 1 if imposed else k
    J = J[:size, :size]
    rng = np.random.default_rng(4)
    exact = rng.standard_normal(size)
    rhs, x = np.zeros(n + 2), np.zeros(n + 2)
    rhs[:size] = J @ exact
    good, products = solve_system(
        n, grid.dx, k, imposed, grid.lam, grid.oil, grid.P, grid.H, cH, cP, ratio, rhs, x
    )
    assert good
    assert 0 < products < 120
    assert x[:size] == pytest.approx(exact, abs=1e-6)
    if imposed:
        # the load row holds to rounding, however many iterations were made
        carried = grid.dx * np.abs(x[:k]).sum()
        assert grid.dx * x[:k].sum() == pytest.approx(rhs[k], abs=1e-9 * carried)


@pytest.mark.slow
def test_coarse_grid_saves_products(contact):
    fine = solve_line_contact_moes(200, 10, nodes=4097, domain="auto", inlet="flooded")._grid
    n, k = fine.n, fine.free
    cH, cP, _ = _coefficients(fine)
    rhs, x, counts = np.zeros(n + 2), np.zeros(n + 2), []
    rhs[k] = 0.5 * math.pi
    for ratio in (0, 32):
        counts.append(
            solve_system(
                n, fine.dx, k, True, fine.lam, fine.oil, fine.P, fine.H, cH, cP, ratio, rhs, x
            )[1]
        )
    assert 0 < counts[1] < 0.7 * counts[0]
    assert contact.attempts == ()


def _coefficients(grid):
    return _coefficients_of(grid.n, grid.dx, grid.lam, grid.oil, grid.P, grid.H)[:3]


@pytest.mark.slow
def test_imposed_approach_returns_the_load_that_was_imposed(contact):
    grid = contact._grid
    P, H = grid.P.copy(), np.zeros(grid.n + 1)
    P[grid.n // 2 : grid.free] *= 0.98  # a disturbed start

    def load(offset, free):
        return solve_level(
            grid.n, grid.dx, grid.lam, offset, False, grid.tail, grid.oil, grid.shape, offset,
            free, P, H,
        )  # fmt: skip

    solved = load(grid.H0, grid.free)
    assert solved.status == 0
    assert solved.offset == grid.H0
    assert solved.load == pytest.approx(grid.load, rel=1e-7)
    assert pytest.approx(P, abs=1e-7) == grid.P
    # pressed closer, the contact carries more
    assert load(grid.H0 - 1e-3, solved.free).load > 1.0005 * grid.load


def test_transfer_preserves_the_load_and_a_parabola():
    n, dx = 64, 0.1
    X = -4.0 + dx * np.arange(n + 1)
    P = np.maximum(1.03 - X, 0.0) ** 2 * (X + 4.0) * 0.02
    k = int(np.flatnonzero(P > 0.0)[-1])
    fine = np.zeros(2 * n + 1)
    load = dx * P.sum()
    last = refined(n, dx, P, k, load, 0.0, fine)
    assert 0.5 * dx * fine.sum() == pytest.approx(load, rel=1e-13)
    exact = np.maximum(1.03 - (-4.0 + 0.5 * dx * np.arange(2 * n + 1)), 0.0) ** 2
    exact *= (dx * np.arange(2 * n + 1) * 0.5) * 0.02
    assert fine == pytest.approx(exact, abs=4e-3 * exact.max())
    assert last == np.flatnonzero(exact > 0.0)[-1]
    assert np.all(fine[last + 1 :] == 0.0)


@pytest.mark.parametrize("nodes", [257, 1025, 2049])
def test_tight_tolerances_are_met(nodes):
    for M, L in ((20, 10), (5, 20), (100, 5)):
        solution = solve_line_contact_moes(
            M, L, nodes=nodes, domain="auto", inlet="flooded", tolerance=1e-11, flux_tolerance=1e-9
        )
        assert solution.flux_error <= 1.05e-9
        assert solution.load_error <= 1e-12
        assert solution.cavity_residual >= 0.0
        loose = solve_line_contact_moes(M, L, nodes=nodes, domain="auto", inlet="flooded")
        assert loose.flux_error <= 1e-3
        assert loose.central_film == pytest.approx(solution.central_film, rel=2e-4)


def test_equal_numbers_give_equal_films():
    first = solve_line_contact(1.5e5, 8e-3, 3.0, OIL, 2.2e11, nodes=513)
    # twice the radius at the same R/b and U: load and speed double, z and alpha stay
    second = solve_line_contact(3.0e5, 16e-3, 6.0, OIL, 2.2e11, nodes=513)
    assert second.moes_load == pytest.approx(first.moes_load, rel=1e-14)
    ratio = second.film / second.film_unit / (first.film / first.film_unit)
    assert ratio == pytest.approx(1.0, abs=1e-10)
    # half the viscosity and twice the speed, with the alpha that keeps z
    thin = Lubricant(0.041, 880.0, 2.19e-8)
    other = solve_line_contact(1.5e5, 8e-3, 6.0, thin, 2.2e11, nodes=513)
    assert other.moes_viscosity == pytest.approx(first.moes_viscosity, rel=1e-14)
    assert other.central_film != pytest.approx(first.central_film, rel=1e-4)  # z differs


def test_number_of_moes_and_mean_speed():
    solution = solve_line_contact(1.5e5, 8e-3, 3.0, OIL, 2.2e11, nodes=1025)
    H = solution.central_film / solution.film_unit
    U = 0.082 * 3.0 / (2.2e11 * 8e-3)
    moes = solution.central_film / 8e-3 / math.sqrt(2.0 * U)
    assert moes == pytest.approx(8.0 * solution.moes_load * H / math.pi, rel=1e-12)
    # taking the sum of the surface speeds for their mean: the classic factor 2^0.69 or so
    double = solve_line_contact(1.5e5, 8e-3, 6.0, OIL, 2.2e11, nodes=1025)
    assert double.central_film / solution.central_film == pytest.approx(1.62, abs=0.02)


@pytest.mark.parametrize("load", [49267.5, 147802.0, 295604.0])
def test_flooded_film_does_not_depend_on_the_domain(load):
    films = [
        solve_line_contact(
            load, 8e-3, 3.0722, OIL, 2.2e11, domain=domain, nodes=nodes
        ).central_film_extrapolated
        for domain, nodes in (((-6.0, 2.0), 2049), ((-20.0, 2.0), 8193), ("auto", 2049))
    ]
    assert max(films) / min(films) - 1.0 < 1e-3


def test_film_of_a_light_contact_of_thick_film():
    # M = 1, L = 0: the domain rule holds to 0.16 %
    auto = solve_line_contact_moes(1.0, 0.0, domain="auto", inlet="flooded", nodes=1025)
    far = solve_line_contact_moes(1.0, 0.0, domain=(-60.0, 5.0), inlet="flooded", nodes=8193)
    assert auto.central_film == pytest.approx(far.central_film, rel=2e-3)


@pytest.mark.parametrize("law", ["roelands", "barus", "isoviscous"])
@pytest.mark.parametrize("compressible", [True, False])
def test_stress_set_without_tuning(law, compressible):
    for M in (0.3, 1.0, 10.0, 100.0, 300.0, 1000.0):
        for L in (0.0, 2.0, 10.0, 25.0):
            alpha = max(2.2e-8, L * math.sqrt(M / (2.0 * math.pi)) / 4e9)
            solution = solve_line_contact_moes(
                M, L, nodes=1025, domain="auto", inlet="flooded", viscosity_law=law,
                compressible=compressible, pressure_viscosity_coefficient=min(alpha, 1e-7),
            )  # fmt: skip
            assert solution.attempts == (), (M, L)
            assert solution.pressure.min() >= 0.0
            assert solution.cavity_residual >= -1e-8
