"""The compiled kernels of the film against the equations in plain NumPy, piece by piece."""

from __future__ import annotations

import math

import numba as nb
import numpy as np
import pytest

from plain.film import PlainContact, PlainOil, plain_oil
from plain.film_newton import dry_start, solve_plain
from tribodyn.ehl import solve_line_contact, solve_line_contact_moes
from tribodyn.ehl._kernel import film_sum as sums
from tribodyn.ehl._kernel import reynolds
from tribodyn.errors import ComputationError
from tribodyn.lubricant import (
    barus_viscosity,
    dowson_higginson_density,
    from_library,
    roelands_viscosity,
)

_LAWS = ("isoviscous", "barus", "roelands")


@nb.njit
def _film_sum(n, kernel, P):
    out, work = np.empty(n + 1), np.empty(sums.film_work_size(n))
    sums.film_sum(n, kernel, sums.film_plan(n, kernel), P, work, out)
    return out


@nb.njit
def _influence(n, dx):
    return sums.influence(n, dx)


@nb.njit
def _oil(n, P, oil):
    lneta, dlneta, rho, drho = np.empty(n + 1), np.empty(n + 1), np.empty(n + 1), np.empty(n + 1)
    reynolds.oil_state(n, P, oil, lneta, dlneta, rho, drho)
    return lneta, dlneta, rho, drho


@nb.njit
def _reynolds(n, dx, lam, u, squeeze, history, P, H, oil):
    f, cH, cP = reynolds.make_fields(n), np.empty((n + 1, 4)), np.empty((n + 1, 4))
    reynolds.fill_oil(n, lam, oil, P, H, f)
    reynolds.residual(n, dx, u, squeeze, history, P, H, f)
    reynolds.fill_tangent(n, dx, u, squeeze, P, H, f, cH, cP)
    return f.F[: n + 1], f.G[: n + 1], cH, cP


def make(
    n: int = 60,
    M: float = 8.0,
    L: float = 9.0,
    *,
    law: str = "roelands",
    compressible: bool = True,
    domain: tuple[float, float] = (-4.5, 1.5),
    inlet_pressure: float = 0.0,
) -> PlainContact:
    """Contact of Moes' numbers, with alpha = 2.2e-8 1/Pa and z = 0.68."""
    hertz = L * math.sqrt(M / (2.0 * math.pi)) / 2.2e-8
    oil = plain_oil(law, hertz, 2.2e-8, compressible=compressible)
    lam = 3.0 * math.pi**2 / (8.0 * M**2)
    return PlainContact(n, domain, lam, oil, inlet_pressure=inlet_pressure)


def state(contact: PlainContact, seed: int = 1) -> tuple[np.ndarray, np.ndarray]:
    """Pressures and films with nothing regular about them; P at the outlet is zero."""
    generator = np.random.default_rng(seed)
    P = generator.uniform(0.0, 0.2, contact.intervals + 1)
    P[-1] = 0.0
    return P, generator.uniform(0.5, 1.5, contact.intervals + 1)


# The equations themselves, against what they are meant to be.


def test_hertz_pressure_makes_a_flat_gap():
    contact = make(2000, domain=(-2.0, 2.0))
    H = contact.film(np.sqrt(np.maximum(1.0 - contact.X**2, 0.0)), 0.0)
    inside = np.abs(contact.X) < 0.95
    assert np.ptp(H[inside]) < 2e-4
    wide = np.abs(contact.X[np.abs(contact.X) > 1.05])
    dry = 0.5 * (wide * np.sqrt(wide**2 - 1.0) - np.log(wide + np.sqrt(wide**2 - 1.0)))
    flatness = H[np.abs(contact.X) > 1.05] - H[inside].mean()
    np.testing.assert_allclose(flatness, dry, atol=2e-4)


def test_influence_is_the_integral_of_the_logarithm():
    from scipy.integrate import quad

    contact = make(40)
    for m in (0, 1, 2, 17, 40):
        ends = ((m - 0.5) * contact.width, (m + 0.5) * contact.width)
        exact, _ = quad(
            lambda x: -math.log(abs(x)) / math.pi, *ends, points=[0.0] if m == 0 else None
        )
        assert contact.influence[0, m] == pytest.approx(exact, rel=1e-10, abs=1e-14)


@pytest.mark.parametrize("law", ["barus", "roelands"])
def test_oil_is_that_of_the_lubricant(law):
    hertz, alpha, viscosity = 0.9e9, 2.19e-8, 0.082
    z = alpha / 5.1e-9 / (math.log(viscosity) + 9.67)
    oil, P = plain_oil(law, hertz, alpha, z), np.linspace(0.0, 1.3, 14)
    formula = {"barus": barus_viscosity, "roelands": roelands_viscosity}[law]
    exact = np.log(formula(P * hertz, viscosity, alpha) / viscosity)
    np.testing.assert_allclose(oil.log_viscosity(P)[0], exact, rtol=2e-4, atol=1e-12)
    exact = dowson_higginson_density(P * hertz, 880.0) / 880.0
    np.testing.assert_allclose(oil.density(P)[0], exact, rtol=1e-12)
    assert oil.initial_slope == pytest.approx(alpha * hertz, rel=1e-12)


@pytest.mark.parametrize("law", _LAWS)
@pytest.mark.parametrize("compressible", [True, False])
def test_plain_jacobian_is_the_derivative(law, compressible):
    contact = make(law=law, compressible=compressible)
    P, offset = dry_start(contact)
    full, by_offset = contact.jacobian(P, contact.film(P, offset))
    direction = np.random.default_rng(2).standard_normal(len(P))
    direction[-1] = 0.0
    tiny = 1e-25  # a complex step: no difference of near numbers
    moved = P + 1j * tiny * direction
    slope = contact.residual(moved, contact.film(moved, offset)).imag / tiny
    np.testing.assert_allclose(full @ direction, slope, rtol=1e-10, atol=1e-12 * abs(slope).max())
    raised = contact.residual(P, contact.film(P, offset) + 1j * tiny).imag / tiny
    np.testing.assert_allclose(by_offset, raised, rtol=1e-10, atol=1e-12 * abs(raised).max())


def test_plain_solution_meets_every_condition():
    contact = make(256, 20.0, 10.0)
    solution = solve_plain(contact)
    P, H, free = solution.P, solution.H, solution.free
    assert P[1 : free + 1].min() > 0.0
    assert np.all(P[free + 1 :] == 0.0)
    residual = contact.residual(P, H)
    assert np.abs(residual[:free]).max() < 1e-12
    assert residual[free:].min() > 0.0
    assert contact.width * P.sum() == pytest.approx(math.pi / 2.0, rel=1e-12)
    np.testing.assert_allclose(H, contact.film(P, solution.offset), atol=1e-14)
    flux = contact.flux(P, H)[: free + 1]
    assert np.ptp(flux) < 1e-10 * flux.mean()


def test_plain_solution_does_not_depend_on_the_start():
    contact = make(200, 12.0, 8.0)
    first = solve_plain(contact)
    P, offset = dry_start(make(200, 15.0, 7.0))
    second = solve_plain(contact, (P, offset))
    assert first.free == second.free
    np.testing.assert_allclose(first.H, second.H, rtol=1e-9)
    np.testing.assert_allclose(first.P, second.P, atol=1e-9)


@pytest.mark.slow
def test_plain_solver_reports_failure():
    with pytest.raises(ComputationError, match="plain solver stopped"):
        solve_plain(make(128, 20.0, 10.0), flux_tolerance=0.0)


# The compiled kernels against them.


@pytest.mark.parametrize("n", [1, 16, 63, 64, 65, 100, 129, 200, 255, 256, 777, 1024, 2048])
def test_film_sum_equals_the_dense_sum(n):
    contact = make(n, domain=(-4.5, 1.5))
    P, _ = state(contact)
    kernel = _influence(n, contact.width)
    np.testing.assert_allclose(kernel, contact.influence[0], rtol=1e-13 * n, atol=1e-15)
    node = np.arange(n + 1)
    exact = kernel[np.abs(node[:, None] - node)] @ P
    assert np.abs(_film_sum(n, kernel, P) - exact).max() < 1e-12 * np.abs(exact).max()


def test_film_sum_of_a_large_grid_is_that_of_single_nodes():
    n, width = 16384, 6.0 / 16384
    kernel = _influence(n, width)
    for node in (0, 1, 5000, n - 1):
        P = np.zeros(n + 1)
        P[node] = 1.0
        exact = kernel[np.abs(np.arange(n + 1) - node)]
        assert np.abs(_film_sum(n, kernel, P) - exact).max() < 1e-12 * np.abs(exact).max()


@pytest.mark.parametrize("law", _LAWS)
@pytest.mark.parametrize("compressible", [True, False])
def test_oil_kernel_equals_plain(law, compressible):
    hertz = 2.5e9 if law == "roelands" else 0.6e9
    oil = plain_oil(law, hertz, 2.4e-8, 0.6, compressible=compressible)
    P = np.concatenate((np.linspace(0.0, 1.4, 300), [1e-12, 1e-6, 0.0]))
    coefficients = _oil(len(P) - 1, P, np.array(oil))
    for kernel, plain in zip(coefficients, (*oil.log_viscosity(P), *oil.density(P)), strict=True):
        np.testing.assert_allclose(kernel, plain, rtol=2e-14, atol=2e-14)


def test_oil_kernel_holds_roelands_at_the_same_tension():
    oil = plain_oil("roelands", 1e9, 2e-8)
    P = np.array([-0.2, -0.29, -0.31, -5.0]) * oil.reference
    lneta, dlneta, _, _ = _oil(len(P) - 1, P, np.array(oil))
    np.testing.assert_allclose(lneta, oil.log_viscosity(P)[0], rtol=1e-13)
    assert np.all(dlneta > 0.0)  # the slope goes on, so that Newton's method is led back


@pytest.mark.parametrize("law", _LAWS)
@pytest.mark.parametrize(("u", "squeeze"), [(1.0, 0.0), (0.7, 0.4)])
def test_residual_equals_plain(law, u, squeeze):
    contact = make(law=law)
    P, H = state(contact)
    P[0] = 0.03  # a wedge that is cut off leaves a pressure there
    history = np.random.default_rng(5).uniform(-0.1, 0.1, len(P))
    n, lam, oil = contact.intervals, contact.speed_parameter, np.array(contact.oil)
    F, G, _, _ = _reynolds(n, contact.width, lam, u, squeeze, history, P, H, oil)
    flux = contact.flux(P, H, u)
    np.testing.assert_allclose(F[:n], flux, rtol=1e-12, atol=1e-13 * np.abs(flux).max())
    residual = contact.residual(P, H, u, squeeze, history[1:-1])
    np.testing.assert_allclose(G[1:n], residual, rtol=0.0, atol=1e-12 * np.abs(flux).max())


@pytest.mark.parametrize("law", _LAWS)
@pytest.mark.parametrize(("u", "squeeze"), [(1.0, 0.0), (0.7, 0.4)])
def test_eight_coefficients_are_the_derivatives(law, u, squeeze):
    contact = make(32, law=law)
    P, H = state(contact)
    n, lam, oil, tiny = contact.intervals, contact.speed_parameter, np.array(contact.oil), 1e-25
    _, _, cH, cP = _reynolds(n, contact.width, lam, u, squeeze, np.zeros(n + 1), P, H, oil)
    by_film, by_pressure = np.zeros((n + 1, n + 1)), np.zeros((n + 1, n + 1))
    for j in range(n + 1):
        unit = 1j * tiny * (np.arange(n + 1) == j)
        by_film[1:-1, j] = contact.residual(P, H + unit, u, squeeze).imag / tiny
        by_pressure[1:-1, j] = contact.residual(P + unit, H, u, squeeze).imag / tiny
    for derivative, exact in ((cH, by_film), (cP, by_pressure)):
        size = np.abs(exact).max()
        assert size > 0.1
        for i in range(1, n):
            row = np.zeros(n + 3)
            row[i - 1 : i + 3] = derivative[i]  # nodes i-2..i+1, after one place for node -1
            np.testing.assert_allclose(row[1:-1], exact[i], rtol=1e-11, atol=1e-12 * size)
            assert row[0] == 0.0
    assert not np.any(cH[[0, n]])
    assert not np.any(cP[[0, n]])


def test_gap_that_is_closed_has_no_slope_in_the_mobility():
    contact = make(16)
    P, H = state(contact)
    H[5:8] = -1e-3
    n, oil = contact.intervals, np.array(contact.oil)
    F, _, cH, _ = _reynolds(
        n, contact.width, contact.speed_parameter, 1.0, 0.0, np.zeros(n + 1), P, H, oil
    )
    np.testing.assert_allclose(F[:n], contact.flux(P, H), rtol=1e-12, atol=1e-12)
    rho = contact.oil.density(P)[0]
    assert cH[7, 2] == pytest.approx(1.5 * rho[7], rel=1e-12)


# The compiled solvers, on the same grid.

_TIGHT = {"newton": 1e-10, "multigrid": 1e-9}
_CONTACTS = {
    "M20 L10": {"M": 20.0, "L": 10.0},
    "incompressible": {"M": 20.0, "L": 10.0, "compressible": False},
    "barus": {"M": 6.0, "L": 8.0, "viscosity_law": "barus"},
    "isoviscous": {"M": 5.0, "L": 0.0},
    "heavy": {"M": 150.0, "L": 10.0, "domain": (-2.5, 1.5)},
    "light": {"M": 1.5, "L": 15.0, "domain": (-9.0, 2.5)},
    "odd grid": {"M": 12.0, "L": 9.0, "nodes": 401},
    "flooded": {"M": 4.0, "L": 12.0, "domain": "auto", "inlet": "flooded"},
}


def twin(solution):
    """The plain contact on the grid of a solution."""
    grid = solution._grid
    oil = PlainOil(*map(float, grid.oil))
    return PlainContact(grid.n, solution.domain, grid.lam, oil, grid.load, grid.tail)


@pytest.mark.parametrize("method", ["newton", pytest.param("multigrid", marks=pytest.mark.slow)])
@pytest.mark.parametrize("name", _CONTACTS)
def test_solver_equals_plain(name, method):
    case = {"nodes": 257, **_CONTACTS[name]}
    solution = solve_line_contact_moes(
        case.pop("M"), case.pop("L"), method=method, tolerance=1e-9, flux_tolerance=1e-8, **case
    )
    assert solution.method == method
    contact = twin(solution)
    plain = solve_plain(contact, (solution._grid.P, solution._grid.H0))
    precision = _TIGHT[method] * 10.0
    np.testing.assert_allclose(solution.film, plain.H, rtol=precision)
    np.testing.assert_allclose(solution.pressure, plain.P, atol=precision)
    assert solution._grid.free == plain.free
    cold = solve_plain(contact)  # nothing of the solution that is judged goes in
    np.testing.assert_allclose(solution.film, cold.H, rtol=precision)


def test_solver_in_si_equals_plain():
    oil = from_library("80W")
    solution = solve_line_contact(
        1.2e5, 9e-3, 4.0, oil, 2.2e11, nodes=257, tolerance=1e-10, flux_tolerance=1e-9
    )
    half_width = math.sqrt(8.0 * 1.2e5 * 9e-3 / (math.pi * 2.2e11))
    hertz = 2.0 * 1.2e5 / (math.pi * half_width)
    assert solution.half_width == pytest.approx(half_width, rel=1e-13)
    assert solution.hertz_pressure == pytest.approx(hertz, rel=1e-13)
    alpha = oil.pressure_viscosity_coefficient
    lam = 12.0 * oil.dynamic_viscosity * 4.0 * 9e-3**2 / (half_width**3 * hertz)
    same = PlainContact(
        256, solution.domain, lam, plain_oil("roelands", hertz, alpha, oil.roelands_index),
        solution._grid.load, solution._grid.tail,
    )  # fmt: skip
    plain = solve_plain(same)
    np.testing.assert_allclose(solution.film, plain.H * half_width**2 / 9e-3, rtol=1e-8)
    np.testing.assert_allclose(solution.pressure, plain.P * hertz, atol=1e-8 * hertz)


def test_random_gear_contacts_meet_the_plain_equations():
    generator = np.random.default_rng(17)
    for _ in range(25):
        M, L = math.exp(generator.uniform(0.0, math.log(300.0))), generator.uniform(0.0, 25.0)
        L = min(L, 2.2e-8 * 2e9 / math.sqrt(M / (2.0 * math.pi)))
        solution = solve_line_contact_moes(M, L, domain="auto", inlet="flooded", nodes=513)
        contact, P = twin(solution), solution.pressure
        H = contact.film(P, solution._grid.H0)
        np.testing.assert_allclose(solution.film, H, rtol=1e-10)
        free, flux = solution._grid.free, contact.flux(P, H)
        assert P.min() == 0.0
        assert np.all(P[free + 1 :] == 0.0)
        wet = flux[: free + 1]
        deviation = np.abs(wet / wet.mean() - 1.0).max()
        assert deviation < 1e-3
        assert solution.flux_error == pytest.approx(deviation, rel=0.02, abs=1e-9)
        gain = contact.residual(P, H)[free:] / contact.width
        assert gain.min() > -1e-8
        assert solution.cavity_residual == pytest.approx(gain.min(), rel=1e-6, abs=1e-8)
        load = contact.width * (P.sum() - 0.5 * P[0])
        assert load == pytest.approx(solution._grid.load, rel=1e-10)
