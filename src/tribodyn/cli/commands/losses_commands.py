"""``tribodyn losses`` and ``tribodyn friction-from-loss``."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from cyclopts import Parameter

from tribodyn.cli.commands.study_commands import finish
from tribodyn.cli.settings import (
    MEASURED,
    USUAL,
    CaseName,
    Measured,
    Mesh,
    Place,
    changed_case,
    read_changes,
    read_ranges,
)
from tribodyn.errors import InputError, Problem, collected, did_you_mean
from tribodyn.nomenclature import GEARS
from tribodyn.study.case.values import FaultError, read_value
from tribodyn.study.studies.needs import require

if TYPE_CHECKING:
    from tribodyn.losses import RigPowerFlow
    from tribodyn.study.case.pair import PairCase

Text = str | None
_EXAMPLES = {"torque": "50,150,300 N*m", "speed": "400..3500 rpm:8"}


@Parameter(name="*")
@dataclass(frozen=True)
class Points:
    """Torques and speeds of a map.

    Parameters
    ----------
    torque : str
        "50,150,300 N*m" or "50..300 N*m:6"; by default 8 up to twice that of the case.
    speed : str
        "400,1400 rpm" or "400..3500 rpm:8"; by default 8 up to twice that of the case.
    """

    torque: Text = None
    speed: Text = None


#: Points at the torque and the speed of the case and about them.
_ABOUT = Points()


def losses(
    case: CaseName,
    /,
    *,
    points: Points = _ABOUT,
    rig: Text = None,
    mesh: Mesh = None,
    at: Place = USUAL,
) -> None:
    """Find losses and efficiency of a case over torque and speed; no motion is computed.

    Parameters
    ----------
    points : Points
        Torques and speeds.
    rig : str
        Bearings of the slave gearbox of a back-to-back rig, such as "QJ 308": the power flow of the
        rig is drawn too, at the torque and speed of the case and with its gears in both gearboxes.
    """
    from tribodyn import plot
    from tribodyn.cli.progress_bar import progress_bar
    from tribodyn.report.study_report_data import figure_with_caption, losses_report_data

    ready, target = at.case("losses", case)
    slave = _slave(ready, rig)
    values = {name: _values(ready, name, text) for name, text in vars(points).items()}
    with collected() as warnings:
        with progress_bar() as progress:
            answer = losses_report_data(ready, **values, progress=progress, mesh=mesh)
        if slave is not None:
            rig_figure = figure_with_caption(plot.power_flow, _rig(ready, slave, answer.facts))
            statements = [*answer.statements, f"{rig_figure[1].layout.title.text}."]
            answer = answer._replace(figures=[*answer.figures, rig_figure], statements=statements)
    finish("losses", ready, target, answer, at, warnings)


def _values(case: PairCase, name: str, text: Text) -> list[float] | None:
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


def _slave(case: PairCase, rig: Text) -> PairCase | None:
    if rig is None:
        return None
    require("losses --rig", case, "--rig")
    bearings = {f"losses.{gear}.bearing": rig for gear in GEARS}
    return case.replace(bearings, by="--rig")


def _rig(case: PairCase, slave: PairCase, facts: dict[str, Any]) -> RigPowerFlow:
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


def friction_from_loss(
    file: str, /, *, case: Text = None, mesh: Mesh = None, at: Measured = MEASURED
) -> None:
    """Find friction coefficients from the torque losses of a rig, each with its uncertainty.

    Parameters
    ----------
    file : str
        CSV file with columns speed [rpm], torque [N*m], torque_loss [N*m] and perhaps other_loss
        [N*m], repeats as rows of their own; or "fzg-wheel-driven", a printed table.
    case : str
        Case with the gears that were tested: their gear loss factor is taken.
    """
    from tribodyn.losses import friction_from_power_loss
    from tribodyn.report.study_report_data import friction_report_data, measured_losses

    target = at.reserved(file, "friction")
    with collected() as warnings:
        options = _options(at.set_ or [])
        if "gear_loss_factor" in options and case is not None:
            factor, why = options["gear_loss_factor"], "The gears of the case have their own"
            what = f"gear_loss_factor = {factor:g} and --case {case} are both given"
            raise InputError(what, "--set", why, "Keep one of them")
        gears = None if case is None else changed_case(case, [], "friction-from-loss")
        losses = measured_losses(file, gears, mesh, options)
        answer = friction_report_data(losses, friction_from_power_loss(losses))
    finish("friction from losses", None, target, answer, at, warnings)


def _options(settings: Sequence[str]) -> dict[str, float]:
    """Return the checked values of --set."""
    from tribodyn.report.study_report_data import MEASUREMENT

    options: dict[str, float] = {}
    problems = []
    for key, value in read_changes(settings).items():
        if key not in MEASUREMENT:
            remedy = did_you_mean(key, MEASUREMENT, "Take one of these")
            why = f"Keys: {', '.join(MEASUREMENT)}"
            problems.append(Problem(f'unknown key "{key}"', "--set", why, remedy))
            continue
        try:
            options[key] = float(read_value(MEASUREMENT[key], key, value))
        except FaultError as fault:
            problems.append(replace(fault.problem, where="--set"))
    if problems:
        raise InputError(problems)
    return options
