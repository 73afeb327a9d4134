"""Gears that the tests of the stiffness models share."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable

import pytest

from tribodyn.errors import ModelWarning
from tribodyn.gear import BasicRack, Material, SpurPair, spur_pair


@pytest.fixture(scope="session")
def steel() -> Material:
    return Material()


@pytest.fixture(scope="session")
def fzg() -> Callable[..., SpurPair]:
    """FZG type A with any change; its thin tip and undercut are known and not the matter here."""

    def make(**changes: object) -> SpurPair:
        values = {
            "pinion_teeth": 16,
            "wheel_teeth": 24,
            "normal_module": 4.5e-3,
            "normal_pressure_angle": math.radians(20.0),
            "center_distance": 91.5e-3,
            "pinion_face_width": 20e-3,
            "pinion_profile_shift_coefficient": 0.8635,
            "wheel_profile_shift_coefficient": -0.5103,
            "pinion_bore_diameter": 30e-3,
            "wheel_bore_diameter": 30e-3,
        }
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", ModelWarning)
            return spur_pair(**{**values, **changes})

    return make


@pytest.fixture(scope="session")
def high_contact_pair() -> SpurPair:
    """A pair with a contact ratio between two and three."""
    rack = BasicRack(
        addendum_coefficient=1.4, dedendum_coefficient=1.65, tip_radius_coefficient=0.2
    )
    return spur_pair(
        pinion_teeth=45,
        wheel_teeth=60,
        normal_module=3e-3,
        normal_pressure_angle=math.radians(20.0),
        pinion_face_width=30e-3,
        pinion_bore_diameter=60e-3,
        wheel_bore_diameter=60e-3,
        pinion_rack=rack,
        wheel_rack=rack,
    )
