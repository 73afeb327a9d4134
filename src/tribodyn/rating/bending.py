"""Bending of the tooth root: stress by ISO 6336-3, method B, and strength.

``sigma_F0 = F_t/(b m_n) Y_F Y_S Y_beta Y_B Y_DT``,
``sigma_F = sigma_F0 K_A K_gamma K_v K_Fbeta K_Falpha``,
``sigma_FG = sigma_Flim Y_ST Y_NT Y_drelT Y_RrelT Y_X``, ``S_F = sigma_FG/sigma_F``, with
``Y_F = 6 h_Fe cos(alpha_Fen)/(s_Fn^2 cos(alpha_n)) f_eps`` (lengths over m_n) for a load at the
outer point of single contact of the virtual gear, and
``Y_S = (1.2 + 0.13 L) q_s^(1/(1.21 + 2.3/L))``, ``L = s_Fn/h_Fe``, ``q_s = s_Fn/(2 rho_F)``.

Strength:
``Y_drelT = (1 + sqrt(rho' (1 + 2 q_s)/5))/(1 + sqrt(1.2 rho'))`` with the slip layer rho' in mm;
``Y_RrelT`` by the Rz of the root; ``Y_X`` by the module; for a reversed load
``Y_M = 1/(1 - R (1 - M)/(1 + M))`` with the stress ratio R and the mean stress ratio M.
"""

from __future__ import annotations

import math
from typing import Final, NamedTuple

import numpy as np

from tribodyn.errors import Argument, InputError
from tribodyn.gear import CylindricalGear
from tribodyn.gear.curves import involute
from tribodyn.rating.factor import Factors, check_range
from tribodyn.rating.life import (
    bending_curve,
    between_static_and_endurance,
    life_factor,
    reference_cycles,
)
from tribodyn.rating.materials import GearMaterial
from tribodyn.rating.mesh_load import PRACTICE, MeshLoad
from tribodyn.rating.root_section import RootSection, root_section, virtual_teeth

PART_3: Final = "ISO 6336-3"


class LeverArm(NamedTuple):
    """Load at the outer point of single contact of the virtual gear."""

    bending_arm: float  #: h_Fe over m_n
    load_angle: float  #: alpha_Fen [rad]
    pressure_angle: float  #: alpha_en [rad]


def virtual_contact_ratio(mesh: MeshLoad) -> float:
    """eps_alpha,n = eps_alpha/cos^2(beta_b)."""
    return mesh.pair.transverse_contact_ratio / math.cos(mesh.pair.base_helix_angle) ** 2


def lever_arm(gear: CylindricalGear, section: RootSection, contact_ratio: float) -> LeverArm:
    """Lever arm and angle of the load; lengths over the normal module."""
    z, angle = virtual_teeth(gear), gear.normal_pressure_angle
    sign, module = gear.sign, gear.normal_module
    base = abs(z) * math.cos(angle)
    tip = abs(z) + 2.0 * (gear.tip_radius - gear.reference_radius) / module
    reach = math.sqrt((0.5 * tip) ** 2 - (0.5 * base) ** 2)
    reach -= sign * math.pi * math.cos(angle) * (contact_ratio - 1.0)
    at_load = math.atan(reach / (0.5 * base))
    shift = gear.generating_shift_coefficient
    half = (math.pi / 2.0 + 2.0 * shift * math.tan(angle)) / z + involute(angle) - involute(at_load)
    load_angle = at_load - half
    center = 0.5 * base / math.cos(load_angle)
    return LeverArm(sign * (center - section.center_distance), load_angle, at_load)


def form_factor(
    lever: LeverArm, section: RootSection, pressure_angle: float, overlap_factor: float
) -> float:
    """Y_F."""
    bending = 6.0 * lever.bending_arm * math.cos(lever.load_angle)
    return bending / (section.chord**2 * math.cos(pressure_angle)) * overlap_factor


def stress_correction(slenderness: float, notch: float) -> float:
    """Y_S at L = s_Fn/h_Fe and q_s = s_Fn/(2 rho_F)."""
    return float((1.2 + 0.13 * slenderness) * notch ** (1.0 / (1.21 + 2.3 / slenderness)))


def load_distribution_factor(
    contact_ratio: float, overlap: float, edition: int
) -> tuple[float, str]:
    """f_eps of the 2019 form factor, and its rule."""
    if edition == 2006:
        return 1.0, "edition 2006"
    if overlap == 0.0:
        return (1.0, "spur") if contact_ratio < 2.0 else (0.7, "spur, eps_alpha,n >= 2")
    if overlap >= 1.0:
        return contact_ratio**-0.5, "eps_beta >= 1"
    share = 1.0 - overlap
    if contact_ratio >= 2.0:
        return math.sqrt(0.5 * share + overlap / contact_ratio), "eps_beta < 1, eps_alpha,n >= 2"
    return math.sqrt(share + overlap / contact_ratio), "eps_beta < 1"


def _helix_factor(mesh: MeshLoad) -> float:
    """Y_beta."""
    beta, overlap = mesh.pair.helix_angle, mesh.pair.overlap_ratio
    degrees = math.degrees(beta)
    check_range("beta", degrees, 0.0, 30.0, f"Y_beta of {PART_3}, in deg")
    value = 1.0 - min(overlap, 1.0) * min(degrees, 30.0) / 120.0
    if mesh.conditions.edition == 2019:
        value /= math.cos(beta) ** 3
    branch = f"edition {mesh.conditions.edition}" + ("; beta limited to 30 deg" * (degrees > 30.0))
    return mesh.factors.record("Y_beta", value, f"{PART_3}, helix angle factor", branch=branch)


def rim_factor(gear: CylindricalGear, name: str) -> tuple[float, str, str]:
    """Y_B, its rule and source."""
    height = abs(gear.tip_radius - gear.root_radius)
    rim = abs(gear.rim_radius - gear.root_radius)
    if gear.is_ring:
        ratio, limits, source = rim / gear.normal_module, (1.75, 3.5), PRACTICE
        symbol, value = "s_R/m_n", 1.15 * math.log(8.324 / ratio)
    else:
        ratio, limits, source = rim / height, (0.5, 1.2), PART_3
        symbol, value = "s_R/h_t", 1.6 * math.log(2.242 / ratio)
    if gear.bore_diameter == 0.0 and not gear.is_ring:
        return 1.0, "solid", source
    if ratio >= limits[1]:
        return 1.0, f"{symbol} = {ratio:.4g}", source
    if ratio >= limits[0]:
        return value, f"thin rim, {symbol} = {ratio:.4g}", source
    raise InputError(
        f"rim of {rim * 1e3:.4g} mm behind the teeth of the {name}: {symbol} = {ratio:.4g}",
        where=Argument("rim_diameter" if gear.is_ring else "bore_diameter", name),
        why=f"The rim factor Y_B holds from {symbol} = {limits[0]:g}",
        remedy="Make the rim thicker, or give the factor Y_B from a computed root stress",
    )


def _deep_tooth_factor(
    mesh: MeshLoad, contact_ratio: float, grade: int | None
) -> tuple[float, str]:
    """Y_DT and its rule."""
    if contact_ratio <= 2.05 or grade is None or grade > 4:
        return (
            1.0,
            "eps_alpha,n <= 2.05" if contact_ratio <= 2.05 else "grade above 4 or not stated",
        )
    if contact_ratio <= 2.5:
        return 2.366 - 0.666 * contact_ratio, "eps_alpha,n up to 2.5"
    return 0.7, "eps_alpha,n above 2.5"


def record_root_stress(mesh: MeshLoad, index: int, factors: Factors) -> float:
    """sigma_F of a gear (0 pinion, 1 wheel) with its Y factors."""
    gear, rated, mate = mesh.gears[index], mesh.rated[index], mesh.gears[1 - index]
    record, module = factors.record, gear.normal_module
    ratio = virtual_contact_ratio(mesh)
    section = root_section(gear, rated.cutter, mesh.conditions.edition)
    lever = lever_arm(gear, section, ratio)
    lengths = {"s_Fn": section.chord, "h_Fe": lever.bending_arm, "rho_F": section.fillet_radius}
    chord, arm, fillet = (
        record(name, value * module, f"{PART_3}, critical section", unit="m", branch=section.tool)
        for name, value in lengths.items()
    )
    record("alpha_Fen", lever.load_angle, f"{PART_3}, angle of the load", unit="rad")
    f_eps, rule = load_distribution_factor(ratio, mesh.pair.overlap_ratio, mesh.conditions.edition)
    f_eps = record("f_eps", f_eps, PRACTICE, branch=rule)
    y_f = form_factor(lever, section, gear.normal_pressure_angle, f_eps)
    source = PRACTICE if gear.is_ring else PART_3  # the lever of rings is derived
    y_f = record("Y_F", y_f, f"{source}, form factor", branch=section.tool)
    slender = chord / arm
    notch = record("q_s", chord / (2.0 * fillet), f"{PART_3}, notch parameter")
    check_range("q_s", notch, 1.0, 8.0, f"Y_S of {PART_3}")
    y_s = record("Y_S", stress_correction(slender, notch), f"{PART_3}, stress correction factor")
    if "Y_B" in factors.replacements:
        y_b = record("Y_B", 1.0, f"{PART_3}, rim factor")
    else:
        y_b, rule, source = rim_factor(gear, ("pinion", "wheel")[index])
        y_b = record("Y_B", y_b, f"{source}, rim factor", branch=rule)
    y_dt, rule = _deep_tooth_factor(mesh, ratio, rated.grade)
    y_dt = record("Y_DT", y_dt, f"{PART_3}, deep tooth factor", branch=rule)
    width = min(gear.face_width, mate.face_width + 2.0 * module)
    nominal = mesh.tangential_force / (width * module) * y_f * y_s * y_b * y_dt
    nominal *= mesh.factors["Y_beta"]
    nominal = record("sigma_F0", nominal, f"{PART_3}, nominal root stress", unit="Pa")
    names = ("K_A", "K_gamma", "K_v", "K_Fbeta", "K_Falpha")
    stress = nominal * math.prod(mesh.factors[name] for name in names)
    return record("sigma_F", stress, f"{PART_3}, root stress", unit="Pa")


def record_helix_factor(mesh: MeshLoad) -> None:
    """Y_beta and eps_alpha,n of a mesh."""
    ratio = virtual_contact_ratio(mesh)
    mesh.factors.record("eps_alphan", ratio, f"{PART_3}, virtual contact ratio")
    _helix_factor(mesh)


#: Slip layer rho' [mm] over strength [N/mm2]; of St over sigma_S, of V over sigma_0.2.
_ST: Final = ((300.0, 400.0), (0.0833, 0.0445))
_V: Final = ((500.0, 600.0, 800.0, 1000.0), (0.0281, 0.0194, 0.0064, 0.0014))
#: Y_RrelT: below 1 um, then a - b (Rz + 1)^c.
_ROUGHNESS: Final = {
    "steel": (1.12, 1.674, 0.529, 0.1),
    "St": (1.07, 5.306, 4.203, 0.01),
    "soft": (1.025, 4.299, 3.259, 0.0058),
}
#: Y_X: a - b m_n from 5 mm down to a least value.
_SIZE: Final = {
    "steel": (1.03, 0.006, 0.85), "hard": (1.05, 0.01, 0.80), "cast iron": (1.075, 0.015, 0.70),
}  # fmt: skip


def _strength(material: GearMaterial) -> float:
    """sigma_S or sigma_0.2 [N/mm2] that the notch sensitivity needs."""
    if material.yield_strength is not None:
        return 1e-6 * material.yield_strength
    raise InputError(
        f"yield_strength of {material.kind} is missing",
        Argument("yield_strength"),
        "The notch sensitivity of structural and through-hardened material depends on it",
        "Give yield_strength, or the factor Y_drelT",
    )


def slip_layer(material: GearMaterial) -> tuple[float, str]:
    """Rho' [mm] of a material, and its rule."""
    kind = material.kind
    if kind.startswith("N"):
        return 0.1005, "nitrided"
    if kind in ("Eh", "IF"):
        return 0.0030, "case- or induction-hardened"
    if kind in ("GG", "GGG(ferr.)"):
        strength = 150.0 if material.tensile_strength is None else 1e-6 * material.tensile_strength
        weak = kind == "GG" and strength < 300.0
        return (0.3124, "sigma_B 150") if weak else (0.3095, "sigma_B 300")
    strengths, layers = _ST if kind.startswith("St") else _V
    strength = _strength(material)
    ends = strengths[0], strengths[-1]
    check_range("strength", strength, *ends, f"rho' of {PART_3}, in N/mm2", limited=True)
    limited = min(max(strength, ends[0]), ends[1])
    branch = f"strength {strength:.4g} N/mm2"
    if limited != strength:
        branch += f" limited to {limited:g}"
    return float(np.interp(limited, strengths, layers)), branch


def _static_notch_factor(material: GearMaterial, y_s: float) -> float:
    """Y_drelT for static stress."""
    kind = material.kind
    if kind.startswith("St"):
        k = math.sqrt(math.sqrt(200.0 / _strength(material)))
        return (1.0 + 0.93 * (y_s - 1.0) * k) / (1.0 + 0.93 * k)
    if kind in ("Eh", "IF"):
        return 0.44 * y_s + 0.12
    if kind.startswith("N"):
        return 0.20 * y_s + 0.60
    if kind in ("GG", "GGG(ferr.)"):
        return 1.0
    k = math.sqrt(math.sqrt(300.0 / _strength(material)))
    return (1.0 + 0.82 * (y_s - 1.0) * k) / (1.0 + 0.82 * k)


def _roughness_factor(material: GearMaterial, roughness: float) -> tuple[float, str]:
    """Y_RrelT for endurance, and its rule."""
    kind = material.kind
    if kind.startswith("St"):
        group = "St"
    else:
        group = "soft" if kind.startswith("N") or kind in ("GG", "GGG(ferr.)") else "steel"
    smooth, a, b, c = _ROUGHNESS[group]
    rz = 1e6 * roughness
    if rz < 1.0:
        return smooth, "Rz below 1 um"
    check_range("Rz", rz, 0.0, 40.0, f"Y_RrelT of {PART_3}, in um", limited=True)
    limited = min(rz, 40.0)
    branch = "" if limited == rz else f"Rz {rz:g} um limited to 40 um"
    return a - b * (limited + 1.0) ** c, branch


def _size_factor(material: GearMaterial, module: float) -> float:
    """Y_X for endurance."""
    a, b, least = _SIZE[material.running_in_group]
    millimetres = 1e3 * module
    return 1.0 if millimetres <= 5.0 else max(a - b * millimetres, least)


def mean_stress_ratio(material: GearMaterial, y_s: float) -> float:
    """M of reversed bending."""
    if material.peened and material.kind == "Eh":
        return 0.4
    kind = material.kind
    if kind == "Eh":
        return 0.8 - 0.15 * y_s
    ductile = kind.startswith(("V", "St")) and "cast" not in kind
    return 0.3 if ductile or kind.startswith("N") else 0.4


def reversed_load_factor(stress_ratio: float, mean_ratio: float) -> float:
    """Y_M of a stress ratio R; the 0.7 that is often used is a rounded case."""
    return 1.0 / (1.0 - stress_ratio * (1.0 - mean_ratio) / (1.0 + mean_ratio))


def record_bending(mesh: MeshLoad, index: int, factors: Factors, cycles: float | None) -> float:
    """S_F of a gear (0 pinion, 1 wheel) at a number of load cycles."""
    rated, record = mesh.rated[index], factors.record
    material, y_s = rated.material, factors["Y_S"]
    curve = bending_curve(material, mesh.conditions.long_life_factor)
    count = reference_cycles(curve) if cycles is None else cycles
    branch = "no life stated: endurance" if cycles is None else f"N = {count:.6g}"
    limit = record("sigma_Flim", material.sigma_Flim, "ISO 6336-5:2016", unit="Pa")
    strength = limit * record("Y_ST", 2.0, f"{PART_3}, of the reference test gears")
    strength *= record("Y_NT", life_factor(curve, count), f"{PART_3}, life factor", branch=branch)
    if "Y_drelT" in factors.replacements:
        strength *= record("Y_drelT", 1.0, f"{PART_3}, notch sensitivity")
    else:
        layer, rule = slip_layer(material)
        gradient = layer * (1.0 + 2.0 * factors["q_s"]) / 5.0
        endurance = (1.0 + math.sqrt(gradient)) / (1.0 + math.sqrt(1.2 * layer))
        static = _static_notch_factor(material, y_s)
        value = between_static_and_endurance(static, endurance, curve, count)
        strength *= record("Y_drelT", value, f"{PART_3}, notch sensitivity", branch=rule)
    endurance, rule = _roughness_factor(material, rated.root_roughness)
    value = between_static_and_endurance(1.0, endurance, curve, count)
    strength *= record("Y_RrelT", value, f"{PART_3}, root roughness", branch=rule)
    endurance = _size_factor(material, mesh.gears[index].normal_module)
    value = between_static_and_endurance(1.0, endurance, curve, count)
    strength *= record("Y_X", value, f"{PART_3}, size factor")
    mean_ratio = mean_stress_ratio(material, y_s)
    reversal = reversed_load_factor(min(rated.stress_ratio, 0.0), mean_ratio)
    branch = f"R = {rated.stress_ratio:g}, M = {mean_ratio:.4g}" if reversal != 1.0 else "R >= 0"
    strength *= record("Y_M", reversal, f"{PRACTICE}, mean stress", branch=branch)
    strength = record("sigma_FG", strength, f"{PART_3}, root stress limit", unit="Pa")
    return record("S_F", strength / factors["sigma_F"], f"{PART_3}, safety against fracture")
