"""Steps along a branch: predict along the tangent, correct across it, adapt the length."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from tribodyn.dynamics.orbits.continuation_corrector import (
    BranchPoint,
    StalledError,
    correct,
    tangent_at,
)
from tribodyn.dynamics.orbits.continuation_map import ParameterMap
from tribodyn.progress import Progress
from tribodyn.types import Array

#: Least cosine of the angle between neighbouring tangents: a larger turn may be another branch.
_STRAIGHT = 0.8
#: Shortest step, and the longest that may turn at a kink, relative to the longest.
_SHORTEST, _TURN = 1e-5, 1e-3
#: Longest step of the state, relative to the motion.
_STATE = 0.25
#: Iterations of an easy and of a hard point.
_EASY, _HARD = 6, 9


@dataclass(frozen=True)
class Stepping:
    """How to go along a branch."""

    longest: float  #: longest step in the parameter, relative to the range
    points: int  #: points at most
    tolerance: float  #: largest error of a point, relative to the motion


def _inside(x: Array) -> bool:
    return bool(0.0 <= x[-1] <= 1.0)


def hold(size: int) -> Array:
    """Plane of constant parameter."""
    row = np.zeros(size)
    row[-1] = 1.0
    return row


def _last(
    function: ParameterMap, before: BranchPoint, beyond: BranchPoint, tolerance: float
) -> BranchPoint | None:
    """Point at the end of the range, between one inside and one outside."""
    return _at(function, before, beyond, 1.0 if beyond.x[-1] > 1.0 else 0.0, tolerance)


def _at(
    function: ParameterMap,
    before: BranchPoint,
    beyond: BranchPoint,
    end: float,
    tolerance: float,
) -> BranchPoint | None:
    """Point at a scaled parameter between those of two neighbours."""
    part = (end - before.x[-1]) / (beyond.x[-1] - before.x[-1])
    guess = before.x + part * (beyond.x - before.x)
    guess[-1] = end
    nearer = before if part < 0.5 else beyond
    try:
        found = correct(function, guess, hold(guess.size), nearer.jet, tolerance)
    except StalledError:
        return None
    return replace(found, tangent=tangent_at(found.jet, before.tangent))


def with_values(
    function: ParameterMap, points: list[BranchPoint], values: Array, tolerance: float
) -> list[BranchPoint]:
    """Add the points of a branch at given parameters, as often as it passes them."""
    scaled = (np.asarray(values, dtype=float) - function.origin) / function.range
    made = points[:1]
    for left, right in pairwise(points):
        low, high = sorted((float(left.x[-1]), float(right.x[-1])))
        inside = np.sort(scaled[(scaled > low) & (scaled < high)])
        for value in inside if right.x[-1] > left.x[-1] else inside[::-1]:
            found = _at(function, left, right, float(value), tolerance)
            made += [found] if found is not None else []
        made.append(right)
    return made


def _closes(points: list[BranchPoint], new: BranchPoint) -> bool:
    """Whether the branch has come back to its first point."""
    if len(points) < 8:
        return False
    first, last = points[0], points[-1]
    step = new.x - last.x
    part = float((first.x - last.x) @ step / (step @ step))
    across = np.linalg.norm(first.x - last.x - part * step)
    same = float(first.tangent @ new.tangent) > _STRAIGHT
    return bool(same and 0.0 < part <= 1.0 and across < 0.2 * np.linalg.norm(step))


def follow(
    function: ParameterMap, first: BranchPoint, stepping: Stepping, progress: Progress
) -> tuple[list[BranchPoint], str, bool]:
    """Go along a branch until it leaves the range, closes, ends or has enough points."""
    points, length = [first], 0.25
    reason, worst = "", ""
    while not reason:
        here = points[-1]
        weight = _weight(here.x, stepping)
        along = here.tangent / np.linalg.norm(weight * here.tangent)
        row = weight**2 * along
        turned, new = False, None
        try:
            guess = here.x + length * along
            new = correct(function, guess, row / np.linalg.norm(row), here.jet, stepping.tolerance)
            turned = _cosine(weight * new.tangent, weight * along) < _STRAIGHT
            worst = "the branch turns sharply" if turned else ""
            if np.linalg.norm(weight * (new.x - guess)) > length:
                new, worst = None, "the next orbit found is far away"
        except StalledError as stalled:
            worst = f"the residual stays at {stalled.residual:.2e}"
        if new is None or (turned and length > _TURN):
            length = 0.5 * length
            if length < _SHORTEST:
                return points, _stopped(function, here, worst), False
            continue
        progress.advance(1)
        if not _inside(new.x):
            end = _last(function, here, new, stepping.tolerance)
            points += [end] if end is not None else []
            reason = f"left the range at {function.parameter(np.clip(new.x, 0.0, 1.0)):.10g}"
            break
        reason = "closed" if _closes(points, new) else ""
        points.append(new)
        factor = 1.5 if new.effort <= _EASY else 0.7 if new.effort >= _HARD else 1.0
        length = min(1.0, factor * length)
        if not reason and len(points) >= stepping.points:
            reason = f"{stepping.points} points, the last at {function.parameter(new.x):.10g}"
    return points, reason, True


def _weight(x: Array, stepping: Stepping) -> Array:
    """Weights in which the longest step has the length 1, in the state or in the parameter."""
    weight = np.full(x.size, 1.0 / (_STATE * max(1.0, float(np.linalg.norm(x[:-1])))))
    weight[-1] = 1.0 / stepping.longest
    return weight


def _cosine(one: Array, other: Array) -> float:
    return float(one @ other / (np.linalg.norm(one) * np.linalg.norm(other)))


def _stopped(function: ParameterMap, here: BranchPoint, worst: str) -> str:
    return (
        f"stopped at {function.parameter(here.x):.10g}, the largest multiplier being "
        f"{np.abs(here.multipliers[:1]).max(initial=0.0):.6g}: {worst}, however short the step"
    )
