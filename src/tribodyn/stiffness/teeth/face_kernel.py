"""The compiled sum of compliances over all slices in contact."""

from __future__ import annotations

from pathlib import Path

import numba as nb
import numpy as np

from tribodyn.compiled import source_digest
from tribodyn.compiled.cache import cached_njit
from tribodyn.compiled.jit import INNER, JIT
from tribodyn.types import Array

_DIGEST = source_digest(Path(__file__).parent, [Path(__file__).stem])


@nb.njit(**INNER)
def _cubic_weights(knots: Array, x: float, weights: Array) -> int:
    """Values of the four cubic B-splines at a place; returns the number of the first one."""
    last = knots.size - 5
    low, high = 3, last
    while low < high:
        middle = (low + high + 1) // 2
        if knots[middle] <= x:
            low = middle
        else:
            high = middle - 1
    weights[0] = 1.0
    for k in range(1, 4):
        carried = 0.0
        for r in range(k):
            right, left = knots[low + 1 + r], knots[low + 1 + r - k]
            part = weights[r] / (right - left)
            weights[r] = carried + (right - x) * part
            carried = (x - left) * part
        weights[k] = carried
    return low - 3


@cached_njit(_DIGEST, "the compliance between slices", "five seconds", **JIT)
def fill_compliance(
    table: Array, knots: Array, widths: Array, radii: Array, sense: int, out: Array
) -> None:
    """Add the compliance between all contacts of all phases."""
    phases, pairs, slices = radii.shape
    most = table.shape[0] - 1
    first, weight = np.empty((pairs, slices), np.int64), np.empty((pairs, slices, 4))
    for p in range(phases):
        for i in range(pairs):
            for k in range(slices):
                x = min(max(radii[p, i, k] ** 2, knots[0]), knots[-1])
                first[i, k] = _cubic_weights(knots, x, weight[i, k])
        for i in range(pairs):
            for j in range(pairs):
                step = (j - i) * sense
                # the other side follows by reciprocity
                if step < 0 or step > most or (step == 0 and i != j):
                    continue
                for k in range(slices):
                    for m in range(slices):
                        if i == j and m < k:
                            continue
                        total = 0.0
                        for a in range(4):
                            row = 0.0
                            for b in range(4):
                                row += (
                                    weight[j, m, b]
                                    * table[step, k, m, first[i, k] + a, first[j, m] + b]
                                )
                            total += weight[i, k, a] * row
                        loaded, displaced = i * slices + k, j * slices + m
                        out[p, displaced, loaded] += total / widths[m]
                        if loaded != displaced:
                            out[p, loaded, displaced] += total / widths[k]
