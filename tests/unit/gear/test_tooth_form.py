"""Circles, thickness and checks of one gear."""

import math
import warnings
from collections.abc import Callable
from dataclasses import FrozenInstanceError
from typing import Any

import pytest

from tribodyn import load_case
from tribodyn.errors import InputError, ModelWarning
from tribodyn.gear import BasicRack, SpurGear, spur_pair
from tribodyn.study.case.to_models import gear_warnings

Maker = Callable[..., SpurGear]


def test_plain_gear_circles(make_gear: Maker) -> None:
    gear = make_gear()
    assert gear.reference_radius == pytest.approx(40e-3)
    assert gear.base_radius == pytest.approx(40e-3 * math.cos(math.radians(20.0)))
    assert gear.root_radius == pytest.approx(35e-3)
    assert gear.base_pitch == pytest.approx(2.0 * math.pi * gear.base_radius / 20)
    assert gear.tooth_thickness(gear.reference_radius) == pytest.approx(math.pi * 2e-3)


def test_thinning_is_measured_on_the_base_circle(make_gear: Maker) -> None:
    full, thin = make_gear(), make_gear(tooth_thinning=80e-6)
    base = full.base_radius
    difference = full.tooth_thickness(base) - thin.tooth_thickness(base)
    assert difference == pytest.approx(80e-6, rel=1e-11)
    infeed = full.root_radius - thin.root_radius
    assert infeed == pytest.approx(80e-6 / (2.0 * math.sin(math.radians(20.0))), rel=1e-11)


def test_roll_angle_is_curvature_radius_over_base_radius(make_gear: Maker) -> None:
    gear = make_gear()
    assert gear.roll_angle(gear.base_radius) == 0.0
    assert gear.roll_angle(gear.reference_radius) == pytest.approx(math.tan(math.radians(20.0)))
    assert gear.pressure_angle_at(gear.reference_radius) == pytest.approx(math.radians(20.0))


def test_no_involute_below_the_base_circle(make_gear: Maker) -> None:
    gear = make_gear()
    with pytest.raises(InputError, match="involute begins"):
        gear.half_tooth_angle(0.999 * gear.base_radius)


@pytest.mark.parametrize(("teeth", "undercut"), [(17, True), (18, False)])
def test_undercut_begins_at_17_097_teeth(make_gear: Maker, teeth: int, undercut: bool) -> None:
    # 2 h / sin(alpha)^2 = 17.097 for a rack that is straight down to one module.
    rack = BasicRack(tip_radius_coefficient=0.25 / (1.0 - math.sin(math.radians(20.0))))
    gear = make_gear(teeth=teeth, tip_diameter=4e-3 * (teeth + 2), rack=rack)
    assert gear.undercut is undercut


def test_form_circle_without_undercut_is_the_end_of_the_rack_flank(make_gear: Maker) -> None:
    gear = make_gear(teeth=40, tip_diameter=168e-3)
    angle = math.radians(20.0)
    depth = (1.25 - 0.38 * (1.0 - math.sin(angle))) * 4e-3
    expected = math.hypot(80e-3 - depth, depth / math.tan(angle))
    assert gear.form_radius == pytest.approx(expected, rel=1e-13)


def test_gear_is_frozen_and_its_line_of_text_has_units(make_gear: Maker) -> None:
    gear = make_gear()
    assert repr(gear) == "SpurGear(z 20, m 4 mm, alpha 20 deg, x 0, tip 88 mm, width 20 mm)"
    with pytest.raises(FrozenInstanceError):
        gear.teeth = 21  # type: ignore[misc]


@pytest.mark.parametrize(
    ("changes", "expected"),
    [
        ({"teeth": 4}, "teeth = 4. "),
        ({"teeth": 1001}, "at most 1000"),
        ({"teeth": 20.5}, "whole number"),
        ({"normal_module": -4e-3}, "normal_module = -4 mm"),
        ({"normal_pressure_angle": 20.0}, "normal_pressure_angle = 1145.92 deg"),
        ({"profile_shift_coefficient": math.nan}, "profile_shift_coefficient = nan"),
        ({"tip_diameter": 0.0}, "tip_diameter = 0 mm"),
        ({"tooth_thinning": -1e-6}, "tooth_thinning = -0.001 mm"),
        ({"face_width": 0.0}, "face_width = 0 mm"),
        ({"bore_diameter": -1e-3}, "bore_diameter = -1 mm"),
        ({"mass": 0.0}, "mass = 0 kg"),
        ({"moment_of_inertia": math.inf}, "moment_of_inertia = inf"),
        ({"rack": BasicRack(dedendum_coefficient=2.3)}, "flanks of the rack meet"),
        ({"rack": BasicRack(1.0, 0.2, 1.0)}, "more than the dedendum"),
        ({"teeth": 5, "profile_shift_coefficient": -2.0}, "cut through the axis"),
        ({"tip_diameter": 75e-3}, "below the base circle of 75.1754 mm"),
        ({"tip_diameter": 97e-3}, "pointed: tip thickness -"),
        ({"tip_diameter": 75.2e-3}, "leaves no involute flank"),
        (
            {"teeth": 6, "profile_shift_coefficient": -0.9, "tip_diameter": 26e-3},
            "meets in the middle of the tooth",
        ),
        ({"bore_diameter": 70e-3}, "The root circle has 70 mm"),
    ],
)
def test_impossible_gears_say_why(
    make_gear: Maker, changes: dict[str, object], expected: str
) -> None:
    with pytest.raises(InputError) as caught:
        make_gear(**changes)
    assert expected in str(caught.value)
    assert len(caught.value.problems) == 1


def test_all_faults_come_at_once(make_gear: Maker) -> None:
    with pytest.raises(InputError) as caught:
        make_gear(teeth=2, normal_module=0.0, face_width=math.nan, mass=-1.0)
    assert len(caught.value.problems) == 4
    with pytest.raises(InputError) as caught:
        make_gear(tip_diameter=97e-3, bore_diameter=80e-3)
    assert len(caught.value.problems) == 2


def test_thin_tip_warns_below_a_fifth_of_the_module(make_gear: Maker) -> None:
    with pytest.warns(ModelWarning, match="thin-tip") as record:
        gear = make_gear(tip_diameter=91.8e-3)
    assert 0.0 < gear.tip_thickness < 0.2 * 4e-3
    message = record[0].message
    assert isinstance(message, ModelWarning)
    assert f"{gear.tip_thickness / 4e-3:.3g} modules" in message.message


def test_tip_round_that_does_not_fit_is_reduced_with_a_warning(make_gear: Maker) -> None:
    rack = BasicRack(dedendum_coefficient=1.4, tip_radius_coefficient=0.5)
    with pytest.warns(ModelWarning, match="full-fillet"):
        gear = make_gear(rack=rack)
    largest = rack.largest_tip_radius_coefficient(math.radians(20.0))
    assert gear.trochoid.tip_radius == pytest.approx(largest * 4e-3)
    assert gear.trochoid.center_offset == pytest.approx(0.0, abs=1e-18)


def test_default_tip_round_fits_between_the_flanks_of_its_rack(make_gear: Maker) -> None:
    """The round of a rack of 25 degrees touches both flanks and the tip line."""
    angle = math.radians(25.0)
    round_ = BasicRack.usual(angle).tip_radius_coefficient
    half_width = math.pi / 4.0 - 1.25 * math.tan(angle)
    assert round_ * math.tan(math.pi / 4.0 - 0.5 * angle) == pytest.approx(half_width)
    assert BasicRack.usual(math.radians(20.0)) == BasicRack()
    data: dict[str, Any] = {
        "pinion_teeth": 30, "wheel_teeth": 40, "normal_module": 2e-3,
        "normal_pressure_angle": angle, "pinion_face_width": 20e-3,
    }  # fmt: skip
    with warnings.catch_warnings():
        warnings.simplefilter("error", ModelWarning)
        assert spur_pair(**data).pinion.rack.tip_radius_coefficient == round_
    with pytest.warns(ModelWarning, match="full-fillet"):
        spur_pair(**data, pinion_rack=BasicRack())


def test_a_case_of_any_angle_warns_only_of_the_round_that_it_gives() -> None:
    case = load_case("fzg-film").replace({
        "gears.normal_pressure_angle": "25 deg", "gears.pinion.profile_shift_coefficient": 0.2,
        "gears.wheel.profile_shift_coefficient": 0.1, "gears.center_distance": None,
        "gears.pinion.tip_diameter": None, "gears.wheel.tip_diameter": None,
    })  # fmt: skip
    given = case.replace({"gears.rack_tip_radius_coefficient": 0.38})
    codes = [{each.code for each in gear_warnings(c.gears, None)} for c in (case, given)]
    assert ["full-fillet" in each for each in codes] == [False, True]
    forms = [c.gear_pair.pinion.trochoid for c in (case, given)]
    assert forms[0].tip_radius == pytest.approx(forms[1].tip_radius, rel=1e-15)
