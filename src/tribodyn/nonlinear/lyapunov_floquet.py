"""Exponents of a motion whose disturbances see the same matrices again and again.

They are the logarithms of the Floquet multipliers. The multipliers may differ by more than a
product of matrices can hold, so that they are read off the orthogonal frame, block by block.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from tribodyn.types import Array

#: Mesh cycles after which matrices may repeat, and how closely.
_PERIODS = 16
_REPEATS = 1e-8
#: Blocks of the frame are apart when they exchange less than this.
_APART = 1e-10


def repeats_after(cycles: Sequence[Array]) -> tuple[int, float]:
    """Tell after how many mesh cycles the matrices repeat."""
    known = np.asarray(cycles)
    size = np.linalg.norm(known, axis=(-2, -1))
    for period in range(1, min(_PERIODS, len(known) // 2) + 1):
        apart = np.linalg.norm(known[period:] - known[:-period], axis=(-2, -1)) / size[period:]
        if apart.max() <= _REPEATS:
            return period, float(apart.max())
    return 0, float("nan")


def floquet_growth(cycles: Sequence[Array], frame: Array) -> Array:
    """Growth of disturbances over one period, from matrices and a frame that has turned in."""
    old, uppers = frame, []
    for product in (product for groups in cycles for product in groups):
        frame, upper = np.linalg.qr(product @ frame)
        uppers.append(upper)
    turn = old.T @ frame
    size = turn.shape[0]
    edges = [0, *(i for i in range(1, size) if np.abs(turn[i:, :i]).max() < _APART), size]
    growth = np.zeros(size)
    for first, last in pairwise(edges):
        block, scale = np.eye(last - first), 0.0
        for upper in uppers:
            block = upper[first:last, first:last] @ block
            norm = float(np.linalg.norm(block))
            block, scale = block / norm, scale + float(np.log(norm))
        values = np.linalg.eigvals(turn[first:last, first:last] @ block)
        growth[first:last] = np.log(np.abs(values)) + scale
    return np.asarray(np.sort(growth)[::-1])
