"""Material and basic rack."""

import math

import pytest

from tribodyn.errors import InputError
from tribodyn.gear import BasicRack, Material


def test_shear_modulus_of_an_incompressible_body_is_a_third() -> None:
    assert Material(3e9, 0.499).shear_modulus == pytest.approx(3e9 / 2.998)


@pytest.mark.parametrize(
    "arguments", [{"youngs_modulus": 0.0}, {"poissons_ratio": 0.5}, {"density": math.nan}]
)
def test_impossible_materials_are_refused(arguments: dict[str, float]) -> None:
    with pytest.raises(InputError, match=next(iter(arguments))):
        Material(**arguments)


def test_full_round_touches_both_flanks_and_the_tip_line() -> None:
    angle = math.radians(20.0)
    rack = BasicRack(dedendum_coefficient=1.4)
    radius = rack.largest_tip_radius_coefficient(angle)
    # Circle on the centre line at the depth dedendum - radius; distance to the straight flank.
    half_width = math.pi / 4.0 - (1.4 - radius) * math.tan(angle)
    assert half_width * math.cos(angle) == pytest.approx(radius, rel=1e-14)


def test_rack_reports_all_wrong_coefficients() -> None:
    with pytest.raises(InputError) as caught:
        BasicRack(0.0, math.inf, -0.1)
    assert len(caught.value.problems) == 3


def test_rack_may_be_sharp() -> None:
    assert BasicRack(tip_radius_coefficient=0.0).fitting_tip_radius_coefficient(0.35) == 0.0
