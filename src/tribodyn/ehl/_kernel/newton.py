"""Newton's method for the pressure on one grid, with the free outlet and optional cavities.

A steady film parts once, at the outlet. A film that is unloaded quickly also ruptures inside: the
nodes of such a cavity have the pressure zero, and their mass balance leaves oil missing.
"""

from __future__ import annotations

from typing import NamedTuple

import numba as nb
import numpy as np

from tribodyn.ehl._kernel.elementary import INNER
from tribodyn.ehl._kernel.film_sum import Grid, film_sum
from tribodyn.ehl._kernel.grid_transfer import cut_negative, extend
from tribodyn.ehl._kernel.linear_solver import (
    CoarseTangent,
    LinearWork,
    System,
    film_change,
    linear_solve,
    linear_work,
    prepare,
)
from tribodyn.ehl._kernel.reynolds import Fields, fill_oil, fill_tangent, make_fields, residual
from tribodyn.interrupt import STOPPED
from tribodyn.types import Array, Index

CONVERGED, STALLED, GAP, SINGULAR, NOT_FINITE, ROUNDED = 0, 1, 2, 3, 4, 5

#: A change of the pressure that rounding alone makes.
_ROUNDING = 1e-13
#: How often a node may fill again before it stays in its cavity.
_RETURNS = 10.0
#: Least part of the thinnest film that a step leaves.
_LEFT = 0.3


class Equation(NamedTuple):
    """The contact that is solved, in the scales of the dry contact."""

    lam: float  #: factor of the viscous flux
    oil: Array
    speed: float
    squeeze: float  #: factor of the squeeze term, zero for a steady contact
    history: Array  #: what the squeeze term takes over from earlier instants
    shape: Array  #: gap of the undeformed bodies
    tail: float  #: pressure at the first node
    imposed: bool  #: whether the load is imposed, or the offset
    target: float  #: the load, or the offset


class Limits(NamedTuple):
    """When Newton's method ends, and how far it goes in a step."""

    pressure: float  #: greatest relative change of the pressure at convergence
    flux: float  #: greatest flux error at convergence
    steps: int
    linear: float  #: tolerance of the linear solver
    change: float  #: greatest change of a pressure in a step


class NewtonWork(NamedTuple):
    """Arrays of :func:`newton_level`."""

    fields: Fields
    linear: LinearWork
    rhs: Array
    delta: Array  #: correction of the free pressures, then of the offset
    visits: Array  #: how often the outlet or a cavity has come to a node
    flag: Index  #: not zero when the work has to end


class Solved(NamedTuple):
    """How a solve ended; pressure and film are in their arrays."""

    status: int
    offset: float  #: rigid offset of the film
    free: int  #: last node with pressure
    load: float  #: integral of the pressure
    steps: int
    change: float  #: relative change of the pressure in the last step
    flux_error: float


@nb.njit(**INNER)
def newton_work(n: int, flag: Index) -> NewtonWork:
    """Arrays of :func:`newton_level` on ``n`` intervals."""
    a = np.zeros((3, n + 2))
    return NewtonWork(make_fields(n), linear_work(n), a[0], a[1], a[2], flag)


@nb.njit(**INNER)
def _flux_error(k: int, F: Array, G: Array) -> float:
    """Greatest deviation of the summed mass balance from its mean, over the mean flux."""
    total, mean, flux, highest = 0.0, 0.0, 0.0, 0.0
    for i in range(k + 1):
        total += G[i]
        mean += total
        flux += F[i]
        highest = max(highest, abs(F[i]))
    mean /= k + 1
    # A contact that is only squeezed has no mean flux.
    unit = max(abs(flux) / (k + 1), 0.1 * highest)
    total, worst = 0.0, 0.0
    for i in range(k + 1):
        total += G[i]
        worst = max(worst, abs(total - mean))
    return worst / unit


@nb.njit(**INNER)
def _balance_error(k: int, squeeze: float, cavity: Array, H: Array, f: Fields) -> float:
    """Sum of the mass balances of the free nodes over the mean flux, or over the squeezed oil."""
    wrong, flux, squeezed = 0.0, 0.0, 0.0
    for i in range(1, k + 1):
        flux += abs(f.F[i])
        squeezed += squeeze * f.rho[i] * H[i]
        if cavity[i] == 0.0 or f.G[i] < 0.0:
            wrong += abs(f.G[i])
    return wrong / max(flux / k, 1e-3 * squeezed)


@nb.njit(**INNER)
def _step_length(n: int, k: int, cap: float, delta: Array, rise: Array, H: Array) -> float:
    """Greatest step that changes no pressure by more than ``cap`` and keeps the gap open."""
    largest, least = 0.0, H[0]
    for i in range(k):
        largest = max(largest, abs(delta[i]))
    for i in range(n + 1):
        least = min(least, H[i])
    step = 1.0 if largest <= cap else cap / largest
    for _ in range(12):
        thinnest = H[0] + step * rise[0]
        for i in range(n + 1):
            thinnest = min(thinnest, H[i] + step * rise[i])
        if thinnest > _LEFT * least:
            return step
        step *= 0.5
    return 0.0


@nb.njit(**INNER)
def _refill(k: int, streak: int, cavity: Array, visits: Array, G: Array) -> bool:
    """Fill cavities from those of their nodes where oil is left over: one more node, two, four."""
    filled, i = False, 1
    while i <= k:
        if cavity[i] == 0.0 or G[i] >= 0.0 or visits[i] >= _RETURNS:
            i += 1
            continue
        # The cavity fills from the side of its free neighbour.
        way = -1 if cavity[i - 1] > 0.0 and cavity[i + 1] == 0.0 else 1
        node, left = i, min(2**streak, k)
        while left > 0 and 1 <= node <= k and cavity[node] > 0.0 and visits[node] < _RETURNS:
            cavity[node], filled = 0.0, True
            visits[node] += 1.0
            node += way
            left -= 1
        i = max(i, node) + 1 if way > 0 else i + 1
    return filled


@nb.njit(**INNER)
def _rupture(k: int, cavity: Array, P: Array) -> tuple[int, bool]:
    """Make cavities of the nodes with negative pressure; last free node, and whether any was."""
    torn = False
    for i in range(1, k + 1):
        if P[i] < 0.0:
            cavity[i], P[i], torn = 1.0, 0.0, True
    while k > 2 and cavity[k] > 0.0:
        cavity[k] = 0.0
        k -= 1
    return k, torn


@nb.njit(**INNER)
def _hold_cavities(k: int, cavity: Array, P: Array, rhs: Array, cH: Array, cP: Array) -> None:
    """Put the pressure zero in place of the mass balance where the film is torn."""
    for i in range(1, k + 1):
        if cavity[i] > 0.0:
            rhs[i - 1] = -P[i]
            for s in range(4):
                cH[i, s] = cP[i, s] = 0.0
            cP[i, 2] = 1.0


@nb.njit(**INNER)
def newton_level(
    grid: Grid, equation: Equation, limits: Limits, offset: float, free: int, P: Array, H: Array,
    cavity: Array, coarse: CoarseTangent, work: NewtonWork,
) -> Solved:  # fmt: skip
    """Solve one grid from a given pressure; an empty ``cavity`` lets the film part once."""
    n, dx, target, imposed = grid.n, grid.dx, equation.target, equation.imposed
    f, linear, rhs, delta, visits = work.fields, work.linear, work.rhs, work.delta, work.visits
    G, cH, cP, rise = f.G, linear.by_film, linear.by_pressure, linear.film
    torn = cavity.size > 0
    k = min(max(free, 2), n - 1)
    P[0] = equation.tail
    for i in range(n + 1):
        visits[i] = 0.0
    for i in range(k + 1, n + 1):
        P[i] = 0.0
        if torn:
            cavity[i] = 0.0
    # Typed: a literal would make the compiler compile the callee again.
    streak, refills, used, status = nb.int64(0), nb.int64(0), nb.int64(0), nb.int64(STALLED)
    moved, fresh, change, step, last_change, flux_error = False, True, 1.0, 1.0, 0.0, 0.0
    for steps in range(limits.steps + 1):
        if work.flag[0] != 0:
            status = nb.int64(STOPPED)
            break
        if fresh:
            film_sum(n, grid.influence, grid.plan, P, linear.transform, H)
            for i in range(n + 1):
                H[i] += offset + equation.shape[i]
        fill_oil(n, equation.lam, equation.oil, P, H, f)
        residual(n, dx, equation.speed, equation.squeeze, equation.history, P, H, f)
        if steps > 0:
            settled, grown = not moved and change < 0.1, False
            if settled and torn and _refill(k, refills, cavity, visits, G):
                moved = True
                refills += 1
            # No growth on to a node from which the outlet has already come back twice.
            if settled and k < n - 1 and G[k + 1] < 0.0:
                further = extend(n, k, streak)
                if visits[further] < 2.0:
                    k, moved, grown = further, True, True
                    streak += 1
            if grown or (moved and not torn):
                visits[k] += 1.0
            last_change = change
            if torn:
                flux_error = _balance_error(k, equation.squeeze, cavity, H, f)
            else:
                flux_error = _flux_error(k, f.F, G)
            if step == 1.0 and not moved and change < limits.pressure:
                if flux_error < limits.flux:
                    status = nb.int64(CONVERGED)
                    break
                if change < _ROUNDING:
                    status = nb.int64(ROUNDED)
                    break
        if steps == limits.steps:
            break
        used = steps + 1
        fill_tangent(n, dx, equation.speed, equation.squeeze, P, H, f, cH, cP)
        total = 0.5 * P[0]
        for i in range(1, k + 1):
            rhs[i - 1] = -G[i]
            total += P[i]
        rhs[k] = target - dx * total
        if torn:
            _hold_cavities(k, cavity, P, rhs, cH, cP)
        # An imposed offset is approached together with the pressure that keeps the film open.
        shift = 0.0 if imposed else target - offset
        if shift != 0.0:
            for i in range(1, k + 1):
                rhs[i - 1] -= shift * (cH[i, 0] + cH[i, 1] + cH[i, 2] + cH[i, 3])
        if not prepare(grid, k, imposed, linear):
            status = nb.int64(SINGULAR)
            break
        tolerance = limits.linear
        if not torn:
            # Where many steps are needed, the linear solver is often what holds them up.
            tolerance *= max(1e-4, 0.3 ** max(0, steps - 3))
        linear_solve(System(grid, k, imposed, coarse, linear), tolerance, rhs, delta)
        # Film of the whole step: the line search and the next film need no further sum.
        film_change(grid, k, 0.0, delta, linear)
        if imposed:
            shift = delta[k]
        for i in range(n + 1):
            rise[i] += shift
        step = _step_length(n, k, limits.change, delta, rise, H)
        if step == 0.0:
            status = nb.int64(GAP)
            break
        change, total = 0.0, abs(P[0])
        for i in range(k):
            P[i + 1] += step * delta[i]
            change += abs(step * delta[i])
            total += abs(P[i + 1])
        change /= total
        if not np.isfinite(change):
            status = nb.int64(NOT_FINITE)
            break
        offset = target if not imposed and step == 1.0 else offset + step * shift
        if torn:
            last, moved = _rupture(k, cavity, P)
        else:
            last = cut_negative(n, k, change, P)
            moved = last < k
        if moved:
            refills = nb.int64(0)
        if last < k:
            streak = nb.int64(0)
        k, fresh = last, moved
        if not moved:
            for i in range(n + 1):
                H[i] += step * rise[i]
    total = 0.5 * P[0]
    for i in range(1, k + 1):
        total += P[i]
    return Solved(status, offset, k, dx * total, used, last_change, flux_error)
