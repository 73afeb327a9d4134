"""Least point of an objective over amount and length: a map, and simplexes from its best points."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from tribodyn.nomenclature import require_whole
from tribodyn.types import Array

#: Points of the map from which the search goes on: the best one, and others that lie apart.
_STARTS = 3
#: Steps of a simplex; it ends when neither place nor value move by more than these parts.
_SIMPLEX = {"maxfev": 200, "xatol": 1e-4, "fatol": 1e-5}


def least_point(
    value: Callable[[Array], float], axes: list[Array], mapped: Array, digits: int | None = None
) -> tuple[tuple[float, float], float]:
    """Amount and length of the least objective, rounded to digits, and the objective there."""
    digits = None if digits is None else require_whole("digits", digits)
    from scipy.optimize import minimize

    low = np.array([axis[0] for axis in axes])
    span = np.array([axis[-1] - axis[0] for axis in axes])
    starts = _starts(mapped)
    first = starts[0]
    best, least = np.array([axes[k][first[k]] for k in (0, 1)]), float(mapped[first])
    step = [0.5 / (axis.size - 1) for axis in axes]
    for row, column in starts:
        start = (np.array([axes[0][row], axes[1][column]]) - low) / span
        toward = np.where(start + step > 1.0, -1.0, 1.0) * step
        simplex = start + np.array([[0.0, 0.0], [toward[0], 0.0], [0.0, toward[1]]])
        minimum = minimize(
            lambda unit: value(low + span * unit) / mapped.max(),
            start,
            method="Nelder-Mead",
            bounds=[(0.0, 1.0), (0.0, 1.0)],
            options={"initial_simplex": simplex, **_SIMPLEX},
        )
        place = low + span * np.clip(minimum.x, 0.0, 1.0)
        objective = value(place)
        if objective < least:
            best, least = place, objective
    if digits is None:
        return (float(best[0]), float(best[1])), least
    amount, length = (
        _rounded(float(x), axis[-1], digits) for x, axis in zip(best, axes, strict=True)
    )
    return (amount, length), value(np.array([amount, length]))


def _starts(mapped: Array) -> list[tuple[int, int]]:
    """Rows and columns of the least local minima of the map, the least of all first."""
    padded = np.pad(mapped, 1, constant_values=np.inf)
    rows, columns = mapped.shape
    around = [
        padded[1 + i : 1 + i + rows, 1 + j : 1 + j + columns]
        for i in (-1, 0, 1)
        for j in (-1, 0, 1)
        if (i, j) != (0, 0)
    ]
    valleys = np.argwhere(mapped <= np.min(around, axis=0))
    order = np.argsort([mapped[row, column] for row, column in valleys], kind="stable")
    return [(int(row), int(column)) for row, column in valleys[order[:_STARTS]]]


def _rounded(value: float, most: float, digits: int) -> float:
    """Value with so many significant digits, but not above the most that is allowed."""
    nearest = float(f"{value:.{digits - 1}e}")
    if nearest <= most or value == 0.0:
        return nearest
    step = 10.0 ** (math.floor(math.log10(value)) - digits + 1)
    return float(f"{math.floor(value / step) * step:.{digits - 1}e}")
