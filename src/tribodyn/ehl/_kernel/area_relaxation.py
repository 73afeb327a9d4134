"""Kernels of the two-dimensional Reynolds equation: oil, residual, tangent and line relaxation.

Arrays have the shape (rows across, nodes along x). Poiseuille flux central, Couette flux upstream
of second order along both axes; all lengths in the half width of the dry contact along x, see
:mod:`tribodyn.ehl.area.area_case`. ``oil`` as in :mod:`tribodyn.ehl._kernel.reynolds`.
"""

from __future__ import annotations

from pathlib import Path

import numba as nb
import numpy as np

from tribodyn.compiled import source_digest
from tribodyn.compiled.cache import cached_njit
from tribodyn.ehl._kernel.elementary import INNER, JIT, exp_, log_
from tribodyn.types import Array

_DIGEST = source_digest(Path(__file__).parent, ("elementary", "area_relaxation"))

#: Least film in the mobility, and share of Roelands' pole below which a pressure is cut.
_THINNEST, _LOWEST = 1e-9, -0.3
#: Flow per overlap of an iterate, in units of the flow that is carried along a line.
_APART = 5.0
#: Half width of the band of a line, and nodes of the influence that it needs.
BAND = 4
REACH = BAND + 4


@nb.njit(**INNER)
def _oil_fields(lam: float, oil: Array, P: Array, H: Array, fields: Array) -> None:
    """Density, its slope, mobility ``rho H^3/(eta lam)``, and slopes of its logarithm and film."""
    rho, drho, eps, grow = fields[0], fields[1], fields[2], fields[3]
    law, a, reference, z, d1, d2 = oil[0], oil[1], oil[2], oil[3], oil[4], oil[5]
    rows, nodes = P.shape
    for j in range(rows):
        for i in range(nodes):
            p = P[j, i]
            lneta, slope = 0.0, 0.0
            if law == 2.0:
                base = 1.0 + max(p, _LOWEST * reference) / reference
                thick = a * exp_(z * log_(base))
                lneta, slope = thick - a, thick * z / (reference * base)
            elif law == 1.0:
                lneta, slope = a * p, a
            share = 1.0 / (1.0 + d2 * max(p, 0.0))
            density = 1.0 + d1 * p * share
            rho[j, i] = density
            drho[j, i] = d1 * share * share
            h = max(H[j, i], _THINNEST)
            eps[j, i] = density * h * h * h * exp_(-lneta) / lam
            grow[j, i] = drho[j, i] / density - slope


@cached_njit(_DIGEST, "films of point contacts", "five seconds", **JIT)
def residual(
    hx: float, hy: float, ux: float, uy: float, lam: float, oil: Array, P: Array, H: Array,
    f: Array, fields: Array, r: Array,
) -> float:  # fmt: skip
    """Residual ``f - L`` of the inner nodes, and the mean of the Couette terms' size."""
    _oil_fields(lam, oil, P, H, fields)
    rho, eps = fields[0], fields[2]
    ax, ay, bx, by = 0.5 / hx**2, 0.5 / hy**2, ux / hx, uy / hy
    rows, nodes = P.shape
    size = 0.0
    for j in range(1, rows - 1):
        for i in range(1, nodes - 1):
            e = eps[j, i]
            flow = ax * (
                (e + eps[j, i + 1]) * (P[j, i + 1] - P[j, i])
                - (e + eps[j, i - 1]) * (P[j, i] - P[j, i - 1])
            ) + ay * (
                (e + eps[j + 1, i]) * (P[j + 1, i] - P[j, i])
                - (e + eps[j - 1, i]) * (P[j, i] - P[j - 1, i])
            )
            m = rho[j, i] * H[j, i]
            left = rho[j, i - 1] * H[j, i - 1]
            if i > 1:
                moved = bx * (1.5 * m - 2.0 * left + 0.5 * rho[j, i - 2] * H[j, i - 2])
            else:
                moved = bx * (m - left)
            if by != 0.0:
                below = rho[j - 1, i] * H[j - 1, i]
                if j > 1:
                    moved += by * (1.5 * m - 2.0 * below + 0.5 * rho[j - 2, i] * H[j - 2, i])
                else:
                    moved += by * (m - below)
            # Bodies that overlap in an iterate press each other apart.
            r[j, i] = f[j, i] - flow + moved + _APART * bx * min(H[j, i], 0.0)
            size += abs(moved)
    return size / ((rows - 2) * (nodes - 2))


@nb.njit(**INNER)
def _tangent_row(
    j: int, i: int, steps: Array, P: Array, H: Array, fields: Array, cH: Array, cP: Array
) -> None:
    """Slopes of ``L`` by film and pressure of a node and of i-1, i-2, i+1, j-1, j-2, j+1."""
    rho, drho, eps, grow = fields[0], fields[1], fields[2], fields[3]
    ax, ay, bx, by = steps[0], steps[1], steps[2], steps[3]
    for k in range(7):
        cH[k] = cP[k] = 0.0
    sides = ((j, i - 1, 1, ax), (j, i + 1, 3, ax), (j - 1, i, 4, ay), (j + 1, i, 6, ay))
    e = eps[j, i]
    rise, mean = 0.0, 0.0
    for jj, ii, k, a in sides:
        d = a * (P[jj, ii] - P[j, i])
        en = eps[jj, ii]
        rise += d
        half = a * (e + en)
        mean += half
        cP[k] = half + d * en * grow[jj, ii]
        if H[jj, ii] > _THINNEST:
            cH[k] = d * 3.0 * en / H[jj, ii]
    cP[0] = -mean + rise * e * grow[j, i]
    if H[j, i] > _THINNEST:
        cH[0] = rise * 3.0 * e / H[j, i]
    elif H[j, i] < 0.0:
        cH[0] = -_APART * bx
    w0, w1, w2 = (1.5 * bx, -2.0 * bx, 0.5 * bx) if i > 1 else (bx, -bx, 0.0)
    v0, v1, v2 = (1.5 * by, -2.0 * by, 0.5 * by) if j > 1 else (by, -by, 0.0)
    cH[0] -= (w0 + v0) * rho[j, i]
    cP[0] -= (w0 + v0) * drho[j, i] * H[j, i]
    cH[1] -= w1 * rho[j, i - 1]
    cP[1] -= w1 * drho[j, i - 1] * H[j, i - 1]
    cH[4] -= v1 * rho[j - 1, i]
    cP[4] -= v1 * drho[j - 1, i] * H[j - 1, i]
    if i > 1:
        cH[2] -= w2 * rho[j, i - 2]
        cP[2] -= w2 * drho[j, i - 2] * H[j, i - 2]
    if j > 1:
        cH[5] -= v2 * rho[j - 2, i]
        cP[5] -= v2 * drho[j - 2, i] * H[j - 2, i]


@nb.njit(**INNER)
def _solve_band(n: int, A: Array, b: Array) -> None:
    """Solve a band system of ``n`` rows without exchanges; the diagonal is column ``BAND``."""
    for k in range(n):
        pivot = 1.0 / A[k, BAND]
        for m in range(1, min(BAND, n - 1 - k) + 1):
            factor = A[k + m, BAND - m] * pivot
            if factor != 0.0:
                for c in range(1, BAND + 1):
                    A[k + m, BAND - m + c] -= factor * A[k, BAND + c]
                b[k + m] -= factor * b[k]
    for k in range(n - 1, -1, -1):
        total = b[k]
        for c in range(1, min(BAND, n - 1 - k) + 1):
            total -= A[k, BAND + c] * b[k + c]
        b[k] = total / A[k, BAND]


@cached_njit(_DIGEST, "the solver of point contacts", "ten seconds", **JIT)
def relax(
    hx: float, hy: float, ux: float, uy: float, switch: float, damping: Array, K: Array,
    P: Array, H: Array, fields: Array, r: Array, change: Array,
) -> None:  # fmt: skip
    """One sweep of distributive line relaxation, with film and residual of its beginning."""
    # A node whose mobility exceeds ``switch`` changes alone, another one as a dipole: itself,
    # less its share of the four neighbours.
    rows, nodes = P.shape
    eps = fields[2]
    steps = np.array([0.5 / hx**2, 0.5 / hy**2, ux / hx, uy / hy])
    wx = 0.5 * hy**2 / (hx**2 + hy**2)
    wy = 0.5 * hx**2 / (hx**2 + hy**2)
    cH, cP = np.empty(7), np.empty(7)
    A, b = np.zeros((nodes, 2 * BAND + 1)), np.zeros(nodes)
    dipole = np.zeros(nodes, dtype=np.bool_)
    # Influence at the signed distance, of a single node and of a dipole, in three rows.
    single, double = np.zeros((3, 2 * REACH + 1)), np.zeros((3, 2 * REACH + 1))
    for row in range(3):
        for d in range(-REACH, REACH + 1):
            single[row, d + REACH] = K[row, abs(d)]
            double[row, d + REACH] = (
                K[row, abs(d)]
                - wx * (K[row, abs(d - 1)] + K[row, abs(d + 1)])
                - wy * (K[abs(row - 1), abs(d)] + K[row + 1, abs(d)])
            )
    before = np.zeros(nodes)
    change[:] = 0.0
    for j in range(1, rows - 1):
        for i in range(1, nodes - 1):
            dipole[i] = eps[j, i] < switch
        n = nodes - 2
        for i in range(1, nodes - 1):
            k = i - 1
            for c in range(2 * BAND + 1):
                A[k, c] = 0.0
            if P[j, i] <= 0.0 and r[j, i] >= 0.0:
                A[k, BAND] = 1.0
                b[k] = 0.0
                continue
            _tangent_row(j, i, steps, P, H, fields, cH, cP)
            b[k] = r[j, i] - cP[4] * before[i]
            for m in range(max(1, i - BAND), min(nodes - 2, i + BAND) + 1):
                d = i - m + REACH
                t = double if dipole[m] else single
                A[k, m - k - 1 + BAND] = (
                    cH[0] * t[0, d] + cH[1] * t[0, d - 1] + cH[2] * t[0, d - 2]
                    + cH[3] * t[0, d + 1] + (cH[4] + cH[6]) * t[1, d] + cH[5] * t[2, d]
                )  # fmt: skip
            # Direct slopes by pressure: nodes i-2..i+1 of the line, and its neighbours.
            for q in range(4):
                at, value = (i, cP[0]) if q == 0 else (i + 1, cP[3])
                if q == 1 or q == 2:
                    at, value = i - q, cP[q]
                for side in range(-1, 2):
                    m = at + side
                    if m < 1 or m > nodes - 2:
                        continue
                    if side == 0:
                        A[k, m - i + BAND] += value
                    elif dipole[m]:
                        A[k, m - i + BAND] -= wx * value
            if dipole[i]:
                A[k, BAND] -= wy * (cP[4] + cP[6])
            largest = 1.0 / abs(A[k, BAND])
            for c in range(2 * BAND + 1):
                A[k, c] *= largest
            b[k] *= largest
        _solve_band(n, A, b)
        before[:] = 0.0
        for i in range(1, nodes - 1):
            delta = b[i - 1]
            if dipole[i]:
                delta = min(max(delta * damping[1], -damping[2]), damping[2])
                change[j, i] += delta
                change[j, i - 1] -= wx * delta
                change[j, i + 1] -= wx * delta
                change[j - 1, i] -= wy * delta
                change[j + 1, i] -= wy * delta
            else:
                delta = min(max(delta * damping[0], -damping[2]), damping[2])
                change[j, i] += delta
                before[i] = delta
    for j in range(1, rows - 1):
        for i in range(1, nodes - 1):
            P[j, i] = max(P[j, i] + change[j, i], 0.0)


@cached_njit(_DIGEST, "the tangent of point contacts", "five seconds", **JIT)
def dense_tangent(
    hx: float, hy: float, ux: float, uy: float, K: Array, P: Array, H: Array, fields: Array,
    r: Array, J: Array, b: Array,
) -> None:  # fmt: skip
    """Dense tangent of all inner nodes, then of the load by the rigid gap; right-hand side."""
    rows, nodes = P.shape
    steps = np.array([0.5 / hx**2, 0.5 / hy**2, ux / hx, uy / hy])
    cH, cP = np.empty(7), np.empty(7)
    width = nodes - 2
    n = (rows - 2) * width
    dj, di = (0, 0, 0, 0, -1, -2, 1), (0, -1, -2, 1, 0, 0, 0)
    J[:] = 0.0
    for j in range(1, rows - 1):
        for i in range(1, nodes - 1):
            k = (j - 1) * width + i - 1
            J[n, k] = 1.0
            if P[j, i] <= 0.0 and r[j, i] >= 0.0:
                J[k, k], b[k] = 1.0, 0.0
                continue
            _tangent_row(j, i, steps, P, H, fields, cH, cP)
            b[k] = r[j, i]
            for q in range(7):
                jj, ii = j + dj[q], i + di[q]
                J[k, n] += cH[q]
                if cH[q] != 0.0:
                    for row in range(1, rows - 1):
                        for m in range(1, nodes - 1):
                            at = (row - 1) * width + m - 1
                            J[k, at] += cH[q] * K[abs(jj - row), abs(ii - m)]
                if 1 <= jj < rows - 1 and 1 <= ii < nodes - 1:
                    J[k, (jj - 1) * width + ii - 1] += cP[q]
