"""``tribodyn losses`` and ``tribodyn friction-from-loss``."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

from cyclopts import Parameter

from tribodyn.cli.commands.study_commands import finish, prepare_study
from tribodyn.cli.console import say, say_json, show_warnings, table, tell
from tribodyn.cli.settings import (
    CaseName,
    Flag,
    Force,
    Mesh,
    Output,
    Words,
    changed_case,
    check_place,
    read_changes,
    read_ranges,
)
from tribodyn.errors import InputError, Problem, collected, did_you_mean
from tribodyn.model import Option, number
from tribodyn.nomenclature import GEARS
from tribodyn.study.case.values import FaultError, read_value
from tribodyn.study.studies.needs import mesh_pair, require

if TYPE_CHECKING:
    from tribodyn.losses import FrictionFromLoss, PowerLossTable, RigPowerFlow
    from tribodyn.study.case.case import Case

Text = str | None
_EXAMPLES = {"torque": "50,150,300 N*m", "speed": "400..3500 rpm:8"}


@dataclass(frozen=True)
class _Points:
    """Torques and speeds of a map."""

    torque: Annotated[
        Text,
        Parameter(
            help='"50,150,300 N*m" or "50..300 N*m:6"; by default 8 up to twice that of the case.'
        ),
    ] = None
    speed: Annotated[
        Text,
        Parameter(
            help='"400,1400 rpm" or "400..3500 rpm:8"; by default 8 up to twice that of the case.'
        ),
    ] = None


#: Points at the torque and the speed of the case and about them.
_USUAL = _Points()


def losses(
    case: CaseName,
    /,
    *,
    points: Annotated[_Points, Parameter(name="*")] = _USUAL,
    rig: Text = None,
    mesh: Mesh = None,
    out: Output = None,
    set_: Words = None,
    force: Force = False,
    json: Flag = False,
) -> None:
    """Find losses and efficiency of a case over torque and speed; no motion is computed.

    Parameters
    ----------
    points : _Points
        Torques and speeds.
    rig : str
        Bearings of the slave gearbox of a back-to-back rig, such as "QJ 308": the power flow of the
        rig is drawn too, at the torque and speed of the case and with its gears in both gearboxes.
    out : Path
        Directory to write; by default that of the case with "-losses".
    set_ : list of str
        Values to change, for example "losses.pinion.bearing=NJ 406".
    json : bool
        Write losses and efficiency in SI as one JSON object to stdout.
    """
    from tribodyn import plot
    from tribodyn.cli.progress_bar import progress_bar
    from tribodyn.report.study_report_data import figure_with_caption, losses_report_data

    ready, target = prepare_study("losses", case, out, set_, force)
    slave = _slave(ready, rig)
    values = {name: _values(ready, name, text) for name, text in vars(points).items()}
    with collected() as warnings:
        with progress_bar() as progress:
            answer = losses_report_data(ready, **values, progress=progress, mesh=mesh)
        if slave is not None:
            rig_figure = figure_with_caption(plot.power_flow, _rig(ready, slave, answer.facts))
            statements = [*answer.statements, f"{rig_figure[1].layout.title.text}."]
            answer = answer._replace(figures=[*answer.figures, rig_figure], statements=statements)
    finish("losses", ready, target, answer, force, json)
    show_warnings(warnings)


def _values(case: Case, name: str, text: Text) -> list[float] | None:
    """Return torques or speeds of an option, checked like the key of the case."""
    from tribodyn.study.studies.study_axes import points_of

    if text is None:
        return None
    key, by = f"operation.{name}", f"--{name}"
    values = read_ranges([f"{key}={text}"])[key]
    try:
        return points_of(case, key, values, by=by)
    except InputError as error:
        remedy = f'Write --{name} "{_EXAMPLES[name]}"'
        problems = [replace(p, where=by, remedy=remedy) for p in error.problems]
        raise InputError(problems) from None


def _slave(case: Case, rig: Text) -> Case | None:
    if rig is None:
        return None
    require("losses --rig", case, "--rig")
    bearings = {f"losses.{gear}.bearing": rig for gear in GEARS}
    return case.replace(bearings, by="--rig")


def _rig(case: Case, slave: Case, facts: dict[str, Any]) -> RigPowerFlow:
    """Power flow of the rig; its figures are added to the facts."""
    from tribodyn.study.studies.losses import rig_power_flow

    flow = rig_power_flow(case, slave)
    boxes = zip(flow.gearbox, flow.loss.tolist(), strict=True)
    facts["rig"] = {
        "motor_power": flow.motor_power,
        "circulating_power": flow.circulating_power,
        **{box: dict(zip(flow.part, lost, strict=True)) for box, lost in boxes},
    }
    return flow


_GUARD = "guards against a wrong unit"


def _torque(default: float | None, meaning: str) -> Any:
    format_options = {"unit": "N*m", "display_unit": "N*m", "example": '"0.1 N*m"'}
    return number(default, 0.0, 1e6, _GUARD, meaning=meaning, **format_options)


#: Keys of a measurement that --set accepts.
_KEYS: dict[str, Option] = {
    "gear_loss_factor": number(None, 1e-3, 2.0, "gears lie between 0.05 and 0.5", meaning="H_V"),
    "gear_loss_factor_uncertainty": number(0.0, 0.0, 1.0, _GUARD, meaning="of H_V"),
    "gear_sets": number(1.0, 1.0, 2.0, "test gears alone, or equal slave gears too", meaning="k"),
    "no_load_torque": _torque(5.0, "rows up to it are without load"),
    "other_loss": _torque(0.0, "what bearings and seals lose more under load"),
    "torque_loss_uncertainty": _torque(None, "of one reading"),
    "torque_uncertainty": _torque(0.0, "of the torque"),
    "other_loss_uncertainty": _torque(0.0, "of other_loss"),
}


def friction_from_loss(
    file: str,
    /,
    *,
    case: Text = None,
    mesh: Mesh = None,
    set_: Words = None,
    out: Output = None,
    force: Force = False,
    json: Flag = False,
) -> None:
    """Find friction coefficients from the torque losses of a rig, each with its uncertainty.

    Parameters
    ----------
    file : str
        CSV file with columns speed [rpm], torque [N*m], torque_loss [N*m] and perhaps other_loss
        [N*m], repeats as rows of their own; or "fzg-wheel-driven", a printed table.
    case : str
        Case with the gears that were tested: their gear loss factor is taken.
    set_ : list of str
        Further data: gear_loss_factor, gear_sets (2: equal slave gears), no_load_torque,
        other_loss, and the standard uncertainties torque_loss_uncertainty, torque_uncertainty,
        other_loss_uncertainty and gear_loss_factor_uncertainty, as in "no_load_torque=5 N*m".
    out : Path
        Directory to write; by default called like the file, with "-friction".
    json : bool
        Write the coefficients in SI as one JSON object to stdout.
    """
    from tribodyn import plot
    from tribodyn.losses import friction_from_power_loss
    from tribodyn.report import write_study_report
    from tribodyn.report.study_report_data import figure_with_caption
    from tribodyn.study.pipeline.save import new_directory
    from tribodyn.validated_files import csv_text, write_dataset

    target = out if out is not None else Path(f"{Path(file).stem}-friction")
    check_place(target, force)
    with collected() as warnings:
        loss_table = _measured(file, case, mesh, _options(set_ or []))
        friction = friction_from_power_loss(loss_table)
    head, rows = _friction_rows(friction)
    figure = figure_with_caption(plot.friction_from_loss, friction)
    statements = [
        f"{figure[1].layout.title.text}.",
        f"H_V = {loss_table.gear_loss_factor:.5g}. Source: {loss_table.source}.",
        *(warning.message for warning in warnings),
    ]
    with new_directory(target, force=force) as place:
        write_dataset(friction.to_xarray(), place / "study.nc")
        (place / "friction.csv").write_text(csv_text([head, *rows]), encoding="utf-8")
        write_study_report(
            None,
            place / "report.html",
            kind="friction from losses",
            results=statements,
            figures=[figure],
            head=head,
            rows=rows,
        )
    if json:
        say_json(_friction_facts(friction, loss_table))
    else:
        say("\n".join([*statements[:2], table([head, *rows])]))
    show_warnings(warnings)
    tell(f"Report: {target / 'report.html'}")


def _options(settings: Sequence[str]) -> dict[str, Any]:
    """Return the checked values of --set."""
    options: dict[str, Any] = {}
    problems = []
    for key, value in read_changes(settings).items():
        if key not in _KEYS:
            remedy = did_you_mean(key, _KEYS, "Take one of these")
            why = f"Keys: {', '.join(_KEYS)}"
            problems.append(Problem(f'unknown key "{key}"', "--set", why, remedy))
            continue
        try:
            options[key] = float(read_value(_KEYS[key], key, value))
        except FaultError as fault:
            problems.append(replace(fault.problem, where="--set"))
    if problems:
        raise InputError(problems)
    return options


def _measured(file: str, case: Text, mesh: Text, options: dict[str, Any]) -> PowerLossTable:
    """Return the table of the file, or the built-in table with this name."""
    from tribodyn.losses import gear_loss_factor, power_loss_table, read_power_loss_table
    from tribodyn.losses.loss_table import TABLES

    factor = options.pop("gear_loss_factor", None)
    if factor is not None and case is not None:
        what = f"gear_loss_factor = {factor:g} and --case {case} are both given"
        raise InputError(what, "--set", "The gears of the case have their own", "Keep one of them")
    if case is not None:
        ready = changed_case(case, [], "friction-from-loss")
        factor = gear_loss_factor(mesh_pair("friction-from-loss", ready, mesh).pair.gear_pair)
    if file in TABLES and not Path(file).exists():
        changes: dict[str, Any] = {} if factor is None else {"gear_loss_factor": factor}
        return replace(power_loss_table(file), **changes, **options)
    if factor is None:
        why = "Friction is the loss over the torque and the gear loss factor H_V"
        remedy = 'Name the gears with --case, or write --set "gear_loss_factor=0.30"'
        raise InputError("the gear loss factor is missing", "", why, remedy)
    return read_power_loss_table(file, factor, **options)


_COLUMNS = (
    "speed",
    "torque",
    "friction_coefficient",
    "standard_uncertainty",
    "monte_carlo_uncertainty",
    "degrees_of_freedom",
    "low",
    "high",
    "sensitivity",
)


def _friction_facts(friction: FrictionFromLoss, loss_table: PowerLossTable) -> dict[str, Any]:
    """Return columns in SI; infinite degrees of freedom, which JSON cannot express, are null."""
    columns = {name: getattr(friction, name).tolist() for name in _COLUMNS}
    freedom = columns["degrees_of_freedom"]
    columns["degrees_of_freedom"] = [None if math.isinf(value) else value for value in freedom]
    facts = {"gear_loss_factor": loss_table.gear_loss_factor, "source": loss_table.source}
    return {**facts, **columns, "verdict": list(friction.verdict)}


def _friction_rows(friction: FrictionFromLoss) -> tuple[list[str], list[list[str]]]:
    from tribodyn.units import convert

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
