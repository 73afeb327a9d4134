"""Torsion of the gear body."""

from __future__ import annotations

import numpy as np
import pytest

from tribodyn.errors import InputError
from tribodyn.gear import Material
from tribodyn.stiffness import wind_up_compliance

RING = {"base_radius": 0.034, "root_radius": 0.036, "bore_radius": 0.015, "face_width": 0.02}


def test_it_is_the_shear_of_rings_summed_from_bore_to_root():
    material = Material()
    r = np.linspace(RING["bore_radius"], RING["root_radius"], 200_001)
    # A torque T shears a ring by T / (2 pi r^2 b G); the angle is the sum of shear over radius.
    twist = 1.0 / (2.0 * np.pi * r**3 * RING["face_width"] * material.shear_modulus)
    exact = np.trapezoid(twist, r) * RING["base_radius"] ** 2
    assert wind_up_compliance(**RING, material=material) == pytest.approx(exact, rel=1e-8)


def test_a_gear_without_bore_names_the_rim_as_remedy():
    with pytest.raises(InputError, match='reference = "rim"'):
        wind_up_compliance(**{**RING, "bore_radius": 0.0}, material=Material())


def test_a_bore_beyond_the_root_circle_is_refused():
    with pytest.raises(InputError, match="bore smaller than the root"):
        wind_up_compliance(**{**RING, "bore_radius": 0.036}, material=Material())
