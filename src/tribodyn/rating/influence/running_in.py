"""Running-in of deviations: ISO 6336-1, in N/mm2, um and m/s.

| group | y_alpha, y_p, y_f | limit at 5 < v <= 10 / v > 10 | y_beta | limit 5 to 10 / above 10 |
| --- | --- | --- | --- | --- |
| steel | 160/sigma_Hlim f | 12800/s, 6400/s | 320/sigma_Hlim F_bx | 25600/s, 12800/s |
| cast iron | 0.275 f | 22, 11 | 0.55 F_bx | 45, 22 |
| hard | 0.075 f | 3 at any speed | 0.15 F_bx | 6 at any speed |
"""

from __future__ import annotations

import math

from tribodyn.rating.materials import GearMaterial
from tribodyn.rating.mesh_load import MeshLoad


def _limit(material: GearMaterial, speed: float, widest: tuple[float, float, float]) -> float:
    """Greatest allowance of the profile [um]; over sigma_Hlim for steel."""
    slow, fast, hard = widest
    if material.running_in_group == "hard":
        return hard
    if speed <= 5.0:
        return math.inf
    limit = slow if speed <= 10.0 else fast
    steel = material.running_in_group == "steel"
    return limit / (material.sigma_Hlim * 1e-6) if steel else limit


def profile_allowance(material: GearMaterial, deviation: float, speed: float) -> float:
    """y_alpha of a base pitch deviation, or y_f of a form deviation [m]."""
    steel = material.running_in_group == "steel"
    share = {"steel": 160e6 / material.sigma_Hlim, "cast iron": 0.275, "hard": 0.075}
    limits = (12800.0, 6400.0, 3.0) if steel else (22.0, 11.0, 3.0)
    allowance = share[material.running_in_group] * deviation
    return min(allowance, 1e-6 * _limit(material, speed, limits))


def lead_allowance(material: GearMaterial, deviation: float, speed: float) -> float:
    """y_beta of the initial equivalent misalignment F_bx [m]; of steel at most F_bx itself."""
    steel = material.running_in_group == "steel"
    share = {"steel": 320e6 / material.sigma_Hlim, "cast iron": 0.55, "hard": 0.15}
    limits = (25600.0, 12800.0, 6.0) if steel else (45.0, 22.0, 6.0)
    allowance = min(share[material.running_in_group], 1.0) * deviation
    return min(allowance, 1e-6 * _limit(material, speed, limits))


def mean_profile_allowance(mesh: MeshLoad, deviation: float) -> float:
    """Mean of the allowances of both gears [m]."""
    speed = mesh.pitch_line_speed
    return sum(profile_allowance(gear.material, deviation, speed) for gear in mesh.rated) / 2.0


def mean_lead_allowance(mesh: MeshLoad, deviation: float) -> float:
    """Mean of the allowances of both gears along the face [m]."""
    speed = mesh.pitch_line_speed
    return sum(lead_allowance(gear.material, deviation, speed) for gear in mesh.rated) / 2.0
