"""The steady contact from Python: nested iteration, and the tangent of its film."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numba as nb
import numpy as np

from tribodyn.compiled import source_digest
from tribodyn.ehl._kernel.elementary import BURIED, JIT
from tribodyn.ehl._kernel.film_sum import film_plan, film_sum, influence
from tribodyn.ehl._kernel.inlet import cold_start, free_nodes
from tribodyn.ehl._kernel.linear_solver import (
    coarse_tangent,
    linear_solve,
    newton_work,
    no_coarse,
    prepare,
)
from tribodyn.ehl._kernel.newton import CONVERGED, newton_level
from tribodyn.ehl._kernel.reynolds import coefficients, mobility, oil_state
from tribodyn.ehl._kernel.transfer import central, refine
from tribodyn.types import Array

#: Every file whose code ends up in the compiled kernel.
_SOURCES = (
    "elementary", "reynolds", "film_sum", "factors", "linear_solver", "transfer", "inlet",
    "newton", "steady",
)  # fmt: skip

#: Intervals from which on the linear solver has a coarse grid, and about how many that has.
_TWO_GRIDS, _COARSE = 2048, 128
#: Flux tolerance of the grids that only lead to the next one.
_PASSING_FLUX = 1e-2


@nb.njit(**BURIED)
def _gap(n: int, start: float, dx: float, factor: int, profile: Array) -> Array:
    """Undeformed gap on a grid ``factor`` times as wide: the profile by its local mean."""
    shape = np.empty(n + 1)
    for i in range(n + 1):
        x = start + i * dx
        total, weight, at = 0.0, 0.0, i * factor
        for j in range(max(0, at - factor + 1), min(n * factor, at + factor - 1) + 1):
            share = 1.0 - abs(j - at) / factor
            total += share * profile[j]
            weight += share
        shape[i] = 0.5 * x * x + total / weight
    return shape


def _build(digest: str) -> Any:
    @nb.njit(cache=True, **JIT)
    def newton_solve(
        n: int,
        first: int,
        warm: bool,
        start: float,
        end: float,
        lam: float,
        oil: Array,
        film: float,
        load: float,
        tail: float,
        profile: Array,
        limits: Array,
        film_tolerance: float,
        P: Array,
        H: Array,
        state: Array,
        films: Array,
    ) -> int:
        """Solve a steady contact on all grids from ``first`` to ``n`` intervals."""
        digest  # noqa: B018  # a closure variable, hence part of the key of the disk cache
        # Typed, or each literal would make the compiler translate the callees anew.
        m: Any = np.int64(first)
        level: Any = np.int64(0)
        last: Any = np.int64(0)
        before, film_before, coarse = np.empty(0), np.empty(0), no_coarse()
        while True:
            dx = (end - start) / m
            K = influence(m, dx)
            plan = film_plan(m, K)
            work = newton_work(m)
            shape, history = _gap(m, start, dx, n // m, profile), np.zeros(m + 1)
            p, h, final = P[: m + 1], H[: m + 1], limits.copy()
            if level > 0:
                if m >= _TWO_GRIDS and coarse[0].size == 0:
                    ratio: Any = np.int64(1)
                    while m // (4 * ratio) >= _COARSE and m % (4 * ratio) == 0:
                        ratio *= 2
                    coarse = coarse_tangent(
                        m // 2, 2.0 * dx, last, ratio, lam, 1.0, 0.0, True, oil, before,
                        film_before,
                    )  # fmt: skip
                state[1] = refine(m // 2, 2.0 * dx, before, last, load, tail, p)
            elif not warm:
                state[0] = cold_start(
                    m, start, dx, lam, oil, film, load, tail, shape, K, plan, work, p, h
                )
                state[1] = free_nodes(m, p)
            if m < n and film_tolerance == 0.0:
                final[1] = max(final[1], _PASSING_FLUX)
            status = newton_level(
                m, dx, lam, 1.0, 0.0, load, True, tail, oil, shape, history, K, plan, final,
                coarse, work, p, h, state,
            )  # fmt: skip
            state[8], state[9], state[10] = m, first, level + 1
            if status != CONVERGED:
                if level > 0 or warm or m >= n:
                    return status
                first = m = 2 * m
                continue
            films[level] = central(m, start, dx, h)
            error = abs(films[level] - films[level - 1]) / 3.0 if level > 0 else np.inf
            if m >= n or error < film_tolerance * films[level]:
                return status
            before, film_before, last = p.copy(), h.copy(), int(state[1])
            m *= 2
            level += 1

    return newton_solve


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


def _build_tangent(digest: str) -> Any:
    @nb.njit(cache=True, **JIT)
    def tangent_of_film(
        n: int, start: float, dx: float, lam: float, oil: Array, k: int, tail: float,
        load: float, P: Array, H: Array,
    ) -> tuple[float, int]:  # fmt: skip
        """Slope of the film, see :func:`film_tangent`."""
        digest  # noqa: B018  # a closure variable, hence part of the key of the disk cache
        K = influence(n, dx)
        return film_tangent(
            n, start, dx, lam, oil, k, tail, load, K, film_plan(n, K), newton_work(n), P, H
        )

    return tangent_of_film


_DIGEST = source_digest(Path(__file__).parent, _SOURCES)
newton_solve = _build(_DIGEST)
tangent_of_film = _build_tangent(_DIGEST)
