"""Studies that the page starts: the functions of the commands, with their values as a form."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tribodyn.app.case_form import field_of
from tribodyn.errors import InputError
from tribodyn.model import REQUIRED, Option, choice, integer, number, text
from tribodyn.nomenclature import GEARS
from tribodyn.study.case.values import FaultError, Plain, read_value
from tribodyn.study.machine.case import MachineCase
from tribodyn.study.studies.needs import STUDIES as NEEDS
from tribodyn.study.studies.needs import kind_of
from tribodyn.study.studies.range_syntax import (
    UnreadError,
    read_list,
    read_range,
    read_values,
    toml_value,
)

if TYPE_CHECKING:
    from tribodyn.progress import Progress
    from tribodyn.study.case.case import Case

#: Values of a study by name: numbers and choices checked, others as text; None or empty: default.
Values = Mapping[str, Any]
#: What a study shows: ``sentences``, ``tables``, and figures as (heading, figure, caption).
Shown = dict[str, Any]

#: Ends of the keys of a tip relief.
_RELIEF = ("", "_length", "_shape")
#: Kinds of options whose values are checked before the study begins.
_CHECKED = ("number", "integer", "choice")
_RANGE = "400..3500 rpm:20, or 50, 150, 300 N*m"
_ENDS = "400..3500 rpm"


def _text(default: Any, meaning: str, example: str) -> Option:
    option: Option = text(default, meaning=f"{meaning}, such as {example}", example=example)
    return option


@dataclass(frozen=True)
class Study:
    """One kind of study."""

    title: str
    meaning: str
    options: Mapping[str, Option]
    function: Callable[[Any, Values, Progress, Path], Shown]

    def compute(
        self, case: Case | MachineCase, texts: Mapping[str, str], progress: Progress, target: Path
    ) -> Shown:
        """Check the typed values, compute the study and write its directory."""
        values: dict[str, Any] = {}
        problems = []
        for name, option in self.options.items():
            values[name] = text = texts.get(name) or default_of(option)
            if texts.get(name) and option.kind in _CHECKED and not name.endswith("key"):
                try:
                    values[name] = read_value(option, name, Plain(toml_value(text)))
                except FaultError as fault:
                    problems.append(replace(fault.problem, where=name))
        if problems:
            raise InputError(problems)
        return self.function(case, values, progress, target)


def _varied(values: Values) -> Iterator[tuple[str, Any]]:
    for key, name in (("key", "values"), ("second_key", "second_values")):
        if values[key]:
            yield values[key], _read(name, values[name] or "", read_values)


def _read(name: str, text: str, read: Callable[[str], Any]) -> Any:
    """Parse a range or a list in the syntax of the commands."""
    try:
        return read(text)
    except UnreadError as fault:
        raise InputError(f'cannot read "{text}"', name, str(fault), f"Write {_RANGE}") from None


def _ends(name: str, text: str) -> tuple[Any, Any]:
    low, high, _ = _read(name, f"{text}:2", read_range)
    return low, high


def _points(case: Case, key: str, text: str) -> list[float] | None:
    """Parse torques or speeds like the keys of the case."""
    from tribodyn.study.studies.study_axes import points_of

    return points_of(case, key, _read(key, text, read_values), by="study") if text else None


def _operation(case: Case, values: Values) -> list[list[float] | None]:
    return [_points(case, f"operation.{n}", values[n] or "") for n in ("torque", "speed")]


def _of(answer: Any, kind: str, case: Case, target: Path) -> Shown:
    from tribodyn.report.study_report_data import save_study

    save_study(kind, case, target, answer)
    table = ["Table", list(answer.head), [list(row) for row in answer.rows]]
    return {"sentences": list(answer.statements), "tables": [table], "figures": answer.figures}


def _sweep(case: Case, values: Values, progress: Progress, target: Path) -> Shown:
    from tribodyn import plot
    from tribodyn.report.study_report_data import figure_with_caption
    from tribodyn.study.pipeline.summary_labels import in_words
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
    options = {name: values[name] for name in ("sweep", "cycles", "transient")}
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
    return _of(losses_report_data(case, torque, speed, progress), "losses", case, target)


def _film(case: Case, values: Values, progress: Progress, target: Path) -> Shown:
    from tribodyn.report.study_report_data import film_report_data

    torque, speed = _operation(case, values)
    return _of(film_report_data(case, torque, speed, progress), "film", case, target)


def _relief(case: Case, values: Values, progress: Progress, target: Path) -> Shown:
    from tribodyn.report.study_report_data import relief_report_data

    progress.start("Tip relief")
    torque = _read("torque", values["torque"], read_list) if values["torque"] else None
    answer = relief_report_data(case, torque, values["gears"])
    content = _of(answer, "relief", case, target)
    gears = list(GEARS) if values["gears"] == "both" else [values["gears"]]
    reliefs = [f"gears.{g}.modification.tip_relief{part}" for g in gears for part in _RELIEF]
    changes = getattr(answer.best, "user_input", {})
    return {**content, "relief": {key: changes[key] for key in reliefs if key in changes}}


def _harris(case: Case, values: Values, progress: Progress, target: Path) -> Shown:
    from tribodyn.report.study_report_data import harris_report_data

    progress.start("Static transmission error")
    torque = _read("torque", values["torque"], read_list) if values["torque"] else None
    return _of(harris_report_data(case, torque), "harris", case, target)


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
        case, values["key"], ends, values["periods"], step, "study", progress
    )
    return _of(answer, "continuation", case, target)


def _basins(case: Case, values: Values, progress: Progress, target: Path) -> Shown:
    from tribodyn.report.nonlinear_report_data import basins_report_data

    error, rate = (
        _ends(name, values[name]) if values[name] else None
        for name in ("transmission_error", "rate")
    )
    answer = basins_report_data(case, error, rate, values["points"], progress=progress)
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


_TORQUES = _text(None, "torques; 8 up to twice that of the case where it is empty", "50..300 N*m:6")
_SPEEDS = _text(None, "speeds; 8 up to twice that of the case where it is empty", "400, 1400 rpm")
_LIST = _text(None, "torques", "60 N*m, 120 N*m")
_KEY = "operation.speed"
_GUARD = "guards against a slip of the keyboard"


def offered(kind: str, case: Case | MachineCase) -> bool:
    """Whether the page offers a study for a case."""
    return kind_of(case) in NEEDS[kind].kinds


STUDIES: dict[str, Study] = {
    "sweep": Study(
        "Sweep",
        "The whole case at many values of one of its keys, or at a grid of two.",
        {
            "key": choice(REQUIRED, list, meaning="what varies"),
            "values": _text(REQUIRED, "its values", _RANGE),
            "second_key": choice(None, list, meaning="what varies besides"),
            "second_values": _text(None, "its values", _RANGE),
        },
        _sweep,
    ),
    "losses": Study(
        "Operating map",
        "Losses and efficiency over torque and speed; no motion is computed.",
        {"torque": _TORQUES, "speed": _SPEEDS},
        _losses,
    ),
    "film": Study(
        "Oil film over operation",
        "Least film and lubrication regime over torque and speed.",
        {"torque": _TORQUES, "speed": _SPEEDS},
        _film,
    ),
    "bifurcation": Study(
        "Bifurcation",
        "The motion over one value: jumps, doubled periods, chaos.",
        {
            "key": choice(REQUIRED, list, meaning="what varies"),
            "values": _text(REQUIRED, "its range with the number of points", "400..3500 rpm:60"),
            "sweep": choice(
                "up", ("up", "down", "both", "independent"), meaning="where each motion begins"
            ),
            "cycles": integer(64, 2, 4096, _GUARD, meaning="mesh cycles of the statistics"),
            "transient": integer(300, 0, 100000, _GUARD, meaning="mesh cycles before"),
        },
        _bifurcation,
    ),
    "continuation": Study(
        "Branch of motions",
        "The periodic motion over one value, stable or not: where it turns back and jumps.",
        {
            "key": choice(REQUIRED, list, meaning="what varies"),
            "ends": _text(REQUIRED, "its first and last value", "3000..9000 rpm"),
            "periods": integer(1, 1, 16, _GUARD, meaning="mesh cycles until the motion repeats"),
            "longest_step": number(
                0.02, 1e-4, 1.0, _GUARD, meaning="longest step, relative to the range"
            ),
        },
        _continuation,
    ),
    "basins": Study(
        "Basins",
        "Which of several motions a disturbed start comes to.",
        {
            "transmission_error": _text(
                None, "its range; about the static one where it is empty", "-20..40 um"
            ),
            "rate": _text(None, "range of its rate", "-400000..400000 um/s"),
            "points": integer(21, 2, 201, _GUARD, meaning="values of each"),
        },
        _basins,
    ),
    "lyapunov": Study(
        "Lyapunov exponents",
        "Whether the motion is chaos.",
        {
            "cycles": integer(1000, 2, 100000, _GUARD, meaning="mesh cycles of the mean"),
            "transient": integer(300, 0, 100000, _GUARD, meaning="mesh cycles before"),
        },
        _lyapunov,
    ),
    "sobol": Study(
        "Tolerances",
        "Which tolerance the spread of the figures comes from; those in the case count too.",
        {
            "key": choice(REQUIRED, list, meaning="what has a tolerance"),
            "tolerance": _text(REQUIRED, "its value with the tolerance", "90 N*m +- 5 %"),
            "second_key": choice(None, list, meaning="what has one besides"),
            "second_tolerance": _text(None, "its value with the tolerance", "1500 rpm +- 2 %"),
            "figures": _text(None, "figures of the summary", "peak_mesh_force, efficiency"),
            "size": integer(32, 2, 4096, _GUARD, meaning="size of the sample, a power of two"),
        },
        _sobol,
    ),
    "relief": Study(
        "Tip relief",
        "The tip relief that leaves least transmission error, and the case with it.",
        {
            "torque": _LIST,
            "gears": choice("both", ("both", *GEARS), meaning="gears with relief"),
        },
        _relief,
    ),
    "harris": Study(
        "Harris map", "The static transmission error over the torque.", {"torque": _LIST}, _harris
    ),
    "modes": Study(
        "Natural modes",
        "Natural frequencies and critical speeds; no motion is computed.",
        {"speeds": _text(None, "speeds of the Campbell diagram", _ENDS)},
        _modes,
    ),
    "run-up": Study(
        "Run-up",
        "The motion while the speed rises: where it vibrates most.",
        {
            "speeds": _text(REQUIRED, "lowest and highest speed", _ENDS),
            "duration": number(10.0, 0.1, 1e4, _GUARD, meaning="length of the rise in seconds"),
        },
        _run_up,
    ),
}


def numeric_keys(options: Mapping[str, Option]) -> list[str]:
    """Keys of a case that a study can vary."""
    return [key for key, option in options.items() if option.kind == "number"]


def first_values(kind: str, case: Case | MachineCase) -> dict[str, str]:
    """Values to begin with: speeds about that of the case."""
    from tribodyn.units import convert

    point = case.operating_point if isinstance(case, MachineCase) else case.operation
    rpm = abs(convert(point.speed, "rad/s", "rpm"))
    about = f"{0.5 * rpm:.4g}..{2.0 * rpm:.4g} rpm"
    first = {
        "key": _KEY,
        "values": f"{about}:{8 if kind == 'sweep' else 60}",
        "speeds": about,
        "ends": about,
        "tolerance": f"{rpm:.4g} rpm +- 2 %",
    }
    required = [n for n, o in STUDIES[kind].options.items() if o.required]
    return {name: value for name, value in first.items() if name in required}


def form_of(kind: str, values: Values, keys: list[str]) -> dict[str, Any]:
    """The form of a study as data."""
    study, fields = STUDIES[kind], []
    for name, option in study.options.items():
        field = field_of(name, option, values.get(name, ""), default_of(option))
        if name.endswith("key"):
            field["names"] = [["", "nothing"]] * (not option.required) + [[k, k] for k in keys]
        fields.append(field)
    group = {
        "key": kind,
        "title": study.title,
        "meaning": study.meaning,
        "note": "",
        "open": True,
        "fields": fields,
        "more": [],
        "groups": [],
    }
    return {"groups": [group], "faults": []}


def default_of(option: Option) -> Any:
    """Value in force where none is given."""
    return None if option.required else option.default
