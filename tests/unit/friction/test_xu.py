"""The regression of Xu: units, limits, range."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tribodyn.errors import InputError, ModelWarning
from tribodyn.friction import xu_2007

INSIDE = {
    "slide_to_roll_ratio": 0.3,
    "hertz_pressure": 1.0e9,
    "dynamic_viscosity": 0.01,
    "roughness_rms": 0.2e-6,
    "entrainment_speed": 5.0,
    "equivalent_radius": 0.02,
}


def friction(**changes):
    return xu_2007(**{**INSIDE, **changes})


def test_one_point_worked_by_hand_in_the_units_of_the_paper():
    # 1 GPa, 10 cP: |SR| P_h log10(nu) = 0.3
    f = -8.916465 - 0.354068 * 0.3 + 2.812084 * math.exp(-0.3) + 0.620305 * math.exp(0.2)
    by_hand = math.exp(f) * 0.3**1.036077 * 5.0**-0.100601 * 10.0**0.752755 * 0.02**-0.390958
    assert friction() == pytest.approx(by_hand, rel=1e-12)


def test_pure_rolling_has_no_friction():
    assert friction(slide_to_roll_ratio=0.0) == 0.0
    near_rolling = friction(slide_to_roll_ratio=np.array([1e-3, 1e-6, 1e-9]))
    assert np.all(np.diff(near_rolling) < 0.0)
    assert near_rolling[-1] < 1e-8


def test_sign_of_sliding_does_not_matter():
    assert friction(slide_to_roll_ratio=-0.3) == friction()


def test_speed_and_radius_enter_as_powers():
    assert friction(entrainment_speed=10.0) / friction() == pytest.approx(2**-0.100601, rel=1e-12)
    assert friction(equivalent_radius=0.04) / friction() == pytest.approx(2**-0.390958, rel=1e-12)


def test_roughness_enters_as_a_double_exponential():
    ratio = friction(roughness_rms=0.5e-6) / friction(roughness_rms=0.0)
    assert ratio == pytest.approx(math.exp(0.620305 * (math.exp(0.5) - 1.0)), rel=1e-12)


def test_at_one_centipoise_only_the_power_of_the_pressure_is_left():
    thin = friction(dynamic_viscosity=1e-3, hertz_pressure=np.array([0.7e9, 1.4e9]))
    assert thin[1] / thin[0] == pytest.approx(2**1.03303, rel=1e-12)


def test_arrays_are_broadcast():
    result = friction(slide_to_roll_ratio=np.array([0.1, 0.3]), hertz_pressure=[[1e9], [2e9]])
    assert result.shape == (2, 2)
    assert result[0, 1] == pytest.approx(friction(), rel=1e-14)


def test_limits_of_the_range_are_inclusive():
    friction(slide_to_roll_ratio=np.array([0.0, 1.0]), hertz_pressure=np.array([0.5e9, 2.5e9]))
    friction(entrainment_speed=np.array([1.0, 20.0]), equivalent_radius=np.array([5e-3, 80e-3]))
    friction(roughness_rms=np.array([0.0, 0.6e-6]))


@pytest.mark.parametrize(
    ("name", "value", "message"),
    [
        ("slide_to_roll_ratio", -1.49, r"\|slide_to_roll_ratio\| 1\.49.*0 to 1"),
        ("hertz_pressure", 0.4e9, r"hertz_pressure 0\.4 GPa.*0\.5 to 2\.5 GPa"),
        ("hertz_pressure", 3.0e9, r"hertz_pressure 3 GPa"),
        ("entrainment_speed", 0.5, r"entrainment_speed 0\.5 m/s.*1 to 20 m/s"),
        ("entrainment_speed", 30.0, "entrainment_speed 30 m/s"),
        ("equivalent_radius", 4e-3, r"equivalent_radius 4 mm.*5 to 80 mm"),
        ("equivalent_radius", 0.1, "equivalent_radius 100 mm"),
        ("roughness_rms", 0.7e-6, r"roughness 0\.7 um.*0 to 0\.6 um"),
        ("dynamic_viscosity", 0.7e-3, r"dynamic_viscosity 0\.7 mPa\*s.*1 or more mPa\*s"),
        ("dynamic_viscosity", 4.0, r"friction coefficient 0\.2\d+, fitted for 0 to 0\.2"),
    ],
)
def test_every_limit_is_warned_of_with_value_limit_and_remedy(name, value, message):
    with pytest.warns(ModelWarning, match=message + ".*another friction law") as caught:
        friction(**{name: value})
    assert caught[0].message.code == "friction-range"
    assert caught[0].filename == __file__


def test_one_warning_names_all_quantities():
    with pytest.warns(ModelWarning) as caught:
        friction(hertz_pressure=np.array([0.2e9, 0.3e9, 3e9]), slide_to_roll_ratio=1.2)
    assert len(caught) == 1
    for text in (
        "hertz_pressure 0.2 to 3 GPa, fitted for 0.5 to 2.5 GPa",
        "slide_to_roll_ratio| 1.2,",
    ):
        assert text in str(caught[0].message)


@pytest.mark.parametrize("name", INSIDE)
@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_arguments_must_be_finite(name, value):
    with pytest.raises(InputError, match=name):
        friction(**{name: value})


@pytest.mark.parametrize("name", [name for name in INSIDE if name != "slide_to_roll_ratio"])
def test_arguments_must_not_be_negative(name):
    with pytest.raises(InputError, match=name):
        friction(**{name: -INSIDE[name]})


@pytest.mark.parametrize("roughness", [3e-6, 0.2, 200.0])
def test_roughness_far_outside_is_refused_and_does_not_overflow(roughness):
    with pytest.raises(InputError, match=r"xu-2007 gives.*Check the roughness and its unit"):
        friction(roughness_rms=roughness)
