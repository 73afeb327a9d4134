"""Transverse load factors K_Halpha and K_Falpha: ISO 6336-1, method B.

With ``t = c_gamma,alpha (f_pb - y_alpha)/(F_tH/b)``, ``F_tH = F_t K_A K_gamma K_v K_Hbeta``:
``eps_gamma/2 (0.9 + 0.4 t)`` up to eps_gamma = 2, else
``0.9 + 0.4 sqrt(2 (eps_gamma - 1)/eps_gamma) t``; at least 1, at most
``eps_gamma/(eps_alpha Z_eps^2)`` for K_Halpha and ``eps_gamma/(0.25 eps_alpha + 0.75)`` for
K_Falpha.
"""

from __future__ import annotations

import math

from tribodyn.rating.mesh_load import PART_1, MeshLoad


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
