"""Figures of a summary in words and units."""

from __future__ import annotations

from itertools import pairwise

import pytest

from tribodyn.plot.theme.labels import engineering
from tribodyn.report.numbers import HEADLINES, describe, headlines, number_tables
from tribodyn.study import SUMMARY
from tribodyn.study.pipeline.summary_figures import in_a_sentence, in_words
from tribodyn.units import parse


@pytest.mark.parametrize(
    ("name", "label"),
    [
        ("mesh_frequency", "Mesh frequency"),
        ("rms_mesh_force", "Mesh force, rms"),
        ("minimum_mesh_force", "Mesh force, least"),
        ("minimum_film", "Minimum film"),  # a quantity of its own, not the least of "film"
        ("mass_wheel", "Mass, wheel"),
        ("omega_max_dt", "omega_max dt"),
        ("line_of_action_indicator", "Bearing force across over along the line of action"),
        ("roll_angle_C", "Roll angle, at C"),
        (
            "dynamic_transmission_error_harmonic_2",
            "Dynamic transmission error, mesh harmonic 2",
        ),
        (
            "rms_acceleration_oloa_wheel",
            "Acceleration, rms, across the line of action, wheel",
        ),
    ],
)
def test_names_become_readable_labels(name: str, label: str) -> None:
    assert in_words(name) == label


@pytest.mark.parametrize(
    ("name", "label"),
    [
        ("rms_bearing_force_loa_pinion",
         "rms bearing force along the line of action of the pinion"),
        ("peak_to_peak_dynamic_transmission_error", "peak to peak dynamic transmission error"),
        ("static_transmission_error_harmonic_1", "static transmission error in mesh harmonic 1"),
        ("efficiency", "efficiency"),
    ],
)  # fmt: skip
def test_names_read_within_a_sentence(name: str, label: str) -> None:
    assert in_a_sentence(name) == label


@pytest.mark.parametrize(
    ("value", "unit", "digits", "text"),
    [
        (18350.0, "N/µm", 4, ("18.35", "kN/µm")),
        (9999.0, "N", 4, ("9999", "N")),
        (31415926.0, "W", 4, ("31.42", "MW")),
        (123456.0, "kg", 4, ("123456", "kg")),
        (0.05, "µm", 4, ("0.05", "µm")),
        (0.0, "N", 4, ("0", "N")),
        (1200.0, "rpm", 2, ("1200", "rpm")),
    ],
)
def test_large_numbers_have_no_power_of_ten(
    value: float, unit: str, digits: int, text: tuple[str, str]
) -> None:
    assert engineering(value, unit, digits) == text


def test_rows_stand_by_topic() -> None:
    (pair,) = number_tables(dict.fromkeys(reversed(SUMMARY), 1.5))
    topics = [row.figure.topic for row in pair.rows]
    assert topics[0] == "Operating point"
    assert len(dict.fromkeys(topics)) == 1 + sum(a != b for a, b in pairwise(topics))


def test_every_summary_figure_can_be_printed() -> None:
    (pair,) = number_tables(dict.fromkeys(SUMMARY, 1.5))
    rows = [row.figure for row in pair.rows]
    assert [row.name for row in rows] == list(SUMMARY)
    assert all(row.meaning for row in rows)
    assert len({row.label for row in rows}) == len(rows)


def test_both_columns_are_the_same_value() -> None:
    for name, figure in SUMMARY.items():
        value = 300.25 if figure.unit == "K" else 0.0123  # degrees are counted from elsewhere
        row = describe(name, value)
        value_on_page = parse(f"{row.value} {row.unit}".strip(), figure.unit)
        assert value_on_page == pytest.approx(value, rel=1e-4)
        assert float(row.si) == value


def test_cards_have_a_fixed_order_and_omit_missing_figures() -> None:
    summary = dict.fromkeys(reversed(HEADLINES[:3]), 1.0)
    assert [card.name for card in headlines(summary)] == list(HEADLINES[:3])
    assert set(HEADLINES) <= set(SUMMARY)


def test_figures_of_parts_are_rows_with_a_column_for_each_part() -> None:
    summary = {
        "machine.input_power": 2.5e9,
        "meshes.first.mean_mesh_force": 2.0e6,
        "meshes.second.mean_mesh_force": 1500.0,
        "meshes.second.mesh_frequency": 400.0,
        "load_cases.slow.meshes.first.mean_mesh_force": 100.0,
        "bearings.A.mean_radial_force": 1e-12,
        "bearings.B.mean_radial_force": 5.0,
    }
    tables = {each.title: each for each in number_tables(summary)}
    assert list(tables) == ["Machine", "Meshes", "Bearings", "Meshes, load case slow"]
    meshes = {row.figure.name: row for row in tables["Meshes"].rows}
    assert set(tables["Meshes"].parts) == {"first", "second"}
    force = dict(zip(tables["Meshes"].parts, meshes["mean_mesh_force"].values, strict=True))
    # One unit for the row; a part without the figure has a dash.
    assert meshes["mean_mesh_force"].figure.unit == "kN"
    assert {name: float(value) for name, value in force.items()} == {"first": 2e3, "second": 1.5}
    assert "–" in meshes["mesh_frequency"].values
    (bearings,) = tables["Bearings"].rows
    assert dict(zip(tables["Bearings"].parts, bearings.values, strict=True)) == {"A": "0", "B": "5"}
    assert tables["Meshes, load case slow"].load == "slow"
    head, rows = tables["Meshes"].cells()
    assert all(len(row) == len(head) for row in rows)
