"""Anderson acceleration of a fixed-point iteration: type II of Fang and Saad (2009), (24)."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from tribodyn.types import Array


def anderson(
    function: Callable[[Array], Array],
    start: Array,
    *,
    tolerance: float,
    limit: int,
    depth: int = 8,
) -> tuple[Array, Array, int]:
    """Iterate ``y = function(y)`` to a fixed point: the best one, its residual, evaluations."""
    y = start.copy()
    points: list[Array] = []
    residuals: list[Array] = []
    best = (np.inf, y, np.zeros_like(y))
    for count in range(1, limit + 1):
        residual = function(y) - y
        size = float(np.linalg.norm(residual))
        if size < best[0]:
            best = (size, y, residual)
        if size <= tolerance * max(float(np.linalg.norm(y)), 1e-300):
            return y, residual, count
        if size > 10.0 * best[0]:
            points, residuals = points[-1:], residuals[-1:]
        points.append(y)
        residuals.append(residual)
        points, residuals = points[-depth - 1 :], residuals[-depth - 1 :]
        y = _combine(points, residuals)
    return best[1], best[2], limit


def _combine(points: list[Array], residuals: list[Array]) -> Array:
    image = points[-1] + residuals[-1]
    if len(points) == 1:
        return image
    delta_y = np.diff(np.array(points), axis=0).T
    delta_r = np.diff(np.array(residuals), axis=0).T
    scale = np.linalg.norm(delta_r, axis=0)
    scale[scale == 0.0] = 1.0
    weights, *_ = np.linalg.lstsq(delta_r / scale, residuals[-1], rcond=1e-12)
    combined: Array = image - ((delta_y + delta_r) / scale) @ weights
    return combined
