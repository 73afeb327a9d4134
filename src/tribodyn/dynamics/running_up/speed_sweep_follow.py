"""Follow the motion from speed to speed as in a slow sweep: along an orbit until it is lost."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from tribodyn.dynamics._engine.blocks import march
from tribodyn.dynamics._engine.statistics import Statistics
from tribodyn.dynamics.equations.compiled import Compiled
from tribodyn.dynamics.equations.orbit_coordinates import orbit_coordinates, static_start
from tribodyn.dynamics.equations.program import Program
from tribodyn.dynamics.orbits.orbit_map import OrbitMap, Orbits, newton
from tribodyn.dynamics.running_up.run_up_tables import Table, Tables, blend_weight
from tribodyn.errors import ComputationError
from tribodyn.types import Array, ComplexArray, Index, Mask

#: Mesh cycles between two checks of a motion that has left its orbit.
_LOOK = 24
#: Iterations of Newton's method from rest: while the flanks are in contact, one is enough.
_FROM_REST = 3
#: A motion that repeats within this is near its orbit; a part of a period that does so is one.
_NEAR, _SAME = 5e-3, 1e-5
#: Longest distance to an orbit over the expected one, and the factor by which it has to fall.
_REACH, _CLOSER = 10.0, 0.98
#: A distance between two motions beyond this part of their size may be a jump.
_JUMP = 0.003
#: A multiplier beyond this is unstable.
_UNSTABLE = 1.0 + 1e-7
#: Part of the patience for a motion that did not repeat at the previous speed.
_IRREGULAR = 0.25


class SpeedFamily:
    """One system, or several over the speed, at the speeds of a sweep."""

    def __init__(self, tables: Tables, table_frequencies: Array, frequency: Array) -> None:
        self.tables, self.frequency = tables, frequency
        self.system = tables.systems[0]
        self._compiled: dict[tuple[int, int, float], Compiled] = {}
        self._key = []
        for beat in frequency:
            left, part = blend_weight(table_frequencies, float(beat))
            self._key.append((tables.steps_at(float(beat)), left, part))
        lowest = float(frequency.min())
        self.coordinates = orbit_coordinates(self.compiled(int(np.argmin(frequency))), lowest)
        first = OrbitMap(self.compiled(0), float(frequency[0]), 1, self.coordinates)
        self.balance, self.affine = first.balance, first.affine

    def compiled(self, number: int) -> Compiled:
        """System of one speed on its grid."""
        key = self._key[number]
        if key not in self._compiled:
            table = self.tables.at(float(self.frequency[number]))
            blend = _blended(table, key[1], key[2])
            self._compiled[key] = Compiled(self.system, table.grid, table.nodes[key[1]], *blend)
        return self._compiled[key]

    def mapping(self, number: int | Index, periods: int) -> OrbitMap:
        """Map over some mesh cycles of one speed, or of several that share one program."""
        beat = self.frequency[number]
        first = int(np.ravel(number)[0])
        return OrbitMap(self.compiled(first), beat, periods, self.coordinates, 16)

    def start(self, number: int) -> Array:
        """Reduced vector of the static equilibrium."""
        y = self.coordinates.reduce(static_start(self.compiled(number)))
        return y if self.balance is None else np.append(y, 0.0)

    def groups(self) -> list[Index]:
        """Speeds that share one program."""
        groups: dict[tuple[int, int, float], list[int]] = {}
        for number, key in enumerate(self._key):
            groups.setdefault(key, []).append(number)
        return [np.array(group, dtype=np.int64) for group in groups.values()]

    def all_at_once(self, tolerance: float) -> Orbits:
        """Newton's method from rest at all speeds in one batch."""
        start = np.array([self.start(number) for number in range(self.frequency.size)])
        size = start.shape[1]
        orbits = Orbits(start, np.zeros((*start.shape, size)), np.zeros(len(start)))
        for group in self.groups():
            group_orbits = newton(self.mapping(group, 1), start[group], tolerance, _FROM_REST)
            for values, new in zip(orbits, group_orbits, strict=True):
                values[group] = new
        return orbits

    def split(self, number: Index, y: Array, periods: Index) -> tuple[Array, Array]:
        """States and balancing forces of points that repeat after ``periods`` mesh cycles."""
        state = np.empty((len(y), 2 * self.system.size))
        extra = np.empty((len(y), self.system.size))
        for length in np.unique(periods):
            lanes = np.flatnonzero(periods == length)
            mapping = self.mapping(number[lanes], max(int(length), 1))
            state[lanes], extra[lanes] = mapping.split(y[lanes])
        return state, extra

    def statistics(
        self, number: Index, y: Array, periods: Index, cycles: int, outputs: Array
    ) -> Array:
        """Integrate motions over their periods and compute their figures."""
        contacts, others = len(self.system.contacts), self.system.size + len(outputs)
        figures = np.empty((2 * contacts + others, 5, number.size))
        state, extra = self.split(number, y, periods)
        for group in self.groups():
            inside = np.isin(number, group)
            for length in np.unique(periods[inside]):
                lanes = np.flatnonzero(inside & (periods == length))
                compiled, beat = self.compiled(int(group[0])), self.frequency[number[lanes]]
                statistics = Statistics.of(compiled, outputs, lanes.size)
                options: dict[str, Any] = {"extra_force": extra[lanes], "statistics": statistics}
                march(compiled, 1.0 / beat, state[lanes], int(length) or cycles, **options)
                figures[:, :, lanes] = statistics.figures
        return figures


def _blended(table: Table, left: int, part: float) -> tuple[Program, float]:
    program = table.programs[left]
    if part > 0.0:
        other = table.programs[left + 1]
        program = program._replace(
            rows=program.rows + part * (other.rows - program.rows),
            constant_load=program.constant_load
            + part * (other.constant_load - program.constant_load),
        )
    return program, table.step_number


@dataclass(eq=False)
class Followed:
    """Motion at one speed."""

    point: Array
    multipliers: ComplexArray
    error: float
    period: int
    jumped: bool = False

    @property
    def stable(self) -> bool:
        """Whether all multipliers lie inside the unit circle."""
        return bool(self.period > 0 and np.abs(self.multipliers[:1]).max(initial=0.0) < _UNSTABLE)


def _orbit_near(mapping: OrbitMap, y: Array, tolerance: float) -> Followed | None:
    """Orbit to which Newton's method converges from a point, or None."""
    orbit = newton(mapping, y[None], tolerance)
    error = float(orbit.error[0])
    if not error <= tolerance:
        return None
    multipliers = mapping.multipliers(orbit.matrix[0])
    return Followed(orbit.point[0], multipliers, error, mapping.periods)


def _march(mapping: OrbitMap, y: Array, cycles: int) -> Array:
    """Integrate mesh cycles, and update the balancing torque in the last one."""
    if cycles > 1:
        most = mapping.over(cycles - 1)
        y = mapping.rescaled(most(most.rescaled(y, 1)), cycles - 1)
    return mapping(y)


@dataclass(frozen=True, eq=False)
class Follower:
    """Find the motion of one speed from that of the previous speed."""

    family: SpeedFamily
    closed: Orbits  #: of one mesh cycle, at all speeds
    valid: Mask  #: speeds at which these never leave the driving flanks
    tolerance: float
    patience: int
    periods: Sequence[int]  #: in rising order

    def shut(self, number: int) -> Followed | None:
        """Stable orbit of a speed without loss of contact, or None."""
        if not self.valid[number]:
            return None
        mapping = self.family.mapping(number, 1)
        multipliers = mapping.multipliers(self.closed.matrix[number])
        error = float(self.closed.error[number])
        orbit = Followed(self.closed.point[number], multipliers, error, 1)
        return orbit if orbit.stable else None

    def is_shut(self, number: int, orbit: Followed) -> bool:
        """Whether an orbit is the one without loss of contact."""
        if not self.valid[number] or orbit.period != 1:
            return False
        away = float(np.linalg.norm(orbit.point - self.closed.point[number]))
        return away <= _SAME * float(np.linalg.norm(orbit.point))

    def continued(self, number: int, last: Followed, guess: Array) -> Followed | None:
        """Orbit that continues the one of the previous speed, or None."""
        mapping = self.family.mapping(number, last.period)
        orbit = _orbit_near(mapping, guess, self.tolerance)
        if orbit is None and guess is not last.point:
            orbit = _orbit_near(mapping, last.point, self.tolerance)
        if orbit is None or not orbit.stable:
            return None
        if last.period > 1:
            orbit = self._shortest(number, orbit)
        return orbit

    def _shortest(self, number: int, orbit: Followed) -> Followed:
        """Reduce an orbit of several mesh cycles to its shortest period."""
        for periods in self.periods:
            if periods < orbit.period and orbit.period % periods == 0:
                mapping = self.family.mapping(number, periods)
                point = mapping.rescaled(orbit.point, orbit.period)
                away = float(np.linalg.norm(mapping.states(mapping(point) - point)))
                if away <= _SAME * float(np.linalg.norm(point)):
                    return _orbit_near(mapping, point, self.tolerance) or orbit
        return orbit

    def lost(self, number: int, y: Array, patience: int) -> Followed:
        """Integrate until the motion repeats, and find the orbit that it has reached."""
        mapping = self.family.mapping(number, 1)
        marched = 0
        while marched < patience:
            y = _march(mapping, y, _LOOK)
            marched += _LOOK
            ahead = y
            candidates: list[tuple[int, float]] = []
            for count in range(1, max(self.periods) + 1):
                ahead = mapping(ahead)
                away = float(np.linalg.norm(mapping.states(ahead - y)))
                if count in self.periods and away <= _NEAR * float(np.linalg.norm(y)):
                    candidates.append((count, away))
            for periods, away in candidates:
                period_map = self.family.mapping(number, periods)
                orbit = _orbit_near(period_map, period_map.rescaled(y, 1), self.tolerance)
                if orbit is not None and orbit.stable and self._arrives(mapping, y, orbit, away):
                    orbit.jumped = True
                    return self._again(number, orbit)
        none = np.full(y.size - (self.family.balance is not None), np.nan, dtype=complex)
        return Followed(y, none, float("nan"), 0, True)

    def _arrives(self, mapping: OrbitMap, y: Array, orbit: Followed, away: float) -> bool:
        """Whether a motion converges to the orbit that Newton's method found from it."""
        before = float(np.linalg.norm(mapping.states(orbit.point - y)))
        size = float(np.linalg.norm(orbit.point))
        if before <= _SAME * size:
            return True
        left = max(1.0 - float(np.abs(orbit.multipliers[0])), 1e-3)
        if before > _REACH * away / left:
            return False
        cycles = orbit.period * -(-_LOOK // orbit.period)
        after = float(np.linalg.norm(mapping.states(orbit.point - _march(mapping, y, cycles))))
        return after < _CLOSER * before or after <= _SAME * size

    def _again(self, number: int, orbit: Followed) -> Followed:
        if orbit.period == 1:
            return orbit
        orbit = self._shortest(number, orbit)
        orbit.jumped = True
        return orbit


def follow(
    follower: Follower, order: Sequence[int], start: Array | None, report_speed: Callable[[], None]
) -> list[Followed]:
    """Follow the motion over the speeds in one direction."""
    family = follower.family
    done: list[Followed] = []
    shut = False
    for place, number in enumerate(order):
        orbit: Followed | None = None
        if place == 0:
            orbit = follower.shut(number) if start is None else None
            shut = orbit is not None
            begin = family.start(number) if start is None else start
            orbit = orbit or _settled(follower, number, begin)
            orbit.jumped = False
        else:
            last = done[-1]
            orbit = follower.shut(number) if shut else None
            if orbit is None and last.period > 0:
                shut = False
                guess = _guess(family.frequency, order, place, done)
                orbit = follower.continued(number, last, guess)
                shut = orbit is not None and follower.is_shut(number, orbit)
            if orbit is None:
                share = _IRREGULAR if last.period == 0 else 1.0
                begin = family.mapping(number, 1).rescaled(last.point, max(last.period, 1))
                orbit = _settled(follower, number, begin, share)
                orbit.jumped = _is_jump(done, orbit)
        done.append(orbit)
        report_speed()
    return done


def _is_jump(done: Sequence[Followed], orbit: Followed) -> bool:
    """Whether the distance from the last motion is large, and large compared with the previous."""
    last = done[-1]
    if last.period == 0 or orbit.period == 0:
        return last.period != orbit.period
    size = last.point.size if last.period == orbit.period else last.point.size - 1
    usual = 0.0
    if len(done) > 1 and done[-2].period == last.period:
        usual = float(np.linalg.norm(last.point - done[-2].point))
    away = float(np.linalg.norm((orbit.point - last.point)[:size]))
    return away > max(_JUMP * float(np.linalg.norm(last.point)), 3.0 * usual)


def _settled(follower: Follower, number: int, begin: Array, share: float = 1.0) -> Followed:
    patience = max(int(share * follower.patience), _LOOK)
    try:
        return follower.lost(number, begin, patience)
    except ComputationError:
        # The motion diverged: restart at rest.
        return follower.lost(number, follower.family.start(number), patience)


def _guess(frequency: Array, order: Sequence[int], place: int, done: Sequence[Followed]) -> Array:
    """Extrapolate the last two orbits linearly if they belong to the same branch."""
    last = done[-1]
    if place < 2 or last.jumped or done[-2].period != last.period:
        return last.point
    current, before, old = (float(frequency[order[place - k]]) for k in (0, 1, 2))
    return last.point + (last.point - done[-2].point) * ((current - before) / (before - old))
