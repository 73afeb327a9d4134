"""The outline against brute force: the generating rack rolled over it in many steps."""

import math

import numpy as np
import pytest
from numpy.typing import NDArray

from tribodyn.gear import BasicRack, ToothForm, half_tooth, tooth_outline

Array = NDArray[np.float64]


def distance_to_rack_tooth(form: ToothForm, x: Array, depth: Array) -> Array:
    """Signed distance to the rack tooth that cuts a space: positive outside, exact outside."""
    angle, module = form.normal_pressure_angle, form.normal_module
    rounding = form.rack.fitting_tip_radius_coefficient(angle) * module
    dedendum = form.rack.dedendum_coefficient * module
    corner_depth = dedendum - rounding
    width = math.pi / 4.0 * module - dedendum * math.tan(angle)
    corner_x = width - rounding * (1.0 - math.sin(angle)) / math.cos(angle)
    # The rack is straight: its normal section is its transverse one, narrower by the helix angle.
    dx, dy = np.abs(x) * math.cos(form.helix_angle) - corner_x, depth - corner_depth
    along_flank = dx * math.sin(angle) - dy * math.cos(angle)
    to_flank = dx * math.cos(angle) + dy * math.sin(angle)
    around_corner = (dx > 0.0) & (along_flank < 0.0)
    flat = np.where(dx <= 0.0, np.maximum(dy, to_flank), to_flank)
    return np.where(around_corner, np.hypot(dx, dy), flat) - rounding


def approach(form: ToothForm, x: float, y: float, rolled: Array) -> Array:
    """Distance of one point of the gear from the rack at positions of the rack."""
    turn = rolled / form.reference_radius
    x_space = x * np.cos(turn) + y * np.sin(turn)
    y_space = y * np.cos(turn) - x * np.sin(turn)
    shift = form.generating_shift_coefficient * form.normal_module
    return distance_to_rack_tooth(form, x_space - rolled, form.reference_radius + shift - y_space)


def closest_approach(form: ToothForm, points: Array) -> Array:
    """Smallest distance of each point of the gear from the rack while it rolls by."""
    coarse = np.linspace(-15.0, 15.0, 6001) * form.normal_module
    window = np.linspace(-1.0, 1.0, 401) * (coarse[1] - coarse[0])
    nearest = []
    for x, y in points.T:
        best = coarse[approach(form, x, y, coarse).argmin()]
        nearest.append(approach(form, x, y, best + window).min())
    return np.array(nearest)


ROUGH = BasicRack(1.0, 1.25, 0.25)
CASES = {
    "FZG-A pinion": (16, 20.0, 0.8635, 88.593 / 4.5, BasicRack(), 0.0),
    "FZG-A wheel, slightly undercut": (24, 20.0, -0.5103, 112.228 / 4.5, BasicRack(), 0.0),
    "strongly undercut": (10, 20.0, 0.0, 12.0, BasicRack(), 0.0),
    "undercut by a sharp rack": (12, 20.0, -0.1, 13.8, BasicRack(1.0, 1.25, 0.0), 0.0),
    "few teeth": (5, 20.0, 0.7, 8.0, ROUGH, 0.0),
    "many teeth": (500, 20.0, 0.3, 502.6, BasicRack(), 0.0),
    "low pressure angle": (80, 10.0, 0.0, 82.0, ROUGH, 0.0),
    "high pressure angle": (14, 30.0, 0.0, 16.0, ROUGH, 0.0),
    "tip round centred above the reference circle": (20, 20.0, 1.2, 24.0, BasicRack(), 0.0),
    "tip round centred on the reference circle": (20, 20.0, 0.87, 23.5, BasicRack(), 0.0),
    "full round": (20, 20.0, 0.0, 22.0, BasicRack(1.0, 1.4, 0.5), 0.0),
    "thinned": (20, 20.0, 0.0, 22.0, BasicRack(), 0.1),
    "helical": (27, 20.0, 0.2, 31.2, BasicRack(), 0.0),
    "helical, undercut and thinned": (8, 20.0, 0.0, 12.2, BasicRack(), 0.03),
}
HELIX = {"helical": 21.0, "helical, undercut and thinned": 35.0}


def form_of(case: str) -> ToothForm:
    teeth, angle, shift, tip, rack, thinning = CASES[case]
    return ToothForm(
        teeth=teeth,
        normal_module=1.0,
        normal_pressure_angle=math.radians(angle),
        profile_shift_coefficient=shift,
        tip_diameter=tip,
        rack=rack,
        tooth_thinning=thinning,
        helix_angle=math.radians(HELIX.get(case, 0.0)),
    )


@pytest.mark.parametrize("case", CASES)
def test_rack_touches_every_point_and_cuts_none(case: str) -> None:
    form = form_of(case)
    height, half_thickness = half_tooth(form, 60)
    # Into the frame whose space, not tooth, lies on the y axis.
    turn = math.pi / form.teeth
    x = height * math.sin(turn) - half_thickness * math.cos(turn)
    y = height * math.cos(turn) + half_thickness * math.sin(turn)
    nearest = closest_approach(form, np.stack([x, y]))
    assert nearest.min() > -1e-9
    assert nearest.max() < 5e-6


@pytest.mark.parametrize("case", CASES)
def test_height_is_monotone_and_ends_at_the_tip_corner(case: str) -> None:
    form = form_of(case)
    height, half_thickness = half_tooth(form, 300)
    assert height.shape == half_thickness.shape == (300,)
    assert np.all(np.diff(height) > 0.0)
    radius = np.hypot(height, half_thickness)
    assert radius[0] == pytest.approx(form.root_radius, rel=1e-13)
    assert radius[-1] == pytest.approx(form.tip_radius, rel=1e-13)


@pytest.mark.parametrize("case", CASES)
def test_fillet_and_involute_meet(case: str) -> None:
    form = form_of(case)
    fillet = float(form.trochoid.half_tooth_angle(form.form_normal_angle))
    assert fillet == pytest.approx(form.half_tooth_angle(form.form_radius), abs=1e-13)
    assert form.base_radius <= form.form_radius * (1.0 + 1e-15)


@pytest.mark.parametrize("case", CASES)
def test_fillet_is_the_integral_of_its_slope(case: str) -> None:
    curve = form_of(case).trochoid
    angle = np.linspace(curve.pressure_angle, math.pi / 2.0, 7)
    step = 1e-6
    difference = (curve.radius(angle + step) ** 2 - curve.radius(angle - step) ** 2) / (2 * step)
    slope = curve.squared_radius_slope(angle)
    assert np.all(slope[:-1] < 0.0)
    assert slope == pytest.approx(difference, rel=1e-6, abs=1e-6 * float(np.abs(slope).max()))


@pytest.mark.parametrize("case", CASES)
def test_outline_is_symmetric_and_spans_one_pitch(case: str) -> None:
    form = form_of(case)
    outline = tooth_outline(form, 200)
    assert outline.shape == (2, 199)
    assert outline[0] == pytest.approx(-outline[0][::-1], abs=0.0)
    assert outline[1] == pytest.approx(outline[1][::-1], abs=0.0)
    assert outline[0, 0] > 0.0
    assert outline[:, 99] == pytest.approx([0.0, form.tip_radius], abs=1e-15)
    span = math.atan2(outline[0, 0], outline[1, 0])
    assert span == pytest.approx(math.pi / form.teeth, rel=1e-13)
