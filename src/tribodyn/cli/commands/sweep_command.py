"""``tribodyn sweep``."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from tribodyn.cli.screen import say, say_json, show_resumed, table, tell
from tribodyn.cli.settings import (
    CaseName,
    Flag,
    Force,
    Settings,
    changed_case,
    check_place,
    read_ranges,
)

if TYPE_CHECKING:
    from tribodyn.study.studies.sweep_result import Sweep

#: A sweep, or what says like one how many of its ``points`` are done.
Study = TypeVar("Study", bound=Any)


#: Exit code of a sweep that was stopped by Ctrl-C; what was done is kept.
INTERRUPTED = 130


def sweep(
    case: CaseName,
    /,
    *over: str,
    out: Path | None = None,
    set_: Settings = None,
    force: Force = False,
    show: str = "",
    json: Flag = False,
) -> int:
    """Compute a case at many values of its keys; write a table and a report.

    Parameters
    ----------
    over : str
        What varies: "operation.speed=400..3500 rpm:60" or "operation.torque=50,150,300 N*m".
        Several make a grid.
    out : Path
        Directory to write; by default that of the case with "-sweep".
    show : str
        Figures of the table on the screen, such as "minimum_film_ratio,efficiency".
    json : bool
        Write all figures in SI as one JSON object to stdout.
    """
    target = out if out is not None else Path(f"{Path(case).stem}-sweep")
    ranges = read_ranges(over)
    ready = changed_case(case, set_ or [])
    names = _asked(show)

    def compute(**kept: Any) -> Sweep:
        from tribodyn.study.studies.sweep import sweep as over_keys

        return over_keys(ready, ranges, partial=True, by="sweep", **kept)

    found = kept_study(target, force, compute)
    _show(found, found.shown(names), json)
    failed = sum(bool(point.failed) for point in found.points)
    if failed:
        tell(f"{failed} of {len(found.points)} values failed; the column failed tells why.")
    return ended(found, target)


def kept_study(target: Path, force: bool, compute: Callable[..., Study]) -> Study:
    """Compute a study whose parts are kept as they are finished, and save what is done."""
    from tribodyn.checkpoints import Members
    from tribodyn.cli.bar import progress_bar

    check_place(target, force)
    with Members(target, force) as members:
        with progress_bar() as progress:
            found = compute(progress=progress, members=members)
        show_resumed(members)
        if not found.complete:
            tell(
                f"interrupted: {len(found.points)} of {found.asked} values are done and "
                "being written; the same command with --force goes on from there; "
                "Ctrl-C again stops at once"
            )
        with progress_bar() as progress:
            progress.start("Report")
            found.save(target, force=force)
            progress.finish()
        members.close_after(found.complete)
    return found


def ended(found: Sweep, target: Path) -> int:
    """Tell where the report is; exit code of the study."""
    tell(f"Report: {target / 'report.html'}")
    if not found.complete:
        return INTERRUPTED
    return 1 if all(point.failed for point in found.points) else 0


def _asked(show: str) -> list[str]:
    """Names of figures that are asked for; unknown ones are told before anything is computed."""
    from tribodyn.errors import InputError, did_you_mean
    from tribodyn.study.pipeline.summary import SUMMARY

    names = [name.strip() for name in show.split(",") if name.strip()]
    for name in names:
        if name not in SUMMARY:
            remedy = did_you_mean(name, SUMMARY, "See: tribodyn check and run")
            raise InputError(f'there is no figure "{name}"', "--show", "", remedy)
    return names


def _show(found: Sweep, names: Sequence[str], as_json: bool) -> None:
    from tribodyn.study.pipeline.summary import SUMMARY

    if as_json:
        units = {axis.key: axis.unit for axis in found.axes}
        say_json({"keys": units, "complete": found.complete, "rows": list(found.rows())})
        return
    rows: list[list[str]] = [[*(axis.name for axis in found.axes), *names, ""]]
    for point in found.points:
        keys: list[Any] = [a.show(v) for a, v in zip(found.axes, point.values, strict=True)]
        figures = [SUMMARY[n].show(point.figures[n]) if n in point.figures else "-" for n in names]
        rows.append([*keys, *figures, f"failed: {point.failed}" if point.failed else ""])
    say(f"{found.case.title}\n{table(rows)}")
