"""Report data of the studies of a case: data set, figures, sentences and table."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from tribodyn import plot
from tribodyn.drawing import finite
from tribodyn.errors import InputError
from tribodyn.model import Option, number
from tribodyn.progress import SILENT, Progress
from tribodyn.report.study import write_bifurcation_report, write_study_report
from tribodyn.study.pipeline.save import new_directory
from tribodyn.study.studies.needs import mesh_pair
from tribodyn.types import Tree
from tribodyn.units import convert

if TYPE_CHECKING:
    from tribodyn.drawing import Drawing
    from tribodyn.losses import FrictionFromLoss, GearboxLosses, PowerLossTable
    from tribodyn.nonlinear.bifurcation import Bifurcation
    from tribodyn.study.case.pair import PairCase
    from tribodyn.study.machine.case import AnyCase
    from tribodyn.study.studies.bifurcation import Findings
    from tribodyn.study.studies.levels import MachineLevels

#: Rows of the table of a run-up.
_ROWS = 40
_ALONE = "Tooth losses only; add [losses] to the case for bearings, seals and oil."

#: Root mean square of the force without its mean: the name, and its deprecated name.
_ALTERNATING = ("alternating_rms_mesh_force", "rms_mesh_force")
#: Heading, figure and caption.
Picture = tuple[str, Any, str]


class StudyReportData(NamedTuple):
    """Results of a study for its report: data, figures, sentences and a table."""

    data: Any  #: result whose data set is stored
    figures: Sequence[Picture]
    statements: Sequence[str]  #: results in sentences
    head: Sequence[str]
    rows: Sequence[Sequence[str]]
    facts: Tree  #: in SI
    best: AnyCase | None = None  #: resulting case, such as the optimum
    table_file: str = ""  #: name of a file of the table


def figure_with_caption(figure: Drawing, result: object) -> Picture:
    """Heading, figure and caption of a study result."""
    return figure.heading, figure(result), figure.caption_of(result)


def facts_of(result: object, names: str) -> Tree:
    """Fields of a result for JSON, by their names in one text."""
    values = {name: getattr(result, name) for name in names.split()}
    return {n: finite(v.tolist() if hasattr(v, "tolist") else v) for n, v in values.items()}


def _title(picture: Picture) -> str:
    return str(picture[1].layout.title.text)


def save_study(
    kind: str, case: AnyCase | None, target: Path, report: StudyReportData, force: bool = False
) -> None:
    """Write case, data set and report of a study to a directory."""
    from tribodyn.validated_files import csv_text, write_dataset

    with new_directory(target, force=force) as place:
        if case is not None:
            (place / "case.toml").write_text(case.to_toml(), encoding="utf-8")
        if report.table_file:
            table = csv_text([report.head, *report.rows])
            (place / report.table_file).write_text(table, encoding="utf-8")
        if report.best is not None:
            (place / "best.toml").write_text(report.best.to_toml(), encoding="utf-8")
        write_dataset(report.data.to_xarray(), place / "study.nc")
        write_study_report(
            case,
            place / "report.html",
            kind=kind,
            results=report.statements,
            figures=report.figures,
            head=report.head,
            rows=report.rows,
        )


def save_bifurcation(
    diagram: Bifurcation, case: PairCase, findings: Findings, target: Path, force: bool = False
) -> None:
    """Write case, data set and report of a bifurcation diagram to a directory."""
    from tribodyn.validated_files import write_dataset

    head, rows = findings.rows()
    with new_directory(target, force=force) as place:
        (place / "case.toml").write_text(case.to_toml(), encoding="utf-8")
        write_dataset(diagram.to_xarray(), place / "bifurcation.nc")
        write_bifurcation_report(
            diagram,
            case,
            place / "bifurcation.html",
            lead=findings.lead(),
            results=findings.sentences(),
            head=head,
            rows=rows,
        )


def harris_report_data(
    case: AnyCase, torque: Sequence[object] | None, mesh: str | None = None
) -> StudyReportData:
    """Static transmission error over the torque."""
    from tribodyn.study.studies.static import harris_map

    study = harris_map(case, torque, mesh=mesh)
    facts = facts_of(
        study,
        "torque mean_transmission_error peak_to_peak_transmission_error mean_mesh_stiffness_secant",
    )
    rows = [
        [f"{t:.4g}", f"{m * 1e6:.4g}", f"{p * 1e6:.4g}", f"{k * 1e-6:.4g}"]
        for t, m, p, k in zip(*facts.values(), strict=True)
    ]
    head = ["Pinion torque [N*m]", "Mean error [um]", "Peak to peak [um]", "Stiffness [N/um]"]
    figure = figure_with_caption(plot.harris_map, study)
    return StudyReportData(study, [figure], [f"{_title(figure)}."], head, rows, facts)


def relief_report_data(
    case: AnyCase, torque: Sequence[object] | None, gears: str, mesh: str | None = None
) -> StudyReportData:
    """Tip relief with the least transmission error, and the case with it."""
    from tribodyn.study.studies.static import optimize_tip_relief

    optimum = optimize_tip_relief(case, torque, gears=gears, mesh=mesh)
    facts = facts_of(optimum, "torque peak_to_peak_before peak_to_peak_after amount length on_edge")
    rows = [
        [f"{t:.4g}", f"{b * 1e6:.4g}", f"{a * 1e6:.4g}"]
        for t, b, a in zip(*list(facts.values())[:3], strict=True)
    ]
    head = ["Pinion torque [N*m]", "Peak to peak before [um]", "Peak to peak after [um]"]
    statements = [
        f"A relief of {optimum.amount * 1e6:.4g} um over {optimum.length * 1e3:.4g} mm of roll "
        f"length; best.toml is the case with it."
    ]
    if optimum.on_edge:
        statements.append(
            "It is at the edge of the search range: a wider range may contain a better relief."
        )
    figures = [figure_with_caption(plot.tip_relief_map, optimum)]
    return StudyReportData(optimum, figures, statements, head, rows, facts, optimum.case)


def lead_report_data(
    case: AnyCase, torque: Sequence[Any] | None, progress: Progress, **values: Any
) -> StudyReportData:
    """Crowning and lead slope that spread the load most evenly, and the case with them."""
    from tribodyn.study.studies.static import optimize_lead

    optimum = optimize_lead(case, torque, progress=progress, **values)
    columns = facts_of(optimum, "torque face_load_factor_before face_load_factor_after")
    rows = [[f"{value:.4g}" for value in row] for row in zip(*columns.values(), strict=True)]
    head = ["Pinion torque [N*m]", "Face load factor before", "Face load factor after"]
    statements = [
        f"A crowning of {optimum.crowning * 1e6:.4g} um and a lead slope of "
        f"{optimum.lead_slope * 1e6:.4g} um on the {optimum.gear}; best.toml is the case with them."
    ]
    figures = [figure_with_caption(plot.lead_optimum, optimum)]
    facts = facts_of(optimum, "crowning lead_slope") | columns
    return StudyReportData(optimum, figures, statements, head, rows, facts, optimum.case)


def run_up_report_data(
    case: AnyCase, ends: Any, duration: float, down: bool = False, progress: Progress = SILENT
) -> StudyReportData:
    """Vibration levels over the speed of a run-up."""
    from tribodyn.analysis import overall_level
    from tribodyn.study.studies.levels import MachineLevels
    from tribodyn.study.studies.run_up import run_up

    run = run_up(case, ends, duration, down=down, progress=progress)
    if isinstance(run, MachineLevels):
        return _levels_report_data(run)
    level = overall_level(run, "contact_force")
    picked = range(0, level.rms.size, max(1, level.rms.size // _ROWS))
    rpm = convert(1.0, "rad/s", "rpm") * level.speed
    rows = [[f"{rpm[k]:.5g}", f"{level.rms[k]:.4g}"] for k in picked]
    figures = [figure_with_caption(plot.run_up, run), figure_with_caption(plot.run_up_map, run)]
    facts = {"speed": level.speed.tolist()} | dict.fromkeys(_ALTERNATING, level.rms.tolist())
    head = ["Speed [rpm]", "Mesh force, rms [N]"]
    return StudyReportData(run, figures, [f"{_title(figures[0])}."], head, rows, facts)


def _levels_report_data(run: MachineLevels) -> StudyReportData:
    """Levels of a machine over the speed, and the harmonics of meshes behind them."""
    rpm = convert(1.0, "rad/s", "rpm") * run.speed
    figures = [
        figure_with_caption(each, run) for each in (plot.machine_levels, plot.machine_level_lines)
    ]
    head = ["Speed [rpm]", *(f"Mesh force of {name}, rms [N]" for name in run.mesh)]
    head += [f"Housing at {name}, rms [m/s^2]" for name in run.node]
    columns = np.hstack((run.mesh_force, run.acceleration))
    rows = [
        [f"{rpm[k]:.5g}", *(f"{value:.4g}" for value in columns[k])]
        for k in range(0, rpm.size, max(1, rpm.size // _ROWS))
    ]
    met = [
        f"{each.mesh} x {each.harmonic} meets mode {each.mode} ({each.frequency:.5g} Hz) at "
        f"{convert(each.speed, 'rad/s', 'rpm'):.5g} rpm"
        for each in run.resonances
    ]
    statements = [f"{_title(picture)}." for picture in figures]
    statements += [f"{'; '.join(met)}."] if met else []
    forces = dict(zip(run.mesh, run.mesh_force.T.tolist(), strict=True))
    facts = {
        "speed": run.speed.tolist(),
        **dict.fromkeys(_ALTERNATING, forces),
        "rms_radial_force": dict(zip(run.bearing, run.bearing_force.T.tolist(), strict=True)),
        "rms_acceleration": dict(zip(run.node, run.acceleration.T.tolist(), strict=True)),
        "resonances": [each._asdict() for each in run.resonances],
    }
    return StudyReportData(run, figures, statements, head, rows, facts)


def losses_report_data(
    case: AnyCase,
    torque: object = None,
    speed: object = None,
    progress: Progress = SILENT,
    mesh: str | None = None,
) -> StudyReportData:
    """Losses and efficiency over torque and speed."""
    from tribodyn.losses.gearbox import PARTS
    from tribodyn.study.studies.losses import loss_map

    gearbox = loss_map(case, torque=torque, speed=speed, mesh=mesh, progress=progress)
    figure = figure_with_caption(plot.losses, gearbox)
    counted = [label for part, label in PARTS.items() if getattr(gearbox, part).any()]
    scope = _ALONE if counted == ["teeth"] else f"Included losses: {', '.join(counted)}."
    names = f"pinion_torque pinion_speed {' '.join(PARTS)} total gear_efficiency efficiency"
    statements, facts = [f"{_title(figure)}.", scope], facts_of(gearbox, names)
    return StudyReportData(gearbox, [figure], statements, *_losses(gearbox), facts)


def _losses(gearbox: GearboxLosses) -> tuple[list[str], list[list[str]]]:
    """Table of the efficiency over torque and speed, or of all losses for a single row."""
    from tribodyn.losses.gearbox import PARTS

    torque, speed = gearbox.pinion_torque, gearbox.pinion_speed * convert(1.0, "rad/s", "rpm")
    percent = 100.0 * gearbox.efficiency
    if torque.size > 1 and speed.size > 1:
        head = ["Efficiency [%]: torque of the pinion", *(f"{n:.4g} rpm" for n in speed)]
        rows = [
            [f"{load:.4g} N*m", *(f"{value:.5g}" for value in line)]
            for load, line in zip(torque, percent, strict=True)
        ]
        return head, rows
    parts = {label: getattr(gearbox, part) for part, label in PARTS.items()}
    parts = {label: power for label, power in parts.items() if power.any()} | {"all": gearbox.total}
    head = ["Torque [N*m]", "Speed [rpm]", *(f"{label} [W]" for label in parts), "Efficiency [%]"]
    rows = [
        [
            f"{torque[i]:.4g}",
            f"{speed[j]:.4g}",
            *(f"{power[i, j]:.4g}" for power in parts.values()),
            f"{percent[i, j]:.5g}",
        ]
        for i in range(torque.size)
        for j in range(speed.size)
    ]
    return head, rows


def film_report_data(
    case: AnyCase,
    torque: object = None,
    speed: object = None,
    progress: Progress = SILENT,
    mesh: str | None = None,
) -> StudyReportData:
    """Minimum film and lubrication regime over torque and speed."""
    from tribodyn.study.studies.losses import STEPS
    from tribodyn.study.studies.static import film_over_operation

    case = mesh_pair("film", case, mesh).pair
    operation = case.operation
    torque = list(STEPS * operation.torque) if torque is None else torque
    speed = list(STEPS * operation.speed) if speed is None else speed
    films = film_over_operation(case, torque=torque, speed=speed, progress=progress)
    drawings = (plot.film_over_operation, plot.lubrication_map)
    figures = [figure_with_caption(each, films) for each in drawings if not each.missing(films)]
    thickness = films.central_film if films.minimum_film is None else films.minimum_film
    least = np.nanmin(np.asarray(thickness), axis=2)
    rpm = films.pinion_speed * convert(1.0, "rad/s", "rpm")
    head = ["Least film [um]: torque of the pinion", *(f"{n:.4g} rpm" for n in rpm)]
    rows = [
        [f"{load:.4g} N*m", *(f"{film * 1e6:.4g}" for film in line)]
        for load, line in zip(films.pinion_torque, least, strict=True)
    ]
    facts = {**facts_of(films, "pinion_torque pinion_speed"), "least_film": least.tolist()}
    return StudyReportData(films, figures, [f"{_title(figures[0])}."], head, rows, facts)


_GUARD = "guards against a wrong unit"


def _torque(default: float | None, meaning: str) -> Any:
    format_options = {"unit": "N*m", "display_unit": "N*m", "example": '"0.1 N*m"'}
    return number(default, 0.0, 1e6, _GUARD, meaning=meaning, **format_options)


#: Data of a measurement in addition to its table.
MEASUREMENT: dict[str, Option] = {
    "gear_loss_factor": number(None, 1e-3, 2.0, "gears lie between 0.05 and 0.5", meaning="H_V"),
    "gear_loss_factor_uncertainty": number(0.0, 0.0, 1.0, _GUARD, meaning="of H_V"),
    "gear_sets": number(1.0, 1.0, 2.0, "test gears alone, or equal slave gears too", meaning="k"),
    "no_load_torque": _torque(5.0, "rows up to it are without load"),
    "other_loss": _torque(0.0, "what bearings and seals lose more under load"),
    "torque_loss_uncertainty": _torque(None, "of one reading"),
    "torque_uncertainty": _torque(0.0, "of the torque"),
    "other_loss_uncertainty": _torque(0.0, "of other_loss"),
}


def measured_losses(
    file: str, case: AnyCase | None, mesh: str | None, options: Mapping[str, float]
) -> PowerLossTable:
    """Read a table of losses, or the built-in one of this name; a case gives the loss factor."""
    from tribodyn.losses import gear_loss_factor, power_loss_table, read_power_loss_table
    from tribodyn.losses.loss_table import TABLES

    more: Tree = dict(options)
    factor = more.pop("gear_loss_factor", None)
    if case is not None:
        factor = gear_loss_factor(mesh_pair("friction-from-loss", case, mesh).pair.gear_pair)
    if file in TABLES and not Path(file).exists():
        changes: Tree = {} if factor is None else {"gear_loss_factor": factor}
        return replace(power_loss_table(file), **changes, **more)
    if factor is None:
        why = "Friction is the loss over the torque and the gear loss factor H_V"
        remedy = 'Name the gears with --case, or write --set "gear_loss_factor=0.30"'
        raise InputError("the gear loss factor is missing", "", why, remedy)
    return read_power_loss_table(file, factor, **more)


def friction_report_data(losses: PowerLossTable, friction: FrictionFromLoss) -> StudyReportData:
    """Friction coefficients of all points with their uncertainty."""
    head, rows = _friction_rows(friction)
    figure = figure_with_caption(plot.friction_from_loss, friction)
    statements = [
        f"{figure[1].layout.title.text}.",
        f"H_V = {losses.gear_loss_factor:.5g}. Source: {losses.source}.",
    ]
    names = "speed torque friction_coefficient standard_uncertainty monte_carlo_uncertainty "
    names += "degrees_of_freedom low high sensitivity verdict"
    facts = facts_of(losses, "gear_loss_factor source") | facts_of(friction, names)
    file = "friction.csv"
    return StudyReportData(friction, [figure], statements, head, rows, facts, table_file=file)


def _friction_rows(friction: FrictionFromLoss) -> tuple[list[str], list[list[str]]]:
    head = [
        "speed [rpm]",
        "torque [N*m]",
        "mu",
        "u(mu)",
        "u(mu) drawn",
        "low 95 %",
        "high 95 %",
        "mu per 0.1 N*m",
        "verdict",
    ]
    columns = (
        friction.speed * convert(1.0, "rad/s", "rpm"),
        friction.torque,
        friction.friction_coefficient,
        friction.standard_uncertainty,
        friction.monte_carlo_uncertainty,
        friction.low,
        friction.high,
        0.1 * friction.sensitivity,
    )
    rows = [[f"{value:.4g}" for value in row] for row in zip(*columns, strict=True)]
    return head, [[*row, verdict] for row, verdict in zip(rows, friction.verdict, strict=True)]
