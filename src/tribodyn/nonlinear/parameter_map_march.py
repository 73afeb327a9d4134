"""The motions behind a map over two parameters, in groups that share a system and its steps."""

from __future__ import annotations

import threading
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from tribodyn.dynamics.equations.compiled import Compiled
from tribodyn.dynamics.equations.system import System
from tribodyn.dynamics.orbits.start import static_start
from tribodyn.errors import ComputationError
from tribodyn.nonlinear.attractors import Motions, settle
from tribodyn.nonlinear.bifurcation_statistics import measure
from tribodyn.nonlinear.bifurcation_values import compile_unchecked
from tribodyn.nonlinear.verdict import step_verdict
from tribodyn.progress import Progress
from tribodyn.types import Array, Index, Mask

#: Certified distance to the motion that repeats, relative to the state.
_NEAR = 1e-5
#: Distance of the motion of half the step at which both are the same, relative to the state.
_AGREES = 5e-3
#: Lanes of one block.
_WIDTH = 64


@dataclass(frozen=True)
class Plan:
    """What to do at every point."""

    transient: int
    cycles: int  #: mesh cycles before, and those of the statistics of a motion that does not repeat
    signal: int | str  #: contact whose compression is looked at, or name of a coordinate
    verdict: bool  #: judge every motion by half the step
    keep_partial: bool  #: whether an interruption leaves what is finished
    stop: threading.Event = field(default_factory=threading.Event, repr=False, compare=False)


class Field:
    """All points of a map, filled while marching."""

    def __init__(
        self, shape: tuple[int, int], frequency: Array, scales: dict[str, Array], steps: Index,
        step_number: Array,
    ) -> None:  # fmt: skip
        self.frequency, self.scales = frequency, scales
        self.steps, self.step_number = steps, step_number
        self.period = np.zeros(shape, dtype=np.int64)
        self.rms, self.contact_loss_share = np.full(shape, np.nan), np.full(shape, np.nan)
        self.verdict = np.full(shape, "", dtype="<U12")
        self.finished = np.zeros(shape, dtype=bool)


def march_field(
    points: Field, systems: list[tuple[System, slice]], start: Array | None, plan: Plan,
    progress: Progress,
) -> None:  # fmt: skip
    """March and judge all points."""
    for system, rows in systems:
        inside = np.zeros(points.steps.shape, dtype=bool)
        inside[rows] = True
        for steps in np.unique(points.steps[inside]):
            where = np.nonzero(inside & (points.steps == steps))
            if not plan.stop.is_set():
                _march_group(points, where, system, int(steps), start, plan, progress)


def _march_group(
    points: Field, where: tuple[Any, ...], system: System, steps: int, start: Array | None,
    plan: Plan, progress: Progress,
) -> None:  # fmt: skip
    frequency = points.frequency[where]
    compiled = compile_unchecked(system, float(frequency.min()), steps)
    begin = static_start(compiled) if start is None else start
    motions = _motions(points, where, compiled, np.tile(begin, (frequency.size, 1)))
    _settle(motions, np.arange(frequency.size), plan, progress)
    done = np.flatnonzero(motions.finished)
    found = measure(motions, done, plan.cycles, max(2, plan.cycles), plan.signal)
    to = tuple(axis[done] for axis in where)
    points.period[to], points.rms[to] = found.period, found.rms
    points.contact_loss_share[to], points.finished[to] = found.contact_loss_share, True
    if plan.verdict and not plan.stop.is_set():
        finer = compile_unchecked(system, float(frequency.min()), 2 * steps)
        again = _motions(points, where, finer, motions.state)
        again.force[:] = motions.force
        _judge(points, where, motions, again, plan, progress)


def _motions(points: Field, where: tuple[Any, ...], compiled: Compiled, begin: Array) -> Motions:
    scales = {name: values[where] for name, values in points.scales.items()}
    return Motions(compiled, points.frequency[where], begin, parameters=scales)


def _settle(motions: Motions, indices: Index, plan: Plan, progress: Progress) -> None:
    try:
        settle(
            motions, indices, plan.transient, tolerance=_NEAR, width=_WIDTH, progress=progress
        )  # fmt: skip
    except KeyboardInterrupt:
        plan.stop.set()
        if not plan.keep_partial:
            raise


def _judge(
    points: Field, where: tuple[Any, ...], motions: Motions, again: Motions, plan: Plan,
    progress: Progress,
) -> None:  # fmt: skip
    """Judge by half the step: by one period where that is enough, else by marching anew."""
    same = _comes_back(motions, again)
    points.verdict[tuple(axis[same] for axis in where)] = "physical"
    progress.advance(int(same.sum()))
    alive = np.all(np.isfinite(motions.state), axis=1)
    lost = tuple(axis[motions.finished & ~alive] for axis in where)
    points.verdict[lost] = "undecided"
    open_ = np.flatnonzero(motions.finished & alive & ~same)
    if not open_.size:
        return
    _settle(again, open_, plan, progress)
    open_ = open_[again.finished[open_]]
    found = measure(again, open_, plan.cycles, max(2, plan.cycles), plan.signal)
    for n, index in enumerate(open_):
        at = tuple(axis[index] for axis in where)
        points.verdict[at] = step_verdict(
            float(points.step_number[at]), int(points.period[at]), float(points.rms[at]),
            int(found.period[n]), float(found.rms[n]),
        )  # fmt: skip


def _comes_back(motions: Motions, again: Motions) -> Mask:
    """Motions whose period with half the step ends so near that both motions are the same."""
    same = np.zeros(motions.period.size, dtype=bool)
    reduce = again.coordinates.reduce
    for period in np.unique(motions.period[motions.period > 0]):
        index = np.flatnonzero((motions.period == period) & (motions.rate < 1.0))
        if not index.size:
            continue
        try:
            new = again.march(index, motions.state[index], int(period), motions.force[index])
        except ComputationError:
            continue
        old = reduce(motions.state[index])
        apart = np.abs(reduce(new) - old).max(axis=1) / (1.0 - motions.rate[index])
        same[index] = apart <= _AGREES * np.abs(old).max(axis=1)
    return same
