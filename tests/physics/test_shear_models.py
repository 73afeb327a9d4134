"""Shear models against closed forms, limits and a quadrature of the shear rate over the film."""

from __future__ import annotations

import numpy as np
import pytest

from plain.film import PlainContact, plain_oil
from plain.film_newton import solve_plain
from tribodyn.contact import hertz_line
from tribodyn.ehl import (
    SHEAR_MODELS,
    FilmState,
    bair_winer_shear_stress,
    carreau_shear_stress,
    film_traction,
)
from tribodyn.errors import InputError
from tribodyn.lubricant import Lubricant

OIL = Lubricant(0.082, 880.0, 2.19e-8)
PRESSURE, HALF_WIDTH = 0.8e9, 1e-4
LOAD = 0.5 * np.pi * HALF_WIDTH * PRESSURE
GAUSS, WEIGHT = np.polynomial.legendre.leggauss(40)


@pytest.fixture(scope="module")
def hertzian():
    """A flat film under the pressure of Hertz: no gradient matters in the sum of both halves."""
    x = np.linspace(-1.0, 1.0, 2001)
    pressure = PRESSURE * np.sqrt(1.0 - x**2)
    return FilmState(HALF_WIDTH * x, pressure, np.full(x.size, 1e-9), OIL, 2.2e11)


@pytest.fixture(scope="module")
def solved():
    hertz = hertz_line(147802.0, 8e-3, 2.2e11)
    b, p_h = float(hertz.half_width), float(hertz.maximum_pressure)
    speed = 12.0 * OIL.dynamic_viscosity * 3.0722 * 8e-3**2 / (b**3 * p_h)
    oil = plain_oil("roelands", p_h, OIL.pressure_viscosity_coefficient, OIL.roelands_index)
    contact = PlainContact(256, (-4.5, 1.5), speed, oil)
    answer = solve_plain(contact)
    return FilmState(contact.X * b, answer.P * p_h, answer.H * b**2 / 8e-3, OIL, 2.2e11)


@pytest.mark.parametrize("share", [1e-6, 0.01, 0.5, 0.99])
def test_bair_winer_rate_of_its_stress_is_that_of_the_film(share):
    limit = 3e6 + 0.06 * 0.9e9  # in Pa; a limit in MPa, or the slope per GPa, misses by orders
    rate = -limit / 800.0 * np.log1p(-share)
    stress = bair_winer_shear_stress(800.0, rate * 2e-7, 2e-7, 0.9e9, 3e6, 0.06)
    assert stress == pytest.approx(share * limit, rel=1e-12)
    assert bair_winer_shear_stress(800.0, -rate * 2e-7, 2e-7, 0.9e9, 3e6, 0.06) == -stress


@pytest.mark.parametrize(("n", "a"), [(0.4, 2.0), (0.7, 1.3)])
def test_carreau_by_integrating_its_slope(n, a):
    """d ln(tau)/d ln(s) = 1 + (n - 1)(s/G)^a/(1 + (s/G)^a), integrated from Newton's oil on."""
    stress, logarithms = 4e6, np.linspace(np.log(1e-9), np.log(3e3), 200001)
    power = np.exp(a * logarithms)
    slope = 1.0 + (n - 1.0) * power / (1.0 + power)
    ratio = np.exp(logarithms[0] + np.trapezoid(slope, logarithms))
    newtonian = 3e3 * stress
    computed_stress = carreau_shear_stress(500.0, newtonian / 500.0 * 1e-6, 1e-6, stress, n, a)
    assert computed_stress == pytest.approx(ratio * stress, rel=1e-7)
    # far beyond: a straight line of slope n through the corner at G
    assert carreau_shear_stress(1.0, 1e16, 1.0, stress, n, a) == pytest.approx(
        stress * (1e16 / stress) ** n, rel=1e-6
    )


@pytest.mark.parametrize("name", list(SHEAR_MODELS))
def test_slow_shear_is_newtonian_and_the_slope_is_that_of_the_stress(name):
    model = SHEAR_MODELS[name]
    numbers = model.complete(5e6, {"limiting_stress_slope": 0.05})
    rate, limit = np.geomspace(1e-3, 1e12, 61), np.full(61, 4.2e7)
    stress, slope = model.stress(rate, limit, **numbers)
    assert stress[:20] == pytest.approx(rate[:20], rel=1e-3)
    up, down = (model.stress(rate * np.exp(e), limit, **numbers)[0] for e in (1e-5, -1e-5))
    assert slope == pytest.approx((up - down) / 2e-5, rel=1e-5, abs=1e-3)
    assert np.ravel(model.stress(np.zeros(1), limit[:1], **numbers)).tolist() == [0.0, 0.0]


def test_limits_of_the_parameters_give_the_limiting_models(solved):
    def sliding(name, **numbers):
        return film_traction(solved, 0.5, shear_model=name, **numbers).sliding

    limitless = {"limiting_stress": 1e16, "limiting_stress_slope": 0.0}
    eyring, newtonian = sliding("ree-eyring"), sliding("newtonian")
    assert sliding("ree-eyring", **limitless) == eyring
    assert sliding("bair-winer", **limitless) == pytest.approx(newtonian, rel=1e-4)
    assert sliding("carreau", carreau_exponent=1.0) == pytest.approx(newtonian, rel=1e-12)
    assert sliding("carreau-eyring", carreau_stress=1e16) == pytest.approx(eyring, rel=1e-9)
    assert sliding("carreau-eyring", eyring_stress=1e16) == pytest.approx(
        sliding("carreau"), rel=1e-6
    )
    # two ways to thin leave less than each
    combined = sliding("carreau-eyring")
    assert combined < 0.9 * min(eyring, sliding("carreau"))


@pytest.mark.parametrize("name", ["bair-winer", "ree-eyring", "newtonian", "carreau"])
def test_fast_sliding_of_a_limited_film_is_the_sum_of_its_limit(hertzian, name):
    traction = film_traction(
        hertzian, 1e9, shear_model=name, limiting_stress=2e6, limiting_stress_slope=0.06
    )
    expected = 2e6 * 2.0 * HALF_WIDTH + 0.06 * LOAD
    # of which the walls of the film, 1 nm thick, bear h/2 |dp/dx| for the pressure
    assert traction.sliding[0] == pytest.approx(expected - 1e-9 * PRESSURE, rel=1e-4)


def test_yield_begins_at_a_wall():
    """Stress tau_m + z p' stays below the limit everywhere; at it no more sliding raises it."""
    x = np.linspace(-1e-4, 1e-4, 11)
    film = FilmState(x, 5e8 + 4e12 * x, np.full(11, 1e-6), OIL, 2.2e11)
    fast = film_traction(film, 1e3, limiting_stress=5e6, limiting_stress_slope=0.04)
    wall = 0.5 * 1e-6 * 4e12
    assert fast.sliding[0] == pytest.approx((5e6 + 0.04 * 5e8 - wall) * 2e-4, rel=1e-12)


def newtonian_stress(name, stress, limit):
    """Viscosity times rate at a stress: the law read backwards."""
    size = np.abs(stress)
    if name == "bair-winer":
        return np.sign(stress) * -limit * np.log1p(-np.minimum(size / limit, 1.0 - 1e-15))
    rates = np.geomspace(1e-6, 1e16, 4401)
    stresses = carreau_shear_stress(1.0, rates, 1.0)
    rate = np.exp(np.interp(np.log(size + 1e-30), np.log(stresses), np.log(rates)))
    return np.sign(stress) * rate


@pytest.mark.parametrize(("name", "most"), [("carreau", 0.014), ("bair-winer", 0.007)])
def test_pressure_gradients_across_the_film_matter_little(solved, name, most):
    """The laws without a closed integral take the stress as even across the film."""
    speed, thickness = 0.01, solved.interval_film[0]
    wall = 0.5 * thickness * np.abs(solved.pressure_gradient[0])
    limit = 2e6 + 0.05 * solved.interval_pressure[0]
    low, high = np.zeros(wall.size), np.full(wall.size, 1e9)
    if name == "bair-winer":
        high = np.maximum(limit - wall, 0.0)
    for _ in range(50):
        middle = 0.5 * (low + high)
        across = newtonian_stress(name, middle[:, None] + wall[:, None] * GAUSS, limit[:, None])
        enough = 0.5 * thickness * (across @ WEIGHT) >= speed * np.exp(solved.log_viscosity[0])
        low, high = np.where(enough, low, middle), np.where(enough, middle, high)
    expected = low @ solved.interval_width[0]
    sliding_ = film_traction(solved, speed, shear_model=name).sliding[0]
    assert sliding_ == pytest.approx(expected, rel=most)
    assert sliding_ != pytest.approx(expected, rel=1e-4)  # it is no identity


@pytest.mark.parametrize(
    ("numbers", "message"),
    [
        ({"carreau_stress": 5e6}, 'does not belong to shear_model = "ree-eyring"'),
        ({"limit_stress": 5e6}, "limit_stress does not belong"),
        ({"limiting_stress": 0.0}, "limiting_stress"),
        ({"limiting_stress_slope": -0.1}, "limiting_stress_slope"),
        ({"limiting_stress": np.nan}, "limiting_stress"),
        ({"eyring_stress": -5e6}, "5 MPa is 5e6 Pa"),
    ],
)
def test_numbers_that_a_model_cannot_have(hertzian, numbers, message):
    with pytest.raises(InputError, match=message):
        film_traction(hertzian, 1.0, **numbers)
