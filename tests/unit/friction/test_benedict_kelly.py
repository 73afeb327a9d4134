"""The formula of Benedict and Kelly: units, variants, singularities."""

from __future__ import annotations

import math
import warnings

import numpy as np
import pytest

from tribodyn.errors import InputError, ModelWarning
from tribodyn.friction import benedict_kelly

CONTACT = {
    "load_per_width": 100e3,
    "sliding_speed": 1.0,
    "entrainment_speed": 2.0,
    "dynamic_viscosity": 0.05,
    "roughness": 0.4e-6,
}


def friction(**changes):
    return benedict_kelly(**{**CONTACT, **changes})


def test_one_point_worked_by_hand_in_the_units_of_the_paper():
    # 100 N/mm, 50 cP, 1 m/s, 2 m/s, 0.4 um
    by_hand = 0.0127 * 1.13 / 0.73 * math.log10(29700.0 * 100.0 / (50.0 * 1.0 * 4.0))
    assert friction() == pytest.approx(by_hand, rel=1e-12)


@pytest.mark.parametrize(
    ("name", "power"),
    [
        ("load_per_width", 1),
        ("sliding_speed", -1),
        ("entrainment_speed", -2),
        ("dynamic_viscosity", -1),
    ],
)
def test_a_decade_of_each_argument_adds_its_power(name, power):
    # a slip in a unit (N/mm for N/m, cP for Pa*s) is worth three such decades
    step = friction(**{name: 2.0 * CONTACT[name]}) - friction()
    expected = power * 0.0127 * 1.13 / 0.73 * math.log10(2.0)
    assert step == pytest.approx(expected, rel=1e-10)


@pytest.mark.parametrize(("roughness", "factor"), [(0.325, 1.404), (0.53, 1.883), (0.0, 1.0)])
def test_roughness_factor(roughness, factor):
    ratio = friction(roughness=roughness * 1e-6) / friction(roughness=0.0)
    assert ratio == pytest.approx(factor, abs=5e-4)


def test_variant_has_its_factor():
    assert friction(variant="he-singh") / friction() == pytest.approx(0.0137 / 0.0127, rel=1e-12)
    with pytest.raises(InputError, match='Did you mean "he-singh"'):
        friction(variant="he-sing")


def test_sum_of_the_surface_speeds_instead_of_their_mean():
    # a factor of 4 in the argument of the logarithm
    drop = friction(roughness=0.0) - friction(roughness=0.0, rolling_speed="sum")
    assert drop == pytest.approx(0.0127 * math.log10(4.0), rel=1e-10)
    assert friction(rolling_speed="sum") == pytest.approx(friction(entrainment_speed=4.0))
    with pytest.raises(InputError, match="Known: mean, sum"):
        friction(rolling_speed="total")


def test_sign_of_sliding_does_not_matter():
    assert friction(sliding_speed=-1.0) == friction()


def test_sliding_speed_is_limited_to_its_floor():
    slow = friction(sliding_speed=np.array([0.0, 1e-9, -1e-3, 1e-3]))
    assert np.array_equal(slow, [friction(sliding_speed=1e-3)] * 4)
    assert friction(sliding_speed=0.0, minimum_sliding_speed=0.1) == friction(sliding_speed=0.1)


def test_friction_is_largest_at_the_pitch_point():
    sliding = np.linspace(-2.0, 2.0, 41)
    coefficient = friction(sliding_speed=sliding)
    assert np.argmax(coefficient) == 20
    assert np.all(np.diff(coefficient[:21]) > 0.0)


@pytest.mark.parametrize("speed", [0.0, -1e-3, np.nan])
def test_floor_must_be_positive(speed):
    with pytest.raises(InputError, match="minimum_sliding_speed"):
        friction(minimum_sliding_speed=speed)


def test_negative_logarithm_is_clipped_at_zero_with_a_warning():
    with pytest.warns(ModelWarning, match=r"down to -0\.0.*set to 0") as caught:
        coefficient = friction(load_per_width=np.array([1.0, 100e3]), sliding_speed=3.0)
    assert coefficient[0] == 0.0
    assert coefficient[1] == friction(sliding_speed=3.0)
    assert caught[0].message.code == "friction-range"


def test_rough_flanks_are_warned_of():
    with pytest.warns(
        ModelWarning, match=r"roughness = 0\.991 um is above 0\.8 um.*8\.13"
    ) as caught:
        coefficient = friction(roughness=0.991e-6)
    assert coefficient / friction(roughness=0.0) == pytest.approx(1.13 / 0.139, rel=1e-9)
    assert caught[0].message.code == "friction-roughness"
    assert len(caught) == 1


def test_trusted_roughness_is_inclusive():
    assert friction(roughness=0.8e-6) / friction(roughness=0.0) == pytest.approx(1.13 / 0.33)


@pytest.mark.parametrize("roughness", [1.13e-6, 2e-6, 0.53])
def test_divergence_is_refused(roughness):
    with pytest.raises(InputError, match=r"diverges at 1\.13 um.*unit"):
        friction(roughness=roughness)


@pytest.mark.parametrize("name", CONTACT)
@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_arguments_must_be_finite(name, value):
    with pytest.raises(InputError, match=name):
        friction(**{name: value})


@pytest.mark.parametrize("name", ["load_per_width", "entrainment_speed", "dynamic_viscosity"])
def test_arguments_must_be_positive(name):
    with pytest.raises(InputError, match=name):
        friction(**{name: 0.0})


def test_arrays_are_broadcast():
    result = friction(sliding_speed=np.array([1.0, 2.0]), load_per_width=[[1e5], [2e5], [3e5]])
    assert result.shape == (3, 2)
    assert result[0, 0] == pytest.approx(friction(), rel=1e-14)


@pytest.mark.parametrize(
    "changes", [{"entrainment_speed": 0.09}, {"sliding_speed": 1e-3, "roughness": 0.75e-6}]
)
def test_creeping_surfaces_are_warned_of(changes):
    with pytest.warns(ModelWarning, match="friction coefficient up to") as caught:
        friction(**changes)
    assert caught[0].message.code == "friction-range"
    assert caught[0].filename == __file__


def test_a_rough_flank_is_named_as_the_cause():
    with pytest.warns(ModelWarning, match="roughness factor") as caught:
        friction(sliding_speed=1e-3, roughness=0.75e-6)
    text = str(caught[0].message)
    assert "by 2.97 at S = 0.75 um" in text
    assert "Do not use it below" not in text


def test_close_to_the_pole_the_coefficient_is_that_of_dry_steel():
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        limited = benedict_kelly(133022.0, 0.913038, 1.407953, 0.082, [0.53e-6, 1.073e-6])
    assert any("up to 1.11 is limited to 0.78" in str(each.message) for each in caught)
    assert limited == pytest.approx([0.105843, 0.78], rel=1e-4)
