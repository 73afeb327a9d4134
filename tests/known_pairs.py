"""Gear pairs of several kinds for tests of stiffness and transmission error."""

from __future__ import annotations

import math
import warnings
from typing import Any

from tribodyn.errors import ModelWarning
from tribodyn.gear import SpurPair, spur_pair


def pair_of(**changes: Any) -> SpurPair:
    """FZG type A with bores of 30 mm, or what becomes of it by changes; silently."""
    figures: dict[str, Any] = {
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
        return spur_pair(**{**figures, **changes})


def type_c(**changes: Any) -> SpurPair:
    """FZG type C: nearly equal sliding at both ends of the path of contact."""
    return pair_of(
        pinion_profile_shift_coefficient=0.182,
        wheel_profile_shift_coefficient=0.1715,
        pinion_tip_diameter=82.46e-3,
        wheel_tip_diameter=118.36e-3,
        **changes,
    )


def standard(teeth: tuple[int, int], bore: float = 30e-3, **changes: Any) -> SpurPair:
    """Unshifted gears of module 4 mm."""
    return pair_of(
        **{
            "pinion_teeth": teeth[0],
            "wheel_teeth": teeth[1],
            "normal_module": 4e-3,
            "center_distance": None,
            "pinion_profile_shift_coefficient": 0.0,
            "wheel_profile_shift_coefficient": 0.0,
            "pinion_bore_diameter": bore,
            "wheel_bore_diameter": bore,
            **changes,
        }
    )
