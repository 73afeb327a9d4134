"""Flash temperature and film temperature: moving heat source, partition, balance of energy."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.special import k0e

from tribodyn.ehl import blok_flash_temperature
from tribodyn.ehl.traction.film_temperature import (
    FLASH_FACTORS,
    film_temperature_rise,
    film_thermal_resistance,
)
from tribodyn.errors import ComputationError, InputError

CONDUCTIVITY, CAPACITY = 46.0, 3.8e6  # steel: W/(m K), J/(m^3 K)
EFFUSIVITY = np.sqrt(CONDUCTIVITY * CAPACITY)
HALF_WIDTH, HEAT = 1.2e-4, 6000.0


def hertzian(x, width=HALF_WIDTH, heat=HEAT):
    """Heat per area that is spread like the Hertz pressure and amounts to ``heat`` per width."""
    return 2.0 * heat / (np.pi * width) * np.sqrt(np.maximum(0.0, 1.0 - (x / width) ** 2))


def moving_source(x, speed, count=4000):
    """Surface temperature of a half-space under a moving Hertzian source, all directions counted.

    Carslaw and Jaeger: ``1/(pi k) int q(s) exp(-w) K_0(|w|) ds`` with ``w = u (x - s)/(2 kappa)``
    where the surface moves towards positive x. The substitution s = x - r|r| removes the
    singularity.
    """
    rate = speed * CAPACITY / (2.0 * CONDUCTIVITY)
    total = 0.0
    for sign in (1.0, -1.0):
        reach = max(0.0, HALF_WIDTH + sign * x)  # towards s = -b for +, s = b for -
        edge = (np.arange(count) + 0.5) / count * np.sqrt(reach)
        s, ds = x - sign * edge**2, 2.0 * edge * np.sqrt(reach) / count
        w = rate * (x - s)
        total += np.sum(hertzian(s) * k0e(np.abs(w)) * np.exp(w - np.abs(w)) * ds)
    return total / (np.pi * CONDUCTIVITY)


def temperature_along(points, fast, heat=hertzian, count=4000):
    """Surface temperature under a fast source: heat flows straight into the depth."""
    rise = []
    for x in points:
        reach = np.sqrt(max(0.0, x + HALF_WIDTH))
        edge = (np.arange(count) + 0.5) / count * reach
        rise.append(2.0 * np.sum(heat(x - edge**2)) * reach / count)
    return np.array(rise) / np.sqrt(np.pi) / fast


def test_maximum_is_that_of_the_moving_source():
    speed = 20.0
    assert speed * HALF_WIDTH * CAPACITY / (2.0 * CONDUCTIVITY) > 50.0
    exact = max(moving_source(x, speed) for x in np.linspace(0.3, 0.9, 25) * HALF_WIDTH)
    closed = blok_flash_temperature(HEAT, HALF_WIDTH, speed, 0.0, EFFUSIVITY, EFFUSIVITY)
    assert closed == pytest.approx(exact, rel=0.01)


def test_slow_surfaces_are_cooler_than_by_the_formula():
    # the stated limit u b/(2 kappa) = 5: heat that flows along the surface is left out
    speed = 5.0 * 2.0 * CONDUCTIVITY / (CAPACITY * HALF_WIDTH)
    exact = max(moving_source(x, speed) for x in np.linspace(0.2, 0.9, 29) * HALF_WIDTH)
    closed = blok_flash_temperature(HEAT, HALF_WIDTH, speed, 0.0, EFFUSIVITY, EFFUSIVITY)
    assert exact < closed < 1.1 * exact


def test_factors_of_the_hertzian_source():
    x = np.linspace(-1.0, 1.0, 2001) * HALF_WIDTH
    rise = temperature_along(x, 1.0) * np.sqrt(2.0 * HALF_WIDTH) / HEAT
    assert rise.max() == pytest.approx(FLASH_FACTORS["maximum"], rel=2e-4)
    assert np.trapezoid(rise, x) / (2.0 * HALF_WIDTH) == pytest.approx(
        FLASH_FACTORS["mean"], rel=2e-4
    )
    assert FLASH_FACTORS["maximum"] == pytest.approx(1.11, abs=0.005)  # as Blok prints it
    assert x[np.argmax(rise)] == pytest.approx(0.652 * HALF_WIDTH, abs=2e-3 * HALF_WIDTH)


def test_even_heat_has_its_own_factors():
    # 2/sqrt(pi) = 1.128 at the end, 2/3 of it in the mean: near those of the Hertzian source
    even = temperature_along(
        np.array([HALF_WIDTH]), 1.0, lambda x: np.full(x.shape, HEAT / (2.0 * HALF_WIDTH))
    )
    factor = even[0] * np.sqrt(2.0 * HALF_WIDTH) / HEAT
    assert factor == pytest.approx(2.0 / np.sqrt(np.pi), rel=1e-3)
    assert FLASH_FACTORS["maximum"] == pytest.approx(factor, rel=0.02)


def two_bodies(speeds, effusivities, steps=600, layers=160):
    """March both bodies through the contact: conduction into the depth, one temperature between.

    Returns the surface temperature along the contact, the heat that entered each body and the heat
    that is in it at the end, all per width.
    """
    dx = 2.0 * HALF_WIDTH / steps
    x = -HALF_WIDTH + (np.arange(steps) + 0.5) * dx
    # depth in units in which conductivity is B sqrt(u) and capacity over dx is B sqrt(u) too
    depth = np.sinh(np.linspace(0.0, 5.0, layers)) / np.sinh(5.0) * 8.0 * np.sqrt(2.0 * HALF_WIDTH)
    cell = np.gradient(depth)
    cell[[0, -1]] = 0.5 * np.diff(depth)[[0, -1]]
    link = 1.0 / np.diff(depth)
    carry = [b * np.sqrt(u) for b, u in zip(effusivities, speeds, strict=True)]
    size = 2 * layers - 1  # the surface node is common
    matrix = np.zeros((size, size))
    for body, factor in enumerate(carry):
        nodes = np.r_[0, 1 + body * (layers - 1) + np.arange(layers - 1)]
        for i, node in enumerate(nodes):
            matrix[node, node] += factor * cell[i] / dx
        for i, strength in enumerate(link):
            a, b = nodes[i], nodes[i + 1]
            matrix[np.ix_([a, b], [a, b])] += factor * strength * np.array([[1, -1], [-1, 1]])
    inverse = np.linalg.inv(matrix)
    heat_capacity = np.zeros(size)
    entered, surface, state = np.zeros(2), [], np.zeros(size)
    for body, factor in enumerate(carry):
        nodes = np.r_[0, 1 + body * (layers - 1) + np.arange(layers - 1)]
        heat_capacity[nodes] += factor * cell
    for place in x:
        source = heat_capacity * state / dx
        source[0] += hertzian(place)
        before, state = state, inverse @ source
        for body, factor in enumerate(carry):
            first = 1 + body * (layers - 1)
            heat_into_body = factor * cell[0] * (state[0] - before[0]) / dx
            entered[body] += dx * (heat_into_body + factor * link[0] * (state[0] - state[first]))
        surface.append(state[0])
    stored = float(heat_capacity @ state)
    return np.array(surface), entered, stored


def test_heat_parts_so_that_both_surfaces_are_equally_hot():
    speeds, effusivities = (6.0, 1.5), (13.6e3, 9.0e3)
    surface, entered, stored = two_bodies(speeds, effusivities)
    closed = blok_flash_temperature(HEAT, HALF_WIDTH, *speeds, *effusivities)
    mean = blok_flash_temperature(HEAT, HALF_WIDTH, *speeds, *effusivities, kind="mean")
    assert surface.max() == pytest.approx(closed, rel=0.01)
    assert surface.mean() == pytest.approx(mean, rel=0.01)
    # energy: what the friction makes is in the bodies, parted as B sqrt(u)
    assert entered.sum() == pytest.approx(HEAT, rel=1e-3)
    assert stored == pytest.approx(HEAT, rel=1e-3)
    carried = np.array(effusivities) * np.sqrt(speeds)
    assert entered / HEAT == pytest.approx(carried / carried.sum(), rel=1e-4)


def test_like_bodies_by_the_form_with_the_difference_of_the_roots():
    # 1.11 mu w |sqrt(u_1) - sqrt(u_2)| / (B sqrt(2b)), as gear books print it
    coefficient, load, speeds = 0.05, 150e3, (4.0, 2.5)
    heat = coefficient * load * (speeds[0] - speeds[1])
    by_hand = 1.11 * coefficient * load * (2.0 - np.sqrt(2.5)) / (13.6e3 * np.sqrt(2.4e-4))
    assert blok_flash_temperature(heat, HALF_WIDTH, *speeds) == pytest.approx(by_hand, rel=2e-3)


def test_rise_scales_with_heat_speed_and_width():
    base = blok_flash_temperature(HEAT, HALF_WIDTH, 3.0, 2.0)
    assert blok_flash_temperature(3.0 * HEAT, HALF_WIDTH, 3.0, 2.0) == pytest.approx(3.0 * base)
    assert blok_flash_temperature(HEAT, HALF_WIDTH, 12.0, 8.0) == pytest.approx(0.5 * base)
    assert blok_flash_temperature(HEAT, 4.0 * HALF_WIDTH, 3.0, 2.0) == pytest.approx(0.5 * base)
    assert blok_flash_temperature(HEAT, HALF_WIDTH, -3.0, 2.0) == base
    assert blok_flash_temperature([0.0, HEAT], HALF_WIDTH, 3.0, 2.0).tolist() == [0.0, base]


@pytest.mark.parametrize(
    ("arguments", "named"),
    [
        ((-1.0, 1e-4, 1.0, 1.0), "heat_per_width"),
        ((1.0, 0.0, 1.0, 1.0), "half_width"),
        ((1.0, 1e-4, np.nan, 1.0), "surface_speed_1"),
        ((1.0, 1e-4, 0.0, 0.0), "surface_speed"),
        ((1.0, 1e-4, 1.0, 1.0, 0.0), "thermal_contact_coefficient_1"),
    ],
)
def test_bad_values_are_refused(arguments, named):
    with pytest.raises(InputError, match=named):
        blok_flash_temperature(*arguments)


def test_oil_is_warmer_than_its_surfaces_by_the_mean_of_a_parabola():
    ones = np.ones(1)
    thin, thick = (
        film_thermal_resistance(HALF_WIDTH * ones, h * ones, 3.0 * ones, 2.0 * ones, 0.13)
        for h in (1e-12, 1e-6)
    )
    z = (np.arange(20000) + 0.5) / 20000 * 1e-6
    per_area = 1.0 / (2.0 * HALF_WIDTH)
    parabola = per_area / (2.0 * 0.13 * 1e-6) * z * (1e-6 - z)  # k T'' = -q/h, cold walls
    assert thick - thin == pytest.approx(parabola.mean(), rel=1e-5)
    assert thin == pytest.approx(
        blok_flash_temperature(1.0, HALF_WIDTH, 3.0, 2.0, kind="mean"), rel=1e-4
    )


def test_heat_made_is_heat_led_away():
    resistance = np.geomspace(1e-6, 1e3, 10)

    def heat(rise):
        heat_rate = 2e4 * np.exp(-0.08 * rise) + 100.0 / (1.0 + rise)
        slope = -0.08 * 2e4 * np.exp(-0.08 * rise) - 100.0 / (1.0 + rise) ** 2
        return heat_rate, slope

    rise = film_temperature_rise(heat, resistance)
    assert rise == pytest.approx(resistance * heat(rise)[0], rel=1e-7)
    assert np.all(np.diff(rise) > 0.0)


def test_no_heat_no_rise():
    rise = film_temperature_rise(lambda t: (0.0 * t, 0.0 * t), np.array([1.0, 2.0]))
    assert rise.tolist() == [0.0, 0.0]


def test_a_balance_is_found_even_with_a_wrong_slope():
    # the bracket catches steps that overshoot
    rise = film_temperature_rise(
        lambda t: (100.0 / (1.0 + np.exp(2.0 * (t - 20.0))), np.zeros(t.shape)), np.ones(1)
    )
    assert rise == pytest.approx(100.0 / (1.0 + np.exp(2.0 * (rise - 20.0))), rel=1e-4)


def test_heat_that_is_not_a_number_is_an_error():
    with pytest.raises(ComputationError, match="film temperature did not settle"):
        film_temperature_rise(lambda t: (t + np.nan, t), np.ones(1))
