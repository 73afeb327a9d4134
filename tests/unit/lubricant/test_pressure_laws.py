"""Viscosity and density under pressure: limits, slopes and refusals."""

from __future__ import annotations

import numpy as np
import pytest

from tribodyn.errors import InputError
from tribodyn.lubricant import (
    ROELANDS_PRESSURE,
    VISCOSITY_LAWS,
    barus_viscosity,
    dowson_higginson_density,
    roelands_index,
    roelands_viscosity,
)

ETA, ALPHA = 0.082, 2.19e-8


def test_roelands_index_of_80w():
    assert roelands_index(ETA, ALPHA) == pytest.approx(0.599, abs=5e-4)


@pytest.mark.parametrize("law", VISCOSITY_LAWS.names())
def test_every_law_starts_at_ambient_viscosity_with_the_given_slope(law):
    step = 1e3
    start = VISCOSITY_LAWS[law](0.0, ETA, ALPHA)
    slope = np.log(VISCOSITY_LAWS[law](step, ETA, ALPHA) / start) / step
    assert start == ETA
    assert slope == pytest.approx(ALPHA, rel=1e-5)


@pytest.mark.parametrize("law", VISCOSITY_LAWS.names())
def test_zero_coefficient_is_isoviscous(law):
    pressure = np.array([0.0, 1e8, 2e9])
    assert np.array_equal(VISCOSITY_LAWS[law](pressure, ETA, 0.0), [ETA] * 3)


def test_roelands_with_index_one_is_barus():
    # z = 1 makes the exponent linear in p: (ln eta0 + 9.67) p/p0 = alpha p
    alpha = (np.log(ETA) + 9.67) / ROELANDS_PRESSURE
    pressure = np.linspace(0.0, 1e9, 7)
    expected = barus_viscosity(pressure, ETA, alpha)
    assert roelands_viscosity(pressure, ETA, alpha) == pytest.approx(expected, rel=1e-12)


def test_roelands_at_its_reference_pressure():
    index = roelands_index(ETA, ALPHA)
    pole = np.exp(-9.67)
    expected = pole * (ETA / pole) ** (2.0**index)
    assert roelands_viscosity(ROELANDS_PRESSURE, ETA, ALPHA) == pytest.approx(expected, rel=1e-12)


def test_roelands_stays_below_barus():
    pressure = np.linspace(1e7, 2e9, 20)
    assert np.all(roelands_viscosity(pressure, ETA, ALPHA) < barus_viscosity(pressure, ETA, ALPHA))


def test_density_limits():
    assert dowson_higginson_density(0.0, 880.0) == 880.0
    assert dowson_higginson_density(1e14, 880.0) == pytest.approx(880.0 * (1 + 0.6 / 1.7), rel=1e-5)
    slope = (dowson_higginson_density(1e3, 1.0) - 1.0) / 1e3
    assert slope == pytest.approx(0.6e-9, rel=1e-5)


def test_density_doubles_its_rise_at_half_of_the_limit():
    pressure = 1.0 / 1.7e-9  # there p/(1 + 1.7e-9 p) is half of its limit
    assert dowson_higginson_density(pressure, 1.0) == pytest.approx(1.0 + 0.3 / 1.7, rel=1e-12)


@pytest.mark.parametrize("law", VISCOSITY_LAWS.names())
@pytest.mark.parametrize("pressure", [-1.0, np.nan, np.inf])
def test_pressure_must_be_finite_and_not_negative(law, pressure):
    with pytest.raises(InputError, match="pressure"):
        VISCOSITY_LAWS[law](pressure, ETA, ALPHA)


def test_overflow_is_an_error_and_not_infinity():
    with pytest.raises(InputError, match=r"Barus.*Roelands law"):
        barus_viscosity(1e11, ETA, ALPHA)


def test_viscosity_below_the_pole_is_refused():
    with pytest.raises(InputError, match=r"6\.32e-5 Pa\*s"):
        roelands_viscosity(1e8, 5e-5, ALPHA)


def test_arrays_keep_their_shape():
    pressure = np.full((2, 3), 1e8)
    assert roelands_viscosity(pressure, ETA, ALPHA).shape == (2, 3)
    assert dowson_higginson_density(pressure, 880.0).shape == (2, 3)
