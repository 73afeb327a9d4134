"""Studies of one case: modes, optima, run-up, losses, rating."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Annotated, Any

from cyclopts import Parameter

from tribodyn.cli.console import say, say_json, show_warnings, table, tell
from tribodyn.cli.settings import (
    BEST,
    MEASURED,
    USUAL,
    Best,
    CaseName,
    Flag,
    Measured,
    Mesh,
    Place,
    Settings,
    changed_any_case,
    changed_case,
    read_changes,
    read_ends,
    read_ranges,
)
from tribodyn.errors import InputError, ModelWarning, Problem, collected, did_you_mean
from tribodyn.nomenclature import GEARS
from tribodyn.study.case.values import FaultError, read_value
from tribodyn.study.rating_summary import RatingTable, factor_tables, main_tables, sentences
from tribodyn.study.studies.needs import require
from tribodyn.types import Tree

if TYPE_CHECKING:
    from pathlib import Path

    from tribodyn.losses import RigPowerFlow
    from tribodyn.progress import Progress
    from tribodyn.report.study_report_data import StudyReportData
    from tribodyn.study.case.pair import PairCase
    from tribodyn.study.machine.case import AnyCase


def answer(
    kind: str, case: str, at: Place, compute: Callable[[Any, Progress], StudyReportData]
) -> StudyReportData:
    """Compute a study of a case with its changes, write its directory and print its results."""
    from tribodyn.cli.progress_bar import progress_bar

    ready, target = at.case(kind, case)
    with progress_bar() as progress:
        results = compute(ready, progress)
    finish(kind, ready, target, results, at)
    return results


def finish(
    kind: str,
    case: AnyCase | None,
    target: Path,
    results: StudyReportData,
    at: Place,
    warnings: Sequence[ModelWarning] = (),
) -> None:
    """Write the directory of a study and print its results, with warnings that it raised."""
    from tribodyn.report.study_report_data import save_study

    messages = [warning.message for warning in warnings]
    report = results._replace(statements=[*results.statements, *messages])
    save_study(kind, case, target, report, at.force)
    if at.json:
        say_json(results.facts)
    else:
        heading = [] if case is None else [case.title]
        say("\n".join([*heading, *results.statements, table([results.head, *results.rows])]))
    show_warnings(warnings)
    tell(f"Report: {target / 'report.html'}")


def modes(case: CaseName, /, between: str | None = None, *, at: Place = USUAL) -> None:
    """Find natural frequencies and critical speeds of a case; no motion is computed.

    Parameters
    ----------
    between : str
        Speeds of the Campbell diagram: "400..3500 rpm".
    """
    from tribodyn.report.nonlinear_report_data import any_modes_report_data

    ends = None if between is None else read_ends(between)
    answer("modes", case, at, lambda ready, to: any_modes_report_data(ready, ends, to))


def _stripped(texts: Sequence[str]) -> list[str] | None:
    """Torques of the command line without spaces around them; none by default."""
    return [text.strip() for text in texts] or None


def harris(case: CaseName, /, *torque: str, mesh: Mesh = None, at: Place = USUAL) -> None:
    """Find the static transmission error of a case over the torque (Harris map).

    Parameters
    ----------
    torque : str
        Torques such as "60 N*m" "120 N*m"; by default 20 up to twice that of the case.
    """
    from tribodyn.report.study_report_data import harris_report_data

    torques = _stripped(torque)
    answer("harris", case, at, lambda ready, _: harris_report_data(ready, torques, mesh))


def relief(
    case: CaseName, /, *torque: str, gears: str = "both", mesh: Mesh = None, at: Best = BEST
) -> None:
    """Find the tip relief of a case that leaves least transmission error; write the better case.

    Parameters
    ----------
    torque : str
        Torques such as "60 N*m" "120 N*m"; by default from half that of the case to all of it.
    gears : str
        Which gears are relieved: both, or the name of one.
    """
    from tribodyn.report.study_report_data import relief_report_data

    torques = _stripped(torque)
    answer("relief", case, at, lambda ready, _: relief_report_data(ready, torques, gears, mesh))


def lead(
    case: CaseName, /, *torque: str, gear: str = "pinion", mesh: Mesh = None, at: Best = BEST
) -> None:
    """Find the crowning and lead slope that spread the load most evenly; write the better case.

    Parameters
    ----------
    torque : str
        Torques such as "60 N*m" "120 N*m"; by default that of the case.
    gear : str
        Which gear is modified: pinion or wheel.
    """
    from tribodyn.report.study_report_data import lead_report_data

    def compute(ready: Any, progress: Progress) -> StudyReportData:
        return lead_report_data(ready, _stripped(torque), progress, gear=gear, mesh=mesh)

    answer("lead", case, at, compute)


def run_up(
    case: CaseName,
    between: str,
    /,
    *,
    duration: float = 10.0,
    down: Flag = False,
    at: Place = USUAL,
) -> None:
    """Integrate a case in time while its speed rises; report where it vibrates most.

    Parameters
    ----------
    between : str
        Lowest and highest speed: "400..3500 rpm".
    duration : float
        Length of the rise in seconds.
    down : bool
        Let the speed fall back as it rose.
    """
    from tribodyn.report.study_report_data import run_up_report_data

    ends = read_ends(between)
    answer("run-up", case, at, lambda on, to: run_up_report_data(on, ends, duration, down, to))


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


def _rig(case: PairCase, slave: PairCase, facts: Tree) -> RigPowerFlow:
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


def rate(
    case: CaseName,
    /,
    *,
    set_: Settings = None,
    all_: Annotated[bool, Parameter(name="--all", negative="")] = False,
    json: Flag = False,
    variants: int = 0,
    seed: int = 0,
) -> None:
    """Rate gears, bearings and shafts of a case: ISO 6336, ISO 281, ISO/TS 16281, DIN 743.

    Parameters
    ----------
    all_ : bool
        Print every factor with its value, source and the branch taken.
    json : bool
        Write safeties and factors in SI as one JSON object to stdout.
    variants : int
        Print the probability of failure over so many variants of the tolerances of the case.
    seed : int
        The same seed gives the same variants.
    """
    from tribodyn.cases.load import run as compute
    from tribodyn.cli.progress_bar import progress_bar

    ready = changed_any_case(case, set_ or [])
    if not ready.is_rated:
        remedy = 'Add [rating] with required_life = "20000 h", and strengths in [materials.NAME]'
        raise InputError("the case has no table [rating]", case, "", remedy)
    if variants:
        _probabilities(ready, variants, seed, json=json)
        return
    with progress_bar() as progress, warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)
        rating = compute(ready, progress).rating
        progress.finish()
    if rating is None:
        why = "Cylindrical gears with computed teeth, bearings and shafts are rated"
        remedy = "Give bearings dynamic_load_rating or shafts notches, or remove [rating]"
        raise InputError("nothing of the case can be rated", case, why, remedy)
    if json:
        say_json(rating.to_dict())
        return
    conditions = rating.ratings[0].standard.conditions if rating.ratings else None
    say(f"{ready.title}{f': ISO 6336:{conditions.edition}' if conditions else ''}")
    for each in main_tables(rating):
        _say(each)
    for line in sentences(rating):
        say(line)
    for each in factor_tables(rating) if all_ else ():
        _say(each)
    show_warnings(rating.warnings)


def _probabilities(ready: Any, variants: int, seed: int, *, json: bool) -> None:
    """Print the probability that each safety or life is too small."""
    from tribodyn.cli.progress_bar import progress_bar
    from tribodyn.study.pipeline.summary_figures import figure_of, in_words
    from tribodyn.study.uncertain.failure_probability import failure_probability

    with progress_bar() as progress, warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)
        result = failure_probability(ready, size=variants, seed=seed, progress=progress)
    columns = result.required, result.sample.mean(axis=0), result.share, result.probability
    names = "required", "mean", "share_below", "probability"
    table_of = {
        str(key): dict(zip(names, map(float, row), strict=True))
        for key, *row in zip(result.figure, *columns, strict=True)
    }
    if json:
        say_json(table_of)
        return
    rows: list[tuple[str, ...]] = [
        ("figure", "required", "mean", "share below", "probability of failure")
    ]
    for key, each in table_of.items():
        values = (figure_of(key).show(each[name]) for name in names[:2])
        # the tail of a fitted distribution says no more than that it is rare
        rare = "below 1e-6 %" if 0.0 < each["probability"] < 1e-8 else ""
        shares = (f"{100.0 * each[name]:.3g} %" for name in names[2:])
        share, probability = shares
        rows.append((in_words(key), *values, share, rare or probability))
    say(table(rows))


def _say(each: RatingTable) -> None:
    """Print a table under its title."""
    say(f"\n{each.title}")
    say(table([each.head, *each.rows]))
