"""Identities that hold for every feasible pair."""

import math
import warnings
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, assume, given, settings
from hypothesis import strategies as st

from tribodyn.contact import extended_contact, path_of_contact
from tribodyn.errors import InputError, ModelWarning
from tribodyn.gear import (
    FlankModification,
    SpurPair,
    flank_gap,
    flank_ranges,
    half_tooth,
    mass_properties,
    spur_pair,
    tooth_outline,
)
from tribodyn.gear.curves import involute

FEW = settings(max_examples=40, deadline=None, suppress_health_check=[HealthCheck.filter_too_much])


@st.composite
def pairs(draw: st.DrawFn) -> SpurPair:
    teeth = sorted((draw(st.integers(8, 120)), draw(st.integers(8, 120))))
    figures: dict[str, Any] = {
        "pinion_teeth": teeth[0],
        "wheel_teeth": teeth[1],
        "normal_module": draw(st.floats(0.5e-3, 20e-3)),
        "normal_pressure_angle": math.radians(draw(st.floats(17.0, 27.0))),
        "pinion_profile_shift_coefficient": draw(st.floats(-0.2, 0.8)),
        "wheel_profile_shift_coefficient": draw(st.floats(-0.6, 0.8)),
        "pinion_face_width": 20e-3,
        "driver": draw(st.sampled_from(["pinion", "wheel"])),
        "backlash": draw(st.none() | st.floats(0.0, 50e-6)),
    }
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)
        try:
            return spur_pair(**figures)
        except InputError:
            assume(False)
            raise


@FEW
@given(pairs(), st.floats(0.0, 1.0))
def test_curvature_radii_add_up_to_the_line_of_action(pair: SpurPair, place: float) -> None:
    contact = path_of_contact(pair)
    path = contact.A + place * (contact.E - contact.A)
    motion = contact.kinematics(path, 100.0)
    total = motion.pinion_curvature_radius + motion.wheel_curvature_radius
    along = pair.center_distance * math.sin(pair.operating_pressure_angle)
    assert total == pytest.approx(along, rel=1e-13)
    # The contact point lies where each involute has this radius of curvature.
    for gear, radius in (
        (pair.pinion, motion.pinion_curvature_radius),
        (pair.wheel, motion.wheel_curvature_radius),
    ):
        assert gear.form_radius <= math.hypot(gear.base_radius, float(radius)) * (1.0 + 1e-6)


@FEW
@given(pairs())
def test_flanks_roll_at_the_pitch_point(pair: SpurPair) -> None:
    contact = path_of_contact(pair)
    motion = contact.kinematics(contact.C, 100.0)
    assert motion.pinion_surface_speed == pytest.approx(
        float(motion.wheel_surface_speed), rel=1e-13
    )
    assert motion.sliding_speed == 0.0
    speed = 100.0 * pair.pinion.base_radius * math.tan(pair.operating_pressure_angle)
    assert motion.entrainment_speed == pytest.approx(speed, rel=1e-12)


@FEW
@given(pairs())
def test_contact_ratio_from_roll_angles_equals_the_closed_form(pair: SpurPair) -> None:
    angles = path_of_contact(pair).roll_angles
    rolled = (angles["E"] - angles["A"]) * pair.driving.teeth / (2.0 * math.pi)
    reach = sum(
        math.sqrt(gear.tip_radius**2 - gear.base_radius**2) for gear in (pair.pinion, pair.wheel)
    )
    length = reach - pair.center_distance * math.sin(pair.operating_pressure_angle)
    assert rolled == pytest.approx(length / pair.base_pitch, rel=1e-11)
    assert pair.transverse_contact_ratio == pytest.approx(rolled, rel=1e-11)


@FEW
@given(pairs())
def test_play_from_thicknesses_equals_play_from_angles(pair: SpurPair) -> None:
    """j = 2 a_0 cos(alpha) (inv alpha_wt - inv alpha) - 2 (x_1 + x_2) m sin(alpha) + thinning."""
    alpha, module = pair.pinion.normal_pressure_angle, pair.pinion.normal_module
    gears = (pair.pinion, pair.wheel)
    spread = involute(pair.operating_pressure_angle) - involute(alpha)
    shifts = sum(gear.profile_shift_coefficient for gear in gears)
    bases = sum(gear.base_radius for gear in gears)
    play = 2.0 * bases * spread - 2.0 * shifts * module * math.sin(alpha)
    play += sum(gear.tooth_thinning for gear in gears)
    assert pair.geometric_backlash == pytest.approx(play, abs=1e-11 * module)


@FEW
@given(pairs())
def test_tooth_is_symmetric_and_has_the_thickness_of_its_shift(pair: SpurPair) -> None:
    for gear in (pair.pinion, pair.wheel):
        outline = tooth_outline(gear, 100)
        assert np.array_equal(outline[0], -outline[0][::-1])
        assert np.array_equal(outline[1], outline[1][::-1])
        alpha, module = gear.normal_pressure_angle, gear.normal_module
        thickness = module * (
            math.pi / 2.0 + 2.0 * gear.profile_shift_coefficient * math.tan(alpha)
        ) - gear.tooth_thinning / math.cos(alpha)
        measured = gear.tooth_thickness(gear.reference_radius)
        assert measured == pytest.approx(thickness, rel=1e-12)


@FEW
@given(pairs())
def test_half_tooth_is_a_graph_over_its_height(pair: SpurPair) -> None:
    for gear in (pair.pinion, pair.wheel):
        height, half_thickness = half_tooth(gear, 80)
        assert np.all(np.diff(height) > 0.0)
        assert np.all(half_thickness > 0.0)
        tip = gear.tip_radius * math.sin(gear.half_tooth_angle(gear.tip_radius))
        assert half_thickness[-1] == pytest.approx(tip, rel=1e-9)


@FEW
@given(pairs())
def test_solid_lies_between_root_and_tip_cylinder(pair: SpurPair) -> None:
    for gear in (pair.pinion, pair.wheel):
        solid = mass_properties(gear, 1.0)
        low, high = (
            math.pi * radius**2 * gear.face_width for radius in (gear.root_radius, gear.tip_radius)
        )
        assert low < solid.mass < high
        gyration = math.sqrt(2.0 * solid.moment_of_inertia / solid.mass)
        assert gear.root_radius < gyration < gear.tip_radius


@FEW
@given(pairs())
def test_separation_begins_with_the_relative_curvature(pair: SpurPair) -> None:
    """gap = rho L x^2 / (2 r_b^2 rho_mate): rho and r_b of the gear whose corner it is."""
    length, (low, high) = pair.line_of_action_length, pair.path_limits
    ends = ((high, 1.0, high, pair.pinion), (low, -1.0, length - low, pair.wheel))
    for end, sense, tip, gear in ends:
        mate = length - tip
        assume(mate > 0.05 * pair.base_pitch)
        off = 1e-3 * min(mate, tip)
        contact = extended_contact(pair, end + sense * off)
        expected = tip * length * off**2 / (2.0 * gear.base_radius**2 * mate)
        if bool(contact.possible):
            assert float(contact.separation) == pytest.approx(expected, rel=0.02)


@FEW
@given(pairs())
def test_separation_grows_away_from_the_path_of_contact(pair: SpurPair) -> None:
    low, high = pair.path_limits
    off = pair.base_pitch * np.linspace(0.0, 0.3, 31)
    for path in (high + off, low - off):
        contact = extended_contact(pair, path)
        assert np.all(np.diff(contact.separation[contact.possible]) > 0.0)


@FEW
@given(pairs(), st.floats(0.0, 100e-6), st.floats(0.0, 100e-6), st.floats(0.0, 1.0))
def test_gaps_of_both_gears_add(pair: SpurPair, tip: float, root: float, place: float) -> None:
    wheel_modification = FlankModification(
        tip_relief=tip, root_relief=root, profile_crowning=-0.5 * tip
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)
        pinion = replace(pair, pinion=replace(pair.pinion, modification=wheel_modification))
        wheel = replace(pair, wheel=replace(pair.wheel, modification=wheel_modification))
        modified = replace(pinion, wheel=wheel.wheel)
    low, high = pair.path_limits
    path = low + place * (high - low)
    radii = (path, pair.line_of_action_length - path)
    total = float(flank_gap(pinion, *radii) + flank_gap(wheel, *radii))
    assert float(flank_gap(modified, *radii)) == pytest.approx(total, abs=1e-18)
    assert float(flank_gap(pair, *radii)) == 0.0
    ends = flank_ranges(pair)[0]
    assert ends.lowest - 1e-12 <= radii[0] <= ends.highest + 1e-12
