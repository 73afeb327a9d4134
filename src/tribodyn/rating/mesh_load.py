"""One mesh under one load: forces, speeds and running-in that all factors of a rating start from.

``F_t = 2 T_1/d_1`` at the reference cylinder, ``v = pi d_1 n_1``, ``w = F_t K_A K_gamma/b`` with
the common face width b. Source: ISO 6336-1.

Running-in of deviations, in N/mm2, um and m/s:

| group | y_alpha, y_p, y_f | limit at 5 < v <= 10 / v > 10 | y_beta | limit 5 to 10 / above 10 |
| --- | --- | --- | --- | --- |
| steel | 160/sigma_Hlim f | 12800/s, 6400/s | 320/sigma_Hlim F_bx | 25600/s, 12800/s |
| cast iron | 0.275 f | 22, 11 | 0.55 F_bx | 45, 22 |
| hard | 0.075 f | 3 at any speed | 0.15 F_bx | 6 at any speed |
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Final

from tribodyn.gear import CylindricalGear, CylindricalPair
from tribodyn.rating.conditions import RatingConditions
from tribodyn.rating.factor import Factors
from tribodyn.rating.rated_gear import RatedGear
from tribodyn.rating.tolerances import Deviations

PART_1: Final = "ISO 6336-1"
#: Source of what was not compared with the text of a standard.
PRACTICE: Final = "engineering practice, not compared with the text of a standard"


def nominal_root_radius(gear: CylindricalGear) -> float:
    """Half of d_f by the nominal profile shift, without the allowance of the thickness [m]."""
    depth = gear.rack.dedendum_coefficient - gear.profile_shift_coefficient
    return gear.reference_radius - gear.sign * depth * gear.normal_module


@dataclass(frozen=True)
class MeshLoad:
    """A gear pair under one torque and speed, with the factors that are known so far."""

    pair: CylindricalPair
    pinion: RatedGear
    wheel: RatedGear
    conditions: RatingConditions
    torque: float  #: of the pinion [N*m]
    speed: float  #: of the pinion [rad/s]
    factors: Factors

    @property
    def rated(self) -> tuple[RatedGear, RatedGear]:
        """Pinion and wheel."""
        return self.pinion, self.wheel

    @property
    def gears(self) -> tuple[CylindricalGear, CylindricalGear]:
        """Geometry of pinion and wheel."""
        return self.pair.pinion, self.pair.wheel

    @property
    def ratio(self) -> float:
        """Gear ratio u, negative for an internal pair."""
        return self.pair.ratio

    @property
    def face_width(self) -> float:
        """Common face width [m]."""
        return self.pair.common_face_width

    @property
    def reference_diameter(self) -> float:
        """d_1 [m]."""
        return 2.0 * self.pair.pinion.reference_radius

    @cached_property
    def deviations(self) -> tuple[Deviations, Deviations]:
        """Deviations of both gears."""
        pinion, wheel = self.gears
        return self.pinion.deviations(pinion), self.wheel.deviations(wheel)

    @cached_property
    def tangential_force(self) -> float:
        """F_t at the reference cylinder [N]."""
        force = 2.0 * self.torque / self.reference_diameter
        return self.factors.record("F_t", force, f"{PART_1}, 2 T_1/d_1", unit="N")

    @cached_property
    def pitch_line_speed(self) -> float:
        """V at the reference cylinder [m/s]."""
        speed = 0.5 * self.speed * self.reference_diameter
        return self.factors.record("v", speed, f"{PART_1}, pi d_1 n_1", unit="m/s")

    @cached_property
    def outer_factors(self) -> float:
        """K_A K_gamma."""
        application = self.factors.record(
            "K_A", self.conditions.application_factor, f"{PART_1}, application factor"
        )
        sharing = self.factors.record(
            "K_gamma", self.conditions.mesh_load_factor, f"{PART_1}, mesh load factor"
        )
        return application * sharing

    @cached_property
    def line_load(self) -> float:
        """F_t K_A K_gamma/b [N/m]."""
        return self.tangential_force * self.outer_factors / self.face_width

    @cached_property
    def resonance_ratio_limit(self) -> float:
        """N_S, end of the subcritical range."""
        load = 1e-3 * self.line_load
        return 0.85 if load >= 100.0 else 0.5 + 0.35 * math.sqrt(load / 100.0)

    @property
    def total_load_factor(self) -> float:
        """K_A K_gamma K_v K_Hbeta K_Halpha."""
        names = ("K_A", "K_gamma", "K_v", "K_Hbeta", "K_Halpha")
        return math.prod(self.factors[name] for name in names)


def mean_profile_allowance(mesh: MeshLoad, deviation: float) -> float:
    """Mean over both gears of y_alpha of a pitch deviation, or y_f of a form deviation [m]."""
    return _mean_allowance(
        mesh, deviation, (160.0, 12800.0, 6400.0), (0.275, 22.0, 11.0), (0.075, 3.0, 3.0)
    )


def mean_lead_allowance(mesh: MeshLoad, deviation: float) -> float:
    """Mean over both gears of y_beta of the initial equivalent misalignment F_bx [m]."""
    return _mean_allowance(
        mesh, deviation, (320.0, 25600.0, 12800.0), (0.55, 45.0, 22.0), (0.15, 6.0, 6.0)
    )


def _mean_allowance(mesh: MeshLoad, deviation: float, *rules: tuple[float, float, float]) -> float:
    """Mean of a share of the deviation, at most all of it and a limit [m]."""
    # Share and limits [um] up to 10 m/s and above, of steel over sigma_Hlim [MPa]. There is no
    # limit up to 5 m/s except for hard teeth.
    allowances = []
    for material in (gear.material for gear in mesh.rated):
        group = material.running_in_group
        share, slow, fast = rules[("steel", "cast iron", "hard").index(group)]
        over = material.sigma_Hlim * 1e-6 if group == "steel" else 1.0
        limit = 1e-6 * (slow if mesh.pitch_line_speed <= 10.0 else fast) / over
        if group != "hard" and mesh.pitch_line_speed <= 5.0:
            limit = math.inf
        allowances.append(min(min(share / over, 1.0) * deviation, limit))
    return sum(allowances) / 2.0
