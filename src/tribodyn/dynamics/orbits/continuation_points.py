"""Special points of a branch: where a test function changes its sign, located along the chord."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from tribodyn.dynamics.orbits.continuation_corrector import (
    BranchPoint,
    StalledError,
    correct,
    tangent_at,
)
from tribodyn.dynamics.orbits.continuation_map import ParameterMap

Test = Callable[[BranchPoint], float]

_ITERATIONS = 40
#: Width of the bracket on the chord at which a point is located.
_WIDTH = 1e-10
#: Largest distance of the critical multiplier from the unit circle at such a point.
_CRITICAL = 1e-3
#: Change of the scaled parameter along a branch that is nothing but rounding.
_UPRIGHT = 1e-7


@dataclass(frozen=True)
class Located:
    """A special point."""

    kind: str  #: what happens there
    after: int  #: number of the point of the branch before it
    point: BranchPoint


def _fold(point: BranchPoint) -> float:
    # A branch of a linear motion that loses its stability stands upright: no sign to speak of.
    along = float(point.tangent[-1])
    return along if abs(along) > _UPRIGHT else 0.0


def _period_doubling(point: BranchPoint) -> float:
    """Product of ``1 + mu``."""
    return float(np.prod(1.0 + point.multipliers).real)


def _neimark_sacker(point: BranchPoint) -> float:
    """Product of ``mu_i mu_j - 1`` over all pairs."""
    i, j = np.triu_indices(point.multipliers.size, 1)
    return float(np.prod(point.multipliers[i] * point.multipliers[j] - 1.0).real)


def _branch_point(point: BranchPoint) -> float:
    """Determinant of the bordered matrix: it vanishes where two branches cross."""
    return float(np.linalg.det(point.jet.border(point.tangent)))


def _is_doubling(point: BranchPoint) -> bool:
    return bool(np.abs(point.multipliers + 1.0).min(initial=np.inf) < _CRITICAL)


def _is_torus(point: BranchPoint) -> bool:
    # A real pair with the product 1 makes the same test vanish but changes no stability.
    pair = point.multipliers[np.abs(point.multipliers.imag) > 1e-6]
    return bool(np.abs(np.abs(pair) - 1.0).min(initial=np.inf) < _CRITICAL)


def _is_crossing(point: BranchPoint) -> bool:
    return bool(np.abs(point.multipliers - 1.0).min(initial=np.inf) < _CRITICAL)


def _always(point: BranchPoint) -> bool:
    return True


def tests_of_multipliers() -> dict[str, tuple[Test, Callable[[BranchPoint], bool]]]:
    """Test functions of the multipliers by the kind of point, and what holds at such a point."""
    return {
        "fold": (_fold, _always),
        "period-doubling": (_period_doubling, _is_doubling),
        "neimark-sacker": (_neimark_sacker, _is_torus),
        "branch-point": (_branch_point, _is_crossing),
    }


def locate(
    function: ParameterMap,
    points: list[BranchPoint],
    kind: str,
    test: Test,
    holds: Callable[[BranchPoint], bool],
    tolerance: float,
) -> list[Located]:
    """Find where a test function changes its sign."""
    values = [test(point) for point in points]
    found = []
    for number, (left, right) in enumerate(pairwise(values)):
        if left * right < 0.0 or (right == 0.0 and left != 0.0 and test is not _fold):
            ends = (points[number], points[number + 1])
            point = _between(function, ends, (left, right), test, tolerance)
            if holds(point):
                found.append(Located(kind, number, point))
    return found


def _between(
    function: ParameterMap,
    ends: tuple[BranchPoint, BranchPoint],
    values: tuple[float, float],
    test: Test,
    tolerance: float,
) -> BranchPoint:
    """Regula falsi with the weight of a kept end halved, on the chord of two points."""
    chord = ends[1].x - ends[0].x
    row = chord / np.linalg.norm(chord)
    (low, high), (left, right) = (0.0, 1.0), values
    best = min(zip(ends, values, strict=True), key=lambda pair: abs(pair[1]))[0]
    for _ in range(_ITERATIONS):
        part = low + (high - low) * left / (left - right)
        try:
            guess = ends[0].x + part * chord
            best = correct(function, guess, row, best.jet, tolerance)
        except StalledError:
            break
        value = test(best)
        if value == 0.0:
            break
        if value * right < 0.0:
            moved, low, high = abs(high - part), high, part
            left, right = right, value
        else:
            moved, high, right, left = abs(high - part), part, value, 0.5 * left
        if moved < _WIDTH or abs(high - low) < _WIDTH:
            break
    oriented = tangent_at(best.jet, ends[0].tangent)
    return BranchPoint(best.x, oriented, best.jet, best.multipliers, best.error, best.effort)
