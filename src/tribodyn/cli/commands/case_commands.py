"""``tribodyn cases``, ``check``, ``frequencies`` and ``new``."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from cyclopts import Parameter

from tribodyn.cli.console import figures, say, say_json, show_warnings, table, tell
from tribodyn.cli.screen import screen
from tribodyn.cli.settings import CaseName, Flag, Settings, Words, changed_any_case, check_file
from tribodyn.errors import InputError, ModelWarning
from tribodyn.units import UnitProblemError, parse

if TYPE_CHECKING:
    from tribodyn.study.case.pair import PairCase
    from tribodyn.study.machine.case import AnyCase, MachineCase


def cases(*, json: Flag = False) -> None:
    """List the built-in cases.

    Parameters
    ----------
    json : bool
        Write one JSON array to stdout.
    """
    from tribodyn.cases.catalogue import cases as all_cases

    titles = all_cases(machines=True)
    if json:
        say_json([{"name": name, "title": title} for name, title in titles.items()])
    else:
        say(table([[name, title] for name, title in titles.items()], indent=""))


def check(
    case: CaseName, /, *, set_: Settings = None, all: Flag = False, json: Flag = False
) -> None:
    """Check a case, rehearse its run and show the geometry that follows from it.

    Parameters
    ----------
    all : bool
        Print each figure with its meaning, and each assumption.
    json : bool
        Write one flat JSON object in SI to stdout.
    """
    from tribodyn.study.pipeline.summary_figures import summary_rows

    ready = changed_any_case(case, set_ or [])
    checked: Any = _checked_pair if ready.lumped else _checked_machine
    values, warned, idle, remarks = checked(ready)
    if json:
        say_json(values)
    else:
        every = all or ready.lumped
        text = figures(summary_rows(values)) if every else screen(values, values)
        say(f"{ready.title}\n{text}")
    show_warnings(warned)
    for key, why in idle.items():
        option = ready.option_of(key)
        if option is None or ready.get(key) != option.default:
            tell(f"{ready.source.where(key)} has no effect: {why}.")
    kinds = Counter(assumption.kind for assumption in ready.assumptions)
    counts = ", ".join(f"{count} {kind}" for kind, count in sorted(kinds.items()))
    for remark in [*(ready.assumptions if all else ()), *remarks]:
        tell(str(remark))
    tell(f"The case is in order; values that it does not state (--all): {counts or 'none'}.")


#: Figures, warnings, keys without effect with their reason, and remarks on the motion.
_Checked = tuple[dict[str, float], Iterable[ModelWarning], dict[str, str], list[str]]


def _checked_pair(case: PairCase) -> _Checked:
    """Geometry and load of a pair, after rehearsing its run."""
    from tribodyn.study.case.sections import AUTO
    from tribodyn.study.pipeline.assembly import geometry
    from tribodyn.study.pipeline.cautions import case_cautions, idle_values
    from tribodyn.study.pipeline.motion import engine_remark
    from tribodyn.study.pipeline.preview import operating_figures
    from tribodyn.study.pipeline.run import rehearse

    warned = rehearse(case)
    values = {n: float(v) for n, v in (geometry(case) | operating_figures(case)).items()}
    remarks = [engine_remark(case)] if case.solver.engine == AUTO else []
    if case.faults is not None:
        from tribodyn.study.faults.clock import turning_clock

        remarks = [f"The motion with its faults repeats after {turning_clock(case)}."]
    return values, [*case_cautions(case), *warned], dict(idle_values(case)), remarks


def _checked_machine(case: MachineCase) -> _Checked:
    """Speeds, torques and power of a machine, after rehearsing its teeth."""
    from tribodyn.errors import collected
    from tribodyn.study.faults.machine_motion import rehearse_faults
    from tribodyn.study.machine.first_look import idle_keys, kinematic_figures
    from tribodyn.study.machine.run import rehearse_machine

    with collected() as warned:
        balanced = rehearse_machine(case)
        costs = rehearse_faults(case, balanced)
        values = kinematic_figures(case, balanced.load)
    return values, warned, idle_keys(case), costs


def frequencies(
    case: CaseName,
    /,
    *,
    near: str | None = None,
    sidebands: int = 1,
    set_: Words = None,
    json: Flag = False,
) -> None:
    """List the frequencies of shafts, meshes, bearings and planets; nothing is computed.

    Parameters
    ----------
    near : str
        Frequency of a peak such as "312 Hz": only what lies within 1 % of it, with harmonics.
    sidebands : int
        Sidebands on each side of each mesh frequency.
    set_ : list of str
        Values to change, for example "operation.speed=1450 rpm".
    json : bool
        Write the lines in Hz as one JSON array to stdout.
    """
    from tribodyn.analysis.part_frequencies import PartFrequency
    from tribodyn.study.frequencies import kinematic_frequencies

    ready = changed_any_case(case, set_ or [])
    lines = kinematic_frequencies(ready, sidebands=sidebands)
    columns = lines.part, lines.symbol, lines.frequency.tolist(), lines.meaning
    listed = [PartFrequency(*line) for line in zip(*columns, strict=True)]
    if near is not None:
        try:
            listed = lines.near(parse(near, "Hz"))
        except UnitProblemError as error:
            raise InputError(f"{error}", "--near", "", 'Write --near "312 Hz"') from None
    orders = [line.frequency / lines.input_frequency for line in listed]
    if json:
        say_json([{**line._asdict(), "order": o} for line, o in zip(listed, orders, strict=True)])
        return
    head = ("part", "", "Hz", "order", "what")
    say(f"{ready.title}, input at {lines.input_frequency:.6g} Hz")
    body = [
        (line.part, line.symbol, f"{line.frequency:.6g}", f"{order:.6g}", line.meaning)
        for line, order in zip(listed, orders, strict=True)
    ]
    say(
        table([head, *body])
        if body
        else f"No part has {near}, alone or as one of its first ten harmonics."
    )
    if lines.without_elements:
        names = ", ".join(lines.without_elements)
        tell(f"Without frequencies, for they have no type with elements: bearings {names}.")


def new(
    path: Path,
    /,
    *,
    from_: Annotated[str | None, Parameter(name="--from")] = None,
    machine: Flag = False,
    stage: Flag = False,
    hypoid: Flag = False,
    force: Flag = False,
    json: Flag = False,
) -> None:
    """Write a commented case file to start from, with the files that it needs.

    Parameters
    ----------
    path : Path
        File to write; the matrices of a housing are copied next to it.
    from_ : str
        Built-in case or case file to take all values from; by default a short file of no
        particular gears is written, to be filled in.
    machine : bool
        Short file of a gearbox with shafts and bearings in place of that of a gear pair.
    stage : bool
        Short file of a planetary stage.
    hypoid : bool
        Short file of a pair of hypoid gears.
    force : bool
        Replace an existing file.
    json : bool
        Write one JSON object to stdout.
    """
    from tribodyn.cases.load import load_case
    from tribodyn.study.machine.housing_files import copy_housing
    from tribodyn.study.pipeline.save import write_file

    templates = {"from": from_, "machine": machine, "stage": stage, "hypoid": hypoid}
    options = [name for name, value in templates.items() if value]
    if len(options) > 1:
        what = f"{' and '.join(f'--{name}' for name in options)} are both given"
        raise InputError(what, "tribodyn new", "A file has one beginning", "Keep one of them")
    check_file(path, force)
    source = load_case(from_) if from_ else None
    files = []
    if source is not None:
        prefix = f"{path.stem}-"
        files = [path.parent / name for name in source.with_files(prefix).housing_files.values()]
        for file in files:
            check_file(file, force)
        source = copy_housing(source, path.parent, prefix)
    write_file(path, _new_text(source, *options))
    if json:
        say_json({"path": str(path)} | ({"files": [str(file) for file in files]} if files else {}))
    else:
        say("\n".join(map(str, (path, *files))))
        tell(f"Edit it, then: tribodyn check {path}")


def _new_text(source: AnyCase | None, kind: str = "") -> str:
    """Text of a case file with all values of a case, or to be filled in."""
    from tribodyn.study.case.reference import start_toml
    from tribodyn.study.machine_tables import start_of

    if source is None:
        return start_of(kind) if kind else start_toml()
    return source._text(comments=True)
