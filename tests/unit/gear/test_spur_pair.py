"""Centre distance, play, contact ratio and checks of a pair."""

import math
from collections.abc import Callable
from dataclasses import replace

import pytest

from tribodyn.errors import InputError, ModelWarning
from tribodyn.gear import BasicRack, SpurPair, operating_pressure_angle, spur_pair
from tribodyn.gear.curves import involute

Maker = Callable[..., SpurPair]
SMALL_RACK = BasicRack(1.0, 1.0, 0.2)


def test_unshifted_pair_runs_at_the_reference_distance(make_pair: Maker) -> None:
    pair = make_pair()
    assert pair.center_distance == pytest.approx(100e-3, rel=1e-14)
    assert pair.operating_pressure_angle == pytest.approx(math.radians(20.0), rel=1e-12)
    assert pair.backlash == pytest.approx(0.0, abs=1e-15)
    assert pair.tip_shortening_coefficient == pytest.approx(0.0, abs=1e-12)
    assert pair.pinion.tip_diameter == pytest.approx(88e-3)
    assert pair.ratio == 1.5


def test_shifted_pair_has_the_bottom_clearance_of_the_rack(make_pair: Maker) -> None:
    pair = make_pair(pinion_profile_shift_coefficient=0.5, wheel_profile_shift_coefficient=0.4)
    assert pair.tip_shortening_coefficient > 0.05
    clearance = pair.center_distance - pair.pinion.tip_radius - pair.wheel.root_radius
    assert clearance == pytest.approx(0.25 * 4e-3, rel=1e-9)


def test_wide_distance_leaves_the_tips_alone(make_pair: Maker) -> None:
    pair = make_pair(center_distance=101e-3)
    assert pair.tip_shortening_coefficient == 0.0
    assert pair.pinion.tip_diameter == pytest.approx(88e-3)


def test_play_of_a_spread_pair(make_pair: Maker) -> None:
    """Unshifted gears pulled apart: j = 2 a_0 cos(alpha) (inv alpha_wt - inv alpha)."""
    pair = make_pair(center_distance=100.4e-3)
    spread = involute(pair.operating_pressure_angle) - involute(math.radians(20.0))
    expected = 2.0 * 100e-3 * math.cos(math.radians(20.0)) * spread
    assert pair.backlash == pytest.approx(expected, rel=1e-10)


def test_thinning_adds_its_amount_to_the_play(make_pair: Maker) -> None:
    pair = make_pair(pinion_tooth_thinning=30e-6, wheel_tooth_thinning=50e-6)
    assert pair.backlash == pytest.approx(80e-6, rel=1e-9)


@pytest.mark.parametrize("distance", [None, 100e-3, 100.1e-3])
def test_requested_play_is_reached_by_equal_thinning(
    make_pair: Maker, distance: float | None
) -> None:
    pair = make_pair(center_distance=distance, backlash=120e-6)
    assert pair.backlash == pytest.approx(120e-6, rel=1e-9)
    assert pair.pinion.tooth_thinning == pair.wheel.tooth_thinning > 0.0


def test_play_below_what_the_distance_leaves_is_a_contradiction(make_pair: Maker) -> None:
    with pytest.raises(InputError) as caught:
        make_pair(center_distance=100.2e-3, backlash=50e-6)
    text = str(caught.value)
    assert "backlash = 0.05 mm" in text
    assert "0.137834 mm" in text


def test_driver_names_driving_and_driven_gear(make_pair: Maker) -> None:
    pair = make_pair(wheel_face_width=18e-3)
    assert (pair.driving, pair.driven) == (pair.pinion, pair.wheel)
    swapped = make_pair(driver="wheel")
    assert (swapped.driving, swapped.driven) == (swapped.wheel, swapped.pinion)
    assert pair.common_face_width == 18e-3


def test_rounding_of_shifts_counts_as_no_play(make_pair: Maker) -> None:
    pair = make_pair(center_distance=99.998e-3)
    assert -0.0005 * 4e-3 < pair.geometric_backlash < 0.0
    assert pair.backlash == 0.0
    with pytest.warns(ModelWarning, match="flank-interference-rounding"):
        pair = make_pair(center_distance=99.99e-3)
    assert -0.002 * 4e-3 < pair.geometric_backlash < -0.0005 * 4e-3


def test_interfering_flanks_name_the_smallest_distance(make_pair: Maker) -> None:
    with pytest.raises(InputError, match=r"at least 100 mm .*flanks interfere"):
        make_pair(center_distance=99.9e-3)


@pytest.mark.parametrize("distance", [80e-3, 90e-3, 91e-3])
@pytest.mark.parametrize("backlash", [None, 50e-6, 2e-4])
def test_no_backlash_makes_up_for_a_centre_distance_that_is_too_small(
    distance: float, backlash: float | None
) -> None:
    with pytest.raises(InputError) as caught:
        spur_pair(
            pinion_teeth=16, wheel_teeth=24, normal_module=4.5e-3,
            normal_pressure_angle=math.radians(20.0), pinion_face_width=20e-3,
            pinion_profile_shift_coefficient=0.8635, wheel_profile_shift_coefficient=-0.5103,
            center_distance=distance, backlash=backlash,
        )  # fmt: skip
    assert [str(problem.where) for problem in caught.value.problems] == ["argument center_distance"]
    assert "the centre distance must be at least 91.5001 mm" in str(caught.value)


def test_shifts_too_large_for_the_centre_distance_are_one_fault(make_pair: Maker) -> None:
    with pytest.raises(InputError) as caught:
        make_pair(center_distance=100e-3, wheel_profile_shift_coefficient=0.6, backlash=50e-6)
    assert len(caught.value.problems) == 1
    assert "the centre distance must be at least 102." in str(caught.value)


@pytest.mark.parametrize(
    ("changes", "expected"),
    [
        ({"pinion_teeth": 31}, "pinion_teeth: the pinion has 31 teeth, the wheel 30"),
        ({"driver": "sun"}, 'driver = "sun"'),
        ({"center_distance": 90e-3}, "at least 100 mm for these tooth thicknesses; 90 mm is given"),
        ({"center_distance": -0.1}, "center_distance = -0.1"),
        ({"center_distance": 105e-3}, "transverse contact ratio 0.534"),
        ({"pinion_tip_diameter": 70e-3}, "pinion_tip_diameter: tip diameter 70 mm"),
        ({"wheel_tip_diameter": 137e-3}, "wheel_tip_diameter: the tooth is pointed"),
        ({"wheel_bore_diameter": 110e-3}, "wheel_bore_diameter: bore diameter 110 mm"),
        ({"pinion_rack": SMALL_RACK}, "bottom clearance at the wheel's tip is 0 mm"),
        ({"pinion_teeth": 12}, "passes the base tangent point of the pinion by 1.5543 mm"),
        (
            {"pinion_rack": BasicRack(1.0, 1.05, 0.38)},
            "fillet reaches up to",
        ),
        ({"pinion_profile_shift_coefficient": -7.0}, "No centre distance without play"),
        ({"backlash": -1e-6}, "backlash = -1e-06 m"),
        ({"backlash": 1e-4, "wheel_tooth_thinning": 2e-5}, "wheel_tooth_thinning = 0.02 mm"),
        ({"wheel_mass": -1.0}, "wheel_mass: mass = -1 kg"),
        ({"normal_module": 0.0}, "argument normal_module: normal_module = 0 mm"),
    ],
)
def test_impossible_pairs_say_why(
    make_pair: Maker, changes: dict[str, object], expected: str
) -> None:
    with pytest.raises(InputError) as caught:
        make_pair(**changes)
    assert expected in str(caught.value)


def test_faults_of_both_gears_and_of_the_mesh_come_at_once(make_pair: Maker) -> None:
    with pytest.raises(InputError) as caught:
        make_pair(
            pinion_tip_diameter=100e-3, wheel_bore_diameter=0.2, center_distance=0.09, driver="x"
        )
    places = [str(problem.where) for problem in caught.value.problems]
    assert places == [
        "argument center_distance",
        "argument driver",
        "argument pinion_tip_diameter",
        "argument wheel_bore_diameter",
    ]


def test_undercut_below_the_used_flank_warns_with_both_diameters(make_pair: Maker) -> None:
    with pytest.warns(ModelWarning, match="undercut") as record:
        pair = make_pair(pinion_teeth=16)
    assert pair.pinion.undercut
    used = 2e3 * math.hypot(pair.pinion.base_radius, pair.path_limits[0])
    text = str(record[0].message)
    assert f"{2e3 * pair.pinion.form_radius:.6g} mm" in text
    assert f"{used:.6g} mm" in text


def test_undercut_of_the_used_flank_is_refused_and_the_remedy_works(make_pair: Maker) -> None:
    tip = 127.3e-3  # meets the pinion just above its base circle
    with pytest.raises(InputError, match="undercut removes flank") as caught:
        make_pair(pinion_teeth=14, wheel_tip_diameter=tip)
    (problem,) = caught.value.problems
    allowed = float(problem.remedy.split()[3]) * 1e-3
    assert allowed < tip
    with pytest.warns(ModelWarning, match="undercut"):
        pair = make_pair(pinion_teeth=14, wheel_tip_diameter=allowed - 1e-6)
    assert pair.transverse_contact_ratio > 1.0


def test_gears_of_different_base_pitch_are_no_pair(make_pair: Maker) -> None:
    pair = make_pair()
    other = replace(pair.wheel, normal_module=4.1e-3, tip_diameter=131.2e-3)
    with pytest.raises(InputError, match=r"4 mm on the pinion and 4\.1 mm on the wheel"):
        SpurPair(pair.pinion, other, pair.center_distance)


def test_operating_angle_needs_more_than_the_base_circles() -> None:
    with pytest.raises(InputError, match="base radii"):
        operating_pressure_angle(50, 4e-3, math.radians(20.0), 93.9e-3)
