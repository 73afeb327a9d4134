"""``tribodyn run``, ``app``, and ``warm-up``, which compiles kernels ahead of the first run."""

from __future__ import annotations

import warnings
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

from tribodyn.cli.console import figures, say, say_json, show_warnings, tell
from tribodyn.cli.screen import chief_figures
from tribodyn.cli.settings import CaseName, Flag, Force, Settings, changed_any_case, check_place
from tribodyn.errors import InputError

if TYPE_CHECKING:
    from tribodyn.study import Result


@Parameter(name="*")
@dataclass(frozen=True)
class Printed:
    """What a run writes to stdout.

    Parameters
    ----------
    quiet : bool
        Omit the tables; warnings and the location of the report are printed.
    all : bool
        Print every figure with its meaning, not the chief ones of each part.
    json : bool
        Write the summary as one flat JSON object in SI to stdout.
    """

    quiet: Flag = False
    all: Flag = False
    json: Flag = False


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

        result: Result = compute(ready, progress)
        progress.start("Motion with faults and report" if result.case.faults else "Report")
        result.save(target, force=force, csv=csv)
        progress.finish()
    if printed.json:
        say_json(result.summary())
    elif not printed.quiet:
        text = figures(result.rows()) if printed.all else chief_figures(result.summary())
        say(f"{result.case.title}\n{text}")
    show_warnings(result.warnings)
    if reason := result.response.reason:
        tell(f"Motion by {result.response.engine}: {reason}.")
    report = target / "report.html"
    tell(f"Report: {report}")
    if open_:
        import webbrowser

        webbrowser.open(report.absolute().as_uri())


def warm_up(case: str | None = None, /, *, jobs: int | None = None, json: Flag = False) -> None:
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


def app(
    case: str = "",
    /,
    *,
    folder: Path = Path(),
    host: str = "127.0.0.1",
    port: int = 8050,
    no_browser: Flag = False,
) -> None:
    """Serve a page for the whole job, on this machine alone, until Ctrl-C.

    Parameters
    ----------
    case : str
        Built-in case, or path of a case file in the folder; without it a short one to fill in.
    folder : Path
        Folder that the page reads and writes, and nothing beyond it; by default this one.
    host : str
        Address to serve at. Any but 127.0.0.1 lets other machines reach it, who need the token.
    port : int
        Port to serve at; 0 takes one that is free.
    no_browser : bool
        Write the address only, and open no browser.
    """
    import webbrowser
    from importlib.util import find_spec

    if find_spec("dash") is None:
        why, remedy = "The page is drawn by Dash", 'Install it with pip install "tribodyn[app]"'
        raise InputError("Dash is not installed", "tribodyn app", why, remedy)
    if not 0 <= port <= 65535:
        raise InputError(f"port = {port}", "--port", "Ports are 0 to 65535")
    from tribodyn.app.server import Page

    page = Page(folder, case, host, port)
    tell(f"The page is at {page.address}")
    tell("It belongs to whoever has this address. Ctrl-C ends it.")
    if not no_browser and not webbrowser.open(page.address):
        tell("No browser could be opened: open the address in one yourself.")
    with suppress(KeyboardInterrupt):
        page.serve()
    tell("The page has ended.")
