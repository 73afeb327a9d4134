"""The search for a fixed point: settle, accelerate, finish with Newton's method."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tribodyn.dynamics.anderson import anderson
from tribodyn.dynamics.orbit_map import OrbitMap

__all__ = ["OrbitPoint", "find_orbit"]

Array = NDArray[np.float64]

#: Plain periods before acceleration: a linear system, and at most with dead zones, where they
#: keep a start in its own basin of attraction.
_SETTLE, _SETTLE_DEAD_ZONE = 3, 24
#: A disturbance this small relative to the orbit no longer changes the basin.
_SETTLED = 1e-3
_ANDERSON_LIMIT = 40
_NEWTON_LIMIT = 8
#: Plain periods of each further attempt, and attempts.
_PATIENCE = (150, 400)
#: Size of the disturbances of the monodromy matrix relative to the orbit.
_DISTURBANCE = 1e-6


@dataclass
class OrbitPoint:
    """A point of the map with its residual and the matrix of the map.

    Parameters
    ----------
    point, residual : (k,) array
        Reduced vector and what the map adds to it [m/s].
    matrix : (k, k) array
        Derivative of the map, the monodromy matrix [-].
    scale : float
        Size of the motion [m/s].
    multipliers : (m,) complex array
        Floquet multipliers, the largest first.
    """

    point: Array
    residual: Array
    matrix: Array
    scale: float
    multipliers: NDArray[np.complex128]

    @property
    def correction(self) -> Array:
        """Newton step to the fixed point, (k,)."""
        identity = np.eye(self.matrix.shape[0])
        step, *_ = np.linalg.lstsq(identity - self.matrix, self.residual, rcond=None)
        return np.asarray(step, dtype=float)

    @property
    def error(self) -> float:
        """Distance to the orbit over its size; at least the rounding of the map."""
        return float(np.linalg.norm(self.correction)) / self.scale


def _examine(mapping: OrbitMap, y: Array, scale: float) -> OrbitPoint:
    """Evaluate the map and its matrix at a point."""
    image = mapping(y)
    # Of a linear map any difference is exact, and a large one loses no digits.
    step = scale if mapping.affine else _DISTURBANCE * scale
    matrix = (mapping(y + step * np.eye(y.size)) - image).T / step
    return OrbitPoint(y, image - y, matrix, scale, mapping.multipliers(matrix))


def _newton(mapping: OrbitMap, y: Array, scale: float, tolerance: float) -> OrbitPoint:
    best = _examine(mapping, y, scale)
    for _ in range(_NEWTON_LIMIT):
        if best.error <= 0.01 * tolerance:
            break
        trial = _examine(mapping, best.point + best.correction, scale)
        if not trial.error < 0.5 * best.error:
            break
        best = trial
    return best


def _settle(mapping: OrbitMap, y: Array, periods: int) -> tuple[Array, float]:
    """March plain periods until little changes; returns the point and the size of the motion."""
    scale = 0.0
    for count in range(periods):
        new = mapping(y)
        if count % 8 == 0:
            record = mapping.coordinates.reduce(mapping.record(new)[0])
            scale = float(np.linalg.norm(record, axis=1).max()) or 1.0
        change = float(np.linalg.norm(new - y))
        y = new
        if count >= _SETTLE - 1 and change < _SETTLED * scale:
            break
    return y, scale


def find_orbit(mapping: OrbitMap, y: Array, tolerance: float) -> OrbitPoint:
    """Settle, accelerate, finish; with more and more plain marching if that is not enough.

    Parameters
    ----------
    mapping : OrbitMap
    y : (k,) array
        Reduced vector to start from [m/s].
    tolerance : float
        Certified error that is good enough [-].

    Returns
    -------
    OrbitPoint
        The last attempt, whether or not it meets the tolerance.
    """
    periods = _SETTLE if mapping.affine else _SETTLE_DEAD_ZONE
    for patience in (0, *_PATIENCE):
        y, scale = _settle(mapping, y, max(periods, patience))
        near, _, _ = anderson(mapping, y, tolerance=1e-3 * tolerance, limit=_ANDERSON_LIMIT)
        orbit = _newton(mapping, near, scale, tolerance)
        settled = np.abs(orbit.multipliers[:1]).max(initial=0.0) <= 1.0 + 1e-6
        if orbit.error <= tolerance and settled:
            break
        if orbit.error <= tolerance:
            # Accurate but unstable: a motion would leave it, so the search goes on beside it.
            generator = np.random.default_rng(0)
            y = orbit.point + _SETTLED * scale * generator.standard_normal(y.size)
    return orbit
