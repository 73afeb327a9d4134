"""Viscosity index and oils of data sheets: printed examples and tables, inverses, assumptions."""

from __future__ import annotations

import math

import pytest

from tribodyn.errors import InputError
from tribodyn.lubricant import (
    Lubricant,
    agma_925_coefficient,
    from_data_sheet,
    from_library,
    viscosity_at_40_degc,
    viscosity_at_100_degc,
    viscosity_index,
    walther_viscosity,
)
from tribodyn.lubricant.data_sheet import points_through, sheet_points

#: Rows of table 1 of ASTM D2270: viscosity at 100 degC, and L of it [mm^2/s].
PRINTED_L = (
    (2.0, 7.994), (3.0, 15.49), (4.0, 25.32), (4.6, 33.52), (5.5, 49.09), (6.5, 67.12),
    (7.3, 84.53), (8.0, 100.0), (10.0, 147.7), (12.0, 201.9), (14.4, 276.3),
)  # fmt: skip
#: The same, with H.
PRINTED_H = (
    (5.2, 30.43), (6.6, 44.24), (8.5, 65.32), (11.0, 95.19), (14.5, 142.4), (18.7, 207.6),
    (23.8, 297.9), (30.0, 421.7),
)  # fmt: skip


@pytest.mark.parametrize(
    ("at_40", "at_100", "index"), [(73.30, 8.86, 92), (22.83, 5.05, 156), (53.47, 7.80, 111)]
)
def test_examples_of_astm_d2270(at_40: float, at_100: float, index: int) -> None:
    """Sections 5.1.4 and 6.1.4: one of procedure A, two of procedure B."""
    assert round(viscosity_index(at_40 * 1e-6, at_100 * 1e-6)) == index


@pytest.mark.parametrize(("index", "rows"), [(0.0, PRINTED_L), (100.0, PRINTED_H)])
def test_oils_of_index_0_and_100_are_those_of_the_table(
    index: float, rows: tuple[tuple[float, float], ...]
) -> None:
    for at_100, at_40 in rows:
        assert viscosity_at_40_degc(at_100 * 1e-6, index) * 1e6 == pytest.approx(at_40, rel=1e-3)


def test_above_70_the_equations_of_the_text_hold() -> None:
    """L = 0.8353 Y^2 + 14.67 Y - 216 and H = 0.1684 Y^2 + 11.85 Y - 97."""
    for y in (71.0, 100.0, 300.0):
        low, high = (viscosity_at_40_degc(y * 1e-6, index) * 1e6 for index in (0.0, 100.0))
        assert low == pytest.approx(0.8353 * y**2 + 14.67 * y - 216.0, rel=2e-4)
        assert high == pytest.approx(0.1684 * y**2 + 11.85 * y - 97.0, rel=2e-4)


@pytest.mark.parametrize("index", [-50.0, 0.0, 62.5, 95.0, 99.999, 100.0, 100.001, 147.0, 250.0])
@pytest.mark.parametrize("at_40", [22.0, 46.0, 220.0, 1000.0])
def test_the_index_and_both_viscosities_give_each_other(index: float, at_40: float) -> None:
    at_100 = viscosity_at_100_degc(at_40 * 1e-6, index)
    assert viscosity_at_40_degc(at_100, index) == pytest.approx(at_40 * 1e-6, rel=2e-3)
    assert viscosity_index(at_40 * 1e-6, at_100) == pytest.approx(index, abs=0.5)


def test_both_procedures_meet_at_an_index_of_100() -> None:
    high = viscosity_at_40_degc(10e-6, 100.0)
    below, above = (viscosity_index(high * factor, 10e-6) for factor in (1.0 + 1e-9, 1.0 - 1e-9))
    assert below == pytest.approx(above, abs=1e-5)
    assert below < 100.0 < above


@pytest.mark.parametrize(
    ("at_40", "at_100", "message"),
    [
        (10e-6, 20e-6, "thinner when it is warmer"),
        (10e-6, 1.9e-6, "viscosity_at_100"),
        (math.nan, 10e-6, "viscosity_at_40"),
        (220.0, 18.7e-6, "1 mm.2/s is 1e-6"),
    ],
)
def test_viscosities_without_index_are_refused(at_40: float, at_100: float, message: str) -> None:
    with pytest.raises(InputError, match=message):
        viscosity_index(at_40, at_100)


def test_a_viscosity_out_of_the_reach_of_an_index_is_refused() -> None:
    with pytest.raises(InputError, match=r"3 mm\^2/s at 40 degC.*7.993 to .* mm\^2/s"):
        viscosity_at_100_degc(3e-6, 0.0)
    with pytest.raises(InputError, match="index"):
        viscosity_at_100_degc(220e-6, 900.0)


@pytest.mark.parametrize("grade", [32, 68, 220, 460])
@pytest.mark.parametrize("celsius", [15.0, 40.0, 60.0, 100.0, 125.0])
def test_a_sheet_of_index_95_is_the_oil_of_the_library(grade: int, celsius: float) -> None:
    library_oil = from_library(f"ISO VG {grade}", celsius + 273.15)
    density = from_library(f"ISO VG {grade}", 313.15).density + 0.7 * 25.0
    oil = from_data_sheet(celsius + 273.15, density, viscosity_at_40=grade * 1e-6, index=95)
    for name in (
        "dynamic_viscosity",
        "density",
        "pressure_viscosity_coefficient",
        "temperature_viscosity_coefficient",
    ):
        assert getattr(oil, name) == pytest.approx(getattr(library_oil, name), rel=1e-3)
    assert oil.thermal_conductivity == pytest.approx(0.13, abs=0.015)


def test_any_two_figures_of_a_sheet_give_the_same_oil() -> None:
    at_40, at_100 = 220e-6, viscosity_at_100_degc(220e-6, 147.0)
    figures = {"viscosity_at_40": at_40, "viscosity_at_100": at_100, "index": 147.0}
    oils = [
        from_data_sheet(333.15, 880.0, **{k: v for k, v in figures.items() if k != missing})
        for missing in (*figures, "")
    ]
    for oil in oils[1:]:
        assert oil.dynamic_viscosity == pytest.approx(oils[0].dynamic_viscosity, rel=1e-6)
    with pytest.raises(InputError, match="Two of them are needed"):
        from_data_sheet(333.15, 880.0, viscosity_at_40=at_40)
    with pytest.raises(InputError, match=r"index 95.*have an index of 147 by ISO 2909"):
        from_data_sheet(333.15, 880.0, **{**figures, "index": 95.0})
    assert sheet_points(at_40, at_100, 150.0) == sheet_points(at_40, at_100, None)


def test_values_missing_in_a_sheet_are_estimated_and_listed() -> None:
    oil = from_data_sheet(333.15, 892.0, viscosity_at_40=220e-6, viscosity_at_100=18.7e-6)
    estimate = agma_925_coefficient(oil.dynamic_viscosity, "mineral")
    assert oil.pressure_viscosity_coefficient == estimate
    assumptions = " ".join(oil.assumptions)
    for part in ("Base oil mineral", "AGMA 925", "Cragoe"):
        assert part in assumptions
    measured = from_data_sheet(
        333.15,
        892.0,
        viscosity_at_40=220e-6,
        viscosity_at_100=18.7e-6,
        pressure_viscosity_coefficient=1.5e-8,
        thermal_conductivity=0.14,
    )
    assert measured.assumptions == ()
    assert measured.pressure_viscosity_coefficient == 1.5e-8
    synthetic = from_data_sheet(
        333.15, 850.0, viscosity_at_40=220e-6, index=150, base_oil="polyalphaolefin"
    )
    assert synthetic.pressure_viscosity_coefficient == agma_925_coefficient(
        synthetic.dynamic_viscosity, "polyalphaolefin"
    )
    assert "Base oil" not in " ".join(synthetic.assumptions)


@pytest.mark.parametrize("celsius", [12.0, 40.0, 70.0, 100.0])
def test_a_line_of_an_index_goes_through_its_point(celsius: float) -> None:
    points = points_through(celsius + 273.15, 90e-6, 120.0)
    assert walther_viscosity(celsius + 273.15, points) == pytest.approx(90e-6, rel=2e-3)
    (_, at_40), (_, at_100) = points
    assert viscosity_index(at_40, at_100) == pytest.approx(120.0, abs=0.1)


PRINTED = {
    "80W": (313.15, 0.082, 880.0, 2.19e-8, 0.0533, 0.13),
    "75W90-A": (343.15, 0.0298, 842.2, 1.226e-8, 0.0328, 0.15),
}


@pytest.mark.parametrize("name", PRINTED)
def test_an_oil_of_one_viscosity_has_it_there(name: str) -> None:
    temperature, *printed = PRINTED[name]
    for oil in (from_library(name), from_library(name, temperature)):
        assert [
            oil.dynamic_viscosity,
            oil.density,
            oil.pressure_viscosity_coefficient,
            oil.temperature_viscosity_coefficient,
            oil.thermal_conductivity,
        ] == printed
        assert not any("ASTM D341 line" in remark for remark in oil.assumptions[1:])


@pytest.mark.parametrize("name", PRINTED)
def test_an_oil_of_one_viscosity_follows_its_index(name: str) -> None:
    """It goes through the printed point, and its slope there is the printed one."""
    temperature = PRINTED[name][0]
    printed = from_library(name)
    neighbours = [from_library(name, temperature + step) for step in (-0.5, 0.5)]
    slope = math.log(neighbours[0].dynamic_viscosity / neighbours[1].dynamic_viscosity)
    assert slope == pytest.approx(printed.temperature_viscosity_coefficient, rel=0.02)
    assert (
        neighbours[0].dynamic_viscosity
        > printed.dynamic_viscosity
        > neighbours[1].dynamic_viscosity
    )
    assert neighbours[0].density > printed.density > neighbours[1].density
    at_40, at_100 = (from_library(name, known_at) for known_at in (313.149999, 373.15))
    index = viscosity_index(at_40.kinematic_viscosity, at_100.kinematic_viscosity)
    assert index == pytest.approx({"80W": 95.0, "75W90-A": 147.0}[name], abs=0.3)
    assert "is known at" in from_library(name, 363.15).assumptions[-1]


def test_the_density_of_75w90_at_15_degc_is_the_printed_one() -> None:
    assert from_library("75W90-A", 288.15).density == pytest.approx(870.0, abs=0.1)


def test_a_sheet_is_an_oil_of_its_two_points() -> None:
    points = sheet_points(100e-6, 11.066e-6, None)
    oil_ = Lubricant.from_temperature(343.15, points, 892.2, 1.6e-8, thermal_conductivity=0.13)
    other = from_data_sheet(
        343.15,
        892.2,
        viscosity_at_40=100e-6,
        viscosity_at_100=11.066e-6,
        pressure_viscosity_coefficient=1.6e-8,
        thermal_conductivity=0.13,
    )
    assert other.dynamic_viscosity == oil_.dynamic_viscosity
    assert other.density == oil_.density
