"""Sweeps over a parameter: every value from the last state of the one before.

Such a sweep integrates one motion at a time. Where one system serves all values, pieces of the
sweep are integrated in one batch and joined where their motions are the same: all stretches
begin at once, from rest. Then every stretch is entered from the end of the one before, and
marched again until it meets a motion that is there already; if it never does, the following
stretch is entered again.
"""

from __future__ import annotations

import numpy as np

from tribodyn.arrays.linear_algebra import lengths
from tribodyn.dynamics.equations.compiled import Compiled
from tribodyn.dynamics.equations.orbit_coordinates import static_start
from tribodyn.nonlinear.attractors import Motions, settle
from tribodyn.nonlinear.survey import Outcomes, Points, Survey, each_in_threads, march_group
from tribodyn.progress import SILENT, Progress
from tribodyn.types import Array

#: Most stretches of a branch, and values of the shortest.
_STRETCHES, _SHORTEST = 32, 4
#: Motions that are marched one lane at a time: a block would be mostly idle.
_FEW = 2
#: States of the same motion: settled ones, and those that still approach.
_SAME, _NEARLY = 1e-5, 1e-3


class Stretches(Motions):
    """Motions of one or two sweeps, cut into stretches."""

    def __init__(
        self,
        compiled: Compiled,
        frequency: Array,
        first: Array,
        rest_state: Array,
        branches: tuple[str, ...],
    ) -> None:
        count = frequency.size
        all_of_them = np.tile(frequency, len(branches))
        start = np.tile(rest_state, (all_of_them.size, 1))
        super().__init__(compiled, all_of_them, start, keep_states=True)
        self.rest_state = rest_state
        pieces = min(_STRETCHES, max(1, count // _SHORTEST))
        self.stretches: list[list[list[int]]] = []
        self.follower = np.full(all_of_them.size, -1)
        for number, branch in enumerate(branches):
            order = np.arange(count) + number * count
            order = order[::-1] if branch == "down" else order
            self.start[order[0]] = first
            self.stretches.append(
                [[int(i) for i in part] for part in np.array_split(order, pieces)]
            )
        self.met = np.zeros(all_of_them.size, dtype=bool)
        self.joining = False

    def places(self) -> list[int]:
        """First value of every stretch, or the first after the motions finished before."""
        starts = []
        for part in (part for cut in self.stretches for part in cut):
            self.follower[part[:-1]] = part[1:]
            done = next((k for k, i in enumerate(part) if not self.finished[i]), len(part))
            if 0 < done < len(part):
                self.enter(part[done], part[done - 1])
            starts += part[done : done + 1]
        return starts

    def store(self, index: int, state: Array, facts: tuple[int, float, Array, Array]) -> int:
        """Store a motion and continue with the next value of its stretch."""
        self.met[index] = self.joining and self._same(index, facts)
        if self.joining:  # Only whole stretches can be joined: joints are searched again.
            self.names = []
        super().store(index, state, facts)
        if self.met[index]:
            return -1
        after = int(self.follower[index])
        if after >= 0:
            self.enter(after, index)
        return after

    def enter(self, index: int, before: int) -> None:
        """Start a motion at the end of another, or at rest if that one diverged."""
        alive = np.all(np.isfinite(self.state[before]))
        self.start[index] = self.state[before] if alive else self.rest_state
        self.force[index] = self.force[before] if alive else 0.0

    def _same(self, index: int, facts: tuple[int, float, Array, Array]) -> bool:
        """Whether a motion equals the stored one."""
        period, change, _, recent = facts
        old = self.recent[index]
        if np.isnan(recent).any() or np.isnan(old).any():
            return bool(np.isnan(recent).any() and np.isnan(old).any())
        if period != self.period[index]:
            return False
        if not period and min(change, self.change[index]) > _NEARLY:
            return True  # Neither repeats: the states say nothing.
        distance = lengths(old - recent[-1])[-max(period, 1) :]
        if not period:
            distance = lengths(old - recent[-1])
        limit = (_SAME if period else _NEARLY) * lengths(recent).max()
        return bool(distance.min() <= limit)


def march_stretches(sweeps: Stretches, transient: int, progress: Progress) -> None:
    """March all stretches, then join them."""
    progress.advance(int(sweeps.finished.sum()))
    places = sweeps.places()
    joints = [(b, s) for b, cut in enumerate(sweeps.stretches) for s in range(1, len(cut))]
    try:
        settle(sweeps, places, transient, progress=progress)
        sweeps.joining = True
        while joints:
            for branch, s in joints:
                cut = sweeps.stretches[branch]
                sweeps.enter(cut[s][0], cut[s - 1][-1])
            settle(
                sweeps,
                [sweeps.stretches[b][s][0] for b, s in joints],
                transient,
                progress=SILENT,
                width=1 if len(joints) <= _FEW else 16,
            )
            changed = [(b, s) for b, s in joints if not sweeps.met[sweeps.stretches[b][s]].any()]
            sweeps.met[:] = False
            joints = [(b, s + 1) for b, s in changed if s + 1 < len(sweeps.stretches[b])]
    except KeyboardInterrupt:
        for branch, cut in enumerate(sweeps.stretches):
            doubtful = min((s for b, s in joints if b == branch), default=len(cut))
            for part in cut[doubtful:]:
                sweeps.finished[part] = False
        raise


def march_sweeps(
    points: Points,
    first: Array | None,
    survey: Survey,
    branches: tuple[str, ...],
    progress: Progress,
) -> list[Outcomes]:
    """March the values of the parameter each from the end of the last, on every branch."""
    outcomes = [Outcomes(points.count, survey.keep, points.size, name) for name in branches]
    if len(points.groups) > 1:

        def sweep(task: tuple[str, Outcomes]) -> None:
            _sweep(points, first, survey, task, progress)

        tasks = list(zip(branches, outcomes, strict=True))
        survey.uninterrupted(lambda: each_in_threads(sweep, tasks))
        return outcomes
    count = points.count
    compiled = points.compiled(points.groups[0])
    rest_state = static_start(compiled)
    begin = rest_state if first is None else first
    sweeps = Stretches(compiled, points.mesh_frequency, begin, rest_state, branches)
    names = [f"{branch} {number}" for branch in branches for number in range(count)]
    sweeps.use_checkpoints(survey.checkpoints, names)
    survey.uninterrupted(lambda: march_stretches(sweeps, survey.transient, progress))
    for number, outcome in enumerate(outcomes):
        numbers = np.arange(count)
        outcome.fill(survey, sweeps, numbers + number * count, numbers)
    return outcomes


def _sweep(
    points: Points,
    first: Array | None,
    survey: Survey,
    task: tuple[str, Outcomes],
    progress: Progress,
) -> None:
    """One value after the other, each with its own system."""
    (branch, outcomes), state = task, first
    for number in range(points.count)[::-1] if branch == "down" else range(points.count):
        if survey.stop.is_set():
            return
        if state is not None:
            outcomes.first[number] = state
        march_group(points, survey, outcomes, np.array([number]))
        last = outcomes.last[number]
        state = last if np.all(np.isfinite(last)) else None
        progress.advance()
