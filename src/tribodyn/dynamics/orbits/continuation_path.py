"""Steps along a branch of periodic orbits: predict along the tangent, correct across it.

State and parameter are scaled, so that one length measures both: states by the size of the first
orbit, the parameter by its range. The corrector is a damped Newton's method with a bordered matrix.
The matrix is reused, with Broyden's update, as long as it reduces the residual; where a contact
begins to open the map has a kink, the matrix is recomputed and the step is halved until the
residual falls. Special points lie where a test function changes its sign.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

import numpy as np

from tribodyn.dynamics.equations.compiled import Compiled
from tribodyn.dynamics.equations.orbit_coordinates import OrbitCoordinates
from tribodyn.dynamics.equations.system import System
from tribodyn.dynamics.modal.modal_march import compile_motion
from tribodyn.dynamics.orbits.orbit_map import OrbitMap
from tribodyn.errors import ComputationError, InputError
from tribodyn.progress import Progress
from tribodyn.types import Array, ComplexArray

#: Half of the differences that give the matrix of a map with dead zones, and the slope along the
#: parameter, relative to the motion and to the range.
_DISTURBANCE, _PARAMETER_DISTURBANCE = 3e-6, 1e-6
#: Iterations of the corrector, and of the search for a special point.
_ITERATIONS, _BISECTIONS = 14, 40
_HALVINGS = 4
#: A reused matrix has to reduce the residual at least by this factor.
_CONTRACTION = 0.3
#: Least cosine of the angle between neighbouring tangents: a larger turn may be another branch.
_STRAIGHT = 0.8
#: Shortest step, and the longest that may turn at a kink, relative to the longest.
_SHORTEST, _TURN = 1e-5, 1e-3
#: Longest step of the state, relative to the motion.
_STATE = 0.25
#: Iterations of an easy and of a hard point.
_EASY, _HARD = 6, 9
#: Width of the bracket on the chord at which a point is located.
_WIDTH = 1e-10
#: Largest distance of the critical multiplier from the unit circle at such a point.
_CRITICAL = 1e-3
#: Multipliers below this are those of motions that are gone after a period.
_GONE = 1e-3
#: Change of the scaled parameter along a branch that is mere rounding.
_UPRIGHT = 1e-7


class Family:
    """Systems that differ by one parameter, each with its mesh frequency."""

    def __init__(
        self,
        make: System | Callable[[float], Any],
        mesh_frequency: float | None,
        steps: int,
        lowest: float,
    ) -> None:
        self._make, self._frequency, self._steps = make, mesh_frequency, steps
        # The slowest cycle has the longest steps.
        self._compiled = compile_motion(make, lowest, steps) if isinstance(make, System) else None

    def __call__(self, parameter: float) -> tuple[Compiled, float]:
        """Compile the system of one parameter; returns it with its mesh frequency."""
        if self._compiled is not None or isinstance(self._make, System):
            assert self._compiled is not None
            return self._compiled, parameter
        result = self._make(parameter)
        system, frequency = result if isinstance(result, tuple) else (result, self._frequency)
        if isinstance(system, Compiled) and frequency is not None:
            return system, float(frequency)
        if not isinstance(system, System) or frequency is None:
            raise InputError(
                f"the function of the parameter returned {type(result).__name__}"
                + ("" if frequency is not None else " and there is no argument mesh_frequency"),
                where="argument make_system",
                why="It has to return a System and mesh_frequency is set, or a tuple (System, "
                "mesh frequency)",
                remedy="Return one of the two",
            )
        return compile_motion(system, float(frequency), self._steps), float(frequency)


@dataclass(frozen=True)
class Jet:
    """The map at one point with its derivatives, all scaled."""

    residual: Array  #: image minus the point [-]
    matrix: Array  #: derivative with respect to the point, the monodromy matrix [-]
    slope: Array  #: derivative with respect to the parameter [-]

    def border(self, row: Array) -> Array:
        """Matrix of Newton's method with one more equation."""
        top = np.column_stack((self.matrix - np.eye(self.residual.size), self.slope))
        return np.vstack((top, row))


class FamilyMap:
    """The scaled map of a point ``x = (state / size, (parameter - low) / range)``."""

    def __init__(
        self, family: Family, periods: int, between: tuple[float, float], tolerance: float
    ) -> None:
        self.family, self.periods = family, periods
        self.origin, self.range = between[0], between[1] - between[0]
        #: Largest error of a point, relative to the motion.
        self.tolerance = tolerance
        self.size = 1.0
        self.cycles = 0
        self._coordinates: OrbitCoordinates | None = None
        self._latest: tuple[float, OrbitMap] | None = None

    def parameter(self, x: Array) -> float:
        """Parameter of a point."""
        return float(self.origin + self.range * x[-1])

    def at(self, parameter: float) -> OrbitMap:
        """The map at one parameter; the latest one is cached."""
        if self._latest is not None and self._latest[0] == parameter:
            return self._latest[1]
        compiled, frequency = self.family(parameter)
        mapping = OrbitMap(compiled, frequency, self.periods, self._coordinates, None)
        self._coordinates = mapping.coordinates
        self._latest = (parameter, mapping)
        return mapping

    def reduced(self, x: Array) -> Array:
        """Reduced vector of a point, without the scale."""
        return np.asarray(x[:-1] * self.size)

    def residual(self, x: Array) -> Array:
        """Scaled image of a point minus the point."""
        y = self.reduced(x)
        self.cycles += self.periods
        return np.asarray((self.at(self.parameter(x))(y) - y) / self.size)

    def jet(self, x: Array) -> Jet:
        """Evaluate the map at a point and next to it."""
        u, parameter, delta = x[:-1], self.parameter(x), _PARAMETER_DISTURBANCE
        sides = [self.at(parameter + sign * delta * self.range)(u * self.size) for sign in (-1, 1)]
        mapping, linear = self.at(parameter), self.at(parameter).affine
        step = self.size * (1.0 if linear else _DISTURBANCE)
        image, matrix = mapping.matrix(u * self.size, step, central=not linear)
        self.cycles += self.periods * (u.size * (1 if linear else 2) + 3)
        slope = (sides[1] - sides[0]) / (2.0 * delta * self.size)
        return Jet(image / self.size - u, matrix, slope)


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
    direction = np.linalg.lstsq(jet.border(along), hold(along.size), rcond=None)[0]
    return np.asarray(direction / np.linalg.norm(direction))


def _norm(function: FamilyMap, x: Array, row: Array, guess: Array) -> tuple[Array, float]:
    try:
        value = np.append(function.residual(x), row @ (x - guess))
    except ComputationError:  # a motion that grows without bound is a step too far
        return np.full(x.size, np.inf), np.inf
    return value, float(np.linalg.norm(value))


def correct(function: FamilyMap, guess: Array, row: Array, jet: Jet | None) -> BranchPoint:
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
        # The remaining distance is the last step times the contraction; rounding ends it too.
        left = float(np.linalg.norm(moved)) * (min(contraction, 1.0) if contraction < 0.1 else 1.0)
        if left <= 0.5 * function.tolerance and np.isfinite(new_size):
            return _accept(function, trial if new_size < size else x, row, count)
        if new_size < size:
            # Broyden's update of the matrix.
            border = border + np.outer(new - value - border @ moved, moved) / (moved @ moved)
            x, value, size = trial, new, new_size
        elif fresh:
            break
        if contraction > _CONTRACTION:
            border, fresh = function.jet(x).border(row), True
        else:
            fresh = False
    raise StalledError(size)


def _accept(function: FamilyMap, x: Array, row: Array, count: int) -> BranchPoint:
    jet = function.jet(x)
    left = np.linalg.lstsq(jet.border(row), np.append(jet.residual, 0.0), rcond=None)[0]
    error = max(float(np.linalg.norm(left)), float(np.finfo(float).eps))
    mapping = function.at(function.parameter(x))
    return BranchPoint(x, tangent_at(jet, row), jet, mapping.multipliers(jet.matrix), error, count)


@dataclass(frozen=True)
class Stepping:
    """Step control along a branch."""

    longest: float  #: longest step in the parameter, relative to the range
    points: int  #: points at most


def _inside(x: Array) -> bool:
    return bool(0.0 <= x[-1] <= 1.0)


def hold(size: int) -> Array:
    """Plane of constant parameter."""
    row = np.zeros(size)
    row[-1] = 1.0
    return row


def _at(
    function: FamilyMap, before: BranchPoint, beyond: BranchPoint, end: float
) -> BranchPoint | None:
    """Point at a scaled parameter between those of two neighbours."""
    part = (end - before.x[-1]) / (beyond.x[-1] - before.x[-1])
    guess = before.x + part * (beyond.x - before.x)
    guess[-1] = end
    nearer = before if part < 0.5 else beyond
    try:
        point = correct(function, guess, hold(guess.size), nearer.jet)
    except StalledError:
        return None
    return replace(point, tangent=tangent_at(point.jet, before.tangent))


def with_values(function: FamilyMap, points: list[BranchPoint], values: Array) -> list[BranchPoint]:
    """Add the points of a branch at ``values`` of the parameter, as often as it passes them."""
    scaled = (np.asarray(values, dtype=float) - function.origin) / function.range
    joined = points[:1]
    for left, right in pairwise(points):
        low, high = sorted((float(left.x[-1]), float(right.x[-1])))
        inside = np.sort(scaled[(scaled > low) & (scaled < high)])
        for value in inside if right.x[-1] > left.x[-1] else inside[::-1]:
            point = _at(function, left, right, float(value))
            joined += [point] if point is not None else []
        joined.append(right)
    return joined


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
    function: FamilyMap, first: BranchPoint, stepping: Stepping, progress: Progress
) -> tuple[list[BranchPoint], str, bool]:
    """Follow a branch until it leaves the range, closes, ends or has enough points."""
    points, length = [first], 0.25
    reason, worst = "", ""
    while not reason:
        current = points[-1]
        weight = _weight(current.x, stepping)
        along = current.tangent / np.linalg.norm(weight * current.tangent)
        row = weight**2 * along
        turned, new = False, None
        try:
            guess = current.x + length * along
            new = correct(function, guess, row / np.linalg.norm(row), current.jet)
            turned = _cosine(weight * new.tangent, weight * along) < _STRAIGHT
            worst = "the branch turns sharply" if turned else ""
            if np.linalg.norm(weight * (new.x - guess)) > length:
                new, worst = None, "the next orbit is far away"
        except StalledError as stalled:
            worst = f"the residual stays at {stalled.residual:.2e}"
        if new is None or (turned and length > _TURN):
            length = 0.5 * length
            if length < _SHORTEST:
                return points, _stopped(function, current, worst), False
            continue
        progress.advance(1)
        if not _inside(new.x):
            end = _at(function, current, new, 1.0 if new.x[-1] > 1.0 else 0.0)
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


def _cosine(first: Array, second: Array) -> float:
    return float(first @ second / (np.linalg.norm(first) * np.linalg.norm(second)))


def _stopped(function: FamilyMap, current: BranchPoint, worst: str) -> str:
    return (
        f"stopped at {function.parameter(current.x):.10g}, the largest multiplier being "
        f"{np.abs(current.multipliers[:1]).max(initial=0.0):.6g}: {worst}, however short the step"
    )


Test = Callable[[BranchPoint], float]


@dataclass(frozen=True)
class Located:
    """A special point."""

    kind: str  #: what happens there
    after: int  #: number of the point of the branch before it
    point: BranchPoint


def _fold(point: BranchPoint) -> float:
    # A branch of a linear motion that loses its stability is vertical: the sign is rounding.
    along = float(point.tangent[-1])
    return along if abs(along) > _UPRIGHT else 0.0


def _period_doubling(point: BranchPoint) -> float:
    """Product of ``1 + mu``."""
    return float(np.prod(1.0 + point.multipliers).real)


def _neimark_sacker(point: BranchPoint) -> float:
    """Product of ``1 - mu_i mu_j`` over all pairs; that of a motion that is gone is one."""
    left = point.multipliers[np.abs(point.multipliers) > _GONE]
    i, j = np.triu_indices(left.size, 1)
    return float(np.prod(1.0 - left[i] * left[j]).real)


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
    """Test functions of the multipliers by kind of point, and a check of the located point."""
    return {
        "fold": (_fold, _always),
        "period-doubling": (_period_doubling, _is_doubling),
        "neimark-sacker": (_neimark_sacker, _is_torus),
        "branch-point": (_branch_point, _is_crossing),
    }


def locate(
    function: FamilyMap,
    points: list[BranchPoint],
    kind: str,
    test: Test,
    holds: Callable[[BranchPoint], bool],
) -> list[Located]:
    """Find where a test function changes its sign."""
    values = [test(point) for point in points]
    located = []
    for number, (left, right) in enumerate(pairwise(values)):
        if left * right < 0.0 or (right == 0.0 and left != 0.0 and test is not _fold):
            ends = (points[number], points[number + 1])
            point = _between(function, ends, (left, right), test)
            if holds(point):
                located.append(Located(kind, number, point))
    return located


def _between(
    function: FamilyMap,
    ends: tuple[BranchPoint, BranchPoint],
    values: tuple[float, float],
    test: Test,
) -> BranchPoint:
    """Regula falsi (Illinois method) on the chord of two points."""
    chord = ends[1].x - ends[0].x
    row = chord / np.linalg.norm(chord)
    (low, high), (left, right) = (0.0, 1.0), values
    best = min(zip(ends, values, strict=True), key=lambda pair: abs(pair[1]))[0]
    for _ in range(_BISECTIONS):
        part = low + (high - low) * left / (left - right)
        try:
            guess = ends[0].x + part * chord
            best = correct(function, guess, row, best.jet)
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
    return replace(best, tangent=tangent_at(best.jet, ends[0].tangent))
