"""Inlet shear heating: against a thermal inlet solved here, against printed factors, limits."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from tribodyn.ehl import inlet_heating_factor
from tribodyn.errors import InputError, ModelWarning

OIL = {
    "dynamic_viscosity": 0.08,
    "temperature_viscosity_coefficient": 0.05,
    "thermal_conductivity": 0.13,
    "effective_modulus": 2.3e11,
}
LIGHT = 1e5  # Hertz pressure [Pa] at which the load plays no part
_ENOUGH = 1.0 - np.exp(-16.0)  # reduced pressure at the edge of the contact


def factor(loading, ratio=0.0, pressure=LIGHT, **changes):
    """Factor at a thermal loading ``L = eta_0 beta u_e^2/k``."""
    oil = {**OIL, **changes}
    per_square = oil["dynamic_viscosity"] * oil["temperature_viscosity_coefficient"]
    speed = np.sqrt(np.asarray(loading) * oil["thermal_conductivity"] / per_square)
    return inlet_heating_factor(speed, ratio, pressure, **oil)


def _pressure_is_reached(strength, loading, slide=0.0, steps=300):
    """March a Grubin inlet ``h = h_0 (1 + s^1.5)`` from far out to the edge of the contact.

    The reduced pressure rises as ``K s^1.5/(1 + s^1.5)^3 R``, where R is the fall of the pressure
    gradient by the heat conducted out of the film (Aggarwal and Wilson 1980).
    """

    def slope(u, reduced):
        s = u / (1.0 - u)
        over = s**1.5
        local = loading / (1.0 - reduced)
        backflow = local * (over / (1.0 + over)) ** 2
        heated = 1.0 + 0.5 * backflow**0.85 + 0.2 * (local * slide**2) ** 0.9
        return strength * over / (1.0 + over) ** 3 / heated / (1.0 - u) ** 2

    places = np.linspace(0.999, 0.0, steps + 1)
    reduced = 0.5 * strength * ((1.0 - places[0]) / places[0]) ** 2
    for position, next_position in pairwise(places):
        middle = reduced + 0.5 * (position - next_position) * slope(position, reduced)
        if middle >= _ENOUGH:
            return True
        reduced += (position - next_position) * slope(0.5 * (position + next_position), middle)
        if reduced >= _ENOUGH:
            return True
    return False


def solved_inlet(loading, slide=0.0):
    """Film of the heated inlet over that of the cold one; ``slide`` = (u_1 - u_2)/u_e."""
    strengths = []
    for value in (0.0, loading):
        low, high = 0.1, 1e3
        for _ in range(25):
            middle = np.sqrt(low * high)
            is_reached = _pressure_is_reached(middle, value, slide if value else 0.0)
            low, high = (low, middle) if is_reached else (middle, high)
        strengths.append(high)
    return (strengths[0] / strengths[1]) ** 0.75


@pytest.mark.parametrize("loading", [0.3, 1.0, 3.0])
def test_pure_rolling_agrees_with_a_solved_inlet(loading):
    assert factor(loading) == pytest.approx(solved_inlet(loading), abs=0.05)


def test_the_solved_inlet_would_show_the_sum_of_the_speeds():
    # the sum of the speeds in the place of the mean makes the loading four times as great
    assert abs(factor(4.0) - solved_inlet(1.0)) > 0.1


@pytest.mark.parametrize("loading", [0.1, 0.3, 1.0, 3.0, 10.0])
def test_pure_rolling_agrees_with_printed_factors(loading):
    wilson_sheu = 1.0 / (1.0 + 0.241 * loading**0.64)
    murch_wilson = 1.0 / (1.0 + 0.254 * loading**0.62)
    assert factor(loading) == pytest.approx(wilson_sheu, rel=0.07)
    assert factor(loading) == pytest.approx(murch_wilson, rel=0.07)


@pytest.mark.parametrize("ratio", [0.3, 1.0])
def test_sliding_lies_between_pure_rolling_and_the_inlet_of_unlimited_pressure(ratio):
    loading = np.array([0.1, 1.0, 10.0])
    unlimited = 1.0 / (1.0 + 0.241 * (1.0 + 14.8 * (0.5 * ratio) ** 0.83) * loading**0.64)
    assert np.all(factor(loading, ratio) > unlimited)
    assert np.all(factor(loading, ratio) < factor(loading))


def test_moderate_sliding_is_near_a_solved_inlet():
    assert factor(0.3, 0.5) == pytest.approx(solved_inlet(0.3, 0.5), abs=0.05)


def test_worked_by_hand():
    # L = 0.08 * 0.05 * 9/0.13 = 0.27692
    loading = 0.08 * 0.05 * 9.0 / 0.13
    above = 1.0 - 13.2 * 1e9 / 2.3e11 * loading**0.42
    below = 1.0 + 0.213 * (1.0 + 2.23 * 0.4**0.83) * loading**0.64
    factor_ = inlet_heating_factor(3.0, -0.4, 1e9, **OIL)
    assert factor_ == pytest.approx(above / below, rel=1e-14)


def test_slow_contacts_keep_their_film():
    slow = inlet_heating_factor(np.array([1e-1, 1e-3, 1e-6]), 1.0, 1e9, **OIL)
    assert np.all(np.diff(slow) > 0.0)
    assert slow[-1] == pytest.approx(1.0, abs=1e-4)
    assert slow[-1] < 1.0


@pytest.mark.parametrize("name", ["loading", "ratio", "pressure"])
def test_factor_falls_with_everything_that_heats(name):
    values = {"loading": 1.0, "ratio": 0.3, "pressure": 1e9}
    factors = [factor(**{**values, name: values[name] * step}) for step in (1.0, 1.5, 2.0)]
    assert np.all(np.diff(factors) < 0.0)
    assert 0.0 < factors[-1] < factors[0] < 1.0


def test_units_do_not_matter():
    # lengths in mm, forces in N: Pa -> 1e-6, Pa*s -> 1e-6, m/s -> 1e3, W/(m K) -> N/(s K)
    scaled = inlet_heating_factor(3.0e3, 0.4, 1e9 * 1e-6, 0.08 * 1e-6, 0.05, 0.13, 2.3e11 * 1e-6)
    assert scaled == pytest.approx(inlet_heating_factor(3.0, 0.4, 1e9, **OIL), rel=1e-12)


def test_greater_loadings_than_fitted_are_warned_of():
    with pytest.warns(ModelWarning, match=r"thermal loading .* up to 60") as caught:
        factor(60.0, pressure=0.5e9)
    assert caught[0].message.code == "film-range"
    assert len(caught) == 1


def test_no_film_is_an_error():
    with pytest.raises(InputError, match=r"gives no film.*leave out inlet_heating"):
        factor(1000.0, pressure=2e9)


@pytest.mark.parametrize("name", list(OIL))
@pytest.mark.parametrize("value", [0.0, -1.0, np.nan])
def test_oil_must_be_one(name, value):
    with pytest.raises(InputError, match=name):
        inlet_heating_factor(1.0, 0.1, 1e9, **{**OIL, name: value})
