"""Gears that the tests of this folder share."""

import math
from collections.abc import Callable
from typing import Any

import pytest

from tribodyn.gear import SpurGear, SpurPair, spur_pair

PLAIN_PAIR: dict[str, Any] = {
    "pinion_teeth": 20,
    "wheel_teeth": 30,
    "normal_module": 4e-3,
    "normal_pressure_angle": math.radians(20.0),
    "pinion_face_width": 20e-3,
}
PLAIN_GEAR: dict[str, Any] = {
    "teeth": 20,
    "normal_module": 4e-3,
    "normal_pressure_angle": math.radians(20.0),
    "profile_shift_coefficient": 0.0,
    "tip_diameter": 88e-3,
    "face_width": 20e-3,
}


@pytest.fixture
def make_pair() -> Callable[..., SpurPair]:
    return lambda **changes: spur_pair(**{**PLAIN_PAIR, **changes})


@pytest.fixture
def make_gear() -> Callable[..., SpurGear]:
    return lambda **changes: SpurGear(**{**PLAIN_GEAR, **changes})
