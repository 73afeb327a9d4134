"""Friction in the loop compared with nominal friction, in a report."""

import re

import pytest

from tribodyn.report import render_report
from tribodyn.report.numbers import compared_friction

NAMES = (
    "rms_mesh_force", "peak_mesh_force", "peak_to_peak_dynamic_transmission_error",
    "rms_friction_force", "mean_friction_power",
)  # fmt: skip


def compared():
    """A summary in which each figure is a little more than with nominal friction."""
    values = {name: 1e-5 if "error" in name else 200.0 for name in NAMES}
    other = {f"{name}_nominal_friction": value / 1.25 for name, value in values.items()}
    return values | other | {"friction_fit_error": 1e-3}


def test_five_figures_in_display_units_with_their_change():
    rows = compared_friction(compared())
    assert [row.coupled.name for row in rows] == list(NAMES)
    assert {row.change for row in rows} == {"+25.000 %"}
    assert (rows[2].coupled.value, rows[2].coupled.unit, rows[2].nominal.value) == ("10", "µm", "8")
    assert rows[0].coupled.label == "Mesh force, rms"


def test_a_loss_and_nothing_to_relate_to():
    less = {"mean_friction_power": 90.0, "mean_friction_power_nominal_friction": 100.0}
    assert compared_friction(less)[0].change == "-10.000 %"
    none = {"mean_friction_power": 0.0, "mean_friction_power_nominal_friction": 0.0}
    assert compared_friction(none)[0].change == "–"
    assert compared_friction({"mean_friction_power": 90.0}) == []


@pytest.mark.parametrize("follows", [True, False])
def test_the_report_has_the_section_only_with_a_comparison(drawable, follows):
    result = drawable()
    summary = result.summary() | (compared() if follows else {})
    result.summary = lambda: summary
    page = render_report(result)
    assert page.count('href="#friction-in-the-loop"') == follows
    section = re.findall(r'id="friction-in-the-loop">(.*?)</section>', page, flags=re.DOTALL)
    assert len(section) == follows
    if follows:
        assert section[0].count("+25.000 %") == 5
        assert section[0].index("200 N") < section[0].index("160 N")
