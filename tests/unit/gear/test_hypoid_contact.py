"""Tooth contact of hypoid pairs: exact and by the ease-off, misaligned, its lines and pattern."""

import math

import numpy as np
import pytest

from known_hypoids import eased, h1043, random_blanks
from tribodyn.errors import InputError
from tribodyn.gear import EaseOff, Misalignment, hypoid_blank, hypoid_flanks, tooth_contact
from tribodyn.gear.hypoid.conjugate import ContactLines
from tribodyn.gear.hypoid.flank import SIDES
from tribodyn.gear.hypoid.tooth_contact import exact_contact, lightest, start_values

NONE = Misalignment()


def _eased(along=1e-4, across=3e-4, twist=0.5e-4, scale=1.0, side="drive", **more):
    return eased(h1043(**more), side, along, across, twist, scale)


def _linear_and_exact(flanks, rotation, misalignment=NONE):
    """Lag to first order and exact contact at rotations of the wheel."""
    lines = ContactLines(flanks.conjugate)
    ends, valid = lines.ends(rotation)
    assert valid.all()
    station, lag, edge = lightest(lines, rotation, ends, misalignment)
    assert not edge.any()
    guess = start_values(lines, rotation, station, lag)
    turn = rotation / flanks.conjugate.axes.ratio
    return lag, exact_contact(flanks.conjugate, turn, guess, misalignment)


def _from_design_point(flanks, turns):
    start = flanks.conjugate.touch(np.array([[0.0, -2.2e-3]])).contact.rotation[0]
    return start + flanks.conjugate.axes.ratio * np.asarray(turns)


def _ahead(flanks, contact, rotation):
    return flanks.conjugate.sense * (contact.wheel_rotation - rotation)


def test_exact_contact_of_ten_against_43():
    flanks = _eased()
    rotation = _from_design_point(flanks, [-0.3, -0.2, -0.1, 0.1, 0.2, 0.3])
    lag, contact = _linear_and_exact(flanks, rotation)
    expected = [-45.9816, -20.0019, -4.8911, -4.6690, -18.2226, -39.9623]
    assert 1e6 * _ahead(flanks, contact, rotation) == pytest.approx(expected, abs=6e-5)
    assert 1e3 * contact.places[:, 0] == pytest.approx(
        [-3.818, -2.467, -1.191, 1.099, 2.097, 2.984], abs=6e-4
    )
    assert 1e3 * contact.places[:, 1] == pytest.approx(
        [-5.341, -4.310, -3.262, -1.123, -0.032, 1.072], abs=6e-4
    )
    assert contact.residual.max() < 1e-14
    assert -1e6 * lag == pytest.approx(expected, rel=8e-3)


def test_first_order_theory_errs_in_proportion_to_the_ease_off():
    errors = []
    for scale in (1.0, 0.1, 0.01):
        flanks = _eased(scale=scale)
        rotation = _from_design_point(flanks, [-0.25, -0.1, 0.15, 0.3])
        lag, contact = _linear_and_exact(flanks, rotation)
        errors.append(np.max(np.abs(lag / -_ahead(flanks, contact, rotation) - 1.0)))
    assert errors[0] < 9e-3
    assert errors[0] / errors[1] == pytest.approx(10.0, rel=0.05)
    assert errors[1] / errors[2] == pytest.approx(10.0, rel=0.05)


def test_curvature_of_the_transmission_error_at_the_design_point():
    # -1 / (lever g H^-1 g), with g the slope of the rotation and H that of the ease-off.
    flanks = _eased(scale=0.1)
    step = 1e-3
    rotation = _from_design_point(flanks, [0.0]) + step * np.array([-1.0, 0.0, 1.0])
    _, contact = _linear_and_exact(flanks, rotation)
    bent = np.diff(_ahead(flanks, contact, rotation), 2)[0] / step**2
    conjugate = flanks.conjugate
    place = np.array([[0.0, -2.2e-3]])
    touch = conjugate.touch(place)
    neighbours = place + 1e-6 * np.array([[[1.0, 0.0], [0.0, 1.0]], [[-1.0, 0.0], [0.0, -1.0]]])
    turns = conjugate.touch(neighbours).contact.rotation
    slope = (turns[0] - turns[1]) / 2e-6
    hessian = 1e2 * np.array([[2e-4, 0.5e-4], [0.5e-4, 6e-4]])
    wanted = -1.0 / (touch.lever[0] * slope @ np.linalg.inv(hessian) @ slope)
    assert bent == pytest.approx(wanted, rel=1e-3)
    assert bent == pytest.approx(-1.7773e-3, abs=6e-8)
    assert wanted == pytest.approx(-1.77839e-3, rel=1e-4)


def test_the_exact_ratio_is_that_of_the_moment_arms():
    flanks = _eased(scale=3.0)
    step = 2e-3
    middle = _from_design_point(flanks, [-0.2, 0.0, 0.25])
    misaligned = Misalignment(offset=30e-6, pinion_axial=-20e-6, wheel_axial=40e-6)
    turns = [
        _linear_and_exact(flanks, middle + k * step * flanks.conjugate.axes.ratio, misaligned)[1]
        for k in (-2, -1, 0, 1, 2)
    ]
    rotations = [each.wheel_rotation for each in turns]
    slope = (rotations[0] - 8 * rotations[1] + 8 * rotations[3] - rotations[4]) / (12 * step)
    contact = turns[2]
    origin = flanks.conjugate.axes.origin - [30e-6, 0.0, 0.0]
    pinion = np.cross(contact.position - origin, contact.normal)[:, 1]
    wheel = -np.cross(contact.position, contact.normal)[:, 2]
    assert slope == pytest.approx(pinion / wheel, rel=1e-8)


@pytest.mark.slow
def test_conjugate_flanks_have_no_transmission_error():
    for blank in random_blanks(3):
        for side in SIDES:
            flanks = hypoid_flanks(blank, side, points=9)
            contact = tooth_contact(flanks, rotations_per_pitch=6, cells=9)
            assert np.all(contact.angular_transmission_error == 0.0)
            assert contact.contact_ratio > 1.0
            # The exact flanks, started near their contact, come to the same rotation.
            lines = ContactLines(flanks.conjugate)
            rotation = 0.3 * np.array(lines.span)
            ends, _ = lines.ends(rotation)
            guess = start_values(lines, rotation, ends.mean(axis=1), np.zeros(2))
            guess += [20e-6, 2e-4, -30e-6, 3e-4, 1e-5]
            turn = rotation / flanks.conjugate.axes.ratio
            exact = exact_contact(flanks.conjugate, turn, guess, NONE)
            assert np.abs(exact.wheel_rotation - rotation).max() < 1e-12


def test_lines_end_on_the_flanks_and_are_recovered():
    flanks = _eased()
    lines = ContactLines(flanks.conjugate)
    low, high = lines.span
    rotation = np.linspace(low, high, 30)[1:-1]
    ends, valid = lines.ends(rotation)
    assert valid.all()
    touch = lines.touch(rotation[:, None], ends)
    assert np.abs(touch.contact.rotation - rotation[:, None]).max() < 1e-12
    assert np.abs(np.min(flanks.conjugate.margins(touch), axis=-1)).max() < 1e-12
    inside = lines.touch(rotation[:, None], ends @ [[0.99, 0.01], [0.01, 0.99]])
    assert flanks.conjugate.margins(inside).min() > 0.0
    # No point of the flank touches before the first or after the last rotation.
    fine = hypoid_flanks(flanks.blank, points=201)
    touched = fine.wheel_rotation[fine.active]
    assert low <= touched.min() < low + 0.004
    assert high - 0.004 < touched.max() <= high


def test_the_shortest_lines_are_computed():
    # At both ends of the contact lines shrink to a point; those of a hundredth of a millimetre too.
    for flanks in (_eased(), _eased(side="coast", hand_pinion="right")):
        lines = ContactLines(flanks.conjugate)
        low, high = lines.span
        inner = np.array([1e-5, 1e-4, 1e-3]) * (high - low)
        ends, valid = lines.ends(np.concatenate([low + inner, high - inner]))
        assert valid.all()
        lengths = np.ptp(ends, axis=1).reshape(2, 3)
        assert np.all(np.diff(lengths, axis=1) > 0.0)
        assert lengths[:, 0].max() < 5e-5


def test_lines_have_the_curvature_of_the_ease_off_across_their_ends():
    flanks = _eased()
    contact = tooth_contact(flanks, marking_thickness=1e-6, rotations_per_pitch=6, cells=401)
    for number in np.flatnonzero(contact.leads & ~contact.on_edge):
        touching = contact.clearance[number] <= 1e-6
        share = touching.mean() * contact.line_length[number]
        assert share == pytest.approx(2.0 * contact.semi_axes[number, 0], rel=0.025)
    across = contact.semi_axes[contact.leads, 1]
    assert np.all(across < 0.1 * contact.semi_axes[contact.leads, 0])


def test_clearance_is_nowhere_negative_and_zero_at_the_contact():
    contact = tooth_contact(_eased(), Misalignment(offset=40e-6), cells=201)
    assert contact.clearance.min() > -1e-15
    assert np.all(contact.clearance.min(axis=1) < 3e-9)
    assert np.all(contact.marked == (contact.clearance <= 6.35e-6))


@pytest.mark.parametrize(
    "change",
    [
        {"offset": 20e-6},
        {"pinion_axial": 20e-6},
        {"wheel_axial": -20e-6},
        {"shaft_angle": 1e-4},
    ],
)
def test_misaligned_contact_agrees_with_the_surfaces(change):
    flanks = _eased()
    misaligned = Misalignment(**change)
    first = tooth_contact(flanks, misaligned, rotations_per_pitch=6, cells=9)
    exact = tooth_contact(flanks, misaligned, exact=True, rotations_per_pitch=6, cells=9)
    inner = first.leads & ~first.on_edge
    assert inner.sum() >= 5
    change = np.abs(first.angular_transmission_error - exact.angular_transmission_error)[
        inner
    ].max()
    moved = np.abs(
        tooth_contact(flanks, rotations_per_pitch=6, cells=9).angular_transmission_error
        - first.angular_transmission_error
    )
    assert change < 0.02 * moved[inner].max()


@pytest.mark.slow
def test_a_pair_of_the_other_hand_and_the_coast_side():
    for side in SIDES:
        left, right = (
            tooth_contact(
                _eased(side=side, hand_pinion=hand),
                Misalignment(offset=20e-6, shaft_angle=1e-4, pinion_axial=-10e-6),
                exact=True,
                rotations_per_pitch=6,
                cells=9,
            )
            for hand in ("left", "right")
        )
        assert left.rotation == pytest.approx(right.rotation, abs=1e-12)
        assert left.angular_transmission_error == pytest.approx(
            right.angular_transmission_error, abs=1e-11
        )
        assert left.position * [-1.0, 1.0, 1.0] == pytest.approx(right.position, abs=1e-9)


def test_a_spiral_bevel_pair_touches_too():
    blank = hypoid_blank(14, 39, 0.0, 0.176893, 0.0254, math.radians(35.0), 0.1143)
    ease = EaseOff(lengthwise_crowning=20e-6, profile_crowning=8e-6)
    first, exact = (
        tooth_contact(hypoid_flanks(blank, "drive", ease), exact=each, rotations_per_pitch=6)
        for each in (False, True)
    )
    assert 1.5 < first.contact_ratio < 4.0
    assert exact.peak_to_peak == pytest.approx(first.peak_to_peak, rel=0.05)


def test_wrong_arguments_are_refused():
    flanks = _eased()
    for change in (
        {"flanks": h1043()}, {"misalignment": 1e-3}, {"exact": "yes"}, {"marking_thickness": 0.0},
        {"marking_thickness": 1.0}, {"rotations_per_pitch": 3}, {"cells": 2.5}, {"cells": 10**6},
    ):  # fmt: skip
        with pytest.raises(InputError):
            tooth_contact(**({"flanks": flanks} | change))
    for change in ({"offset": 1.0}, {"shaft_angle": math.nan}, {"pinion_axial": "0.1 mm"}):
        with pytest.raises(InputError):
            Misalignment(**change)
