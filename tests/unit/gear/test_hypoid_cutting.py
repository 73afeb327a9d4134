"""Generated and face-hobbed wheels: kinematics of cutting, the crown gear, limits."""

import math

import numpy as np
import pytest

from tribodyn.errors import ComputationError, InputError, collected
from tribodyn.gear import EaseOff, hypoid_blank, hypoid_flanks, tooth_contact
from tribodyn.gear.hypoid.conjugate import ConjugateFlanks
from tribodyn.gear.hypoid.envelope import Axes, envelope, turned
from tribodyn.gear.hypoid.wheel_flanks import GeneratedFlank, HobbedFlank, wheel_flank

HOBBED = {"process": "face-hobbing", "blade_groups": 13, "cutter_radius": 105e-3}
KINDS = {
    "generated": {"wheel_generation": "generated"},
    "hobbed": HOBBED,
    "hobbed-generated": {**HOBBED, "wheel_generation": "generated"},
}


def blank_of(offset=31.7e-3, **more):
    sizes = {"cutter_radius": 114.3e-3, **more}
    return hypoid_blank(10, 43, offset, 336e-3, 47.7e-3, math.radians(46.0), **sizes)


@pytest.mark.parametrize("side", ["drive", "coast"])
@pytest.mark.parametrize("kind", KINDS)
def test_the_cutter_leaves_the_flank_through_the_calculation_point(kind, side):
    flank = wheel_flank(blank_of(**KINDS[kind]), side)
    place = flank.at(np.zeros(2))
    assert place.position == pytest.approx(flank.point, abs=1e-15)
    assert place.normal == pytest.approx(flank.normal, abs=1e-14)
    if kind != "generated":  # of uniform depth: the cutter moves along the trace of the pitch cone
        along = place.tangents[:, 1] / np.linalg.norm(place.tangents[:, 1])
        assert np.abs(np.cross(along, flank.trace)).max() < 1e-14
    places = np.array([[1e-3, 0.02], [-2e-3, -0.1]])
    surface, step = flank.at(places), 1e-6
    for number, shift in enumerate(step * np.eye(2)):
        ahead, behind = flank.at(places + shift), flank.at(places - shift)
        for name, change in (("position", "tangents"), ("normal", "turns")):
            rate = (getattr(ahead, name) - getattr(behind, name)) / (2.0 * step)
            assert rate == pytest.approx(getattr(surface, change)[..., number], abs=2e-9)
        assert np.abs((surface.normal * surface.tangents[..., number]).sum(axis=-1)).max() < 1e-15


@pytest.mark.parametrize("hobbed", [False, True])
def test_gears_that_one_crown_gear_generates_are_conjugate(hobbed):
    # Of a spiral bevel pair without taper, cutters on one crown gear generate both flanks: points
    # of the pinion that envelops the wheel are those that the crown gear cuts on the pinion.
    taper = {} if hobbed else {"addendum_angle_wheel": 0.0, "dedendum_angle_wheel": 0.0}
    blank = blank_of(0.0, wheel_generation="generated", **(HOBBED if hobbed else {}), **taper)
    flanks = ConjugateFlanks(blank, "drive", EaseOff())
    wheel = flanks.wheel
    assert isinstance(wheel, GeneratedFlank)
    places = np.array([[1e-3, 0.05], [0.0, 0.0], [-2e-3, -0.08], [3e-3, 0.1]])
    pinion = flanks.pinion_at(places)[0]
    axis = wheel.frame @ np.array([0.0, 1.0, 0.0])
    cut_at = wheel.tool.at(places)
    tool = type(cut_at)(
        cut_at.position @ wheel.frame.T,
        cut_at.normal @ wheel.frame.T,
        *(np.einsum("ij,...jk->...ik", wheel.frame, each) for each in cut_at[2:]),
    )
    # The crown gear turns with the pitch point: slower than the pinion by the sine of its cone.
    sine = math.sin(blank.pitch_angle_pinion)
    cut = envelope(tool, Axes(-axis, np.zeros(3), sine))
    other = envelope(tool, Axes(axis, np.zeros(3), sine))
    matches = []
    for generated, about in ((cut, -axis), (other, axis)):
        position = turned(generated.pinion.position, about, -generated.rotation / sine)
        matches.append(np.abs(position @ wheel.frame - pinion).max())
    assert min(matches) < 1e-12
    assert max(matches) > 1e-6


def test_traces_of_face_hobbing_have_the_curvature_of_iso_23509():
    blank = blank_of(**HOBBED)
    crown, step = HobbedFlank(blank, "coast", on_crown=True), 1e-4
    path = crown.at(np.stack([np.zeros(3), step * np.array([-1.0, 0.0, 1.0])], axis=-1)).position
    speed, bend = (path[2] - path[0]) / (2.0 * step), (path[2] - 2.0 * path[1] + path[0]) / step**2
    curvature = np.linalg.norm(np.cross(speed, bend)) / np.linalg.norm(speed) ** 3
    assert blank.limit_curvature == pytest.approx(curvature, rel=1e-6)
    assert blank.face_angle_wheel == blank.pitch_angle_wheel == blank.root_angle_wheel
    # Angles of the same trace at both ends of the wheel's teeth.
    for end in ("inner", "outer"):
        distance = getattr(blank, f"{end}_cone_distance_wheel")
        angles = np.linspace(-0.6, 0.6, 20001)
        path = crown.at(np.stack([np.zeros_like(angles), angles], axis=-1))
        from_apex = path.position - crown.apex
        near = np.argmin(np.abs(np.linalg.norm(from_apex, axis=-1) - distance))
        along = path.tangents[near, :, 1] / np.linalg.norm(path.tangents[near, :, 1])
        spiral = math.acos(abs(along @ from_apex[near]) / distance)
        assert spiral == pytest.approx(getattr(blank, f"{end}_spiral_angle_wheel"), abs=2e-4)
    # Few blade groups tend to face milling.
    assert blank_of(process="face-hobbing", blade_groups=3).limit_curvature == pytest.approx(
        1.0 / 114.3e-3, rel=0.06
    )


@pytest.mark.parametrize("kind", KINDS)
def test_contact_of_such_pairs(kind):
    ease = EaseOff(lengthwise_crowning=15e-6, profile_crowning=8e-6)
    flanks = hypoid_flanks(blank_of(**KINDS[kind]), "drive", ease, points=5)
    assert flanks.undercut_share == flanks.interference_share == 0.0
    first = tooth_contact(flanks, rotations_per_pitch=8, cells=9)
    exact = tooth_contact(flanks, exact=True, rotations_per_pitch=8, cells=9)
    assert exact.peak_to_peak == pytest.approx(first.peak_to_peak, rel=0.01)
    assert 2.5 < first.contact_ratio < 3.5


def test_a_small_offset_tends_to_the_spiral_bevel_pair():
    angles = ("pitch_angle", "mean_spiral_angle", "face_angle", "root_angle")
    names = [f"{name}_{gear}" for name in angles for gear in ("pinion", "wheel")]
    for more in ({}, HOBBED):
        bevel, *small = (blank_of(offset, **more) for offset in (0.0, 1e-5, 1e-4, -1e-4))
        near, far, other = (
            np.array([getattr(blank, name) - getattr(bevel, name) for name in names])
            for blank in small
        )
        # In proportion to the offset; the approximate mean radius leaves 0.2 % of the sizes.
        assert 0.0 < np.abs(far).max() < 1e-3
        assert near == pytest.approx(0.1 * far, abs=2e-6)
        assert other == pytest.approx(-far, abs=2e-5)
        assert small[0].mean_normal_module == pytest.approx(bevel.mean_normal_module, rel=2.5e-3)


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        ({"process": "face-hobbing"}, "decide by how much the work turns"),
        ({"blade_groups": 13}, "Only face hobbing has them"),
        ({"blade_groups": 2.5, "process": "face-hobbing"}, "blade_groups"),
        ({**HOBBED, "dedendum_angle_wheel": 0.05}, "teeth of uniform depth"),
        ({"process": "hobbing"}, "face-hobbing"),
        ({**HOBBED, "cutter_radius": 20e-3}, "no pitch cones have the curvature"),
    ],
)
def test_impossible_cutting_is_refused(change, reason):
    with pytest.raises(InputError, match=reason):
        blank_of(**change)


def designs(count, seed):
    """Random designs of all kinds, some of which no cutter can make."""
    draw = np.random.default_rng(seed)
    for number in range(count):
        diameter = draw.uniform(0.1, 0.5)
        more = dict(list(KINDS.values())[number % 4 - 1]) if number % 4 else {}
        more["cutter_radius"] = draw.uniform(0.25, 0.45) * diameter
        if "blade_groups" in more:
            more["blade_groups"] = int(draw.integers(5, 20))
        offset = (0.0, 1.0, 1.0, -1.0)[int(draw.integers(4))] * draw.uniform(0.02, 0.2) * diameter
        teeth = int(draw.integers(6, 20)), int(draw.integers(25, 60))
        width = draw.uniform(0.08, 0.2) * diameter
        more["shaft_angle"] = math.radians(90.0 if number % 3 else draw.uniform(50.0, 115.0))
        yield (*teeth, offset, diameter, width, math.radians(draw.uniform(20.0, 55.0))), more


def test_random_designs_run_or_are_refused_with_a_reason():
    made = flanked = 0
    refused: list[object] = []
    for number, (sizes, more) in enumerate(designs(200, seed=7)):
        try:
            blank = hypoid_blank(*sizes, **more)
            made += 1
            if number % 8:
                continue
            with collected():
                flanks = hypoid_flanks(blank, ("drive", "coast")[number % 16 // 8], points=5)
            flanked += 1
        except (InputError, ComputationError) as error:
            refused += [each for each in error.problems if not (each.why and each.remedy)]
            continue
        values = np.concatenate([flanks.pinion_position.ravel(), flanks.wheel_normal.ravel()])
        assert np.all(np.isfinite(values))
    assert not refused
    assert made > 80
    assert flanked > 8
