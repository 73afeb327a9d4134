"""Rolling bearings: closed forms, derivatives, symmetries, published figures, messages."""

import math

import numpy as np
import pytest
from scipy.optimize import brentq

import tribodyn as td
from tribodyn.contact import hertz_ellipse, hertz_line
from tribodyn.errors import ComputationError, InputError, ModelWarning, collected
from tribodyn.machine import (
    ROLLING_BEARINGS,
    AngularContactBallBearing,
    CylindricalRollerBearing,
    DeepGrooveBallBearing,
    TaperedRollerBearing,
)
from tribodyn.machine.static.supports import floating_response, seated

DEG = math.pi / 180.0
STEEL = 207e9 / 0.91
BALLS = {"pitch_diameter": 43.5e-3, "balls": 7, "ball_diameter": 11.5e-3}
ROLLERS = {
    "pitch_diameter": 65e-3,
    "rollers": 14,
    "roller_diameter": 10e-3,
    "roller_length": 9.6e-3,
}
BEARINGS = [
    DeepGrooveBallBearing(**BALLS, radial_clearance=10e-6),
    DeepGrooveBallBearing(**BALLS, radial_clearance=-5e-6, preload=300.0, direction=-1),
    AngularContactBallBearing(**BALLS, contact_angle=25 * DEG, preload=200.0, direction=-1),
    CylindricalRollerBearing(**ROLLERS, radial_clearance=8e-6, profile="logarithmic"),
    TaperedRollerBearing(**ROLLERS, contact_angle=14 * DEG, preload=800.0),
]
POSITIONS = np.array([[30e-6, 25e-6, -12e-6, 4e-4, -7e-4], [-20e-6, -9e-6, 28e-6, -3e-4, 2e-4]])


@pytest.mark.parametrize("bearing", BEARINGS)
@pytest.mark.parametrize("position", POSITIONS)
def test_load_and_stiffness_are_derivatives_of_the_energy(bearing, position):
    _, load, stiffness = bearing.response(position)
    steps = np.array([1e-9, 1e-9, 1e-9, 1e-7, 1e-7])
    for k, step in enumerate(steps):
        shift = np.eye(5)[k] * step
        upper, lower = bearing.response(position + shift), bearing.response(position - shift)
        assert load[k] == pytest.approx((upper[0] - lower[0]) / (2 * step), rel=1e-5, abs=1e-3)
        slopes = (upper[1] - lower[1]) / (2 * step)
        assert stiffness[k] == pytest.approx(
            slopes, rel=1e-3, abs=1e-4 * np.abs(stiffness[k]).max()
        )
    assert np.array_equal(stiffness, stiffness.T)
    assert np.linalg.eigvalsh(stiffness)[0] > -1e-9 * np.trace(stiffness)


@pytest.mark.parametrize("bearing", BEARINGS[:2] + BEARINGS[3:4])
@pytest.mark.parametrize("position", POSITIONS)
def test_a_floating_bearing_has_no_axial_force(bearing, position):
    energy, load, stiffness = floating_response(bearing, position)
    assert load[0] == 0.0
    ring = seated(bearing, position)
    assert abs(bearing.load(ring)[0]) < 1e-6 * np.abs(load).max() + 1e-9
    np.testing.assert_array_equal(ring[1:], position[1:])
    assert energy <= bearing.response(position)[0]  # it slides to the least energy
    steps = np.array([1e-9, 1e-9, 1e-9, 1e-7, 1e-7])
    for k, step in enumerate(steps):
        shift = np.eye(5)[k] * step
        upper = floating_response(bearing, position + shift)
        lower = floating_response(bearing, position - shift)
        slopes = (upper[1] - lower[1]) / (2 * step)
        assert load[k] == pytest.approx((upper[0] - lower[0]) / (2 * step), rel=1e-4, abs=1e-3)
        assert stiffness[k] == pytest.approx(slopes, rel=2e-3, abs=2e-4 * np.abs(stiffness).max())
    radial = DeepGrooveBallBearing(**BALLS).response(np.array([0.0, 2e-5, 1e-5, 0.0, 0.0]))
    moved = np.array([5e-5, 2e-5, 1e-5, 0.0, 0.0])
    floating = floating_response(DeepGrooveBallBearing(**BALLS), moved)
    np.testing.assert_allclose(floating[1], radial[1], atol=1e-9 * np.abs(radial[1]).max())


@pytest.mark.parametrize("bearing", BEARINGS)
def test_displacement_balances_the_load(bearing):
    axial = 0.0 if isinstance(bearing, CylindricalRollerBearing) else 900.0 * bearing.direction
    load = np.array([axial, 1500.0, -700.0, 4.0, -3.0])
    position = bearing.displacement(load)
    assert bearing.load(position) == pytest.approx(load, rel=1e-7, abs=1e-6)


@pytest.mark.parametrize("bearing", BEARINGS)
def test_a_ring_turned_by_one_element_is_the_same(bearing):
    turn = 2 * math.pi / bearing.elements
    cosine, sine = math.cos(turn), math.sin(turn)
    plane = np.array([[cosine, -sine], [sine, cosine]])
    rotation = np.zeros((5, 5))
    rotation[0, 0], rotation[1:3, 1:3], rotation[3:, 3:] = 1.0, plane, plane
    for position in POSITIONS:
        turned = bearing.load(rotation @ position)
        assert turned == pytest.approx(rotation @ bearing.load(position), rel=1e-9, abs=1e-6)


def test_opposite_mounting_is_the_mirror_image():
    mirror = np.array([-1.0, 1.0, 1.0, -1.0, -1.0])
    for kind in (AngularContactBallBearing, TaperedRollerBearing):
        sizes = BALLS if kind is AngularContactBallBearing else ROLLERS
        right, left = (
            kind(**sizes, contact_angle=20 * DEG, preload=500.0, direction=sign) for sign in (1, -1)
        )
        assert right.load([0.0] * 5)[0] == pytest.approx(500.0, rel=1e-9)
        for position in POSITIONS:
            assert left.load(mirror * position) == pytest.approx(mirror * right.load(position))


def test_preload_of_a_bearing_with_interference_is_its_axial_force():
    bearing = TaperedRollerBearing(
        **ROLLERS, contact_angle=14 * DEG, preload=300.0, radial_clearance=-10e-6, direction=-1
    )
    assert bearing.axial_offset > 0.0
    assert bearing.load([0.0] * 5)[0] == pytest.approx(-300.0, rel=1e-9)


def test_axial_load_against_the_equation_of_the_contact_angle():
    """F / Z = c A^1.5 sin(a) (cos(a0)/cos(a) - 1)^1.5, x = A sin(a - a0) / cos(a)."""
    free = 40 * DEG
    bearing = AngularContactBallBearing(
        pitch_diameter=125.3e-3,
        balls=16,
        ball_diameter=22.23e-3,
        inner_groove=0.5232,
        outer_groove=0.5232,
        contact_angle=free,
    )
    position = bearing.displacement([17800.0, 0.0, 0.0, 0.0, 0.0])
    state = bearing.state(position)
    angle = float(state.contact_angle[0])
    distance = 0.0464 * 22.23e-3
    compression = distance * (math.cos(free) / math.cos(angle) - 1.0)
    diameter, slope = 22.23e-3, 22.23e-3 * math.cos(free) / 125.3e-3
    across = diameter / (2.0 - 1.0 / 0.5232)
    force = 17800.0 / 16 / math.sin(angle)
    approach = sum(
        float(hertz_ellipse(force, 0.5 * diameter * (1 + sign * slope), across, STEEL).approach)
        for sign in (-1, 1)
    )
    assert approach == pytest.approx(compression, rel=1e-7)
    expected = distance * math.sin(angle - free) / math.cos(angle)
    assert position[0] == pytest.approx(expected, rel=1e-9)
    assert position[1:] == pytest.approx(0.0, abs=1e-12)
    assert state.element_load == pytest.approx(force, rel=1e-9)
    # Harris, Rolling Bearing Analysis, example of the 218 bearing: 41.6 deg, by a chart of K.
    assert angle / DEG == pytest.approx(41.6, abs=0.15)


def test_deep_groove_bearing_209_of_harris():
    """Rolling Bearing Analysis: 8900 N radially, clearance 15 um: largest ball load 4536 N."""
    bearing = DeepGrooveBallBearing(
        pitch_diameter=65e-3,
        balls=9,
        ball_diameter=12.7e-3,
        inner_groove=0.52,
        outer_groove=0.52,
        radial_clearance=15e-6,
    )
    state = bearing.state(bearing.displacement([0.0, 8900.0, 0.0, 0.0, 0.0]))
    assert state.element_load.max() == pytest.approx(4536.0, rel=0.003)


@pytest.mark.parametrize(
    ("clearance", "load", "expected"),
    [
        (0.0, (0, 1000), (15.1101, 0)),
        (0.0, (1000, 0), (0, 133.5381)),
        (10e-6, (0, 1000), (21.223, 0)),
        (10e-6, (1000, 0), (0, 149.1717)),
        (10e-6, (1000, 1000), (19.5923, 146.4603)),
    ],
)
def test_ball_bearing_against_a_program_after_iso_16281(clearance, load, expected):
    """Displacements in um of a bearing of 7 balls; outer figures of github.com/minzhun/ISO16281.

    The file Test_BallBearing.py there (commit 1b0e9ded) quotes them from a commercial program.
    """
    bearing = DeepGrooveBallBearing(
        **BALLS, radial_clearance=clearance, effective_modulus=210e9 / 0.91
    )
    position = bearing.displacement([*load, 0.0, 0.0, 0.0])
    assert 1e6 * position[1] == pytest.approx(expected[0], rel=1e-4, abs=1e-6)
    assert 1e6 * position[0] == pytest.approx(expected[1], rel=1e-5, abs=1e-6)
    if all(load):  # that program has the tilt at the pitch radius, 1 % below that of the groove
        assert 1e3 * position[4] == pytest.approx(2.6872, rel=0.015)


def integral(zone: float, exponent: float, order: int) -> float:
    """Load distribution integral of Sjovall, by the midpoint rule."""
    reach = math.acos(max(1.0 - 2.0 * zone, -1.0))
    angle = reach * (2.0 * (np.arange(200_000) + 0.5) / 200_000 - 1.0)
    share = (1.0 - (1.0 - np.cos(angle)) / (2.0 * zone)) ** exponent
    return float(np.mean(share * np.cos(angle) ** order) * reach / math.pi)


#: Factors of NSK, Technical Report E728g, section 5.1: Q_max Z cos(alpha) / F_r and F_a / F_r / tan
#: (alpha) where half of the elements carry, of point and line contact.
NSK = {1.5: (4.37, 1.216), 10.0 / 9.0: (4.08, 1.260)}


def large_bearing(exponent: float, angle: float):
    """Bearing with many small elements."""
    if exponent == 1.5:
        sizes = {"pitch_diameter": 0.4, "balls": 200, "ball_diameter": 4e-3}
        kind = AngularContactBallBearing if angle else DeepGrooveBallBearing
        return kind(**sizes, contact_angle=angle)
    sizes = {"pitch_diameter": 0.4, "rollers": 200, "roller_diameter": 4e-3, "roller_length": 4e-3}
    kind = TaperedRollerBearing if angle else CylindricalRollerBearing
    return kind(**sizes, contact_angle=angle)


@pytest.mark.parametrize("exponent", NSK)
def test_largest_load_without_clearance_is_that_of_stribeck(exponent):
    bearing = large_bearing(exponent, 0.0)
    state = bearing.state([0.0, 1e-6, 0.0, 0.0, 0.0])
    factor = state.element_load.max() * bearing.elements / state.load[1]
    assert factor == pytest.approx(1.0 / integral(0.5, exponent, 1), rel=3e-4)
    assert factor == pytest.approx(NSK[exponent][0], abs=0.006)


@pytest.mark.parametrize("exponent", NSK)
@pytest.mark.parametrize("zone", [0.3, 0.5, 0.8])
def test_load_zone_follows_the_integrals_of_sjovall(exponent, zone):
    angle = 20 * DEG
    bearing = large_bearing(exponent, angle)
    radial = 1e-8  # so small that contact angles stay
    axial = (2.0 * zone - 1.0) * radial / math.tan(angle)
    state = bearing.state([axial, radial, 0.0, 0.0, 0.0])
    radial_integral, axial_integral = (integral(zone, exponent, k) for k in (1, 0))
    top = state.element_load.max() * bearing.elements
    assert state.load[1] == pytest.approx(top * math.cos(angle) * radial_integral, rel=2e-3)
    assert state.load[0] == pytest.approx(top * math.sin(angle) * axial_integral, rel=2e-3)
    if zone == 0.5:
        ratio = state.load[0] / state.load[1] / math.tan(angle)
        assert ratio == pytest.approx(NSK[exponent][1], abs=0.003)


def test_roller_carries_the_force_of_iso_16281():
    """35948 N/mm^2 L^(8/9) delta^(10/9), and half the radial clearance is lost first."""
    bearing = CylindricalRollerBearing(**ROLLERS, radial_clearance=20e-6)
    assert np.all(bearing.load([0.0, 9.9e-6, 0.0, 0.0, 0.0]) == 0.0)
    state = bearing.state([0.0, 30e-6, 0.0, 0.0, 0.0])
    assert state.element_load[0] == pytest.approx(35948 * 9.6 ** (8 / 9) * 0.02 ** (10 / 9))
    per_length = state.element_load[0] / 9.6e-3
    slope = 10.0 / 65.0
    for pressure, sign in ((state.inner_pressure, -1), (state.outer_pressure, 1)):
        line = hertz_line(per_length, 5e-3 * (1 + sign * slope), STEEL)
        assert pressure[0] == pytest.approx(float(line.maximum_pressure), rel=1e-9)


def test_ball_pressure_is_that_of_hertz():
    bearing = DeepGrooveBallBearing(**BALLS)
    state = bearing.state([0.0, 20e-6, 0.0, 0.0, 0.0])
    slope, across = 11.5 / 43.5, 11.5e-3 / (2 - 1 / 0.52)
    contact = hertz_ellipse(state.element_load[0], 5.75e-3 * (1 - slope), across, STEEL)
    assert state.inner_pressure[0] == pytest.approx(float(contact.maximum_pressure), rel=1e-9)
    assert state.inner_pressure[0] > state.outer_pressure[0]


def test_laminae_converge_and_a_profile_relieves_the_ends():
    tilt = [0.0, 12e-6, 0.0, 0.0, 1e-3]
    moments = [CylindricalRollerBearing(**ROLLERS, laminae=n).load(tilt)[4] for n in (30, 400)]
    assert moments[0] == pytest.approx(moments[1], rel=5e-3)
    straight, crowned = (
        CylindricalRollerBearing(**ROLLERS, profile=profile) for profile in ("none", "logarithmic")
    )
    assert crowned.state(tilt).inner_pressure.max() < straight.state(tilt).inner_pressure.max()
    # 0.00035 D ln(1/(1 - (2x/L)^2)) at each of both contacts, in the outermost lamina.
    share = 1.0 - 1.0 / 30
    assert crowned.lamina_gaps[-1] == pytest.approx(-0.0007 * 10e-3 * math.log(1 - share**2))
    assert crowned.lamina_gaps[14] < 1e-3 * crowned.lamina_gaps[-1]


def test_clearance_sets_the_free_contact_angle():
    bearing = DeepGrooveBallBearing(**BALLS, radial_clearance=10e-6)
    distance = 0.05 * 11.5e-3
    assert math.cos(bearing.free_contact_angle) == pytest.approx(1 - 5e-6 / distance, rel=1e-12)
    end_play = distance * math.sin(bearing.free_contact_angle)
    assert bearing.load([0.999 * end_play, 0, 0, 0, 0])[0] == 0.0
    assert bearing.load([1.001 * end_play, 0, 0, 0, 0])[0] > 0.0
    assert bearing.load([-1.01 * end_play, 0, 0, 0, 0])[0] < 0.0


def test_centres_of_curvature_in_one_point_carry_nothing():
    bearing = DeepGrooveBallBearing(**BALLS)
    load = bearing.load([0.0, -bearing.centre_distance, 0.0, 0.0, 0.0])  # of the first ball
    assert np.all(np.isfinite(load))
    assert load[1] < 0.0


def test_missing_dimensions_are_estimated_and_listed():
    bearing = DeepGrooveBallBearing(bore_diameter=45e-3, outer_diameter=85e-3)
    assert (bearing.balls, bearing.pitch_diameter) == (9, 65e-3)  # as a 6209 has
    assert bearing.ball_diameter == pytest.approx(12.7e-3, rel=0.06)
    assert [note.split(" = ")[0] for note in bearing.assumptions] == [
        "pitch_diameter",
        "ball_diameter",
        "balls",
    ]
    roller = CylindricalRollerBearing(bore_diameter=45e-3, outer_diameter=85e-3, width=19e-3)
    assert (roller.rollers, roller.roller_diameter) == (16, pytest.approx(10e-3))
    assert "roller_length = 11.4 mm" in roller.assumptions[-1]
    assert DeepGrooveBallBearing(**BALLS).assumptions == ()


@pytest.mark.parametrize(
    ("kind", "changes", "text"),
    [
        ("deep-groove", {"balls": None}, "DeepGrooveBallBearing.balls: balls is missing"),
        ("deep-groove", {"balls": 13}, "space for 11 of 11.5 mm"),
        ("deep-groove", {"balls": 9.5}, "DeepGrooveBallBearing.balls: balls = 9.5"),
        ("cylindrical-roller", {"laminae": 1}, "CylindricalRollerBearing.laminae"),
        ("deep-groove", {"inner_groove": 0.49}, "usually 0.515 to 0.53"),
        ("deep-groove", {"radial_clearance": 2e-3}, "radial_clearance = 2 mm"),
        ("deep-groove", {"contact_angle": 0.2}, "angular-contact"),
        ("deep-groove", {"direction": 0}, "direction = 0"),
        ("deep-groove", {"outer_diameter": 50e-3, "bore_diameter": 40e-3}, "rolling elements of"),
        ("angular-contact", {}, "contact_angle = 0 deg"),
        ("tapered-roller", {}, "contact_angle = 0 deg"),
        ("cylindrical-roller", {"preload": 10.0}, "carries no axial force"),
        ("cylindrical-roller", {"roller_length": None}, "roller_length or width"),
        ("cylindrical-roller", {"profile": "crowned"}, "logarithmic"),
    ],
)
def test_messages_name_the_field(kind, changes, text):
    sizes = BALLS if kind in ("deep-groove", "angular-contact") else ROLLERS
    with pytest.raises(InputError) as error:
        ROLLING_BEARINGS[kind](**{**sizes, **changes})
    assert text in str(error.value)


def test_pressures_above_the_static_limit_warn():
    bearing = DeepGrooveBallBearing(**BALLS)
    high = bearing.displacement([0.0, 30e3, 0.0, 0.0, 0.0])
    with pytest.warns(ModelWarning, match=r"bearing-pressure.* above the 4200 MPa of ISO 76"):
        assert bearing.state(high).inner_pressure.max() > 4.2e9


@pytest.mark.parametrize(
    ("bearing", "limit", "power"),
    [
        (DeepGrooveBallBearing(**BALLS), 4.2e9, 3),
        (AngularContactBallBearing(**BALLS, contact_angle=25 * DEG, preload=200.0), 4.2e9, 3),
        (CylindricalRollerBearing(**ROLLERS), 4.0e9, 2),
    ],
)
def test_the_warning_begins_at_the_pressure_of_the_static_rating(bearing, limit, power):
    """Hertz: the load of an element grows with the third (point) or second power (line)."""
    direction = np.array([0.0, 1.0, 0.0, 0.0, 0.0])

    def peak(depth):
        with collected() as warnings:
            state = bearing.state(depth * direction)
        pressure = max(state.inner_pressure.max(), state.outer_pressure.max())
        return pressure, state.element_load.max(), [each.code for each in warnings]

    depth = brentq(lambda x: peak(x)[0] - limit, 1e-6, 1.5e-3, xtol=1e-12)
    below, above = peak(depth - 1e-8), peak(depth + 1e-8)
    assert below[2] == []
    assert above[2] == ["bearing-pressure"]
    half, load, _ = peak(0.3 * depth)
    assert (limit / half) ** power == pytest.approx(above[1] / load, rel=2e-3)
    assert 0.2 < half / limit < 0.9


def test_loads_that_no_displacement_balances():
    with pytest.raises(ComputationError, match="carries no axial force"):
        CylindricalRollerBearing(**ROLLERS).displacement([100.0, 500.0, 0.0, 0.0, 0.0])
    tapered = TaperedRollerBearing(**ROLLERS, contact_angle=14 * DEG)
    with pytest.raises(ComputationError, match=r"along \+x only"):
        tapered.displacement([-100.0, 500.0, 0.0, 0.0, 0.0])
    with pytest.raises(InputError, match="cannot carry it"):
        DeepGrooveBallBearing(**BALLS, preload=1e8).load([0.0] * 5)
    with pytest.raises(InputError, match=r"shape \(6,\)"):
        tapered.load([0.0] * 6)
    angular = AngularContactBallBearing(**BALLS, contact_angle=15 * DEG)
    with pytest.warns(ModelWarning, match="low shoulder"):
        angular.state(angular.displacement([-50.0, 500.0, 0.0, 0.0, 0.0]))


def test_the_warning_of_a_machine_names_each_bearing_above_its_limit():
    case = td.load_case("two-stage-spur").replace({"operation.torque": "3000 N*m"})
    with collected() as warnings:
        balance = td.machine.static_balance(case.machine())
    listed = " ".join(each.message for each in warnings if each.code == "bearing-pressure")
    for name, bearing in balance.bearings.items():
        peak = max(bearing.state.inner_pressure.max(), bearing.state.outer_pressure.max())
        ball = "ball" in type(case.machine().bearings[name].rolling).__name__.lower()
        limit = 4.2e9 if ball else 4.0e9
        assert (f'bearing "{name}": ' in listed) == (peak > limit)
        assert peak < limit or f"reaches {1e-6 * peak:.0f} MPa" in listed
    assert 0 < sum(each.code == "bearing-pressure" for each in warnings) < len(balance.bearings)
