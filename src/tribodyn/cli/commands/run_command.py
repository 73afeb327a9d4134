"""``tribodyn run``, and ``tribodyn warm-up``, which compiles kernels ahead of the first run."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

from tribodyn.cli.console import figures, say, say_json, show_warnings, tell
from tribodyn.cli.settings import (
    CaseName,
    Flag,
    Force,
    Settings,
    changed_any_case,
    check_place,
)

if TYPE_CHECKING:
    from tribodyn.study import MachineResult, Result


@Parameter(name="*")
@dataclass(frozen=True)
class Printed:
    """What a run writes to stdout."""

    quiet: Annotated[
        Flag,
        Parameter(help="Omit the tables; warnings and the location of the report are printed."),
    ] = False
    all: Annotated[
        Flag,
        Parameter(help="Print every figure with its meaning, not the chief ones of each part."),
    ] = False
    json: Annotated[
        Flag, Parameter(help="Write the summary as one flat JSON object in SI to stdout.")
    ] = False


_CHIEF = Printed()


def run(
    case: CaseName,
    /,
    *,
    out: Path | None = None,
    set_: Settings = None,
    force: Force = False,
    printed: Printed = _CHIEF,
    open_: Annotated[bool, Parameter(name="--open", negative="")] = False,
    csv: Flag = False,
) -> None:
    """Compute a case; write its report and its data into a new directory.

    Parameters
    ----------
    out : Path
        Directory to write; by default it is called like the case.
    printed : Printed
        What is written to stdout.
    open_ : bool
        Show the report in the web browser.
    csv : bool
        Write the motion over the time as response.csv as well.
    """
    from tribodyn.cli.progress_bar import progress_bar
    from tribodyn.errors import ModelWarning

    target = out if out is not None else Path(Path(case).stem)
    ready = changed_any_case(case, set_ or [])
    check_place(target, force)
    with progress_bar() as progress, warnings.catch_warnings():
        # They are shown below, from the result.
        warnings.simplefilter("ignore", ModelWarning)
        from tribodyn.cases.load import run as compute

        result: Result | MachineResult = compute(ready, progress)
        progress.start("Report")
        result.save(target, force=force, csv=csv)
        progress.finish()
    if printed.json:
        say_json(result.summary())
    elif not printed.quiet:
        from tribodyn.cli.summary_screen import screen

        text = figures(result.rows()) if printed.all else screen(result.summary())
        say(f"{result.case.title}\n{text}")
    show_warnings(result.warnings)
    report = target / "report.html"
    tell(f"Report: {report}")
    if open_:
        import webbrowser

        webbrowser.open(report.absolute().as_uri())


def warm_up(
    case: str | None = None,
    /,
    *,
    jobs: int | None = None,
    json: Flag = False,
) -> None:
    """Compile what a case needs into the disk cache, by a run whose result is discarded.

    Parameters
    ----------
    case : str
        Built-in case or path of a case file; all built-in cases by default.
    jobs : int
        Parallel processes; by default one per processor, at most four.
    json : bool
        Write kernels and seconds as one JSON object to stdout.
    """
    from tribodyn.cases.compile_ahead import warm_up as compute
    from tribodyn.cli.progress_bar import progress_bar

    with progress_bar() as progress:
        report = compute(case, jobs, progress)
    if json:
        say_json(report)
        return
    for name, seconds in report["compiled"].items():
        say(f"compiled in {seconds:.0f} s: {name}")
    for name in report["there_already"]:
        say(f"already cached: {name}")
    what = "runs of the built-in cases compile" if case is None else "a run of this case compiles"
    say(f"Done in {report['seconds']:.0f} s; {what} nothing more")
