"""The lubricant object."""

from __future__ import annotations

import dataclasses

import pytest

from tribodyn.errors import InputError
from tribodyn.lubricant import Lubricant, barus_viscosity, roelands_viscosity, walther_viscosity

POINTS = ((313.15, 100e-6), (373.15, 11.066e-6))


@pytest.fixture
def oil():
    return Lubricant(0.082, 880.0, 2.19e-8, name="80W", temperature=313.15, source="a data sheet")


def test_properties_are_stored(oil):
    assert (oil.dynamic_viscosity, oil.density) == (0.082, 880.0)
    assert oil.kinematic_viscosity == pytest.approx(93.18e-6, rel=1e-4)
    assert (oil.name, oil.temperature, oil.source, oil.assumptions) == (
        "80W",
        313.15,
        "a data sheet",
        (),
    )


def test_it_cannot_be_changed(oil):
    with pytest.raises(dataclasses.FrozenInstanceError):
        oil.density = 1.0


def test_repr_is_one_short_line(oil):
    assert "\n" not in repr(oil)
    assert len(repr(oil)) < 140


def test_viscosity_picks_the_law_by_name(oil):
    assert oil.viscosity(5e8) == roelands_viscosity(5e8, 0.082, 2.19e-8)
    assert oil.viscosity(5e8, law="barus") == barus_viscosity(5e8, 0.082, 2.19e-8)
    with pytest.raises(InputError, match='Did you mean "roelands"'):
        oil.viscosity(5e8, law="roeland")


@pytest.mark.parametrize(
    ("values", "remedy"),
    [
        ((82.0e3, 880.0, 2.19e-8), r"82 mPa\*s"),
        ((0.082, 0.88, 2.19e-8), r"0\.88 g/cm\^3 is 880"),
        ((0.082, 880.0, 21.9), r"21\.9 1/GPa is 2\.19e-8"),
        ((0.0, 880.0, 2.19e-8), "dynamic_viscosity"),
        ((0.082, 880.0, -1e-8), "pressure_viscosity_coefficient"),
        ((float("nan"), 880.0, 2.19e-8), "finite"),
    ],
)
def test_slips_in_units_are_pointed_out(values, remedy):
    with pytest.raises(InputError, match=remedy):
        Lubricant(*values)


def test_temperature_must_be_absolute():
    with pytest.raises(InputError, match="temperature"):
        Lubricant(0.082, 880.0, 2.19e-8, temperature=-10.0)


def test_from_temperature_multiplies_with_the_density_at_that_temperature():
    oil = Lubricant.from_temperature(343.15, POINTS, 892.2, 1.6e-8)
    assert oil.density == pytest.approx(892.2 - 0.7 * 55.0)
    assert oil.kinematic_viscosity == pytest.approx(walther_viscosity(343.15, POINTS), rel=1e-12)
    assert oil.temperature == 343.15
    assert oil.assumptions == ()


def test_an_estimated_coefficient_is_listed_as_an_assumption():
    oil = Lubricant.from_temperature(343.15, POINTS, 892.2, base_oil="mineral")
    assert oil.pressure_viscosity_coefficient == pytest.approx(1.6e-8, rel=1e-3)
    assert any("AGMA 925" in assumption for assumption in oil.assumptions)


@pytest.mark.parametrize("coefficient", [None, 1.6e-8])
def test_coefficient_and_base_oil_are_not_both_or_neither(coefficient):
    base_oil = None if coefficient is None else "mineral"
    with pytest.raises(InputError, match="exactly one of the two"):
        Lubricant.from_temperature(343.15, POINTS, 892.2, coefficient, base_oil=base_oil)
