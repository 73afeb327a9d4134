"""Values and units as they are printed."""

from __future__ import annotations

import numpy as np
import pytest

from tribodyn.nomenclature import QUANTITIES
from tribodyn.plot.theme.labels import axis_label, display_unit, displayed, readable, rounded


def test_units_are_printed_with_their_signs() -> None:
    assert readable("kg*mm^2") == "kg·mm²"
    assert readable("kg/m^3") == "kg/m³"
    assert readable("um") == "µm"


def test_only_the_unit_of_a_label_is_rewritten() -> None:
    # "um" occurs in "minimum" and "addendum": only the unit in brackets is rewritten
    assert axis_label("minimum_film") == "Minimum film [µm]"
    assert axis_label("addendum_coefficient") == "Addendum coefficient"


def test_every_quantity_has_a_label_with_its_display_unit() -> None:
    for name, quantity in QUANTITIES.items():
        label = axis_label(name)
        assert label.lower().startswith(name.replace("_", " ").lower())
        assert ("[" in label) == bool(quantity.display_unit)


def test_a_label_of_the_caller_has_the_unit() -> None:
    assert axis_label("acceleration", "Along the line of action") == (
        "Along the line of action [m/s²]"
    )
    assert axis_label("friction_coefficient", "mu") == "mu"


def test_values_have_the_display_unit() -> None:
    values = displayed("deflection", np.array([[1e-6, -2e-6]]))
    np.testing.assert_allclose(values, [[1.0, -2.0]], rtol=1e-15)
    assert displayed("hertz_pressure", 1.2e9) == pytest.approx(1.2)
    assert display_unit("hertz_pressure") == "GPa"


@pytest.mark.parametrize(
    ("name", "value", "text"),
    [
        ("mesh_force", 2660.44, "2660 N"),
        ("mesh_force", -12.3456, "-12.3 N"),
        ("mesh_force", 0.0, "0 N"),
        ("friction_coefficient", 0.051234, "0.0512"),
        ("contact_loss_share", 1.0, "1.00"),
        ("mesh_force", 3.2e-9, "3.20e-09 N"),
        ("mesh_force", 999.9, "1000 N"),
    ],
)
def test_one_value_for_a_title(name: str, value: float, text: str) -> None:
    assert rounded(name, value) == text
