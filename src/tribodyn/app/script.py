"""What was done on the page as a Python script, which does the same with public names."""

from __future__ import annotations

import tomllib
from collections.abc import Callable, Iterator, Mapping
from pprint import pformat
from typing import TYPE_CHECKING, Any

import tribodyn
from tribodyn.app.session import Edited, TabSession
from tribodyn.app.studies import STUDIES
from tribodyn.app.study_functions import (
    MEASURED,
    Values,
    ends_in,
    in_range,
    in_values,
    torques_in,
    varied,
)
from tribodyn.cases.catalogue import cases
from tribodyn.cases.load import load_case
from tribodyn.errors import TribodynError, collected
from tribodyn.types import Tree

if TYPE_CHECKING:
    from tribodyn.app.jobs import Job

#: Characters of a line.
_WIDTH = 100


def script_of(session: TabSession) -> str:
    """Script with the cases, runs and studies of a tab, in their order."""
    title = session.case.title.replace("\\", "/").replace('"', "'")
    made_by = f"Done on the page of tribodyn {tribodyn.__version__}."
    lines = [f'"""{title}', "", f'{made_by}"""', "", "import tribodyn as td"]
    state: Edited | None = None
    names: dict[int, str] = {}
    for job in sorted(session.all_jobs(), key=lambda each: each.number):
        if job.state in ("failed", "stopped"):
            continue
        if job.kind == "overlay":
            lines += _overlay(job, names)
            continue
        lines += ["", *_case_lines(session, state, session.edited[job.number])]
        state = session.edited[job.number]
        names[job.number] = job.title.lower().replace(" ", "_") if job.kind == "run" else (
            f"study_{1 + sum(name.startswith('study') for name in names.values())}"
        )  # fmt: skip
        lines += _run(job, names[job.number]) if job.kind == "run" else _study(job, names)
    last = list(_case_lines(session, state, session.edits_of_case()))
    return "\n".join([*lines, *([""] if last else []), *last]) + "\n"


def _case_lines(session: TabSession, before: Edited | None, now: Edited) -> Iterator[str]:
    """Lines that lead from one case to another."""
    written = 0
    if before is not None and now.follows(before):
        written = len(before.changes)
    else:
        yield f"case = {_opening(session, now)}"
    for changes in now.changes[written:]:
        yield f"case = case.replace({_literal(changes, 20)})"


def _opening(session: TabSession, state: Edited) -> str:
    """Expression of the case as it was opened."""
    name = state.opened.source.name.removesuffix(".toml")
    with collected():
        for place, load in ((state.file, session.folder.load), (name, load_case)):
            try:
                is_there = bool(place) and (bool(state.file) or place in cases(machines=True))
                if is_there and load(place) == state.opened:
                    return f"td.load_case({place!r})"
            except TribodynError:
                continue
    tables = tomllib.loads(state.opened.to_toml())
    return f"td.Case(**{_literal(tables, 17)})"


def _literal(value: object, indent: int) -> str:
    """Python literal on lines of limited width."""
    text = repr(value)
    if len(text) + indent <= _WIDTH:
        return text
    rows = pformat(value, width=_WIDTH - 4, compact=True, sort_dicts=False).splitlines()
    return "\n    ".join(rows)


def _run(job: Job, name: str) -> Iterator[str]:
    yield f"{name} = td.run(case)"
    yield f"print({name}.summary())"
    blocks = [each["name"] for each in job.content.get("blocks", ()) if not each["missing"]]
    if blocks:
        figure = "mesh_force" if "mesh_force" in blocks else blocks[0]
        yield f'{name}.plot_{figure}().write_html("{name.replace("_", "-")}.html")'


def _overlay(job: Job, names: Mapping[int, str]) -> Iterator[str]:
    """The runs of an overlay that are in the script."""
    runs = [names[number] for number in job.order["numbers"] if number in names]
    if len(runs) > 1:
        labels = [name.replace("_", " ").capitalize() for name in runs]
        yield f"overlay = td.compare_results({', '.join(runs)}, names={labels})"
        yield 'overlay.plot().write_html("overlay.html")'


def _study(job: Job, names: Mapping[int, str]) -> Iterator[str]:
    """Lines of a study: the function with its values, and its figure."""
    name, kind = names[job.number], job.order["study"]
    values = STUDIES[kind].read(job.order["values"])
    *before, call = _CALLS[kind](job.case, values)
    yield from before
    yield f"{name} = {call}"
    file = f'"{name.replace("_", "-")}.html"'
    if kind == "sweep" and not job.case.lumped:
        yield f"td.plot.machine_sweep({name}).write_html({file})"
    else:
        yield f"{name}.plot().write_html({file})"


def _call(function: str, *arguments: object, **options: object) -> str:
    """Call with the case first; options that are None are left out."""
    stated = [f"{key}={value!r}" for key, value in options.items() if value is not None]
    return f"{function}({', '.join(['case', *map(repr, arguments), *stated])})"


def _operation(values: Values) -> Tree:
    return {key: in_values(key, values[key]) for key in ("torque", "speed") if values[key]}


def _film(case: Any, values: Values) -> list[str]:
    """The film needs its torques and speeds: those of the page, where none are typed."""
    from tribodyn.study.studies.losses import STEPS
    from tribodyn.study.studies.needs import mesh_pair

    with collected():
        operation = mesh_pair("film", case, values["mesh"]).pair.operation
    steps = {key: (STEPS * getattr(operation, key)).tolist() for key in ("torque", "speed")}
    options = {**steps, **_operation(values), "mesh": values["mesh"]}
    return [_call("td.film_over_operation", **options)]


def _bifurcation(case: object, values: Values) -> list[str]:
    low, high, points = in_range("values", values["values"])
    options = {name: values[name] for name in ("mesh", "sweep", "cycles", "transient")}
    options["keep"] = min(48, values["cycles"])
    return [_call("td.bifurcation", values["key"], (low, high), points, **options)]


def _continuation(case: object, values: Values) -> list[str]:
    options = {name: values[name] for name in ("periods", "longest_step", "mesh")}
    return [_call("td.continuation", values["key"], ends_in("ends", values["ends"]), **options)]


def _basins(case: object, values: Values) -> list[str]:
    names = ("transmission_error", "rate")
    ends = {name: ends_in(name, values[name]) for name in names if values[name]}
    return [_call("td.basins", **ends, points=values["points"], mesh=values["mesh"])]


def _sobol(case: object, values: Values) -> list[str]:
    pairs = (("key", "tolerance"), ("second_key", "second_tolerance"))
    spread = {values[key]: values[tolerance] for key, tolerance in pairs if values[key]}
    figures = (values["figures"] or "").replace(",", " ").split() or None
    call = _call("td.sobol_indices", figures=figures, size=values["size"], seed=0)
    return [call.replace("(case", f"(case.replace({spread!r})", 1)]


def _recording(case: object, values: Values) -> list[str]:
    settings = {name: values[name] for name in ("duration", "sample_rate", "noise", "seed")}
    stated = ", ".join(f"{key}={value!r}" for key, value in settings.items())
    sensor = values["sensor"]
    return [
        f"recording = td.run(case).recording([{sensor!r}], {stated})",
        f'recording.save("recording.{values["format"]}")',
        f'td.measurement.analyse_signal(recording, {sensor!r}, tacho="tacho")',
    ]


def _friction(case: Any, values: Values) -> list[str]:
    from tribodyn.losses import gear_loss_factor
    from tribodyn.losses.loss_table import TABLES
    from tribodyn.study.studies.needs import mesh_pair

    with collected():
        factor = gear_loss_factor(
            mesh_pair("friction-from-loss", case, values["mesh"]).pair.gear_pair
        )
    data = {name: values[name] for name in MEASURED if values[name] is not None}
    file, stated = values["file"], "".join(f", {key}={value!r}" for key, value in data.items())
    before = [f"losses = td.losses.read_power_loss_table({file!r}, {factor!r}{stated})"]
    if file in TABLES:
        before = [
            "from dataclasses import replace",
            f"losses = td.losses.power_loss_table({file!r})",
            f"losses = replace(losses, gear_loss_factor={factor!r}{stated})",
        ]
    return [*before, "td.losses.friction_from_power_loss(losses)"]


#: Lines of each study, the call at last.
_CALLS: dict[str, Callable[[Any, Any], list[str]]] = {
    "sweep": lambda case, values: [_call("td.sweep", dict(varied(values)))],
    "losses": lambda case, values: [
        _call("td.loss_map", **_operation(values), mesh=values["mesh"])
    ],
    "film": _film,
    "bifurcation": _bifurcation,
    "continuation": _continuation,
    "basins": _basins,
    "lyapunov": lambda case, values: [
        _call("td.lyapunov_exponents", cycles=values["cycles"], transient=values["transient"])
    ],
    "sobol": _sobol,
    "relief": lambda case, values: [
        _call("td.optimize_tip_relief", torques_in(values), gears=values["gears"],
              mesh=values["mesh"])
    ],
    "lead": lambda case, values: [
        _call("td.optimize_lead", torques_in(values), gear=values["gear"],
              misalignment=values["misalignment"], mesh=values["mesh"])
    ],
    "harris": lambda case, values: [
        _call("td.harris_map", torques_in(values), mesh=values["mesh"])
    ],
    "modes": lambda case, values: [
        _call("td.campbell", *([ends_in("speeds", values["speeds"])] if values["speeds"] else []))
    ],
    "run-up": lambda case, values: [
        _call("td.run_up", ends_in("speeds", values["speeds"]), values["duration"])
    ],
    "recording": _recording,
    "friction-from-loss": _friction,
}  # fmt: skip
