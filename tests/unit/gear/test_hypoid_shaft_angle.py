"""Hypoid and spiral bevel pairs on axes at any angle: blank, flanks, contact and load."""

import math

import numpy as np
import pytest
from scipy.optimize import minimize

from tribodyn.errors import InputError
from tribodyn.gear import EaseOff, Misalignment, hypoid_blank, hypoid_flanks, tooth_contact
from tribodyn.lubricant import Lubricant
from tribodyn.mesh import hypoid_friction, hypoid_loaded_contact


def blank_of(shaft, offset=20e-3, teeth=(13, 37), **more):
    angle = math.radians(shaft)
    sizes = {"outer_pitch_diameter_wheel": 0.25, "face_width_wheel": 0.03, "cutter_radius": 0.1}
    return hypoid_blank(*teeth, offset, mean_spiral_angle_pinion=math.radians(40.0),
                        shaft_angle=angle, **sizes, **more)  # fmt: skip


DESIGNS = [blank_of(shaft, offset) for shaft in (60.0, 90.0, 100.0) for offset in (20e-3, -9e-3)]


def axes_of(blank):
    """Direction of the pinion's axis and a point of it; the wheel's axis is z."""
    shaft = blank.shaft_angle
    return np.array([0.0, math.sin(shaft), math.cos(shaft)]), np.array([-blank.offset, 0.0, 0.0])


def cones(blank, cone):
    """Calculation point, and of both cones the apex."""
    axis, origin = axes_of(blank)
    angle, radius = blank.offset_angle_axial, 0.5 * blank.mean_pitch_diameter_wheel
    point = radius * np.array([-math.sin(angle), math.cos(angle), 0.0])
    point[2] = blank.calculation_point_wheel
    apices = [origin - getattr(blank, f"{cone}_apex_pinion") * axis,
              np.array([0.0, 0.0, -getattr(blank, f"{cone}_apex_wheel")])]  # fmt: skip
    return point, apices, (axis, np.array([0.0, 0.0, 1.0]))


@pytest.mark.parametrize("blank", DESIGNS, ids=repr)
def test_pitch_cones_touch_and_teeth_slide_along_their_traces(blank):
    point, apices, directions = cones(blank, "pitch")
    normals, generators = [], []
    for gear, apex, axis in zip(("pinion", "wheel"), apices, directions, strict=True):
        along = (point - apex) / np.linalg.norm(point - apex)
        half = getattr(blank, f"pitch_angle_{gear}")
        assert along @ axis == pytest.approx(math.cos(half), abs=1e-12)
        radial = along - (along @ axis) * axis
        radial /= np.linalg.norm(radial)
        normals.append(math.cos(half) * radial - math.sin(half) * axis)
        generators.append(along)
    assert np.abs(normals[0] + normals[1]).max() < 1e-12
    origin = axes_of(blank)[1]
    relative = directions[0] + directions[1] / blank.ratio
    slip = np.cross(relative, point) - np.cross(directions[0], origin)
    speed = np.linalg.norm(slip)
    assert abs(normals[1] @ slip) < 1e-12 * speed
    for gear, along in zip(("pinion", "wheel"), generators, strict=True):
        spiral = getattr(blank, f"mean_spiral_angle_{gear}")
        assert abs(along @ slip) / speed == pytest.approx(math.cos(spiral), rel=1e-9)
    # The limit normal does not push while the gears turn; the trace has the cutter's curvature.
    trace = slip / speed
    pull = np.cross(directions[0], np.cross(directions[1], point)) / blank.ratio
    pull -= np.cross(directions[1], np.cross(directions[0], point - origin)) / blank.ratio
    limit = np.cross(trace, pull)
    limit /= np.linalg.norm(limit)
    assert abs(limit @ normals[1]) == pytest.approx(
        abs(math.sin(blank.limit_pressure_angle)), abs=1e-9
    )
    turn = abs(limit @ np.cross(relative, trace)) / speed
    assert turn * blank.cutter_radius == pytest.approx(1.0, rel=1e-8)


@pytest.mark.parametrize("blank", DESIGNS, ids=repr)
@pytest.mark.parametrize("pair", [("face", "root"), ("root", "face")], ids="-".join)
def test_tips_have_their_clearance_over_roots(blank, pair):
    of_pinion, of_wheel = pair
    _, apices, (axis, up) = cones(blank, of_pinion)
    apex, half = apices[0], getattr(blank, f"{of_pinion}_angle_pinion")
    root = cones(blank, of_wheel)[1][1]
    other = getattr(blank, f"{of_wheel}_angle_wheel")
    first = np.array([1.0, 0.0, 0.0])
    second = np.cross(axis, first)

    def gap(unknown):
        distance, azimuth = unknown
        around = math.cos(azimuth) * first + math.sin(azimuth) * second
        place = apex + distance * (math.cos(half) * axis + math.sin(half) * around) - root
        radius = math.hypot(place[0], place[1])
        return 1e3 * (radius * math.cos(other) - (place @ up) * math.sin(other))

    # The least distance of the pinion's cone from outside the wheel's: parallel tangent planes.
    middle = blank.mean_cone_distance_pinion
    start = min(([middle, a] for a in np.linspace(-math.pi, math.pi, 181)), key=gap)
    place = minimize(gap, start, method="Nelder-Mead", options={"xatol": 1e-9, "fatol": 1e-12})
    slopes = [gap(place.x + s) - gap(place.x - s) for s in ([1e-6, 0.0], [0.0, 1e-5])]
    assert np.abs(slopes).max() < 1e-4
    assert abs(gap(place.x)) == pytest.approx(1e3 * blank.clearance, abs=2e-6)


@pytest.mark.parametrize("shaft", [60.0, 100.0])
def test_contact_load_and_friction_balance_on_both_axes(shaft):
    blank = blank_of(shaft, hand_pinion="right")
    ease = EaseOff(lengthwise_crowning=20e-6, profile_crowning=8e-6)
    flanks = hypoid_flanks(blank, "coast", ease, points=7)
    # Points of the pinion turn about the y axis of their own frame.
    y = flanks.pinion_position[..., 1]
    assert np.all(y > 0.0)
    distance = np.hypot(flanks.pinion_position[..., 0], flanks.pinion_position[..., 2])
    slope = np.polyfit(y[:, 3], distance[:, 3], 1)[0]
    assert slope == pytest.approx(math.tan(blank.pitch_angle_pinion), rel=0.2)
    shifted = Misalignment(pinion_axial=5e-6, shaft_angle=2e-5)
    analyses = [
        tooth_contact(flanks, case, exact=exact, rotations_per_pitch=4, cells=5)
        for case in (Misalignment(), shifted) for exact in (False, True)
    ]  # fmt: skip
    first, exact, first_shifted, exact_shifted = (each.angular_transmission_error
                                                  for each in analyses)  # fmt: skip
    inner = ~analyses[0].on_edge & ~analyses[2].on_edge
    assert np.ptp(exact[inner]) == pytest.approx(np.ptp(first[inner]), rel=0.02)
    changes = (first_shifted - first)[inner], (exact_shifted - exact)[inner]
    assert changes[1] == pytest.approx(changes[0], rel=0.05)
    loaded = hypoid_loaded_contact(flanks, 300.0, steps=16, cells=6)
    torques = [loaded.mesh_force * each[:, 4]
               for each in (loaded.pinion_direction, loaded.wheel_direction)]  # fmt: skip
    assert torques[0] == pytest.approx(300.0, rel=1e-9)
    assert torques[1] == pytest.approx(300.0 * blank.ratio, rel=1e-9)
    rubbed = hypoid_friction(
        loaded, 100.0, lubricant=Lubricant(0.02, 850.0, 2e-8), composite_roughness=0.5e-6,
        friction_law="constant", friction_options={"coefficient": 0.05},
    )  # fmt: skip
    turning = rubbed.pinion_friction[:, 4] + rubbed.wheel_friction[:, 4] / blank.ratio
    assert -loaded.mesh_force * turning * 100.0 == pytest.approx(rubbed.power, rel=1e-9)


def test_spiral_bevel_cones_share_the_shaft_angle():
    blank = blank_of(75.0, 0.0)
    assert blank.pitch_angle_pinion + blank.pitch_angle_wheel == pytest.approx(blank.shaft_angle)
    assert math.sin(blank.pitch_angle_wheel) / math.sin(blank.pitch_angle_pinion) == pytest.approx(
        37 / 13
    )
    small = blank_of(75.0, 1e-5)
    assert small.pitch_angle_pinion == pytest.approx(blank.pitch_angle_pinion, abs=1e-4)
    with pytest.raises(InputError, match="crown gear"):
        blank_of(112.0)
