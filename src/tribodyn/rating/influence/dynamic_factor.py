"""Dynamic factor K_v: ISO 6336-1, method B, from the reference speed N = n_1/n_E1.

``n_E1 = 30000/(pi z_1) sqrt(c_gamma,alpha/m_red)`` in 1/min, N/(mm um) and kg/mm;
``B_p = c' f_pb,eff/w``, ``B_f = c' f_fa,eff/w``, ``B_k = |1 - c' C_a/w|``, and

| range | K_v |
| --- | --- |
| N <= N_S (subcritical) | 1 + N (C_v1 B_p + C_v2 B_f + C_v3 B_k) |
| N_S < N <= 1.15 (main resonance) | 1 + C_v1 B_p + C_v2 B_f + C_v4 B_k |
| 1.15 < N < 1.5 (intermediate) | straight between both |
| N >= 1.5 (supercritical) | C_v5 B_p + C_v6 B_f + C_v7 |

N_S = 0.85, below 100 N/mm 0.5 + 0.35 sqrt(w/100). The step at N_S is that of the standard.

Stiffness of the teeth: ISO 6336-1, method B.
``c_gamma,alpha = c' (0.75 eps_alpha + 0.25)``, ``c_gamma,beta = 0.85 c_gamma,alpha``; c' of
:func:`tribodyn.stiffness.iso6336_single_stiffness` with ``E = 2 E_1 E_2/(E_1 + E_2)`` and the load
``F_t K_A K_gamma/b``. Valid for eps_alpha of at least 1.2.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from tribodyn.errors import require_between, require_positive, warn
from tribodyn.gear import Material
from tribodyn.rating.factor import check_range
from tribodyn.rating.mesh_load import PART_1, MeshLoad, mean_profile_allowance, nominal_root_radius
from tribodyn.stiffness import iso6336_mesh_stiffness, iso6336_single_stiffness

#: Addition to the rule of the reduced mass in a planetary stage.
_OF_STAGE = ", of a sun for one of its planets, of a held ring infinite (clause 6.5.9, from memory)"


def mesh_stiffness(mesh: MeshLoad) -> tuple[float, float]:
    """C' and c_gamma,alpha [N/m^2]."""
    moduli = [gear.material.youngs_modulus for gear in mesh.rated]
    modulus = 2.0 * moduli[0] * moduli[1] / sum(moduli)
    force = mesh.tangential_force / math.cos(mesh.pair.transverse_pressure_angle)
    single = iso6336_single_stiffness(
        mesh.pair, Material(modulus), force, application_factor=mesh.outer_factors
    )
    contact_ratio = mesh.pair.transverse_contact_ratio
    check_range("eps_alpha", contact_ratio, 1.2, 3.0, f"c_gamma,alpha of {PART_1}")
    light = "below 100 N/mm: (w/100)^0.25" if mesh.line_load < 1e5 else "at least 100 N/mm"
    record = mesh.factors.record
    single = record("c_prime", single, f"{PART_1}, method B", unit="N/m^2", branch=light)
    mean = iso6336_mesh_stiffness(single, contact_ratio)
    mean = record("c_gamma_alpha", mean, f"{PART_1}, c' (0.75 eps_alpha + 0.25)", unit="N/m^2")
    record("c_gamma_beta", 0.85 * mean, f"{PART_1}, 0.85 c_gamma,alpha", unit="N/m^2")
    return single, mean


class DynamicFactor(NamedTuple):
    """Dynamic factor and the range of speed that it belongs to.

    Parameters
    ----------
    value : float
        K_v (dimensionless).
    branch : str
        ``subcritical``, ``main resonance``, ``intermediate`` or ``supercritical``.
    """

    value: float
    branch: str


def _coefficients(contact_ratio: float) -> tuple[float, ...]:
    """C_v1 to C_v7 at a total contact ratio."""
    e = contact_ratio
    within = min(max(e, 1.5), 2.5)  # 0.75 up to 1.5, 1 from 2.5
    c_7 = 0.125 * math.sin(math.pi * (within - 2.0)) + 0.875
    if e <= 2.0:
        return 0.32, 0.34, 0.23, 0.90, 0.47, 0.47, c_7
    c_4 = (0.57 - 0.05 * e) / (e - 1.44)
    return 0.32, 0.57 / (e - 0.3), 0.096 / (e - 1.56), c_4, 0.47, 0.12 / (e - 1.74), c_7


def dynamic_factor(
    reference_speed: float,
    total_contact_ratio: float,
    deviations: tuple[float, float, float],
    limit: float = 0.85,
) -> DynamicFactor:
    """Dynamic factor in all ranges of speed.

    Parameters
    ----------
    reference_speed : float
        N, speed over that of the main resonance; pure number.
    total_contact_ratio : float
        eps_gamma.
    deviations : tuple of float
        B_p, B_f and B_k, pure numbers.
    limit : float
        N_S, end of the subcritical range; pure number.

    Returns
    -------
    DynamicFactor

    Raises
    ------
    InputError
        If a value is out of range.

    Notes
    -----
    Source: ISO 6336-1, K_v by method B.

    Examples
    --------
    >>> dynamic_factor(0.069214, 1.462529, (0.172505, 0.183576, 0.503849)).branch
    'subcritical'
    """
    require_between("reference_speed", reference_speed, 0.0, 1e6)
    require_between("total_contact_ratio", total_contact_ratio, 1.0, 20.0)
    require_positive("limit", limit)
    b_p, b_f, b_k = deviations
    c_1, c_2, c_3, c_4, c_5, c_6, c_7 = _coefficients(total_contact_ratio)
    resonance = 1.0 + c_1 * b_p + c_2 * b_f + c_4 * b_k
    beyond = c_5 * b_p + c_6 * b_f + c_7
    if reference_speed <= limit:
        value = 1.0 + reference_speed * (c_1 * b_p + c_2 * b_f + c_3 * b_k)
        return DynamicFactor(value, "subcritical")
    if reference_speed <= 1.15:
        return DynamicFactor(resonance, "main resonance")
    if reference_speed < 1.5:
        share = (reference_speed - 1.15) / 0.35
        return DynamicFactor(resonance + share * (beyond - resonance), "intermediate")
    return DynamicFactor(beyond, "supercritical")


def reduced_mass(mesh: MeshLoad) -> tuple[float, str]:
    """m_red of both gears per face width [kg/m], and its rule."""
    shares = [rated.inertia_share for rated in mesh.rated]
    alone = shares == [1.0, 1.0]
    inertias = [gear.moment_of_inertia for gear in mesh.gears]
    if None not in inertias:
        inverse = sum(
            gear.face_width * gear.base_radius**2 / (inertia * share)
            for gear, inertia, share in zip(mesh.gears, inertias, shares, strict=True)
            if inertia is not None
        )
        return 1.0 / inverse, "moments of inertia as stated" + _OF_STAGE * (not alone)
    means = [gear.tip_radius + nominal_root_radius(gear) for gear in mesh.gears]
    hollow = [
        abs(1.0 - (2.0 * gear.rim_radius / mean) ** 4)
        for gear, mean in zip(mesh.gears, means, strict=True)
    ]
    inverse = 1.0 / (hollow[0] * mesh.pinion.material.density * shares[0])
    inverse += 1.0 / (hollow[1] * mesh.wheel.material.density * mesh.ratio**2 * shares[1])
    shape = (0.5 * means[0] / mesh.pair.pinion.base_radius) ** 2 * means[0] ** 2
    rule = "solid bodies between bore and mean diameter"
    return math.pi / 8.0 * shape / inverse, rule + _OF_STAGE * (not alone)


def _relief(mesh: MeshLoad) -> tuple[float, str]:
    """C_a [m]: the smaller design relief, else what running-in leaves."""
    designed = min(gear.modification.tip_relief for gear in mesh.gears)
    if designed > 0.0:
        return designed, "design relief"
    run_in = [
        (rated.material.sigma_Hlim * 1e-6 / 97.0 - 18.45) ** 2 / 18.0 + 1.5 for rated in mesh.rated
    ]
    return 1e-6 * sum(run_in) / 2.0, "running-in"


def _deviation_terms(mesh: MeshLoad, stiffness: float) -> tuple[float, float, float]:
    """B_p, B_f and B_k."""
    load, record = mesh.line_load, mesh.factors.record
    pitch = max(deviation.single_pitch for deviation in mesh.deviations)
    pitch *= math.cos(mesh.pair.transverse_pressure_angle)
    form = max(deviation.profile_form for deviation in mesh.deviations)
    origin = "; ".join(dict.fromkeys(gear.grade_text for gear in mesh.rated))
    source = f"{PART_1}, running-in"
    pitch = record("f_pb", pitch, f"{PART_1}, f_pt cos(alpha_t)", unit="m", branch=origin)
    y_p = record("y_alpha", mean_profile_allowance(mesh, pitch), source, unit="m")
    y_f = record("y_f", mean_profile_allowance(mesh, form), source, unit="m")
    relief, design = _relief(mesh)
    relief = record("C_a", relief, f"{PART_1}, tip relief", unit="m", branch=design)
    grades = [gear.grade for gear in mesh.rated if gear.grade is not None]
    coarse = bool(grades) and max(grades) >= 6
    b_k = 1.0 if coarse else abs(1.0 - stiffness * relief / load)
    rule = "1 for grade 6 and coarser" if coarse else "|1 - c' C_a/w|"
    return (
        record("B_p", stiffness * (pitch - y_p) / load, f"{PART_1}, K_v"),
        record("B_f", stiffness * (form - y_f) / load, f"{PART_1}, K_v"),
        record("B_k", b_k, f"{PART_1}, K_v", branch=rule),
    )


def record_dynamic_factor(mesh: MeshLoad) -> float:
    """K_v of a mesh, with all that it is computed from."""
    record, pair = mesh.factors.record, mesh.pair
    single, mean = mesh_stiffness(mesh)
    value, rule = reduced_mass(mesh)
    mass = record("m_red", value, f"{PART_1}, reduced mass", unit="kg/m", branch=rule)
    resonance = math.sqrt(mean / mass) / pair.pinion.teeth
    reference = record("N", mesh.speed / resonance, f"{PART_1}, n_1/n_E1")
    limit = record("N_S", mesh.resonance_ratio_limit, f"{PART_1}, subcritical limit")
    terms = _deviation_terms(mesh, single)
    value, branch = dynamic_factor(reference, pair.total_contact_ratio, terms, limit)
    ratio = abs(mesh.ratio)
    threshold = mesh.pitch_line_speed * pair.pinion.teeth / 100.0
    threshold *= ratio / math.sqrt(1.0 + ratio**2)
    if threshold < 3.0:
        branch += "; slow, method C may serve"
    if branch == "main resonance" and "K_v" not in mesh.factors.replacements:
        warn(
            "rating-resonance",
            f"N = {reference:.4g}: the pinion runs in its main resonance ({limit:.3g} to 1.15), "
            f"where K_v = {value:.4g} of method B is uncertain; compute K_v from the motion",
        )
    return record("K_v", value, f"{PART_1}, method B", branch=branch)
