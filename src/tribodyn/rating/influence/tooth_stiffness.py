"""Stiffness of the teeth for the influence factors: ISO 6336-1, method B.

``c_gamma,alpha = c' (0.75 eps_alpha + 0.25)``, ``c_gamma,beta = 0.85 c_gamma,alpha``; c' of
:func:`tribodyn.stiffness.iso6336_single_stiffness` with ``E = 2 E_1 E_2/(E_1 + E_2)`` and the load
``F_t K_A K_gamma/b``. Valid for eps_alpha of at least 1.2.
"""

from __future__ import annotations

import math

from tribodyn.gear import Material
from tribodyn.rating.factor import check_range
from tribodyn.rating.mesh_load import PART_1, MeshLoad
from tribodyn.stiffness import iso6336_mesh_stiffness, iso6336_single_stiffness


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
