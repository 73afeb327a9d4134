"""Blanks of hypoid pairs: printed figures, kinematic definitions, and what is refused."""

import math

import numpy as np
import pytest

from known_hypoids import h1043, random_blanks
from tribodyn.errors import InputError
from tribodyn.gear import HypoidBlank, hypoid_blank

#: Dimensions in mm and deg of 10 x 43, computed by hand from the clauses of ISO 23509.
H1043 = {
    "pitch_angle_pinion": 16.9006, "pitch_angle_wheel": 72.7355,
    "mean_spiral_angle_wheel": 33.8592, "offset_angle_pitch": 12.1405,
    "offset_angle_axial": 11.6087, "limit_pressure_angle": -1.63463,
    "normal_pressure_angle_drive": 18.3654, "normal_pressure_angle_coast": 21.6346,
    "mean_cone_distance_pinion": 138.6874, "mean_cone_distance_wheel": 151.8703,
    "mean_pitch_diameter_pinion": 80.6365, "mean_pitch_diameter_wheel": 290.0555,
    "mean_normal_module": 5.60151, "outer_cone_distance_wheel": 175.9264,
    "inner_cone_distance_wheel": 128.2264, "mean_addendum_pinion": 7.842,
    "mean_addendum_wheel": 3.361, "mean_dedendum_pinion": 4.761, "mean_dedendum_wheel": 9.242,
    "calculation_point_pinion": 142.0612, "calculation_point_wheel": 40.2396,
    "pitch_apex_pinion": -9.3637, "pitch_apex_wheel": 4.8330,
    "face_angle_pinion": 20.3190, "face_angle_wheel": 74.5312,
    "root_angle_pinion": 15.1390, "root_angle_wheel": 69.2529, "outer_tip_diameter_pinion": 113.970,
}  # fmt: skip


def _figure(blank, name):
    value = getattr(blank, name)
    return math.degrees(value) if "angle" in name else value * 1e3


@pytest.mark.parametrize("name", H1043)
def test_dimensions_of_ten_against_43(name):
    last = 10.0 ** -len(str(H1043[name]).partition(".")[2])
    assert abs(_figure(h1043(), name) - H1043[name]) <= 0.51 * last


def test_worked_example_of_iso_23509_annex_f3():
    # ISO stops its iteration at 1 % of the cutter radius.
    blank = hypoid_blank(
        13, 42, 15e-3, 170e-3, 30e-3, math.radians(50.0), 63.5e-3, addendum_factor_wheel=0.35,
        thickness_factor=0.1, outer_backlash=0.2e-3, addendum_angle_wheel=math.radians(1.0),
        dedendum_angle_wheel=math.radians(4.0),
    )  # fmt: skip
    printed = {
        "pitch_angle_pinion": 21.288, "pitch_angle_wheel": 68.324, "mean_spiral_angle_wheel": 38.61,
        "inner_spiral_angle_wheel": 30.83, "outer_spiral_angle_wheel": 47.68,
    }  # fmt: skip
    for name, value in printed.items():
        assert _figure(blank, name) == pytest.approx(value, abs=5e-3 if value < 90 else 0)


def _frame(blank):
    """Calculation point, outward normals of both pitch cones, and their generators."""
    axial, offset = blank.offset_angle_axial, blank.offset
    radius = 0.5 * blank.mean_pitch_diameter_wheel
    y, z = blank.calculation_point_pinion, blank.calculation_point_wheel
    point = np.array([-radius * math.sin(axial), y, z])
    vectors = []
    for axis, apex, angle in (
        (1, [-offset, -blank.pitch_apex_pinion, 0.0], blank.pitch_angle_pinion),
        (2, [0.0, 0.0, -blank.pitch_apex_wheel], blank.pitch_angle_wheel),
    ):
        generator = (point - apex) / np.linalg.norm(point - apex)
        across = generator.copy()
        across[axis] = 0.0
        normal = math.cos(angle) * across / np.linalg.norm(across)
        normal[axis] -= math.sin(angle)
        vectors.append((normal, generator))
    return point, *vectors


@pytest.fixture(scope="module")
def blanks():
    return random_blanks(100)


def test_pitch_cones_touch(blanks):
    for blank in blanks:
        point, (normal_1, along_1), (normal_2, along_2) = _frame(blank)
        assert np.abs(normal_1 + normal_2).max() < 1e-12
        assert math.hypot(point[0] + blank.offset, point[2]) == pytest.approx(
            0.5 * blank.mean_pitch_diameter_pinion, rel=1e-12
        )
        assert abs(normal_1 @ along_1) < 1e-12
        assert abs(normal_2 @ along_2) < 1e-12
        assert along_1 @ along_2 == pytest.approx(math.cos(blank.offset_angle_pitch), rel=1e-12)


def _sliding(blank, point):
    x, y, z = point
    slow = 1.0 / blank.ratio
    return np.array([z - slow * y, slow * x, -x - blank.offset])


def test_teeth_slide_along_their_traces(blanks):
    for blank in blanks:
        point, (normal, along_1), (_, along_2) = _frame(blank)
        slip = _sliding(blank, point)
        speed = np.linalg.norm(slip)
        assert abs(normal @ slip) < 1e-12 * speed
        for along, spiral in (
            (along_1, blank.mean_spiral_angle_pinion),
            (along_2, blank.mean_spiral_angle_wheel),
        ):
            assert abs(along @ slip) / speed == pytest.approx(math.cos(spiral), rel=1e-10)
        wanted = 0.5 * blank.mean_pitch_diameter_pinion * math.sin(blank.offset_angle_pitch)
        assert speed == pytest.approx(wanted / math.cos(blank.mean_spiral_angle_wheel), rel=1e-10)


def test_limit_pressure_angle_and_curvature_are_kinematic(blanks):
    # At the limit angle n.v12 does not change with the rotation; there the trace has the curvature
    # of the cutter, or contact lines would pile up.
    for blank in blanks:
        point, _, (normal, _) = _frame(blank)
        slip = _sliding(blank, point)
        trace = slip / np.linalg.norm(slip)
        limit = np.cross(trace, np.cross([1.0, 0.0, 0.0], point))
        limit /= np.linalg.norm(limit)
        assert abs(limit @ normal) == pytest.approx(
            abs(math.sin(blank.limit_pressure_angle)), abs=1e-9
        )
        turn = np.cross([0.0, 1.0, 1.0 / blank.ratio], trace)
        curvature = abs(limit @ turn) / np.linalg.norm(slip)
        assert curvature * blank.cutter_radius == pytest.approx(1.0, rel=1e-9)
        assert blank.limit_curvature * blank.cutter_radius == pytest.approx(1.0, rel=1e-9)


def test_negative_offset_makes_the_pinion_smaller():
    sizes = {}
    for offset in (-20e-3, 20e-3):
        blank = hypoid_blank(10, 43, offset, 0.336, 0.0477, math.radians(40.0), 0.1143)
        point, (normal_1, _), (normal_2, _) = _frame(blank)
        assert np.abs(normal_1 + normal_2).max() < 1e-12
        assert abs(normal_2 @ _sliding(blank, point)) < 1e-12
        sizes[offset] = blank.mean_pitch_diameter_pinion
        assert math.copysign(1.0, offset) == math.copysign(1.0, blank.offset_angle_pitch)
    assert sizes[-20e-3] < 2.0 * 0.5 * 0.29 / 4.3 < sizes[20e-3]


def test_without_offset_the_cones_of_a_spiral_bevel_pair_roll():
    blank = hypoid_blank(14, 39, 0.0, 0.176893, 0.0254, math.radians(35.0), 0.1143)
    assert math.tan(blank.pitch_angle_pinion) == pytest.approx(14 / 39, rel=1e-14)
    assert blank.pitch_angle_pinion + blank.pitch_angle_wheel == pytest.approx(math.pi / 2)
    assert blank.mean_cone_distance_pinion == blank.mean_cone_distance_wheel
    assert blank.mean_spiral_angle_pinion == blank.mean_spiral_angle_wheel == math.radians(35.0)
    assert blank.pitch_apex_pinion == pytest.approx(0.0, abs=1e-15)
    assert blank.face_width_pinion == pytest.approx(blank.face_width_wheel, rel=1e-12)
    point, _, _ = _frame(blank)
    assert np.linalg.norm(_sliding(blank, point)) < 1e-15
    # Tip and root of one gear run along those of the other, a clearance apart.
    assert blank.face_angle_pinion == pytest.approx(math.pi / 2 - blank.root_angle_wheel)
    apex_distance = blank.face_apex_pinion * math.sin(blank.face_angle_pinion)
    apex_distance += blank.root_apex_wheel * math.sin(blank.root_angle_wheel)
    assert -apex_distance == pytest.approx(blank.clearance, rel=1e-9)


def test_spiral_angles_are_those_of_a_circle():
    # The cutter's centre is equally far from the trace at toe, mean point and heel.
    blank = h1043()
    places = [
        blank.inner_cone_distance_wheel,
        blank.mean_cone_distance_wheel,
        blank.outer_cone_distance_wheel,
    ]
    spirals = [
        blank.inner_spiral_angle_wheel,
        blank.mean_spiral_angle_wheel,
        blank.outer_spiral_angle_wheel,
    ]
    radius = blank.cutter_radius
    away = [
        math.hypot(r - radius * math.sin(s), radius * math.cos(s))
        for r, s in zip(places, spirals, strict=True)
    ]
    assert away == pytest.approx([away[0]] * 3, rel=1e-12)


def test_tooth_and_space_fill_the_pitch_but_for_the_backlash():
    blank = h1043(thickness_factor=0.12, outer_backlash=0.15e-3)
    pitch = math.pi * blank.mean_normal_module
    teeth = blank.mean_normal_thickness_pinion + blank.mean_normal_thickness_wheel
    share = blank.mean_cone_distance_wheel / blank.outer_cone_distance_wheel
    play = 0.15e-3 * share * math.cos(blank.mean_spiral_angle_wheel)
    assert pitch - teeth == pytest.approx(play, rel=1e-12)
    more = (
        blank.mean_normal_thickness_pinion
        - h1043(outer_backlash=0.15e-3).mean_normal_thickness_pinion
    )
    assert more == pytest.approx(0.12 * blank.mean_normal_module, rel=1e-12)


def test_the_pair_scales_and_either_hand_has_the_same_dimensions():
    blank = h1043()
    large = hypoid_blank(10, 43, 63.4e-3, 672e-3, 95.4e-3, math.radians(46.0), 228.6e-3)
    assert large.crown_pinion == pytest.approx(2.0 * blank.crown_pinion, rel=1e-10)
    assert large.face_angle_pinion == pytest.approx(blank.face_angle_pinion, rel=1e-10)
    other = h1043(hand_pinion="right")
    assert other.hand_pinion == "right"
    assert other != blank
    assert other.limit_pressure_angle == blank.limit_pressure_angle


BAD = [
    ({"offset": 0.2}, "offset", "passes the wheel"),
    ({"offset": float("nan")}, "offset", "finite"),
    ({"offset": "31 mm"}, "offset", "number"),
    ({"cutter_radius": 10e-3}, "cutter_radius", "limit curvature"),
    ({"face_width_wheel": 0.16}, "face_width_wheel", "at most"),
    ({"teeth_wheel": 9}, "teeth_wheel", "as many teeth"),
    ({"teeth_pinion": 10.5}, "teeth_pinion", "whole"),
    ({"mean_spiral_angle_pinion": 46.0}, "mean_spiral_angle_pinion", "radians"),
    ({"mean_spiral_angle_pinion": 0.02}, "offset", "offset 31.7 mm"),
    ({"teeth_wheel": 60, "addendum_angle_wheel": 0.3}, "addendum_angle_wheel", "cones have"),
    (
        {
            "thickness_factor": 0.5,
            "addendum_factor_wheel": 0.05,
            "pressure_angle_drive": 0.5,
            "pressure_angle_coast": 0.5,
            "depth_factor": 2.5,
        },
        "thickness_factor",
        "leaves a tooth",
    ),
    ({"hand_pinion": "both"}, "hand_pinion", "left, right"),
]


@pytest.mark.parametrize(("change", "place", "reason"), BAD)
def test_impossible_blanks_are_refused_with_a_reason(change, place, reason):
    sound = {
        "teeth_pinion": 10, "teeth_wheel": 43, "offset": 31.7e-3,
        "outer_pitch_diameter_wheel": 0.336, "face_width_wheel": 47.7e-3,
        "mean_spiral_angle_pinion": math.radians(46.0), "cutter_radius": 114.3e-3,
    }  # fmt: skip
    with pytest.raises(InputError, match=reason) as caught:
        hypoid_blank(**(sound | change))
    assert place in str(caught.value)


def test_all_faults_come_at_once():
    with pytest.raises(InputError) as caught:
        hypoid_blank(10, 43, 5.0, -1.0, 0.0, 46.0, 0.1143)
    assert len(caught.value.problems) == 4


def test_matching_cutters_are_reported():
    with pytest.raises(InputError) as caught:
        hypoid_blank(10, 43, 31.7e-3, 0.336, 0.0477, math.radians(46.0), 10e-3)
    least = float(str(caught.value).partition("from ")[2].split(" mm")[0]) * 1e-3
    assert 10e-3 < least < 114.3e-3
    assert isinstance(
        hypoid_blank(10, 43, 31.7e-3, 0.336, 0.0477, math.radians(46.0), 3.0 * least), HypoidBlank
    )


def test_it_exports_its_dimensions_with_units():
    data = h1043().to_xarray()
    assert data.pitch_angle_pinion.units == "rad"
    assert float(data.offset) == 31.7e-3
    assert data.attrs["teeth_wheel"] == 43


def test_figure_is_to_scale_and_shows_the_clearance():
    figure = h1043().plot()
    heels = [trace for trace in figure.data if "handed" in trace.name]
    assert [trace.name for trace in heels] == ["pinion, left-handed", "wheel, right-handed"]
    pinion = heels[0]
    # The tip cone of the pinion keeps clear of the wheel's root; its addendum follows nearly.
    assert 2.0 * max(pinion.y) == pytest.approx(113.970, abs=0.02)
    assert max(heels[1].y) * 2e-3 == pytest.approx(h1043().outer_tip_diameter_wheel, rel=1e-9)
