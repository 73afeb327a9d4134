"""Surveys of motions: integrate until they repeat, evaluate, and judge by half the step.

A survey has motions that differ in their system, mesh frequency, factors, steps or start. Those
that share a system and its steps are lanes of one march.
"""

from __future__ import annotations

import os
import threading
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from tribodyn.arrays.linear_algebra import each_times, lengths
from tribodyn.checkpoints import Checkpoints
from tribodyn.dynamics._engine.statistics import Statistics
from tribodyn.dynamics.equations.compiled import Compiled, compile_lanes
from tribodyn.dynamics.equations.orbit_coordinates import static_start
from tribodyn.dynamics.equations.step_limit import LIMIT
from tribodyn.dynamics.equations.system import System
from tribodyn.dynamics.modal.modal_march import compile_motion
from tribodyn.dynamics.orbits.periods import open_period
from tribodyn.errors import ComputationError, InputError
from tribodyn.interrupt import in_threads
from tribodyn.nonlinear.attractors import Motions, settle
from tribodyn.progress import SILENT, Progress
from tribodyn.record import Record
from tribodyn.types import Array, Index, Mask

Verdict = Literal["physical", "step-limited", "undecided"]

#: Rms values agree within this: of motions that repeat, and of those that do not.
_PERIODIC, _IRREGULAR = 0.01, 0.1
#: Distance of the motion of half the step at which both are the same, relative to the state.
_AGREES = 5e-3


def step_verdict(
    step_number: float, period: int, rms: float, refined_period: int, refined_rms: float
) -> Verdict:
    """Judge a motion by the same computation with shorter steps."""
    if step_number > LIMIT:
        return "step-limited"
    unsettled = period == 0 or refined_period == 0
    tolerance = _IRREGULAR if unsettled else _PERIODIC
    agrees = abs(rms - refined_rms) <= tolerance * max(abs(rms), abs(refined_rms))
    if period != refined_period:
        return "undecided" if unsettled and agrees else "step-limited"
    return "physical" if agrees else "undecided"


class Surveyed(Record):
    """Motions over parameters, each with a verdict; some may be missing after an interruption."""

    finished: Mask
    rms: Array
    verdict: NDArray[np.str_]

    @property
    def complete(self) -> bool:
        """Whether every motion is finished."""
        return bool(self.finished.all())

    @property
    def ran_away(self) -> Mask:
        """Mask of the motions that grew beyond all bounds and are not step-limited."""
        lost = self.finished & ~np.isfinite(self.rms)
        return np.asarray(lost & (self.verdict != "step-limited"))

    def verdicts(self) -> dict[str, int]:
        """Count the verdicts that occur."""
        names, counts = np.unique(self.verdict, return_counts=True)
        return {str(w): int(c) for w, c in zip(names, counts, strict=True) if w}

    def _ending(self) -> str:
        """Counts of the verdicts, for the end of a line."""
        counts = [f"{count} {verdict}" for verdict, count in self.verdicts().items()]
        counts += [f"{lost} ran away"] if (lost := int(self.ran_away.sum())) else []
        return (
            f"{': ' if counts else ''}{', '.join(counts)}{'' if self.complete else ', interrupted'}"
        )


def signal_name(system: System, signal: int | str) -> str:
    """Name of the evaluated contact or coordinate."""
    names = tuple(system.names)
    if isinstance(signal, str) and signal in names:
        return signal
    if isinstance(signal, int) and 0 <= signal < len(system.contacts):
        return f"contact {signal}"
    if signal == 0 and not system.contacts:
        return names[0]
    why = f"The number of one of {len(system.contacts)} contacts, or one of {', '.join(names)}"
    raise InputError(f"signal = {signal!r}", "argument signal", why, "Choose one of these")


@dataclass(frozen=True)
class Survey:
    """How motions are marched, and what is measured of them."""

    transient: int  #: mesh cycles before, fewer where the motion repeats
    cycles: int  #: mesh cycles of the statistics of a motion that does not repeat
    keep: int  #: number of last mesh cycles whose points are stored
    signal: int | str  #: contact whose compression is evaluated, or name of a coordinate
    keep_partial: bool = False  #: whether an interruption leaves what is finished
    tolerance: float = 1e-7  #: certified distance to the motion that repeats, over its size
    width: int = 16  #: lanes of one block
    checkpoints: Checkpoints = field(default_factory=Checkpoints, repr=False, compare=False)
    stop: threading.Event = field(default_factory=threading.Event, repr=False, compare=False)

    def uninterrupted(self, work: Callable[[], None]) -> None:
        """Run ``work``; suppress an interruption if partial results are requested."""
        try:
            work()
        except KeyboardInterrupt:
            self.stop.set()
            if not self.keep_partial:
                raise

    def settle(self, motions: Motions, indices: Index, progress: Progress = SILENT) -> None:
        """March motions until they repeat, or over the whole transient."""
        width = 1 if indices.size == 1 else self.width
        self.uninterrupted(
            lambda: settle(
                motions,
                indices,
                self.transient,
                tolerance=self.tolerance,
                width=width,
                progress=progress,
            )
        )


#: Most steps of all compiled systems in the cache together, some 60 MB.
_CACHED_STEPS = 2**16


class Points:
    """Systems, mesh frequencies, factors and steps of all motions of a survey."""

    def __init__(
        self,
        systems: Sequence[System],
        mesh_frequency: Array,
        steps: Index,
        factors: dict[str, Array] | None = None,
    ) -> None:
        self.systems, self.mesh_frequency, self.steps = list(systems), mesh_frequency, steps
        self.factors = factors or {}
        self.count, self.size = len(self.systems), self.systems[0].size
        self.step_number = np.zeros(self.count)
        self._compiled: dict[int, Compiled] = {}
        self._lock = threading.Lock()
        groups: dict[tuple[int, int], list[int]] = {}
        for number, system in enumerate(self.systems):
            groups.setdefault((id(system), int(steps[number])), []).append(number)
        self.groups = [np.array(group, dtype=np.int64) for group in groups.values()]

    def compiled(self, group: Index) -> Compiled:
        """System of a group on its grid; notes ``omega_max * dt``."""
        slowest = float(self.mesh_frequency[group].min())
        first = int(group[0])
        with self._lock:
            compiled = self._compiled.pop(first, None)
        if compiled is None:
            steps = int(self.steps[first])
            # Lanes with factors of their own are not integrated in modal coordinates.
            compile_group = compile_lanes if self.factors else compile_motion
            compiled = compile_group(self.systems[first], slowest, steps, any_step=True)
            numbers = compiled.limited_number * slowest / self.mesh_frequency[group]
            self.step_number[group] = numbers
        with self._lock:  # The other branch requests the groups in reverse order.
            self._compiled[first] = compiled
            while sum(each.grid.steps for each in self._compiled.values()) > _CACHED_STEPS:
                del self._compiled[next(iter(self._compiled))]
        return compiled

    def motions(self, compiled: Compiled, group: Index, outcomes: Outcomes) -> Motions:
        """Motions of a group from the starts in their outcomes."""
        factors = {name: values[group] for name, values in self.factors.items()}
        starts = outcomes.first[group], outcomes.force[group]
        return Motions(compiled, self.mesh_frequency[group], *starts, factors)

    def refined(self, steps: Index) -> Points:
        """The same with other steps."""
        return Points(self.systems, self.mesh_frequency, steps, self.factors)


class Outcomes:
    """Results of all motions of a survey, filled during the time integration."""

    def __init__(self, count: int, keep: int, size: int, name: str = "") -> None:
        self.name = name  #: prefix of the names of checkpoints
        self.section = np.full((count, keep), np.nan)
        self.period = np.zeros(count, dtype=np.int64)
        self.rms, self.contact_loss_share = np.full(count, np.nan), np.full(count, np.nan)
        #: States at the start, when settled, and after the statistics.
        self.first, self.settled, self.last = (np.full((count, 2 * size), np.nan) for _ in range(3))
        self.force = np.zeros((count, size))
        #: Period when settled, and the rate at which a disturbance shrinks within it.
        self.repeats, self.rate = np.zeros(count, dtype=np.int64), np.ones(count)
        self.finished = np.zeros(count, dtype=bool)

    def verdict(self, number: int, step_number: float, finer: Outcomes) -> str:
        """What shorter steps say of a motion; empty where one of both is not finished."""
        if not (self.finished[number] and finer.finished[number]):
            return ""
        facts = [(int(row.period[number]), float(row.rms[number])) for row in (self, finer)]
        return step_verdict(float(step_number), *facts[0], *facts[1])

    def fill(self, survey: Survey, motions: Motions, indices: Index, numbers: Index) -> None:
        """Measure those of some motions that are finished."""
        done = motions.finished[indices]
        index, to = indices[done], numbers[done]
        figures = measure(motions, index, survey)
        self.first[to], self.settled[to] = motions.start[index], motions.state[index]
        self.section[to] = figures.points
        self.period[to] = figures.period
        self.rms[to] = figures.rms
        self.contact_loss_share[to], self.last[to] = figures.contact_loss_share, figures.last
        self.force[to], self.finished[to] = motions.force[index], True
        self.repeats[to], self.rate[to] = motions.period[index], motions.rate[index]


def march_group(
    points: Points,
    survey: Survey,
    outcomes: Outcomes,
    group: Index,
    chosen: Mask | None = None,
    progress: Progress = SILENT,
) -> None:
    """March motions of one group from ``outcomes.first``, or from rest where that is unknown."""
    compiled = points.compiled(group)
    unknown = group[~np.all(np.isfinite(outcomes.first[group]), axis=1)]
    if unknown.size:
        outcomes.first[unknown] = static_start(compiled)
    motions = points.motions(compiled, group, outcomes)
    indices = np.arange(group.size) if chosen is None else np.flatnonzero(chosen[group])
    if outcomes.name:
        motions.use_checkpoints(
            survey.checkpoints, [f"{outcomes.name} {number}" for number in group]
        )
    if indices.size:
        left = indices[~motions.finished[indices]]
        progress.advance(indices.size - left.size)
        if left.size:
            survey.settle(motions, left, progress)
        outcomes.fill(survey, motions, indices, group[indices])


def march_points(
    points: Points, survey: Survey, *rows: tuple[Outcomes, Mask | None], progress: Progress = SILENT
) -> None:
    """Integrate all motions in batches, each from its start; ``rows`` may select some of them."""

    def wanted(group: Index) -> list[tuple[Outcomes, Mask | None]]:
        return [row for row in rows if row[1] is None or row[1][group].any()]

    def march(group: Index) -> None:
        for outcomes, chosen in wanted(group):
            if not survey.stop.is_set():
                march_group(points, survey, outcomes, group, chosen, progress)

    groups = [group for group in points.groups if wanted(group)]
    alone = [group for group in groups if group.size == 1]
    if alone:
        survey.uninterrupted(lambda: each_in_threads(march, alone))
    for group in groups:
        if group.size > 1:
            march(group)


def each_in_threads(function: Callable[[Any], None], items: Sequence[object]) -> None:
    """Call a function with every item, on as many threads as there are cores."""
    in_threads(function, items, os.cpu_count() or 1)


def comes_back(points: Points, outcomes: Outcomes) -> Mask:
    """Motions whose period with these shorter steps ends so near that both motions are the same."""
    same = np.zeros(points.count, dtype=bool)
    for group in points.groups:
        compiled = points.compiled(group)
        motions = points.motions(compiled, group, outcomes)
        repeats, rate = outcomes.repeats[group], outcomes.rate[group]
        for period in np.unique(repeats[repeats > 0]):
            index = np.flatnonzero((repeats == period) & (rate < 1.0))
            if not index.size:
                continue
            state, force = outcomes.settled[group[index]], outcomes.force[group[index]]
            try:
                new = motions.march(index, state, int(period), force)
            except ComputationError:
                continue
            begin, end = (motions.reduce(each, index) for each in (state, new))
            distance = lengths(end - begin) / (1.0 - rate[index])
            same[group[index]] = distance <= _AGREES * lengths(begin)
    return same


class Figures(NamedTuple):
    """Statistics of motions that continue from their last state; shapes are (motions, ...)."""

    points: Array  #: the signal once per mesh cycle [m or rad]
    period: Index  #: mesh cycles after which it repeats
    rms: Array  #: alternating rms of the signal [m or rad]
    contact_loss_share: Array  #: part of the time off the driving flank [-]
    last: Array  #: last state [mixed]


class Path(NamedTuple):
    """Motions once per mesh cycle, and statistics of their signal over all of these cycles."""

    states: Array  #: at the mesh phase 0, (cycles, lanes, 2 n) [mixed]
    points: Array  #: the signal, (cycles, lanes) [m or rad]
    rms: Array  #: alternating rms of the signal, (lanes,) [m or rad]
    largest: Array  #: largest size of the signal, (lanes,) [m or rad]
    contact_loss_share: Array  #: part of the time off the driving flank, (lanes,) [-]
    last: Array  #: state at the end [mixed]


def measure(motions: Motions, indices: Index, survey: Survey) -> Figures:
    """Continue from the last states and compute statistics."""
    nan = np.full(indices.size, np.nan)
    figures = Figures(
        np.full((indices.size, survey.keep), np.nan),
        np.zeros(indices.size, dtype=np.int64),
        nan,
        nan.copy(),
        np.full((indices.size, motions.start.shape[1]), np.nan),
    )
    alive = np.all(np.isfinite(motions.state[indices]), axis=1)
    for period in np.unique(motions.period[indices]):
        rows = np.flatnonzero(alive & (motions.period[indices] == period))
        if rows.size:
            _measure_rows(motions, indices, rows, int(period), survey, figures)
    return figures


def _measure_rows(
    motions: Motions, indices: Index, rows: Index, period: int, survey: Survey, figures: Figures
) -> None:
    """Evaluate motions of one period in a batch; separately if one grows beyond all bounds."""
    index = indices[rows]
    try:
        path = follow(motions, index, motions.state[index], period or survey.cycles, survey.signal)
    except ComputationError:
        if rows.size > 1:
            for row in rows:
                _measure_rows(motions, indices, np.array([row]), period, survey, figures)
        return
    keep = survey.keep
    history = motions.reduce(path.states[-keep:], index)
    figures.points[rows] = np.resize(path.points[-keep:], (keep, rows.size)).T
    figures.period[rows] = period or [open_period(history[:, n]) for n in range(rows.size)]
    figures.rms[rows], figures.last[rows] = path.rms, path.last
    figures.contact_loss_share[rows] = path.contact_loss_share


def follow(
    motions: Motions, index: Index, state: Array, cycles: int, signal: int | str, elapsed: int = 0
) -> Path:
    """March motions cycle by cycle, and gather statistics of their signal."""
    system = motions.compiled.system
    contacts, size, lanes = len(system.contacts), system.size, index.size
    outputs = np.zeros((1, 2 * size))
    if isinstance(signal, str):
        outputs[0, tuple(system.names).index(signal)] = 1.0
    row = -1 if isinstance(signal, str) else signal
    flank = contacts + (signal if isinstance(signal, int) else 0)
    states, total, largest = np.empty((cycles, *state.shape)), np.zeros((3, lanes)), np.zeros(lanes)
    fresh = Statistics.of(motions.compiled, outputs, lanes)
    for cycle in range(cycles):
        states[cycle] = state
        statistics = fresh._replace(moments=fresh.moments.copy())
        state = motions.march(
            index,
            state,
            1,
            motions.force[index],
            statistics=statistics,
            threads=os.cpu_count() or 1,
            elapsed=elapsed + cycle,
        )
        state = motions.at_rest(state)
        moments = statistics.figures
        total[:2] += moments[row, :2] / cycles
        largest = np.maximum(largest, np.abs(moments[row, 2:4]).max(axis=0))
        if contacts:
            total[2] += moments[flank, 4] / cycles
    # A motion on its way beyond all bounds has no rms.
    with np.errstate(over="ignore", invalid="ignore"):
        rms = np.sqrt(np.maximum(total[1] - total[0] ** 2, 0.0))
    points = _signal(motions, states, signal, outputs[0])
    return Path(states, points, rms, largest, total[2], state)


def _signal(motions: Motions, state: Array, signal: int | str, output: Array) -> Array:
    """Compression of the contact, or the coordinate, at the mesh phase 0."""
    if isinstance(signal, str):
        return each_times(state, output[:, None])[..., 0]
    nodes = motions.compiled.nodes
    place = state[..., : state.shape[-1] // 2]
    along = each_times(place, nodes.direction[0, 0, signal, :, None])[..., 0]
    return np.asarray(along - nodes.error[0, 0, signal])
