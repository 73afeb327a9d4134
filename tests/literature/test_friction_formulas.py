"""Every friction formula against its printed form, in the units of its paper."""

from __future__ import annotations

import math

import numpy as np
import pytest

from known_pairs import pair_of, standard, type_c
from references import friction_formulas as printed
from tribodyn.ehl import film_load_share
from tribodyn.errors import InputError, ModelWarning, quiet
from tribodyn.friction import (
    LAWS,
    TribologicalContact,
    drozdov,
    exponential,
    iso_6336_22,
    iso_14179_1,
    iso_14179_2,
    matsumoto,
    measured,
    misharin,
    mixed_ehl,
    niemann,
    odonoghue_cameron,
    pitch_point,
    schlenk,
    xu_2007,
)

#: N/mm, m/s (sum), mm, mPa s, um
STATES = [
    (133.022, 2.63331, 8.38209, 82.0, 0.53),
    (420.0, 11.0, 14.0, 25.0, 0.3),
    (60.0, 24.0, 5.0, 160.0, 1.2),
]
#: m/s, m/s (sum), mPa s, g/cm^3, GPa, um, mm
DISCS = [
    (0.913038, 2.815906, 82.0, 0.88, 0.754725, 0.53, 8.577181),
    (3.2, 14.0, 30.0, 0.85, 1.2, 0.2, 20.0),
]
KGF = 98066.5


def si(load, rolling, radius, viscosity, ra):
    return load * 1e3, rolling, radius * 1e-3, viscosity * 1e-3, ra * 1e-6


@pytest.mark.parametrize("state", STATES)
@pytest.mark.parametrize("oil", [1.0, 0.8])
def test_means_of_the_mesh(state, oil):
    state_si = si(*state)
    assert schlenk(*state_si, oil) == pytest.approx(printed.schlenk(*state, oil), rel=1e-12)
    assert iso_6336_22(*state_si, oil) == pytest.approx(printed.iso_6336_22(*state, oil), rel=1e-12)
    coefficient = niemann(*state_si, 73.2e-3, oil)
    assert coefficient == pytest.approx(printed.niemann(*state, 73.2, oil), rel=1e-12)
    older = niemann(*state_si, 73.2e-3, oil, form="iso-tc60")
    assert older == pytest.approx(printed.iso_tc60(*state), rel=1e-12)


def test_schlenk_of_fzg_a():
    point = pitch_point(pair_of(), 30.0 * math.pi, 90.0)
    state = (point.load_per_width, point.sum_velocity, point.equivalent_radius, 0.082, 0.53e-6)
    assert schlenk(*state) == pytest.approx(0.047058, rel=1e-5)


def test_second_part_of_iso_14179_holds_load_and_speed():
    state_si = si(*STATES[1])
    assert iso_14179_2(*state_si, 14.0) == pytest.approx(schlenk(*state_si), rel=1e-12)
    light = si(50.0, 2.0, 8.0, 82.0, 0.5)
    coefficient = printed.schlenk(150.0, 2.0, 8.0, 82.0, 0.5)
    assert iso_14179_2(*light, 3.0) == pytest.approx(coefficient, rel=1e-12)
    fast = si(300.0, 60.0, 8.0, 82.0, 0.5)
    coefficient = printed.schlenk(300.0, 40.0, 8.0, 82.0, 0.5)
    assert iso_14179_2(*fast, 75.0) == pytest.approx(coefficient, rel=1e-12)


@pytest.mark.parametrize(("speed", "intensity", "kinematic"), [(3.45, 2.8, 93.2), (20.0, 9.0, 15)])
def test_first_part_of_iso_14179(speed, intensity, kinematic):
    coefficient = iso_14179_1(speed, intensity * 1e6, kinematic * 1e-6)
    assert coefficient == pytest.approx(printed.iso_14179_1(speed, intensity, kinematic), rel=1e-12)


@pytest.mark.parametrize("disc", DISCS)
def test_discs(disc):
    sliding, rolling, viscosity, density, pressure, rough, radius = disc
    kinematic = viscosity / density
    speeds = (sliding, 0.5 * rolling)
    with quiet("friction-range"):
        # Drozdov starts at 3 m/s, and Misharin's coefficient ends at 0.08.
        coefficients = (
            misharin(*speeds, kinematic * 1e-6, pressure * 1e9),
            drozdov(*speeds, kinematic * 1e-6, pressure * 1e9),
        )
    wanted = min(printed.misharin(sliding, rolling, kinematic), 0.08)
    assert coefficients[0] == pytest.approx(wanted, rel=1e-12)
    wanted = printed.drozdov(sliding, rolling, kinematic, pressure * 1e9 / KGF)
    assert coefficients[1] == pytest.approx(wanted, rel=1e-12)
    inch = 0.0254
    wanted = printed.odonoghue_cameron(
        sliding / inch, rolling / inch, viscosity, rough / inch, radius / (1e3 * inch)
    )
    coefficients = odonoghue_cameron(*speeds, viscosity * 1e-3, rough * 1e-6, radius * 1e-3)
    assert coefficients == pytest.approx(wanted, rel=1e-12)


@pytest.mark.parametrize("disc", DISCS)
def test_xu_by_its_second_source(disc):
    sliding, rolling, viscosity, _, pressure, rough, radius = disc
    entrainment = 0.5 * rolling
    state = sliding / entrainment, pressure, viscosity, rough, entrainment, radius * 1e-3
    coefficient = xu_2007(
        state[0], pressure * 1e9, viscosity * 1e-3, rough * 1e-6, entrainment, radius * 1e-3
    )
    assert coefficient == pytest.approx(printed.xu(*state), rel=1e-12)


def test_misharin_is_limited_with_a_warning_where_sliding_stops():
    with pytest.warns(ModelWarning, match="friction coefficient inf, fitted for 0.02 to 0.08"):
        assert misharin(0.0, 2.0, 93e-6) == 0.08


def test_drozdov_beyond_every_disc_is_refused():
    with pytest.raises(InputError, match="far beyond the discs"):
        drozdov(0.0, 50.0, 93e-6, 60e9)


def test_load_share_is_the_fit_below_its_peak_and_one_above():
    ratios = np.array([0.05, 0.2, 0.9, 1.7])
    assert film_load_share(ratios) == pytest.approx([printed.load_share(x) for x in ratios])
    for ratio in (2.1, 2.2576, 4.0, 10.0, math.inf):
        assert film_load_share(ratio) == 1.0
    assert printed.load_share(10.0) == pytest.approx(0.68, abs=0.01)  # what the fit itself does
    fine = np.linspace(0.0, 5.0, 4001)
    assert np.all(np.diff(film_load_share(fine)) >= 0.0)
    assert film_load_share(0.0) == 0.0


@pytest.mark.parametrize("ratio", [-0.1, math.nan])
def test_load_share_of_no_film_ratio(ratio):
    with pytest.raises(InputError, match="film_ratio"):
        film_load_share(ratio)


def test_mixed_friction_and_its_limits():
    share = printed.load_share(0.5)
    assert mixed_ehl(0.5, 0.05) == pytest.approx(0.05 * share**1.2 + 0.15 * (1.0 - share))
    assert mixed_ehl(0.0, 0.05) == 0.15
    assert mixed_ehl(math.inf, 0.05) == pytest.approx(0.05, rel=1e-15)
    assert mixed_ehl(0.0, 0.05, 0.1) == pytest.approx(0.1)
    assert matsumoto(1e-6, 1e-6, 0.03) == pytest.approx(0.03)
    assert matsumoto(1e-6, 10e-6, 0.03, 0.12) == pytest.approx(0.075)
    assert matsumoto(1e-6, 1e-7, 0.03) == pytest.approx(0.03)
    with pytest.warns(ModelWarning, match="heights over film 1000"):
        assert matsumoto(1e-9, 1e-6, 0.03, 0.12) == pytest.approx(0.12)


def test_exponential_has_no_friction_without_sliding_and_no_units_left():
    assert exponential(0.0, 1e9, 0.8e-6) == 0.0
    coefficient = exponential(0.5, 0.7e9, 1.6e-6, 0.05, 0.3, 0.6)
    wanted = 0.05 * math.exp(0.15) * (2.0 / math.sqrt(0.7)) ** 0.6 * math.tanh(25.0)
    assert coefficient == pytest.approx(wanted, rel=1e-12)
    # The references are units: any others with the coefficient that belongs to them give the same.
    other = exponential(
        0.5, 0.7e9, 1.6e-6, 0.05 * 4.0**0.3, 0.3, 0.6,
        reference_roughness=1.6e-6, reference_pressure=1e9,
    )  # fmt: skip
    assert other == pytest.approx(coefficient, rel=1e-12)


def test_exponent_of_the_roughness_fits_the_printed_table():
    # Coefficients at 0.8, 1.6 and 3.2 um at four positions near the pitch point.
    table = [(0.052, 0.112), (0.048, 0.104), (0.041, 0.091), (0.045, 0.099)]
    exponents = [math.log(rough / smooth) / math.log(4.0) for smooth, rough in table]
    exponent = math.log(exponential(0.5, 1e9, 3.2e-6) / exponential(0.5, 1e9, 0.8e-6)) / math.log(
        4.0
    )
    assert exponent == pytest.approx(np.mean(exponents), abs=5e-4)
    smooth = np.mean([smooth for smooth, _ in table])
    assert exponential(0.5, 1e9, 0.8e-6) == pytest.approx(smooth, rel=1e-12)


RPM = math.pi / 30.0


def test_measured_points_are_met_and_joined_in_logarithms():
    torques, speeds = [50, 150, 300, 150, 150], [1400, 1400, 1400, 400, 1800]
    printed_points = [0.0271, 0.0692, 0.119, 0.1505, 0.0554]
    coefficients = measured(torques, np.array(speeds) * RPM)
    assert coefficients == pytest.approx(printed_points, rel=1e-12)
    between = measured(math.sqrt(50.0 * 150.0), 1400 * RPM)
    assert between == pytest.approx(math.sqrt(0.0271 * 0.0692), rel=1e-12)
    power = measured([100.0, 200.0], RPM * np.array([500.0, 700.0]), *grid_of_a_power_law())
    wanted = 0.05 * np.array([1.0, 2.0]) ** 0.3 * np.array([0.5, 0.7]) ** -0.2
    assert power == pytest.approx(wanted, rel=1e-12)


def grid_of_a_power_law():
    torque, speed = np.meshgrid([50.0, 120.0, 400.0], RPM * np.array([300.0, 900.0]))
    mu = 0.05 * (torque / 100.0) ** 0.3 * (speed / (1000.0 * RPM)) ** -0.2
    return torque.ravel(), speed.ravel(), mu.ravel()


def test_friction_is_constant_outside_of_the_measured_points():
    table = grid_of_a_power_law()
    with pytest.warns(ModelWarning, match=r"800 N\*m at 600 rpm is outside"):
        beyond = measured(800.0, 600.0 * RPM, *table)
    assert beyond == pytest.approx(measured(400.0, 600.0 * RPM, *table), rel=1e-9)


def test_measured_points_of_one_speed_and_one_point_alone():
    line = ([50.0, 200.0], [100.0, 100.0], [0.03, 0.06])
    assert measured(100.0, 100.0, *line) == pytest.approx(math.sqrt(0.03 * 0.06))
    assert measured(50.0, 100.0, [50.0], [100.0], [0.04]) == pytest.approx(0.04)


@pytest.mark.parametrize(
    ("table", "message"),
    [
        (([50.0, 60.0], [100.0], [0.03]), "2 measured_torques, 1 measured_speeds"),
        (([50.0, 50.0], [100.0, 100.0], [0.03, 0.04]), r"two points at 50 N\*m and 954.9 rpm"),
        (([50.0], [100.0], [-0.03]), "measured_coefficients = -0.03"),
        (([50.0], [100.0], [1.2]), "measured_coefficients = 1.2"),
        (([50.0], [0.0], [0.03]), "measured_speeds = 0 rad/s"),
    ],
)
def test_bad_tables_are_explained(table, message):
    with pytest.raises(InputError, match=message):
        measured(50.0, 100.0, *table)


@pytest.mark.parametrize("pair", [pair_of(), type_c(), pair_of(driver="wheel"), standard((20, 31))])
def test_pitch_point_of_any_pair(pair):
    point = pitch_point(pair, 120.0, 80.0)
    angle = pair.operating_pressure_angle
    radius = pair.center_distance / (1.0 + pair.ratio)
    assert point.pitch_line_velocity == pytest.approx(120.0 * radius)
    assert point.sum_velocity == pytest.approx(2.0 * 120.0 * radius * math.sin(angle))
    reduced = radius * math.sin(angle) * pair.ratio / (1.0 + pair.ratio)
    assert point.equivalent_radius == pytest.approx(reduced)
    tangential = 80.0 / radius
    width = pair.common_face_width
    assert point.load_per_width == pytest.approx(tangential / math.cos(angle) / width)
    z1, z2 = pair.pinion.teeth, pair.wheel.teeth
    intensity = 80.0 * (z1 + z2) / (2.0 * width * radius**2 * z2)  # ISO/TR 14179-1
    assert point.load_intensity == pytest.approx(intensity)
    turned = 1.0 if pair.driver == "pinion" else z2 / z1
    assert (point.driving_torque, point.driving_speed) == pytest.approx((80 * turned, 120 / turned))


def contact(**changes):
    state = {
        "load_per_width": np.array([133e3, 66e3]),
        "hertz_pressure": np.array([0.75e9, 0.57e9]),
        "sliding_speed": np.array([0.9, -0.5]),
        "entrainment_speed": np.array([1.8, 1.6]),
        "slide_to_roll_ratio": np.array([0.5, -0.3125]),
        "equivalent_radius": np.array([8.5e-3, 7.5e-3]),
        "dynamic_viscosity": 0.082,
        "composite_roughness": 0.53e-6,
        "oil_density": 880.0,
        "film_thickness": np.array([0.4e-6, 0.3e-6]),
        "pitch": pitch_point(pair_of(), 1400.0 * RPM, 150.0),
    }
    return TribologicalContact(**{**state, **changes})


def test_laws_hand_the_pitch_point_and_the_roughness_to_their_formulas():
    c = contact()
    point = c.pitch
    state = (point.load_per_width, point.sum_velocity, point.equivalent_radius, 0.082)
    # Two equal Gaussian flanks: rms of one is composite/sqrt(2), and Ra is sqrt(2/pi) of it.
    ra = 0.53e-6 / math.sqrt(2.0) * math.sqrt(2.0 / math.pi)
    oil = {"lubricant_factor": 0.8}
    assert LAWS["schlenk"](c, **oil) == pytest.approx([schlenk(*state, ra, 0.8)] * 2)
    coefficient = LAWS["schlenk"](c, roughness_ra=0.4e-6)
    assert coefficient == pytest.approx([schlenk(*state, 0.4e-6)] * 2)
    assert LAWS["iso-6336-22"](c, load_factor=1.5, **oil) == pytest.approx(
        [iso_6336_22(1.5 * state[0], *state[1:], ra, 0.8)] * 2
    )
    diameter = point.pinion_pitch_diameter
    assert LAWS["niemann"](c) == pytest.approx([niemann(*state, ra, diameter)] * 2)
    speed = point.pitch_line_velocity
    assert LAWS["iso-14179"](c) == pytest.approx([iso_14179_2(*state, ra, speed)] * 2)
    first = iso_14179_1(speed, point.load_intensity, 0.082 / 880.0)
    assert LAWS["iso-14179"](c, part="1") == pytest.approx([first] * 2)
    assert LAWS["measured"](c) == pytest.approx([0.0692] * 2)


def test_mixed_laws_take_film_and_roughness_from_the_contact():
    c = contact()
    film = LAWS["xu-2007"](c)
    assert LAWS["mixed-ehl"](c) == pytest.approx(mixed_ehl(c.film_thickness / 0.53e-6, film))
    mixed = LAWS["mixed-ehl"](c, ehl_friction_coefficient=0.04, boundary_friction_coefficient=0.1)
    assert mixed == pytest.approx(mixed_ehl(c.film_thickness / 0.53e-6, 0.04, 0.1))
    smooth = LAWS["mixed-ehl"](contact(composite_roughness=0.0))
    assert smooth == pytest.approx(LAWS["xu-2007"](contact(composite_roughness=0.0)), rel=1e-12)
    coefficient = LAWS["matsumoto"](c, film_friction_coefficient=0.03, maximum_heights=4e-6)
    assert coefficient == pytest.approx(matsumoto(c.film_thickness, 4e-6, 0.03))


def test_disc_laws_read_the_contact():
    c = contact()
    speeds = (c.sliding_speed, c.entrainment_speed)
    nu = 0.082 / 880.0
    assert LAWS["drozdov"](c) == pytest.approx(drozdov(*speeds, nu, c.hertz_pressure))
    with pytest.warns(ModelWarning, match="misharin"):
        coefficient = LAWS["misharin"](c)
    with pytest.warns(ModelWarning, match="misharin"):
        assert coefficient == pytest.approx(misharin(*speeds, nu, c.hertz_pressure))
    wanted = odonoghue_cameron(*speeds, 0.082, 0.53e-6, c.equivalent_radius)
    assert LAWS["odonoghue-cameron"](c) == pytest.approx(wanted)
    wanted = exponential(c.slide_to_roll_ratio, c.hertz_pressure, 0.53e-6)
    assert LAWS["exponential"](c) == pytest.approx(wanted)
