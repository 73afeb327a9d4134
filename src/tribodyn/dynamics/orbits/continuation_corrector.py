"""From a guess to a point of the branch: damped Newton's method with a border.

The matrix of the last point is kept, with Broyden's update, as long as it brings the residual
down; where a contact begins to open the map has a kink, the matrix is taken anew and the step is
halved until the residual falls.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tribodyn.dynamics.orbits.continuation_map import Jet, ParameterMap
from tribodyn.errors import ComputationError
from tribodyn.types import Array, ComplexArray

_ITERATIONS = 14
_HALVINGS = 4
#: A kept matrix has to bring the residual down at least by this factor.
_CONTRACTION = 0.3


@dataclass(frozen=True)
class BranchPoint:
    """A point of the branch."""

    x: Array  #: scaled state and parameter [-]
    tangent: Array  #: unit vector along the branch [-]
    jet: Jet  #: the map at the point
    multipliers: ComplexArray  #: floquet multipliers, the largest first
    error: float  #: distance to the branch relative to the size of the motion [-]
    effort: int  #: iterations of the corrector


class StalledError(Exception):
    """The corrector found no point."""

    def __init__(self, residual: float) -> None:
        super().__init__(f"residual {residual:.2e}")
        self.residual = residual


def tangent_at(jet: Jet, along: Array) -> Array:
    """Direction of the branch at a point."""
    last = np.zeros(along.size)
    last[-1] = 1.0
    found = np.linalg.lstsq(jet.border(along), last, rcond=None)[0]
    return np.asarray(found / np.linalg.norm(found))


def _norm(function: ParameterMap, x: Array, row: Array, guess: Array) -> tuple[Array, float]:
    try:
        value = np.append(function.residual(x), row @ (x - guess))
    except ComputationError:  # a motion that grows without bound is a step too far
        return np.full(x.size, np.inf), np.inf
    return value, float(np.linalg.norm(value))


def correct(
    function: ParameterMap, guess: Array, row: Array, jet: Jet | None, tolerance: float
) -> BranchPoint:
    """Find the point of the branch in the plane through the guess."""
    x, fresh = guess.copy(), jet is None
    value, size = _norm(function, x, row, guess)
    if not np.isfinite(size):
        raise StalledError(size)
    border = (function.jet(x) if jet is None else jet).border(row)
    for count in range(1, _ITERATIONS + 1):
        step = -np.linalg.lstsq(border, value, rcond=None)[0]
        for halving in range(_HALVINGS if fresh else 1):
            trial = x + step * 0.5**halving
            new, new_size = _norm(function, trial, row, guess)
            if new_size < (0.9 if fresh else _CONTRACTION) * size:
                break
        moved = trial - x
        contraction = new_size / size if size else 0.0
        # What is left to go is the last step times the contraction; rounding ends it too.
        left = float(np.linalg.norm(moved)) * (min(contraction, 1.0) if contraction < 0.1 else 1.0)
        if left <= 0.5 * tolerance and np.isfinite(new_size):
            return _accept(function, trial if new_size < size else x, row, count)
        if new_size < size:
            # Broyden's update: the matrix learns from the step that was taken.
            border = border + np.outer(new - value - border @ moved, moved) / (moved @ moved)
            x, value, size = trial, new, new_size
        elif fresh:
            break
        if contraction > _CONTRACTION:
            border, fresh = function.jet(x).border(row), True
        else:
            fresh = False
    raise StalledError(size)


def _accept(function: ParameterMap, x: Array, row: Array, count: int) -> BranchPoint:
    jet = function.jet(x)
    left = np.linalg.lstsq(jet.border(row), np.append(jet.residual, 0.0), rcond=None)[0]
    error = max(float(np.linalg.norm(left)), float(np.finfo(float).eps))
    mapping = function.at(function.parameter(x))
    return BranchPoint(x, tangent_at(jet, row), jet, mapping.multipliers(jet.matrix), error, count)
