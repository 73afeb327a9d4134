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
from numpy.typing import NDArray

from tribodyn.compiled import source_digest
from tribodyn.ehl.kernel.coarse import no_coarse
from tribodyn.ehl.kernel.coarsest import (
    BALANCE,
    DLNETA,
    DRHO,
    EPS,
    FLUX,
    RHO,
    balance,
    coarsest_work,
    evaluate,
    solve_coarsest,
)
from tribodyn.ehl.kernel.fas_transfer import add_correction, inject, mean_gap, restrict_defect
from tribodyn.ehl.kernel.film_sum import film_plan, film_sum, film_work_size, influence
from tribodyn.ehl.kernel.krylov import newton_work
from tribodyn.ehl.kernel.newton import (
    CONVERGED,
    GAP,
    NOT_FINITE,
    ROUNDED,
    STALLED,
    newton_level,
)
from tribodyn.ehl.kernel.options import INNER, JIT
from tribodyn.ehl.kernel.outlet import cut_negative, extend
from tribodyn.ehl.kernel.reynolds import coefficients
from tribodyn.ehl.kernel.relaxation import LEFT, RIGHT, near_influence, relax
from tribodyn.ehl.kernel.start import cold_start, free_nodes
from tribodyn.ehl.kernel.transfer import central, refine

__all__ = ["RECORD", "multigrid_solve"]

Array = NDArray[np.float64]
Index = NDArray[np.int64]

#: Every file whose code ends up in the compiled kernel.
_SOURCES = (
    "options", "elementary", "transform", "film_sum", "oil", "reynolds", "band", "dense",
    "outlet", "transfer", "start", "coarse", "krylov", "newton", "relaxation", "fas_transfer",
    "coarsest", "multigrid",
)  # fmt: skip

#: Columns of the record of cycles: intervals, change of pressure, flux error, load error, least
#: residual of the cavity per length, last free node.
RECORD = 6

# Rows of the field over all grids.
_P, _H, _INJECTED, _RIGHT_SIDE, _EXCESS, _SHAPE, _K = 0, 1, 2, 3, 4, 5, 6
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
        field[_K, offset[g] : offset[g + 1]] = K
        plan = film_plan(m, K)
        plans[begin[g] : begin[g + 1]] = plan
        near_influence(dx, near[g])
        heights = field[_SHAPE, offset[g] : offset[g + 1]]
        if g == 0:
            heights[:] = profile
        else:
            mean_gap(m, field[_SHAPE, offset[g - 1] : offset[g]], heights)
    for g in range(count):
        for i in range((n >> g) + 1):
            x = start + i * ((end - start) / (n >> g))
            field[_SHAPE, offset[g] + i] += 0.5 * x * x
    return offset, begin, field, plans, near


@nb.njit(**INNER)
def _move_outlet(
    n: int, free: int, streak: int, P: Array, G: Array
) -> tuple[int, int]:
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
def _cycle(
    top: int, n: int, start: float, end: float, lam: float, oil: Array, load: float, grids: Any,
    rows: Array, room: Array, cH: Array, cP: Array, band: Array, work: Any, free: Index,
    loads: Array, state: Array,
) -> bool:  # fmt: skip
    """One V cycle below and with the grid ``top``, whose film and residual are known."""
    offset, begin, field, plans, near = grids
    last, least = offset.size - 2, _STIFF * (end - start) ** 2
    dipole, delta, G = rows[_DIPOLE], rows[_DELTA], rows[BALANCE]
    streak = np.int64(state[5])
    loads[top] = load
    # Down to the coarsest grid and up again; the turn is at step `last - top`.
    for step in range(2 * (last - top) + 1):
        g = top + step if step <= last - top else 2 * last - top - step
        m = n >> g
        dx = (end - start) / m
        grid = field[:, offset[g] : offset[g + 1]]
        P, H, right, K = grid[_P], grid[_H], grid[_RIGHT_SIDE], grid[_K]
        shape, excess, plan = grid[_SHAPE], grid[_EXCESS], plans[begin[g] : begin[g + 1]]
        k = free[g]
        if g == last:
            if not solve_coarsest(
                m, k, dx, lam, oil, loads[g], shape, excess, right, K, plan, rows, room, cH, cP,
                work, P, H, state,
            ):  # fmt: skip
                return False
            continue
        upwards = step > last - top
        if upwards:
            below = field[:, offset[g + 1] : offset[g + 2]]
            add_correction(m // 2, k, below[_P], below[_INJECTED], P)
            if g == top:
                for i in range(1, k + 1):
                    P[i] = max(P[i], 0.0)
        # The second time: after the sweep, for the way down or, on the finest grid, for the end.
        for turn in range(2):
            if turn == 1 or upwards:
                evaluate(
                    m, dx, lam, oil, state[0], shape, excess, K, plan, rows, room, P, H
                )
            if turn == 1:
                break
            coefficients(
                m, dx, lam, 1.0, 0.0, P, H, rows[DLNETA], rows[RHO], rows[DRHO], rows[EPS], cH, cP
            )
            relax(
                k, least, _DAMPING, _CAP, near[g], cH, cP, rows[EPS], G, right, dipole, delta,
                band, P,
            )  # fmt: skip
            if g == top:
                k, streak = _move_outlet(m, k, streak, P, G)
                free[g] = k
            elif upwards:
                break
        if upwards:
            continue
        # The coarser grid: injected state, its film corrected to that of this grid.
        below = field[:, offset[g + 1] : offset[g + 2]]
        half, wide = m // 2, 2.0 * dx
        free[g + 1] = k // 2
        p, h, coarse, gap = below[_P], below[_H], below[_RIGHT_SIDE], below[_EXCESS]
        inject(half, P, p)
        inject(half, P, below[_INJECTED])
        loads[g + 1] = loads[g]
        for i in range(1, m):
            loads[g + 1] -= dx * P[i]
        for i in range(1, half):
            loads[g + 1] += wide * p[i]
        loads[g + 1] += 0.5 * (wide - dx) * P[0]
        film_sum(half, below[_K], plans[begin[g + 1] : begin[g + 2]], p, room, h)
        for i in range(half + 1):
            gap[i] = H[2 * i] - (h[i] + state[0] + below[_SHAPE, i])
        inject(half, H, h)
        restrict_defect(half, k, right, G, coarse)
        balance(half, wide, lam, oil, rows, p, h)
        for i in range(1, half):
            coarse[i] += G[i]
    state[5] = streak
    return True


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
        shape: Array,
        state: Array,
        films: Array,
        record: Array,
    ) -> int:
        """Solve a steady contact by full multigrid.

        Parameters
        ----------
        n, count : int
            Intervals of the finest grid, and number of grids, each with half as many.
        first : int
            Intervals of the grid to start on.
        warm : bool
            Whether ``P`` and the state hold a start on the first grid.
        start, end : float
            First and last position.
        lam, oil : float, array
            As for :mod:`tribodyn.ehl.kernel.reynolds`.
        film : float
            Estimate of the central film, for a cold start.
        load, tail : float
            Target of ``dx`` times the sum of P, the first node counted half; pressure there.
        profile : (n + 1,) array
            Heights added to the gap.
        limits : (8,) array
            Tolerance of pressure and of flux, Newton steps of the start, tolerance of its linear
            solver, greatest change of pressure in its steps, nothing, tolerance of the load,
            most cycles on the last grid.
        film_tolerance : float
            Relative error of the central film at which finer grids are left out; zero for none.
        P, H, shape : (n + 1,) arrays
            Receive the solution and the undeformed gap in their first nodes.
        state : (12,) array
            Offset and last free node, in and out; cycles on the last grid, change of pressure,
            flux error there. Then, at 8, the intervals of the last grid, those of the first one
            after all failed starts, the number of grids used, and that of recorded cycles.
        films : (20,) array
            Receives the central films of the grids used.
        record : (lines, RECORD) array
            Receives a line for every cycle, as long as there is room.

        Returns
        -------
        int
            A status of :mod:`tribodyn.ehl.kernel.newton`.
        """
        digest  # noqa: B018  # a closure variable, hence part of the key of the disk cache
        grids = _make_grids(n, count, start, end, profile)
        offset, begin, field, plans = grids[0], grids[1], grids[2], grids[3]
        last = count - 1
        rows = np.zeros((11, n + 2))
        room = np.empty(film_work_size(n))
        cH, cP = np.empty((n + 1, 4)), np.empty((n + 1, 4))
        band = np.empty((n, LEFT + RIGHT + 1))
        work = coarsest_work(n >> last)
        free, loads = np.zeros(count, np.int64), np.zeros(count)
        line = np.zeros(RECORD)
        g = np.int64(0)
        while n >> g > first:
            g += 1
        # The start: a solution on a coarse grid.
        while not warm or g == last:
            m = n >> g
            dx = (end - start) / m
            grid = field[:, offset[g] : offset[g + 1]]
            plan = plans[begin[g] : begin[g + 1]]
            newton, enough = newton_work(m), limits.copy()
            if g > 0 and film_tolerance == 0.0:
                enough[0], enough[1] = max(limits[0], 1e-4), max(limits[1], _PASSING_FLUX)
            if warm:
                grid[_P, :] = P[: m + 1]
            else:
                state[0] = cold_start(
                    m, start, dx, lam, oil, film, load, tail, grid[_SHAPE], grid[_K], plan, newton,
                    grid[_P], grid[_H],
                )  # fmt: skip
                state[1] = free_nodes(m, grid[_P])
            status = newton_level(
                m, dx, lam, 1.0, 0.0, load, True, tail, oil, grid[_SHAPE], rows[7], grid[_K],
                plan, enough, no_coarse(), newton, grid[_P], grid[_H], state,
            )  # fmt: skip
            state[9] = m
            if status == CONVERGED:
                break
            if warm or g == 0:
                state[8] = m
                return status
            g -= 1
        if warm and g < last:
            field[_P, offset[g] : offset[g + 1]] = P[: (n >> g) + 1]
        free[g] = int(state[1])
        used, lines, status = 0, 0, CONVERGED
        while True:
            m = n >> g
            dx = (end - start) / m
            grid = field[:, offset[g] : offset[g + 1]]
            p, h = grid[_P], grid[_H]
            plan = plans[begin[g] : begin[g + 1]]
            passing = g > 0 and film_tolerance == 0.0
            for i in range(m + 1):
                grid[_EXCESS, i] = grid[_RIGHT_SIDE, i] = 0.0
            work[5][0] = 0
            best, since, cycles = np.inf, 0, 0
            if g < last:
                evaluate(
                    m, dx, lam, oil, state[0], grid[_SHAPE], grid[_EXCESS], grid[_K], plan, rows,
                    room, p, h,
                )  # fmt: skip
            while g < last:
                for i in range(m + 1):
                    rows[_BEFORE, i] = p[i]
                k = free[g]
                if not _cycle(
                    g, n, start, end, lam, oil, load, grids, rows, room, cH, cP, band, work, free,
                    loads, state,
                ):  # fmt: skip
                    status = GAP
                    break
                cycles += 1
                _check(m, dx, free[g], load, rows, p, line)
                if lines < record.shape[0]:
                    record[lines] = line
                    lines += 1
                change, flux = line[1], line[2]
                if not np.isfinite(change + flux):
                    status = NOT_FINITE
                    break
                tight = change < limits[0] and line[3] < limits[6] and line[4] >= _CAVITY
                if tight and flux < limits[1] and free[g] == k:
                    break
                if passing and (
                    cycles >= _PASSING_CYCLES
                    or (change < limits[0] and flux < max(limits[1], _PASSING_FLUX))
                ):
                    break
                if tight and change < _ROUNDING and free[g] == k:
                    status = ROUNDED
                    break
                best, since = (change, 0) if change < best else (best, since + 1)
                if cycles >= int(limits[7]) or since >= _PATIENCE:
                    status = STALLED
                    break
            state[1], state[2], state[8] = free[g], cycles, m
            state[10], state[11] = used + 1, lines
            if cycles > 0:
                state[3], state[4] = line[1], line[2]
            films[used] = central(m, start, dx, h)
            error = abs(films[used] - films[used - 1]) / 3.0 if used > 0 else np.inf
            if status != CONVERGED or g == 0 or error < film_tolerance * films[used]:
                break
            used += 1
            free[g - 1] = refine(
                m, dx, p, free[g], load, tail, field[_P, offset[g - 1] : offset[g]]
            )
            g -= 1
        for i in range(m + 1):
            P[i], H[i], shape[i] = p[i], h[i], grid[_SHAPE, i]
        return status

    return multigrid_solve


multigrid_solve = _build(source_digest(Path(__file__).parent, _SOURCES))
