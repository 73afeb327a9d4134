"""Functions of the studies of the page: each computes, writes the directory and shows a result."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tribodyn.errors import InputError
from tribodyn.study.studies.range_syntax import UnreadError, read_list, read_range, read_values

if TYPE_CHECKING:
    from tribodyn.progress import Progress
    from tribodyn.report.study_report_data import StudyReportData
    from tribodyn.study.case.case import Case

#: Values of a study by name: numbers and choices checked, others as text; None or empty: default.
Values = Mapping[str, Any]
#: What a study shows: ``sentences``, ``tables``, and figures as (heading, figure, caption).
Shown = dict[str, Any]

RANGE = "400..3500 rpm:20, or 50, 150, 300 N*m"
#: Data of a measurement of losses that the page asks for.
MEASURED = ("gear_sets", "no_load_torque", "other_loss")


def _varied(values: Values) -> Iterator[tuple[str, object]]:
    for key, name in (("key", "values"), ("second_key", "second_values")):
        if values[key]:
            yield values[key], _read(name, values[name] or "", read_values)


def _read(name: str, text: str, read: Callable[[str], Any]) -> Any:
    """Parse a range or a list in the syntax of the commands."""
    try:
        return read(text)
    except UnreadError as fault:
        raise InputError(f'cannot read "{text}"', name, str(fault), f"Write {RANGE}") from None


def _ends(name: str, text: str) -> tuple[str, str]:
    low, high, _ = _read(name, f"{text}:2", read_range)
    return low, high


def _points(case: Case, key: str, text: str) -> list[float] | None:
    """Parse torques or speeds like the keys of the case."""
    from tribodyn.study.studies.study_axes import points_of

    return points_of(case, key, _read(key, text, read_values), by="study") if text else None


def _operation(case: Case, values: Values) -> list[list[float] | None]:
    return [_points(case, f"operation.{n}", values[n] or "") for n in ("torque", "speed")]


def _of(answer: StudyReportData, kind: str, case: Case, target: Path) -> Shown:
    from tribodyn.report.study_report_data import save_study

    save_study(kind, case, target, answer)
    table = ["Table", list(answer.head), [list(row) for row in answer.rows]]
    return {"sentences": list(answer.statements), "tables": [table], "figures": answer.figures}


def _sweep(case: Case, values: Values, progress: Progress, target: Path) -> Shown:
    from tribodyn import plot
    from tribodyn.report.study_report_data import figure_with_caption
    from tribodyn.study.pipeline.summary_figures import in_words
    from tribodyn.study.studies.sweep import sweep

    result = sweep(case, dict(_varied(values)), by="study", progress=progress)
    result.save(target)
    names = result.displayed_figures()
    if not plot.machine_sweep.missing(result):
        names = []
    figures = [(in_words(name), result.plot(name), "") for name in names]
    figures[:1] = [(*figures[0][:2], plot.sweep.caption_of(result))] if figures else []
    if not names:
        figures = [figure_with_caption(plot.machine_sweep, result)]
    failed = dict.fromkeys(point.failed for point in result.points if point.failed)
    return {
        "sentences": [f"{len(result.points)} values.", *failed],
        "tables": [],
        "figures": figures,
    }


def _bifurcation(case: Case, values: Values, progress: Progress, target: Path) -> Shown:
    from tribodyn import plot
    from tribodyn.report.study_report_data import figure_with_caption, save_bifurcation
    from tribodyn.study.studies.bifurcation import Findings, bifurcation

    low, high, points = _read("values", values["values"], read_range)
    options = {name: values[name] for name in ("mesh", "sweep", "cycles", "transient")}
    result = bifurcation(
        case,
        values["key"],
        (low, high),
        points,
        by="study",
        progress=progress,
        keep=min(48, values["cycles"]),
        **options,
    )
    findings = Findings(case, result)
    save_bifurcation(result, case, findings, target)
    head, rows = findings.rows()
    return {
        "sentences": list(findings.sentences()),
        "tables": [["Table", list(head), [list(row) for row in rows]]],
        "figures": [figure_with_caption(plot.bifurcation, result)],
    }


def _losses(case: Case, values: Values, progress: Progress, target: Path) -> Shown:
    from tribodyn.report.study_report_data import losses_report_data

    torque, speed = _operation(case, values)
    answer = losses_report_data(case, torque, speed, progress, values["mesh"])
    return _of(answer, "losses", case, target)


def _film(case: Case, values: Values, progress: Progress, target: Path) -> Shown:
    from tribodyn.report.study_report_data import film_report_data

    torque, speed = _operation(case, values)
    answer = film_report_data(case, torque, speed, progress, values["mesh"])
    return _of(answer, "film", case, target)


def _friction_from_loss(case: Case, values: Values, progress: Progress, target: Path) -> Shown:
    from tribodyn.losses import friction_from_power_loss
    from tribodyn.report.study_report_data import friction_report_data, measured_losses

    progress.start("Friction coefficients")
    options = {name: values[name] for name in MEASURED}
    losses = measured_losses(values["file"], case, values["mesh"], options)
    answer = friction_report_data(losses, friction_from_power_loss(losses))
    return _of(answer, "friction from losses", case, target)


def _recording(case: Case, values: Values, progress: Progress, target: Path) -> Shown:
    from tribodyn.report.signal_report import recorded_motion, recording_report_data

    settings = {k: values[k] for k in ("duration", "sample_rate", "noise", "seed")}
    sensor = values["sensor"]
    recorded, truth = recorded_motion(case, [sensor], progress, **settings)
    content = _of(recording_report_data(recorded, sensor), "recording", case, target)
    recorded.save(target / f"recording.{values['format']}", truth={"title": case.title, **truth})
    return content


def _relief(case: Case, values: Values, progress: Progress, target: Path) -> Shown:
    from tribodyn.report.study_report_data import relief_report_data

    progress.start("Tip relief")
    torque = _read("torque", values["torque"], read_list) if values["torque"] else None
    answer = relief_report_data(case, torque, values["gears"], values["mesh"])
    return {**_of(answer, "relief", case, target), "relief": answer.data.changes}


def _harris(case: Case, values: Values, progress: Progress, target: Path) -> Shown:
    from tribodyn.report.study_report_data import harris_report_data

    progress.start("Static transmission error")
    torque = _read("torque", values["torque"], read_list) if values["torque"] else None
    return _of(harris_report_data(case, torque, values["mesh"]), "harris", case, target)


def _modes(case: Case, values: Values, progress: Progress, target: Path) -> Shown:
    from tribodyn.report.modes_report_data import any_modes_report_data

    ends = _ends("speeds", values["speeds"]) if values["speeds"] else None
    return _of(any_modes_report_data(case, ends, progress), "modes", case, target)


def _run_up(case: Case, values: Values, progress: Progress, target: Path) -> Shown:
    from tribodyn.report.study_report_data import run_up_report_data

    ends = _ends("speeds", values["speeds"])
    answer = run_up_report_data(case, ends, values["duration"], progress=progress)
    return _of(answer, "run-up", case, target)


def _continuation(case: Case, values: Values, progress: Progress, target: Path) -> Shown:
    from tribodyn.report.nonlinear_report_data import continuation_report_data

    ends, step = _ends("ends", values["ends"]), values["longest_step"]
    answer = continuation_report_data(
        case, values["key"], ends, values["periods"], step, "study", progress, values["mesh"]
    )
    return _of(answer, "continuation", case, target)


def _basins(case: Case, values: Values, progress: Progress, target: Path) -> Shown:
    from tribodyn.report.nonlinear_report_data import basins_report_data

    error, rate = (
        _ends(name, values[name]) if values[name] else None
        for name in ("transmission_error", "rate")
    )
    answer = basins_report_data(
        case, error, rate, values["points"], progress=progress, mesh=values["mesh"]
    )
    return _of(answer, "basins", case, target)


def _lyapunov(case: Case, values: Values, progress: Progress, target: Path) -> Shown:
    from tribodyn.report.nonlinear_report_data import lyapunov_report_data

    answer = lyapunov_report_data(case, values["cycles"], values["transient"], progress)
    return _of(answer, "lyapunov", case, target)


def _sobol(case: Case, values: Values, progress: Progress, target: Path) -> Shown:
    from tribodyn.report.nonlinear_report_data import sobol_report_data

    pairs = (("key", "tolerance"), ("second_key", "second_tolerance"))
    spread = {values[key]: values[tolerance] or "" for key, tolerance in pairs if values[key]}
    for key, tolerance in spread.items():
        if not any(sign in tolerance for sign in ("+-", "±", "..")):
            what = f'"{tolerance}" is no tolerance of {key}'
            why = "It is a value with its tolerance"
            remedy = 'Write "90 N*m +- 5 %" or "80 .. 100 N*m"'
            raise InputError(what, "tolerance", why, remedy)
    figures = (values["figures"] or "").replace(",", " ").split()
    spread_case = case.replace(spread, by="study")
    answer = sobol_report_data(spread_case, figures, values["size"], 0, progress)
    return _of(answer, "sobol", case, target)


def _lead(case: Case, values: Values, progress: Progress, target: Path) -> Shown:
    from tribodyn.report.study_report_data import lead_report_data

    torque = _read("torque", values["torque"], read_list) if values["torque"] else None
    chosen = {name: values[name] for name in ("gear", "misalignment", "mesh")}
    answer = lead_report_data(case, torque, progress, **chosen)
    return {**_of(answer, "lead", case, target), "relief": answer.data.changes}


#: Functions of the studies by the names of their commands.
FUNCTIONS: Mapping[str, Callable[[Any, Values, Progress, Path], Shown]] = {
    "sweep": _sweep,
    "bifurcation": _bifurcation,
    "losses": _losses,
    "film": _film,
    "friction-from-loss": _friction_from_loss,
    "recording": _recording,
    "relief": _relief,
    "lead": _lead,
    "harris": _harris,
    "modes": _modes,
    "run-up": _run_up,
    "continuation": _continuation,
    "basins": _basins,
    "lyapunov": _lyapunov,
    "sobol": _sobol,
}
