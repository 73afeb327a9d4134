"""Columns of the pair at the pitch point, wherever that point lies."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tribodyn.contact import path_of_contact
from tribodyn.gear import Material, spur_pair
from tribodyn.lubricant import Lubricant
from tribodyn.mesh import build


def table(pair, **changes):
    conditions = {
        "material": Material(),
        "stiffness_model": "rectangular",
        "stiffness_options": {"pair_stiffness": 2e8},
        "lubricant": Lubricant(0.082, 880.0, 21.9e-9),
        "friction_law": "none",
        "composite_roughness": 0.5e-6,
        "film_model": "moes",
        "pinion_speed": 94.0,
        "pinion_torque": 90.0,
        "steps": 64,
    }
    return build(pair, **{**conditions, **changes})


@pytest.mark.parametrize("driver", ["pinion", "wheel"])
def test_the_pair_there_has_the_pitch_point_and_its_own_share(driver, fzg):
    mesh = table(fzg(driver=driver))
    contact = path_of_contact(mesh.gear_pair)
    assert mesh.at_pitch_point("path") == pytest.approx(contact.C, rel=1e-12)
    assert mesh.at_pitch_point("sliding_speed") == pytest.approx(0.0, abs=1e-12)
    # C lies in a double zone of this pair, where equal pairs share equally
    assert mesh.at_pitch_point("load_share") == pytest.approx(0.5, rel=1e-12)
    at_pitch_point = np.abs(mesh.path - contact.C) < 1e-12
    assert mesh.at_pitch_point("central_film") == pytest.approx(
        mesh.central_film[at_pitch_point].max()
    )


def test_one_pair_at_the_pitch_point_carries_all():
    pair = spur_pair(pinion_teeth=20, wheel_teeth=30, normal_module=4e-3,
                     normal_pressure_angle=math.radians(20.0), pinion_face_width=50e-3)  # fmt: skip
    mesh = table(pair)
    assert mesh.at_pitch_point("load_share") == 1.0
    assert mesh.at_pitch_point("film_stiffness") == pytest.approx(
        mesh.film_stiffness.max(), rel=0.1
    )


def test_a_column_that_is_not_there_has_no_value(fzg):
    mesh = table(fzg())
    assert mesh.at_pitch_point("minimum_film") is None
    assert mesh.at_pitch_point("nonsense") is None


def test_a_pitch_point_outside_of_the_contact_has_no_value():
    # large shifts move the whole contact behind it
    pair = spur_pair(
        pinion_teeth=40, wheel_teeth=60, normal_module=4e-3, pinion_face_width=20e-3,
        normal_pressure_angle=math.radians(20.0), pinion_profile_shift_coefficient=1.1,
        wheel_profile_shift_coefficient=-1.1,
    )  # fmt: skip
    contact = path_of_contact(pair)
    assert contact.C < contact.A
    assert table(pair).at_pitch_point("central_film") is None
