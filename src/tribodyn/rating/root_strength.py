"""Strength of the tooth root: notch sensitivity, roughness, size and reversed load, ISO 6336-3.

``Y_drelT = (1 + sqrt(rho' (1 + 2 q_s)/5))/(1 + sqrt(1.2 rho'))`` with the slip layer rho' in mm;
``Y_RrelT`` by the Rz of the root; ``Y_X`` by the module; for a reversed load
``Y_M = 1/(1 - R (1 - M)/(1 + M))`` with the stress ratio R and the mean stress ratio M.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from tribodyn.errors import Argument, InputError
from tribodyn.rating.bending import PART_3
from tribodyn.rating.factor import Factors, check_range
from tribodyn.rating.life import (
    bending_curve,
    between_static_and_endurance,
    life_factor,
    reference_cycles,
)
from tribodyn.rating.materials import GearMaterial
from tribodyn.rating.mesh_load import PRACTICE, MeshLoad

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
