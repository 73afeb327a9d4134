"""Physics of the solved film, checked by ways that do not share its discretisation."""

from __future__ import annotations

import math
from functools import cache

import numpy as np
import pytest

from known_films import deflection, known_film, limiting_film, rigid_film, wetted
from tribodyn.ehl import solve_line_contact_moes


@cache
def solved(M, L, nodes=4097, *, compressible=True, domain=(-4.5, 1.5)):
    return solve_line_contact_moes(
        M, L, compressible=compressible, domain=domain, inlet="zero", nodes=nodes,
        tolerance=1e-9, flux_tolerance=1e-8,
    )  # fmt: skip


def lam(M):
    return 3.0 * math.pi**2 / (8.0 * M**2)


CASES = [(20.0, 10.0), (5.0, 5.0), (3.0, 12.0)]


# The closed solutions for rigid bodies.


def test_constants_of_rigid_bodies_agree_with_literature():
    M = 0.01
    far = rigid_film(M, -1e7)
    assert far.minimum * 16.0 * M**2 / math.pi == pytest.approx(4.89496849, abs=1e-7)
    assert far.at_maximum * 8.0 * M**2 / math.pi == pytest.approx(3.0, abs=1e-8)
    assert limiting_film() == pytest.approx((1.04970, 1.28667), abs=5e-6)


@pytest.mark.parametrize("reach", [4.0, 10.0])
def test_isoviscous_film_tends_to_that_of_rigid_bodies(reach):
    deviation = []
    for M in (0.1, 0.05):
        unit = math.sqrt(2.0 * 4.895 * math.pi / 16.0) / M
        rigid = rigid_film(M, -reach * unit)
        solution = solve_line_contact_moes(
            M, 0.0, compressible=False, domain=(-reach * unit, unit), inlet="zero", nodes=4097
        )
        deviation.append(solution.minimum_film / rigid.minimum - 1.0)
        assert solution.outlet == pytest.approx(rigid.outlet, rel=0.02)
    assert abs(deviation[1]) < 1e-3
    # what the bodies yield falls with the square of M
    assert deviation[1] == pytest.approx(deviation[0] / 4.0, abs=1e-4)


def test_piezoviscous_film_tends_to_that_of_rigid_bodies():
    deviation = []
    for M in (0.4, 0.2):
        L = 4.0 / M**1.5  # the reduced pressure comes to 72 % of its bound 1/alpha
        unit = 1.3 * math.sqrt(2.0 * 4.895 * math.pi / 16.0) / M
        rigid = rigid_film(M, -8.0 * unit, piezoviscosity=L * math.sqrt(M / (2.0 * math.pi)))
        plain = rigid_film(M, -8.0 * unit)
        assert rigid.minimum > 1.3 * plain.minimum
        solution = solve_line_contact_moes(
            M, L, compressible=False, domain=(-8.0 * unit, unit), inlet="zero", nodes=4097,
            viscosity_law="barus",
        )  # fmt: skip
        deviation.append(solution.minimum_film / rigid.minimum - 1.0)
    assert abs(deviation[1]) < 1e-2
    assert (4.0 * deviation[1] - deviation[0]) / 3.0 == pytest.approx(0.0, abs=1e-3)


# The field equations of a solved contact, each by another numerical method.


@pytest.mark.parametrize(("M", "L"), CASES)
def test_film_is_the_elastic_gap_under_its_pressure(M, L):
    solution = solved(M, L)
    at = np.linspace(-4.0, 1.45, 60)
    gap = 0.5 * at**2 + deflection(solution.position, at) @ solution.pressure
    offset = np.interp(at, solution.position, solution.film) - gap
    assert np.ptp(offset) < 2e-3 * solution.central_film


@pytest.mark.parametrize(("M", "L"), CASES)
def test_pressure_follows_from_the_film_by_the_first_integral(M, L):
    """March ``dP/dX = lambda eta (H - H_m)/H^3`` through the inlet over the film alone."""
    from scipy.integrate import solve_ivp
    from scipy.interpolate import CubicSpline

    solution = solved(M, L, compressible=False)
    X, H = solution.position, CubicSpline(solution.position, solution.film)
    outlet = float(H(solution.outlet))
    alpha_p = L * math.sqrt(M / (2.0 * math.pi))
    index, reference = 0.68, 1.0 / 5.1e-9 / (alpha_p / 2.2e-8)

    def slope(x, p):
        viscous = alpha_p * reference / index * ((1.0 + p / reference) ** index - 1.0)
        h = float(H(x))
        return lam(M) * np.exp(viscous) * (h - outlet) / h**3

    place = np.array([-3.0, -2.0, -1.5, -1.2, -1.0])
    marched = solve_ivp(
        slope, (X[0], place[-1]), [0.0], t_eval=place, rtol=1e-8, atol=1e-12, max_step=0.02
    )
    exact = np.interp(place, X, solution.pressure)
    np.testing.assert_allclose(marched.y[0], exact, rtol=5e-3)


@pytest.mark.parametrize(("M", "L"), CASES)
def test_flux_by_spline_derivatives_is_one_constant(M, L):
    from scipy.interpolate import CubicSpline

    solution = solved(M, L, compressible=False)
    slope = CubicSpline(solution.position, solution.pressure).derivative()(solution.position)
    flux = solution.film - solution.film**3 / solution.viscosity / lam(M) * slope
    wet = (solution.position > -4.0) & (solution.position < 0.98 * solution.outlet)
    # the spike is the one place where a spline does not follow
    smooth = wet & (np.abs(solution.position - wetted(solution).spike[0]) > 0.02)
    at_outlet = np.interp(solution.outlet, solution.position, solution.film)
    np.testing.assert_allclose(flux[smooth], at_outlet, rtol=2e-3)


@pytest.mark.parametrize(("M", "L"), CASES)
def test_load_by_another_quadrature(M, L):
    from scipy.integrate import simpson

    solution = solved(M, L)
    assert simpson(solution.pressure, x=solution.position) == pytest.approx(math.pi / 2.0, rel=2e-4)


@pytest.mark.parametrize(("M", "L"), CASES)
def test_rolling_traction_balances_the_moment_of_the_pressure(M, L):
    """``int h dp/dx dx = -int p x/R dx``: the elastic gap does no work on its own pressure."""
    solution = solved(M, L)
    X, P, H = solution.position, solution.pressure, solution.film
    traction = np.sum(0.5 * (H[1:] + H[:-1]) * np.diff(P))
    moment = -np.trapezoid(P * X, X)
    assert moment > 0.0  # the pressure leads: rolling is resisted
    assert traction == pytest.approx(moment, rel=2e-3)


# The inlet.


@pytest.mark.parametrize(("M", "L"), [(1.65, 19.8), (5.0, 20.0), (20.0, 10.0)])
def test_a_flooded_inlet_adds_the_wedge_before_the_first_node(M, L):
    from scipy.integrate import quad

    solution = solve_line_contact_moes(M, L, domain=(-5.0, 1.8), inlet="flooded", nodes=2049)

    def slope(x):
        dry = 0.5 * (x * math.sqrt(x * x - 1.0) - math.log(x + math.sqrt(x * x - 1.0)))
        return lam(M) * dry / (dry + solution.central_film) ** 3

    pressure, _ = quad(slope, 5.0, math.inf)
    load, _ = quad(lambda x: slope(x) * (x - 5.0), 5.0, math.inf)
    assert solution.pressure[0] == pytest.approx(pressure, rel=0.03)
    width = solution.position[1] - solution.position[0]
    carried = width * (solution.pressure.sum() - 0.5 * solution.pressure[0])
    assert math.pi / 2.0 - carried == pytest.approx(load, rel=0.03)


@pytest.mark.parametrize(("M", "L"), [(1.65, 19.8), (5.0, 20.0), (20.0, 10.0)])
def test_flooded_film_does_not_depend_on_where_the_grid_begins(M, L):
    films = []
    for start in (-6.0, -20.0):
        nodes = 2049 if start == -6.0 else 8193
        solution = solve_line_contact_moes(M, L, domain=(start, 1.8), inlet="flooded", nodes=nodes)
        films.append(solution.central_film_extrapolated)
    starved = solve_line_contact_moes(M, L, domain=(-20.0, 1.8), inlet="zero", nodes=8193)
    assert films[0] == pytest.approx(films[1], rel=1e-3)
    assert starved.central_film_extrapolated < films[1]
    assert starved.central_film_extrapolated == pytest.approx(films[1], rel=3e-3)


# Limits.


def test_pressure_tends_to_that_of_the_dry_contact():
    worst, outlet = [], []
    for M in (20.0, 200.0, 800.0):
        solution = solved(M, 5.0, domain=(-2.5, 1.5))
        inside = np.abs(solution.position) < 0.7
        dry = np.sqrt(1.0 - solution.position[inside] ** 2)
        worst.append(np.abs(solution.pressure[inside] - dry).max())
        outlet.append(solution.outlet)
    assert worst[0] > worst[1] > worst[2]
    assert worst[2] < 0.01
    assert outlet[0] > outlet[1] > outlet[2] > 1.0
    assert outlet[2] == pytest.approx(1.0, abs=0.02)


def test_film_outside_a_loaded_contact_is_the_dry_gap():
    solution = solved(800.0, 5.0, domain=(-2.5, 1.5))
    x = np.array([1.2, 1.3, 1.45])
    dry = 0.5 * (x * np.sqrt(x**2 - 1.0) - np.log(x + np.sqrt(x**2 - 1.0)))
    gap = np.interp(x, solution.position, solution.film) - solution.central_film
    np.testing.assert_allclose(gap, dry, rtol=0.05)


# The whole contact, by a scheme of its own.


@pytest.mark.parametrize(("M", "L"), [(20.0, 10.0), (5.0, 5.0)])
def test_film_agrees_with_the_reference_scheme(M, L):
    solution = solved(M, L)
    reference = known_film(M, L, wetted(solution), inlet=-4.5)
    assert solution.central_film == pytest.approx(reference.central, rel=3e-4)
    assert solution.minimum_film == pytest.approx(reference.minimum, rel=5e-4)
    assert solution.outlet == pytest.approx(reference.X[-1], abs=1e-3)
    spike, _ = reference.spike
    inside = reference.X - spike < -0.05
    pressure = np.interp(reference.X, solution.position, solution.pressure)
    np.testing.assert_allclose(pressure[inside], reference.P[inside], atol=1e-3)
