"""Full multigrid for the steady line contact: full approximation scheme, as one compiled call.

Nested iteration from a coarse solution upwards; on every grid V cycles with one distributive line
sweep before and one after the coarser grids. Film sums are Fourier transforms, not multilevel
integration. The rigid offset of the film is changed on the coarsest grid alone.
"""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import numba as nb
import numpy as np

from tribodyn.compiled import source_digest
from tribodyn.compiled.cache import cached_njit
from tribodyn.ehl._kernel.elementary import INNER, JIT, SOURCES
from tribodyn.ehl._kernel.film_sum import Grid, film_plan, film_sum, film_work_size, influence
from tribodyn.ehl._kernel.grid_transfer import central, cut_negative, extend, refine
from tribodyn.ehl._kernel.multigrid_levels import (
    LEFT,
    RIGHT,
    Level,
    LevelWork,
    add_correction,
    fill_balance,
    fill_film,
    fill_level_tangent,
    inject,
    level_work,
    mean_gap,
    near_influence,
    relax,
    restrict_defect,
    solve_coarsest,
)
from tribodyn.ehl._kernel.newton import CONVERGED, NOT_FINITE, ROUNDED, STALLED
from tribodyn.ehl._kernel.steady import SteadyContact
from tribodyn.interrupt import STOPPED
from tribodyn.types import Array, Index

_FILES = (*SOURCES, "steady", "multigrid_levels", "multigrid")
_DIGEST = source_digest(Path(__file__).parent, _FILES)

#: Columns of the record of cycles: intervals, change of pressure, flux error, load error, least
#: residual of the cavity per length, last free node.
RECORD = 6

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
#: Change of the pressure within rounding.
_ROUNDING = 1e-13


class MultigridLimits(NamedTuple):
    """When the cycles end."""

    pressure: float  #: greatest relative change of the pressure in a cycle at convergence
    flux: float  #: greatest flux error at convergence
    load: float  #: greatest load error at convergence
    cycles: int  #: at most, on one grid
    film: float  #: relative error of the central film with which a coarser grid does


class Cycled(NamedTuple):
    """How the cycles ended; pressure, film and gap are in their arrays."""

    status: int
    offset: float  #: rigid offset of the film
    free: int  #: last node with pressure
    cycles: int  #: on the last grid
    change: float
    flux_error: float
    intervals: int  #: of the last grid
    grids: int  #: that were solved
    lines: int  #: of the record


class Grids(NamedTuple):
    """All grids, the finest first, each row one after the other; see :class:`Level`."""

    n: int  #: intervals of the finest grid
    width: float  #: of the domain
    first: Index  #: where the nodes of each grid begin
    plan: Index  #: where its plan begins
    P: Array
    H: Array
    injected: Array
    target: Array
    excess: Array
    shape: Array
    influence: Array
    plans: Array
    near_films: Array
    free: Index  #: last free node of each grid
    load: Array  #: load that each grid carries


@nb.njit(**INNER)
def _level(grids: Grids, g: int) -> Level:
    """Views of one grid."""
    a, b, n = grids.first[g], grids.first[g + 1], grids.n >> g
    plan = grids.plans[grids.plan[g] : grids.plan[g + 1]]
    return Level(
        Grid(n, grids.width / n, grids.influence[a:b], plan),
        grids.P[a:b],
        grids.H[a:b],
        grids.injected[a:b],
        grids.target[a:b],
        grids.excess[a:b],
        grids.shape[a:b],
        grids.near_films[g],
    )


@nb.njit(**INNER)
def _make_grids(n: int, count: int, contact: SteadyContact) -> Grids:
    """All grids with their influence, plans and undeformed gaps."""
    start, width = contact.start, contact.end - contact.start
    offset, begin = np.zeros(count + 1, np.int64), np.zeros(count + 1, np.int64)
    for g in range(count):
        m = n >> g
        offset[g + 1] = offset[g] + m + 1
        # The size of a plan, from that of the arrays of its film sums: see film_sum.py.
        half = film_work_size(m) // 4
        begin[g + 1] = begin[g] + (6 * half + 2 if half > 0 else 0)
    a = np.zeros((7, offset[count]))
    grids = Grids(
        n, width, offset, begin, a[0], a[1], a[2], a[3], a[4], a[5], a[6],
        np.empty(begin[count]), np.empty((count, 2, 4, LEFT + RIGHT + 1)),
        np.zeros(count, np.int64), np.zeros(count),
    )  # fmt: skip
    for g in range(count):
        level = _level(grids, g)
        m, dx = level.grid.n, level.grid.dx
        level.grid.influence[:] = influence(m, dx)
        level.grid.plan[:] = film_plan(m, level.grid.influence)
        near_influence(dx, level.near_films)
        if g == 0:
            level.shape[:] = contact.profile
        else:
            mean_gap(m, _level(grids, g - 1).shape, level.shape)
    for g in range(count):
        level = _level(grids, g)
        for i in range(level.grid.n + 1):
            x = start + i * level.grid.dx
            level.shape[i] += 0.5 * x * x
    return grids


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
def _descend(grids: Grids, g: int, work: LevelWork) -> None:
    """Pose the problem of the next coarser grid: there the state of this one is injected."""
    fine, coarse = _level(grids, g), _level(grids, g + 1)
    m, k, dx, wide = fine.grid.n, grids.free[g], fine.grid.dx, coarse.grid.dx
    P, p, h, G = fine.P, coarse.P, coarse.H, work.fields.G
    half = m // 2
    grids.free[g + 1] = k // 2
    inject(half, P, p)
    inject(half, P, coarse.injected)
    carried = 0.5 * (wide - dx) * P[0]
    for i in range(1, m):
        carried -= dx * P[i]
    for i in range(1, half):
        carried += wide * p[i]
    grids.load[g + 1] = grids.load[g] + carried
    film_sum(half, coarse.grid.influence, coarse.grid.plan, p, work.transform, h)
    for i in range(half + 1):
        coarse.excess[i] = fine.H[2 * i] - (h[i] + work.offset[0] + coarse.shape[i])
        h[i] = fine.H[2 * i]
    restrict_defect(half, k, fine.target, G, coarse.target)
    fill_balance(coarse, work)
    for i in range(1, half):
        coarse.target[i] += G[i]


@nb.njit(**INNER)
def _cycle(top: int, load: float, grids: Grids, work: LevelWork, streak: Index) -> int:
    """One V cycle on and below the grid ``top``, whose film and residual are known."""
    last, least = grids.free.size - 1, _STIFF * grids.width**2
    grids.load[top] = load
    for step in range(2 * (last - top) + 1):
        upwards = step > last - top
        g = 2 * last - top - step if upwards else top + step
        level, k = _level(grids, g), grids.free[g]
        if g == last:
            status = solve_coarsest(level, k, grids.load[g], work)
            if status != CONVERGED:
                return status
            continue
        if upwards:
            coarse = _level(grids, g + 1)
            add_correction(level.grid.n // 2, k, coarse.P, coarse.injected, level.P)
            if g == top:
                for i in range(1, k + 1):
                    level.P[i] = max(level.P[i], 0.0)
        # After the sweep again: for the coarser grid or, on the finest, for the next cycle.
        for swept in range(2):
            if swept == 1 or upwards:
                fill_film(level, work.offset[0], work)
            if swept == 1:
                break
            fill_level_tangent(level, work)
            relax(level, k, least, _DAMPING, _CAP, work)
            if g == top:
                k, streak[0] = _move_outlet(level.grid.n, k, streak[0], level.P, work.fields.G)
                grids.free[g] = k
            elif upwards:
                break
        if not upwards:
            _descend(grids, g, work)
    return CONVERGED


@nb.njit(**INNER)
def _check(level: Level, k: int, load: float, work: LevelWork, line: Array) -> None:
    """Fill a line of the record: change, flux, load, cavity, outlet."""
    n, dx, P = level.grid.n, level.grid.dx, level.P
    F, G, before = work.fields.F, work.fields.G, work.before
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


@cached_njit(_DIGEST, "the multigrid film solver", "half a minute", **JIT)
def multigrid_solve(
    n: int, count: int, first: int, contact: SteadyContact, limits: MultigridLimits,
    offset: float, free: int, P: Array, H: Array, shape: Array, films: Array, record: Array,
    flag: Index,
) -> Cycled:  # fmt: skip
    """Solve a steady contact by full multigrid, from a pressure on the grid ``first``."""
    grids = _make_grids(n, count, contact)
    last, load = count - 1, contact.load
    work = level_work(n, n >> last, contact.lam, contact.oil)
    streak, line = np.zeros(1, np.int64), np.zeros(RECORD)
    g = nb.int64(0)
    while n >> g > first:
        g += 1
    level = _level(grids, g)
    for i in range(level.grid.n + 1):
        level.P[i] = P[i]
    grids.free[g], work.offset[0] = free, offset
    used, lines, status = nb.int64(0), nb.int64(0), nb.int64(CONVERGED)
    while True:
        level = _level(grids, g)
        m = level.grid.n
        for i in range(m + 1):
            level.excess[i] = level.target[i] = 0.0
        work.coarsest.factored[0] = 0
        best, since, cycles = np.inf, nb.int64(0), nb.int64(0)
        fill_film(level, work.offset[0], work)
        while g < last:
            if flag[0] != 0:
                status = nb.int64(STOPPED)
                break
            for i in range(m + 1):
                work.before[i] = level.P[i]
            k = grids.free[g]
            status = nb.int64(_cycle(g, load, grids, work, streak))
            if status != CONVERGED:
                break
            cycles += 1
            _check(level, grids.free[g], load, work, line)
            if lines < record.shape[0]:
                record[lines] = line
                lines += 1
            change, flux = line[1], line[2]
            still = grids.free[g] == k and line[3] < limits.load and line[4] >= _CAVITY
            if not np.isfinite(change + flux):
                status = nb.int64(NOT_FINITE)
            elif still and change < limits.pressure and flux < limits.flux:
                break
            elif g > 0 and limits.film == 0.0:
                if cycles >= _PASSING_CYCLES or (
                    change < limits.pressure and flux < max(limits.flux, _PASSING_FLUX)
                ):
                    break
            elif still and change < _ROUNDING:
                status = nb.int64(ROUNDED)
            else:
                best, since = (change, 0) if change < best else (best, since + 1)
                if cycles >= limits.cycles or since >= _PATIENCE:
                    status = nb.int64(STALLED)
            if status != CONVERGED:
                break
        films[used] = central(m, contact.start, level.grid.dx, level.H)
        error = abs(films[used] - films[used - 1]) / 3.0 if used > 0 else np.inf
        if status != CONVERGED or g == 0 or error < limits.film * films[used]:
            break
        used += 1
        g -= 1
        grids.free[g] = refine(
            m, level.grid.dx, level.P, grids.free[g + 1], load, contact.tail, _level(grids, g).P
        )
    for i in range(m + 1):
        P[i], H[i], shape[i] = level.P[i], level.H[i], level.shape[i]
    return Cycled(
        status, work.offset[0], grids.free[g], cycles, line[1], line[2], m, used + 1, lines
    )
