"""Figures of a summary in words and units."""

from __future__ import annotations

import pytest

from tribodyn.report.numbers import HEADLINES, describe, headlines, in_words, table
from tribodyn.study import SUMMARY
from tribodyn.units import parse


@pytest.mark.parametrize(
    ("name", "words"),
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
def test_names_read_like_words(name: str, words: str) -> None:
    assert in_words(name) == words


def test_every_summary_figure_can_be_printed() -> None:
    rows = table(dict.fromkeys(SUMMARY, 1.5))
    assert [row.name for row in rows] == list(SUMMARY)
    assert all(row.meaning for row in rows)
    assert len({row.words for row in rows}) == len(rows)


def test_both_columns_are_the_same_value() -> None:
    for name, figure in SUMMARY.items():
        row = describe(name, 0.0123)
        assert parse(f"{row.shown} {row.unit}".strip(), figure.unit) == pytest.approx(
            0.0123, rel=1e-4
        )
        assert float(row.si) == 0.0123


def test_cards_keep_their_order_and_leave_out_what_is_missing() -> None:
    summary = dict.fromkeys(reversed(HEADLINES[:3]), 1.0)
    assert [card.name for card in headlines(summary)] == list(HEADLINES[:3])
    assert set(HEADLINES) <= set(SUMMARY)
