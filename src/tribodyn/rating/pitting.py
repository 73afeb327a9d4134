"""Pitting: contact stress and its allowable value, ISO 6336-2.

``sigma_H0 = Z_H Z_E Z_eps Z_beta sqrt(F_t/(d_1 b) (u + 1)/u)``,
``sigma_H = Z_B,D sigma_H0 sqrt(K_A K_gamma K_v K_Hbeta K_Halpha)``,
``sigma_HG = sigma_Hlim Z_NT Z_L Z_v Z_R Z_W Z_X``, ``S_H = sigma_HG/sigma_H``, with
``Z_H = sqrt(2 cos(beta_b) cos(alpha_wt)/(cos^2(alpha_t) sin(alpha_wt)))``,
``Z_E = sqrt(1/(pi sum (1 - nu^2)/E))``, ``Z_beta = 1/sqrt(cos(beta))``. The lubricant film factors
Z_L, Z_v and Z_R take the smaller sigma_Hlim of the pair and the viscosity at 40 degC.
"""

from __future__ import annotations

import math
from typing import Final

from tribodyn.rating.conditions import RELIEF_DESIGNS
from tribodyn.rating.factor import Factors, check_range
from tribodyn.rating.influence.face_load import contact_ratio_factor
from tribodyn.rating.life import (
    Curve,
    between_static_and_endurance,
    life_factor,
    pitting_curve,
    reference_cycles,
)
from tribodyn.rating.mesh_load import PRACTICE, MeshLoad
from tribodyn.rating.oil import GearOil
from tribodyn.rating.rated_gear import RatedGear

PART_2: Final = "ISO 6336-2"


def _single_contact_factors(mesh: MeshLoad) -> tuple[float, float]:
    """M_1 and M_2: contact stress at the inner points of single contact over that at C."""
    pair = mesh.pair
    reach = [gear.roll_angle(gear.tip_radius) for gear in mesh.gears]
    pitch = [2.0 * math.pi / gear.teeth for gear in mesh.gears]
    excess = pair.transverse_contact_ratio - 1.0
    tangent = math.tan(pair.operating_pressure_angle)
    first = (reach[0] - pitch[0]) * (reach[1] - excess * pitch[1])
    second = (reach[1] - pitch[1]) * (reach[0] - excess * pitch[0])
    return tangent / math.sqrt(first), tangent / math.sqrt(second)


def _relief_factor(mesh: MeshLoad) -> tuple[float, str, str]:
    """Root of f_ZCa, what it follows from, and its source."""
    if mesh.conditions.edition == 2006:
        return 1.0, "edition 2006", PART_2
    design = mesh.conditions.relief_design
    if design is None:
        design = "experience" if mesh.pair.has_profile_modification else "none"
    return math.sqrt(RELIEF_DESIGNS[design]), f"relief by {design}", PRACTICE


def _record_contact_factors(mesh: MeshLoad) -> None:
    """Z_B and Z_D: stress at B of the pinion and at D of the wheel over that at C."""
    record, overlap = mesh.factors.record, min(mesh.pair.overlap_ratio, 1.0)
    factors = _single_contact_factors(mesh)
    helical, design, source = _relief_factor(mesh)
    for name, short, factor in zip(("M_1", "M_2"), ("Z_B", "Z_D"), factors, strict=True):
        factor = record(name, factor, f"{PART_2}, single pair contact")
        if overlap == 0.0:
            value, branch, from_where = max(factor, 1.0), "spur", PART_2
        else:
            value = max(factor - overlap * (factor - helical), 1.0)
            branch, from_where = f"helical, {design}", source
        if short == "Z_D" and mesh.pair.is_internal:
            value, branch, from_where = 1.0, "internal", PART_2
        record(short, value, f"{from_where}, single pair tooth contact factor", branch=branch)


def record_contact_stress(mesh: MeshLoad) -> None:
    """sigma_H0 of a mesh with its Z factors."""
    record, pair = mesh.factors.record, mesh.pair
    angle, ratio = pair.operating_pressure_angle, mesh.ratio
    zone = 2.0 * math.cos(pair.base_helix_angle) * math.cos(angle)
    zone /= math.cos(pair.transverse_pressure_angle) ** 2 * math.sin(angle)
    compliance = sum(
        (1.0 - gear.material.poissons_ratio**2) / gear.material.youngs_modulus
        for gear in mesh.rated
    )
    z_h = record("Z_H", math.sqrt(zone), f"{PART_2}, zone factor")
    z_e = math.sqrt(1.0 / (math.pi * compliance))
    z_e = record("Z_E", z_e, f"{PART_2}, elasticity factor", unit="Pa^0.5")
    z_eps = contact_ratio_factor(pair.transverse_contact_ratio, pair.overlap_ratio)
    z_eps = record("Z_eps", z_eps, f"{PART_2}, contact ratio factor")
    z_beta = 1.0 / math.sqrt(math.cos(pair.helix_angle))
    z_beta = record("Z_beta", z_beta, f"{PART_2} with Cor. 1:2008, helix angle factor")
    load = mesh.tangential_force / (mesh.reference_diameter * mesh.face_width)
    nominal = z_h * z_e * z_eps * z_beta * math.sqrt(load * (ratio + 1.0) / ratio)
    record("sigma_H0", nominal, f"{PART_2}, nominal contact stress", unit="Pa")
    _record_contact_factors(mesh)


def reduced_radius(mesh: MeshLoad) -> float:
    """rho_red at the pitch point, in the transverse section [m]."""
    tangent = math.tan(mesh.pair.operating_pressure_angle)
    inverse = sum(1.0 / (gear.sign * gear.base_radius * tangent) for gear in mesh.gears)
    return 1.0 / inverse


def _film_constant(limit: float) -> float:
    """C_ZL of sigma_Hlim [N/mm2]."""
    return 0.83 if limit < 850.0 else 0.91 if limit > 1200.0 else limit / 4375.0 + 0.6357


def record_film_factors(mesh: MeshLoad, oil: GearOil) -> None:
    """Z_L, Z_v and Z_R for endurance, of the mesh."""
    record = mesh.factors.record
    limit = 1e-6 * min(gear.material.sigma_Hlim for gear in mesh.rated)
    viscosity = 1e6 * oil.kinematic_viscosity_at_40
    check_range("nu_40", viscosity, 50.0, 1000.0, f"Z_L of {PART_2}, in mm2/s")
    c_l = _film_constant(limit)
    z_l = c_l + 4.0 * (1.0 - c_l) / (1.2 + 134.0 / viscosity) ** 2
    record("Z_L", z_l, f"{PART_2}, lubricant factor")
    c_v = c_l + 0.02
    z_v = c_v + 2.0 * (1.0 - c_v) / math.sqrt(0.8 + 32.0 / mesh.pitch_line_speed)
    record("Z_v", z_v, f"{PART_2}, velocity factor")
    radius = 1e3 * reduced_radius(mesh)
    mean = 0.5e6 * sum(gear.flank_roughness for gear in mesh.rated)
    rz_10 = record("Rz10", 1e-6 * mean * (10.0 / radius) ** (1.0 / 3.0), PART_2, unit="m") * 1e6
    c_r = 0.15 if limit < 850.0 else 0.08 if limit > 1200.0 else 0.32 - 0.0002 * limit
    record("Z_R", (3.0 / rz_10) ** c_r, f"{PART_2}, roughness factor")


def _hardening(
    mesh: MeshLoad, index: int, oil: GearOil, factors: Factors
) -> tuple[float, float, str]:
    """Z_W of a gear at endurance and for static stress, and its rule."""
    rated, mate = mesh.rated[index], mesh.rated[1 - index]
    soft = rated.material.kind.startswith(("St", "V", "GGG"))
    if soft and mate.material.is_hard:
        return _against_hard(mesh, (rated, mate), oil, factors)
    hardnesses = rated.material.hardness, mate.material.hardness
    through = all(gear.material.kind.startswith("V") for gear in mesh.rated)
    if index == 0 or not through or None in hardnesses:
        return 1.0, 1.0, "no work hardening"
    quotient = mate.material.hardness / rated.material.hardness  # type: ignore[operator]
    if quotient < 1.2:
        return 1.0, 1.0, "similar hardness"
    excess = min(abs(mesh.ratio), 20.0) - 1.0
    slope = 0.00698 if quotient > 1.7 else 0.00898 * quotient - 0.00829
    value = 1.0 + slope * excess
    return value, value, "both through-hardened"


def _against_hard(
    mesh: MeshLoad, gears: tuple[RatedGear, RatedGear], oil: GearOil, factors: Factors
) -> tuple[float, float, str]:
    """Z_W of a soft gear with a surface-hardened mate, in this order."""
    soft, hard = gears
    if soft.material.hardness is None:
        return 1.0, 1.0, "hardness of the soft gear is not stated"
    if hard.flank_roughness > 6e-6:
        return 1.0, 1.0, f"hard flank rougher than 6 um: Rz {hard.flank_roughness * 1e6:g} um"
    radius, rough = 1e3 * reduced_radius(mesh), 1e6 * hard.flank_roughness
    film = 1e6 * oil.kinematic_viscosity_at_40 * mesh.pitch_line_speed / 1500.0
    quotient = hard.flank_roughness / soft.flank_roughness
    equivalent = rough * (10.0 / radius) ** 0.33 * quotient**0.66 / film**0.33
    limited = min(max(equivalent, 3.0), 16.0)
    factors.record(
        "R_zH",
        1e-6 * limited,
        f"{PART_2}, work hardening",
        unit="m",
        branch="" if limited == equivalent else f"{equivalent:.4g} um limited",
    )
    check_range("HB", soft.material.hardness, 130.0, 470.0, f"Z_W of {PART_2}", limited=True)
    hardness = min(max(soft.material.hardness, 130.0), 470.0)
    branch = "soft against hard"
    if hardness != soft.material.hardness:
        branch += f"; hardness limited to {hardness:g}"
    value = (1.2 - (hardness - 130.0) / 1700.0) * (3.0 / limited) ** 0.15
    return value, 1.05 - (hardness - 130.0) / 6800.0, branch


def pitting_strength_curve(mesh: MeshLoad, rated: RatedGear) -> Curve:
    """Curve of Z_NT of a gear."""
    conditions = mesh.conditions
    return pitting_curve(rated.material, conditions.long_life_factor, conditions.some_pitting)


def record_pitting(
    mesh: MeshLoad, index: int, oil: GearOil, factors: Factors, cycles: float | None
) -> float:
    """S_H of a gear (0 pinion, 1 wheel) at a number of load cycles."""
    rated, record, common = mesh.rated[index], factors.record, mesh.factors
    curve = pitting_strength_curve(mesh, rated)
    count = reference_cycles(curve) if cycles is None else cycles
    single = common[("Z_B", "Z_D")[index]]
    stress = single * common["sigma_H0"] * math.sqrt(mesh.total_load_factor)
    stress = record("sigma_H", stress, f"{PART_2}, contact stress", unit="Pa")
    limit = record("sigma_Hlim", rated.material.sigma_Hlim, "ISO 6336-5:2016", unit="Pa")
    branch = "no life stated: endurance" if cycles is None else f"N = {count:.6g}"
    strength = limit * record("Z_NT", life_factor(curve, count), f"{PART_2}", branch=branch)
    endurance, static, rule = _hardening(mesh, index, oil, factors)
    names = {name: (1.0, float(common[name]), "") for name in ("Z_L", "Z_v", "Z_R")}
    names["Z_W"] = static, endurance, rule
    for name, (at_static, at_endurance, branch) in names.items():
        value = between_static_and_endurance(at_static, at_endurance, curve, count)
        strength *= record(
            name, value, common[name].source if name in common else PART_2, branch=branch
        )
    strength *= record("Z_X", 1.0, f"{PART_2}, size factor")
    strength = record("sigma_HG", strength, f"{PART_2}, pitting stress limit", unit="Pa")
    return record("S_H", strength / stress, f"{PART_2}, safety against pitting")
