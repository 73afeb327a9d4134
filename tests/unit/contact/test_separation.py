"""Contact outside of the path of contact: separation of a tip corner from the mating flank."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from tribodyn.contact import extended_contact
from tribodyn.errors import InputError
from tribodyn.gear import BasicRack, SpurGear, SpurPair, cylindrical_pair, half_tooth, spur_pair

pytestmark = pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")

Array = NDArray[np.float64]

FZG_A: dict[str, Any] = {
    "pinion_teeth": 16, "wheel_teeth": 24, "normal_module": 4.5e-3,
    "normal_pressure_angle": math.radians(20.0), "center_distance": 91.5e-3,
    "pinion_profile_shift_coefficient": 0.8635, "wheel_profile_shift_coefficient": -0.5103,
    "pinion_face_width": 20e-3,
}  # fmt: skip
FZG_C = {
    **FZG_A, "pinion_profile_shift_coefficient": 0.182, "wheel_profile_shift_coefficient": 0.171,
    "pinion_tip_diameter": 82.46e-3, "wheel_tip_diameter": 118.36e-3,
}  # fmt: skip
LARGE = {
    "pinion_teeth": 30, "wheel_teeth": 70, "normal_module": 3e-3,
    "normal_pressure_angle": math.radians(22.5), "pinion_profile_shift_coefficient": 0.3,
    "wheel_profile_shift_coefficient": -0.1, "pinion_face_width": 20e-3,
}  # fmt: skip
PAIRS = {"fzg-a": FZG_A, "fzg-c": FZG_C, "large": LARGE}


def flank_points(gear: SpurGear, points: int = 4000) -> Array:
    """Right flank with its tip corner, tooth axis upwards, gear axis at the origin."""
    height, half_thickness = half_tooth(gear, points)
    return np.array([half_thickness, height])


def turned(points: Array, angle: float) -> Array:
    cosine, sine = math.cos(angle), math.sin(angle)
    return np.array([[cosine, -sine], [sine, cosine]]) @ points


def rotation_to_touch(pair: SpurPair, path: float) -> float:
    """Brute force: turn the wheel until its outline meets the pinion's; result on the base circle.

    Only outlines and the two axes go in. The pinion's tooth is placed so that its involute passes
    the line of action at ``path``; how far the wheel's flank is from it is looked for point by
    point, in polar angles about the wheel's axis, as is where it would touch at ``path`` itself.
    """
    base1, base2 = pair.pinion.base_radius, pair.wheel.base_radius
    length = pair.line_of_action_length
    centre = np.array([[length], [base1 + base2]])
    # Right flank of the pinion: point of the involute with radius of curvature ``path`` at
    # (path, base1), its tooth axis turned by the polar angle of that point.
    flank1 = flank_points(pair.pinion)
    half_angle = pair.pinion.base_half_angle - (path / base1 - math.atan(path / base1))
    placed1 = turned(flank1, half_angle - math.atan(path / base1))
    reach = length - path
    flank2 = flank_points(pair.wheel)
    half_angle = pair.wheel.base_half_angle - (reach / base2 - math.atan(reach / base2))
    # The wheel hangs upside down: its tooth axis points to the pinion.
    placed2 = turned(-flank2, half_angle - math.atan(reach / base2))
    about = placed1 - centre
    radius1, angle1 = np.hypot(*about), np.arctan2(about[0], -about[1])
    radius2, angle2 = np.hypot(*placed2), np.arctan2(placed2[0], -placed2[1])
    inside = (radius1 >= radius2.min()) & (radius1 <= radius2.max())
    gaps = np.interp(radius1[inside], radius2, angle2) - angle1[inside]
    # The other way: points of the wheel, the corner among them, against the pinion's outline.
    at_pinion = placed2 + centre
    radius, angle = np.hypot(*at_pinion), np.arctan2(at_pinion[0], at_pinion[1])
    own_radius, own_angle = np.hypot(*placed1), np.arctan2(placed1[0], placed1[1])
    common = (radius >= own_radius.min()) & (radius <= own_radius.max())
    back = angle[common] - np.interp(radius[common], own_radius, own_angle)
    return min(float(gaps.min()) * base2, float(back.min()) * base1)


def test_reference_values() -> None:
    pair = spur_pair(**FZG_A)
    low, high = pair.path_limits
    off = 0.05 * pair.base_pitch
    gap = extended_contact(pair, [low - off, high + off]).separation
    assert gap * 1e6 == pytest.approx([6.8, 28.6], rel=0.02)


@pytest.mark.parametrize("driver", ["pinion", "wheel"])
@pytest.mark.parametrize("name", PAIRS)
@pytest.mark.parametrize("pitches", [0.02, 0.05, 0.15])
def test_outlines_meet_at_the_computed_separation(name: str, driver: str, pitches: float) -> None:
    pair = spur_pair(**PAIRS[name], driver=driver)
    low, high = pair.path_limits
    for path in (low - pitches * pair.base_pitch, high + pitches * pair.base_pitch):
        contact = extended_contact(pair, path)
        assert bool(contact.possible)
        expected = rotation_to_touch(pair, path)
        assert float(contact.separation) == pytest.approx(expected, rel=2e-3, abs=2e-8)


@pytest.mark.parametrize("name", PAIRS)
def test_on_the_path_of_contact_involutes_touch(name: str) -> None:
    pair = spur_pair(**PAIRS[name])
    path = np.linspace(*pair.path_limits, 11)
    contact = extended_contact(pair, path)
    assert np.all(contact.separation == 0.0)
    assert np.all(contact.possible)
    assert np.array_equal(contact.pinion_curvature_radius, path)
    assert np.array_equal(contact.wheel_curvature_radius, pair.line_of_action_length - path)
    assert rotation_to_touch(pair, float(path[5])) == pytest.approx(0.0, abs=2e-8)


@pytest.mark.parametrize("name", PAIRS)
def test_it_begins_with_zero_slope_as_a_square(name: str) -> None:
    pair = spur_pair(**PAIRS[name])
    low, high = pair.path_limits
    for end, sense in ((low, -1.0), (high, 1.0)):
        off = pair.base_pitch * np.array([1e-4, 1e-3, 2e-3])
        gap = extended_contact(pair, end + sense * off).separation
        assert np.all(gap > 0.0)
        assert gap / off**2 == pytest.approx(np.full(3, gap[1] / off[1] ** 2), rel=0.01)


def test_the_tip_corner_contact_has_its_curvature_and_meets_the_mate_above_its_lowest_point() -> (
    None
):
    pair = spur_pair(**FZG_A)
    low, high = pair.path_limits
    length, off = pair.line_of_action_length, 0.05 * pair.base_pitch
    contact = extended_contact(pair, [low - off, high + off])
    assert contact.pinion_curvature_radius[1] == pytest.approx(high, rel=1e-14)
    assert contact.wheel_curvature_radius[0] == pytest.approx(length - low, rel=1e-14)
    assert low < contact.pinion_curvature_radius[0] < low + off
    assert length - high < contact.wheel_curvature_radius[1]


def test_curvature_of_the_mate_is_that_of_the_touching_point() -> None:
    pair = spur_pair(**FZG_C)
    _, high = pair.path_limits
    path = high + 0.1 * pair.base_pitch
    angle = (path - high) / pair.pinion.base_radius
    corner = turned(np.array([[high], [pair.pinion.base_radius]]), -angle)
    across = pair.pinion.base_radius + pair.wheel.base_radius
    radius = math.hypot(corner[0, 0] - pair.line_of_action_length, corner[1, 0] - across)
    expected = math.sqrt(radius**2 - pair.wheel.base_radius**2)
    mate_radius = float(extended_contact(pair, path).wheel_curvature_radius)
    assert mate_radius == pytest.approx(expected, rel=1e-12)


def test_driver_does_not_matter() -> None:
    pinion, wheel = (spur_pair(**FZG_A, driver=driver) for driver in ("pinion", "wheel"))
    path = np.linspace(-0.002, 0.04, 40)
    for distance, other in zip(
        extended_contact(pinion, path), extended_contact(wheel, path), strict=True
    ):
        assert np.array_equal(distance, other)


def test_equal_gears_are_symmetric_at_both_ends() -> None:
    pair = spur_pair(
        pinion_teeth=25, wheel_teeth=25, normal_module=4e-3,
        normal_pressure_angle=math.radians(20.0), pinion_face_width=20e-3,
    )  # fmt: skip
    path = np.linspace(-0.01, 0.05, 61)
    contact = extended_contact(pair, path)
    other = extended_contact(pair, pair.line_of_action_length - path)
    finite = np.isfinite(contact.separation)
    assert np.array_equal(finite, np.isfinite(other.separation))
    assert contact.separation[finite] == pytest.approx(
        other.separation[finite], rel=1e-9, abs=1e-17
    )


def test_far_beyond_the_ends_nothing_can_touch() -> None:
    pair = spur_pair(**FZG_A)
    low, high = pair.path_limits
    contact = extended_contact(pair, [low - 2.0 * pair.base_pitch, high + 2.0 * pair.base_pitch])
    assert not np.any(contact.possible)
    assert np.all(np.isinf(contact.separation))


def test_a_corner_that_would_meet_the_fillet_is_impossible() -> None:
    """With the pitch point beyond the end the corner first moves down the flank of its mate."""
    rack = BasicRack(1.0, 1.13, 0.2)
    pair = spur_pair(
        pinion_teeth=50, wheel_teeth=60, normal_module=4e-3,
        normal_pressure_angle=math.radians(20.0), pinion_profile_shift_coefficient=-1.3,
        wheel_profile_shift_coefficient=1.3, pinion_face_width=20e-3, pinion_rack=rack,
        wheel_rack=rack,
    )  # fmt: skip
    _, high = pair.path_limits
    contact = extended_contact(pair, high + pair.base_pitch * np.linspace(0.0, 1.0, 101))
    form = pair.wheel.roll_angle(pair.wheel.form_radius) * pair.wheel.base_radius
    assert np.any(contact.wheel_curvature_radius < form)
    assert np.array_equal(contact.possible, contact.wheel_curvature_radius >= form - 1e-6 * 4e-3)
    assert np.array_equal(contact.possible, np.isfinite(contact.separation))


@pytest.mark.parametrize("path", [math.nan, math.inf])
def test_a_position_is_finite(path: float) -> None:
    with pytest.raises(InputError, match="path"):
        extended_contact(spur_pair(**FZG_A), path)


RINGS: dict[str, dict[str, Any]] = {
    "spur": {"pinion_teeth": 22, "wheel_teeth": -61, "helix_angle": 0.0},
    "helical": {
        "pinion_teeth": 21,
        "wheel_teeth": -72,
        "helix_angle": math.radians(15.0),
        "pinion_profile_shift_coefficient": 0.2,
        "wheel_profile_shift_coefficient": -0.1,
    },
}


def ring_rotation_to_touch(pair: SpurPair, path: float) -> float:
    """The same as :func:`rotation_to_touch` for a ring, whose tooth stands above the pinion's."""
    base1, base2 = pair.pinion.base_radius, pair.wheel.base_radius
    length = pair.line_of_action_length
    centre = np.array([[length], [base1 - base2]])
    half_angle = pair.pinion.base_half_angle - (path / base1 - math.atan(path / base1))
    placed1 = turned(flank_points(pair.pinion), half_angle - math.atan(path / base1))
    reach = path - length
    half_angle = pair.wheel.base_half_angle + (reach / base2 - math.atan(reach / base2))
    left = flank_points(pair.wheel) * np.array([[-1.0], [1.0]])
    placed2 = turned(left[:, ::-1], -half_angle - math.atan(reach / base2))
    about = placed1 - centre
    radius1, angle1 = np.hypot(*about), np.arctan2(*about)
    radius2, angle2 = np.hypot(*placed2), np.arctan2(*placed2)
    inside = (radius1 >= radius2.min()) & (radius1 <= radius2.max())
    gaps = np.interp(radius1[inside], radius2, angle2) - angle1[inside]
    at_pinion = placed2 + centre
    radius, angle = np.hypot(*at_pinion), np.arctan2(*at_pinion)
    own_radius, own_angle = np.hypot(*placed1), np.arctan2(*placed1)
    common = (radius >= own_radius.min()) & (radius <= own_radius.max())
    back = angle[common] - np.interp(radius[common], own_radius, own_angle)
    return min(float(gaps.min()) * base2, float(back.min()) * base1)


@pytest.mark.parametrize("name", RINGS)
@pytest.mark.parametrize("pitches", [0.05, 0.15])
def test_outlines_of_an_internal_pair_meet_at_the_separation(name: str, pitches: float) -> None:
    common = {"normal_module": 4e-3, "normal_pressure_angle": math.radians(20.0)}
    pair = cylindrical_pair(**common, **RINGS[name], pinion_face_width=20e-3)
    path = pair.path_limits[1] + pitches * pair.base_pitch
    contact = extended_contact(pair, path)
    assert bool(contact.possible)
    assert float(contact.wheel_curvature_radius) < 0.0
    expected = ring_rotation_to_touch(pair, path)
    assert float(contact.separation) == pytest.approx(expected, rel=2e-3, abs=2e-8)
    # Before the path the ring's tip would meet the pinion's fillet or nothing.
    assert not bool(extended_contact(pair, pair.path_limits[0] - 1e-4).possible)
    # A ring that is cut short touches early with its corner.
    short = replace(pair, wheel=replace(pair.wheel, tip_diameter=pair.wheel.tip_diameter + 4e-3))
    path = short.path_limits[0] - pitches * pair.base_pitch
    early = extended_contact(short, path)
    assert bool(early.possible)
    assert float(early.separation) == pytest.approx(
        ring_rotation_to_touch(short, path), rel=2e-3, abs=2e-8
    )
