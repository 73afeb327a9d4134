"""Load factors over the face and over the pairs in contact: ISO 6336-1.

K_Hbeta and K_Fbeta by method C:
``f_sh = F_m/b 0.023 (|B* + K' l s/d_1^2 (d_1/d_sh)^4 - 0.3| + 0.3) (b/d_1)^2`` in um, N/mm and mm;
``f_ma = sqrt(f_Hb1^2 + f_Hb2^2)``; ``F_bx = 1.33 B_1 f_sh + B_2 f_ma``, at least 0.005 F_m/b and
half of f_Hb; ``F_by = F_bx - y_beta``; with ``k = F_by c_gamma,beta/(2 F_m/b)``
``K_Hbeta = 1 + k`` below k = 1, else ``2 sqrt(k)``;
``K_Fbeta = K_Hbeta^N_F``, ``N_F = 1/(1 + h/b + (h/b)^2)`` with b/h of at least 3.

K_Halpha and K_Falpha by method B:
with ``t = c_gamma,alpha (f_pb - y_alpha)/(F_tH/b)``, ``F_tH = F_t K_A K_gamma K_v K_Hbeta``:
``eps_gamma/2 (0.9 + 0.4 t)`` up to eps_gamma = 2, else
``0.9 + 0.4 sqrt(2 (eps_gamma - 1)/eps_gamma) t``; at least 1, at most
``eps_gamma/(eps_alpha Z_eps^2)`` for K_Halpha and ``eps_gamma/(0.25 eps_alpha + 0.75)`` for
K_Falpha.
"""

from __future__ import annotations

import math

from tribodyn.errors import require_between
from tribodyn.rating.conditions import LEADS
from tribodyn.rating.mesh_load import PART_1, MeshLoad, mean_lead_allowance, nominal_root_radius
from tribodyn.rating.rated_gear import SHAFT_FACTORS
from tribodyn.rating.tolerances import gear_tolerances


def face_load_factor(misalignment: float, stiffness: float, line_load: float) -> float:
    """Face load factor of a straight misalignment of the flanks.

    Parameters
    ----------
    misalignment : float [m]
        F_by, difference of the gap over the face width.
    stiffness : float [N/m^2]
        c_gamma,beta, of the mesh per face width.
    line_load : float [N/m]
        F_m/b, mean load per width.

    Returns
    -------
    float
        K_Hbeta, greatest over mean load per width.

    Raises
    ------
    InputError
        If a value is out of range.

    Notes
    -----
    Exact for a linear error on a uniform stiffness: above k = 1 one end of the face is unloaded.
    Source: ISO 6336-1, K_Hbeta by method C.

    Examples
    --------
    >>> face_load_factor(10e-6, 20e9, 500e3), face_load_factor(50e-6, 20e9, 500e3)
    (1.2, 2.0)
    """
    require_between("misalignment", misalignment, 0.0, 1.0, "m")
    k = misalignment * stiffness / (2.0 * line_load)
    return 1.0 + k if k < 1.0 else 2.0 * math.sqrt(k)


def _deflection(mesh: MeshLoad, line_load: float) -> tuple[float, str]:
    """f_sh [m] and the rule that gave it."""
    conditions, diameter = mesh.conditions, mesh.reference_diameter
    if conditions.shaft_deflection is not None:
        return conditions.shaft_deflection, "stated"
    share = 1.0 + 2.0 * (1.0 - conditions.power_share) / conditions.power_share
    bending, rule = 0.0, "pinion in the middle between the bearings"
    if (shaft := conditions.shaft) is not None:
        stiffened = diameter / shaft.diameter >= 1.15
        factor = SHAFT_FACTORS[shaft.arrangement][0 if stiffened else 1]
        bending = factor * shaft.bearing_span * shaft.offset / diameter**2
        bending *= (diameter / shaft.diameter) ** 4
        rule = f"arrangement {shaft.arrangement}, {'with' if stiffened else 'without'} stiffening"
    bracket = abs(share + bending - 0.3) + 0.3
    slenderness = (mesh.face_width / diameter) ** 2
    return 1e-9 * line_load * 0.023 * bracket * slenderness, rule


def _lead(mesh: MeshLoad) -> tuple[str, str]:
    """Design of the lead, and where it is from."""
    if mesh.conditions.lead is not None:
        return mesh.conditions.lead, "stated"
    modifications = [gear.modification for gear in mesh.gears]
    if any(each.end_relief > 0.0 for each in modifications):
        return "end relief", "from the flanks"
    if any(each.crowning > 0.0 for each in modifications):
        return "crowning", "from the flanks"
    return "none", "from the flanks"


def _initial_misalignment(mesh: MeshLoad, line_load: float) -> float:
    """F_bx [m]."""
    record = mesh.factors.record
    f_sh, rule = _deflection(mesh, line_load)
    f_sh = record("f_sh", f_sh, f"{PART_1}, method C", unit="m", branch=rule)
    slopes = [deviation.helix_slope for deviation in mesh.deviations]
    f_ma = record("f_ma", math.hypot(*slopes), f"{PART_1}, sqrt(f_Hb1^2 + f_Hb2^2)", unit="m")
    lead, origin = _lead(mesh)
    b_1, b_2 = LEADS[lead]
    least = max(0.005e-9 * line_load, 0.5 * max(slopes))
    if mesh.conditions.contact_pattern_proven:
        fine = max(gear_tolerances(gear, 5).helix_slope for gear in mesh.gears)
        sought, branch = abs(1.33 * b_1 * f_sh - fine), "favourable contact pattern proven"
    else:
        sought, branch = 1.33 * b_1 * f_sh + b_2 * f_ma, "contact pattern not proven"
    if sought < least:
        sought, branch = least, "least value"
    branch += f"; lead {lead} {origin}"
    return record("F_betax", sought, f"{PART_1}, method C", unit="m", branch=branch)


def record_face_load_factors(mesh: MeshLoad) -> float:
    """K_Hbeta and K_Fbeta of a mesh; returns the former."""
    record = mesh.factors.record
    line_load = mesh.line_load * mesh.factors["K_v"]
    f_bx = _initial_misalignment(mesh, line_load)
    y_beta = record("y_beta", mean_lead_allowance(mesh, f_bx), f"{PART_1}, running-in", unit="m")
    f_by = record("F_betay", f_bx - y_beta, f"{PART_1}, F_betax - y_beta", unit="m")
    value = face_load_factor(f_by, mesh.factors["c_gamma_beta"], line_load)
    branch = "1 + k" if value < 2.0 else "2 sqrt(k), one end unloaded"
    value = record("K_Hbeta", value, f"{PART_1}, method C", branch=branch)
    slender = min(
        gear.face_width / abs(gear.tip_radius - nominal_root_radius(gear)) for gear in mesh.gears
    )
    limited = max(slender, 3.0)
    exponent = 1.0 / (1.0 + 1.0 / limited + 1.0 / limited**2)
    branch = "b/h raised to 3" if slender < 3.0 else ""
    record("N_F", exponent, f"{PART_1}, exponent of K_Fbeta", branch=branch)
    record("K_Fbeta", value**exponent, f"{PART_1}, K_Hbeta^N_F")
    return value


def contact_ratio_factor(transverse: float, overlap: float) -> float:
    """Z_eps of ISO 6336-2: ``sqrt((4 - eps_alpha)/3 (1 - eps_beta) + eps_beta/eps_alpha)``."""
    limited = min(overlap, 1.0)
    return math.sqrt((4.0 - transverse) / 3.0 * (1.0 - limited) + limited / transverse)


def record_transverse_load_factors(mesh: MeshLoad) -> None:
    """K_Halpha and K_Falpha of a mesh."""
    factors, pair = mesh.factors, mesh.pair
    transverse, total = pair.transverse_contact_ratio, pair.total_contact_ratio
    load = mesh.line_load * factors["K_v"] * factors["K_Hbeta"]
    t = factors["c_gamma_alpha"] * (factors["f_pb"] - factors["y_alpha"]) / load
    if total <= 2.0:
        value, branch = 0.5 * total * (0.9 + 0.4 * t), "eps_gamma <= 2"
    else:
        value = 0.9 + 0.4 * math.sqrt(2.0 * (total - 1.0) / total) * t
        branch = "eps_gamma > 2"
    z_eps = contact_ratio_factor(transverse, pair.overlap_ratio)
    highest = {
        "K_Halpha": total / (transverse * z_eps**2),
        "K_Falpha": total / (0.25 * transverse + 0.75),
    }
    for name, most in highest.items():
        limited = max(1.0, min(value, most))
        rule = branch
        if limited != value:
            rule += f"; {value:.6g} limited to {limited:.6g}"
        factors.record(name, limited, f"{PART_1}, method B", branch=rule)
