"""The page on stiffness: its table is computed anew, its statements hold in these numbers."""

from __future__ import annotations

import re

import pytest
from stiffness_tables import PAGE, PAIRS, TABLES, mesh, on_page, single_pair

TEXT = PAGE.read_text("utf-8")


@pytest.mark.parametrize("name", TABLES)
def test_tables_are_computed_numbers(name: str) -> None:
    numbers = [
        [float(cell) for cell in re.findall(r"(?<=\| )\d+\.\d+(?= \|)", table)]
        for table in (on_page(name, TEXT), "\n".join(TABLES[name]()))
    ]
    assert len(numbers[0]) == len(numbers[1]) > 20, "run tests/docs/stiffness_tables.py"
    assert numbers[0] == pytest.approx(numbers[1], rel=3e-3, abs=0.011)


@pytest.mark.parametrize("name", PAIRS)
def test_independent_pairs_overstate_the_excitation(name: str) -> None:
    def swing(model: str) -> float:
        return float(mesh(name, model, "bore").peak_to_peak_transmission_error)

    assert 1.3 < swing("potential-energy") / swing("fe2d") < 2.8
    assert swing("analytic") == pytest.approx(swing("fe2d"), rel=0.04)
    alone = single_pair(name, "potential-energy", "bore") / single_pair(name, "fe2d", "bore")
    assert 0.94 < alone < 0.985


@pytest.mark.parametrize("name", PAIRS)
def test_analytic_is_within_its_bounds(name: str) -> None:
    means = [
        float(mesh(name, model, "bore").mesh_stiffness_secant.mean())
        for model in ("analytic", "fe2d")
    ]
    assert means[0] == pytest.approx(means[1], rel=0.03)
    alone = [single_pair(name, model, "bore") for model in ("analytic", "fe2d")]
    assert alone[0] == pytest.approx(alone[1], rel=0.06)


@pytest.mark.parametrize("name", PAIRS)
def test_the_wind_up_moves_the_mean_and_not_the_swing(name: str) -> None:
    bore, rim = (mesh(name, "fe2d", where) for where in ("bore", "rim"))
    assert rim.peak_to_peak_transmission_error == pytest.approx(
        float(bore.peak_to_peak_transmission_error), rel=1e-6
    )
    part = 1.0 - float(rim.mean_transmission_error / bore.mean_transmission_error)
    assert 0.1 < part < 0.6
