"""``tribodyn run``."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from tribodyn.cli.screen import figures, say, say_json, show_warnings, tell
from tribodyn.cli.settings import CaseName, Flag, Force, Settings, changed_case, check_place


def run(
    case: CaseName,
    /,
    *,
    out: Path | None = None,
    set_: Settings = None,
    force: Force = False,
    quiet: Flag = False,
    open_: Annotated[bool, Parameter(name="--open", negative="")] = False,
    csv: Flag = False,
    json: Flag = False,
) -> None:
    """Compute a case; write its report and its data into a new directory.

    Parameters
    ----------
    out : Path
        Directory to write; by default it is called like the case.
    quiet : bool
        Leave the table of values out; warnings and the place of the report are still told.
    open_ : bool
        Show the report in the web browser.
    csv : bool
        Write the motion over the time as response.csv as well.
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
        progress.start("Report")
        result.save(target, force=force, csv=csv)
        progress.finish()
    if json:
        say_json(result.summary())
    elif not quiet:
        say(f"{result.case.title}\n{figures(result.summary())}")
    show_warnings(result.warnings)
    report = target / "report.html"
    tell(f"Report: {report}")
    if open_:
        import webbrowser

        webbrowser.open(report.absolute().as_uri())
