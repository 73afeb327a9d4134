"""Permissible film ratio from the FZG micropitting test C-GF/8.3, and the safety S_lambda.

``lambda_GFP = W_W lambda_GFT``: the film ratio of the test gears at A, at the oil temperature of
the test and the torque of the failure load stage 5 to 10: 70.0, 98.9, 132.5, 171.6, 215.6 and
265.1 N m.
"""

from __future__ import annotations

import math
from dataclasses import replace
from functools import lru_cache

import numpy as np

from tribodyn.errors import quiet
from tribodyn.gear import CylindricalPair, spur_pair
from tribodyn.rating.conditions import RatingConditions
from tribodyn.rating.factor import Factors
from tribodyn.rating.materials import GearMaterial
from tribodyn.rating.mesh_load import PRACTICE, MeshLoad
from tribodyn.rating.oil import GearOil
from tribodyn.rating.rated_gear import RatedGear
from tribodyn.rating.surface.micropitting import film_points, least_film_ratio, material_factor
from tribodyn.rating.surface.path_load import PART_22, ScuffingLoad

#: Torque of the pinion [N*m] by failure load stage.
TORQUES = {5: 70.0, 6: 98.9, 7: 132.5, 8: 171.6, 9: 215.6, 10: 265.1}
#: Speed of the pinion [1/min], and Ra of the flanks [m].
_SPEED, _ROUGHNESS = 2250.0, 0.5e-6


@lru_cache(maxsize=1)
def _test_gears() -> CylindricalPair:
    """Type C-GF."""
    with quiet():
        return spur_pair(
            pinion_teeth=16,
            wheel_teeth=24,
            normal_module=4.5e-3,
            normal_pressure_angle=math.radians(20.0),
            center_distance=91.5e-3,
            pinion_profile_shift_coefficient=0.182,
            wheel_profile_shift_coefficient=0.171,
            pinion_tip_diameter=82.46e-3,
            wheel_tip_diameter=118.36e-3,
            pinion_face_width=14e-3,
        )


def reference_film_ratio(oil: GearOil, stage: int) -> float:
    """lambda_GFT of an oil that failed in a load stage."""
    gear = RatedGear(material=GearMaterial(), arithmetic_roughness=_ROUGHNESS)
    ones = dict.fromkeys(("K_A", "K_gamma", "K_v", "K_Hbeta", "K_Halpha"), 1.0)
    factors = Factors({**ones, "C_eff": 1.0})  # no relief
    for name in ones:
        factors.record(name, 1.0, PART_22)
    factors.record("c_prime", 1e10, PART_22)
    speed = _SPEED * math.pi / 30.0
    mesh = MeshLoad(_test_gears(), gear, gear, RatingConditions(), TORQUES[stage], speed, factors)
    tested = replace(
        oil,
        temperature=oil.micropitting_test_temperature,
        lubrication=oil.micropitting_test_lubrication,
    )
    load = ScuffingLoad(mesh, tested)
    with quiet("friction-range"):
        films = film_points(load, np.array([load.points.named["A"]]))
    return float(films.film_ratio[0])


def record_micropitting(load: ScuffingLoad) -> float | None:
    """S_lambda of a mesh; None without a load stage of the oil or a permissible film ratio."""
    record, oil = load.factors.record, load.oil
    least = least_film_ratio(load)
    if "lambda_GFP" in load.factors.replacements:
        limit = record("lambda_GFP", 0.0, f"{PART_22}, permissible film ratio")
    elif oil.micropitting_load_stage is None:
        return None
    else:
        stage = oil.micropitting_load_stage
        tested = reference_film_ratio(oil, stage)
        branch = f"load stage {stage}"
        tested = record("lambda_GFT", tested, f"{PRACTICE}, test gears at A", branch=branch)
        weight = record("W_W", material_factor(load), f"{PRACTICE}, material factor")
        limit = record("lambda_GFP", weight * tested, f"{PART_22}, permissible film ratio")
    return record("S_lambda", least / limit, f"{PART_22}, safety against micropitting, method B")
