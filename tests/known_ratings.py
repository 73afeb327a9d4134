"""Gear pairs whose ratings were computed by hand, with every factor to the digits printed."""

from __future__ import annotations

import math
from typing import Any

from tribodyn.gear import BasicRack, CylindricalPair, FlankModification, cylindrical_pair
from tribodyn.rating import GearMaterial, GearOil, PairRating, RatedGear, rate_pair

UM, MPA = 1e-6, 1e6
STEEL = GearMaterial(kind="Eh", grade="MQ", density=7830.0)
TEST_OIL = GearOil(kinematic_viscosity_at_40=100e-6)


def spur_example(**changes: Any) -> CylindricalPair:
    """FZG type C gears with tip relief."""
    relief, rack = FlankModification(tip_relief=20 * UM), BasicRack(1.0, 1.25, 0.375)
    figures = {
        "pinion_teeth": 16, "wheel_teeth": 24, "normal_module": 4.5e-3,
        "normal_pressure_angle": math.radians(20.0), "helix_angle": 0.0,
        "pinion_face_width": 14e-3, "center_distance": 91.5e-3,
        "pinion_profile_shift_coefficient": 0.1817, "wheel_profile_shift_coefficient": 0.1715,
        "pinion_tip_diameter": 82.636e-3, "wheel_tip_diameter": 118.544e-3,
        "pinion_bore_diameter": 30e-3, "wheel_bore_diameter": 30e-3,
        "pinion_rack": rack, "wheel_rack": rack,
        "pinion_modification": relief, "wheel_modification": relief,
    }  # fmt: skip
    return cylindrical_pair(**{**figures, **changes})


def helical_example(**changes: Any) -> CylindricalPair:
    """Helical pair whose rack is fed 0.03 modules deeper for backlash."""
    beta, rack = math.radians(20.0), BasicRack(1.0, 1.3, 0.25)
    transverse = math.atan(math.tan(math.radians(20.0)) / math.cos(beta))
    thinning = 0.03 * 2e-3 * 2.0 * math.sin(transverse)
    relief = FlankModification(tip_relief=15 * UM)
    figures = {
        "pinion_teeth": 25, "wheel_teeth": 40, "normal_module": 2e-3,
        "normal_pressure_angle": math.radians(20.0), "helix_angle": beta,
        "pinion_face_width": 26e-3,
        "pinion_tip_diameter": (50.0 / math.cos(beta) + 4.0) * 1e-3,
        "wheel_tip_diameter": (80.0 / math.cos(beta) + 4.0) * 1e-3,
        "pinion_bore_diameter": 20e-3, "wheel_bore_diameter": 30e-3,
        "pinion_rack": rack, "wheel_rack": rack,
        "pinion_tooth_thinning": thinning, "wheel_tooth_thinning": thinning,
        "pinion_modification": relief, "wheel_modification": relief,
    }  # fmt: skip
    return cylindrical_pair(**{**figures, **changes})


def ring_example(**changes: Any) -> CylindricalPair:
    """Internal pair without modification."""
    figures = {
        "pinion_teeth": 25, "wheel_teeth": -72, "normal_module": 2e-3,
        "normal_pressure_angle": math.radians(20.0), "helix_angle": 0.0,
        "pinion_face_width": 25e-3, "pinion_profile_shift_coefficient": 0.2,
        "wheel_profile_shift_coefficient": -0.2, "wheel_tip_diameter": 141.4e-3,
    }  # fmt: skip
    return cylindrical_pair(**{**figures, **changes})


def _gear(cycles: float, pitch: float, profile: float, helix: float, *rough: float) -> RatedGear:
    flank, root = rough
    return RatedGear(
        material=STEEL, load_cycles=cycles, pitch_deviation=pitch * UM,
        profile_deviation=profile * UM, helix_deviation=helix * UM,
        flank_roughness=flank * UM, root_roughness=root * UM,
    )  # fmt: skip


#: Pinion and wheel of the spur example, and of the helical one.
SPUR_GEARS = tuple(_gear(cycles, 8.0, 8.0, 9.0, 4.8, 10.0) for cycles in (1e8, 2e8 / 3.0))
HELICAL_GEARS = (
    _gear(9e8, 7.5, 6.0, 7.0, 6.0, 16.0), _gear(5.625e8, 8.0, 6.5, 7.5, 6.0, 16.0),
)  # fmt: skip


def rate_spur(**changes: Any) -> PairRating:
    """Rating of the spur example."""
    values: dict[str, Any] = {
        "torque": 200.0, "speed": 1500.0 * math.pi / 30.0, "oil": TEST_OIL,
        "pinion": SPUR_GEARS[0], "wheel": SPUR_GEARS[1],
        "application_factor": 1.25, "shaft_deflection": 5 * UM,
    }  # fmt: skip
    return rate_pair(spur_example(), **{**values, **changes})


def rate_helical(**changes: Any) -> PairRating:
    """Rating of the helical example."""
    values: dict[str, Any] = {
        "torque": 150.0, "speed": 3000.0 * math.pi / 30.0,
        "oil": GearOil(kinematic_viscosity_at_40=320e-6),
        "pinion": HELICAL_GEARS[0], "wheel": HELICAL_GEARS[1],
        "shaft_deflection": 4 * UM, "relief_design": "contact analysis",
    }  # fmt: skip
    return rate_pair(helical_example(), **{**values, **changes})
