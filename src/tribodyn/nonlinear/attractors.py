"""Many motions marched until they repeat, in blocks of lanes that are refilled as they settle.

A motion has settled when its states after ``p`` = 1 to 8 mesh cycles come back, and when the rate
at which they do so bounds the distance to the motion that repeats exactly: the change ``d`` over
``p`` cycles, shrinking by ``r`` every ``p`` cycles, leaves at most ``d / (1 - r)``. Machines are
looked at after each period of their clock too: its many mesh cycles may leave nothing of the start.
"""

from __future__ import annotations

import os
import threading
from collections.abc import Iterator, Sequence
from contextlib import suppress
from itertools import islice
from typing import Any

import numpy as np

from tribodyn.arrays.linear_algebra import each_times, lengths
from tribodyn.checkpoints import Checkpoints
from tribodyn.dynamics._engine.blocks import march, marching_on, on_gpu
from tribodyn.dynamics.equations.compiled import Compiled
from tribodyn.dynamics.equations.lane_parameters import LaneParameters
from tribodyn.dynamics.equations.orbit_coordinates import Balance, orbit_coordinates
from tribodyn.errors import ComputationError
from tribodyn.interrupt import in_threads
from tribodyn.progress import SILENT, Progress
from tribodyn.types import Array, Index, Mask

#: Longest period that ends a transient early [mesh cycles].
LONGEST_PERIOD = 8
#: Mesh cycles between two looks at the lanes.
_PART = 2 * LONGEST_PERIOD
#: Rate in every cycle at which a motion settles so fast that its last four states tell.
_FAST = 0.3
#: Lanes of the kernel.
_LANES = 16
#: Lanes that a graphics processor marches at a time: enough to fill it.
_MANY_LANES = 16384
#: A motion this much smaller than its start is at rest.
_REST = 1e-6
#: Points that differ by less than this, relative to their size, are the same.
_SAME = 1e-5
#: A change as small as rounding, relative to the state.
_ROUNDING = 1e-12
#: Numbers that are recorded at most; beyond, the cycles are marched one by one.
_MOST_RECORDED = 2_000_000
#: Part of the change after fewer cycles that is left whole periods later, where it settles.
_FALLS = 0.999


#: What a checkpoint has of each motion, in this order, before its last states.
_KEPT = ("start", "state", "force", "period", "change", "rate")


class Motions:
    """Motions of one compiled system, one lane each, and what became of them."""

    def __init__(
        self,
        compiled: Compiled,
        frequency: Array,
        start: Array,
        force: Array | None = None,
        parameters: dict[str, Array] | None = None,
        *,
        keep_states: bool = False,
    ) -> None:
        count, size = frequency.size, compiled.system.size
        self.compiled, self.frequency, self.parameters = compiled, frequency, parameters or {}
        self.start = np.array(start, dtype=float)
        self.force = np.zeros((count, size)) if force is None else np.array(force, dtype=float)
        self.coordinates = orbit_coordinates(compiled, 1.0 / (2.0 * np.pi))
        self.balance = Balance.of(compiled.system, self.coordinates)
        width = self.coordinates.reducing.shape[1]
        self.state = np.full((count, 2 * size), np.nan)
        self.period = np.zeros(count, dtype=np.int64)
        self.change, self.rate = np.full(count, np.inf), np.ones(count)
        self.recent = np.full((count if keep_states else 0, LONGEST_PERIOD, width), np.nan)
        self.finished = np.zeros(count, dtype=bool)
        self.stop = threading.Event()
        self.progress = SILENT
        self.checkpoints, self.names = Checkpoints(), list[str]()
        self._waiting: Iterator[int] = iter(())
        self._lock = threading.Lock()

    def use_checkpoints(self, checkpoints: Checkpoints, names: Sequence[str]) -> None:
        """Restore the motions that an earlier process finished, and store each new one."""
        self.checkpoints, self.names = checkpoints, list(names)
        for index, name in enumerate(names):
            if (stored := checkpoints.get(name)) is not None:
                self._restore(index, stored)

    def _restore(self, index: int, stored: Any) -> None:
        for name, value in zip(_KEPT, stored, strict=False):
            getattr(self, name)[index] = value
        if len(self.recent):
            self.recent[index] = stored[-1]
        self.finished[index] = True

    def _stored(self, index: int) -> list[Any]:
        """Return the stored values of a motion."""
        recent = self.recent[index] if len(self.recent) else None
        return [*(getattr(self, name)[index] for name in _KEPT), recent]

    def queue(self, indices: Any) -> None:
        """Queue motions for time integration."""
        self._waiting = iter([int(i) for i in indices])

    def take(self, count: int) -> list[int]:
        """Take motions out of the queue."""
        with self._lock:
            return list(islice(self._waiting, count))

    def store(self, index: int, state: Array, facts: tuple[int, float, Array, Array]) -> int:
        """Keep what became of a motion."""
        self.state[index] = state
        self.period[index], self.change[index], self.force[index], recent = facts
        if len(self.recent):
            self.recent[index] = recent
        self.finished[index] = True
        if self.names:
            self.checkpoints.keep(self.names[index], self._stored(index))
        with self._lock:
            self.progress.advance()
        return -1

    def reduce(self, states: Array, index: Index) -> Array:
        """Reduced states (..., lanes, e + v) of some motions, each at its mesh frequency."""
        reduced = each_times(states, self.coordinates.reducing)
        positions = self.coordinates.elastic.shape[1]
        reduced[..., :positions] *= 2.0 * np.pi * self.frequency[index, None]
        return reduced

    def at_rest(self, states: Array) -> Array:
        """States (..., 2 n) with the free motions at rest."""
        resting = self.coordinates.resting
        return states if resting is None else each_times(states, resting)

    def march(self, index: Index, state: Array, cycles: int, force: Array, **options: Any) -> Array:
        """March lanes by whole mesh cycles."""
        if self.parameters:
            options["parameters"] = LaneParameters(
                **{name: values[index] for name, values in self.parameters.items()}
            )
        period = 1.0 / self.frequency[index]
        return march(self.compiled, period, state, cycles, extra_force=force, **options)


class _Block:
    """Lanes integrated in one batch; a lane takes the next motion when its present one is done."""

    def __init__(self, motions: Motions, transient: int, tolerance: float, width: int) -> None:
        self.motions, self.tolerance, self.width = motions, tolerance, width
        self.by_cycle = motions.compiled.engine is not None
        self.cycles = LONGEST_PERIOD if self.by_cycle else _PART
        self.parts = -(-transient // self.cycles)
        self.steps = motions.compiled.grid.steps
        self.scale = float(np.abs(motions.compiled.nodes.force).max(initial=0.0)) or 1.0
        size = motions.start.shape[1]
        self.job = np.full(width, -1)
        self.state, self.force = np.zeros((width, size)), np.zeros((width, size // 2))
        self.part = np.zeros(width, dtype=np.int64)
        self.least = np.full(width, 1e-300)
        self.before = np.full((LONGEST_PERIOD, width), np.inf)
        reduced = motions.coordinates.reducing.shape[1]
        self.earlier = np.full((LONGEST_PERIOD + 1, width, reduced), np.nan)
        points = LONGEST_PERIOD * self.steps + 1
        self.record = None
        self.lanes = width if on_gpu() else min(width, _LANES)
        if points * size * self.lanes <= _MOST_RECORDED and not self.by_cycle:
            self.record = np.empty((points, size, self.lanes))

    def run(self) -> None:
        """March until the queue is empty, or another block was stopped by an error."""
        try:
            while not self.motions.stop.is_set() and self._fill():
                self._advance()
        except BaseException:
            self.motions.stop.set()
            raise

    def _fill(self) -> bool:
        """Give a motion to every lane that has none; tell whether any lane has one."""
        idle = np.flatnonzero(self.job < 0)
        if idle.size:
            for lane, job in zip(idle, self.motions.take(idle.size), strict=False):
                self._begin(int(lane), job)
        busy = np.flatnonzero(self.job >= 0)
        if not busy.size:
            return False
        idle = np.flatnonzero(self.job < 0)
        # Idle lanes go along with one that is busy.
        self.state[idle], self.force[idle] = self.state[busy[0]], self.force[busy[0]]
        return True

    def _begin(self, lane: int, job: int) -> None:
        m = self.motions
        while job >= 0:
            self.job[lane], self.part[lane], self.before[:, lane] = job, 0, np.inf
            self.earlier[:, lane] = np.nan
            self.state[lane], self.force[lane] = m.start[job], m.force[job]
            begin = m.reduce(m.start[[job]], np.array([job]))
            self.least[lane] = max(_REST * float(lengths(begin)[0]), 1e-300)
            if self.parts:
                return
            recent = np.repeat(begin, LONGEST_PERIOD, axis=0)
            job = m.store(job, m.start[job], (0, np.inf, m.force[job], recent))
        self.job[lane] = -1

    def _advance(self) -> None:
        """March one part, look at every lane, and put others in place of those that are done."""
        m = self.motions
        index = np.where(self.job >= 0, self.job, self.job.max())
        parts: list[Array] = []
        try:
            if not self.by_cycle:
                parts.append(self._first_cycles(index, slice(None)))
            last, states = self._last_cycles(index, m.at_rest(parts[0] if parts else self.state))
        except ComputationError:
            self._drop_lost(index)
            return
        self.state = m.at_rest(last)
        shift, parts = np.zeros(self.width), [*parts, last]
        if m.balance is not None:
            gained = np.sum([m.balance.gain(part) for part in parts], axis=0)
            cycles = self.cycles - LONGEST_PERIOD + len(states) - 1
            more = m.balance.torque(gained, cycles / m.frequency[index])
            self.force -= more
            shift = np.abs(more).max(axis=1)
        self.part += 1
        reduced, balanced = m.reduce(states, index), shift <= self.tolerance * self.scale
        if len(states) > LONGEST_PERIOD:
            self._find_periods(reduced, balanced)
        else:
            self._end_early(reduced, bool(balanced[0]))

    def _first_cycles(self, index: Index, lanes: slice, width: int | None = None) -> Array:
        """March some lanes over the mesh cycles of a part before its last 8."""
        cycles, options = _PART - LONGEST_PERIOD, {"width": width or self.lanes, "threads": 1}
        return self.motions.march(
            index[lanes], self.state[lanes], cycles, self.force[lanes], **options
        )

    def _last_cycles(self, index: Index, state: Array) -> tuple[Array, Array]:
        """March the last 8 mesh cycles of a part; also returns all states, (9, lanes, 2 n)."""
        m = self.motions
        options: dict[str, Any] = {"width": self.lanes, "threads": 1}
        if self.record is not None:
            options["record"] = self.record
            states_by_cycle = np.empty((LONGEST_PERIOD + 1, *state.shape))
            for first in range(0, self.width, self.lanes):
                lanes = slice(first, first + self.lanes)
                m.march(index[lanes], state[lanes], LONGEST_PERIOD, self.force[lanes], **options)
                states_by_cycle[:, lanes] = np.moveaxis(self.record[:: self.steps], 2, 1)
            return states_by_cycle[-1], states_by_cycle
        states = [state]
        for _ in range(LONGEST_PERIOD):
            states.append(m.march(index, states[-1], 1, self.force, **options))
            if self.by_cycle and self._contraction(m.reduce(np.array(states[-4:]), index)) < _FAST:
                break
        return states[-1], np.array(states)

    def _contraction(self, states: Array) -> float:
        """Rate in every cycle of a motion that is certified by four states; 1 if it is not."""
        if len(states) < 4:
            return 1.0
        change = lengths(np.diff(states, axis=0))[:, 0]
        rate = float(np.max(change[1:] / np.maximum(change[:-1], 1e-300)))
        size = max(float(lengths(states[-1])[0]), float(self.least[0]))
        certified = rate < _FAST and change[-1] <= (1.0 - rate) * self.tolerance * size
        return rate if certified else 1.0

    def _end_early(self, states: Array, balanced: bool) -> None:
        """End the only motion, which repeats after each cycle, unless the torque still changes."""
        m, job = self.motions, int(self.job[0])
        self.before[:], self.earlier[:] = np.inf, np.nan
        if balanced or self.part[0] >= self.parts:
            m.rate[job] = self._contraction(states[-4:])
            size = max(float(lengths(states[-1])[0]), float(self.least[0]))
            change = float(lengths(states[-1] - states[-2])[0]) / size
            recent = np.repeat(states[-1:, 0], LONGEST_PERIOD, axis=0)
            facts = (int(balanced), change, self.force[0], recent)
            self._begin(0, m.store(job, self.state[0], facts))

    def _find_periods(self, states: Array, balanced: Mask) -> None:
        """Find the lanes that repeat; ``states`` are (9, lanes, k), the last is the current one."""
        size = np.maximum(lengths(states[-1]), self.least)
        change = lengths(states[-1] - states[-2::-1]) / size
        with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
            rate = np.where(change < self.before, change / self.before, 1.0)
            rate **= np.arange(1, LONGEST_PERIOD + 1)[:, None] / self.cycles
            certified = change / (1.0 - rate) <= self.tolerance
        repeats = ((certified & np.isfinite(self.before)) | (change <= _ROUNDING)) & balanced
        period = np.where(repeats.any(axis=0), repeats.argmax(axis=0) + 1, 0)
        # Rotating states first come near after several cycles: the shortest divisor counts, and
        # while they still come nearer after fewer cycles, the period is undecided.
        for lane in np.flatnonzero(period > 1):
            shorter = [p for p in range(1, period[lane]) if period[lane] % p == 0]
            period[lane] = next((p for p in shorter if change[p - 1, lane] <= _SAME), period[lane])
            if still_settles(
                states[:, lane], self.earlier[:, lane], int(period[lane]), self.cycles
            ):
                period[lane] = 0
        self.earlier = states
        m = self.motions
        done = (self.job >= 0) & ((period > 0) | (self.part >= self.parts))
        self.before = change
        for lane in np.flatnonzero(done):
            if period[lane]:
                m.rate[self.job[lane]] = rate[period[lane] - 1, lane]
            facts = (
                int(period[lane]),
                float(change[:, lane].min()),
                self.force[lane],
                states[1:, lane],
            )
            self._begin(int(lane), m.store(int(self.job[lane]), self.state[lane], facts))

    def _drop_lost(self, index: Index) -> None:
        """Remove the lanes that grow beyond all bounds; the others are repeated."""
        m = self.motions
        lost = []
        for lane in np.flatnonzero(self.job >= 0):
            single = slice(lane, lane + 1)
            with suppress(ComputationError), marching_on("cpu"):
                middle = m.at_rest(self._first_cycles(index, single, 1))
                m.march(index[single], middle, LONGEST_PERIOD, self.force[single], threads=1)
                continue
            lost.append(int(lane))
        # What diverged on a graphics processor may pass here: then the farthest one goes.
        size = np.where(self.job >= 0, np.abs(self.state).max(axis=1), -1.0)
        for number in lost or [int(size.argmax())]:
            nan = np.full(self.state.shape[1], np.nan)
            recent = np.full((LONGEST_PERIOD, m.recent.shape[2]), np.nan)
            force = np.zeros(self.force.shape[1])
            self._begin(number, m.store(int(self.job[number]), nan, (0, np.inf, force, recent)))


def settle(
    motions: Motions,
    indices: Any,
    transient: int,
    *,
    tolerance: float = 1e-7,
    width: int = 16,
    progress: Progress = SILENT,
) -> None:
    """Integrate motions until they repeat, or over the full transient."""
    width = min(len(indices), _MANY_LANES) if on_gpu() else width
    if motions.compiled.engine is not None:  # it integrates one lane after the other
        width = 1
    motions.queue(indices)
    motions.progress = progress
    single_block = on_gpu() or (width == 1 and len(indices) == 1)
    count = 1 if single_block else os.cpu_count() or 1
    blocks = [_Block(motions, transient, tolerance, width) for _ in range(count)]
    in_threads(_Block.run, blocks, count)


def still_settles(states: Array, earlier: Array, period: int, part: int = _PART) -> bool:
    """Whether a motion still comes nearer after fewer cycles than its period, from part to part."""
    back = period * -(-part // period) - part
    for fewer in range(1, period):
        if period % fewer == 0:
            new = states[-1] - states[-1 - fewer]
            old = earlier[-1 - back] - earlier[-1 - back - fewer]
            if np.linalg.norm(new) < _FALLS * np.linalg.norm(old):
                return True
    return False
