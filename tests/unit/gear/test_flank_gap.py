"""Gaps of modified flanks: amount, length, shape and above all sign of each modification."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from tribodyn.gear import (
    BasicRack,
    FlankModification,
    ProfileMap,
    SpurPair,
    default_relief_length,
    flank_gap,
    flank_ranges,
    profile_gap,
)

Array = NDArray[np.float64]
Maker = Callable[..., SpurPair]


def over_path(pair: SpurPair, path: Array | float, face: Array | float = 0.0) -> Array:
    place = np.asarray(path)
    return flank_gap(pair, place, pair.line_of_action_length - place, face)


@pytest.fixture
def ends(make_pair: Maker) -> Array:
    """``path`` at the wheel's tip, in the middle and at the pinion's tip."""
    low, high = make_pair().path_limits
    return np.array([low, 0.5 * (low + high), high])


def test_involutes_leave_no_gap(make_pair: Maker, ends: Array) -> None:
    pair = make_pair()
    assert not np.any(over_path(pair, ends, np.array([[-0.01], [0.01]])))
    assert not pair.has_modification


@pytest.mark.parametrize("shape", ["linear", "parabolic"])
def test_tip_relief_of_the_pinion_opens_the_end_at_its_tip(make_pair: Maker, shape: str) -> None:
    relief = FlankModification(tip_relief=20e-6, tip_relief_length=4e-3, tip_relief_shape=shape)
    pair = make_pair(pinion_modification=relief)
    _, high = pair.path_limits
    gap = over_path(pair, high - np.array([0.0, 1e-3, 2e-3, 4e-3, 6e-3]))
    left = np.array([1.0, 0.75, 0.5, 0.0, 0.0])
    assert gap == pytest.approx(20e-6 * (left if shape == "linear" else left**2), abs=1e-18)


def test_tip_relief_of_the_wheel_opens_the_other_end(make_pair: Maker, ends: Array) -> None:
    pair = make_pair(wheel_modification=FlankModification(tip_relief=20e-6, tip_relief_length=1e-3))
    assert over_path(pair, ends) == pytest.approx([20e-6, 0.0, 0.0], abs=1e-18)


def test_root_relief_of_the_wheel_is_where_the_pinion_tip_touches(
    make_pair: Maker, ends: Array
) -> None:
    relief = FlankModification(root_relief=12e-6, root_relief_length=2e-3)
    pair = make_pair(wheel_modification=relief)
    assert over_path(pair, ends) == pytest.approx([0.0, 0.0, 12e-6], abs=1e-18)
    assert over_path(pair, ends[2] - 0.5e-3) == pytest.approx(9e-6, rel=1e-9)


def test_default_relief_ends_where_the_number_of_pairs_changes(make_pair: Maker) -> None:
    relief = FlankModification(tip_relief=10e-6)
    pair = make_pair(pinion_modification=relief, wheel_modification=relief)
    low, high = pair.path_limits
    lone_start, lone_end = high - pair.base_pitch, low + pair.base_pitch
    path = np.array([low, 0.5 * (low + lone_start), lone_start, lone_end, high])
    gap = over_path(pair, path)
    assert gap == pytest.approx([10e-6, 5e-6, 0.0, 0.0, 10e-6], abs=1e-17)
    length = (pair.transverse_contact_ratio - 1.0) * pair.base_pitch
    assert default_relief_length(pair) == pytest.approx(length, rel=1e-12)
    stated = FlankModification(tip_relief=10e-6, tip_relief_length=length)
    again = make_pair(pinion_modification=stated, wheel_modification=stated)
    assert over_path(again, path) == pytest.approx(gap, abs=1e-17)


def test_high_contact_ratio_has_a_short_default(make_pair: Maker) -> None:
    rack = BasicRack(1.25, 1.55, 0.25)
    pair = make_pair(pinion_teeth=60, wheel_teeth=80, pinion_rack=rack, wheel_rack=rack)
    ratio = pair.transverse_contact_ratio
    assert 2.0 < ratio < 3.0
    assert default_relief_length(pair) == pytest.approx((ratio - 2.0) * pair.base_pitch)


def test_reliefs_add_where_they_overlap(make_pair: Maker, ends: Array) -> None:
    length = flank_ranges(make_pair())[0].length
    modification = FlankModification(
        tip_relief=10e-6, tip_relief_length=length, root_relief=6e-6, root_relief_length=length
    )
    pair = make_pair(pinion_modification=modification)
    assert over_path(pair, ends) == pytest.approx([6e-6, 8e-6, 10e-6], rel=1e-9)


def test_beyond_its_ends_a_flank_is_as_at_them(make_pair: Maker, ends: Array) -> None:
    relief = FlankModification(tip_relief=10e-6, root_relief=4e-6, profile_slope=2e-6)
    pair = make_pair(pinion_modification=relief)
    beyond = over_path(pair, ends[[0, 2]] + np.array([-1e-3, 1e-3]))
    assert beyond == pytest.approx([4e-6, 12e-6], rel=1e-9)


def test_profile_crowning_takes_from_both_ends(make_pair: Maker, ends: Array) -> None:
    pair = make_pair(wheel_modification=FlankModification(profile_crowning=8e-6))
    assert over_path(pair, ends) == pytest.approx([8e-6, 0.0, 8e-6], abs=1e-17)
    quarter = 0.75 * ends[0] + 0.25 * ends[2]
    assert over_path(pair, quarter) == pytest.approx(2e-6, rel=1e-9)


def test_profile_slope_takes_from_the_tip(make_pair: Maker, ends: Array) -> None:
    slope = FlankModification(profile_slope=8e-6)
    pinion, wheel = make_pair(pinion_modification=slope), make_pair(wheel_modification=slope)
    assert over_path(pinion, ends) == pytest.approx([0.0, 4e-6, 8e-6], abs=1e-17)
    assert over_path(wheel, ends) == pytest.approx([8e-6, 4e-6, 0.0], abs=1e-17)


def test_crowning_takes_from_the_ends_of_the_face(make_pair: Maker, ends: Array) -> None:
    pair = make_pair(pinion_modification=FlankModification(crowning=8e-6))
    face = np.array([[-10e-3], [-5e-3], [0.0], [10e-3]])
    gap = over_path(pair, ends, face)
    assert gap.shape == (4, 3)
    assert gap[:, 1] == pytest.approx([8e-6, 2e-6, 0.0, 8e-6], rel=1e-12)
    assert pair.has_lead_modification
    assert not pair.has_profile_modification


def test_crowning_of_a_wider_gear_is_cut_off(make_pair: Maker) -> None:
    pair = make_pair(wheel_face_width=40e-3, wheel_modification=FlankModification(crowning=8e-6))
    assert over_path(pair, 0.02, 10e-3) == pytest.approx(2e-6, rel=1e-12)


def test_lead_slopes_and_misalignment_open_the_positive_end(make_pair: Maker) -> None:
    slope = FlankModification(lead_slope=6e-6)
    pair = make_pair(pinion_modification=slope, wheel_modification=slope, misalignment=10e-6)
    face = np.array([-10e-3, 0.0, 10e-3])
    assert over_path(pair, 0.02, face) == pytest.approx([-11e-6, 0.0, 11e-6], abs=1e-18)
    opposed = make_pair(pinion_modification=slope, misalignment=-6e-6)
    assert over_path(opposed, 0.02, face) == pytest.approx([0.0, 0.0, 0.0], abs=1e-18)


def test_misalignment_belongs_to_the_common_face(make_pair: Maker) -> None:
    pair = make_pair(wheel_face_width=40e-3, misalignment=10e-6)
    assert over_path(pair, 0.02, pair.common_face_width / 2.0) == pytest.approx(5e-6)
    assert pair.has_lead_modification
    assert pair.has_modification


def test_wear_takes_away(make_pair: Maker, ends: Array) -> None:
    even = make_pair(pinion_modification=FlankModification(wear_depth=3e-6))
    assert over_path(even, ends) == pytest.approx([3e-6, 3e-6, 3e-6], rel=1e-12)
    depth = FlankModification(wear_depth=(9e-6, 1e-6, 5e-6))
    assert over_path(make_pair(pinion_modification=depth), ends) == pytest.approx(
        [9e-6, 1e-6, 5e-6], rel=1e-9
    )
    assert over_path(make_pair(wheel_modification=depth), ends) == pytest.approx(
        [5e-6, 1e-6, 9e-6], rel=1e-9
    )


def test_measured_excess_closes_the_gap(make_pair: Maker, ends: Array) -> None:
    pinion, _ = flank_ranges(make_pair())
    chart = ProfileMap(tuple(pinion), (0.0,), ((1e-6,), (5e-6,)))
    pair = make_pair(pinion_modification=FlankModification(profile_map=chart))
    assert over_path(pair, ends) == pytest.approx([-1e-6, -3e-6, -5e-6], rel=1e-9)
    assert pair.has_profile_modification
    assert not pair.has_lead_modification


def test_contacts_off_the_line_of_action_take_their_own_radii(make_pair: Maker) -> None:
    relief = FlankModification(tip_relief=10e-6, tip_relief_length=1e-3)
    pair = make_pair(pinion_modification=relief, wheel_modification=relief)
    pinion, wheel = flank_ranges(pair)
    assert float(flank_gap(pair, pinion.highest, wheel.lowest)) == pytest.approx(10e-6)
    assert float(flank_gap(pair, pinion.highest, wheel.highest)) == pytest.approx(20e-6)


def test_the_gap_does_not_depend_on_the_driver(make_pair: Maker, ends: Array) -> None:
    relief = FlankModification(tip_relief=10e-6, root_relief=3e-6, crowning=2e-6)
    pairs = [make_pair(pinion_modification=relief, driver=name) for name in ("pinion", "wheel")]
    first, second = (over_path(pair, ends, 5e-3) for pair in pairs)
    assert np.array_equal(first, second)
    assert first[2] == pytest.approx(10.5e-6, rel=1e-9)


def test_a_gear_alone(make_pair: Maker) -> None:
    pair = make_pair(pinion_modification=FlankModification(tip_relief=10e-6))
    pinion, _ = flank_ranges(pair)
    assert profile_gap(pair.pinion, pinion.highest - 1e-3, pinion, 2e-3) == pytest.approx(5e-6)


def test_gears_with_modifications_are_values(make_pair: Maker) -> None:
    relief = FlankModification(tip_relief=10e-6, wear_depth=[1e-6, 2e-6])  # type: ignore[arg-type]
    pair, again = (make_pair(pinion_modification=relief) for _ in range(2))
    assert pair == again
    assert hash(pair) == hash(again)
    assert pair != make_pair()
    plain = replace(pair, pinion=replace(pair.pinion, modification=FlankModification()))
    assert plain == make_pair()
    assert repr(relief) == "FlankModification(tip_relief 10 um, wear_depth 1 to 2 um)"
