"""Ratings by ISO 6336, factor by factor, against examples computed by hand."""

from __future__ import annotations

import math

import pytest

from known_ratings import MPA, TEST_OIL, UM, helical_example, rate_helical, rate_spur, spur_example
from tribodyn.gear import BasicRack, cylindrical_pair
from tribodyn.rating import ShaftMaterial, ShaftNotch, ShaftStress, rate_pair, rate_shaft

#: Factor, value as printed, SI unit of the print; pairs belong to pinion and wheel.
SPUR = {
    "F_t": (5555.556, 1.0), "v": (5.654867, 1.0), "c_prime": (12.305339, 1e9),
    "c_gamma_alpha": (16.574018, 1e9), "m_red": (0.012570082, 1e3), "N": (0.069214, 1.0),
    "f_pb": (7.517541, UM), "y_alpha": (0.563816, UM), "y_f": (0.6, UM), "B_p": (0.172505, 1.0),
    "B_f": (0.183576, 1.0), "B_k": (0.503849, 1.0), "K_v": (1.016162, 1.0),
    "F_betax": (19.377922, UM), "y_beta": (2.906688, UM), "K_Hbeta": (1.230182, 1.0),
    "K_Fbeta": (1.154214, 1.0), "K_Halpha": (1.0, 1.0), "Z_H": (2.341930, 1.0),
    "Z_eps": (0.919687, 1.0), "Z_B": (1.070192, 1.0), "M_2": (0.979817, 1.0),
    "sigma_H0": (1239.067, MPA), "Z_L": (0.965800, 1.0), "Z_v": (0.985087, 1.0),
    "Z_R": (0.958576, 1.0),
}  # fmt: skip
SPUR_GEARS = {
    "sigma_H": (1657.590, 1548.872, MPA), "Z_NT": (0.978963, 0.991215, 1.0),
    "S_H": (0.807921, 0.875451, 1.0), "s_Fn": (8.906461, 9.397826, 1e-3),
    "h_Fe": (5.057838, 5.276146, 1e-3), "rho_F": (2.320571, 2.264832, 1e-3),
    "alpha_Fen": (22.819930, 22.746734, math.pi / 180.0), "Y_F": (1.688634, 1.582982, 1.0),
    "Y_S": (1.851458, 1.916585, 1.0), "sigma_F0": (275.700, 267.541, MPA),
    "sigma_F": (404.199, 392.239, MPA), "Y_drelT": (0.994224, 0.995835, 1.0),
    "Y_RrelT": (1.001651, 1.001651, 1.0), "Y_NT": (0.932157, 0.939760, 1.0),
    "S_F": (2.117508, 2.203440, 1.0),
}  # fmt: skip
HELICAL = {
    "eps_alphan": (1.702711, 1.0), "c_prime": (12.333513, 1e9), "c_gamma_alpha": (17.206770, 1e9),
    "m_red": (0.0067459424, 1e3), "N": (0.155511, 1.0), "K_v": (1.032590, 1.0),
    "f_ma": (10.259142, UM), "K_Hbeta": (1.432473, 1.0), "K_Fbeta": (1.346439, 1.0),
    "K_Halpha": (1.070131, 1.0), "Z_H": (2.371324, 1.0), "Z_eps": (0.809291, 1.0),
    "Z_beta": (1.031590, 1.0), "sigma_H0": (967.0345, MPA), "Z_L": (1.047386, 1.0),
    "Z_v": (0.995073, 1.0), "Z_R": (0.932896, 1.0), "Y_beta": (1.004295, 1.0),
}  # fmt: skip
HELICAL_GEARS = {
    "sigma_H": (1216.655, 1216.655, MPA), "Z_NT": (0.915158, 0.928447, 1.0),
    "S_H": (1.097020, 1.112950, 1.0), "s_Fn": (4.110366, 4.361251, 1e-3),
    "h_Fe": (2.135506, 2.222432, 1e-3), "rho_F": (0.991400, 0.902416, 1e-3),
    "f_eps": (0.766354, 0.766354, 1.0), "Y_F": (1.173070, 1.078430, 1.0),
    "Y_S": (1.963722, 2.107437, 1.0), "sigma_F": (373.2075, 368.2078, MPA),
    "S_F": (2.132451, 2.189281, 1.0),
}  # fmt: skip
#: Digits of the print: six decimals, or seven significant ones.
PRINTED = {"rel": 2e-6, "abs": 5.1e-7}


@pytest.mark.parametrize(
    ("rate", "mesh", "gears"),
    [(rate_spur, SPUR, SPUR_GEARS), (rate_helical, HELICAL, HELICAL_GEARS)],
    ids=["spur", "helical"],
)
def test_every_factor_of_an_example(rate, mesh, gears):
    rating = rate()
    values = {name: rating.factors[name] / unit for name, (_, unit) in mesh.items()}
    assert values == pytest.approx({name: value for name, (value, _) in mesh.items()}, **PRINTED)
    for index, gear in enumerate((rating.pinion, rating.wheel)):
        values = {name: gear.factors[name] / figures[2] for name, figures in gears.items()}
        expected = {name: figures[index] for name, figures in gears.items()}
        assert values == pytest.approx(expected, **PRINTED)
        assert gear.pitting_safety == gear.factors["S_H"]
        assert gear.bending_safety == gear.factors["S_F"]


def test_contact_ratios_of_the_examples():
    assert spur_example().transverse_contact_ratio == pytest.approx(1.462529, abs=5e-7)
    assert helical_example().transverse_contact_ratio == pytest.approx(1.526831, abs=5e-7)
    assert helical_example().overlap_ratio == pytest.approx(1.415289, abs=5e-7)


def test_form_factor_of_the_2006_edition():
    rating = rate_helical(edition=2006)
    assert rating.pinion.factors["Y_F"] == pytest.approx(1.530716, **PRINTED)
    assert rating.wheel.factors["Y_F"] == pytest.approx(1.407222, **PRINTED)
    beta = math.radians(20.0)
    assert rating.factors["Y_beta"] == pytest.approx(1.004295 * math.cos(beta) ** 3, **PRINTED)


def _nominal(diameter: float, force: float, bending: float, torque: float) -> tuple[float, ...]:
    """Stresses of a solid section by a force [N] and two moments [N m]."""
    modulus = math.pi * diameter**3 / 32.0
    return 4.0 * force / (math.pi * diameter**2), bending / modulus, torque / (2.0 * modulus)


def test_shafts_of_an_examination_by_din_743():
    """Two shafts of 2024 whose solutions are in the tests of github.com/hanslhansl/din743, MIT."""
    steel = ShaftMaterial(tensile_strength=1100e6, yield_strength=900e6, treated_diameter=0.1)
    notch = ShaftNotch(diameter=84e-3, large_diameter=0.1, radius=4e-3, roughness=10e-6)
    means = _nominal(84e-3, 443341.5553, 23275.43165, 13965.25899)
    stress = ShaftStress(_nominal(84e-3, 0.0, 2909.428956, 0.0), means)
    rating = rate_shaft(notch, steel, stress, constant_ratio=False)
    assert rating.safety == pytest.approx(2.373, abs=5e-4)
    assert rating.yield_safety == pytest.approx(1.464, abs=5e-4)
    steel = ShaftMaterial(
        tensile_strength=750e6, yield_strength=520e6, treated_diameter=0.08, hard_surface=True
    )
    key = ShaftNotch(diameter=60e-3, kind="key", roughness=25e-6)
    bent, twisted = _nominal(60e-3, 0.0, 1402.294, 0.0), _nominal(60e-3, 0.0, 0.0, 1336.902)
    rating = rate_shaft(key, steel, ShaftStress(bent, twisted))
    assert rating.safety == pytest.approx(1.472, abs=5e-4)
    assert rating.yield_safety / 1.8 == pytest.approx(2.568, abs=5e-4)  # overload of 1.8


def test_a_spur_pair_whose_figures_another_program_prints():
    """Teeth 19 and 104 of github.com/hanslhansl/din3990 (tests/test_1.py), to its 16 digits.

    DIN 3990-11 has the factors of geometry of ISO 6336; K factors are those printed, Z_E is 189.8.
    """
    pair = cylindrical_pair(
        pinion_teeth=19, wheel_teeth=104, normal_module=4e-3, helix_angle=0.0,
        normal_pressure_angle=math.radians(20.0), pinion_profile_shift_coefficient=0.5,
        wheel_profile_shift_coefficient=0.15, pinion_face_width=48.64e-3,
        wheel_face_width=48.64e-3, pinion_tip_diameter=88e-3, wheel_tip_diameter=425.2e-3,
        pinion_rack=BasicRack(1.0, 1.25, 0.25), wheel_rack=BasicRack(1.0, 1.25, 0.25),
    )  # fmt: skip
    speed = 980.0 * math.pi / 30.0
    loads = {"K_v": 1.0278576187783273, "K_Hbeta": 1.1064272863295082, "K_Halpha": 1.0}
    rating = rate_pair(
        pair, torque=55e3 / speed, speed=speed, oil=TEST_OIL, application_factor=1.75,
        factors={**loads, "K_Falpha": 1.0, "Z_E": 189.8e3},
    )  # fmt: skip
    printed = {
        "F_t": 14103.41869503906, "v": 3.89976368065613, "Z_eps": 0.906214912960638,
        "M_1": 1.00554704549864, "M_2": 0.8835590102280203, "Z_H": 2.3959406670899934,
        "sigma_H0": 875.3827378988153e6, "K_Fbeta": 1.0864854433487987,
    }  # fmt: skip
    assert {n: float(rating.factors[n]) for n in printed} == pytest.approx(printed, rel=1e-9)
    assert rating.pinion.factors["sigma_H"] == pytest.approx(1241.7875902772687e6, rel=1e-9)
    roots = {"s_Fn": (8.748743355951145, 9.239504610725831), "rho_F": (1.3161477577, 1.3259991929)}
    for name, values in roots.items():
        ours = [1e3 * gear.factors[name] for gear in rating.gears.values()]
        assert ours == pytest.approx(values, rel=1e-4)  # its theta is iterated to 3e-4 degrees
