"""Studies that the page starts: the functions of the commands, with their values as a form."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tribodyn.app.case_form import field_of
from tribodyn.app.study_functions import FUNCTIONS, MEASURED, RANGE, WRITERS, Shown, Values, write
from tribodyn.errors import InputError
from tribodyn.model import REQUIRED, Option, choice, file_path, integer, number, text
from tribodyn.nomenclature import GEARS, PAIR_MESH
from tribodyn.report.study_report_data import MEASUREMENT
from tribodyn.study.case.values import FaultError, Plain, read_value
from tribodyn.study.studies.needs import STUDIES as NEEDS
from tribodyn.study.studies.needs import study_meshes, takes
from tribodyn.study.studies.study_axes import toml_value
from tribodyn.types import Tree

if TYPE_CHECKING:
    from tribodyn.app.workspace import Workspace
    from tribodyn.progress import Progress
    from tribodyn.study.machine.case import AnyCase

#: Kinds of options whose values are checked before the study begins.
_CHECKED = ("number", "integer", "choice")
_ENDS = "400..3500 rpm"


def _text(default: object, meaning: str, example: str) -> Option:
    option: Option = text(default, meaning=f"{meaning}, such as {example}", example=example)
    return option


@dataclass(frozen=True)
class Study:
    """One kind of study."""

    title: str
    meaning: str
    options: Mapping[str, Option]

    def read(self, texts: Mapping[str, str]) -> Values:
        """Check the typed values."""
        values: Tree = {}
        problems = []
        for name, option in self.options.items():
            values[name] = text = texts.get(name) or default_of(option)
            named = option.names is not None and not option.names()
            if texts.get(name) and option.kind in _CHECKED and not named:
                try:
                    values[name] = read_value(option, name, Plain(toml_value(text)))
                except FaultError as fault:
                    problems.append(replace(fault.problem, where=name))
        if problems:
            raise InputError(problems)
        return values


_TORQUES = _text(None, "torques; 8 up to twice that of the case where it is empty", "50..300 N*m:6")
_SPEEDS = _text(None, "speeds; 8 up to twice that of the case where it is empty", "400, 1400 rpm")
_LIST = _text(None, "torques", "60 N*m, 120 N*m")
_MESH = choice(None, list, meaning="which mesh of the case")
_KEY = "operation.speed"
_GUARD = "guards against a slip of the keyboard"


def _time(unit: str, default: float, high: float, meaning: str) -> Option:
    option: Option = number(
        default, 1e-3, high, _GUARD, unit=unit, meaning=meaning, example=f'"{default:g} {unit}"'
    )
    return option


def offered(kind: str, case: AnyCase) -> bool:
    """Whether the page offers a study for a case."""
    return takes(kind, case) and (not NEEDS[kind].of_mesh or bool(study_meshes(kind, case)))


STUDIES: dict[str, Study] = {
    "sweep": Study(
        "Sweep",
        "The whole case at many values of one of its keys, or at a grid of two.",
        {
            "key": choice(REQUIRED, list, meaning="what varies"),
            "values": _text(REQUIRED, "its values", RANGE),
            "second_key": choice(None, list, meaning="what varies besides"),
            "second_values": _text(None, "its values", RANGE),
        },
    ),
    "losses": Study(
        "Operating map",
        "Losses and efficiency over torque and speed; no motion is computed.",
        {"mesh": _MESH, "torque": _TORQUES, "speed": _SPEEDS},
    ),
    "film": Study(
        "Oil film over operation",
        "Least film and lubrication regime over torque and speed.",
        {"mesh": _MESH, "torque": _TORQUES, "speed": _SPEEDS},
    ),
    "bifurcation": Study(
        "Bifurcation",
        "The motion over one value: jumps, doubled periods, chaos.",
        {
            "mesh": _MESH,
            "key": choice(REQUIRED, list, meaning="what varies"),
            "values": _text(REQUIRED, "its range with the number of points", "400..3500 rpm:60"),
            "sweep": choice(
                "up", ("up", "down", "both", "independent"), meaning="where each motion begins"
            ),
            "cycles": integer(64, 2, 4096, _GUARD, meaning="mesh cycles of the statistics"),
            "transient": integer(300, 0, 100000, _GUARD, meaning="mesh cycles before"),
        },
    ),
    "continuation": Study(
        "Branch of motions",
        "The periodic motion over one value, stable or not: where it turns back and jumps.",
        {
            "mesh": _MESH,
            "key": choice(REQUIRED, list, meaning="what varies"),
            "ends": _text(REQUIRED, "its first and last value", "3000..9000 rpm"),
            "periods": integer(1, 1, 16, _GUARD, meaning="mesh cycles until the motion repeats"),
            "longest_step": number(
                0.02, 1e-4, 1.0, _GUARD, meaning="longest step, relative to the range"
            ),
        },
    ),
    "basins": Study(
        "Basins",
        "Which of several motions a disturbed start comes to.",
        {
            "mesh": _MESH,
            "transmission_error": _text(
                None, "its range; about the static one where it is empty", "-20..40 um"
            ),
            "rate": _text(None, "range of its rate", "-400000..400000 um/s"),
            "points": integer(None, 2, 201, _GUARD, meaning="values of each, or as many as fit"),
        },
    ),
    "lyapunov": Study(
        "Lyapunov exponents",
        "Whether the motion is chaos.",
        {
            "cycles": integer(
                None, 2, 100000, _GUARD, meaning="mesh cycles of the mean, 1000 or fewer"
            ),
            "transient": integer(300, 0, 100000, _GUARD, meaning="mesh cycles before"),
        },
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
    ),
    "relief": Study(
        "Tip relief",
        "The tip relief that leaves least transmission error, and the case with it.",
        {
            "mesh": _MESH,
            "torque": _LIST,
            "gears": choice("both", ("both", *GEARS), meaning="gears with relief"),
        },
    ),
    "lead": Study(
        "Crowning and lead",
        "The crowning and lead slope that spread the load most evenly, and the case with them.",
        {
            "mesh": _MESH,
            "torque": _LIST,
            "gear": choice("pinion", GEARS, meaning="gear that is modified"),
            "misalignment": _text(None, "misalignment besides that of the case", "15 um"),
        },
    ),
    "harris": Study(
        "Harris map",
        "The static transmission error over the torque.",
        {"mesh": _MESH, "torque": _LIST},
    ),
    "modes": Study(
        "Natural modes",
        "Natural frequencies and critical speeds; no motion is computed.",
        {"speeds": _text(None, "speeds of the Campbell diagram", _ENDS)},
    ),
    "run-up": Study(
        "Run-up",
        "The motion while the speed rises: where it vibrates most.",
        {
            "speeds": _text(REQUIRED, "lowest and highest speed", _ENDS),
            "duration": number(10.0, 0.1, 1e4, _GUARD, meaning="length of the rise in seconds"),
        },
    ),
    "recording": Study(
        "Recording",
        "What a sensor records of the motion, faults included, and its analysis.",
        {
            "sensor": choice(REQUIRED, list, meaning="what is recorded"),
            "duration": _time("s", 1.0, 1e4, "length of the recording"),
            "sample_rate": _time("Hz", 25600.0, 1e7, "samples per second"),
            "noise": number(0.0, 0.0, 1e9, _GUARD, meaning="deviation of white noise, in SI"),
            "seed": integer(0, 0, 10**9, _GUARD, meaning="number of the draw of all that scatters"),
            "format": choice("mat", ("mat", "wav", "h5", "uff", "csv"), meaning="kind of file"),
        },
    ),
    "friction-from-loss": Study(
        "Friction from losses",
        "Friction coefficients from the torque losses that a rig measured with these gears.",
        {
            "mesh": _MESH,
            "file": replace(
                file_path(
                    meaning="CSV file of the folder with the losses, or fzg-wheel-driven",
                    example="losses.csv",
                ),
                default=REQUIRED,
            ),
            **{name: MEASUREMENT[name] for name in MEASURED},
        },
    ),
}


def compute(
    kind: str, case: AnyCase, texts: Mapping[str, str], progress: Progress, target: Path
) -> Shown:
    """Check the typed values of a study, compute it and write its directory."""
    values = STUDIES[kind].read(texts)
    if kind in WRITERS:
        return WRITERS[kind](case, values, progress, target)  # type: ignore[arg-type]
    return write(FUNCTIONS[kind](case, values, progress), kind, case, target)  # type: ignore[arg-type]


def numeric_keys(options: Mapping[str, Option]) -> list[str]:
    """Keys of a case that a study can vary."""
    return [key for key, option in options.items() if option.kind == "number"]


def first_values(kind: str, case: AnyCase) -> dict[str, str]:
    """Values to begin with: speeds about that of the case, the first mesh and sensor."""
    from tribodyn.units import convert

    rpm = abs(convert(dict(case.values())[_KEY], "rad/s", "rpm"))
    about = f"{0.5 * rpm:.4g}..{2.0 * rpm:.4g} rpm"
    first = {
        "key": _KEY,
        "values": f"{about}:{8 if kind == 'sweep' else 60}",
        "speeds": about,
        "ends": about,
        "tolerance": f"{rpm:.4g} rpm +- 2 %",
    }
    required = [n for n, o in STUDIES[kind].options.items() if o.required]
    chosen = {name: value for name, value in first.items() if name in required}
    return {**chosen, **first_names(kind, case)}


def first_names(kind: str, case: AnyCase) -> dict[str, str]:
    """Mesh and sensor that a study begins with: the first mesh, and its force."""
    listed = _listed(kind, case).items()
    return {k: next((n for n in names if "mesh_force" in n), names[0]) for k, names in listed}


def _listed(kind: str, case: AnyCase) -> dict[str, tuple[str, ...]]:
    """Names in the case that a study chooses from; a pair has but one mesh."""
    from tribodyn.study.faults.sensors import sensors_of

    meshes = study_meshes(kind, case) if NEEDS[kind].of_mesh else (PAIR_MESH,)
    listed = {} if meshes == (PAIR_MESH,) else {"mesh": meshes}
    return {**listed, **({"sensor": sensors_of(case).names} if kind == "recording" else {})}


def form_of(kind: str, values: Values, case: AnyCase, keys: Sequence[str]) -> Tree:
    """The form of a study as data; ``keys`` of the case can vary."""
    study, fields = STUDIES[kind], []
    listed = {"key": keys, "second_key": keys, **_listed(kind, case)}
    for name, option in study.options.items():
        if name == "mesh" and name not in listed:
            continue
        field = field_of(name, option, values.get(name, ""), default_of(option))
        if name in listed:
            empty = [["", "nothing"]] * (name == "second_key")
            field["names"] = [*empty, *([each, each] for each in listed[name])]
        if option.unit:  # what is typed may have a unit of its own
            field |= {"value": values.get(name, ""), "units": [option.display_unit]}
        fields.append(field)
    group: Tree = {"key": kind, "title": study.title, "meaning": study.meaning}
    group |= {"note": "", "open": True, "fields": fields, "more": [], "groups": []}
    return {"groups": [group], "faults": []}


def with_paths(kind: str, values: Values, folder: Workspace) -> dict[str, str]:
    """Values of a study with the paths of files of the folder; built-in tables have none."""
    from tribodyn.losses.loss_table import TABLES

    files = [name for name, option in STUDIES[kind].options.items() if option.kind == "file"]
    paths = {
        n: str(folder.inside(values[n])) for n in files if values.get(n, "") not in ("", *TABLES)
    }
    return {**values, **paths}


def default_of(option: Option) -> Any:
    """Value in force where none is given."""
    return None if option.required else option.default
