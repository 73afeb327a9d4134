"""Lives of bearings and fatigue of shafts: printed figures, identities, limits, messages."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tribodyn.errors import InputError, ModelWarning
from tribodyn.rating import (
    RatedBearing,
    ShaftMaterial,
    ShaftNotch,
    ShaftStress,
    ball_bearing_life,
    bearing_life,
    contamination_factor,
    deep_groove_load,
    life_modification_factor,
    rate_shaft,
    reference_viscosity,
    roller_bearing_life,
    system_life,
)

RPM = math.pi / 30.0
BEARING = RatedBearing(
    kind="radial ball", dynamic_capacity=55.3e3, static_capacity=31.5e3, pitch_diameter=72.5e-3
)
STEEL = ShaftMaterial(tensile_strength=1000e6, yield_strength=800e6)


def test_life_of_a_catalogue_bearing():
    life = bearing_life(BEARING, 10e3, 3000.0 * RPM)
    assert life.basic_turns == pytest.approx(169.1e6, rel=1e-4)
    assert life.basic_life / 3600.0 == pytest.approx(939.5, abs=0.05)
    assert reference_viscosity(3000.0 * RPM, 72.5e-3) * 1e6 == pytest.approx(9.6490, abs=5e-5)
    assert life.modified_life is None
    kinematic = reference_viscosity(3000.0 * RPM, 72.5e-3)
    modified = bearing_life(
        BEARING, 10e3, 3000.0 * RPM, viscosity=kinematic, contamination=0.5, reliability=95.0
    )
    factor = life_modification_factor("radial ball", 1.0, 0.5 * 31.5e3 / 22.0 / 10e3)
    assert modified.viscosity_ratio == pytest.approx(1.0)
    assert modified.modified_life == pytest.approx(0.64 * factor * life.basic_life, rel=1e-12)


def test_life_modification_factors():
    a = life_modification_factor
    assert a("radial ball", 1.0, 0.1) == pytest.approx(2.430518, abs=5e-7)
    assert a("radial roller", 0.4, 0.1) == pytest.approx(0.153857, abs=5e-7)
    for kind in ("radial ball", "radial roller", "thrust ball", "thrust roller"):
        for at in (0.4, 1.0):
            below, above = (a(kind, at + d, 0.05) for d in (-1e-9, 1e-9))
            assert below == pytest.approx(above, rel=2e-3)
        assert a(kind, 4.0, 0.2) == a(kind, 10.0, 0.2)
        assert a(kind, 4.0, 100.0) == 50.0
        assert a(kind, 1.0, 0.0) == pytest.approx(0.1)
    assert a("thrust ball", 1.0, 0.3) == pytest.approx(a("radial ball", 1.0, 0.1))
    assert a("thrust roller", 1.0, 0.25) == pytest.approx(a("radial roller", 1.0, 0.1))
    with pytest.warns(ModelWarning, match=r"kappa = 0.05"):
        a("radial ball", 0.05, 0.1)


def test_contamination():
    clean = contamination_factor("in-line -/13/10", 4.0, 100e-3)
    expected = min(0.0864 * 4.0**0.68 * 100.0**0.55, 1.0) * (1.0 - 0.5663 / 100.0 ** (1.0 / 3.0))
    assert clean == pytest.approx(expected, rel=1e-12)
    order = [contamination_factor(f"bath -/{c}", 1.0, 0.1) for c in ("13/10", "17/14", "21/18")]
    assert order == sorted(order, reverse=True)
    with pytest.raises(InputError, match="grease typical"):
        contamination_factor("dirty", 1.0, 0.1)


def test_equivalent_load():
    assert deep_groove_load(1000.0, 180.0, 0.172) == 1000.0  # below e
    assert deep_groove_load(1000.0, 500.0, 0.345) == pytest.approx(560.0 + 1.99 * 500.0)


def radial_loads(exponent, total=10e3, count=20000):
    angle = np.linspace(0.0, 2.0 * np.pi, count, endpoint=False)
    shape = np.maximum(np.cos(angle), 0.0) ** exponent
    return shape * total / (shape * np.cos(angle)).sum()


@pytest.mark.parametrize("size", [0.05, 0.1, 0.2, 0.3])
def test_element_loads_of_a_rigid_ball_bearing_give_its_basic_life(size):
    loads = radial_loads(1.5)
    assert loads.max() * loads.size / 10e3 == pytest.approx(4.37, abs=5e-3)
    life = ball_bearing_life(loads, 50e3, (size, 0.0))
    assert life == pytest.approx(125e6, rel=2e-3)
    assert ball_bearing_life(2.0 * loads, 50e3, (size, 0.0)) == pytest.approx(life / 8.0)


def test_a_standing_inner_ring_lives_shorter():
    loads = radial_loads(1.5)
    turning = ball_bearing_life(loads, 50e3, (0.2, 0.0))
    assert ball_bearing_life(loads, 50e3, (0.2, 0.0), inner_rotates=False) < turning


def test_rollers_in_laminae():
    loads = radial_loads(10.0 / 9.0)
    assert loads.max() * loads.size / 10e3 == pytest.approx(4.08, abs=6e-3)
    whole = roller_bearing_life(loads, 50e3, (0.2, 0.0))
    laminae = np.repeat(loads[:, None] / 30.0, 30, axis=1)
    assert roller_bearing_life(laminae, 50e3, (0.2, 0.0)) == pytest.approx(whole, rel=1e-9)
    edge = laminae * np.linspace(0.0, 2.0, 30)
    assert roller_bearing_life(edge, 50e3, (0.2, 0.0)) < 0.5 * whole
    assert roller_bearing_life(2.0 * loads, 50e3, (0.2, 0.0)) == pytest.approx(whole / 16.0)
    with pytest.raises(InputError, match="no element"):
        roller_bearing_life(np.zeros(5), 50e3, (0.2, 0.0))


def test_system_life():
    assert system_life([900.0], 1.5) == pytest.approx(900.0)
    assert system_life([1000.0] * 4, 1.5) == pytest.approx(1000.0 * 4.0 ** (-1.0 / 1.5))
    assert system_life([1.0, 1e9]) == pytest.approx(1.0, rel=1e-6)


def test_a_smooth_shaft_under_each_stress():
    plain = ShaftNotch(diameter=16e-3, kind="given", notch_factors=(1.0, 1.0, 1.0), roughness=1e-6)
    size = 1.0 - 0.2 * math.log10(16.0 / 7.5) / math.log10(20.0)
    for index, limit in ((0, 400e6), (1, 500e6 * size), (2, 300e6 * size)):
        amplitudes = [0.0, 0.0, 0.0]
        amplitudes[index] = 100e6
        rating = rate_shaft(plain, STEEL, ShaftStress(tuple(amplitudes)))
        assert rating.safety == pytest.approx(limit / 100e6, rel=1e-12)


def test_notches():
    notch = ShaftNotch(diameter=40e-3, large_diameter=50e-3, radius=2e-3)
    factors = rate_shaft(notch, STEEL, ShaftStress((0.0, 100e6, 0.0))).factors
    root = 0.62 * 0.4 + 2.0 * 5.8 * 0.05 * 1.1**2 + 0.2 * 0.4**3 * 0.8
    alpha = 1.0 + 1.0 / math.sqrt(root)
    phi = 1.0 / (4.0 * math.sqrt(2.5) + 2.0)
    gradient = 2.3 * (1.0 + phi) / 2.0
    yielding = 800.0 * (1.0 - 0.34 * math.log10(40.0 / 16.0))
    support = 1.0 + math.sqrt(gradient) * 10.0 ** -(0.33 + yielding / 712.0)
    assert factors["beta_bending"] == pytest.approx(alpha / support, rel=1e-12)
    sharp = ShaftNotch(diameter=40e-3, large_diameter=50e-3, radius=0.5e-3)
    worse = rate_shaft(sharp, STEEL, ShaftStress((0.0, 100e6, 0.0))).factors
    assert worse["beta_bending"] > factors["beta_bending"]
    key = ShaftNotch(diameter=40e-3, kind="key")
    keyed = rate_shaft(key, STEEL, ShaftStress((0.0, 100e6, 0.0))).factors
    strength = 1000.0 * (1.0 - 0.26 * math.log10(2.5))
    assert keyed["beta_bending"] == pytest.approx(3.0 * (strength / 1000.0) ** 0.38)
    with pytest.raises(InputError, match="radius is missing"):
        ShaftNotch(diameter=40e-3, large_diameter=50e-3)


def test_mean_stress_and_yield():
    notch = ShaftNotch(diameter=40e-3, large_diameter=50e-3, radius=2e-3)
    alternating = rate_shaft(notch, STEEL, ShaftStress((0.0, 80e6, 0.0)))
    small = ShaftStress((0.0, 80e6, 0.0), (0.0, 60e6, 0.0))
    fixed = rate_shaft(notch, STEEL, small, constant_ratio=False)
    limit, psi = (fixed.factors[f"{name}_bending"] for name in ("sigma_WK", "psi"))
    assert fixed.safety == pytest.approx((limit - psi * 60e6) / 80e6, rel=1e-12)
    assert rate_shaft(notch, STEEL, small).safety < alternating.safety
    large = rate_shaft(notch, STEEL, ShaftStress((0.0, 10e6, 0.0), (0.0, 700e6, 0.0)))
    assert large.factors["sigma_ADK_bending"].branch == "yield strength"
    torsion = ShaftStress((0.0, 0.0, 0.0), (0.0, 60e6, 0.0))
    with pytest.raises(InputError, match="amplitudes"):
        rate_shaft(notch, STEEL, torsion)
    both = rate_shaft(notch, STEEL, ShaftStress((0.0, 80e6, 40e6))).safety
    alone = rate_shaft(notch, STEEL, ShaftStress((0.0, 0.0, 40e6))).safety
    assert both == pytest.approx((alternating.safety**-2 + alone**-2) ** -0.5, rel=1e-12)


def test_yield_of_a_section_under_its_greatest_stress():
    notch = ShaftNotch(diameter=40e-3, large_diameter=50e-3, radius=2e-3)
    rating = rate_shaft(notch, STEEL, ShaftStress((0.0, 80e6, 0.0), (20e6, 0.0, 50e6)))
    zd, b, t = (rating.factors[f"sigma_FK_{kind}"] for kind in ("tension", "bending", "torsion"))
    expected = math.hypot(20e6 / zd + 80e6 / b, 50e6 / t)
    assert rating.yield_safety == pytest.approx(1.0 / expected, rel=1e-12)
    size = 1.0 - 0.34 * math.log10(40.0 / 16.0)
    assert zd == pytest.approx(800e6 * size * 1.10, rel=1e-12)  # alpha between 2 and 3
    keyed = rate_shaft(ShaftNotch(diameter=40e-3, kind="key"), STEEL, ShaftStress((1e6, 0.0, 0.0)))
    assert keyed.factors["sigma_FK_tension"] == pytest.approx(800e6 * size, rel=1e-12)
    assert keyed.factors["K_F_bending"] == 1.0


def test_shapes_beyond_the_range_of_alpha_are_reported():
    sharp = ShaftNotch(diameter=40e-3, large_diameter=60e-3, radius=0.2e-3)
    with pytest.warns(ModelWarning, match="r/t = 0.02"):
        rate_shaft(sharp, STEEL, ShaftStress((0.0, 80e6, 0.0)))
