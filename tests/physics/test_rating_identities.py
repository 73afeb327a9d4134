"""Ratings against closed forms: Hertz, limits of tools, linear damage, load over the face."""

from __future__ import annotations

import math

import numpy as np
import pytest

from known_ratings import (
    SPUR_GEARS,
    STEEL,
    TEST_OIL,
    helical_example,
    rate_helical,
    rate_spur,
    ring_example,
    spur_example,
)
from tribodyn.contact import effective_modulus, hertz_line, path_of_contact
from tribodyn.rating import (
    RatedGear,
    ShaperCutter,
    SpectrumLoad,
    cycles_to_failure,
    dynamic_factor,
    face_load_factor,
    rate_pair,
    rate_spectrum,
)
from tribodyn.rating.life import bending_curve, pitting_curve
from tribodyn.rating.root_section import arc_section, cutter_section, rack_section


def pressure(pair, path, load):
    radius = float(path_of_contact(pair).kinematics(np.array([path]), 100.0).equivalent_radius[0])
    return float(hertz_line(load, radius, effective_modulus(STEEL, STEEL)).maximum_pressure)


@pytest.mark.parametrize("pair", [spur_example(), ring_example()], ids=["spur", "ring"])
def test_contact_stress_of_spur_pairs_is_that_of_hertz(pair):
    rating = rate_pair(pair, torque=200.0, speed=100.0, oil=TEST_OIL)
    factors, contact = rating.factors, path_of_contact(pair)
    load = factors["F_t"] / math.cos(pair.transverse_pressure_angle) / pair.common_face_width
    at_c = factors["sigma_H0"] / factors["Z_eps"]
    assert pressure(pair, contact.C, load) == pytest.approx(at_c, rel=1e-12)
    assert pressure(pair, contact.B, load) == pytest.approx(at_c * factors["M_1"], rel=1e-12)
    assert pressure(pair, contact.D, load) == pytest.approx(at_c * factors["M_2"], rel=1e-12)


def test_contact_stress_of_a_helical_pair_is_that_of_the_mean_line():
    pair, factors = helical_example(), rate_helical().factors
    normal = factors["F_t"] / math.cos(pair.transverse_pressure_angle)
    normal /= math.cos(pair.base_helix_angle)
    line = pair.common_face_width * pair.transverse_contact_ratio / math.cos(pair.base_helix_angle)
    nominal = pressure(pair, path_of_contact(pair).C, normal / line)
    assert nominal == pytest.approx(factors["sigma_H0"] / factors["Z_beta"], rel=1e-12)


def test_a_cutter_of_many_teeth_is_a_rack():
    gear = spur_example().pinion
    rack, differences = rack_section(gear), []
    for teeth in (200, 400):
        cutter = ShaperCutter(teeth=teeth, tip_radius_coefficient=0.375)
        section = cutter_section(gear, cutter)
        differences.append(np.array(section[:3]) - np.array(rack[:3]))
    first, second = np.abs(differences)
    assert first / second == pytest.approx(np.full(3, 2.0), rel=0.05)  # as 1/z_0
    extrapolated = 2.0 * differences[1] - differences[0]
    assert np.abs(extrapolated).max() < 1e-3


@pytest.mark.parametrize("gear", [spur_example().wheel, helical_example().pinion])
@pytest.mark.parametrize("teeth", [20, 40])
def test_the_fillet_of_a_cutter_lies_on_the_envelope_of_its_tip(gear, teeth):
    """Brute force: the boundary of all positions of the tip round touches the critical section."""
    check_envelope(gear, ShaperCutter(teeth=teeth))


@pytest.mark.parametrize("teeth", [20, 25, 40])
def test_the_fillet_of_a_ring_lies_on_the_envelope_of_the_cutter(teeth):
    ring = ring_example().wheel
    check_envelope(ring, ShaperCutter(teeth=teeth, profile_shift_coefficient=0.1))
    section = cutter_section(ring, ShaperCutter(teeth=teeth))
    drawn = arc_section(ring)
    assert section.chord == pytest.approx(drawn.chord, rel=0.05)


def check_envelope(gear, cutter):
    from tribodyn.rating.root_section import _Envelope

    envelope, section = _Envelope(gear, cutter), cutter_section(gear, cutter)
    sign, half = gear.sign, math.pi / envelope.teeth
    rolls = np.linspace(-0.6, 0.6, 24001)
    along = envelope.center * np.cos(rolls + envelope.angle)
    across = envelope.center * np.sin(rolls + envelope.angle)
    x = envelope.pitch + sign * (envelope.cutter_pitch - along)
    turned = rolls * envelope.cutter_pitch / envelope.pitch + half
    radius, angle = np.hypot(x, across), turned - np.arctan2(across, x)
    centers = np.array([radius * np.cos(angle), radius * np.sin(angle)])
    # Distance of the section's point from all positions of the round: its radius, nowhere less.
    point = np.array([[section.center_distance], [0.5 * section.chord]])
    least = np.hypot(*(centers - point)).min()
    assert least == pytest.approx(envelope.rho, abs=1e-7)
    # A second point on the tangent of the section at the stated angle leaves the fillet at once.
    tilt = math.pi / 3.0 if gear.is_ring else math.pi / 6.0
    step = 1e-3 * np.array([[-sign * math.cos(tilt)], [math.sin(tilt)]])
    for side in (1.0, -1.0):
        beside = np.hypot(*(centers - point - side * step)).min() - envelope.rho
        assert abs(beside) == pytest.approx(0.5e-6 / section.fillet_radius, rel=0.05)


def test_dynamic_factor_tends_to_one_without_speed_and_steps_as_the_standard_has_it():
    terms = 0.4, 0.3, 0.6
    assert dynamic_factor(0.0, 1.5, terms).value == 1.0
    for ratio in (1.4, 1.9, 2.6):
        ends = [dynamic_factor(n, ratio, terms).value for n in (1.15, 1.5)]
        middle = dynamic_factor(1.325, ratio, terms).value
        assert middle == pytest.approx(sum(ends) / 2.0, rel=1e-12)
        assert dynamic_factor(1.5 - 1e-9, ratio, terms).value == pytest.approx(ends[1], abs=1e-8)
    below, above = (dynamic_factor(0.85 + d, 1.5, terms).value for d in (0.0, 1e-9))
    sums = 0.32 * 0.4 + 0.34 * 0.3
    assert below == pytest.approx(1.0 + 0.85 * (sums + 0.23 * 0.6), rel=1e-12)
    assert above == pytest.approx(1.0 + sums + 0.9 * 0.6, rel=1e-12)
    fast = dynamic_factor(3.0, 2.6, terms).value
    assert fast == pytest.approx(0.47 * 0.4 + 0.12 / 0.86 * 0.3 + 1.0, rel=1e-12)


@pytest.mark.parametrize("misalignment", [2e-6, 20e-6, 60e-6])
def test_face_load_factor_is_that_of_a_linear_error_on_springs(misalignment):
    stiffness, load, width = 18e9, 400e3, 1.0
    factor = face_load_factor(misalignment, stiffness, load)
    y = np.linspace(-0.5, 0.5, 200001) * width
    low, high = -1e-3, 1e-3
    for _ in range(200):
        shift = 0.5 * (low + high)
        pressed = np.maximum(stiffness * (shift + misalignment * y / width), 0.0)
        low, high = (shift, high) if np.trapezoid(pressed, y) < load else (low, shift)
    assert pressed.max() / load == pytest.approx(factor, rel=1e-5)


@pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")  # a bulk at 277 degC
def test_one_load_case_has_the_safety_of_its_cycles():
    for edition, torque in ((2019, 200.0), (2006, 320.0)):
        rating = rate_spur(
            torque=torque, edition=edition, required_life=3.6e6,
            pinion=RatedGear(material=STEEL), wheel=RatedGear(material=STEEL),
        )  # fmt: skip
        speed = 1500.0 * math.pi / 30.0
        spectrum = rate_spectrum(
            spur_example(), cases=[SpectrumLoad(torque, speed, 3.6e6)], oil=TEST_OIL,
            pinion=RatedGear(material=STEEL), wheel=RatedGear(material=STEEL), edition=edition,
            application_factor=1.25, shaft_deflection=5e-6,
        )  # fmt: skip
        for name in ("pinion", "wheel"):
            alone, damaged = rating.gears[name], getattr(spectrum, name)
            assert damaged.pitting_safety == pytest.approx(alone.pitting_safety, rel=1e-12)
            assert damaged.bending_safety == pytest.approx(alone.bending_safety, rel=1e-12)


def test_damage_adds_up_and_other_flanks_are_separate():
    speed, gears = 150.0, {"pinion": SPUR_GEARS[0], "wheel": SPUR_GEARS[1]}
    pair = spur_example()

    def safety(*cases):
        return rate_spectrum(pair, cases=cases, oil=TEST_OIL, **gears).pitting_safety

    whole = safety(SpectrumLoad(220.0, speed, 4e6))
    halves = safety(SpectrumLoad(220.0, speed, 2e6), SpectrumLoad(220.0, speed, 2e6))
    assert halves == pytest.approx(whole, rel=1e-12)
    other = safety(SpectrumLoad(220.0, speed, 2e6), SpectrumLoad(-220.0, speed, 2e6))
    assert other == pytest.approx(safety(SpectrumLoad(220.0, speed, 2e6)), rel=1e-12)
    assert other > whole
    scaled = rate_spectrum(pair, cases=[SpectrumLoad(220.0, speed, 1.0)], oil=TEST_OIL,
                           required_life=4e6, **gears)  # fmt: skip
    assert scaled.pitting_safety == pytest.approx(whole, rel=1e-12)


@pytest.mark.parametrize(
    ("curve", "exponent"),
    [(pitting_curve, 13.2225), (bending_curve, 8.7378)],
    ids=["pitting", "bending"],
)
def test_slopes_of_case_hardened_life_curves(curve, exponent):
    points = curve(STEEL, 0.85)
    ends = [cycles_to_failure(points, ratio) for ratio in (1.1, 1.5)]
    assert math.log(ends[0] / ends[1]) / math.log(1.5 / 1.1) == pytest.approx(exponent, rel=1e-4)
    long = [cycles_to_failure(points, ratio) for ratio in (0.9, 0.99)]
    slope = {13.2225: 32.6012, 8.7378: 49.9125}[exponent]
    assert math.log(long[0] / long[1]) / math.log(0.99 / 0.9) == pytest.approx(slope, rel=1e-4)
    assert cycles_to_failure(points, 0.84) == math.inf
    assert cycles_to_failure(points, points[0][1] + 0.01) == 0.0
