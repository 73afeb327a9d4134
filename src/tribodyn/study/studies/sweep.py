"""Parameter sweeps: run a case over the values of one of its keys, or over a grid of several."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager, nullcontext
from functools import partial
from itertools import product
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar

from tribodyn.aliases import with_old_names
from tribodyn.checkpoints import Checkpoints
from tribodyn.errors import ComputationError, InputError, quiet
from tribodyn.interrupt import STOPPED, refuse_stopped, stop_flag
from tribodyn.mesh.film.film_lookup import shared_films
from tribodyn.progress import SILENT, Progress
from tribodyn.study.first_use import compile_in_parallel
from tribodyn.study.pipeline.run import (
    PendingRun,
    PreparedRun,
    find_motions,
    prepare_run,
    with_tables,
)
from tribodyn.study.studies.case_grid import points_of_parts
from tribodyn.study.studies.runner import Groups, identity, run_groups
from tribodyn.study.studies.study_axes import Axis, read_axes
from tribodyn.study.studies.sweep_result import Sweep, SweepPoint
from tribodyn.types import ByName

if TYPE_CHECKING:
    from tribodyn.study.case.pair import PairCase
    from tribodyn.study.machine.case import AnyCase

Value = TypeVar("Value")

#: Number of points from which a shared table of solved films costs less than separate films.
_SHARED_FILM_POINTS = 4
#: Largest number of points in a group, and motions that are integrated in one batch.
_GROUP_SIZE, _BATCH = 16, 8


@with_old_names
def sweep(
    case: AnyCase,
    over: str | ByName = "operation.speed",
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
    case : Case
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
    source = _source(case, tuple(axis.key for axis in axes))
    computed = compute_points(axes, source, study, checkpoints, partly=partial, progress=progress)
    return Sweep(case, axes, computed)


class PointSource(NamedTuple):
    """How a study computes its points from the values of its keys."""

    points_at: Callable[..., list[SweepPoint]]  #: of the places of a group
    #: Run of a pair at a place, for the kernels that it needs first.
    pending_at: Callable[..., PendingRun] | None = None

    def points(
        self, places: Sequence[tuple[Any, ...]], progress: Progress = SILENT, **options: Any
    ) -> list[SweepPoint]:
        """Compute the points of all places; options are those of ``run_groups``."""
        compute, groups = self.points_at, Groups(_GROUP_SIZE, self.points_at)
        if self.pending_at is not None:
            groups = groups._replace(compiling=partial(_compiling, self.pending_at))
        else:  # A machine names the stages of each point, which are computed one after the other.
            compute = partial(self.points_at, progress=progress)
            groups = groups._replace(warm_up=1)
        return run_groups(compute, places, groups=groups, progress=progress, **options)


def pair_source(pending_at: Callable[..., PendingRun]) -> PointSource:
    """Points of a gear pair whose runs a function of the values returns."""
    return PointSource(partial(_points, pending_at), pending_at)


def _source(case: AnyCase, keys: Sequence[str]) -> PointSource:
    if not case.lumped:
        return PointSource(partial(points_of_parts, case, keys))
    return pair_source(partial(_pending_at, case, keys))


def _pending_at(case: PairCase, keys: Sequence[str], *values: object) -> PendingRun:
    return PendingRun(case.replace(dict(zip(keys, values, strict=True))))


def compute_points(
    axes: tuple[Axis, ...],
    source: PointSource,
    study: Mapping[str, object],
    checkpoints: Checkpoints | None,
    **options: Any,
) -> tuple[SweepPoint, ...]:
    """Compute every point of a grid, except those that the checkpoints hold."""
    grid = list(product(*(axis.values for axis in axes)))
    checkpoints = (Checkpoints() if checkpoints is None else checkpoints).begin(study)
    earlier = {
        index: SweepPoint(grid[index], figures, failed, tuple(warned))
        for index in range(len(grid) if len(checkpoints) else 0)
        for figures, failed, warned in [checkpoints.get(str(index)) or (None, "", ())]
        if figures is not None
    }

    def store(index: int, point: SweepPoint) -> None:
        checkpoints.keep(str(index), (dict(point.figures), point.failed, point.warned))

    # By the size of the grid: a resumed sweep has the same figures as an uninterrupted one.
    with shared_films() if len(grid) >= _SHARED_FILM_POINTS else nullcontext():
        return tuple(source.points(grid, task="Values", earlier=earlier, store=store, **options))


def points_under(
    case: AnyCase, changes: Sequence[Mapping[str, object]], progress: Progress = SILENT
) -> list[SweepPoint]:
    """Compute a case for several changes of the same keys; a failed point holds its reason."""
    source = _source(case, tuple(changes[0]) if changes else ())
    return source.points([tuple(change.values()) for change in changes], progress)


def _read_ranges(over: str | ByName, between: Any, points: int) -> ByName:
    if isinstance(over, str):
        if between is None or len(between) != 2:
            remedy = 'Write, for example, between=("400 rpm", "3500 rpm")'
            raise InputError(f"between = {between}", "argument between", "", remedy)
        return {over: (*between, points)}
    if between is not None:
        why = "A mapping of several keys has the ends in over"
        raise InputError(f"between = {between}", "argument between", why, "Remove it")
    return over


@contextmanager
def _compiling(
    pending_at: Callable[..., PendingRun], places: Sequence[tuple[object, ...]]
) -> Iterator[bool]:
    """Compile in parallel what the first of some points needs; yield whether it needs anything."""
    pending = _try(partial(pending_at, *places[0]))
    if not isinstance(pending, PendingRun):
        yield False
        return
    with compile_in_parallel(pending.case, "map" if len(places) >= _BATCH else "run") as compiles:
        yield compiles


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
    values: tuple[object, ...], point: PreparedRun | InputError | ComputationError
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
