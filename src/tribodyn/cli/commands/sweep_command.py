"""``tribodyn sweep``."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from tribodyn.cli.console import say, say_json, show_resumed, table, tell
from tribodyn.cli.settings import USUAL, CaseName, Place, changed_any_case, read_ranges

if TYPE_CHECKING:
    from tribodyn.study.studies.sweep_result import Sweep

#: A sweep, or another study with ``points``, ``complete`` and ``save``.
StudyType = TypeVar("StudyType", bound=Any)


#: Exit code of a sweep that was stopped by Ctrl-C; finished values are saved.
INTERRUPTED = 130


def sweep(case: CaseName, /, *over: str, show: str = "", at: Place = USUAL) -> int:
    """Compute a case at many values of its keys; write a table and a report.

    Parameters
    ----------
    over : str
        What varies: "operation.speed=400..3500 rpm:60" or "operation.torque=50,150,300 N*m".
        Several make a grid.
    show : str
        Figures of the table on the screen, such as "minimum_film_ratio,efficiency".
    """
    ranges = read_ranges(over)
    ready = changed_any_case(case, at.set_ or [])
    names = _summary_names(show)

    def compute(**checkpointing: Any) -> Sweep:
        from tribodyn.study.studies.sweep import sweep as over_keys

        return over_keys(ready, ranges, partial=True, by="sweep", **checkpointing)

    target = at.reserved(case, "sweep")
    result = run_checkpointed(target, at.force, compute)
    _show(result, result.displayed_figures(names), at.json)
    failed = sum(bool(point.failed) for point in result.points)
    if failed:
        tell(
            f"{failed} of {len(result.points)} values failed; the column failed states the reason."
        )
    return report_exit_code(result, target)


def run_checkpointed(target: Path, force: bool, compute: Callable[..., StudyType]) -> StudyType:
    """Compute a study with checkpoints of its finished parts, and save what is done."""
    from tribodyn.checkpoints import Checkpoints
    from tribodyn.cli.progress_bar import progress_bar

    with Checkpoints(target, force) as checkpoints:
        with progress_bar() as progress:
            study = compute(progress=progress, checkpoints=checkpoints)
        show_resumed(checkpoints)
        if not study.complete:
            tell(
                f"interrupted: {len(study.points)} of {study.size} values are done and "
                "being written; the same command with --force continues from there; "
                "Ctrl-C again stops at once"
            )
        with progress_bar() as progress:
            progress.start("Report")
            study.save(target, force=force)
            progress.finish()
        checkpoints.close_after(study.complete)
    return study


def report_exit_code(study: Sweep, target: Path) -> int:
    """Print the location of the report and return the exit code of the study."""
    tell(f"Report: {target / 'report.html'}")
    if not study.complete:
        return INTERRUPTED
    return 1 if all(point.failed for point in study.points) else 0


def _summary_names(show: str) -> list[str]:
    """Return the requested summary figures; refuse unknown ones before anything is computed."""
    from tribodyn.errors import InputError, did_you_mean
    from tribodyn.study.pipeline.summary import SUMMARY
    from tribodyn.study.pipeline.summary_figures import is_figure

    names = [name.strip() for name in show.split(",") if name.strip()]
    for name in names:
        if not is_figure(name):
            remedy = did_you_mean(name, SUMMARY, "See: tribodyn check and run")
            raise InputError(f'there is no figure "{name}"', "--show", "", remedy)
    return names


def _show(result: Sweep, names: Sequence[str], as_json: bool) -> None:
    from tribodyn.study.pipeline.summary_figures import figure_of

    if as_json:
        units = {axis.key: axis.unit for axis in result.axes}
        say_json({"keys": units, "complete": result.complete, "rows": list(result.rows())})
        return
    rows: list[list[str]] = [[*(axis.name for axis in result.axes), *names, ""]]
    for point in result.points:
        keys: list[Any] = [a.show(v) for a, v in zip(result.axes, point.values, strict=True)]
        figures = [
            figure_of(n).show(point.figures[n]) if n in point.figures else "-" for n in names
        ]
        rows.append([*keys, *figures, f"failed: {point.failed}" if point.failed else ""])
    say(f"{result.case.title}\n{table(rows)}")
