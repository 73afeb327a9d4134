"""Scuffing and micropitting against Blok, the FZG tests themselves, and limits of their factors."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from known_ratings import (
    SPUR_GEARS,
    STEEL,
    helical_example,
    rate_helical,
    rate_spur,
    ring_example,
    spur_example,
)
from tribodyn.contact import hertz_line, path_of_contact
from tribodyn.ehl import blok_flash_temperature
from tribodyn.errors import InputError
from tribodyn.gear import spur_pair
from tribodyn.rating import GearOil, RatedGear, RatingConditions, rate_pair
from tribodyn.rating.factor import Factors
from tribodyn.rating.mesh_load import MeshLoad
from tribodyn.rating.surface import micropitting, scuffing
from tribodyn.rating.surface.micropitting import TORQUES
from tribodyn.rating.surface.path_load import ScuffingLoad, helical_load_factor, overlap_factor

ONES = dict.fromkeys(("K_v", "K_Hbeta", "K_Halpha"), 1.0)
OIL = GearOil(
    kinematic_viscosity_at_40=100e-6, temperature=363.15, scuffing_load_stage=10,
    micropitting_load_stage=8, micropitting_test_lubrication="dip",
)  # fmt: skip


def load_of(pair, torque=150.0, rpm=1500.0, oil=OIL, gear=None):
    gear = gear or RatedGear(material=STEEL, accuracy_grade=5, arithmetic_roughness=0.35e-6)
    factors = Factors()
    for name in ("K_A", "K_gamma", "K_v", "K_Hbeta", "K_Halpha"):
        factors.record(name, 1.0, "")
    factors.record("c_prime", 14e9, "")
    factors.record("c_gamma_alpha", 20e9, "")
    mesh = MeshLoad(pair, gear, gear, RatingConditions(), torque, rpm * math.pi / 30.0, factors)
    return ScuffingLoad(mesh, oil)


@pytest.mark.parametrize("driver", ["pinion", "wheel"])
@pytest.mark.parametrize("make", [spur_example, helical_example, ring_example])
def test_flash_temperature_is_that_of_blok(make, driver):
    load = load_of(make(driver=driver))
    pair, friction = load.mesh.pair, 0.05
    position = load.points.grid(41)
    flash = scuffing.flash_temperatures(load, position, friction)
    flash = flash / scuffing.approach_factor(load, position)
    motion = path_of_contact(pair).kinematics(load.points.path(position), load.mesh.speed)
    per_width = load.points.share(position, 5) * load.line_load * load.helical_factor
    per_width = per_width / math.cos(pair.transverse_pressure_angle)
    contact = hertz_line(per_width, motion.equivalent_radius, load.modulus)
    blok = blok_flash_temperature(
        friction * per_width * np.abs(motion.sliding_speed), contact.half_width,
        motion.pinion_surface_speed, motion.wheel_surface_speed, 13.76e3, 13.76e3,
    )  # fmt: skip
    assert flash == pytest.approx(blok, rel=0.01, abs=1e-9)
    assert flash[position == 0.0].tolist() == [0.0]  # exactly, at the pitch point


@pytest.mark.parametrize("stage", [6, 8, 10, 12])
def test_scuffing_test_gears_scuff_in_their_own_load_stage(stage):
    """FZG A/8.3/90: gears of type A at the torque of the load stage are at the limit."""
    pair = spur_pair(
        pinion_teeth=16, wheel_teeth=24, normal_module=4.5e-3,
        normal_pressure_angle=math.radians(20.0), center_distance=91.5e-3,
        pinion_profile_shift_coefficient=0.8635, wheel_profile_shift_coefficient=-0.5103,
        pinion_face_width=20e-3,
    )  # fmt: skip
    oil = replace(OIL, scuffing_load_stage=stage)
    load = load_of(pair, 3.726 * stage**2, 2170.0, oil)
    assert scuffing.record_scuffing_flash(load) == pytest.approx(1.0, abs=0.12)
    assert scuffing.record_scuffing_integral(load) == pytest.approx(1.1, abs=0.12)


@pytest.mark.parametrize("stage", list(TORQUES))
def test_micropitting_test_gears_are_at_their_own_limit(stage):
    pair = spur_pair(
        pinion_teeth=16, wheel_teeth=24, normal_module=4.5e-3,
        normal_pressure_angle=math.radians(20.0), center_distance=91.5e-3,
        pinion_profile_shift_coefficient=0.182, wheel_profile_shift_coefficient=0.171,
        pinion_tip_diameter=82.46e-3, wheel_tip_diameter=118.36e-3, pinion_face_width=14e-3,
    )  # fmt: skip
    gear = RatedGear(arithmetic_roughness=0.5e-6)
    rating = rate_pair(
        pair, torque=TORQUES[stage], speed=2250.0 * math.pi / 30.0, pinion=gear, wheel=gear,
        oil=replace(OIL, micropitting_load_stage=stage), factors=ONES,
    )  # fmt: skip
    assert rating.factors["lambda_A"] == pytest.approx(rating.factors["lambda_GFT"], rel=1e-12)
    assert rating.micropitting_safety == pytest.approx(1.0, abs=1e-12)


def test_film_is_that_of_dowson_and_higginson_without_sliding():
    load = load_of(spur_example())
    points = micropitting.film_points(load, np.array([0.0]))
    assert points.flash_temperature[0] == 0.0
    motion = path_of_contact(load.mesh.pair).kinematics(
        load.points.path(np.array([0.0])), load.mesh.speed
    )
    radius, modulus = float(motion.equivalent_radius[0]), load.modulus
    bulk = float(load.factors["theta_MGF"])
    viscosity = OIL.dynamic_viscosity(bulk)
    alpha = float(micropitting.pressure_viscosity(OIL, np.asarray(bulk)))
    pressed = load.line_load / math.cos(load.mesh.pair.transverse_pressure_angle)
    film = 1.6 * radius * (alpha * modulus) ** 0.6
    film *= (viscosity * float(motion.entrainment_speed[0]) / (modulus * radius)) ** 0.7
    film *= (pressed / (modulus * radius)) ** -0.13
    assert points.film_thickness[0] == pytest.approx(film, rel=1e-12)


def test_safeties_need_the_tests_of_the_oil():
    plain = rate_spur()
    assert plain.scuffing_safety_flash is plain.micropitting_safety is None
    assert plain.factors["lambda_min"] > 0.0
    rated = rate_spur(oil=OIL)
    assert rated.scuffing_safety_flash == rated.factors["S_B"]
    assert rated.scuffing_safety_integral == rated.factors["S_intS"]
    assert rated.pinion.factors["S_lambda"] == rated.micropitting_safety
    stated = rate_spur(factors={"lambda_GFP": 0.2})
    assert stated.micropitting_safety == pytest.approx(stated.factors["lambda_min"] / 0.2)
    with pytest.raises(InputError, match="scuffing_load_stage"):
        replace(OIL, scuffing_load_stage=20)


def test_relief_and_rough_or_new_flanks():
    load = load_of(spur_example())
    position = load.points.grid(11)
    assert scuffing.approach_factor(load, position).min() == 1.0
    coarse = tuple(replace(gear, accuracy_grade=8) for gear in SPUR_GEARS)
    rating = rate_spur(oil=OIL, pinion=coarse[0], wheel=coarse[1], torque=100.0)
    assert rating.factors["X_Ca"] == 1.0
    assert "coarser than 6" in rating.factors["X_Ca"].branch
    new = replace(SPUR_GEARS[0], running_in=0.0)
    assert rate_spur(oil=OIL, pinion=new).factors["X_E"] > 1.0
    light = rate_spur(oil=OIL, torque=20.0)
    assert "raised to 150" in light.factors["mu_mC"].branch
    soft = replace(SPUR_GEARS[0], micropitting_factor=0.5, structure_factor=0.45)
    worse = rate_spur(oil=OIL, pinion=soft)
    assert worse.factors["W_W"] == 0.75
    assert worse.factors["X_W"] == pytest.approx(0.725)


def test_helical_pairs_carry_with_buttressing():
    load = load_of(helical_example())
    a, e = load.points.ends
    share = load.points.share(np.array([a, 0.0, e]), 6) * 1.5268308
    assert share == pytest.approx([1.3, 1.0, 1.3], rel=1e-6)
    rating = rate_helical(oil=OIL)
    excess = rating.factors["eps_1"] + rating.factors["eps_2"]
    assert excess == pytest.approx(1.5268308, rel=1e-6)  # of both addenda is the whole
    total = helical_example().total_contact_ratio
    expected = 1.0 + 0.2 * math.sqrt((total - 2.0) * (5.0 - total))
    assert rating.factors["K_Bgamma"] == pytest.approx(expected, rel=1e-12)


def test_factors_are_continuous_where_their_rules_meet():
    for at in (2.0, 3.5):
        below, above = (helical_load_factor(at + d) for d in (-1e-12, 1e-12))
        assert below == pytest.approx(above, abs=1e-5)
    assert helical_load_factor(5.0) == pytest.approx(1.3)
    q = scuffing.approach_ratio_factor
    assert q(1.5) == pytest.approx(1.0)
    assert q(3.0) == pytest.approx(0.6)
    assert q(1.0) == 1.0
    assert q(4.0) == pytest.approx(0.6)
    x = scuffing.contact_ratio_factor
    for other in (0.5, 0.9):
        assert x(1.0 - 1e-12, other) == pytest.approx(x(1.0 + 1e-12, other), rel=1e-9)
    assert x(1.0, 1.0 - 1e-12) == pytest.approx(x(1.0, 1.0 + 1e-12), rel=1e-9)
    # full relief: 1 + 0.24 e + 0.71 e^2
    assert overlap_factor(2e-5, 1e-5, 0.8) == pytest.approx(1.0 + 0.24 * 0.8 + 0.71 * 0.64)


def test_a_pair_of_high_contact_ratio_shares_its_load():
    pair = spur_pair(
        pinion_teeth=60, wheel_teeth=80, normal_module=2e-3, pinion_face_width=20e-3,
        normal_pressure_angle=math.radians(15.0),
    )  # fmt: skip
    assert pair.transverse_contact_ratio > 2.0
    share = load_of(pair).points.share(np.array([0.0]), 6)
    assert share == pytest.approx(1.0 / pair.transverse_contact_ratio)
