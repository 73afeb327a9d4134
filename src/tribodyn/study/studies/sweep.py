"""Sweeps: the whole pipeline over values of one key of the case, or over a grid of several."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Mapping, Sequence
from contextlib import nullcontext
from itertools import product
from typing import TYPE_CHECKING, Any

from tribodyn.errors import ComputationError, InputError, quiet
from tribodyn.members import Members
from tribodyn.mesh.film.tabled_film import shared_films
from tribodyn.progress import SILENT, Progress
from tribodyn.study.pipeline.run import computed
from tribodyn.study.studies.axes import Axis, read_axes
from tribodyn.study.studies.grid import finished, identity, over_cases
from tribodyn.study.studies.sweep_result import Sweep, SweepPoint

if TYPE_CHECKING:
    from tribodyn.study.case.case import Case
    from tribodyn.study.pipeline.result import Result

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
    members : tribodyn.members.Members, optional
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
    Several values are computed at a time, one by each processor. An interrupted sweep keeps those
    that are finished, up to the first that is not.

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

    def compute(*values: Any) -> Result:
        changes = {axis.key: value for axis, value in zip(axes, values, strict=True)}
        return computed(case.replace(changes))

    return Sweep(case, axes, points_of(axes, compute, study, partial, progress, members))


def points_of(
    axes: tuple[Axis, ...],
    compute: Callable[..., Result],
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

    def point(index: int) -> SweepPoint:
        found = _point(compute, grid[index])
        kept.keep(str(index), (dict(found.figures), found.failed, found.warned))
        return found

    progress.start("Values", len(grid))
    try:
        # Not by what is left: a sweep that goes on has the figures of one that was not stopped.
        with shared_films() if len(grid) >= _MANY else nullcontext():
            over_cases(point, range(len(grid)), done, progress)
    except KeyboardInterrupt:
        if not (partial and 0 in done):
            raise
    progress.finish()
    return tuple(finished(done))


def points_under(
    case: Case, changes: Sequence[Mapping[str, Any]], progress: Progress = SILENT
) -> list[SweepPoint]:
    """Compute a case under each of some changes, in their order; what fails is told."""
    done: dict[int, SweepPoint] = {}

    def point(change: Mapping[str, Any]) -> SweepPoint:
        return _point(lambda *_: computed(case.replace(change)), tuple(change.values()))

    over_cases(point, changes, done, progress)
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


def _point(compute: Callable[..., Result], values: tuple[Any, ...]) -> SweepPoint:
    """Run the case at one place; what fails is told, and the sweep goes on."""
    try:
        with quiet():  # what the models say is kept in the result
            result = compute(*values)
            figures = result.summary()
    except (InputError, ComputationError) as error:
        first = error.problems[0]
        place = str(first.where).removeprefix("replace: ")  # the sweep is what replaces
        return SweepPoint(values, {}, str(dataclasses.replace(first, where=place)))
    return SweepPoint(values, figures, "", tuple(warning.code for warning in result.warnings))
