"""Following the motion from speed to speed as a slow run does: along an orbit until it is lost."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from tribodyn.dynamics._engine.blocks import march
from tribodyn.dynamics.orbits.orbit_map import OrbitMap
from tribodyn.dynamics.orbits.search import newton_step
from tribodyn.dynamics.orbits.speed_sweep_family import Orbits, SpeedFamily
from tribodyn.errors import ComputationError
from tribodyn.types import Array, ComplexArray, Mask

_DISTURBANCE = 1e-6
_NEWTON = 8
#: A matrix evaluated farther than this from the orbit, over its size, is evaluated again.
_FAR = 1e-3
#: Mesh cycles between two looks at a motion that has left its orbit.
_LOOK = 24
#: A motion that repeats within this is near its orbit; a part of a period that does so is one.
_NEAR, _SAME = 5e-3, 1e-5
#: Longest way to an orbit over what is expected, and how much closer a motion has to come.
_REACH, _CLOSER = 10.0, 0.98
#: A way between two motions that is this part of their size may be a jump.
_JUMP = 0.003
#: A multiplier beyond this is unstable.
_UNSTABLE = 1.0 + 1e-7
#: How much of the patience a motion gets that did not repeat at the speed before.
_IRREGULAR = 0.25


class Followed:
    """What was met at one speed."""

    def __init__(
        self,
        point: Array,
        multipliers: ComplexArray,
        error: float,
        period: int,
        jumped: bool = False,
    ) -> None:
        self.point, self.multipliers, self.error = point, multipliers, error
        self.period, self.jumped = period, jumped

    @property
    def stable(self) -> bool:
        """Whether all multipliers lie inside the unit circle."""
        return bool(self.period > 0 and np.abs(self.multipliers[:1]).max(initial=0.0) < _UNSTABLE)


def _matrix(mapping: OrbitMap, y: Array, scale: float) -> tuple[Array, Array]:
    """Residual and matrix of the map."""
    step = _DISTURBANCE * scale
    images = mapping(y + step * np.vstack((np.zeros(y.size), np.eye(y.size))))
    return images[0] - y, (images[1:] - images[0]).T / step


def _newton(mapping: OrbitMap, y: Array, tolerance: float) -> Followed | None:
    """Newton's method; the matrix is kept once the orbit is near."""
    last = np.inf
    residual, matrix = _matrix(mapping, y, float(np.linalg.norm(y)))
    for _ in range(_NEWTON):
        scale = float(np.linalg.norm(y)) + 1e-300
        correction, distance = newton_step(matrix, residual)
        error = distance / scale
        if error <= tolerance:
            return Followed(y, mapping.multipliers(matrix), error, mapping.periods)
        if not error < 0.7 * last:
            return None
        y = y + correction
        if error > _FAR:
            last = error
            residual, matrix = _matrix(mapping, y, scale)
        else:
            residual = mapping(y) - y
    return None


def _march(mapping: OrbitMap, y: Array, cycles: int) -> Array:
    """March plainly, with the balancing torque brought up at the end."""
    if cycles > 1:
        state, extra = mapping.split(y)
        period = np.array([mapping.period])
        state = march(mapping.compiled, period, state, cycles - 1, extra_force=extra)
        reduced = mapping.coordinates.reduce(state[0])
        if mapping.balance is not None:
            gained = mapping.coordinates.free_velocity(state[0]) @ mapping.balance[0]
            reduced = np.append(reduced, y[-1] - gained / (cycles - 1))
        y = reduced
    return np.asarray(mapping(y))


class _Follower:
    def __init__(
        self, family: SpeedFamily, closed: Orbits | None, valid: Mask,
        tolerance: float, patience: int, periods: Sequence[int],
    ) -> None:  # fmt: skip
        self.family, self.closed, self.valid = family, closed, valid
        self.tolerance, self.patience, self.periods = tolerance, patience, sorted(periods)

    def shut(self, number: int) -> Followed | None:
        """Orbit of a speed at which the teeth stay in touch, if it is known and stable."""
        if self.closed is None or not self.valid[number]:
            return None
        mapping = self.family.mapping(number, 1)
        multipliers = mapping.multipliers(self.closed.matrix[number])
        error = float(self.closed.error[number])
        found = Followed(self.closed.point[number], multipliers, error, 1)
        return found if found.stable else None

    def is_shut(self, number: int, found: Followed) -> bool:
        """Tell whether an orbit is the one at which the teeth stay in touch."""
        if self.closed is None or not self.valid[number] or found.period != 1:
            return False
        away = float(np.linalg.norm(found.point - self.closed.point[number]))
        return away <= _SAME * float(np.linalg.norm(found.point))

    def continued(self, number: int, last: Followed, guess: Array) -> Followed | None:
        """Orbit that continues that of the speed before."""
        mapping = self.family.mapping(number, last.period)
        found = _newton(mapping, guess, self.tolerance)
        if found is None and guess is not last.point:
            found = _newton(mapping, last.point, self.tolerance)
        if found is None or not found.stable:
            return None
        if last.period > 1:
            found = self._shortest(number, found)
        return found

    def _shortest(self, number: int, found: Followed) -> Followed:
        """Take an orbit of several mesh cycles for what it is: it may repeat sooner."""
        for periods in self.periods:
            if periods < found.period and found.period % periods == 0:
                mapping = self.family.mapping(number, periods)
                point = self._rescaled(found.point, found.period, periods)
                away = float(np.linalg.norm((mapping(point) - point)[: self._states]))
                if away <= _SAME * float(np.linalg.norm(point)):
                    return _newton(mapping, point, self.tolerance) or found
        return found

    @property
    def _states(self) -> int | None:
        return None if self.family.balance is None else -1

    def _rescaled(self, y: Array, old: int, new: int) -> Array:
        """Reduced vector for another number of mesh cycles: the torque stays."""
        if self.family.balance is None:
            return y
        return np.append(y[:-1], y[-1] * new / old)

    def lost(self, number: int, y: Array, patience: int) -> Followed:
        """March on until the motion repeats, and find the orbit that it has come to."""
        mapping = self.family.mapping(number, 1)
        marched = 0
        while marched < patience:
            y = _march(mapping, y, _LOOK)
            marched += _LOOK
            ahead = y
            near: list[tuple[int, float]] = []
            for count in range(1, max(self.periods) + 1):
                ahead = mapping(ahead)
                away = float(np.linalg.norm((ahead - y)[: self._states]))
                if count in self.periods and away <= _NEAR * float(np.linalg.norm(y)):
                    near.append((count, away))
            for periods, away in near:
                start = self._rescaled(y, 1, periods)
                found = _newton(self.family.mapping(number, periods), start, self.tolerance)
                if found is not None and found.stable and self._arrives(mapping, y, found, away):
                    found.jumped = True
                    return self._again(number, found)
        none = np.full(y.size - (self.family.balance is not None), np.nan, dtype=complex)
        return Followed(y, none, float("nan"), 0, True)

    def _arrives(self, mapping: OrbitMap, y: Array, found: Followed, away: float) -> bool:
        """Tell whether a marched motion goes to the orbit that Newton's method found from it."""
        before = float(np.linalg.norm((found.point - y)[: self._states]))
        size = float(np.linalg.norm(found.point))
        if before <= _SAME * size:
            return True
        left = max(1.0 - float(np.abs(found.multipliers[0])), 1e-3)
        if before > _REACH * away / left:
            return False
        cycles = found.period * -(-_LOOK // found.period)
        after = float(np.linalg.norm((found.point - _march(mapping, y, cycles))[: self._states]))
        return after < _CLOSER * before or after <= _SAME * size

    def _again(self, number: int, found: Followed) -> Followed:
        if found.period == 1:
            return found
        found = self._shortest(number, found)
        found.jumped = True
        return found


def follow(
    family: SpeedFamily,
    order: Sequence[int],
    closed: Orbits | None,
    valid: Mask,
    *,
    start: Array | None,
    tolerance: float,
    patience: int,
    periods: Sequence[int],
    told: Callable[[], None],
) -> list[Followed]:
    """Follow the motion over the speeds in one direction."""
    one = _Follower(family, closed, valid, tolerance, patience, periods)
    done: list[Followed] = []
    shut = False
    for place, number in enumerate(order):
        found: Followed | None = None
        if place == 0:
            found = one.shut(number) if start is None else None
            shut = found is not None
            begin = family.start(number) if start is None else start
            found = found or _settled(one, number, begin)
            found.jumped = False
        else:
            last = done[-1]
            found = one.shut(number) if shut else None
            if found is None and last.period > 0:
                shut = False
                guess = _guess(family.frequency, order, place, done)
                found = one.continued(number, last, guess)
                shut = found is not None and one.is_shut(number, found)
            if found is None:
                share = _IRREGULAR if last.period == 0 else 1.0
                begin = one._rescaled(last.point, max(last.period, 1), 1)
                found = _settled(one, number, begin, share)
                found.jumped = _is_jump(done, found)
        done.append(found)
        told()
    return done


def _is_jump(done: Sequence[Followed], found: Followed) -> bool:
    """Tell a jump from a bend: the way from the last motion is long, and longer than the last."""
    last = done[-1]
    if last.period == 0 or found.period == 0:
        return last.period != found.period
    size = last.point.size if last.period == found.period else last.point.size - 1
    usual = 0.0
    if len(done) > 1 and done[-2].period == last.period:
        usual = float(np.linalg.norm(last.point - done[-2].point))
    away = float(np.linalg.norm((found.point - last.point)[:size]))
    return away > max(_JUMP * float(np.linalg.norm(last.point)), 3.0 * usual)


def _settled(one: _Follower, number: int, begin: Array, share: float = 1.0) -> Followed:
    patience = max(int(share * one.patience), _LOOK)
    try:
        return one.lost(number, begin, patience)
    except ComputationError:
        # The motion grew beyond all bounds: begin again at rest.
        return one.lost(number, one.family.start(number), patience)


def _guess(frequency: Array, order: Sequence[int], place: int, done: Sequence[Followed]) -> Array:
    """Continue the last two orbits in a straight line where they belong together."""
    last = done[-1]
    if place < 2 or last.jumped or done[-2].period != last.period:
        return last.point
    here, before, old = (float(frequency[order[place - k]]) for k in (0, 1, 2))
    return last.point + (last.point - done[-2].point) * ((here - before) / (before - old))
