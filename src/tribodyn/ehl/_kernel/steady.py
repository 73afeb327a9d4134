"""The steady contact from Python: nested iteration, and the tangent of its film."""

from __future__ import annotations

from pathlib import Path
from typing import Any, NamedTuple

import numba as nb
import numpy as np

from tribodyn.compiled import source_digest
from tribodyn.compiled.cache import cached_njit
from tribodyn.ehl._kernel.elementary import INNER, JIT, SOURCES
from tribodyn.ehl._kernel.film_sum import influence, make_grid
from tribodyn.ehl._kernel.grid_transfer import central, refine
from tribodyn.ehl._kernel.inlet import cold_start, free_nodes
from tribodyn.ehl._kernel.linear_solver import (
    System,
    coarse_tangent,
    film_change,
    linear_solve,
    linear_work,
    no_coarse,
    prepare,
)
from tribodyn.ehl._kernel.newton import (
    CONVERGED,
    Equation,
    Limits,
    Solved,
    newton_level,
    newton_work,
)
from tribodyn.ehl._kernel.reynolds import fill_oil, fill_tangent, make_fields
from tribodyn.types import Array, Index

_DIGEST = source_digest(Path(__file__).parent, (*SOURCES, "steady"))

#: Intervals from which on the linear solver has a coarse grid, and about how many that has.
_TWO_GRIDS, _COARSE = 2048, 128
#: Flux tolerance of the grids that only lead to the next one.
_PASSING_FLUX = 1e-2


@nb.njit(**INNER)
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


class SteadyContact(NamedTuple):
    """A steady contact in the scales of the dry one."""

    start: float  #: first position, in half widths
    end: float  #: last position
    lam: float  #: factor of the viscous flux
    oil: Array
    film: float  #: estimate of the central film, for the start
    load: float
    tail: float  #: pressure at the first position
    profile: Array  #: heights at the nodes of the finest grid that are added to the gap


@cached_njit(_DIGEST, "the film solver", "half a minute", **JIT)
def newton_solve(
    n: int, first: int, warm: bool, contact: SteadyContact, limits: Limits,
    film_tolerance: float, offset: float, free: int, P: Array, H: Array, films: Array,
    flag: Index,
) -> tuple[Solved, int, int, int]:  # fmt: skip
    """Solve on all grids from ``first`` to ``n`` intervals; state, last grid, first, count."""
    start, lam, oil = contact.start, contact.lam, contact.oil
    load, tail = contact.load, contact.tail
    # Typed, or each literal would make the compiler compile the callees again.
    m: Any = nb.int64(first)
    level: Any = nb.int64(0)
    free = nb.int64(free)
    before, film_before, once = np.empty(0), np.empty(0), np.empty(0)
    coarse = no_coarse()
    flux = max(limits.flux, _PASSING_FLUX)
    passing = Limits(limits.pressure, flux, limits.steps, limits.linear, limits.change)
    while True:
        grid, work = make_grid(m, (contact.end - start) / m), newton_work(m, flag)
        shape = _gap(m, start, grid.dx, n // m, contact.profile)
        equation = Equation(lam, oil, 1.0, 0.0, np.zeros(m + 1), shape, tail, True, load)
        p, h = P[: m + 1], H[: m + 1]
        if level > 0:
            wide = 2.0 * grid.dx
            if m >= _TWO_GRIDS and coarse.factors.size == 0:
                ratio: Any = nb.int64(1)
                while m // (4 * ratio) >= _COARSE and m % (4 * ratio) == 0:
                    ratio *= 2
                coarse = coarse_tangent(
                    m // 2, wide, free, ratio, lam, 1.0, 0.0, True, oil, before, film_before
                )
            free = refine(m // 2, wide, before, free, load, tail, p)
        elif not warm:
            offset = cold_start(grid, start, equation, contact.film, work, p, h)
            free = free_nodes(m, p)
        last = limits if m >= n or film_tolerance > 0.0 else passing
        solved = newton_level(grid, equation, last, offset, free, p, h, once, coarse, work)
        if solved.status != CONVERGED:
            if level > 0 or warm or m >= n:
                return solved, m, first, level + 1
            first = m = 2 * m
            continue
        films[level] = central(m, start, grid.dx, h)
        error = abs(films[level] - films[level - 1]) / 3.0 if level > 0 else np.inf
        if m >= n or error < film_tolerance * films[level]:
            return solved, m, first, level + 1
        before, film_before = p.copy(), h.copy()
        offset, free = solved.offset, solved.free
        m *= 2
        level += 1


#: Tolerance of the linear solver: far below the discretisation error of the film.
_TOLERANCE = 1e-8


@cached_njit(_DIGEST, "the tangent of a film", "ten seconds", **JIT)
def tangent_of_film(
    n: int, start: float, dx: float, lam: float, oil: Array, k: int, tail: float,
    load: float, P: Array, H: Array,
) -> tuple[float, float, int]:  # fmt: skip
    """Slopes over ``ln(w)`` of the central film and of the offset, bodies and oil held."""
    grid, f, work = make_grid(n, dx), make_fields(n), linear_work(n)
    K, cH, cP = grid.influence, work.by_film, work.by_pressure
    rhs, x = np.zeros(n + 2), np.empty(n + 2)
    # Typed: a literal would make the compiler compile the callees again.
    imposed = n > 0
    fill_oil(n, lam, oil, P, H, f)
    fill_tangent(n, dx, 1.0, 0.0, P, H, f, cH, cP)
    if not prepare(grid, k, imposed, work):
        return 0.0, 0.0, -1
    # The pressure of the first node is given: its column of the tangent goes to the right.
    for i in range(1, k + 1):
        for s in range(4):
            if i - 2 + s >= 0:
                rhs[i - 1] -= cH[i, s] * K[i - 2 + s] * tail
    rhs[0] -= cP[1, 1] * tail
    rhs[1] -= cP[2, 0] * tail
    rhs[k] = load - 0.5 * dx * tail
    products = linear_solve(System(grid, k, imposed, no_coarse(), work), _TOLERANCE, rhs, x)
    film_change(grid, k, tail, x, work)
    for i in range(n + 1):
        work.film[i] += x[k]
    return central(n, start, dx, work.film), x[k], products


@cached_njit(_DIGEST, "small vibrations of a film", "three seconds", **JIT)
def linear_parts(
    n: int, start: float, dx: float, lam: float, oil: Array, k: int, P: Array, H: Array
) -> tuple[Array, ...]:
    """What the equations of small vibrations are made of, dense.

    Coefficients of the flow balance by film and by pressure, density and its slope, film at
    every node by the pressures at 0..k and by the offset, and the central one of each.
    """
    f, (cH, cP) = make_fields(n), np.empty((2, n + 1, 4))
    fill_oil(n, lam, oil, P, H, f)
    fill_tangent(n, dx, 1.0, 0.0, P, H, f, cH, cP)
    pressed = influence(n, dx)
    film, middle = np.ones((k + 2, n + 1)), np.empty(k + 2)
    for j in range(k + 2):
        if j <= k:
            for i in range(n + 1):
                film[j, i] = pressed[abs(i - j)]
        middle[j] = central(n, start, dx, film[j])
    return cH, cP, f.rho[: n + 1], f.drho[: n + 1], film, middle
