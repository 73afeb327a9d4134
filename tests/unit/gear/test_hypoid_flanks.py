"""Flanks of hypoid pairs: envelope, curvature, undercut, ease-off, export."""

import math
import warnings

import numpy as np
import pytest

from known_hypoids import h1043, random_blanks
from tribodyn.errors import InputError, ModelWarning
from tribodyn.gear import EaseOff, hypoid_blank, hypoid_flanks
from tribodyn.gear.hypoid.ease_off import eased_gap
from tribodyn.gear.hypoid.envelope import (
    Axes,
    Surface,
    envelope,
    relative_curvature,
    turned,
)
from tribodyn.gear.hypoid.flank import SIDES

#: Drive side of 10 x 43: place [mm], rotation [deg], sliding [mm], curvature [1/mm], position [mm].
VECTORS = [
    ((0, 0), 0.0, 10.211022, 0.040414120, (-29.183473, 142.061179, 40.239613)),
    ((-20, -3), -9.536174650, 12.171315, 0.033398953, (-33.550409, 120.45332, 37.168771)),
    ((15, 2), 7.004439476, 10.670559, 0.050290256, (-25.132279, 157.958645, 42.781482)),
    ((0, -6), -5.052654523, 18.006077, 0.021115434, (-38.757526, 137.904227, 45.969282)),
]


@pytest.mark.parametrize(("place", "rotation", "sliding", "curvature", "position"), VECTORS)
def test_contact_of_ten_against_43(place, rotation, sliding, curvature, position):
    flanks = hypoid_flanks(h1043()).conjugate
    touch = flanks.touch(1e-3 * np.array([place]))
    assert math.degrees(touch.contact.rotation[0]) == pytest.approx(rotation, abs=2e-9)
    assert 1e3 * np.linalg.norm(touch.sliding[0]) == pytest.approx(sliding, abs=6e-7)
    assert 1e-3 * touch.curvature.tensor[0, 1, 1] == pytest.approx(curvature, abs=6e-10)
    assert 1e3 * touch.contact.wheel.position[0] == pytest.approx(position, abs=1e-6)


def test_blade_angle_normal_and_sense_of_ten_against_43():
    flanks = hypoid_flanks(h1043()).conjugate
    assert math.degrees(flanks.wheel.blade_angle) == pytest.approx(20.2804, abs=5e-5)
    assert flanks.wheel.normal == pytest.approx((-0.6515661, -0.74480921, 0.14394744), abs=1e-8)
    assert flanks.sense == -1.0
    assert hypoid_flanks(h1043(), "coast").conjugate.sense == 1.0


@pytest.fixture(scope="module")
def pairs():
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)
        return [
            hypoid_flanks(blank, side, points=15) for blank in random_blanks(20) for side in SIDES
        ]


def _touch(flanks):
    places = np.stack(np.broadcast_arrays(flanks.along[:, None], flanks.across), axis=-1)
    return flanks.conjugate.touch(places)


def test_the_flanks_slide_and_do_not_part(pairs):
    for flanks in pairs:
        touch = _touch(flanks)
        normal = touch.contact.wheel.normal
        assert np.abs(np.einsum("...i,...i", normal, touch.sliding)).max() < 1e-13


def test_the_contact_line_has_no_curvature_and_the_tensor_is_symmetric(pairs):
    for flanks in pairs:
        tensor = _touch(flanks).curvature.tensor
        scale = np.abs(tensor[..., 1, 1]).max()
        assert np.abs(tensor[..., 0, :]).max() < 1e-9 + 1e-11 * scale
        assert np.abs(tensor[..., 1, 0]).max() < 1e-9 + 1e-11 * scale


def test_places_are_found_again(pairs):
    for flanks in pairs:
        wheel = flanks.conjugate.wheel
        places = np.stack(np.broadcast_arrays(flanks.along[:, None], flanks.across), axis=-1)
        again, _ = wheel.projected(wheel.at(wheel.parameters(places)))
        assert np.abs(again - places).max() < 1e-12


def test_a_formate_flank_has_the_spiral_angles_of_its_blank():
    # The crown gear of ISO 23509 is flat: the mean of both sides agrees with it.
    blank = hypoid_blank(
        13, 42, 15e-3, 170e-3, 30e-3, math.radians(50.0), 63.5e-3, addendum_factor_wheel=0.35,
        addendum_angle_wheel=math.radians(1.0), dedendum_angle_wheel=math.radians(4.0),
    )  # fmt: skip
    mean = blank.mean_cone_distance_wheel
    ends = blank.inner_cone_distance_wheel - mean, blank.outer_cone_distance_wheel - mean
    places = np.array([[end, 0.0] for end in ends])
    spirals = {}
    for side in SIDES:
        wheel = hypoid_flanks(blank, side).conjugate.wheel
        surface = wheel.at(wheel.parameters(places))
        _, slope = wheel.projected(surface)
        # Along the trace the place across the pitch cone stays.
        along = np.stack([slope[:, 1, 1], -slope[:, 1, 0]], axis=-1)
        trace = np.einsum("nij,nj->ni", surface.tangents, along)
        length = np.einsum("ni,ni->n", slope[:, 0], along)
        spirals[side] = np.degrees(np.arccos(np.abs(length) / np.linalg.norm(trace, axis=-1)))
    assert spirals["drive"] == pytest.approx([31.82, 46.54], abs=0.006)
    assert spirals["coast"] == pytest.approx([30.05, 49.42], abs=0.006)
    middle = 0.5 * (spirals["drive"] + spirals["coast"])
    assert middle == pytest.approx([30.83, 47.68], abs=0.4)


def test_the_envelope_of_an_involute_is_the_involute_of_the_mate():
    base, ratio, distance = 40e-3, 20 / 43, 70e-3
    axes = Axes(np.array([0.0, 0.0, 1.0]), np.array([-distance, 0.0, 0.0]), ratio)
    roll, width = np.meshgrid(np.linspace(0.2, 0.9, 12), np.linspace(-5e-3, 5e-3, 3), indexing="ij")
    turn = roll + 3.2
    ray = np.stack([np.cos(turn), np.sin(turn), 0 * turn], axis=-1)
    side = np.stack([-np.sin(turn), np.cos(turn), 0 * turn], axis=-1)
    up = np.broadcast_to([0.0, 0.0, 1.0], ray.shape)
    zero = np.zeros_like(ray)
    surface = Surface(
        base * (ray - roll[..., None] * side) + width[..., None] * up,
        side,
        np.stack([base * roll[..., None] * ray, up], axis=-1),
        np.stack([-ray, zero], axis=-1),
    )
    contact = envelope(surface, axes)
    position, normal = contact.pinion[:2]
    # All normals touch the base circle of the pinion, and its curvature is that of an involute.
    lever = np.cross(position, normal)[..., 2]
    assert np.abs(np.abs(lever) - ratio * base).max() < 1e-15
    reach = np.sqrt(np.sum(position[..., :2] ** 2, axis=-1) - (ratio * base) ** 2)
    curvature = relative_curvature(contact)
    assert np.abs(curvature.line[..., 2]) == pytest.approx(1.0, abs=1e-12)
    flank = base * roll
    assert np.abs(curvature.tensor[..., 1, 1]) == pytest.approx(1 / reach + 1 / flank, rel=1e-9)
    # Contacts move along the wheel at the rate at which its base circle unwinds.
    assert np.abs(curvature.gradient) * flank == pytest.approx(1.0, rel=1e-12)


def test_the_curvature_is_that_of_the_gap_of_the_surfaces():
    flanks = hypoid_flanks(h1043(), ease_off=EaseOff(lengthwise_crowning=1e-12)).conjugate
    touch = flanks.touch(np.array([[2e-3, -1e-3]]))
    axes, rotation = flanks.axes, touch.contact.rotation[0]
    normal, across = touch.contact.wheel.normal[0], touch.curvature.across[0]
    basis = np.stack([touch.curvature.line[0], across])
    start = flanks.wheel.parameters(touch.places)[0]

    def pinion(parameters):
        position, _ = flanks.pinion_at(parameters[None])
        turn = turned(position, axes.axis, np.array([rotation / axes.ratio]))
        return turn[0] + axes.origin

    def wheel(parameters):
        cosine, sine = math.cos(rotation), math.sin(rotation)
        matrix = np.array([[cosine, sine, 0.0], [-sine, cosine, 0.0], [0.0, 0.0, 1.0]])
        return matrix @ flanks.wheel.at(parameters[None]).position[0]

    def above(surface, step):
        """Height of a surface over the tangent plane at a place in it."""
        coordinates, contact = start.copy(), touch.contact.wheel.position[0]
        for _ in range(20):
            error = basis @ (surface(coordinates) - contact) - step
            slope = np.stack(
                [
                    basis @ (surface(coordinates + d) - surface(coordinates - d)) / 2e-6
                    for d in 1e-6 * np.eye(2)
                ],
                axis=-1,
            )
            coordinates = coordinates - np.linalg.solve(slope, error)
        return normal @ (surface(coordinates) - contact)

    for step in (np.array([0.0, 2e-4]), np.array([3e-4, 0.0]), np.array([1e-4, 1e-4])):
        # The mean of both directions is free of the third order.
        gaps = [above(wheel, way * step) - above(pinion, way * step) for way in (1.0, -1.0)]
        wanted = 0.5 * step @ touch.curvature.tensor[0] @ step
        assert np.mean(gaps) == pytest.approx(wanted, rel=3e-4, abs=1e-11)


def test_a_pair_of_the_other_hand_is_the_mirror_image():
    mirror = np.array([-1.0, 1.0, 1.0])
    ease = EaseOff(lengthwise_crowning=30e-6, profile_crowning=8e-6, bias=4e-6, tip_relief=5e-6)
    for side in SIDES:
        left = hypoid_flanks(h1043(), side, ease)
        right = hypoid_flanks(h1043(hand_pinion="right"), side, ease)
        for name in ("wheel_position", "pinion_position", "wheel_normal", "pinion_normal"):
            assert np.abs(getattr(left, name) * mirror - getattr(right, name)).max() < 1e-12
        assert left.wheel_rotation == pytest.approx(-right.wheel_rotation, abs=1e-12)
        assert left.relative_curvature == pytest.approx(right.relative_curvature, rel=1e-9)
        assert left.conjugate.sense == -right.conjugate.sense


def test_the_normal_of_the_eased_pinion_is_perpendicular_to_its_surface():
    ease = EaseOff(lengthwise_crowning=80e-6, profile_crowning=40e-6, bias=20e-6, tip_relief=20e-6)
    flanks = hypoid_flanks(h1043(), ease_off=ease).conjugate
    parameters = flanks.wheel.parameters(np.array([[-9e-3, -4e-3], [3e-3, 1e-3], [15e-3, 3e-3]]))
    _, normal = flanks.pinion_at(parameters)
    for step in 1e-6 * np.eye(2):
        slope = (
            flanks.pinion_at(parameters + step)[0] - flanks.pinion_at(parameters - step)[0]
        ) / 2e-6
        assert np.abs(np.einsum("ni,ni->n", normal, slope)).max() < 1e-8 * np.abs(slope).max()


def test_the_gap_is_the_distance_along_the_normal_of_the_pinion():
    ease = EaseOff(lengthwise_crowning=30e-6, profile_crowning=8e-6, root_relief=9e-6)
    plain, eased = hypoid_flanks(h1043()), hypoid_flanks(h1043(), ease_off=ease)
    lacking = plain.pinion_position - eased.pinion_position
    along = np.einsum("...i,...i->...", lacking, plain.pinion_normal)
    assert along == pytest.approx(eased.gap, abs=1e-15)
    assert np.all(plain.gap == 0.0)
    assert eased.gap.min() >= 0.0


def test_ease_off_has_its_amounts_at_the_ends():
    blank = h1043()
    half = 0.5 * blank.face_width_wheel
    working = blank.mean_addendum_wheel + blank.mean_addendum_pinion
    middle = blank.mean_addendum_wheel - 0.5 * working
    ease = EaseOff(lengthwise_crowning=30e-6, profile_crowning=8e-6, bias=6e-6)
    corner = np.array(
        [[half, middle], [0.0, middle + 0.5 * working], [half, middle + 0.5 * working]]
    )
    assert 1e6 * eased_gap(ease, blank, corner)[0] == pytest.approx([30.0, 8.0, 44.0])
    assert eased_gap(ease, blank, np.array([0.0, middle]))[0] < 1e-30
    relief = EaseOff(tip_relief=10e-6, root_relief=7e-6, relief_length=2e-3)
    high, low = blank.mean_addendum_wheel, -blank.mean_addendum_pinion
    places = np.array([[0.0, high], [0.0, high - 1e-3], [0.0, high - 2e-3], [0.0, low]])
    assert 1e6 * eased_gap(relief, blank, places)[0] == pytest.approx(
        [10.0, 2.5, 0.0, 7.0], abs=1e-9
    )


def test_the_slope_of_the_gap_is_its_derivative():
    blank = h1043()
    ease = EaseOff(lengthwise_crowning=30e-6, profile_crowning=8e-6, bias=6e-6, tip_relief=9e-6,
                   root_relief=5e-6)  # fmt: skip
    places = np.array([[10e-3, 2.5e-3], [-12e-3, -6e-3], [3e-3, -1e-3]])
    _, slope = eased_gap(ease, blank, places)
    for axis, step in enumerate(1e-7 * np.eye(2)):
        change = (
            eased_gap(ease, blank, places + step)[0] - eased_gap(ease, blank, places - step)[0]
        ) / 2e-7
        assert slope[:, axis] == pytest.approx(change, rel=1e-6, abs=1e-12)


def test_undercut_is_reported_up_to_the_least_number_of_teeth():
    # Where the pinion turns back on itself its curvature passes through infinity: the flanks then
    # interfere as well.
    shares = []
    for teeth in (5, 7, 10, 16):
        blank = hypoid_blank(teeth, 35, 0.0, 0.3, 0.05, math.radians(30.0), 0.1143)
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            flanks = hypoid_flanks(blank)
        codes = {each.message.code for each in caught}
        shares.append(flanks.undercut_share)
        assert shares[-1] == flanks.interference_share
        assert codes == ({"hypoid-undercut", "hypoid-interference"} if shares[-1] else set())
    assert shares[0] > shares[1] > 0.0
    assert shares[-1] == 0.0


@pytest.mark.parametrize("gear", ["pinion", "wheel"])
def test_points_and_triangles_are_written(tmp_path, gear):
    flanks = hypoid_flanks(h1043(), points=9)
    rows = np.loadtxt(flanks.to_csv(tmp_path / "p.csv", gear), delimiter=",", skiprows=1)
    position, normal = flanks.points(gear)
    assert rows[:, :3] * 1e-3 == pytest.approx(position.reshape(-1, 3), rel=1e-14)
    assert rows[:, 3:] == pytest.approx(normal.reshape(-1, 3), rel=1e-14)
    text = flanks.to_stl(tmp_path / "p.stl", gear).read_text().split()
    teeth = getattr(flanks.blank, f"teeth_{gear}")
    assert text.count("facet") == teeth * 2 * 8 * 8
    vertices, facets = (
        np.array([text[i + 1 : i + 4] for i, each in enumerate(text) if each == kind], float)
        for kind in ("vertex", "normal")
    )
    a, b, c = vertices.reshape(-1, 3, 3).swapaxes(0, 1)
    facing = np.cross(b - a, c - a)
    area = np.linalg.norm(facing, axis=-1)
    assert np.einsum("ni,ni->n", facing, facets) == pytest.approx(area, rel=1e-5)
    # The triangles of a tooth face outwards as its normals do.
    assert np.all(facets[: len(facets) // teeth] @ normal.mean((0, 1)) > 0.0)


@pytest.mark.filterwarnings("error::RuntimeWarning")
def test_a_flank_without_a_conjugate_is_refused_with_the_reason():
    blank = hypoid_blank(10, 11, 0.0561, 0.821, 0.0833, 0.643, 0.317, addendum_factor_wheel=0.587)
    refused = []
    for side in SIDES:
        try:
            hypoid_flanks(blank, side, points=9)
        except InputError as error:
            refused.append(str(error))
    assert refused
    assert all("never touches a pinion" in each or "out of the cutter" in each for each in refused)


def test_wrong_arguments_are_refused(tmp_path):
    blank = h1043()
    for change in ({"blank": None}, {"side": "left"}, {"ease_off": 3.0}, {"points": 4}):
        with pytest.raises(InputError):
            hypoid_flanks(**({"blank": blank} | change))
    with pytest.raises(InputError, match="cut into each other"):
        EaseOff(lengthwise_crowning=10e-6, profile_crowning=10e-6, bias=21e-6)
    for change in ({"tip_relief": 10.0}, {"bias": math.nan}, {"relief_length": 0.0},
                   {"center": 3.0}, {"center": ("a", 0.0)}, {"bias": -1.0}):  # fmt: skip
        with pytest.raises(InputError):
            EaseOff(**change)
    with pytest.raises(InputError, match="pinion, wheel"):
        hypoid_flanks(blank, points=5).to_csv(tmp_path / "x", "gear")
    with pytest.raises(InputError):
        hypoid_flanks(blank, points=5).to_stl(3.5, "wheel")
