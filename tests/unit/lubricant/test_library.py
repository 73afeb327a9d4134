"""The library of oils: every number has a unit and a source, and agrees with its standard."""

from __future__ import annotations

import math
import tomllib
from importlib.resources import files

import numpy as np
import pytest

from tribodyn.errors import InputError
from tribodyn.lubricant import (
    agma_925_coefficient,
    from_library,
    library,
    walther_slope,
    walther_viscosity,
)

GRADES = (32, 46, 68, 100, 150, 220, 320, 460)
UNITS = {
    "temperature": "K",
    "dynamic_viscosity": "Pa*s",
    "kinematic_viscosity": "m^2/s",
    "density": "kg/m^3",
    "pressure_viscosity_coefficient": "1/Pa",
    "temperature_viscosity_coefficient": "1/K",
    "thermal_conductivity": "W/m/K",
    "viscosity_index": "1",
    "density_fall": "kg/m^3/K",
}


@pytest.fixture(scope="module")
def records():
    text = files("tribodyn.lubricant").joinpath("library.toml").read_text(encoding="utf-8")
    return tomllib.loads(text)


def test_names():
    assert library() == ["80W", "75W90-A", *(f"ISO VG {grade}" for grade in GRADES)]


def test_every_value_has_its_unit_and_a_source(records):
    for record in records.values():
        for key, value in record.items():
            if key == "assumptions":
                assert all(":" in reason or ";" in reason for reason in value)
                continue
            for entry in value if isinstance(value, list) else [value]:
                assert entry["source"]
                assert key == "base_oil" or entry["unit"] == UNITS[key]


def test_80w_is_as_printed():
    oil = from_library("80W")
    assert (oil.dynamic_viscosity, oil.density) == (0.082, 880.0)
    assert oil.pressure_viscosity_coefficient == 2.19e-8
    assert oil.temperature == pytest.approx(40 + 273.15)
    assert "table 1" in oil.source
    assert len(oil.assumptions) == 1
    assert "temperature-viscosity coefficient" in oil.assumptions[0]


def test_75w90_states_the_scatter_of_its_two_viscosities():
    oil = from_library("75W90-A", 70 + 273.15)
    assert oil.dynamic_viscosity == 0.0298
    assert oil.density == pytest.approx(870.0 * (1 - 5.8e-4 * 55), abs=0.1)
    from_kinematic = 36.7e-6 * oil.density
    assert from_kinematic / oil.dynamic_viscosity - 1 == pytest.approx(0.037, abs=0.001)
    assert 1 - oil.dynamic_viscosity / from_kinematic == pytest.approx(0.036, abs=0.001)
    assert any("3.6 %" in assumption for assumption in oil.assumptions)
    estimate = agma_925_coefficient(0.0298, "polyalphaolefin")
    assert oil.pressure_viscosity_coefficient == pytest.approx(estimate, rel=1e-3)


def line_through_index(index, expected):
    """Viscosity at 40 and 100 degC of a line of this viscosity index through one known point."""
    temperature, viscosity = expected

    def ends(at_100):
        rows = np.array([INDEX_TABLE[grade][0] for grade in GRADES])
        low, high = (np.interp(at_100, rows[:, 0], rows[:, column]) for column in (1, 2))
        at_40 = low - index / 100.0 * (low - high)
        if index > 100:
            at_40 = high * (1.0 + 0.00715 * (index - 100.0)) ** (-math.log10(at_100))
        return (313.15, at_40 * 1e-6), (373.15, at_100 * 1e-6)

    low, high = 9.0, 18.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        above = walther_viscosity(temperature, ends(middle)) > viscosity
        low, high = (low, middle) if above else (middle, high)
    return ends(low)


@pytest.mark.parametrize(
    ("name", "index", "kinematic", "expansion"),
    [("80W", 95.0, 82e-3 / 880.0, 7.7e-4), ("75W90-A", 147.0, 36.7e-6, 5.8e-4)],
)
def test_fall_of_viscosity_over_temperature_follows_from_the_index(
    name, index, kinematic, expansion
):
    oil = from_library(name)
    points = line_through_index(index, (oil.temperature, kinematic))
    slope = walther_slope(oil.temperature, points) + expansion
    assert oil.temperature_viscosity_coefficient == pytest.approx(slope, rel=0.02)


@pytest.mark.parametrize("temperature", [313.15, 353.15])
def test_iso_grade_knows_its_slope_over_temperature(temperature):
    oil = from_library("ISO VG 100", temperature)
    logarithms = [
        math.log(from_library("ISO VG 100", temperature + step).dynamic_viscosity)
        for step in (-0.01, 0.01)
    ]
    slope = (logarithms[0] - logarithms[1]) / 0.02
    assert oil.temperature_viscosity_coefficient == pytest.approx(slope, rel=1e-6)


@pytest.mark.parametrize("name", library())
def test_every_oil_knows_what_a_heated_film_needs(name):
    oil = from_library(name)
    assert 0.02 < oil.temperature_viscosity_coefficient < 0.08
    assert 0.1 < oil.thermal_conductivity < 0.2


@pytest.mark.parametrize("grade", GRADES)
def test_iso_grade_has_its_number_at_40_degc(grade):
    oil = from_library(f"ISO VG {grade}")
    assert oil.temperature == pytest.approx(313.15)
    assert oil.kinematic_viscosity == pytest.approx(grade * 1e-6, rel=1e-12)
    assert oil.density == pytest.approx(43.37 * math.log10(grade) + 805.5 - 0.7 * 25, abs=0.06)
    assert any("index 95" in assumption for assumption in oil.assumptions)
    assert any("base oil" in assumption for assumption in oil.assumptions)


#: Rows of the table of ISO 2909 (ASTM D2270) around each grade: viscosity at 100 degC, L, H.
INDEX_TABLE = {
    32: ((5.2, 43.76, 30.43), (5.3, 45.53, 31.4)),
    46: ((6.6, 69.16, 44.24), (6.7, 71.29, 45.33)),
    68: ((8.5, 111.5, 65.32), (8.6, 113.9, 66.48)),
    100: ((11.0, 173.9, 95.19), (11.1, 176.6, 96.45)),
    150: ((14.5, 279.6, 142.4), (14.6, 283.0, 143.9)),
    220: ((18.7, 437.3, 207.6), (18.8, 441.5, 209.3)),
    320: ((23.8, 673.7, 297.9), (24.0, 683.9, 301.8)),
    460: ((30.0, 1023.0, 421.7), (30.5, 1055.0, 432.4)),
}


@pytest.mark.parametrize("grade", GRADES)
def test_iso_grade_has_viscosity_index_95(grade):
    at_100 = from_library(f"ISO VG {grade}", 373.15).kinematic_viscosity * 1e6
    rows = np.array(INDEX_TABLE[grade])
    low, high = (np.interp(at_100, rows[:, 0], rows[:, column]) for column in (1, 2))
    assert rows[0, 0] < at_100 < rows[1, 0]
    assert 100 * (low - grade) / (low - high) == pytest.approx(95.0, abs=0.1)


@pytest.mark.parametrize("celsius", [9.0, 131.0])
def test_oil_of_one_viscosity_refuses_a_temperature_far_outside(celsius):
    with pytest.raises(InputError, match=rf'"80W" at {celsius:g} degC.*from 10 to 130 degC'):
        from_library("80W", celsius + 273.15)


def test_oil_of_one_viscosity_accepts_its_own_temperature():
    assert from_library("80W", 40 + 273.15) == from_library("80W")


def test_oil_of_two_viscosities_refuses_a_temperature_far_outside():
    with pytest.raises(InputError, match="between 10 and 130 degC"):
        from_library("ISO VG 100", 273.15)


@pytest.mark.parametrize("name", ["80W", "ISO VG 100"])
def test_not_a_number_is_no_temperature(name):
    with pytest.raises(InputError, match="temperature"):
        from_library(name, math.nan)


def test_misspelt_oil_names_the_nearest():
    with pytest.raises(InputError, match='Did you mean "ISO VG 100"'):
        from_library("ISO VG100")


def test_warm_oil_is_thinner_lighter_and_thickens_less_under_pressure():
    cold, warm = from_library("ISO VG 220", 313.15), from_library("ISO VG 220", 363.15)
    assert warm.dynamic_viscosity < cold.dynamic_viscosity / 5
    assert warm.density < cold.density
    assert warm.pressure_viscosity_coefficient < cold.pressure_viscosity_coefficient
