"""Motion in the contact of hypoid pairs: sliding, entrainment, levers."""

import math

import numpy as np
import pytest

from known_hypoids import h1043, random_blanks
from tribodyn.errors import InputError
from tribodyn.gear import hypoid_blank, hypoid_flanks, hypoid_kinematics, tooth_contact
from tribodyn.gear.hypoid.flank import SIDES

SPEED = 3000.0 * math.pi / 30.0


def _contact(blank, side="drive"):
    return tooth_contact(hypoid_flanks(blank, side, points=9), rotations_per_pitch=8, cells=15)


@pytest.fixture(scope="module")
def motion():
    return hypoid_kinematics(_contact(h1043()), SPEED)


def _touch(motion):
    contact = motion.contact
    places = np.stack([contact.cell_along, contact.cell_across], axis=-1)
    return contact.flanks.conjugate.touch(places)


@pytest.mark.parametrize("side", SIDES)
def test_the_line_moves_over_the_pinion_as_the_pinion_rolls_through_it(side):
    # The speed over the pinion follows from its own tangents, and from that over the wheel and the
    # sliding: two ways to one figure.
    for blank in [h1043(), h1043(hand_pinion="right"), *random_blanks(2)]:
        motion = hypoid_kinematics(_contact(blank, side), SPEED)
        touch = _touch(motion)
        contact, across = touch.contact, touch.curvature.across
        basis = np.stack([touch.curvature.line, across], axis=-2)
        inverse = np.linalg.inv(basis @ contact.pinion.tangents)
        gradient = np.einsum("...i,...i->...", contact.slope, inverse[..., 1])
        conjugate = motion.contact.flanks.conjugate
        speed = -conjugate.sense * SPEED * conjugate.axes.ratio / gradient
        assert motion.pinion_rolling_speed == pytest.approx(speed, rel=1e-9)
        difference = motion.pinion_rolling_speed - motion.wheel_rolling_speed
        slip = np.einsum("...i,...i->...", motion.sliding_velocity, across)
        assert difference == pytest.approx(slip, abs=1e-12)


def test_sliding_and_entrainment_of_ten_against_43(motion):
    # At the calculation point the pinion slides by 10.211 mm per radian of its rotation.
    number = int(np.argmin(np.abs(motion.rotation)))
    nearest = np.argmin(
        np.hypot(motion.contact.cell_along[number], motion.contact.cell_across[number])
    )
    assert motion.sliding_speed[number, nearest] == pytest.approx(SPEED * 10.211e-3, rel=0.05)
    # Loaded parts of the flank have 3.5 to 8.9 m/s, in the fixed frame 6.2 to 10.8 m/s;
    # they slide by 0.59 to 1.08 of it. The corners of the flank go somewhat beyond.
    fixed = hypoid_kinematics(motion.contact, SPEED, entrainment="fixed_frame")
    for speed, (low, high) in (
        (motion.entrainment_speed, (3.5, 8.9)),
        (fixed.entrainment_speed, (6.2, 10.8)),
        (motion.slide_to_roll_ratio, (0.59, 1.08)),
    ):
        assert 0.8 * low < speed.min() < 1.02 * low
        assert 0.98 * high < speed.max() < 1.25 * high
    assert np.all(fixed.sliding_velocity == motion.sliding_velocity)


def test_friction_takes_power(motion):
    power = np.einsum("...i,...i->...", motion.friction_direction, motion.sliding_velocity)
    assert power == pytest.approx(-motion.sliding_speed)
    assert np.linalg.norm(motion.friction_direction, axis=-1) == pytest.approx(1.0)


def test_levers_have_the_ratio_of_the_teeth(motion):
    # Conjugate normals carry the ratio in every cell.
    pinion, wheel = motion.pinion_lever[..., 1], motion.wheel_lever[..., 2]
    assert np.abs(pinion / wheel) == pytest.approx(10 / 43, rel=1e-12)


def test_surfaces_of_a_bevel_pair_roll_at_the_calculation_point():
    blank = hypoid_blank(14, 39, 0.0, 0.176893, 0.0254, math.radians(35.0), 0.1143)
    contact = _contact(blank)
    motion = hypoid_kinematics(contact, SPEED)
    touch = contact.flanks.conjugate.touch(np.zeros((1, 2)))
    assert np.linalg.norm(touch.sliding) < 1e-15
    assert motion.sliding_speed.min() < 0.1 * motion.sliding_speed.max()
    assert np.all(np.isfinite(motion.friction_direction))


def test_everything_goes_with_the_speed(motion):
    twice = hypoid_kinematics(motion.contact, 2.0 * SPEED)
    assert twice.entrainment_speed == pytest.approx(2.0 * motion.entrainment_speed)
    assert twice.sliding_velocity == pytest.approx(2.0 * motion.sliding_velocity)
    assert twice.slide_to_roll_ratio == pytest.approx(motion.slide_to_roll_ratio)
    assert twice.equivalent_radius == pytest.approx(motion.equivalent_radius)


def test_wrong_arguments_are_refused(motion):
    for change in ({"contact": 1.0}, {"pinion_speed": 0.0}, {"pinion_speed": "3000 rpm"},
                   {"pinion_speed": 1e9}, {"entrainment": "moving"}):  # fmt: skip
        with pytest.raises(InputError):
            hypoid_kinematics(**({"contact": motion.contact, "pinion_speed": SPEED} | change))
