"""``tribodyn run``."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

from tribodyn.cli.screen import say, say_json, show_warnings, table, tell
from tribodyn.cli.settings import changed_case, check_place

if TYPE_CHECKING:
    from tribodyn.study.pipeline.result import Result


def run(
    case: str,
    /,
    *,
    out: Path | None = None,
    set_: Annotated[list[str] | None, Parameter(name="--set", negative="")] = None,
    force: Annotated[bool, Parameter(negative="")] = False,
    quiet: Annotated[bool, Parameter(negative="")] = False,
    open_: Annotated[bool, Parameter(name="--open", negative="")] = False,
    json: Annotated[bool, Parameter(negative="")] = False,
) -> None:
    """Compute a case; write its report and its data into a new directory.

    Parameters
    ----------
    case : str
        Built-in case or path of a case file.
    out : Path
        Directory to write; by default it is called like the case.
    set_ : list of str
        Values to change, for example "operation.torque=120 N*m".
    force : bool
        Replace an earlier result in that directory.
    quiet : bool
        Leave the table of values out; warnings and the place of the report are still told.
    open_ : bool
        Show the report in the web browser.
    json : bool
        Write the summary as one flat JSON object in SI to stdout.
    """
    from tribodyn.cli.bar import progress_bar
    from tribodyn.errors import ModelWarning

    target = out if out is not None else Path(Path(case).stem)
    ready = changed_case(case, set_ or [])
    check_place(target, force)
    with progress_bar() as progress, warnings.catch_warnings():
        # They are shown below, from the result.
        warnings.simplefilter("ignore", ModelWarning)
        from tribodyn.study.pipeline.run import run as compute

        result = compute(ready, progress)
        progress.start("writing the report")
        result.save(target, force=force)
        progress.finish()
    if json:
        say_json(result.summary())
    elif not quiet:
        _show(result)
    show_warnings((warning.code, warning.message) for warning in result.warnings)
    report = target / "report.html"
    tell(f"Report: {report}")
    if open_:
        import webbrowser

        webbrowser.open(report.absolute().as_uri())


def _show(result: Result) -> None:
    from tribodyn.study.pipeline.summary import SUMMARY

    rows = [[n, SUMMARY[n].show(v), SUMMARY[n].meaning] for n, v in result.summary().items()]
    say(f"{result.case.title}\n{table(rows)}")
