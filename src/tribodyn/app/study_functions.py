"""Functions of the studies of the page: each computes, writes the directory and shows a result."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tribodyn import plot
from tribodyn.errors import InputError
from tribodyn.report import nonlinear_report_data as nonlinear
from tribodyn.report import study_report_data as of_studies
from tribodyn.report.study_report_data import StudyReportData, figure_with_caption, save_study
from tribodyn.study.studies.study_axes import UnreadError, read_list, read_range, read_values
from tribodyn.types import ByName, Tree

if TYPE_CHECKING:
    from tribodyn.progress import Progress
    from tribodyn.study.case.pair import PairCase

#: Values of a study by name: numbers and choices checked, others as text; None or empty: default.
Values = ByName
#: What a study shows: ``sentences``, ``tables``, and figures as (heading, figure, caption).
Shown = Tree

RANGE = "400..3500 rpm:20, or 50, 150, 300 N*m"
#: Studies that the report calls differently.
_KINDS = {"friction-from-loss": "friction from losses"}
#: Data of a measurement of losses that the page asks for.
MEASURED = ("gear_sets", "no_load_torque", "other_loss")


def varied(values: Values) -> Iterator[tuple[str, object]]:
    """Keys of a sweep with their values."""
    for key, name in (("key", "values"), ("second_key", "second_values")):
        if values[key]:
            yield values[key], _read(name, values[name] or "", read_values)


def _read(name: str, text: str, read: Callable[[str], object]) -> Any:
    """Parse a range or a list in the syntax of the commands."""
    try:
        return read(text)
    except UnreadError as fault:
        raise InputError(f'cannot read "{text}"', name, str(fault), f"Write {RANGE}") from None


def in_values(name: str, text: str) -> Any:
    """Range or list of a field."""
    return _read(name, text, read_values)


def in_range(name: str, text: str) -> Any:
    """Both ends and the number of points of a field."""
    return _read(name, text, read_range)


def ends_in(name: str, text: str) -> tuple[str, str]:
    """Both ends of a field without a number of points."""
    low, high, _ = _read(name, f"{text}:2", read_range)
    return low, high


def _points(case: PairCase, key: str, text: str) -> list[float] | None:
    """Parse torques or speeds like the keys of the case."""
    from tribodyn.study.studies.study_axes import points_of

    return points_of(case, key, _read(key, text, read_values), by="study") if text else None


def _operation(case: PairCase, values: Values) -> dict[str, list[float] | None]:
    return {n: _points(case, f"operation.{n}", values[n] or "") for n in ("torque", "speed")}


def write(answer: StudyReportData, kind: str, case: PairCase, target: Path) -> Shown:
    """Write the directory of a study, and return what the page shows of it."""
    save_study(_KINDS.get(kind, kind), case, target, answer)
    table = ["Table", list(answer.head), [list(row) for row in answer.rows]]
    parts = {"sentences": list(answer.statements), "tables": [table], "figures": answer.figures}
    changes = getattr(answer.data, "changes", None)
    return parts if changes is None else {**parts, "relief": changes}


def _sweep(case: PairCase, values: Values, progress: Progress, target: Path) -> Shown:
    from tribodyn.study.pipeline.summary_figures import in_words
    from tribodyn.study.studies.sweep import sweep

    result = sweep(case, dict(varied(values)), by="study", progress=progress)
    result.save(target)
    if not plot.machine_sweep.missing(result):
        figures = [figure_with_caption(plot.machine_sweep, result)]
    else:
        figures = [(in_words(n), result.plot(n), "") for n in result.displayed_figures()]
        figures[:1] = [(*each[:2], plot.sweep.caption_of(result)) for each in figures[:1]]
    failed = dict.fromkeys(point.failed for point in result.points if point.failed)
    return {
        "sentences": [f"{len(result.points)} values.", *failed],
        "tables": [],
        "figures": figures,
    }


def _bifurcation(case: PairCase, values: Values, progress: Progress, target: Path) -> Shown:
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
    of_studies.save_bifurcation(result, case, findings, target)
    head, rows = findings.rows()
    return {
        "sentences": list(findings.sentences()),
        "tables": [["Table", list(head), [list(row) for row in rows]]],
        "figures": [figure_with_caption(plot.bifurcation, result)],
    }


def _recording(case: PairCase, values: Values, progress: Progress, target: Path) -> Shown:
    from tribodyn.report.signal_report import recorded_motion, recording_report_data

    settings = {k: values[k] for k in ("duration", "sample_rate", "noise", "seed")}
    sensor = values["sensor"]
    recorded, truth = recorded_motion(case, [sensor], progress, **settings)
    content = write(recording_report_data(recorded, sensor), "recording", case, target)
    recorded.save(target / f"recording.{values['format']}", truth={"title": case.title, **truth})
    return content


#: Studies that write directories of their own form.
WRITERS = {"sweep": _sweep, "bifurcation": _bifurcation, "recording": _recording}


def _friction_from_loss(case: PairCase, values: Values, progress: Progress) -> StudyReportData:
    from tribodyn.losses import friction_from_power_loss

    progress.start("Friction coefficients")
    options = {name: values[name] for name in MEASURED}
    losses = of_studies.measured_losses(values["file"], case, values["mesh"], options)
    return of_studies.friction_report_data(losses, friction_from_power_loss(losses))


def torques_in(values: Values) -> list[str] | None:
    """Torques of a study; None where its field is empty."""
    return _read("torque", values["torque"], read_list) if values["torque"] else None


def _relief(case: PairCase, values: Values, progress: Progress) -> StudyReportData:
    progress.start("Tip relief")
    how = torques_in(values), values["gears"], values["mesh"]
    return of_studies.relief_report_data(case, *how)


def _lead(case: PairCase, values: Values, progress: Progress) -> StudyReportData:
    chosen = {name: values[name] for name in ("gear", "misalignment", "mesh")}
    return of_studies.lead_report_data(case, torques_in(values), progress, **chosen)


def _harris(case: PairCase, values: Values, progress: Progress) -> StudyReportData:
    progress.start("Static transmission error")
    return of_studies.harris_report_data(case, torques_in(values), values["mesh"])


def _modes(case: PairCase, values: Values, progress: Progress) -> StudyReportData:
    from tribodyn.report.nonlinear_report_data import any_modes_report_data

    ends = ends_in("speeds", values["speeds"]) if values["speeds"] else None
    return any_modes_report_data(case, ends, progress)


def _run_up(case: PairCase, values: Values, progress: Progress) -> StudyReportData:
    ends, duration = ends_in("speeds", values["speeds"]), values["duration"]
    return of_studies.run_up_report_data(case, ends, duration, progress=progress)


def _continuation(case: PairCase, values: Values, progress: Progress) -> StudyReportData:
    ends, step = ends_in("ends", values["ends"]), values["longest_step"]
    how = values["periods"], step, "study", progress, values["mesh"]
    return nonlinear.continuation_report_data(case, values["key"], ends, *how)


def _basins(case: PairCase, values: Values, progress: Progress) -> StudyReportData:
    error, rate = (
        ends_in(name, values[name]) if values[name] else None
        for name in ("transmission_error", "rate")
    )
    how = values["points"], False, progress, values["mesh"]
    return nonlinear.basins_report_data(case, error, rate, *how)


def _sobol(case: PairCase, values: Values, progress: Progress) -> StudyReportData:
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
    return nonlinear.sobol_report_data(spread_case, figures, values["size"], 0, progress)


#: Report data of the other studies, by the names of their commands.
FUNCTIONS: Mapping[str, Callable[[Any, Values, Progress], StudyReportData]] = {
    "losses": lambda case, values, progress: of_studies.losses_report_data(
        case, **_operation(case, values), progress=progress, mesh=values["mesh"]
    ),
    "film": lambda case, values, progress: of_studies.film_report_data(
        case, **_operation(case, values), progress=progress, mesh=values["mesh"]
    ),
    "friction-from-loss": _friction_from_loss,
    "relief": _relief,
    "lead": _lead,
    "harris": _harris,
    "modes": _modes,
    "run-up": _run_up,
    "continuation": _continuation,
    "basins": _basins,
    "lyapunov": lambda case, values, progress: nonlinear.lyapunov_report_data(
        case, values["cycles"], values["transient"], progress
    ),
    "sobol": _sobol,
}
