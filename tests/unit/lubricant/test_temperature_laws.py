"""Viscosity, density and pressure-viscosity coefficient over temperature."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tribodyn.errors import InputError
from tribodyn.lubricant import agma_925_coefficient, density_at_temperature, walther_viscosity

POINTS = ((313.15, 100e-6), (373.15, 11.066e-6))


@pytest.mark.parametrize("point", POINTS)
def test_walther_passes_through_its_points(point):
    temperature, viscosity = point
    assert walther_viscosity(temperature, POINTS) == pytest.approx(viscosity, rel=1e-12)


def test_walther_is_a_straight_line_in_its_coordinates():
    temperatures = np.geomspace(300.0, 400.0, 5)
    ordinates = [
        math.log10(math.log10(walther_viscosity(float(t), POINTS) * 1e6 + 0.7))
        for t in temperatures
    ]
    assert np.diff(ordinates, 2) == pytest.approx([0.0] * 3, abs=1e-12)


def test_walther_does_not_depend_on_the_points_of_its_line():
    others = tuple((t, walther_viscosity(t, POINTS)) for t in (330.0, 350.0))
    assert walther_viscosity(370.0, others) == pytest.approx(
        walther_viscosity(370.0, POINTS), rel=1e-12
    )


@pytest.mark.parametrize("celsius", [9.9, 130.1, -273.0])
def test_walther_refuses_to_go_far_beyond_its_data(celsius):
    with pytest.raises(InputError, match=r"known at 40 and 100 degC.*30 K.*between 10 and 130"):
        walther_viscosity(celsius + 273.15, POINTS)


@pytest.mark.parametrize("celsius", [10.0, 130.0])
def test_walther_accepts_thirty_kelvin_beyond(celsius):
    viscosity = walther_viscosity(celsius + 273.15, POINTS)
    assert (viscosity > 100e-6) == (celsius < 40.0)


@pytest.mark.parametrize(
    "points",
    [
        (POINTS[1], POINTS[0]),
        (POINTS[0], POINTS[0]),
        ((313.15, 10e-6), (373.15, 100e-6)),
    ],
)
def test_walther_needs_a_falling_line(points):
    with pytest.raises(InputError, match="colder point first"):
        walther_viscosity(320.0, points)


def test_walther_points_a_slip_in_the_unit_out():
    with pytest.raises(InputError, match=r"1 mm\^2/s is 1e-6 m\^2/s"):
        walther_viscosity(320.0, ((313.15, 100.0), (373.15, 11.066)))


def test_density_falls_by_seven_tenths_per_kelvin():
    assert density_at_temperature(288.15, 880.0) == 880.0
    assert density_at_temperature(298.15, 880.0) == pytest.approx(873.0)


def test_density_points_celsius_out():
    with pytest.raises(InputError, match=r"0 degC is 273\.15 K"):
        density_at_temperature(40.0, 880.0)


@pytest.mark.parametrize(
    ("base_oil", "factor", "exponent"),
    [
        ("mineral", 2.657e-8, 0.1348),
        ("polyalphaolefin", 1.466e-8, 0.0507),
        ("polyalkylene glycol", 1.392e-8, 0.1572),
    ],
)
def test_coefficient_equals_the_form_of_iso_15144_in_pascal_seconds(base_oil, factor, exponent):
    for viscosity in (0.01, 0.1, 0.4):
        expected = factor * viscosity**exponent
        assert agma_925_coefficient(viscosity, base_oil) == pytest.approx(expected, rel=4e-4)


def test_coefficient_is_13_percent_below_the_one_printed_for_80w():
    assert agma_925_coefficient(0.082) / 2.19e-8 == pytest.approx(0.87, abs=0.005)


def test_unknown_base_oil_names_the_nearest():
    with pytest.raises(InputError, match='Did you mean "mineral"'):
        agma_925_coefficient(0.082, "minerl")
