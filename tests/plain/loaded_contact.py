"""The loaded tooth contact in plain NumPy and SciPy: slow, readable, and independent of the kernel.

Finds the loads of one phase as the solution of a complementarity problem by trying every set of
touching pairs, which the kernel never does.
"""

from __future__ import annotations

from itertools import combinations

import numpy as np

from tribodyn.types import Array, Index


def plain_loads(
    structure: Array, local: Array, logarithm: float, gaps: Array, approach: float
) -> Array:
    """Loads of one slice at an approach."""
    from scipy.optimize import root

    scale = max(approach - gaps.min(), 0.0) / np.mean(np.diag(structure) + local)
    if scale == 0.0:
        return np.zeros(gaps.size)
    for count in range(gaps.size, 0, -1):
        for chosen in combinations(range(gaps.size), count):
            place = np.array(chosen)

            def excess(loads: Array, place: Index = place) -> Array:
                f = np.abs(loads) * scale
                compressed = f * (local[place] - logarithm * np.log(f + 1e-300))
                inner = structure[np.ix_(place, place)] @ f
                return np.asarray((gaps[place] + inner + compressed) / approach - 1.0)

            solution = root(excess, np.full(count, 0.3), method="hybr", options={"xtol": 1e-14})
            f = np.zeros(gaps.size)
            f[place] = np.abs(solution.x) * scale
            solved = np.max(np.abs(excess(solution.x))) < 1e-10
            clearance = gaps + structure @ f - approach
            others = np.setdiff1d(np.arange(gaps.size), place)
            if solved and np.all(clearance[others] >= -1e-12 * approach):
                return f
    return np.zeros(gaps.size)


def plain_approach(
    structure: Array,
    local: Array,
    logarithm: float,
    gaps: Array,
    widths: Array,
    total: float,
) -> float:
    """Approach at which all slices together carry a force."""
    from scipy.optimize import brentq

    def missing(approach: float) -> float:
        loads = [plain_loads(structure, local, logarithm, row, approach) for row in gaps]
        return float(widths @ np.sum(loads, axis=1)) - total

    least = float(gaps.min())
    high = least + 1e-6
    while missing(high) < 0.0:
        high = least + 2.0 * (high - least)
    return float(brentq(missing, least, high, xtol=1e-17, rtol=1e-14))
