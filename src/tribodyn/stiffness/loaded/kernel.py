"""The compiled solver of the loaded tooth contact: loads of all pairs at every phase and torque.

For each slice of the face width ``delta = gap_i + sum_j C_ij f_j + f_i (A_i - B ln f_i)`` where a
pair carries, ``f_i >= 0``, and ``delta <= gap_i + sum_j C_ij f_j`` where it does not: the minimum
of a convex function. Replaces, and is tested against, ``tests/plain/loaded_contact.py``.

Loads ``f`` are per face width [N/m], compliances ``C``, ``A``, ``B`` [m^2/N], gaps and ``delta``
[m]. Status 0 is success, 1 no convergence, 2 a contact so wide that the formula of the local
compression has left its range.
"""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import numba as nb
import numpy as np

from tribodyn.compiled import source_digest
from tribodyn.compiled.cache import cached_njit
from tribodyn.compiled.jit import INNER, JIT, LEAN
from tribodyn.interrupt import STOPPED
from tribodyn.types import Array, Index

_DIGEST = source_digest(Path(__file__).parent, [Path(__file__).stem])

#: Residual of a pair over the approach that counts as zero.
_TIGHT = 1e-13
#: Load over the largest one below which a pair that would part is let go.
_FAINT = 1e-12
#: Least part of its load that a step leaves to a pair: one that parts is faint after three.
_LEFT = 1e-4
#: Gap that nothing closes [m].
_APART = 1e6
_INNER_STEPS = 200
_OUTER_STEPS = 200


class Teeth(NamedTuple):
    """Compliances of the pairs at one phase, the same in every slice."""

    C: Array
    A: Array
    B: float


class Work(NamedTuple):
    """Tangent system of the pairs that carry, their places, and sums over the slices."""

    a: Array
    b: Array
    place: Array
    sums: Array  #: force and tangent stiffness


@nb.njit(**INNER)
def _work(n: int) -> Work:
    return Work(np.empty((n, n)), np.empty(n), np.empty(n), np.empty(2))


@nb.njit(**LEAN)
def _eliminate(m: int, a: Array, b: Array) -> None:
    """Solve in place; the matrix is symmetric and positive definite, so nothing is pivoted."""
    for k in range(m):
        inverse = 1.0 / a[k, k]
        for r in range(k + 1, m):
            factor = a[r, k] * inverse
            for c in range(k + 1, m):
                a[r, c] -= factor * a[k, c]
            b[r] -= factor * b[k]
    for k in range(m - 1, -1, -1):
        for c in range(k + 1, m):
            b[k] -= a[k, c] * b[c]
        b[k] /= a[k, k]


@nb.njit(**LEAN)
def _touching_system(teeth: Teeth, gaps: Array, delta: float, f: Array, work: Work) -> int:
    """Tangent compliances and residuals of the pairs that carry; their number, -2 out of range."""
    (C, A, B), (a, b, place, _), m = teeth, work, 0
    n = A.size
    for i in range(n):
        if f[i] > 0.0:
            place[m] = i
            m += 1
    for r in range(m):
        i = int(place[r])
        for c in range(m):
            a[r, c] = C[i, int(place[c])]
        local = A[i] - B * np.log(f[i]) if B > 0.0 else A[i]
        if local - B < 0.0:
            return -2
        a[r, r] += local - B
        total = gaps[i] - delta
        for j in range(n):
            total += C[i, j] * f[j]
        b[r] = -(total + f[i] * local)
    return m


@nb.njit(**LEAN)
def _residual(teeth: Teeth, gap: float, delta: float, f: Array, i: int) -> float:
    C, A, B = teeth
    total = gap - delta
    for j in range(A.size):
        total += C[i, j] * f[j]
    if f[i] > 0.0:
        total += f[i] * (A[i] - B * np.log(f[i]) if B > 0.0 else A[i])
    return total


@nb.njit(**LEAN)
def _slice(teeth: Teeth, gaps: Array, delta: float, f: Array, work: Work) -> int:
    """Loads ``f`` of one slice at an approach, from the loads that it holds.

    Returns the number of pairs that carry, whose tangent system is in ``a`` and ``place``, or minus
    the status of a failure.
    """
    (C, A, B), (a, b, place, _), least = teeth, work, gaps[0]
    n = A.size
    for i in range(1, n):
        least = min(least, gaps[i])
    approach = delta - least
    if not approach > 0.0:
        for i in range(n):
            f[i] = 0.0
        return 0
    tight = _TIGHT * (approach + abs(delta))
    # At least one step is taken, or the loads of a slice would stand still while the approach is
    # led to its force in steps below that limit.
    stepped = False
    for _ in range(_INNER_STEPS):
        touched, settled, largest = False, True, 0.0
        for i in range(n):
            largest = max(largest, f[i])
        for i in range(n):
            if f[i] <= 0.0:
                away = _residual(teeth, gaps[i], delta, f, i)
                if away < -tight:
                    f[i] = -0.5 * away / (C[i, i] + A[i] + 10.0 * B)
                    touched = True
        if touched:
            continue
        m: int = _touching_system(teeth, gaps, delta, f, work)
        if m <= 0:
            return m
        for r in range(m):
            if abs(b[r]) > tight:
                settled = False
        if settled and stepped:
            return m
        stepped = True
        _eliminate(m, a, b)
        for r in range(m):
            i = int(place[r])
            f[i] = max(f[i] + b[r], _LEFT * f[i])
            if f[i] < _FAINT * largest:
                previous = f[i]
                f[i] = 0.0
                if _residual(teeth, gaps[i], delta, f, i) < 0.0:
                    f[i] = previous
    return -1


@nb.njit(**LEAN)
def _total_force(
    teeth: Teeth, gaps: Array, width: Array, delta: float, f: Array, work: Work
) -> int:
    """Force and tangent stiffness of all slices at an approach, into ``sums``; the status."""
    a, b, place, sums = work
    sums[0] = 0.0
    sums[1] = 0.0
    for s in range(width.shape[0]):
        m: int = _slice(teeth, gaps[s], delta, f[s], work)
        if m < 0:
            return -m
        for r in range(m):
            b[r] = 1.0
        _eliminate(m, a, b)
        for r in range(m):
            i = int(place[r])
            sums[0] += width[s, i] * f[s, i]
            sums[1] += width[s, i] * b[r]
    return 0


@nb.njit(**LEAN)
def _least(gaps: Array) -> float:
    """Smallest gap of all slices; NaN if there is one."""
    # Sums and minima of NumPy are slow to compile, and bring SciPy where compiled code is loaded.
    least = gaps[0, 0]
    for s in range(gaps.shape[0]):
        for i in range(gaps.shape[1]):
            if gaps[s, i] < least or gaps[s, i] != gaps[s, i]:
                least = gaps[s, i]
    return float(least)


@nb.njit(**LEAN)
def _approach(
    teeth: Teeth, gaps: Array, width: Array, total: float, start: float, f: Array, work: Work
) -> tuple[float, int]:
    """Approach at which all slices together carry ``total``, by safeguarded Newton steps."""
    n, low, high, sums = teeth.A.size, _least(gaps), np.inf, work.sums
    delta = start
    if not delta > low:
        widest = 0.0
        for i in range(n):
            across = 0.0
            for each in width[:, i]:
                across += each
            widest = max(widest, across)
        delta = low + total / widest * (teeth.C[0, 0] + teeth.A[0])
    for _ in range(_OUTER_STEPS):
        status = _total_force(teeth, gaps, width, delta, f, work)
        if status == 2 and delta - low > 1e-9 * (abs(delta) + abs(low)):
            # A soft pair was touched alone, and its slope led far beyond the load: come back.
            high = delta
            delta = 0.5 * (low + high)
            f[:] = 0.0
            continue
        if status != 0:
            return delta, status
        excess = sums[0] - total
        if abs(excess) <= 1e-12 * total:
            return delta, 0
        if excess > 0.0:
            high = delta
        else:
            low = delta
        new = delta - excess / sums[1] if sums[1] > 0.0 else np.inf
        if not low < new < high:
            new = 0.5 * (low + high) if high < np.inf else delta + 2.0 * (delta - _least(gaps))
        if new == delta:
            return delta, 0
        delta = new
    return delta, 1


@cached_njit(_DIGEST, "the loads of tooth pairs", "ten seconds", **JIT)
def solve_loads(
    C: Array,
    A: Array,
    B: float,
    gaps: Array,
    width: Array,
    totals: Array,
    delta: Array,
    force: Array,
    tangent: Array,
    flag: Index,
) -> int:
    """Solve every phase at every total load, in the order of the loads."""
    n, slices = A.shape[1], width.shape[1]
    work = _work(n)
    f = np.empty((slices, n))
    for p in range(A.shape[0]):
        teeth = Teeth(C[p], A[p], B)
        f[:] = 0.0
        start = -np.inf
        for t in range(totals.shape[0]):
            if flag[0] != 0:
                return STOPPED
            total = totals[t, p]
            start, status = _approach(teeth, gaps[p], width[p], total, start, f, work)
            if status != 0:
                return status
            delta[t, p] = start
            tangent[t, p] = work.sums[1]
            # One by one: the copy of arrays brings its error messages, slow to compile.
            for s in range(slices):
                for i in range(n):
                    force[t, p, s, i] = f[s, i]
    return 0


@cached_njit(_DIGEST, "the forces of tooth pairs", "ten seconds", **JIT)
def solve_deflections(
    C: Array,
    A: Array,
    B: float,
    gaps: Array,
    width: Array,
    delta: Array,
    total: Array,
    tangent: Array,
    flag: Index,
) -> int:
    """Force and tangent stiffness (D, P) of every phase at every approach ``delta`` (D, P)."""
    n, slices = A.shape[1], width.shape[1]
    work = _work(n)
    f = np.empty((slices, n))
    for p in range(A.shape[0]):
        teeth = Teeth(C[p], A[p], B)
        f[:] = 0.0
        for d in range(delta.shape[0]):
            if flag[0] != 0:
                return STOPPED
            status = _total_force(teeth, gaps[p], width[p], delta[d, p], f, work)
            if status != 0:
                return status
            total[d, p] = work.sums[0]
            tangent[d, p] = work.sums[1]
    return 0


@cached_njit(_DIGEST, "the first touch of tooth pairs", "ten seconds", **JIT)
def pickups(
    C: Array, A: Array, B: float, gaps: Array, most: Array, pickup: Array, flag: Index
) -> int:
    """Approach (P, n) at which each pair of a single slice begins to carry, up to ``most``."""
    n = A.shape[1]
    work = _work(n)
    f, alone = np.empty(n), np.empty(n)
    for p in range(A.shape[0]):
        if flag[0] != 0:
            return STOPPED
        teeth = Teeth(C[p], A[p], B)
        for i in range(n):
            # The pair itself stays separated; neighbours may pull its teeth together.
            for j in range(n):
                alone[j] = gaps[p, 0, j]
            alone[i] = _APART
            low, high = _least(gaps[p]), most[p]
            pickup[p, i] = min(low, high)
            if not low < high or low == gaps[p, 0, i]:
                continue
            f[:] = 0.0
            while high - low > 1e-14 * high:
                middle = 0.5 * (low + high)
                if middle <= low or middle >= high:
                    break
                status = _slice(teeth, alone, middle, f, work)
                if status < 0:
                    return -status
                if _residual(teeth, gaps[p, 0, i], middle, f, i) < 0.0:
                    high = middle
                else:
                    low = middle
            pickup[p, i] = high
    return 0
