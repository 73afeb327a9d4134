"""How the central film of a converged steady contact follows the load: the exact tangent."""

from __future__ import annotations

from typing import Any

import numba as nb
import numpy as np

from tribodyn.ehl.kernel.coarse import no_coarse
from tribodyn.ehl.kernel.film_sum import film_sum
from tribodyn.ehl.kernel.krylov import linear_solve, prepare
from tribodyn.ehl.kernel.oil import oil_state
from tribodyn.ehl.kernel.options import BURIED
from tribodyn.ehl.kernel.reynolds import coefficients, mobility
from tribodyn.ehl.kernel.transfer import central
from tribodyn.types import Array

#: Tolerance of the linear solver: far below the discretisation error of the film.
_TOLERANCE = 1e-8


@nb.njit(**BURIED)
def film_tangent(
    n: int, start: float, dx: float, lam: float, oil: Array, k: int, tail: float, load: float,
    K: Array, plan: Array, work: Any, P: Array, H: Array,
) -> tuple[float, int]:  # fmt: skip
    """Slope ``dH_c/d ln(w)`` of the central film over the load, the bodies and the oil held."""
    lneta, dlneta, rho, drho = np.empty((4, n + 1))
    eps, rhs, x = np.empty(n + 1), np.empty(n + 2), np.empty(n + 2)
    cH, cP = np.empty((n + 1, 4)), np.empty((n + 1, 4))
    oil_state(n, P, oil, lneta, dlneta, rho, drho)
    mobility(n, H, lam, lneta, rho, eps)
    coefficients(n, dx, lam, 1.0, 0.0, P, H, dlneta, rho, drho, eps, cH, cP)
    if not prepare(n, dx, k, True, K, cH, cP, work):
        return 0.0, -1
    for i in range(k + 1):
        rhs[i] = 0.0
    # The pressure of the first node is given: its column of the tangent goes to the right.
    for i in range(1, k + 1):
        for s in range(4):
            if i - 2 + s >= 0:
                rhs[i - 1] -= cH[i, s] * K[i - 2 + s] * tail
    rhs[0] -= cP[1, 1] * tail
    rhs[1] -= cP[2, 0] * tail
    rhs[k] = load - 0.5 * dx * tail
    products = linear_solve(n, dx, k, True, K, plan, cH, cP, _TOLERANCE, no_coarse(), work, rhs, x)
    change, film = np.zeros(n + 1), np.empty(n + 1)
    change[0] = tail
    for i in range(k):
        change[i + 1] = x[i]
    film_sum(n, K, plan, change, work[5], film)
    for i in range(n + 1):
        film[i] += x[k]
    return central(n, start, dx, film), products
