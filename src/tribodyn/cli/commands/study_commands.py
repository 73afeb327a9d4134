"""``tribodyn modes``, ``harris``, ``relief``, ``lead`` and ``run-up``: studies of one case."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

from tribodyn.cli.console import say, say_json, show_warnings, table, tell
from tribodyn.cli.settings import BEST, USUAL, Best, CaseName, Flag, Mesh, Place, read_ends

if TYPE_CHECKING:
    from pathlib import Path

    from tribodyn.errors import ModelWarning
    from tribodyn.progress import Progress
    from tribodyn.report.study_report_data import StudyReportData
    from tribodyn.study.machine.case import AnyCase


def answer(
    kind: str, case: str, at: Place, compute: Callable[[Any, Progress], StudyReportData]
) -> StudyReportData:
    """Compute a study of a case with its changes, write its directory and print its results."""
    from tribodyn.cli.progress_bar import progress_bar

    ready, target = at.case(kind, case)
    with progress_bar() as progress:
        results = compute(ready, progress)
    finish(kind, ready, target, results, at)
    return results


def finish(
    kind: str,
    case: AnyCase | None,
    target: Path,
    results: StudyReportData,
    at: Place,
    warnings: Sequence[ModelWarning] = (),
) -> None:
    """Write the directory of a study and print its results, with warnings that it raised."""
    from tribodyn.report.study_report_data import save_study

    messages = [warning.message for warning in warnings]
    report = results._replace(statements=[*results.statements, *messages])
    save_study(kind, case, target, report, at.force)
    if at.json:
        say_json(results.facts)
    else:
        heading = [] if case is None else [case.title]
        say("\n".join([*heading, *results.statements, table([results.head, *results.rows])]))
    show_warnings(warnings)
    tell(f"Report: {target / 'report.html'}")


def modes(case: CaseName, /, between: str | None = None, *, at: Place = USUAL) -> None:
    """Find natural frequencies and critical speeds of a case; no motion is computed.

    Parameters
    ----------
    between : str
        Speeds of the Campbell diagram: "400..3500 rpm".
    """
    from tribodyn.report.modes_report_data import any_modes_report_data

    ends = None if between is None else read_ends(between)
    answer("modes", case, at, lambda ready, to: any_modes_report_data(ready, ends, to))


def _stripped(texts: Sequence[str]) -> list[str] | None:
    """Torques of the command line without spaces around them; none by default."""
    return [text.strip() for text in texts] or None


def harris(case: CaseName, /, *torque: str, mesh: Mesh = None, at: Place = USUAL) -> None:
    """Find the static transmission error of a case over the torque (Harris map).

    Parameters
    ----------
    torque : str
        Torques such as "60 N*m" "120 N*m"; by default 20 up to twice that of the case.
    """
    from tribodyn.report.study_report_data import harris_report_data

    torques = _stripped(torque)
    answer("harris", case, at, lambda ready, _: harris_report_data(ready, torques, mesh))


def relief(
    case: CaseName, /, *torque: str, gears: str = "both", mesh: Mesh = None, at: Best = BEST
) -> None:
    """Find the tip relief of a case that leaves least transmission error; write the better case.

    Parameters
    ----------
    torque : str
        Torques such as "60 N*m" "120 N*m"; by default from half that of the case to all of it.
    gears : str
        Which gears are relieved: both, or the name of one.
    """
    from tribodyn.report.study_report_data import relief_report_data

    torques = _stripped(torque)
    answer("relief", case, at, lambda ready, _: relief_report_data(ready, torques, gears, mesh))


def lead(
    case: CaseName, /, *torque: str, gear: str = "pinion", mesh: Mesh = None, at: Best = BEST
) -> None:
    """Find the crowning and lead slope that spread the load most evenly; write the better case.

    Parameters
    ----------
    torque : str
        Torques such as "60 N*m" "120 N*m"; by default that of the case.
    gear : str
        Which gear is modified: pinion or wheel.
    """
    from tribodyn.report.study_report_data import lead_report_data

    def compute(ready: Any, progress: Progress) -> StudyReportData:
        return lead_report_data(ready, _stripped(torque), progress, gear=gear, mesh=mesh)

    answer("lead", case, at, compute)


def run_up(
    case: CaseName,
    between: str,
    /,
    *,
    duration: float = 10.0,
    down: Flag = False,
    at: Place = USUAL,
) -> None:
    """Integrate a case in time while its speed rises; report where it vibrates most.

    Parameters
    ----------
    between : str
        Lowest and highest speed: "400..3500 rpm".
    duration : float
        Length of the rise in seconds.
    down : bool
        Let the speed fall back as it rose.
    """
    from tribodyn.report.study_report_data import run_up_report_data

    ends = read_ends(between)
    answer("run-up", case, at, lambda on, to: run_up_report_data(on, ends, duration, down, to))
