"""Strength of materials, life curves and tolerances: values, ranges and messages."""

from __future__ import annotations

import pytest

from known_ratings import helical_example
from tribodyn.errors import InputError
from tribodyn.rating import GearMaterial, gear_tolerances, life_factor
from tribodyn.rating.life import bending_curve, pitting_curve
from tribodyn.rating.materials import KINDS

MPA = 1e6


@pytest.mark.parametrize(
    ("kind", "grade", "hardness", "pitting", "bending"),
    [
        ("Eh", "MQ", 700, 1500.0, 461.0),
        ("Eh", "ME", None, 1650.0, 525.0),
        ("V", "MQ", 300, 1.313 * 300 + 373, 0.425 * 300 + 187),
        ("V", "ME", 390, 2.213 * 390 + 260, 0.358 * 390 + 231),
        ("V(carbon)", "ML", 200, 0.963 * 200 + 283, 0.250 * 200 + 108),
        ("St", "MQ", 150, 150 + 190, 0.455 * 150 + 69),
        ("GGG(ferr.)", "MQ", 180, 1.434 * 180 + 211, 0.350 * 180 + 119),
        ("IF", "MQ", 560, 0.541 * 560 + 882, 0.138 * 560 + 290),
        ("IF", "MQ", 600, 0.541 * 600 + 882, 369.0),
        ("NV(nitrocar.)", "ME", 400, 1.167 * 400 + 425, 0.653 * 400 + 94),
        ("NV(nitrocar.)", "MQ", 600, 950.0, 388.0),
    ],
)
def test_strength_by_type_grade_and_hardness(kind, grade, hardness, pitting, bending):
    material = GearMaterial(kind=kind, grade=grade, hardness=hardness)
    assert material.sigma_Hlim == pytest.approx(pitting * MPA, rel=1e-12)
    assert material.sigma_Flim == pytest.approx(bending * MPA, rel=1e-12)


def test_core_of_case_hardened_steel():
    assert GearMaterial(core_hardness=32.0).sigma_Flim == 500 * MPA
    assert GearMaterial(hardenable=False).sigma_Flim == 425 * MPA
    assert GearMaterial(core_hardness=32.0, bending_limit=480 * MPA).sigma_Flim == 480 * MPA
    with pytest.raises(InputError, match="core_hardness = 20"):
        GearMaterial(core_hardness=20.0)


@pytest.mark.parametrize(
    ("values", "text"),
    [
        ({"kind": "NV(nitro.)"}, 'Did you mean "NV.nitr'),
        ({"kind": "18CrNiMo7-6"}, "NV\\(nitrocar.\\)"),
        ({"grade": "MX"}, "ML, MQ, ME"),
        ({"kind": "V", "hardness": 450}, "from 200 to 360 HV"),
        ({"kind": "GG", "hardness": 300}, "from 150 to 240 HBW"),
        ({"kind": "V"}, "hardness is missing"),
        ({"hardness": 850}, "660 to 800 HV"),
    ],
)
def test_what_exists_is_named_where_a_material_does_not(values, text):
    with pytest.raises(InputError, match=text):
        GearMaterial(**values)


@pytest.mark.parametrize("kind", KINDS)
def test_every_type_has_its_curves_and_groups(kind):
    material = GearMaterial(kind=kind, pitting_limit=600 * MPA, bending_limit=200 * MPA)
    for curve in (pitting_curve(material, 0.85), bending_curve(material, 0.85)):
        assert life_factor(curve, 1.0) == curve[0][1] > 1.0
        assert life_factor(curve, 1e10) == life_factor(curve, 1e12) == 0.85
    assert material.running_in_group in {"steel", "cast iron", "hard"}


def test_life_factors_of_groups():
    def z(kind, cycles, some=False):
        material = GearMaterial(kind=kind, pitting_limit=600 * MPA, bending_limit=200 * MPA)
        return life_factor(pitting_curve(material, 0.85, some), cycles)

    assert z("Eh", 5e7) == z("NT", 2e6) == z("NV(nitrocar.)", 2e6) == 1.0
    assert z("Eh", 1e5) == z("V", 6e5, True) == 1.6
    assert z("V", 1e7, True) == pytest.approx(1.3)
    assert z("V", 1e9, True) == pytest.approx(1.0)
    assert z("NT", 2e6, True) == 1.0  # nitrided flanks allow no pitting
    assert z("GG", 1e5) == 1.3
    assert z("NV(nitrocar.)", 1e4) == 1.1


def test_tolerances_of_a_grade():
    pinion = (
        helical_example().pinion
    )  # d 53.2, m 2, b 26: ranges 50-125, 2 to 3.5 or 0.5 to 2, 20-40
    grade_5, grade_7 = gear_tolerances(pinion, 5), gear_tolerances(pinion, 7)
    assert grade_5 == pytest.approx((5.5e-6, 4.5e-6, 6.0e-6))
    assert grade_7.single_pitch == pytest.approx(11e-6)
    assert gear_tolerances(pinion, 5, 2013) == pytest.approx((6.0e-6, 6.0e-6, 6.0e-6), rel=0.1)
    with pytest.raises(InputError, match="1995 and 2013"):
        gear_tolerances(pinion, 5, 2020)
    with pytest.raises(InputError, match="accuracy_grade"):
        gear_tolerances(pinion, 13)
