"""Parameter sweeps: run a case over the values of one of its keys, or over a grid of several."""

from __future__ import annotations

import functools
import os
import pickle
import threading
from collections.abc import Callable, Mapping, Sequence
from contextlib import nullcontext, suppress
from functools import partial
from itertools import product
from typing import TYPE_CHECKING, Any, TypeVar

from tribodyn.aliases import with_old_names
from tribodyn.checkpoints import Checkpoints
from tribodyn.errors import ComputationError, InputError, quiet
from tribodyn.interrupt import STOPPED, in_threads, refuse_stopped, stop_flag
from tribodyn.mesh.film.film_lookup import shared_films
from tribodyn.model import known_elsewhere
from tribodyn.progress import SILENT, Progress
from tribodyn.study.first_use import compile_in_parallel
from tribodyn.study.pipeline.run import (
    PendingRun,
    PreparedRun,
    find_motions,
    prepare_run,
    with_tables,
)
from tribodyn.study.processes import helpers
from tribodyn.study.studies.case_grid import finished, identity, points_of_parts
from tribodyn.study.studies.study_axes import Axis, read_axes
from tribodyn.study.studies.sweep_result import Sweep, SweepPoint

if TYPE_CHECKING:
    from tribodyn.study.case.case import Case
    from tribodyn.study.machine.case import MachineCase

Value = TypeVar("Value")
#: Computes points of a grid by the values of the keys; prepares one of them.
PointsAt = Callable[..., Sequence[SweepPoint]]
CaseAt = Callable[..., PendingRun]

#: Number of points from which a shared table of solved films costs less than separate films.
_SHARED_FILM_POINTS = 4


@with_old_names
def sweep(
    case: Case | MachineCase,
    over: str | Mapping[str, Any] = "operation.speed",
    between: tuple[Any, Any] | None = None,
    points: int = 40,
    *,
    partial: bool = False,
    by: str = "",
    progress: Progress = SILENT,
    checkpoints: Checkpoints | None = None,
) -> Sweep:
    """Compute a case at many values of one or several of its keys.

    Parameters
    ----------
    case : Case or MachineCase
        From :func:`tribodyn.load_case`.
    over : str or mapping
        Dotted key that varies; or several, each with ``(first, last, points)``, a tuple, or a
        list of values. Several keys make a grid, in which the last one varies fastest.
    between : tuple
        Its two ends where ``over`` is one key: floats in SI, or text with a unit.
    points : int
        Number of values, evenly spaced, the ends included.
    partial : bool
        Return the finished values when interrupted with Ctrl-C, instead of raising.
    by : str
        Name of the caller in messages; if set, a bare number for a dimension is refused as in a
        file.
    progress : Progress
        Receives the number of finished values; silent by default.
    checkpoints : tribodyn.checkpoints.Checkpoints, optional
        Stores each finished value, and restores those that a killed process had finished.

    Returns
    -------
    Sweep
        All figures of the summary over the keys; NaN for a value that cannot be computed, with the
        reason in ``failed``.

    Raises
    ------
    InputError
        If a key is unknown, or one of its values out of range.

    Notes
    -----
    Values are computed in parallel: in threads, or, if there are many, in worker processes. These
    load no script and so need no ``if __name__ == "__main__"``. If a script registers its own
    model, threads are used. An interrupted sweep returns the finished values up to the first that
    is not finished.

    Examples
    --------
    >>> import tribodyn
    >>> case = tribodyn.load_case("time-varying-friction")
    >>> result = sweep(case, {"friction.law": ["none", "xu-2007"]})
    >>> bool(result["mean_friction_power"][0] < result["mean_friction_power"][1])
    True
    """
    axes = read_axes(case, _read_ranges(over, between, points), by=by)
    study = identity("sweep", case, [(axis.key, axis.values) for axis in axes])

    sources = _sources(case, tuple(axis.key for axis in axes))
    return Sweep(case, axes, _compute(axes, *sources, study, partial, progress, checkpoints))


def _sources(case: Case | MachineCase, keys: Sequence[str]) -> tuple[PointsAt, CaseAt | None]:
    """What computes a case at values of its keys, and the pair whose kernels it needs first."""
    if not case.lumped:
        return partial(points_of_parts, case, keys), None
    pending_at = partial(_pending_at, case, keys)
    return partial(_points, pending_at), pending_at


def _pending_at(case: Case, keys: Sequence[str], *values: Any) -> PendingRun:
    return PendingRun(case.replace(dict(zip(keys, values, strict=True))))


def compute_points(
    axes: tuple[Axis, ...],
    pending_at: Callable[..., PendingRun],
    study: Mapping[str, Any],
    partial: bool,
    progress: Progress,
    checkpoints: Checkpoints | None,
) -> tuple[SweepPoint, ...]:
    """Compute every point of a grid in parallel, except those that the checkpoints hold."""
    points_at = functools.partial(_points, pending_at)
    return _compute(axes, points_at, pending_at, study, partial, progress, checkpoints)


def _compute(
    axes: tuple[Axis, ...],
    points_at: PointsAt,
    case_at: CaseAt | None,
    study: Mapping[str, Any],
    partial: bool,
    progress: Progress,
    checkpoints: Checkpoints | None,
) -> tuple[SweepPoint, ...]:
    grid = list(product(*(axis.values for axis in axes)))
    checkpoints = (Checkpoints() if checkpoints is None else checkpoints).begin(study)
    done = {
        index: SweepPoint(grid[index], figures, failed, tuple(warned))
        for index in range(len(grid) if len(checkpoints) else 0)
        for figures, failed, warned in [checkpoints.get(str(index)) or (None, "", ())]
        if figures is not None
    }

    def store(index: int, point: SweepPoint) -> None:
        checkpoints.keep(str(index), (dict(point.figures), point.failed, point.warned))

    progress.start("Values", len(grid))
    try:
        # By the size of the grid: a resumed sweep has the same figures as an uninterrupted one.
        with shared_films() if len(grid) >= _SHARED_FILM_POINTS else nullcontext():
            _over_points(points_at, case_at, grid, done, progress, store)
    except KeyboardInterrupt:
        if not (partial and 0 in done):
            raise
    progress.finish()
    return tuple(finished(done))


def points_under(
    case: Case | MachineCase, changes: Sequence[Mapping[str, Any]], progress: Progress = SILENT
) -> list[SweepPoint]:
    """Compute a case for several changes of the same keys; a failed point holds its reason."""
    done: dict[int, SweepPoint] = {}
    sources = _sources(case, tuple(changes[0]) if changes else ())
    _over_points(*sources, [tuple(change.values()) for change in changes], done, progress)
    return [done[index] for index in range(len(changes))]


def _read_ranges(over: str | Mapping[str, Any], between: Any, points: int) -> Mapping[str, Any]:
    if isinstance(over, str):
        if between is None or len(between) != 2:
            remedy = 'Write, for example, between=("400 rpm", "3500 rpm")'
            raise InputError(f"between = {between}", "argument between", "", remedy)
        return {over: (*between, points)}
    if between is not None:
        why = "A mapping of several keys has the ends in over"
        raise InputError(f"between = {between}", "argument between", why, "Remove it")
    return over


#: Largest number of points in a group, and number of groups for each processor.
_GROUP_SIZE, _GROUPS_PER_CPU = 16, 4
#: Motions that are integrated in one batch.
_BATCH = 8
#: Number of points that justifies a worker process.
_POINTS_PER_PROCESS = 50


def _over_points(
    points_at: PointsAt,
    case_at: CaseAt | None,
    grid: Sequence[tuple[Any, ...]],
    done: dict[int, SweepPoint],
    progress: Progress,
    store: Callable[[int, SweepPoint], None] = lambda index, point: None,
) -> None:
    """Compute the points that are not in ``done`` yet, in groups and in parallel."""
    remaining = [index for index in range(len(grid)) if index not in done]
    count = os.cpu_count() or 1
    size = min(_GROUP_SIZE, max(1, len(remaining) // (_GROUPS_PER_CPU * count)))
    size -= size % _BATCH if size > _BATCH else 0
    groups = [remaining[first : first + size] for first in range(0, len(remaining), size)]
    places = [[grid[index] for index in members] for members in groups]
    lock = threading.Lock()
    progress.advance(len(done))

    def keep_group(number: int, points: Sequence[SweepPoint]) -> None:
        for index, point in zip(groups[number], points, strict=True):
            store(index, point)
            with lock:
                done[index] = point
                progress.advance()

    first = _first_use(points_at, case_at, places, partial(keep_group, 0))
    del groups[:first], places[:first]
    pickled = _pickled(points_at)
    with helpers(len(remaining) // _POINTS_PER_PROCESS if pickled else 0) as workers:
        if pickled and workers.count:
            # The points of machines are computed one after the other: one loads all that they need.
            first_call = places[0][:1] if case_at is None else None
            workers.each(points_at, pickled, places, keep_group, first_call)
        else:
            if case_at is None:  # a machine names the stages of each point
                points_at = partial(points_at, progress=progress)
            numbers = range(len(groups))
            in_threads(lambda i: keep_group(i, points_at(places[i])), numbers, count)


def _first_use(
    points_at: PointsAt,
    case_at: CaseAt | None,
    places: Sequence[Sequence[tuple[Any, ...]]],
    store: Callable[[Sequence[SweepPoint]], None],
) -> int:
    """Compute the first group alone if kernels must be compiled; return the number of groups."""
    # Groups in parallel threads or processes would all wait for the same kernels.
    pending = _try(partial(case_at, *places[0][0])) if places and case_at else None
    if not isinstance(pending, PendingRun):
        return 0
    study = "map" if len(places[0]) >= _BATCH else "run"
    with compile_in_parallel(pending.case, study) as compiles:
        if compiles:
            store(points_at(places[0]))
    return int(compiles)


def _pickled(points_at: PointsAt) -> bytes:
    """Pickle the function that a worker process calls; empty if it cannot be pickled."""
    if known_elsewhere():
        with suppress(pickle.PicklingError, AttributeError, TypeError):
            return pickle.dumps(partial(_points_in_process, points_at))
    return b""


def _points_in_process(
    points_at: PointsAt, places: Sequence[tuple[Any, ...]]
) -> Sequence[SweepPoint]:
    with shared_films(persistent=True):
        return points_at(places)


def _points(
    pending_at: Callable[..., PendingRun], places: Sequence[tuple[Any, ...]]
) -> list[SweepPoint]:
    """Run the case at several grid points; a failed point holds its reason."""
    with quiet():  # the results store the warnings of the models
        pending = [_try(partial(pending_at, *values)) for values in places]
        tables = iter(with_tables([run for run in pending if isinstance(run, PendingRun)]))
        points = [
            _try(partial(_prepare, next(tables))) if isinstance(run, PendingRun) else run
            for run in pending
        ]
        find_motions([point for point in points if isinstance(point, PreparedRun)])
        return [_point(values, point) for values, point in zip(places, points, strict=True)]


def _prepare(pending: PendingRun) -> PreparedRun:
    return prepare_run(pending.case, mesh_source=pending.mesh_source)


def _point(
    values: tuple[Any, ...], point: PreparedRun | InputError | ComputationError
) -> SweepPoint:
    outcome = _try(partial(_figures, point)) if isinstance(point, PreparedRun) else point
    if isinstance(outcome, Exception):
        return SweepPoint.of_failure(values, outcome)
    return SweepPoint(values, *outcome)


def _figures(point: PreparedRun) -> tuple[dict[str, float], str, tuple[str, ...]]:
    result = point.result()
    return result.summary(), "", tuple(warning.code for warning in result.warnings)


def _try(compute: Callable[[], Value]) -> Value | InputError | ComputationError:
    refuse_stopped(STOPPED * int(stop_flag()[0]))
    try:
        return compute()
    except (InputError, ComputationError) as error:
        return error
