"""Distributive line relaxation of the line contact: one banded solve over all free nodes.

Where the oil is stiff a change of the pressure at one node bends the film everywhere, so that a
band cannot hold its effect. There a node takes its change half from each of its neighbours: the
film of such a dipole fades with the square of the distance.
"""

from __future__ import annotations

import numba as nb

from tribodyn.ehl.kernel.film_sum import influence
from tribodyn.ehl.kernel.options import INNER
from tribodyn.types import Array

#: Intervals to which a change of the pressure bends the film within the sweep.
NEAR = 5
#: Half bandwidths: the residual of a node has the films of i-2 to i+1.
LEFT, RIGHT = NEAR + 2, NEAR + 1
_WIDTH = LEFT + RIGHT + 1


@nb.njit(**INNER)
def near_influence(dx: float, near: Array) -> None:
    """Film of a single node and of a dipole, up to ``NEAR`` intervals away and zero beyond."""
    K = influence(NEAR + 1, dx)
    for s in range(4):
        for c in range(_WIDTH):
            d = abs(s - 2 - c + LEFT)
            near[0, s, c] = K[d] if d <= NEAR else 0.0
            near[1, s, c] = K[d] - 0.5 * (K[abs(d - 1)] + K[d + 1]) if d <= NEAR else 0.0


@nb.njit(**INNER)
def assemble_band(k: int, dipole: Array, near: Array, cH: Array, cP: Array, band: Array) -> None:
    """Band of the tangent in the unknowns of the sweep, row ``i - 1`` for node i."""
    inside = 0.0
    for j in range(1, min(RIGHT, k) + 1):
        inside += dipole[j]
    for i in range(1, k + 1):
        # Dipoles within the band of this row.
        if i + RIGHT <= k:
            inside += dipole[i + RIGHT]
        if i - LEFT > 1:
            inside -= dipole[i - LEFT - 1]
        row = band[i - 1]
        h0, h1, h2, h3 = cH[i, 0], cH[i, 1], cH[i, 2], cH[i, 3]
        if inside == 0.0 or inside == _WIDTH:
            film = near[1] if inside > 0.0 else near[0]
            for c in range(_WIDTH):
                row[c] = h0 * film[0, c] + h1 * film[1, c] + h2 * film[2, c] + h3 * film[3, c]
        else:
            for c in range(_WIDTH):
                j = i + c - LEFT
                film = near[1] if 1 <= j <= k and dipole[j] > 0.0 else near[0]
                row[c] = h0 * film[0, c] + h1 * film[1, c] + h2 * film[2, c] + h3 * film[3, c]
        for s in range(4):
            j, value = i - 2 + s, cP[i, s]
            c = LEFT - 2 + s
            if 1 <= j <= k:
                row[c] += value
            # The dipoles beside node j take half of their strength from it.
            if j >= 1:
                row[c - 1] -= 0.5 * value * dipole[min(j - 1, k)]
            if 0 <= j < k:
                row[c + 1] -= 0.5 * value * dipole[j + 1]


@nb.njit(**INNER)
def solve_band(k: int, band: Array, x: Array) -> None:
    """Gaussian elimination in node order; ``x`` is the right side, then the solution."""
    for i in range(k):
        row = band[i]
        inverse, value = 1.0 / row[LEFT], x[i]
        for r in range(1, min(LEFT, k - 1 - i) + 1):
            low = band[i + r, LEFT - r :]
            factor = low[0] * inverse
            for c in range(1, RIGHT + 1):
                low[c] -= factor * row[LEFT + c]
            x[i + r] -= factor * value
    for i in range(k - 1, -1, -1):
        row, value = band[i], x[i]
        for c in range(1, min(RIGHT, k - 1 - i) + 1):
            value -= row[LEFT + c] * x[i + c]
        x[i] = value / row[LEFT]


@nb.njit(**INNER)
def relax(
    k: int, least: float, damping: float, cap: float, near: Array, cH: Array, cP: Array,
    eps: Array, G: Array, right: Array, dipole: Array, delta: Array, band: Array, P: Array,
) -> float:  # fmt: skip
    """One sweep: pressures that meet the residual within the band."""
    for j in range(k + 2):
        dipole[j] = 1.0 if 2 <= j < k and eps[j] < least else 0.0
    assemble_band(k, dipole, near, cH, cP, band)
    x = delta[1:]
    for i in range(1, k + 1):
        delta[i] = right[i] - G[i]
    solve_band(k, band, x)
    largest, before = 0.0, 0.0
    for i in range(1, k + 1):
        here = delta[i]
        # Half of the dipoles on both sides; the one behind is still as solved.
        after = 0.5 * dipole[i + 1] * delta[i + 1] if i < k else 0.0
        delta[i] = here - before - after
        before = 0.5 * dipole[i] * here
        largest = max(largest, abs(delta[i]))
    step = damping if damping * largest <= cap else cap / largest
    for i in range(1, k + 1):
        P[i] += step * delta[i]
    return step * largest
