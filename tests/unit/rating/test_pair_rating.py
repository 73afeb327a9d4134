"""Branches, ranges, factors of the caller and messages of the rating of a pair."""

from __future__ import annotations

import json
import math
from dataclasses import replace

import pytest

import tribodyn as td
from known_ratings import (
    SPUR_GEARS,
    STEEL,
    TEST_OIL,
    UM,
    helical_example,
    rate_helical,
    rate_spur,
    ring_example,
    spur_example,
)
from tribodyn.errors import InputError, ModelWarning
from tribodyn.gear import BasicRack, FlankModification
from tribodyn.rating import (
    GearMaterial,
    GearOil,
    PinionShaft,
    RatedGear,
    ShaftMaterial,
    ShaftNotch,
    ShaftStress,
    ShaperCutter,
    rate_pair,
    rate_shaft,
)

THROUGH = GearMaterial(kind="V", hardness=220, yield_strength=550e6)


def test_public_name():
    assert td.rating.rate_pair is rate_pair


def test_factors_carry_value_unit_source_and_branch():
    rating = rate_spur()
    stress = rating.pinion.factors["sigma_H"]
    assert stress.unit == "Pa"
    assert stress.source.startswith("ISO 6336-2")
    assert stress.value == float(stress) > 1e9
    assert rating.factors["K_v"].branch.startswith("subcritical")
    assert "f_eps" in rating.pinion.factors
    assert "ISO" not in rating.pinion.factors["f_eps"].source  # not compared with its text
    data = json.loads(json.dumps(rating.to_dict()))
    assert data["wheel"]["factors"]["Y_F"]["value"] == rating.wheel.factors["Y_F"]
    assert data["edition"] == 2019


def test_what_is_from_memory_is_not_called_a_standard():
    """The source of each factor that was not compared with a text says so."""

    def remembered(factor) -> bool:
        return "not compared" in factor.source

    oil = replace(TEST_OIL, micropitting_load_stage=9, scuffing_load_stage=12)
    rating = rate_spur(oil=oil)
    assert all(remembered(rating.factors[name]) for name in ("X_mp", "W_W", "lambda_GFT"))
    assert not remembered(rating.factors["X_W"])
    for structure, memory in ((1.0, False), (1.5, False), (1.15, True), (0.45, True)):
        gear = replace(SPUR_GEARS[0], structure_factor=structure)
        factors = rate_spur(oil=oil, pinion=gear, wheel=gear).factors
        assert remembered(factors["X_W"]) == memory
    ring = rate_pair(ring_example(), torque=100.0, speed=100.0, oil=TEST_OIL)
    assert remembered(ring.wheel.factors["Y_F"])
    assert not remembered(ring.pinion.factors["Y_F"])
    classed = RatedGear(accuracy_grade=5, tolerance_edition=2013)
    assert classed.grade_text.endswith("from memory")
    assert not RatedGear(accuracy_grade=5).grade_text.endswith("from memory")
    steel = ShaftMaterial(tensile_strength=900e6, yield_strength=700e6)
    bent = ShaftStress((0.0, 50e6, 20e6))
    for notch, memory in (
        (ShaftNotch(diameter=40e-3, kind="key"), True),
        (ShaftNotch(diameter=40e-3, large_diameter=50e-3, radius=2e-3), False),
        (ShaftNotch(diameter=40e-3, kind="given", notch_factors=(1.5, 1.5, 1.3)), False),
    ):
        assert remembered(rate_shaft(notch, steel, bent).factors["beta_bending"]) == memory


def test_factors_of_the_caller_replace_computed_ones():
    base = rate_spur()
    rating = rate_spur(factors={"K_v": 1.2, "K_Hbeta": 1.0, "wheel.Y_F": 2.0})
    assert rating.factors["K_v"] == 1.2
    assert rating.factors["K_v"].branch == "given"
    assert rating.factors["K_Fbeta"] == 1.0  # follows from K_Hbeta
    assert rating.pinion.factors["Y_F"] == base.pinion.factors["Y_F"]
    assert rating.wheel.factors["Y_F"] == 2.0
    assert set(rating.overridden) == {"K_v", "K_Hbeta", "wheel.Y_F"}
    with pytest.raises(InputError, match='Did you mean "K_v"'):
        rate_spur(factors={"K_V": 1.2})
    with pytest.raises(InputError, match='Did you mean "application_factor"'):
        rate_spur(aplication_factor=1.2)


@pytest.mark.parametrize(
    ("speed", "branch"),
    [(500.0, "subcritical"), (2200.0, "resonance"), (3000.0, "intermediate"), (4000.0, "super")],
)
def test_ranges_of_the_dynamic_factor(speed, branch):
    with td.errors.collected() as warnings:
        rating = rate_spur(speed=speed)
    assert branch in rating.factors["K_v"].branch
    resonant = [warning for warning in warnings if warning.code == "rating-resonance"]
    assert bool(resonant) == (branch == "resonance")
    assert all("K_v =" in str(warning) for warning in resonant)


def test_limit_of_the_subcritical_range_falls_with_light_load():
    rating = rate_spur(torque=20.0)
    line_load = 20.0 / 36e-3 * 1.25 / 14.0  # N/mm
    assert rating.factors["N_S"] == pytest.approx(0.5 + 0.35 * math.sqrt(line_load / 100.0))


def test_shafts_and_leads():
    plain = rate_spur(shaft_deflection=None)
    assert plain.factors["f_sh"] == pytest.approx(
        1e-9 * 5555.5556 * 1.25 * plain.factors["K_v"] / 14e-3 * 0.023 * (14.0 / 72.0) ** 2
    )
    overhung = PinionShaft(bearing_span=0.2, offset=0.04, diameter=0.05, arrangement="c")
    bent = rate_spur(shaft_deflection=None, shaft=overhung)
    expected = 1.0 + 1.33 * 200.0 * 40.0 / 72.0**2 * (72.0 / 50.0) ** 4
    assert bent.factors["f_sh"] / plain.factors["f_sh"] == pytest.approx(expected, rel=1e-3)
    corrected = rate_spur(lead="helix correction")
    assert corrected.factors["F_betax"] == pytest.approx(0.133 * 5 * UM + math.hypot(9, 9) * UM)
    with pytest.raises(InputError, match=r"s/l below 0\.3"):
        PinionShaft(bearing_span=0.1, offset=0.05, diameter=0.05)
    crowned = replace(SPUR_GEARS[0])
    pair = spur_example(pinion_modification=FlankModification(tip_relief=20 * UM, crowning=5 * UM))
    rating = rate_pair(pair, torque=200.0, speed=150.0, oil=TEST_OIL, pinion=crowned)
    assert "crowning from the flanks" in rating.factors["F_betax"].branch


def test_transverse_load_factor_is_limited_and_says_so():
    assert "limited to 1" in rate_spur().factors["K_Halpha"].branch
    coarse = replace(SPUR_GEARS[0], pitch_deviation=60 * UM, accuracy_grade=None)
    rating = rate_spur(torque=20.0, pinion=coarse, wheel=coarse)
    most = 1.0 / rating.factors["Z_eps"] ** 2
    assert rating.factors["K_Halpha"] == pytest.approx(most, rel=1e-12)


def test_soft_wheel_against_a_hard_pinion():
    wheel = RatedGear(material=THROUGH, flank_roughness=6 * UM)
    rating = rate_spur(wheel=wheel)
    factors = rating.wheel.factors
    assert factors["Z_W"] == pytest.approx(
        (1.2 - 90.0 / 1700.0) * (3e-6 / factors["R_zH"]) ** 0.15, rel=1e-12
    )
    assert factors["Z_W"].branch == "soft against hard"
    assert rating.pinion.factors["Z_W"] == 1.0
    rough = rate_spur(wheel=wheel, pinion=replace(SPUR_GEARS[0], flank_roughness=8 * UM))
    assert rough.wheel.factors["Z_W"] == 1.0
    assert "6 um" in rough.wheel.factors["Z_W"].branch


def test_through_hardened_pair_of_unequal_hardness():
    hard = GearMaterial(kind="V", hardness=330, yield_strength=800e6)
    rating = rate_spur(pinion=RatedGear(material=hard), wheel=RatedGear(material=THROUGH))
    assert rating.wheel.factors["Z_W"] == pytest.approx(1.0 + (0.00898 * 1.5 - 0.00829) * 0.5)


def test_notch_sensitivity_needs_a_strength():
    soft = RatedGear(material=GearMaterial(kind="V", hardness=220))
    with pytest.raises(InputError, match="yield_strength"):
        rate_spur(wheel=soft)
    rating = rate_spur(wheel=soft, factors={"wheel.Y_drelT": 1.01})
    assert rating.wheel.factors["Y_drelT"] == 1.01


@pytest.mark.parametrize(
    ("kind", "layer"), [("NT", 0.1005), ("NV(nitr.)", 0.1005), ("IF", 0.0030), ("GG", 0.3124)]
)
def test_slip_layers(kind, layer):
    gear = RatedGear(material=GearMaterial(kind=kind, pitting_limit=900e6, bending_limit=300e6))
    factors = rate_spur(pinion=gear).pinion.factors
    gradient = (1.0 + 2.0 * factors["q_s"]) / 5.0
    expected = (1.0 + math.sqrt(layer * gradient)) / (1.0 + math.sqrt(1.2 * layer))
    assert factors["Y_drelT"] == pytest.approx(expected, rel=1e-12)


def test_few_cycles_approach_the_static_factors():
    short = replace(SPUR_GEARS[0], load_cycles=10.0)
    factors = rate_spur(pinion=short).pinion.factors
    for name in ("Z_L", "Z_v", "Z_R", "Y_RrelT", "Y_X"):
        assert factors[name] == pytest.approx(1.0)
    assert factors["Y_drelT"] == pytest.approx(0.44 * factors["Y_S"] + 0.12)
    assert factors["Z_NT"] == 1.6
    assert factors["Y_NT"] == 2.5


def test_life_follows_from_hours_and_from_meshes_per_turn():
    gears = {"pinion": RatedGear(material=STEEL), "wheel": RatedGear(meshes_per_turn=3)}
    rating = rate_spur(required_life=3.6e6, **gears)
    assert rating.pinion.load_cycles == pytest.approx(25.0 * 3.6e6)
    assert rating.wheel.load_cycles == pytest.approx(25.0 / 1.5 * 3 * 3.6e6)
    endless = rate_spur(**gears)
    assert endless.pinion.load_cycles is None
    assert endless.pinion.factors["Z_NT"] == endless.pinion.factors["Y_NT"] == 1.0


def test_an_idler_bears_less():
    once = rate_spur().pinion
    idler = rate_spur(pinion=replace(SPUR_GEARS[0], stress_ratio=-1.2)).pinion
    mean = 0.8 - 0.15 * once.factors["Y_S"]
    expected = 1.0 / (1.0 + 1.2 * (1.0 - mean) / (1.0 + mean))
    assert idler.bending_safety / once.bending_safety == pytest.approx(expected, rel=1e-12)
    assert 0.6 < expected < 0.8


def test_thin_rims_are_refused_unless_their_factor_is_given():
    pair = spur_example(pinion_bore_diameter=50e-3)
    rating = rate_pair(pair, torque=200.0, speed=150.0, oil=TEST_OIL)
    assert "thin rim" in rating.pinion.factors["Y_B"].branch
    assert rating.pinion.factors["Y_B"] > 1.0
    thin = spur_example(pinion_bore_diameter=56e-3)
    with pytest.raises(InputError, match="rim of"):
        rate_pair(thin, torque=200.0, speed=150.0, oil=TEST_OIL)
    stated = rate_pair(thin, torque=200.0, speed=150.0, oil=TEST_OIL, factors={"pinion.Y_B": 1.8})
    assert stated.pinion.factors["Y_B"] == 1.8


def test_ring_with_a_cutter_in_both_editions():
    pair, wheel = ring_example(), RatedGear(cutter=ShaperCutter(teeth=25))
    exact, old = (
        rate_pair(pair, torque=200.0, speed=150.0, oil=TEST_OIL, wheel=wheel, edition=edition)
        for edition in (2019, 2006)
    )
    assert exact.factors["Z_D"] == 1.0
    assert exact.factors["Z_D"].branch == "internal"
    chords = [rating.wheel.factors["s_Fn"] for rating in (exact, old)]
    assert 0.97 < chords[1] / chords[0] < 1.0  # the equivalent rack is too slim
    assert "2006" in old.wheel.factors["s_Fn"].branch
    with pytest.raises(InputError, match="cutter of 5 teeth"):
        rate_pair(
            pair, torque=200.0, speed=150.0, oil=TEST_OIL,
            wheel=RatedGear(cutter=ShaperCutter(teeth=5, profile_shift_coefficient=-2.0)),
        )  # fmt: skip


def test_deep_teeth_need_a_fine_grade():
    rack = BasicRack(1.35, 1.6, 0.2)
    pair = spur_example(
        pinion_teeth=40, wheel_teeth=60, normal_module=2e-3, center_distance=None,
        pinion_profile_shift_coefficient=0.0, wheel_profile_shift_coefficient=0.0,
        pinion_tip_diameter=None, wheel_tip_diameter=None, pinion_rack=rack, wheel_rack=rack,
    )  # fmt: skip
    assert pair.transverse_contact_ratio > 2.05
    for grade, expected in ((4, 2.366 - 0.666 * pair.transverse_contact_ratio), (6, 1.0)):
        gear = RatedGear(accuracy_grade=grade)
        rating = rate_pair(pair, torque=100.0, speed=100.0, oil=TEST_OIL, pinion=gear, wheel=gear)
        assert rating.pinion.factors["Y_DT"] == pytest.approx(expected)


def test_ranges_are_warned_of_with_value_and_limit():
    thin = GearOil(kinematic_viscosity_at_40=20e-6)
    with pytest.warns(ModelWarning, match=r"nu_40 = 20 lies outside of the range 50 to 1000"):
        rating = rate_spur(oil=thin)
    assert [warning.code for warning in rating.warnings] == ["rating-range"]


def test_relief_factor_of_helical_pairs():
    assert rate_helical().factors["Z_B"] == 1.0
    experience = rate_helical(relief_design="experience").factors["Z_B"]
    assert experience == pytest.approx(math.sqrt(1.07))
    assert "ISO" not in experience.source
    plain = helical_example(pinion_modification=None, wheel_modification=None)
    rating = rate_pair(plain, torque=100.0, speed=100.0, oil=TEST_OIL)
    assert rating.factors["Z_B"] == pytest.approx(math.sqrt(1.2))
    old = rate_pair(plain, torque=100.0, speed=100.0, oil=TEST_OIL, edition=2006)
    assert old.factors["Z_B"] == 1.0


@pytest.mark.parametrize("values", [{"torque": 0.0}, {"speed": -1.0}, {"edition": 2010}])
def test_values_out_of_range_are_refused(values):
    with pytest.raises(InputError, match=next(iter(values))):
        rate_spur(**values)


@pytest.mark.parametrize(
    ("change", "text"),
    [
        ({"root_roughness": 60.0 * UM}, r"Rz = 60 lies outside of the range 0 to 40"),
        ({"material": replace(THROUGH, yield_strength=1200e6)}, r"strength = 1200 .* 500 to 1000"),
    ],
)
def test_values_that_are_limited_are_reported_with_the_limit(change, text):
    gear = replace(SPUR_GEARS[0], **change)
    with pytest.warns(ModelWarning, match=text):
        rating = rate_spur(pinion=gear)
    assert any("value at its end is used" in str(warning) for warning in rating.warnings)
