"""``tribodyn sweep``, ``ensemble``, ``sobol`` and ``study``."""

from __future__ import annotations

import logging
from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, TypeVar

import numpy as np

from tribodyn.cli.commands.study_commands import answer
from tribodyn.cli.console import say, say_json, show_resumed, table, tell
from tribodyn.cli.progress_bar import progress_bar
from tribodyn.cli.settings import (
    SPREAD,
    USUAL,
    CaseName,
    Flag,
    Output,
    Place,
    Spread,
    changed_any_case,
    read_ranges,
)
from tribodyn.errors import InputError, quiet
from tribodyn.progress import left

if TYPE_CHECKING:
    from tribodyn.progress import Progress
    from tribodyn.report.study_report_data import StudyReportData
    from tribodyn.study.studies.sweep_result import Sweep
    from tribodyn.variants import StudyState

#: A sweep, or another study with ``points``, ``complete`` and ``save``.
StudyType = TypeVar("StudyType", bound=Any)


#: Exit code of a sweep that was stopped by Ctrl-C; finished values are saved.
INTERRUPTED = 130


def sweep(case: CaseName, /, *over: str, show: str = "", at: Place = USUAL) -> int:
    """Compute a case at many values of its keys; write a table and a report.

    Parameters
    ----------
    over : str
        What varies: "operation.speed=400..3500 rpm:60" or "operation.torque=50,150,300 N*m".
        Several make a grid.
    show : str
        Figures of the table on the screen, such as "minimum_film_ratio,efficiency".
    """
    ranges = read_ranges(over)
    ready = changed_any_case(case, at.set_ or [])
    names = _summary_names(show)

    def compute(**checkpointing: Any) -> Sweep:
        from tribodyn.study.studies.sweep import sweep as over_keys

        return over_keys(ready, ranges, partial=True, by="sweep", **checkpointing)

    target = at.reserved(case, "sweep")
    result = run_checkpointed(target, at.force, compute)
    _show(result, result.displayed_figures(names), at.json)
    failed = sum(bool(point.failed) for point in result.points)
    if failed:
        tell(
            f"{failed} of {len(result.points)} values failed; the column failed states the reason."
        )
    return report_exit_code(result, target)


def run_checkpointed(target: Path, force: bool, compute: Callable[..., StudyType]) -> StudyType:
    """Compute a study with checkpoints of its finished parts, and save what is done."""
    from tribodyn.checkpoints import Checkpoints
    from tribodyn.cli.progress_bar import progress_bar

    with Checkpoints(target, force) as checkpoints:
        with progress_bar() as progress:
            study = compute(progress=progress, checkpoints=checkpoints)
        show_resumed(checkpoints)
        if not study.complete:
            tell(
                f"interrupted: {len(study.points)} of {study.size} values are done and "
                "being written; the same command with --force continues from there; "
                "Ctrl-C again stops at once"
            )
        with progress_bar() as progress:
            progress.start("Report")
            study.save(target, force=force)
            progress.finish()
        checkpoints.close_after(study.complete)
    return study


def report_exit_code(study: Sweep, target: Path) -> int:
    """Print the location of the report and return the exit code of the study."""
    tell(f"Report: {target / 'report.html'}")
    if not study.complete:
        return INTERRUPTED
    return 1 if all(point.failed for point in study.points) else 0


def _summary_names(show: str) -> list[str]:
    """Return the requested summary figures; refuse unknown ones before anything is computed."""
    from tribodyn.errors import InputError, did_you_mean
    from tribodyn.study.pipeline.summary_figures import SUMMARY, is_figure

    names = [name.strip() for name in show.split(",") if name.strip()]
    for name in names:
        if not is_figure(name):
            remedy = did_you_mean(name, SUMMARY, "See: tribodyn check and run")
            raise InputError(f'there is no figure "{name}"', "--show", "", remedy)
    return names


def _show(result: Sweep, names: Sequence[str], as_json: bool) -> None:
    from tribodyn.study.pipeline.summary_figures import figure_of

    if as_json:
        units = {axis.key: axis.unit for axis in result.axes}
        say_json({"keys": units, "complete": result.complete, "rows": list(result.rows())})
        return
    rows: list[list[str]] = [[*(axis.name for axis in result.axes), *names, ""]]
    for point in result.points:
        keys: list[Any] = [a.show(v) for a, v in zip(result.axes, point.values, strict=True)]
        figures = [
            figure_of(n).show(point.figures[n]) if n in point.figures else "-" for n in names
        ]
        rows.append([*keys, *figures, f"failed: {point.failed}" if point.failed else ""])
    say(f"{result.case.title}\n{table(rows)}")


#: Share of the variants between the reported ends.
_SHARE = 0.95


def ensemble(
    case: CaseName,
    /,
    *,
    size: int = 64,
    method: Literal["monte-carlo", "latin-hypercube", "sobol"] = "latin-hypercube",
    seed: int = 0,
    at: Spread = SPREAD,
) -> None:
    """Compute many variants of a case whose inputs are spread, and draw every figure with bands.

    Parameters
    ----------
    size : int
        Variants.
    method : str
        How they are drawn: "monte-carlo", "latin-hypercube" or "sobol".
    seed : int
        The same seed gives the same variants.
    """

    def compute(ready: Any, progress: Progress) -> StudyReportData:
        from tribodyn.study import ensemble as compute_variants

        if not ready.uncertain:
            what, why = "no value of the case is spread", "All variants would be equal"
            remedy = 'Give a value its spread, as in --set "operation.torque=90 N*m +- 2 %"'
            raise InputError(what, case, why, remedy)
        variants = compute_variants(ready, size=size, method=method, seed=seed, progress=progress)
        return _report_data(ready, variants, seed)

    answer("ensemble", case, at, compute)


def _report_data(case: Any, result: Any, seed: int) -> StudyReportData:
    """Figures of all variants with their ends, and drawings of them."""
    from tribodyn import plot
    from tribodyn.plot.signals.bands import banded
    from tribodyn.report.figure_blocks import sections_of
    from tribodyn.report.study_report_data import StudyReportData, figure_with_caption
    from tribodyn.study.pipeline.summary_figures import figure_of
    from tribodyn.uncertainty import bootstrap_band

    rows, facts = [], {}
    for name, values in result.figures().items():
        middle, variants = values[0], values[1:]
        band = bootstrap_band(variants, seed=seed)
        low, high = np.quantile(variants, (0.5 - 0.5 * _SHARE, 0.5 + 0.5 * _SHARE))
        ends = (middle, low, high, float(band.low), float(band.high))
        names = ("middle", "low", "high", "mean_low", "mean_high")
        facts[name] = dict(zip(names, map(float, ends), strict=True))
        if high > low:
            rows.append([name, *(figure_of(name).show(float(end)) for end in ends)])
    statements = [f"{len(result.value)} variants over {', '.join(map(str, result.input))}"]
    statements += [f"{key} = {text}" for key, text in case.uncertain.items()]
    drawings = (plot.ensemble, plot.machine_ensemble, plot.load_share_statistics)
    figures = [figure_with_caption(each, result) for each in drawings if not each.missing(result)]
    figures += banded(result, sections_of(case)) if case.lumped else []
    share = f"{_SHARE:.0%} of the variants"
    head = ("figure", "middle", f"{share}: from", "to", "mean, 95%: from", "to")
    return StudyReportData(result, figures, statements, head, rows, facts)


def sobol(
    case: CaseName, /, *figures: str, size: int = 64, seed: int = 0, at: Spread = SPREAD
) -> None:
    """Find which tolerance of a case the spread of its figures comes from (Sobol indices).

    Parameters
    ----------
    figures : str
        Figures of the summary such as peak_mesh_force; by default those that a sweep shows.
    size : int
        Size of the Sobol sequence, a power of two: the case is computed this many times the number
        of its tolerances and two more.
    seed : int
        The same seed gives the same shares.
    """

    def compute(ready: Any, progress: Progress) -> StudyReportData:
        from tribodyn.report.nonlinear_report_data import sobol_report_data

        if not ready.uncertain:
            what = "no value of the case has a tolerance"
            why = "Shares of a variance need keys with tolerances"
            remedy = 'Give values their tolerances, as in --set "operation.torque=90 N*m +- 5 %"'
            raise InputError(what, case, why, remedy)
        return sobol_report_data(ready, figures, size, seed, progress)

    answer("sobol", case, at, compute)


def study(
    study: str,
    /,
    *,
    out: Output = None,
    scheduler: str = "",
    status: Flag = False,
    force: Flag = False,
    json: Flag = False,
) -> int:
    """Compute the members of a study file into a store; the same command continues it.

    Parameters
    ----------
    study : str
        Path of a study file; with --status that of a store will do.
    out : Path
        Store to write; by default that of the file with "-study".
    scheduler : str
        Address of a Dask scheduler whose workers compute, such as "tcp://127.0.0.1:8786"; by
        default this machine does.
    status : bool
        Report the progress of the study, which may run elsewhere, and compute nothing.
    force : bool
        Replace another study in that place.
    json : bool
        Write the progress as one JSON object to stdout.
    """
    from tribodyn.variants import run_study, study_state

    place = out if out is not None else Path(f"{Path(study).stem}-study")
    if status:
        state = study_state(study if out is None and Path(study).is_dir() else place)
        _show_state(state, json)
        return 0
    if scheduler:
        _silence_dask()
    try:
        with quiet("leftover"), progress_bar() as progress:
            state = run_study(study, place, scheduler=scheduler, force=force, progress=progress)
    except KeyboardInterrupt:
        tell("interrupted: finished chunks are stored; the same command continues from there")
        _show_state(study_state(place), json)
        return INTERRUPTED
    _show_state(state, json)
    for name in state.damaged:
        tell(f"Chunk {name} was damaged or missing and was computed again.")
    for name, why in state.missing.items():
        tell(f"Chunk {name} could not be computed; the same command tries again. {why}")
    tell(f"Store: {place}")
    return 1 if state.missing or state.failed == state.members else 0


def _silence_dask() -> None:
    """Keep the log of Dask off the screen; our own messages report what matters."""
    with suppress(ImportError):
        import distributed  # noqa: F401  # which sets levels of its own when it is imported
    for name in list(logging.root.manager.loggerDict):
        if name.startswith("distributed"):
            logging.getLogger(name).setLevel(logging.CRITICAL)


def _show_state(state: StudyState, as_json: bool) -> None:
    if as_json:
        say_json({**asdict(state), "complete": state.complete})
        return
    share = 100.0 * state.done / max(state.members, 1)
    say(f"{state.title}\n  {state.done} of {state.members} members are done ({share:.3g} %)")
    if state.failed:
        say(f"  {state.failed} of them failed:")
        for reason, count in state.reasons.items():
            say(f"  {count:>8}  {reason}")
    if not state.complete:
        running = ["It is being computed", *filter(None, [left(state.seconds_left)])]
        say(
            f"  {', '.join(running) if state.running else 'No process of this machine computes it'}"
        )
