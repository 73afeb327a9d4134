"""Helical and internal pairs: printed tables, formulas written out, and limits."""

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from tribodyn.contact import path_of_contact
from tribodyn.errors import InputError, ModelWarning, quiet
from tribodyn.gear import (
    BasicRack,
    CylindricalPair,
    FlankModification,
    ProfileMap,
    SpurGear,
    SpurPair,
    cylindrical_pair,
    flank_gap,
    gear_outline,
    hunting_period,
    mass_properties,
    section_moments,
    tooth_positions,
)
from tribodyn.gear.pair_checks import tip_play

Maker = Callable[..., CylindricalPair]


def _pair(z: tuple[int, int], m: float, beta: float, b: float, **changes: Any) -> CylindricalPair:
    """Pair in millimetres and degrees, with the pressure angle of 20 degrees."""
    return cylindrical_pair(
        pinion_teeth=z[0],
        wheel_teeth=z[1],
        normal_module=m * 1e-3,
        normal_pressure_angle=math.radians(20.0),
        helix_angle=math.radians(beta),
        pinion_face_width=b * 1e-3,
        **changes,
    )


def _shifts(first: float, second: float) -> dict[str, float]:
    return {"pinion_profile_shift_coefficient": first, "wheel_profile_shift_coefficient": second}


FVA_1 = _pair((27, 51), 4.5, 21.0, 50.0, center_distance=190e-3, **_shifts(0.231415, 0.231415))
FVA_2 = _pair((23, 34), 6.5, 10.0, 74.0, center_distance=190e-3, **_shifts(0.15074, 0.15074))
RING = _pair((21, -72), 2.0, 15.0, 25.0, **_shifts(0.2, -0.1))
#: Independent figures: angles in degrees, lengths in mm, speeds in m/s at 3000 rpm of the pinion.
TABLE = [
    (
        FVA_1,
        (21.299064, 22.806245, 19.679338),
        (141.08949, 256.77315),
        (1.450202, 1.267467),
        (15.60723, 25.49321, 36.06762),
        (13.06272, 17.70261, 19.54562),
        (4.903156, 9.653161),
        (71.96311, 77.00796, 83.16887),
    ),
    (
        FVA_2,
        (20.283559, 21.775125, 9.391286),
        (166.63110, 239.23410),
        (1.523695, 0.629272),
        (13.63806, 28.44063, 43.27323),
        (11.14861, 17.19505, 16.93257),
        (4.284524, 12.080720),
        (93.23807, 114.28521, 137.42645),
    ),
    (
        RING,
        (20.646896, 20.052474, 14.076095),
        (48.28160, 145.47977),
        (1.708058, 1.029808),
        (2.59849, 7.42587, 12.99550),
        (3.06493, 10.80811, 23.05224),
        (0.816340, 1.890574),
        (43.49507, 44.02330, 44.24110),
    ),
]


@pytest.mark.parametrize(
    ("pair", "angles", "tips", "ratios", "radii", "normal_radii", "speeds", "lengths"), TABLE
)
def test_printed_tables(
    pair: CylindricalPair,
    angles: Any,
    tips: Any,
    ratios: Any,
    radii: Any,
    normal_radii: Any,
    speeds: Any,
    lengths: Any,
) -> None:
    computed = (
        pair.transverse_pressure_angle,
        pair.working_transverse_pressure_angle,
        pair.base_helix_angle,
    )
    assert np.degrees(computed) == pytest.approx(angles, abs=6e-7)
    tip_diameters = 1e3 * pair.pinion.tip_diameter, 1e3 * pair.wheel.tip_diameter
    assert tip_diameters == pytest.approx(tips, abs=6e-6)
    computed = pair.transverse_contact_ratio, pair.overlap_ratio
    assert computed == pytest.approx(ratios, abs=6e-7)
    assert pair.total_contact_ratio == pytest.approx(sum(ratios), abs=2e-6)
    contact = path_of_contact(pair)
    motion = contact.kinematics([contact.A, contact.C, contact.E], 100.0 * math.pi)
    assert 1e3 * motion.pinion_curvature_radius == pytest.approx(radii, abs=6e-6)
    assert 1e3 * motion.equivalent_radius == pytest.approx(normal_radii, abs=6e-6)
    computed = motion.pinion_surface_speed[0], motion.wheel_surface_speed[0]
    assert computed == pytest.approx(speeds, abs=6e-7)
    assert motion.sliding_speed[0] == pytest.approx(speeds[0] - speeds[1], abs=2e-6)
    computed = (
        pair.least_contact_line_length,
        pair.mean_contact_line_length,
        pair.greatest_contact_line_length,
    )
    assert 1e3 * np.array(computed) == pytest.approx(lengths, abs=6e-6)


@pytest.mark.parametrize(
    ("pair", "lengths"),
    [
        (FVA_1, (71.96311, 76.15269, 82.43706, 81.08253, 71.96311, 71.96311)),
        (FVA_2, (93.23807, 93.23807, 104.80372, 134.60213, 123.03649, 105.15744)),
    ],
)
def test_printed_lengths_over_the_cycle(pair: CylindricalPair, lengths: Any) -> None:
    computed = pair.contact_line_length([0.0, 0.1, 0.25, 0.5, 0.75, 0.9])
    assert 1e3 * computed == pytest.approx(lengths, abs=6e-6)
    assert float(pair.contact_line_length(7.5)) == pytest.approx(lengths[3] * 1e-3, abs=6e-9)


def test_spur_ring() -> None:
    pair = _pair((22, -61), 4.0, 0.0, 20.0)
    contact = path_of_contact(pair)
    assert pair.center_distance == pytest.approx(78e-3, rel=1e-12)
    assert pair.transverse_contact_ratio == pytest.approx(1.957161, abs=6e-7)
    radii = 1e3 * np.array([contact.A, contact.C, contact.E])
    assert radii == pytest.approx((1.270546, 15.048886, 24.381735), abs=6e-7)
    assert pair.ratio == pytest.approx(-61.0 / 22.0)
    assert pair.line_of_action_length == pytest.approx(-78e-3 * math.sin(math.radians(20.0)))


def test_spur_names_are_names_of_the_same_classes() -> None:
    assert SpurPair is CylindricalPair
    assert isinstance(FVA_1.wheel, SpurGear)
    assert repr(FVA_1).startswith("CylindricalPair(z 27/51, beta 21 deg, m 4.5 mm, a 190 mm")
    assert (FVA_1.wheel.hand, RING.wheel.hand) == ("left", "right")


def _random_pairs() -> list[CylindricalPair]:
    random, pairs = np.random.default_rng(32), []
    while len(pairs) < 12:
        teeth = int(random.integers(18, 35)), int(random.integers(70, 120))
        sign = 1 if len(pairs) % 2 else -1
        shifts = _shifts(*random.uniform(-0.1, 0.3, 2))
        module, beta, width = random.uniform(1, 8), random.uniform(3, 35), random.uniform(5, 90)
        pairs.append(_pair((teeth[0], sign * teeth[1]), module, beta, width, **shifts))
    return pairs


@pytest.mark.parametrize("pair", _random_pairs(), ids=repr)
def test_random_pairs_against_formulas_in_plain_lengths(pair: CylindricalPair) -> None:
    """No sign rule: sums for external, differences for internal pairs, everything positive."""
    pinion, wheel, inside = pair.pinion, pair.wheel, pair.wheel.teeth < 0
    z1, z2, beta, alpha = pinion.teeth, abs(wheel.teeth), pair.helix_angle, math.radians(20.0)
    transverse = math.atan2(math.tan(alpha), math.cos(beta))
    working, distance = pair.working_transverse_pressure_angle, pair.center_distance
    bases = [
        0.5 * z * pinion.normal_module / math.cos(beta) * math.cos(transverse) for z in (z1, z2)
    ]
    assert (pinion.base_radius, wheel.base_radius) == pytest.approx(bases, rel=1e-12)
    gap = bases[1] - bases[0] if inside else bases[1] + bases[0]
    assert distance * math.cos(working) == pytest.approx(gap, rel=1e-12)
    # Without play the teeth fill the pitch at the operating circles.
    radii = [base / math.cos(working) for base in bases]
    thickness = pinion.tooth_thickness(radii[0]) + wheel.tooth_thickness(radii[1])
    assert thickness == pytest.approx(2.0 * math.pi * radii[0] / z1, rel=1e-9)
    reaches = [
        math.sqrt(gear.tip_radius**2 - base**2)
        for gear, base in zip((pinion, wheel), bases, strict=True)
    ]
    line = distance * math.sin(working)
    entry = reaches[1] - line if inside else line - reaches[1]
    assert pair.path_limits == pytest.approx((entry, reaches[0]), rel=1e-9)
    contact = path_of_contact(pair)
    at = np.linspace(contact.A, contact.E, 7)
    motion = contact.kinematics(at, 10.0)
    second = line + at if inside else line - at
    base_helix = math.acos(math.hypot(math.sin(alpha), math.cos(alpha) * math.cos(beta)))
    relative = at * second / (second - at if inside else second + at) / math.cos(base_helix)
    assert motion.equivalent_radius == pytest.approx(relative, rel=1e-9)
    assert motion.wheel_surface_speed == pytest.approx(10.0 * z1 / z2 * second, rel=1e-9)
    expected = motion.pinion_surface_speed - motion.wheel_surface_speed
    assert motion.sliding_speed == pytest.approx(expected, abs=1e-12)
    root = abs(wheel.root_radius - distance - pinion.tip_radius)
    if inside:
        assert root == pytest.approx(0.25 * pinion.normal_module, rel=0.2)


@pytest.mark.parametrize("driver", ["pinion", "wheel"])
@pytest.mark.parametrize("pair", [FVA_1, FVA_2, RING, *_random_pairs()[:4]], ids=repr)
def test_lines_of_contact_add_up_to_the_length(pair: CylindricalPair, driver: str) -> None:
    """Slices in contact, counted, are the length; its extremes lie at the events."""
    pair = replace(pair, driver=driver)
    contact, width, count = path_of_contact(pair), pair.common_face_width, 20000
    places = (np.arange(count) + 0.5) * width / count
    phases = np.array([0.03, 0.31, 0.77])
    path, in_contact = contact.face_paths(phases, places)
    counted = in_contact.sum(axis=(1, 2)) * width / count / math.cos(pair.base_helix_angle)
    assert counted == pytest.approx(pair.contact_line_length(phases), rel=1e-3)
    low, high = pair.path_limits
    assert np.all((path[in_contact] >= low - 1e-12) & (path[in_contact] <= high + 1e-12))
    events = pair.contact_line_length(contact.event_phases())
    assert events.min() == pytest.approx(pair.least_contact_line_length, rel=1e-9)
    assert events.max() == pytest.approx(pair.greatest_contact_line_length, rel=1e-9)
    dense = pair.contact_line_length((np.arange(4000) + 0.5) / 4000)
    assert dense.mean() == pytest.approx(pair.mean_contact_line_length, rel=1e-4)
    assert np.all((dense >= events.min() * (1 - 1e-9)) & (dense <= events.max() * (1 + 1e-9)))


def test_helix_angle_to_zero_gives_the_spur_pair() -> None:
    spur = _pair((20, 31), 3.0, 0.0, 25.0, **_shifts(0.3, 0.1))
    nearly = _pair((20, 31), 3.0, 1e-5, 25.0, **_shifts(0.3, 0.1))
    for name in ("center_distance", "transverse_contact_ratio", "mean_contact_line_length"):
        assert getattr(nearly, name) == pytest.approx(getattr(spur, name), rel=1e-9)
    assert nearly.least_contact_line_length == pytest.approx(25e-3, rel=1e-5)
    assert spur.least_contact_line_length == pytest.approx(25e-3, rel=1e-12)
    assert spur.greatest_contact_line_length == pytest.approx(50e-3, rel=1e-12)
    assert (spur.overlap_ratio, spur.axial_pitch) == (0.0, math.inf)
    assert nearly.pinion.form_radius == pytest.approx(spur.pinion.form_radius, rel=1e-9)
    contact = path_of_contact(spur)
    path, in_contact = contact.face_paths([0.2, 0.9], [0.0, 12e-3])
    plain, plain_mask = contact.pair_paths([0.2, 0.9])
    assert np.array_equal(path, np.repeat(plain[..., None], 2, axis=2))
    assert np.array_equal(in_contact, np.repeat(plain_mask[..., None], 2, axis=2))


def test_ring_with_many_teeth_is_nearly_a_rack() -> None:
    """Normal radius at the pitch point tends to that of the pinion against a plane."""
    pair = _pair((20, -500), 2.0, 12.0, 20.0)
    contact = path_of_contact(pair)
    radius = float(contact.kinematics(contact.C, 1.0).equivalent_radius)
    plane = contact.C / math.cos(pair.base_helix_angle)
    assert radius / plane == pytest.approx(1.0 / (1.0 - 20.0 / 500.0), rel=1e-9)
    outer = _pair((20, 500), 2.0, 12.0, 20.0)
    mean = 0.5 * (pair.transverse_contact_ratio + outer.transverse_contact_ratio)
    assert abs(pair.transverse_contact_ratio - outer.transverse_contact_ratio) < 0.05 * mean


def test_the_end_that_enters_first_follows_the_hand() -> None:
    assert FVA_1.entry_distance(25e-3) == pytest.approx(0.0)
    left = _pair((27, 51), 4.5, 21.0, 50.0, hand="left")
    assert left.entry_distance(25e-3) == pytest.approx(50e-3)
    assert left.wheel.hand == "right"


#: Changes of a spur pair 22/-61 of module 2 mm, and the figure that decides.
FAULTS: list[tuple[dict[str, Any], str]] = [
    (
        {"helix_angle": 0.2, "wheel_teeth": 61, "wheel_hand": "right"},
        "right-handed, the wheel right",
    ),
    (
        {"helix_angle": 0.2, "wheel_hand": "left"},
        "internal pair on parallel shafts have equal hands",
    ),
    ({"wheel_teeth": -22}, "has 22 teeth, the wheel -22. The gear inside of a ring has fewer"),
    ({"pinion_teeth": -22}, "Only the wheel of a pair may be a ring"),
    ({"pinion_teeth": 57}, "the tips of pinion and ring overlap by 0.815"),
    ({"wheel_tip_diameter": 117e-3}, "passes the base tangent point of the pinion by 1.654"),
    ({"wheel_teeth": -26, "pinion_teeth": 20}, "48 mm. It lies below the base circle of 48.864"),
    ({"wheel_rim_diameter": 120e-3}, "rim diameter 120 mm of a ring without a rim. The root"),
    ({"wheel_teeth": 61, "wheel_rim_diameter": 0.15}, "Only a ring has its rim outside"),
    ({"wheel_bore_diameter": 0.14}, "rim_diameter is the outer diameter of a ring"),
    ({"center_distance": 40e-3}, "the centre distance must be at most 39 mm"),
    ({"center_distance": 36e-3}, "difference of the base radii, 36.648"),
    ({"center_distance": 38.5e-3, "backlash": 1e-4}, "Increase the centre distance to 38.852"),
    ({"helix_angle": 1.1}, "helix_angle must be finite, at least 0 and at most 60 deg"),
    ({"hand": "down"}, "argument hand: hand = 'down'. A helix is right-handed or left-handed"),
]


@pytest.mark.parametrize(("changes", "text"), FAULTS)
def test_faults_name_the_deciding_figure(changes: dict[str, Any], text: str) -> None:
    figures: dict[str, Any] = {
        "pinion_teeth": 22,
        "wheel_teeth": -61,
        "normal_module": 2e-3,
        "normal_pressure_angle": math.radians(20.0),
        "helix_angle": 0.0,
        "pinion_face_width": 20e-3,
    }
    with pytest.raises(InputError) as caught:
        cylindrical_pair(**{**figures, **changes})
    assert text in str(caught.value)


def test_contact_on_a_fillet_of_an_internal_pair_is_a_warning() -> None:
    with pytest.warns(ModelWarning, match="82.732 mm on, but its fillet reaches up to 82.9646 mm"):
        _pair((22, -61), 4.0, 0.0, 20.0)


def _moments(outline: np.ndarray[Any, Any]) -> tuple[float, float]:
    """Area and polar moment of area of a polygon."""
    (x, y), (u, v) = outline[:, :-1], outline[:, 1:]
    area = 0.5 * (x * v - u * y)
    return float(area.sum()), float(
        (area * (x * x + x * u + u * u + y * y + y * v + v * v)).sum() / 6
    )


@pytest.mark.parametrize("gear", [FVA_1.pinion, RING.pinion, RING.wheel], ids=repr)
def test_section_and_mass_are_those_of_the_outline(gear: SpurGear) -> None:
    area, polar = _moments(gear_outline(gear, 2000))
    assert section_moments(gear) == pytest.approx((area, polar), rel=1e-6)
    solid = mass_properties(gear, 7800.0)
    rim = math.pi * gear.rim_radius**2
    if gear.is_ring:
        assert gear.rim_radius == pytest.approx(gear.root_radius + 7e-3)
    sign = -1.0 if gear.is_ring else 1.0
    volume = sign * (area - rim) * gear.face_width
    assert solid.mass == pytest.approx(7800.0 * volume, rel=1e-6)
    spin = sign * (polar - 0.5 * rim * gear.rim_radius**2) * gear.face_width
    assert solid.moment_of_inertia == pytest.approx(7800.0 * spin, rel=1e-6)


@pytest.mark.parametrize("round_", [0.38, 1.0])
def test_fillet_of_a_ring_touches_flank_and_root_circle(round_: float) -> None:
    """Points, angles and directions meet; the wide fillet is the full round of the space."""
    with quiet():
        gear = replace(RING.wheel, rack=BasicRack(1.0, 1.25, round_))
    arc, end = gear.trochoid, gear.form_normal_angle
    assert float(arc.radius(math.pi / 2.0)) == pytest.approx(gear.root_radius, rel=1e-14)
    assert float(arc.half_tooth_angle(end)) == pytest.approx(
        gear.half_tooth_angle(gear.form_radius), abs=1e-13
    )
    step = 1e-6 * gear.form_radius
    on_flank = gear.half_tooth_angle(gear.form_radius) - gear.half_tooth_angle(
        gear.form_radius - step
    )
    turn = 1e-4 * (math.pi / 2.0 - end)
    rise = float(arc.radius(end + turn) - arc.radius(end))
    on_arc = float(arc.half_tooth_angle(end + turn) - arc.half_tooth_angle(end))
    assert on_arc / rise == pytest.approx(on_flank / step, rel=1e-3)
    middle = float(arc.half_tooth_angle(math.pi / 2.0))
    assert middle <= math.pi / 72.0 + 1e-12
    assert (middle == pytest.approx(math.pi / 72.0)) == (round_ == 1.0)


def test_tip_play_is_that_of_the_outlines() -> None:
    """Turn both gears from where they touch; the tips clear by what the ring may turn further."""
    pair = _pair((40, -60), 2.0, 0.0, 20.0, **_shifts(0.4, -0.4))
    pinion, ring, distance = pair.pinion, pair.wheel, pair.center_distance
    ratio, radius = 60.0 / 40.0, pinion.tip_radius
    turns = np.linspace(0.0, 1.5, 200001)
    # Corner of the pinion's tip and of the ring's, each on the line of action where it touches.
    alpha = pair.operating_pressure_angle
    corner = alpha - math.atan(pinion.roll_angle(radius))
    x = distance + radius * np.cos(turns - corner)
    y = radius * np.sin(turns - corner)
    crossing = int(np.argmax(np.hypot(x, y) < ring.tip_radius))
    path = pair.path_limits[1]
    second = abs(pair.line_of_action_length) + path
    touch = math.atan(second / ring.base_radius)
    flank = ring.roll_angle(ring.tip_radius)
    spread = (second / ring.base_radius - touch) - (flank - math.atan(flank))
    ring_corner = turns[crossing] / ratio + (touch - alpha) + spread
    play = ring.tip_radius * (ring_corner - math.atan2(y[crossing], x[crossing]))
    assert tip_play(pair) == pytest.approx(play, abs=2e-7)


def test_modifications_of_a_ring_act_where_its_flank_is_touched() -> None:
    """Tip relief of the ring at A, its root relief at E; a map in roll lengths of a drawing."""
    low, high = RING.path_limits
    first, last = (path - RING.line_of_action_length for path in (low, high))
    chart = ProfileMap((first, last), (0.0,), ((4e-6,), (1e-6,)))

    def gap(path: float, **amounts: Any) -> float:
        gear = replace(RING.wheel, modification=FlankModification(**amounts))
        pair = replace(RING, wheel=gear)
        return float(flank_gap(pair, path, pair.line_of_action_length - path))

    with quiet():
        assert gap(low, tip_relief=7e-6) == pytest.approx(7e-6)
        assert gap(high, tip_relief=7e-6) == pytest.approx(0.0, abs=1e-12)
        assert gap(high, root_relief=5e-6) == pytest.approx(5e-6)
        assert gap(low, profile_map=chart) == pytest.approx(-4e-6)
        assert gap(high, profile_map=chart) == pytest.approx(-1e-6)
        short = ProfileMap((first, 0.5 * (first + last)), (0.0,), ((0.0,), (0.0,)))
        with pytest.raises(InputError, match=r"covers the roll lengths 20\.6"):
            gap(low, profile_map=short)
    assert hunting_period(RING) == 504
    assert tooth_positions(RING.wheel).shape == (72,)
