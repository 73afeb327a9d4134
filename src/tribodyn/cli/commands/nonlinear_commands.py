"""``tribodyn bifurcation``, ``continuation``, ``basins`` and ``lyapunov``: nonlinear motions."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any, Literal

from cyclopts import Parameter

from tribodyn.cli.commands.study_commands import answer
from tribodyn.cli.commands.sweep_commands import INTERRUPTED
from tribodyn.cli.console import say, say_json, show_resumed, tell
from tribodyn.cli.settings import RANGE, USUAL, CaseName, Mesh, Place, read_ends, read_ranges
from tribodyn.errors import InputError
from tribodyn.types import Tree

if TYPE_CHECKING:
    from tribodyn.progress import Progress
    from tribodyn.report.study_report_data import StudyReportData

#: Range whose first value may have a sign.
_Signed = Annotated[str | None, Parameter(allow_leading_hyphen=True)]


def bifurcation(
    case: CaseName,
    /,
    *over: str,
    sweep: Literal["up", "down", "both", "independent"] = "up",
    cycles: int | None = None,
    transient: int | None = None,
    steps: int | None = None,
    mesh: Mesh = None,
    at: Place = USUAL,
) -> int:
    """Follow the motion of a case over one value; report periods, jumps and step errors.

    Parameters
    ----------
    over : str
        What varies: "operation.speed=400..3500 rpm:300".
    sweep : str
        Start each value from the end of the previous one, upwards (up), downwards (down) or both,
        or from the same start (independent).
    cycles : int
        Mesh cycles of the statistics at each value, 64 by default; of a machine periods of its
        clock, by default as many as have 64 cycles of its fastest mesh, at least 16.
    transient : int
        Mesh cycles before, fewer where the motion repeats; 300 by default, of a machine likewise,
        at least 32 periods, and as many as the slowest mode takes to decay to 1e-9, 500 at most.
    steps : int
        Steps per mesh cycle.
    """
    from tribodyn.checkpoints import Checkpoints
    from tribodyn.cli.progress_bar import progress_bar

    key, (first, last, points) = _single_range(over)
    lengths = {"cycles": cycles, "transient": transient}
    options: Tree = {n: each for n, each in lengths.items() if each is not None}
    _check_lengths(**options)
    ready, target = at.case("bifurcation", case)
    if cycles is not None:
        options["keep"] = min(48, cycles)
    with Checkpoints(target, at.force) as checkpoints:
        with progress_bar() as progress:
            from tribodyn.study.studies.bifurcation import Findings
            from tribodyn.study.studies.bifurcation import bifurcation as compute
            from tribodyn.study.studies.study_axes import read_axes

            read_axes(ready, {key: (first, last, points)}, by="bifurcation")
            diagram = compute(
                ready, key, (first, last), points, mesh=mesh, steps=steps, sweep=sweep,
                by="bifurcation", keep_partial=True, progress=progress, checkpoints=checkpoints,
                **options,
            )  # fmt: skip
        show_resumed(checkpoints)
        if not diagram.finished.any():
            raise KeyboardInterrupt
        judged = int((diagram.finished & (diagram.verdict != "")).sum())
        complete = judged == diagram.finished.size
        if not complete:
            tell(
                f"interrupted: {int(diagram.finished.sum())} of {diagram.finished.size} motions "
                f"are done, {judged} of them judged, and being written; the same command with "
                "--force continues from there; Ctrl-C again stops at once"
            )
        findings = Findings(ready, diagram)
        with progress_bar() as progress:
            progress.start("Report")
            from tribodyn.report.study_report_data import save_bifurcation

            save_bifurcation(diagram, ready, findings, target, at.force)
            progress.finish()
        checkpoints.close_after(complete)
    if at.json:
        say_json({**findings.figures(), "complete": complete})
    else:
        say("\n".join([ready.title, *(f"  {line}" for line in findings.sentences())]))
    tell(f"Diagram: {target / 'bifurcation.html'}")
    return 0 if complete else INTERRUPTED


def continuation(
    case: CaseName,
    over: str,
    /,
    *,
    periods: int = 1,
    longest_step: float = 0.02,
    mesh: Mesh = None,
    at: Place = USUAL,
) -> None:
    """Follow the periodic motion of a case over one value, stable or not, and report its folds.

    Parameters
    ----------
    over : str
        What varies: "operation.speed=400..3500 rpm". The branch begins at the first value.
    periods : int
        Mesh cycles after which the motion repeats.
    longest_step : float
        Longest step along the branch, relative to the range.
    """

    def compute(ready: Any, progress: Progress) -> StudyReportData:
        from tribodyn.report.nonlinear_report_data import continuation_report_data

        how = periods, longest_step, "continuation", progress, mesh
        return continuation_report_data(ready, key, ends, *how)

    key, ends = _branch_range(over)
    answer("continuation", case, at, compute)


def basins(
    case: CaseName,
    /,
    *,
    transmission_error: _Signed = None,
    rate: _Signed = None,
    points: int | None = None,
    mesh: Mesh = None,
    at: Place = USUAL,
) -> int:
    """Find which motion of a case a disturbed start comes to, over transmission error and its rate.

    Parameters
    ----------
    transmission_error : str
        Its range at the start, counted from where the driving flanks first touch:
        "-20..40 um". By default about the static equilibrium.
    rate : str
        Range of its rate: "-400000..400000 um/s". By default what a free vibration reaches.
    points : int
        Values of each: 41 by default, of a machine as many as take about two minutes.
    """

    def compute(ready: Any, progress: Progress) -> StudyReportData:
        from tribodyn.report.nonlinear_report_data import basins_report_data

        return basins_report_data(ready, error, speed, points, True, progress, mesh)

    error = None if transmission_error is None else read_ends(transmission_error, "-20..40 um")
    speed = None if rate is None else read_ends(rate, "-400000..400000 um/s")
    results = answer("basins", case, at, compute)
    return 0 if results.facts["complete"] else INTERRUPTED


def lyapunov(
    case: CaseName,
    /,
    *,
    cycles: int | None = None,
    transient: int = 300,
    at: Place = USUAL,
) -> None:
    """Find the Lyapunov exponents of the motion of a case: whether it is chaos.

    Parameters
    ----------
    cycles : int
        Mesh cycles over which to average: 1000, of a machine that does not repeat fewer.
    transient : int
        Mesh cycles before.
    """

    def compute(ready: Any, progress: Progress) -> StudyReportData:
        from tribodyn.report.nonlinear_report_data import lyapunov_report_data

        return lyapunov_report_data(ready, cycles, transient, progress)

    _check_lengths(2 if cycles is None else cycles, transient)
    answer("lyapunov", case, at, compute)


_BRANCH = 'Write "operation.speed=400..3500 rpm"'


def _branch_range(over: str) -> tuple[str, tuple[Any, Any]]:
    """Key and ends of a branch, which chooses its points itself."""
    key, equals, text = (part.strip() for part in over.partition("="))
    if not (key and equals and text):
        raise InputError(f'cannot read "{over}"', "", "It is not KEY=LOW..HIGH", _BRANCH)
    if ":" in text:
        why = "A branch chooses its points itself"
        raise InputError(f'cannot read "{over}"', "", why, f"{_BRANCH}, without a number of points")
    return key, read_ends(text, _BRANCH.removeprefix('Write "').removesuffix('"'))


def _single_range(over: tuple[str, ...]) -> tuple[str, tuple[Any, Any, int]]:
    """Return the single key that varies, with its range."""
    ranges = read_ranges(over, lists=False)
    if len(ranges) > 1:
        what = f"{len(ranges)} keys vary: {', '.join(ranges)}"
        raise InputError(what, "", "A diagram goes over one of them", RANGE)
    return next(iter(ranges.items()))


def _check_lengths(cycles: int = 2, transient: int = 0) -> None:
    """Refuse too few mesh cycles."""
    for name, value, least in (("cycles", cycles, 2), ("transient", transient, 0)):
        if value < least:
            why = f"At least {least} are needed" if least else "It is a count"
            raise InputError(f"{value} mesh cycles", f"--{name}", why, "Give more of them")
