"""``tribodyn modes``, ``harris``, ``relief``, ``lead`` and ``run-up``: studies of one case."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tribodyn.cli.console import say, say_json, show_warnings, table, tell
from tribodyn.cli.settings import (
    CaseName,
    Flag,
    Force,
    Mesh,
    Output,
    Settings,
    Words,
    changed_case,
    check_place,
    read_ends,
)

if TYPE_CHECKING:
    from tribodyn.errors import ModelWarning
    from tribodyn.report.study_report_data import StudyReportData
    from tribodyn.study.case.case import Case
    from tribodyn.study.machine.case import MachineCase


def prepare_study(
    kind: str, case: str, out: Output, settings: Words, force: bool
) -> tuple[Any, Path]:
    """The case of a study with its changes, and the directory to write."""
    ready = changed_case(case, settings or [], kind)
    target = out if out is not None else Path(f"{Path(case).stem}-{kind}")
    check_place(target, force)
    return ready, target


def stripped(texts: Sequence[str]) -> list[str]:
    """Words of the command line without spaces around them."""
    return [text.strip() for text in texts]


def finish(
    kind: str,
    case: Case | MachineCase | None,
    target: Path,
    answer: StudyReportData,
    force: bool,
    json: bool,
    warnings: Sequence[ModelWarning] = (),
) -> None:
    """Write the directory of a study and print its results, with warnings that it raised."""
    from tribodyn.report.study_report_data import save_study

    messages = [warning.message for warning in warnings]
    report = answer._replace(statements=[*answer.statements, *messages])
    save_study(kind, case, target, report, force)
    if json:
        say_json(answer.facts)
    else:
        heading = [] if case is None else [case.title]
        say("\n".join([*heading, *answer.statements, table([answer.head, *answer.rows])]))
    show_warnings(warnings)
    tell(f"Report: {target / 'report.html'}")


def modes(
    case: CaseName,
    /,
    between: str | None = None,
    *,
    out: Output = None,
    set_: Settings = None,
    force: Force = False,
    json: Flag = False,
) -> None:
    """Find natural frequencies and critical speeds of a case; no motion is computed.

    Parameters
    ----------
    between : str
        Speeds of the Campbell diagram: "400..3500 rpm".
    out : Path
        Directory to write; by default that of the case with "-modes".
    json : bool
        Write the modes in SI as one JSON object to stdout.
    """
    from tribodyn.cli.progress_bar import progress_bar
    from tribodyn.report.modes_report_data import any_modes_report_data

    ready, target = prepare_study("modes", case, out, set_, force)
    ends = None if between is None else read_ends(between)
    with progress_bar() as progress:
        answer = any_modes_report_data(ready, ends, progress)
    finish("modes", ready, target, answer, force, json)


def harris(
    case: CaseName,
    /,
    *torque: str,
    mesh: Mesh = None,
    out: Output = None,
    set_: Words = None,
    force: Force = False,
    json: Flag = False,
) -> None:
    """Find the static transmission error of a case over the torque (Harris map).

    Parameters
    ----------
    torque : str
        Torques such as "60 N*m" "120 N*m"; by default 20 up to twice that of the case.
    out : Path
        Directory to write; by default that of the case with "-harris".
    set_ : list of str
        Values to change, for example "gears.pinion.modification.tip_relief=10 um".
    json : bool
        Write transmission errors and stiffness over the torque in SI to stdout.
    """
    from tribodyn.report.study_report_data import harris_report_data

    ready, target = prepare_study("harris", case, out, set_, force)
    answer = harris_report_data(ready, stripped(torque) or None, mesh)
    finish("harris", ready, target, answer, force, json)


def relief(
    case: CaseName,
    /,
    *torque: str,
    gears: str = "both",
    mesh: Mesh = None,
    out: Output = None,
    set_: Words = None,
    force: Force = False,
    json: Flag = False,
) -> None:
    """Find the tip relief of a case that leaves least transmission error; write the better case.

    Parameters
    ----------
    torque : str
        Torques such as "60 N*m" "120 N*m"; by default from half that of the case to all of it.
    gears : str
        Which gears are relieved: both, or the name of one.
    out : Path
        Directory to write; by default that of the case with "-relief". It holds best.toml.
    set_ : list of str
        Values to change, for example "stiffness.model=analytic".
    json : bool
        Write amount, length and transmission errors in SI to stdout.
    """
    from tribodyn.report.study_report_data import relief_report_data

    ready, target = prepare_study("relief", case, out, set_, force)
    answer = relief_report_data(ready, stripped(torque) or None, gears, mesh)
    finish("relief", ready, target, answer, force, json)


def lead(
    case: CaseName,
    /,
    *torque: str,
    gear: str = "pinion",
    mesh: Mesh = None,
    out: Output = None,
    set_: Words = None,
    force: Force = False,
    json: Flag = False,
) -> None:
    """Find the crowning and lead slope of a case that spread its load most evenly over the face.

    Parameters
    ----------
    torque : str
        Torques such as "60 N*m" "120 N*m"; by default that of the case.
    gear : str
        Which gear is modified: pinion or wheel.
    out : Path
        Directory to write; by default that of the case with "-lead". It holds best.toml.
    set_ : list of str
        Values to change, for example "gears.misalignment=15 um".
    json : bool
        Write crowning, lead slope and face load factors in SI to stdout.
    """
    from tribodyn.cli.progress_bar import progress_bar
    from tribodyn.report.study_report_data import lead_report_data

    ready, target = prepare_study("lead", case, out, set_, force)
    with progress_bar() as progress:
        answer = lead_report_data(ready, stripped(torque) or None, progress, gear=gear, mesh=mesh)
    finish("lead", ready, target, answer, force, json)


def run_up(
    case: CaseName,
    between: str,
    /,
    *,
    duration: float = 10.0,
    down: Flag = False,
    out: Output = None,
    set_: Settings = None,
    force: Force = False,
    json: Flag = False,
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
    out : Path
        Directory to write; by default that of the case with "-run-up".
    json : bool
        Write levels over the speed in SI to stdout.
    """
    from tribodyn.cli.progress_bar import progress_bar
    from tribodyn.report.study_report_data import run_up_report_data

    ready, target = prepare_study("run-up", case, out, set_, force)
    with progress_bar() as progress:
        answer = run_up_report_data(ready, read_ends(between), duration, down, progress)
    finish("run-up", ready, target, answer, force, json)
