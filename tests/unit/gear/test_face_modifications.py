"""End relief and twist of a flank: gaps by hand, and what they do to a loaded mesh."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from tribodyn.errors import InputError
from tribodyn.gear import FlankModification, cylindrical_pair, flank_gap
from tribodyn.stiffness import loaded_contact


def pair_with(**modification):
    return cylindrical_pair(
        pinion_teeth=27,
        wheel_teeth=51,
        normal_module=4.5e-3,
        normal_pressure_angle=math.radians(20.0),
        helix_angle=math.radians(21.0),
        pinion_face_width=50e-3,
        pinion_modification=FlankModification(**modification),
    )


def test_end_relief_by_hand():
    pair = pair_with(end_relief=12e-6, end_relief_length=10e-3)
    low, high = pair.path_limits
    face = np.array([-25e-3, -20e-3, -15e-3, 0.0, 22.5e-3, 25e-3])
    middle = 0.5 * (low + high)
    gap = flank_gap(pair, middle, pair.line_of_action_length - middle, face)
    assert gap == pytest.approx(np.array([12.0, 6.0, 0.0, 0.0, 9.0, 12.0]) * 1e-6, abs=1e-18)
    parabolic = pair_with(end_relief=12e-6, end_relief_length=10e-3, end_relief_shape="parabolic")
    gap = flank_gap(parabolic, middle, parabolic.line_of_action_length - middle, face)
    assert gap[1] == pytest.approx(3e-6)
    usual = pair_with(end_relief=12e-6)
    gap = flank_gap(usual, middle, usual.line_of_action_length - middle, np.array([20e-3, 22.5e-3]))
    assert gap == pytest.approx([0.0, 6e-6], abs=1e-12)


def test_twist_is_the_slope_at_the_tip_less_that_at_the_root():
    pair = pair_with(flank_twist=10e-6)
    low, high = pair.path_limits
    slopes = []
    for path in (low, high):
        ends = flank_gap(pair, path, pair.line_of_action_length - path, np.array([-25e-3, 25e-3]))
        slopes.append(ends[1] - ends[0])
    assert slopes[1] - slopes[0] == pytest.approx(10e-6)
    assert slopes[0] == pytest.approx(-slopes[1])
    assert pair.has_profile_modification
    assert pair.has_lead_modification


def test_end_relief_takes_load_from_the_ends_of_the_face():
    plain, relieved = pair_with(), pair_with(end_relief=20e-6, end_relief_length=8e-3)
    loads = [
        loaded_contact(pair, 600.0, phases=16, reference="rim").load_per_width
        for pair in (plain, relieved)
    ]
    ends = [load.sum(axis=(0, 2))[[0, -1]] for load in loads]
    assert np.all(ends[1] < 0.6 * ends[0])
    total = [load.sum() for load in loads]
    assert total[1] == pytest.approx(total[0], rel=2e-2)


def test_a_relief_longer_than_half_the_face_is_refused():
    with pytest.raises(InputError, match=r"end_relief_length = 26 mm of the pinion.*25 mm"):
        pair_with(end_relief=10e-6, end_relief_length=26e-3)
    with pytest.raises(InputError, match="end_relief = -1 um"):
        FlankModification(end_relief=-1e-6)
    with pytest.raises(InputError, match='end_relief_shape = "round"'):
        replace(FlankModification(), end_relief_shape="round")
