"""Full multigrid for the steady line contact: full approximation scheme, as one compiled call.

Nested iteration from a coarse solution upwards; on every grid V cycles with one distributive line
sweep before and one after the coarser grids. Film sums are Fourier transforms, not multilevel
integration. The rigid offset of the film is changed on the coarsest grid alone.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numba as nb
import numpy as np

from tribodyn.compiled import source_digest
from tribodyn.ehl._kernel.elementary import INNER, JIT
from tribodyn.ehl._kernel.film_sum import film_plan, film_sum, film_work_size, influence
from tribodyn.ehl._kernel.multigrid_levels import (
    BALANCE,
    DLNETA,
    DRHO,
    EPS,
    FLUX,
    LEFT,
    RHO,
    RIGHT,
    add_correction,
    balance,
    coarsest_work,
    evaluate,
    inject,
    mean_gap,
    near_influence,
    relax,
    restrict_defect,
    solve_coarsest,
)
from tribodyn.ehl._kernel.newton import CONVERGED, NOT_FINITE, ROUNDED, STALLED
from tribodyn.ehl._kernel.reynolds import coefficients
from tribodyn.ehl._kernel.transfer import central, cut_negative, extend, refine
from tribodyn.types import Array, Index

#: Every file whose code ends up in the compiled kernel.
_SOURCES = (
    "elementary", "reynolds", "film_sum", "factors", "linear_solver", "transfer", "newton",
    "multigrid_levels", "multigrid",
)  # fmt: skip

#: Columns of the record of cycles: intervals, change of pressure, flux error, load error, least
#: residual of the cavity per length, last free node.
RECORD = 6

# Rows of the field over all grids.
_P, _H, _INJECTED, _TARGET, _EXCESS, _SHAPE, _K = 0, 1, 2, 3, 4, 5, 6
# Further rows of the scratch array.
_DIPOLE, _DELTA, _BEFORE = 8, 9, 10

#: A node is a dipole where its mobility is below this part of the squared length of the grid.
_STIFF = 1e-3
#: Share of a correction that is taken, and greatest change of a pressure in a sweep.
_DAMPING, _CAP = 0.8, 0.2
#: Flux tolerance and cycles of the grids that only lead to the next one.
_PASSING_FLUX, _PASSING_CYCLES = 1e-2, 3
#: Least residual of the cavity per length that still counts as none.
_CAVITY = -1e-9
#: Cycles without a smaller change after which the iteration has stalled.
_PATIENCE = 12
#: A change of the pressure that rounding alone makes.
_ROUNDING = 1e-13


@nb.njit(**INNER)
def _make_grids(n: int, count: int, start: float, end: float, profile: Array) -> Any:
    """All grids, the finest first: where they begin in the arrays, field, plans, influences."""
    offset, begin = np.zeros(count + 1, np.int64), np.zeros(count + 1, np.int64)
    for g in range(count):
        m = n >> g
        offset[g + 1] = offset[g] + m + 1
        # The size of a plan, from the room of its film sums: see film_sum.py.
        half = film_work_size(m) // 4
        begin[g + 1] = begin[g] + (6 * half + 2 if half > 0 else 0)
    field = np.zeros((7, offset[count]))
    plans = np.empty(begin[count])
    near = np.empty((count, 2, 4, LEFT + RIGHT + 1))
    for g in range(count):
        m = n >> g
        dx = (end - start) / m
        K = influence(m, dx)
        plan = film_plan(m, K)
        for i in range(m + 1):
            field[_K, offset[g] + i] = K[i]
        for i in range(plan.size):
            plans[begin[g] + i] = plan[i]
        near_influence(dx, near[g])
        heights = field[_SHAPE, offset[g] : offset[g + 1]]
        if g == 0:
            for i in range(n + 1):
                heights[i] = profile[i]
        else:
            mean_gap(m, field[_SHAPE, offset[g - 1] : offset[g]], heights)
    for g in range(count):
        for i in range((n >> g) + 1):
            x = start + i * ((end - start) / (n >> g))
            field[_SHAPE, offset[g] + i] += 0.5 * x * x
    return offset, begin, field, plans, near


@nb.njit(**INNER)
def _move_outlet(n: int, free: int, streak: int, P: Array, G: Array) -> tuple[int, int]:
    """Cut pressure that is negative, or let the film part later where mass is missing."""
    k = cut_negative(n, free, 0.0, P)
    for i in range(1, k + 1):
        P[i] = max(P[i], 0.0)
    if k < free:
        return k, 0
    if k + 1 < n and G[k + 1] < 0.0:
        return extend(n, k, streak), streak + 1
    return k, 0


@nb.njit(**INNER)
def _descend(
    g: int, m: int, k: int, dx: float, lam: float, oil: Array, grids: Any, rows: Array,
    room: Array, free: Index, numbers: Array,
) -> None:  # fmt: skip
    """Pose the problem of the next coarser grid: there the state of this one is injected."""
    offset, begin, field, plans = grids[0], grids[1], grids[2], grids[3]
    a, b, c = offset[g], offset[g + 1], offset[g + 2]
    P, H, right = field[_P, a:b], field[_H, a:b], field[_TARGET, a:b]
    p, h, target, excess = field[_P, b:c], field[_H, b:c], field[_TARGET, b:c], field[_EXCESS, b:c]
    half, wide, G = m // 2, 2.0 * dx, rows[BALANCE]
    free[g + 1] = k // 2
    inject(half, P, p)
    inject(half, P, field[_INJECTED, b:c])
    carried = 0.5 * (wide - dx) * P[0]
    for i in range(1, m):
        carried -= dx * P[i]
    for i in range(1, half):
        carried += wide * p[i]
    numbers[2 + g + 1] = numbers[2 + g] + carried
    film_sum(half, field[_K, b:c], plans[begin[g + 1] : begin[g + 2]], p, room, h)
    for i in range(half + 1):
        excess[i] = H[2 * i] - (h[i] + numbers[0] + field[_SHAPE, b + i])
        h[i] = H[2 * i]
    restrict_defect(half, k, right, G, target)
    balance(half, wide, lam, oil, rows, p, h)
    for i in range(1, half):
        target[i] += G[i]


@nb.njit(**INNER)
def _cycle(
    top: int, n: int, start: float, end: float, lam: float, oil: Array, load: float, grids: Any,
    rows: Array, room: Array, cH: Array, cP: Array, band: Array, work: Any, free: Index,
    numbers: Array,
) -> int:  # fmt: skip
    """One V cycle on and below the grid ``top``, whose film and residual are known."""
    offset, begin, field, plans, near = grids
    last, least = offset.size - 2, _STIFF * (end - start) ** 2
    numbers[2 + top] = load
    for step in range(2 * (last - top) + 1):
        upwards = step > last - top
        g = 2 * last - top - step if upwards else top + step
        m = n >> g
        dx = (end - start) / m
        a, b, k = offset[g], offset[g + 1], free[g]
        P, H, K, right = field[_P, a:b], field[_H, a:b], field[_K, a:b], field[_TARGET, a:b]
        shape, excess, plan = (
            field[_SHAPE, a:b],
            field[_EXCESS, a:b],
            plans[begin[g] : begin[g + 1]],
        )
        if g == last:
            status = solve_coarsest(
                m, k, dx, lam, oil, numbers[2 + g], shape, excess, right, K, plan, rows, room, cH,
                cP, work, P, H, numbers,
            )  # fmt: skip
            if status != CONVERGED:
                return status
            continue
        if upwards:
            c = offset[g + 2]
            add_correction(m // 2, k, field[_P, b:c], field[_INJECTED, b:c], P)
            if g == top:
                for i in range(1, k + 1):
                    P[i] = max(P[i], 0.0)
        # After the sweep again: for the coarser grid or, on the finest, for the next cycle.
        for swept in range(2):
            if swept == 1 or upwards:
                evaluate(m, dx, lam, oil, numbers[0], shape, excess, K, plan, rows, room, P, H)
            if swept == 1:
                break
            coefficients(
                m, dx, lam, 1.0, 0.0, P, H, rows[DLNETA], rows[RHO], rows[DRHO], rows[EPS], cH, cP
            )
            relax(
                k, least, _DAMPING, _CAP, near[g], cH, cP, rows[EPS], rows[BALANCE], right,
                rows[_DIPOLE], rows[_DELTA], band, P,
            )  # fmt: skip
            if g == top:
                k, streak = _move_outlet(m, k, int(numbers[1]), P, rows[BALANCE])
                free[g], numbers[1] = k, streak
            elif upwards:
                break
        if not upwards:
            _descend(g, m, k, dx, lam, oil, grids, rows, room, free, numbers)
    return CONVERGED


@nb.njit(**INNER)
def _check(n: int, dx: float, k: int, load: float, rows: Array, P: Array, line: Array) -> None:
    """Fill a line of the record: change, flux, load, cavity, outlet."""
    F, G, before = rows[FLUX], rows[BALANCE], rows[_BEFORE]
    change, total, mean, flux, cavity = 0.0, 0.0, 0.0, 0.0, 0.0
    for i in range(n + 1):
        change += abs(P[i] - before[i])
        total += P[i]
    for i in range(k + 1):
        mean += F[i] / (k + 1)
    for i in range(k + 1):
        flux = max(flux, abs(F[i] / mean - 1.0))
    for i in range(k + 1, n):
        cavity = min(cavity, G[i])
    line[0], line[1], line[2], line[4], line[5] = n, change / total, flux, cavity / dx, k
    line[3] = abs(dx * (total - 0.5 * P[0]) / load - 1.0)


def _build(digest: str) -> Any:
    @nb.njit(cache=True, **JIT)
    def multigrid_solve(
        n: int,
        count: int,
        first: int,
        start: float,
        end: float,
        lam: float,
        oil: Array,
        load: float,
        tail: float,
        profile: Array,
        limits: Array,
        film_tolerance: float,
        P: Array,
        H: Array,
        shape: Array,
        state: Array,
        films: Array,
        record: Array,
    ) -> int:
        """Solve a steady contact by full multigrid."""
        digest  # noqa: B018  # a closure variable, hence part of the key of the disk cache
        offset, begin, field, plans, near = _make_grids(n, count, start, end, profile)
        grids = (offset, begin, field, plans, near)
        last = count - 1
        rows = np.zeros((11, n + 2))
        room = np.empty(film_work_size(n))
        cH, cP = np.empty((n + 1, 4)), np.empty((n + 1, 4))
        band = np.empty((n, LEFT + RIGHT + 1))
        work = coarsest_work(n >> last)
        free, numbers = np.zeros(count, np.int64), np.zeros(count + 2)
        line = np.zeros(RECORD)
        g = np.int64(0)
        while n >> g > first:
            g += 1
        for i in range((n >> g) + 1):
            field[_P, offset[g] + i] = P[i]
        free[g], numbers[0] = int(state[1]), state[0]
        used, lines, status = 0, 0, CONVERGED
        while True:
            m = n >> g
            dx = (end - start) / m
            a, b = offset[g], offset[g + 1]
            p, h, gap, excess = (
                field[_P, a:b],
                field[_H, a:b],
                field[_SHAPE, a:b],
                field[_EXCESS, a:b],
            )
            for i in range(m + 1):
                excess[i] = field[_TARGET, a + i] = 0.0
            work[5][0] = 0
            best, since, cycles = np.inf, 0, 0
            evaluate(
                m, dx, lam, oil, numbers[0], gap, excess, field[_K, a:b],
                plans[begin[g] : begin[g + 1]], rows, room, p, h,
            )  # fmt: skip
            while g < last:
                for i in range(m + 1):
                    rows[_BEFORE, i] = p[i]
                k = free[g]
                status = _cycle(
                    g, n, start, end, lam, oil, load, grids, rows, room, cH, cP, band, work, free,
                    numbers,
                )  # fmt: skip
                if status != CONVERGED:
                    break
                cycles += 1
                _check(m, dx, free[g], load, rows, p, line)
                if lines < record.shape[0]:
                    for c in range(RECORD):
                        record[lines, c] = line[c]
                    lines += 1
                change, flux = line[1], line[2]
                still = free[g] == k and line[3] < limits[2] and line[4] >= _CAVITY
                if not np.isfinite(change + flux):
                    status = NOT_FINITE
                elif still and change < limits[0] and flux < limits[1]:
                    break
                elif g > 0 and film_tolerance == 0.0:
                    if cycles >= _PASSING_CYCLES or (
                        change < limits[0] and flux < max(limits[1], _PASSING_FLUX)
                    ):
                        break
                elif still and change < _ROUNDING:
                    status = ROUNDED
                else:
                    best, since = (change, 0) if change < best else (best, since + 1)
                    if cycles >= limits[3] or since >= _PATIENCE:
                        status = STALLED
                if status != CONVERGED:
                    break
            state[0], state[1], state[2], state[3] = numbers[0], free[g], cycles, line[1]
            state[4], state[5], state[6], state[7] = line[2], m, used + 1, lines
            films[used] = central(m, start, dx, h)
            error = abs(films[used] - films[used - 1]) / 3.0 if used > 0 else np.inf
            if status != CONVERGED or g == 0 or error < film_tolerance * films[used]:
                break
            used += 1
            g -= 1
            free[g] = refine(
                m, dx, p, free[g + 1], load, tail, field[_P, offset[g] : offset[g + 1]]
            )
        for i in range(m + 1):
            P[i], H[i], shape[i] = p[i], h[i], gap[i]
        return status

    return multigrid_solve


multigrid_solve = _build(source_digest(Path(__file__).parent, _SOURCES))
