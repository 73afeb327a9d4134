"""``tribodyn modes``, ``harris``, ``relief`` and ``run-up``: studies of one case."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NamedTuple

from cyclopts import Parameter

from tribodyn.cli.screen import say, say_json, table, tell
from tribodyn.cli.settings import changed_case, check_place, read_ends

if TYPE_CHECKING:
    from tribodyn.study.case.case import Case

Words = Annotated[list[str] | None, Parameter(name="--set", negative="")]
Flag = Annotated[bool, Parameter(negative="")]
Output = Path | None

#: Rows of the table of a run-up.
_ROWS = 40


class Found(NamedTuple):
    """What a study tells: its data, figures, sentences and a table."""

    data: Any  #: result whose data set is stored
    figures: Sequence[tuple[str, Any, str]]  #: heading, figure and caption
    told: Sequence[str]
    head: Sequence[str]
    rows: Sequence[Sequence[str]]
    facts: dict[str, Any]  #: in SI, for ``--json``
    best: Case | None = None  #: a case that the study made


def begun(kind: str, case: str, out: Output, settings: Words, force: bool) -> tuple[Case, Path]:
    """The case of a study with its changes, and the directory to write."""
    target = out if out is not None else Path(f"{Path(case).stem}-{kind}")
    ready = changed_case(case, settings or [])
    check_place(target, force)
    return ready, target


def finish(kind: str, case: Case, target: Path, found: Found, force: bool, json: bool) -> None:
    """Write the directory of a study and tell what was found."""
    from tribodyn.report import write_study_report
    from tribodyn.stored import write_dataset
    from tribodyn.study.pipeline.save import new_directory

    with new_directory(target, force=force) as place:
        (place / "case.toml").write_text(case.to_toml(), encoding="utf-8")
        if found.best is not None:
            (place / "best.toml").write_text(found.best.to_toml(), encoding="utf-8")
        write_dataset(found.data.to_xarray(), place / "study.nc")
        write_study_report(
            case,
            place / "report.html",
            kind=kind,
            told=found.told,
            figures=found.figures,
            head=found.head,
            rows=found.rows,
        )
    if json:
        say_json(found.facts)
    else:
        say("\n".join([case.title, *found.told, table([found.head, *found.rows])]))
    tell(f"Report: {target / 'report.html'}")


def modes(
    case: str,
    /,
    between: str | None = None,
    *,
    out: Output = None,
    set_: Words = None,
    force: Flag = False,
    json: Flag = False,
) -> None:
    """Find natural frequencies and critical speeds of a case; no motion is computed.

    Parameters
    ----------
    case : str
        Built-in case or path of a case file.
    between : str
        Speeds of the Campbell diagram: "400..3500 rpm".
    out : Path
        Directory to write; by default that of the case with "-modes".
    set_ : list of str
        Values to change, for example "operation.torque=120 N*m".
    force : bool
        Replace an earlier result in that directory.
    json : bool
        Write the modes in SI as one JSON object to stdout.
    """
    from tribodyn import plot
    from tribodyn.cli.bar import progress_bar
    from tribodyn.report.numbers import HEAD, cells
    from tribodyn.study.studies.modes import ORDERS, diagram_of, mode_rows, system_of_case

    ready, target = begun("modes", case, out, set_, force)
    with progress_bar() as progress:
        from tribodyn.dynamics import natural_modes
        from tribodyn.study.studies.axes import operation_values

        ends = None if between is None else operation_values("speed", read_ends(between), ready)
        system, mesh_frequency = system_of_case(ready, progress)
    found = natural_modes(system)
    diagram = diagram_of(system, ready, mesh_frequency, ends)
    rows = mode_rows(found, ready, mesh_frequency)
    figures = [
        (each.heading, each(thing), each.caption_of(thing))
        for each, thing in ((plot.mode_shapes, found), (plot.campbell, diagram))
    ]
    told = [
        f"{diagram.plot().layout.title.text}; speeds are those of the {ready.operation.speed_of}."
    ]
    facts = {
        "mesh_frequency": mesh_frequency,
        "orders": list(ORDERS),
        "modes": [vars(row) for row in rows],
    }
    answer = Found(found, figures, told, HEAD, [cells(row) for row in rows], facts)
    finish("modes", ready, target, answer, force, json)


def harris(
    case: str,
    /,
    *torque: str,
    out: Output = None,
    set_: Words = None,
    force: Flag = False,
    json: Flag = False,
) -> None:
    """Find the static transmission error of a case over the torque (Harris map).

    Parameters
    ----------
    case : str
        Built-in case or path of a case file.
    torque : str
        Torques such as "60 N*m" "120 N*m"; by default 20 up to twice that of the case.
    out : Path
        Directory to write; by default that of the case with "-harris".
    set_ : list of str
        Values to change, for example "gears.pinion.modification.tip_relief=10 um".
    force : bool
        Replace an earlier result in that directory.
    json : bool
        Write transmission errors and stiffness over the torque in SI to stdout.
    """
    from tribodyn import plot
    from tribodyn.study.studies.static import harris_map

    ready, target = begun("harris", case, out, set_, force)
    found = harris_map(ready, list(torque) or None)
    columns = {
        "torque": found.torque,
        "mean_transmission_error": found.mean_transmission_error,
        "peak_to_peak_transmission_error": found.peak_to_peak_transmission_error,
        "mean_mesh_stiffness_secant": found.mean_mesh_stiffness_secant,
    }
    rows = [
        [f"{t:.4g}", f"{m * 1e6:.4g}", f"{p * 1e6:.4g}", f"{k * 1e-6:.4g}"]
        for t, m, p, k in zip(*columns.values(), strict=True)
    ]
    head = ["Pinion torque [N*m]", "Mean error [um]", "Peak to peak [um]", "Stiffness [N/um]"]
    figure = found.plot()
    figures = [(plot.harris_map.heading, figure, plot.harris_map.caption_of(found))]
    facts = {name: values.tolist() for name, values in columns.items()}
    answer = Found(found, figures, [f"{figure.layout.title.text}."], head, rows, facts)
    finish("harris", ready, target, answer, force, json)


def relief(
    case: str,
    /,
    *torque: str,
    gears: str = "both",
    out: Output = None,
    set_: Words = None,
    force: Flag = False,
    json: Flag = False,
) -> None:
    """Find the tip relief of a case that leaves least transmission error; write the better case.

    Parameters
    ----------
    case : str
        Built-in case or path of a case file.
    torque : str
        Torques such as "60 N*m" "120 N*m"; by default from half that of the case to all of it.
    gears : str
        Which gears are relieved: both, pinion or wheel.
    out : Path
        Directory to write; by default that of the case with "-relief". It holds best.toml.
    set_ : list of str
        Values to change, for example "stiffness.model=analytic".
    force : bool
        Replace an earlier result in that directory.
    json : bool
        Write amount, length and transmission errors in SI to stdout.
    """
    from tribodyn import plot
    from tribodyn.study.studies.static import optimize_tip_relief

    ready, target = begun("relief", case, out, set_, force)
    found = optimize_tip_relief(ready, list(torque) or None, gears=gears)
    before, after = found.peak_to_peak_before, found.peak_to_peak_after
    rows = [
        [f"{t:.4g}", f"{b * 1e6:.4g}", f"{a * 1e6:.4g}"]
        for t, b, a in zip(found.torque, before, after, strict=True)
    ]
    head = ["Pinion torque [N*m]", "Peak to peak before [um]", "Peak to peak after [um]"]
    told = [
        f"A relief of {found.amount * 1e6:.3g} um over {found.length * 1e3:.4g} mm of roll "
        f"length; best.toml is the case with it."
    ]
    if found.on_edge:
        told.append("It lies at the edge of what was searched: a wider range may hold a better.")
    figures = [(plot.tip_relief_map.heading, found.plot(), plot.tip_relief_map.caption_of(found))]
    facts = {
        "amount": found.amount,
        "length": found.length,
        "torque": found.torque.tolist(),
        "peak_to_peak_before": before.tolist(),
        "peak_to_peak_after": after.tolist(),
        "on_edge": bool(found.on_edge),
    }
    answer = Found(found, figures, told, head, rows, facts, found.case)
    finish("relief", ready, target, answer, force, json)


def run_up(
    case: str,
    between: str,
    /,
    *,
    duration: float = 10.0,
    down: Flag = False,
    out: Output = None,
    set_: Words = None,
    force: Flag = False,
    json: Flag = False,
) -> None:
    """March a case while its speed rises; tell where it vibrates most.

    Parameters
    ----------
    case : str
        Built-in case or path of a case file.
    between : str
        Lowest and highest speed: "400..3500 rpm".
    duration : float
        Length of the rise in seconds.
    down : bool
        Let the speed fall back as it rose.
    out : Path
        Directory to write; by default that of the case with "-run-up".
    set_ : list of str
        Values to change, for example "operation.torque=120 N*m".
    force : bool
        Replace an earlier result in that directory.
    json : bool
        Write levels over the speed in SI to stdout.
    """
    from tribodyn import plot
    from tribodyn.analysis import overall_level
    from tribodyn.cli.bar import progress_bar
    from tribodyn.study.studies.run_up import run_up as compute
    from tribodyn.units import convert

    ready, target = begun("run-up", case, out, set_, force)
    with progress_bar() as progress:
        found = compute(ready, read_ends(between), duration, down=down, progress=progress)
    level = overall_level(found, "contact_force")
    picked = range(0, level.rms.size, max(1, level.rms.size // _ROWS))
    rpm = convert(1.0, "rad/s", "rpm") * level.speed
    rows = [[f"{rpm[k]:.5g}", f"{level.rms[k]:.4g}"] for k in picked]
    figure = found.plot()
    figures = [
        (each.heading, drawn, each.caption_of(found))
        for each, drawn in ((plot.run_up, figure), (plot.run_up_map, plot.run_up_map(found)))
    ]
    facts = {"speed": level.speed.tolist(), "rms_mesh_force": level.rms.tolist()}
    head = ["Speed [rpm]", "Mesh force, rms [N]"]
    answer = Found(found, figures, [f"{figure.layout.title.text}."], head, rows, facts)
    finish("run-up", ready, target, answer, force, json)
