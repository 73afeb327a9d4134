"""Loads of scuffing and micropitting: helical factor, share of the load along the path.

Positions are ``G = tan(alpha_y1)/tan(alpha_wt) - 1``: 0 at the pitch point, least at the root of
the pinion (A), greatest at its tip (E). Without computed load sharing a spur pair without relief
carries ``(Q - 2)/15`` at A (grade Q of at least 7), one third more at B, everything between B and
D, and the mirror image of it towards E. Helical pairs of eps_gamma > 2 carry 1/eps_alpha, times the
buttressing factor 1.3 at A and E that falls to 1 over ``0.2 sin(beta_b)``.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from tribodyn.contact import effective_modulus
from tribodyn.gear import CylindricalPair
from tribodyn.rating.factor import Factors
from tribodyn.rating.mesh_load import PRACTICE, MeshLoad
from tribodyn.rating.oil import GearOil
from tribodyn.types import Array

PART_20, PART_21, PART_22 = "ISO/TS 6336-20", "ISO/TS 6336-21", "ISO/TS 6336-22"


#: X_W of normal, phosphated and of nitrided or copper-plated steel; others are from memory.
_KNOWN_STRUCTURES = (1.0, 1.25, 1.5)


def helical_load_factor(total_contact_ratio: float) -> float:
    """K_Bgamma: 1 up to eps_gamma = 2, then 1 + 0.2 sqrt((eps - 2)(5 - eps)), 1.3 from 3.5 on."""
    excess = min(max(total_contact_ratio, 2.0), 3.5)
    return 1.0 + 0.2 * math.sqrt((excess - 2.0) * (5.0 - excess))


@dataclass(frozen=True)
class PathPoints:
    """Points A to E of the path of contact by the parameter G."""

    pair: CylindricalPair

    @cached_property
    def pitch_path(self) -> float:
        """Distance of the pitch point from the pinion's base tangent point [m]."""
        return self.pair.line_of_action_length / (1.0 + self.pair.ratio)

    @cached_property
    def ends(self) -> tuple[float, float]:
        """G at A and at E."""
        first, last = self.pair.path_limits
        return first / self.pitch_path - 1.0, last / self.pitch_path - 1.0

    @cached_property
    def pitch(self) -> float:
        """Base pitch in G."""
        return self.pair.base_pitch / self.pitch_path

    @cached_property
    def named(self) -> dict[str, float]:
        """G of A, AB, B, C, D, DE and E."""
        a, e = self.ends
        b, d = e - self.pitch, a + self.pitch
        return {"A": a, "AB": 0.5 * (a + b), "B": b, "C": 0.0, "D": d, "DE": 0.5 * (d + e), "E": e}

    def path(self, position: Array) -> Array:
        """Distance from the pinion's base tangent point [m]."""
        return np.asarray(self.pitch_path * (1.0 + position))

    def grid(self, points: int = 401) -> Array:
        """Positions from A to E with both sides of B and D and the pitch point."""
        a, e = self.ends
        b, d = e - self.pitch, a + self.pitch
        events = [x + side for x in (b, d) for side in (-1e-9, 1e-9) if a < x + side < e]
        return np.unique(np.concatenate([np.linspace(a, e, points), [0.0] * (a < 0.0 < e), events]))

    def share(self, position: Array, grade: int | None) -> Array:
        """Share of the load, with the buttressing of helical pairs."""
        a, e = self.ends
        pair, total = self.pair, self.pair.total_contact_ratio
        if pair.overlap_ratio > 0.0:
            straight = np.full_like(position, 1.0 / pair.transverse_contact_ratio)
            if total <= 2.0:
                straight = self._spur_share(position, grade)
            extra = 0.3 * min(pair.overlap_ratio, 1.0)
            width = 0.2 * math.sin(pair.base_helix_angle)
            inside = np.minimum(position - a, e - position)
            return np.asarray(straight * (1.0 + extra * np.clip(1.0 - inside / width, 0.0, 1.0)))
        return self._spur_share(position, grade)

    def _spur_share(self, position: Array, grade: int | None) -> Array:
        a, e = self.ends
        ratio = self.pair.transverse_contact_ratio
        if ratio >= 2.0:
            return np.full_like(position, 1.0 / ratio)
        first = (max(7, grade or 7) - 2) / 15.0
        double = e - self.pitch - a  # from A to B
        inside = np.minimum(position - a, e - position)
        single = inside > double * (1.0 - 1e-12)
        rising = first + np.clip(inside / double, 0.0, 1.0) / 3.0
        return np.asarray(np.where(single | (inside >= double), 1.0, rising))


@dataclass(frozen=True)
class ScuffingLoad:
    """Load, oil and roughness of a mesh as scuffing and micropitting need them."""

    mesh: MeshLoad
    oil: GearOil

    @property
    def points(self) -> PathPoints:
        """Path of contact."""
        return PathPoints(self.mesh.pair)

    @property
    def factors(self) -> Factors:
        """Factors of the mesh."""
        return self.mesh.factors

    @cached_property
    def line_load(self) -> float:
        """w_Bt [N/m]."""
        load = self.mesh.tangential_force * self.mesh.total_load_factor / self.mesh.face_width
        return self.factors.record("w_Bt", load, f"{PART_20}, transverse unit load", unit="N/m")

    @cached_property
    def helical_factor(self) -> float:
        """K_Bgamma."""
        value = helical_load_factor(self.mesh.pair.total_contact_ratio)
        return self.factors.record("K_Bgamma", value, f"{PART_20}, helical load factor")

    @cached_property
    def pitch_speed(self) -> float:
        """v_t at the operating pitch circle [m/s]."""
        pair = self.mesh.pair
        return self.mesh.speed * pair.pinion.base_radius / math.cos(pair.operating_pressure_angle)

    @cached_property
    def modulus(self) -> float:
        """E_r = 2/sum((1 - nu^2)/E) [Pa]."""
        return effective_modulus(*(gear.material for gear in self.mesh.rated))

    @cached_property
    def roughness(self) -> float:
        """Mean Ra of both flanks [m]."""
        return sum(gear.roughness_ra for gear in self.mesh.rated) / 2.0

    @cached_property
    def pitch_radius(self) -> float:
        """Radius of relative curvature at the pitch point, transverse [m]."""
        pair = self.mesh.pair
        length, ratio = pair.line_of_action_length, pair.ratio
        return ratio * length / (1.0 + ratio) ** 2

    @cached_property
    def addendum_ratios(self) -> tuple[float, float]:
        """Addendum contact ratios eps_1 and eps_2."""
        pair = self.mesh.pair
        tangent = math.tan(pair.operating_pressure_angle)
        first, second = (
            gear.teeth / (2.0 * math.pi) * (gear.roll_angle(gear.tip_radius) - tangent)
            for gear in self.mesh.gears
        )
        self.factors.record("eps_1", first, f"{PART_21}, addendum contact ratio of the pinion")
        self.factors.record("eps_2", second, f"{PART_21}, addendum contact ratio of the wheel")
        return first, second

    @cached_property
    def grade(self) -> int | None:
        """Coarser grade of both gears, if stated."""
        grades = [gear.grade for gear in self.mesh.rated if gear.grade is not None]
        return max(grades) if grades else None

    @cached_property
    def effective_relief(self) -> float:
        """C_eff, deflection of the teeth under the load [m]."""
        spur = self.mesh.pair.helix_angle == 0.0
        stiffness = self.factors["c_prime" if spur else "c_gamma_alpha"]
        branch = "F_t K_A K_gamma/(b c')" if spur else "F_t K_A K_gamma/(b c_gamma,alpha)"
        value = self.mesh.line_load / stiffness
        return self.factors.record("C_eff", value, PART_20, unit="m", branch=branch)

    @cached_property
    def mates_factor(self) -> float:
        """X_mp = (1 + n_p)/2 for n_p mates."""
        mates = max(gear.meshes_per_turn for gear in self.mesh.rated)
        return self.factors.record("X_mp", 0.5 * (1.0 + mates), f"{PRACTICE}, several mates")

    @cached_property
    def structure_factor(self) -> float:
        """X_W, mean of both gears."""
        values, branches, source = [], [], PART_20
        for gear in self.mesh.rated:
            nitrided = gear.material.kind.startswith("N")
            default = 1.5 if nitrided else 1.0
            values.append(default if gear.structure_factor is None else gear.structure_factor)
            branches.append("stated" if gear.structure_factor else gear.material.kind)
            if values[-1] not in _KNOWN_STRUCTURES or gear.material.kind.startswith("G"):
                source = PRACTICE
        branch = " and ".join(dict.fromkeys(branches))
        value = sum(values) / 2.0
        return self.factors.record("X_W", value, f"{source}, structural factor", branch=branch)


def overlap_factor(relief: float, effective: float, ratio: float) -> float:
    """X_Ca of tip relief C_a over C_eff, at the greater addendum contact ratio."""
    q = min(relief / effective, 1.0) if effective > 0.0 else 1.0
    return 1.0 + (0.06 + 0.18 * q) * ratio + (0.02 + 0.69 * q) * ratio**2


def line_factor(pair: CylindricalPair) -> float:
    """X_alpha,beta, the pressure angle factor of the flash temperature."""
    working, beta = pair.operating_pressure_angle, pair.helix_angle
    numerator = math.sin(working) * math.cos(pair.pinion.normal_pressure_angle) * math.cos(beta)
    denominator = math.cos(working) * math.cos(pair.transverse_pressure_angle)
    return float(1.22 * numerator**0.25 / math.sqrt(denominator))
