"""ISO 6336-1 stiffness: the polynomial, the corrections, the course along the path."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tribodyn.contact import path_of_contact
from tribodyn.errors import InputError, ModelWarning
from tribodyn.gear import BasicRack, Material, spur_pair
from tribodyn.stiffness import (
    MODELS,
    iso6336_mesh_stiffness,
    iso6336_pair_stiffness,
    iso6336_single_stiffness,
)


def make(z1=30, z2=30, **changes):
    values = {
        "pinion_teeth": z1,
        "wheel_teeth": z2,
        "normal_module": 4e-3,
        "normal_pressure_angle": math.radians(20.0),
        "pinion_face_width": 20e-3,
    }
    return spur_pair(**{**values, **changes})


def test_one_pair_worked_by_hand(steel):
    q = 0.04723 + 0.15551 / 20 + 0.25791 / 60
    stiffness = iso6336_single_stiffness(make(20, 60), steel, 4000.0)
    # C_B = 1 + 0.5 (1.2 - 1.25) for the rack of ISO 53, profile A.
    assert stiffness == pytest.approx(0.8e9 * 0.975 / q, rel=1e-12)


def test_profile_shift_worked_by_hand(fzg, steel):
    x1, x2 = 0.8635, -0.5103
    q = (
        0.04723 + 0.15551 / 16 + 0.25791 / 24 - 0.00635 * x1 - 0.11654 * x1 / 16
        - 0.00193 * x2 - 0.24188 * x2 / 24 + 0.00529 * x1**2 + 0.00182 * x2**2
    )  # fmt: skip
    stiffness = iso6336_single_stiffness(fzg(), steel, 4000.0)
    assert stiffness == pytest.approx(0.8e9 * 0.975 / q, rel=1e-12)


def test_common_gears_lie_in_the_range_of_the_standard(steel):
    # The standard offers 14 N/(mm um) for a pair and 20 for the mesh where nothing is known.
    rack = BasicRack(dedendum_coefficient=1.2)
    pair = make(24, 36, pinion_rack=rack, wheel_rack=rack)
    single = iso6336_single_stiffness(pair, steel, 4000.0) / 1e9
    mesh = iso6336_mesh_stiffness(single * 1e9, pair.transverse_contact_ratio) / 1e9
    assert single == pytest.approx(14.0, abs=1.0)
    assert mesh == pytest.approx(20.0, abs=2.0)


def test_light_load_lowers_the_stiffness_by_the_fourth_root(steel):
    pair = make()
    at_limit = 100e3 * 20e-3 / math.cos(math.radians(20.0))
    full = iso6336_single_stiffness(pair, steel, at_limit)
    assert iso6336_single_stiffness(pair, steel, 2 * at_limit) == pytest.approx(full, rel=1e-12)
    lighter = iso6336_single_stiffness(pair, steel, at_limit / 16)
    assert lighter == pytest.approx(full / 2, rel=1e-12)
    amplified = iso6336_single_stiffness(pair, steel, at_limit / 16, application_factor=16.0)
    assert amplified == pytest.approx(full, rel=1e-12)


def test_stiffness_scales_with_the_modulus(steel):
    softer = iso6336_single_stiffness(make(), Material(103e9), 4000.0)
    assert softer == pytest.approx(iso6336_single_stiffness(make(), steel, 4000.0) / 2, rel=1e-12)


def test_basic_rack_factor(steel):
    deep = BasicRack(dedendum_coefficient=1.4, tip_radius_coefficient=0.3)
    pair = make(pinion_rack=deep, wheel_rack=deep)
    expected = iso6336_single_stiffness(make(), steel, 4000.0) * 0.9 / 0.975
    assert iso6336_single_stiffness(pair, steel, 4000.0) == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("driver", ["pinion", "wheel"])
def test_the_course_has_both_numbers_of_the_standard(driver, fzg, steel):
    pair = fzg(driver=driver)
    contact = path_of_contact(pair)
    single = iso6336_single_stiffness(pair, steel, 2660.0)
    middle = np.array([(contact.A + contact.E) / 2])
    peak = iso6336_pair_stiffness(pair, steel, middle, 2660.0)[0]
    assert peak == pytest.approx(single * pair.common_face_width, rel=1e-12)
    phase = (np.arange(20_000) + 0.5) / 20_000
    path, in_contact = contact.pair_paths(phase)
    total = MODELS["iso6336"](pair, steel, path, in_contact, phase, 2660.0).sum(axis=1)
    expected = iso6336_mesh_stiffness(single, contact.contact_ratio) * pair.common_face_width
    assert total.mean() == pytest.approx(expected, rel=1e-4)


def test_outside_the_shifts_of_the_standard_it_warns(steel):
    pair = make(20, 40, pinion_profile_shift_coefficient=-0.1, wheel_profile_shift_coefficient=0.3)
    with pytest.warns(ModelWarning, match="x1 >= x2"):
        iso6336_single_stiffness(pair, steel, 4000.0)


@pytest.mark.parametrize("force", [0.0, -1.0, np.nan])
def test_no_force_is_refused(force, steel):
    with pytest.raises(InputError, match="normal_force"):
        iso6336_single_stiffness(make(), steel, force)
