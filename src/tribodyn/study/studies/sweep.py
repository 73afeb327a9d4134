"""Sweeps: the whole pipeline over values of one key of the case, or over a grid of several."""

from __future__ import annotations

import dataclasses
import functools
import os
import pickle
import threading
from collections.abc import Callable, Mapping, Sequence
from contextlib import nullcontext, suppress
from functools import partial
from itertools import product
from typing import TYPE_CHECKING, Any, TypeVar

from tribodyn.checkpoints import Members
from tribodyn.errors import ComputationError, InputError, quiet
from tribodyn.interrupt import STOPPED, in_threads, refuse_stopped, stop_flag
from tribodyn.mesh.film.film_lookup import shared_films
from tribodyn.model import known_elsewhere
from tribodyn.progress import SILENT, Progress
from tribodyn.study.first_use import compile_in_parallel
from tribodyn.study.pipeline.run import Asked, Begun, begin, move_together, with_tables
from tribodyn.study.processes import helpers
from tribodyn.study.studies.axes import Axis, read_axes
from tribodyn.study.studies.grid import finished, identity
from tribodyn.study.studies.sweep_result import Sweep, SweepPoint

if TYPE_CHECKING:
    from tribodyn.study.case.case import Case

Value = TypeVar("Value")

#: Points from which on a table of solved films costs less than films of their own.
_MANY = 4


def sweep(
    case: Case,
    over: str | Mapping[str, Any] = "operation.speed",
    between: tuple[Any, Any] | None = None,
    points: int = 40,
    *,
    partial: bool = False,
    by: str = "",
    progress: Progress = SILENT,
    members: Members | None = None,
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
        Values between them, evenly spaced, the ends included.
    partial : bool
        Return what is done when the computation is interrupted with Ctrl-C, in place of nothing.
    by : str
        What asks, for messages; then a bare number for a dimension is refused as in a file.
    progress : Progress
        Told how many values are done; silent by default.
    members : tribodyn.checkpoints.Members, optional
        Keeps every value as it is finished, and has those that a killed process finished.

    Returns
    -------
    Sweep
        Every figure of the summary over the keys. A value that cannot be computed leaves NaN and
        the reason in ``failed``.

    Raises
    ------
    InputError
        If a key is unknown, or one of its values out of range.

    Notes
    -----
    Several values are computed at a time; many of them by processes beside this one, which load
    no script and so need no ``if __name__ == "__main__"``. Where a script registers a model of its
    own they are computed in threads. An interrupted sweep keeps the values that are finished, up
    to the first that is not.

    Examples
    --------
    >>> import tribodyn
    >>> case = tribodyn.load_case("time-varying-friction")
    >>> found = sweep(case, {"friction.law": ["none", "xu-2007"]})
    >>> bool(found["mean_friction_power"][0] < found["mean_friction_power"][1])
    True
    """
    axes = read_axes(case, _asked(over, between, points), by=by)
    study = identity("sweep", case, [(axis.key, axis.values) for axis in axes])

    asked = functools.partial(_asked_at, case, tuple(axis.key for axis in axes))
    return Sweep(case, axes, points_of(axes, asked, study, partial, progress, members))


def _asked_at(case: Case, keys: Sequence[str], *values: Any) -> Asked:
    return Asked(case.replace(dict(zip(keys, values, strict=True))))


def points_of(
    axes: tuple[Axis, ...],
    asked: Callable[..., Asked],
    study: Mapping[str, Any],
    partial: bool,
    progress: Progress,
    members: Members | None,
) -> tuple[SweepPoint, ...]:
    """Compute every place of a grid, several at a time; what is kept of the study is there."""
    grid = list(product(*(axis.values for axis in axes)))
    kept = (Members() if members is None else members).begin(study)
    done = {
        index: SweepPoint(grid[index], figures, failed, tuple(warned))
        for index in range(len(grid) if len(kept) else 0)
        for figures, failed, warned in [kept.get(str(index)) or (None, "", ())]
        if figures is not None
    }

    def keep(index: int, found: SweepPoint) -> None:
        kept.keep(str(index), (dict(found.figures), found.failed, found.warned))

    progress.start("Values", len(grid))
    try:
        # Not by what is left: a sweep that goes on has the figures of one that was not stopped.
        with shared_films() if len(grid) >= _MANY else nullcontext():
            _over_points(asked, grid, done, progress, keep)
    except KeyboardInterrupt:
        if not (partial and 0 in done):
            raise
    progress.finish()
    return tuple(finished(done))


def points_under(
    case: Case, changes: Sequence[Mapping[str, Any]], progress: Progress = SILENT
) -> list[SweepPoint]:
    """Compute a case under some changes of the same keys, in their order; what fails is told."""
    done: dict[int, SweepPoint] = {}
    asked = partial(_asked_at, case, tuple(changes[0]) if changes else ())
    _over_points(asked, [tuple(change.values()) for change in changes], done, progress)
    return [done[index] for index in range(len(changes))]


def _asked(over: str | Mapping[str, Any], between: Any, points: int) -> Mapping[str, Any]:
    if isinstance(over, str):
        if between is None or len(between) != 2:
            remedy = 'Write, for example, between=("400 rpm", "3500 rpm")'
            raise InputError(f"between = {between}", "argument between", "", remedy)
        return {over: (*between, points)}
    if between is not None:
        why = "Several keys have their ends in over"
        raise InputError(f"between = {between}", "argument between", why, "Remove it")
    return over


#: Points at most that are computed together, and groups of them for each processor.
_TOGETHER, _GROUPS = 16, 4
#: Motions that march side by side.
_ABREAST = 8
#: Points for which it pays to begin a process.
_WORTH = 50


def _over_points(
    asked: Callable[..., Asked],
    grid: Sequence[tuple[Any, ...]],
    done: dict[int, SweepPoint],
    progress: Progress,
    keep: Callable[[int, SweepPoint], None] = lambda index, point: None,
) -> None:
    """Compute what is not ``done`` yet of some points, in groups, several at a time."""
    left = [index for index in range(len(grid)) if index not in done]
    count = os.cpu_count() or 1
    size = min(_TOGETHER, max(1, len(left) // (_GROUPS * count)))
    size -= size % _ABREAST if size > _ABREAST else 0
    groups = [left[first : first + size] for first in range(0, len(left), size)]
    places = [[grid[index] for index in members] for members in groups]
    lock = threading.Lock()
    progress.advance(len(done))

    def keep_group(number: int, points: Sequence[SweepPoint]) -> None:
        for index, point in zip(groups[number], points, strict=True):
            keep(index, point)
            with lock:
                done[index] = point
                progress.advance()

    first = _first_use(asked, places, partial(keep_group, 0))
    del groups[:first], places[:first]
    abroad = _abroad(asked)
    with helpers(len(left) // _WORTH if abroad else 0) as others:
        if abroad and others.count:
            others.each(partial(_points, asked), abroad, places, keep_group)
        else:
            numbers = range(len(groups))
            in_threads(lambda i: keep_group(i, _points(asked, places[i])), numbers, count)


def _first_use(
    asked: Callable[..., Asked],
    places: Sequence[Sequence[tuple[Any, ...]]],
    keep: Callable[[Sequence[SweepPoint]], None],
) -> int:
    """Compute the first group by itself where kernels are to be compiled; return their number."""
    # Several groups at a time, be it in threads or processes, would wait for the same kernels.
    known = _tried(partial(asked, *places[0][0])) if places else None
    if not isinstance(known, Asked):
        return 0
    study = "map" if len(places[0]) >= _ABREAST else "run"
    with compile_in_parallel(known.case, study) as compiles:
        if compiles:
            keep(_points(asked, places[0]))
    return int(compiles)


def _abroad(asked: Callable[..., Asked]) -> bytes:
    """What another process calls; nothing where it could not."""
    if known_elsewhere():
        with suppress(pickle.PicklingError, AttributeError, TypeError):
            return pickle.dumps(partial(_points_abroad, asked))
    return b""


def _points_abroad(
    asked: Callable[..., Asked], places: Sequence[tuple[Any, ...]]
) -> list[SweepPoint]:
    with shared_films(lasting=True):
        return _points(asked, places)


def _points(asked: Callable[..., Asked], places: Sequence[tuple[Any, ...]]) -> list[SweepPoint]:
    """Run the case at some places; what fails is told, and the sweep goes on."""
    with quiet():  # what the models say is kept in the results
        found = [_tried(partial(asked, *values)) for values in places]
        tables = iter(with_tables([each for each in found if isinstance(each, Asked)]))
        points = [
            _tried(partial(_begun, next(tables))) if isinstance(each, Asked) else each
            for each in found
        ]
        move_together([point for point in points if isinstance(point, Begun)])
        return [_point(values, point) for values, point in zip(places, points, strict=True)]


def _begun(asked: Asked) -> Begun:
    return begin(asked.case, known=asked.known)


def _point(values: tuple[Any, ...], point: Begun | InputError | ComputationError) -> SweepPoint:
    found = _tried(partial(_figures, point)) if isinstance(point, Begun) else point
    if isinstance(found, Exception):
        first = found.problems[0]
        place = str(first.where).removeprefix("replace: ")  # the sweep is what replaces
        return SweepPoint(values, {}, str(dataclasses.replace(first, where=place)))
    return SweepPoint(values, *found)


def _figures(point: Begun) -> tuple[dict[str, float], str, tuple[str, ...]]:
    result = point.result()
    return result.summary(), "", tuple(warning.code for warning in result.warnings)


def _tried(compute: Callable[[], Value]) -> Value | InputError | ComputationError:
    refuse_stopped(STOPPED * int(stop_flag()[0]))
    try:
        return compute()
    except (InputError, ComputationError) as error:
        return error
