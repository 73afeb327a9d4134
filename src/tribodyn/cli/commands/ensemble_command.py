"""``tribodyn ensemble`` and ``sobol``: what tolerances of a case lead to."""

from __future__ import annotations

from typing import Literal

import numpy as np

from tribodyn.cli.commands.study_commands import finish, prepare_study
from tribodyn.cli.settings import CaseName, Flag, Force, Output, Words

#: Share of the variants between the reported ends.
_SHARE = 0.95


def ensemble(
    case: str,
    /,
    *,
    size: int = 64,
    method: Literal["monte-carlo", "latin-hypercube", "sobol"] = "latin-hypercube",
    seed: int = 0,
    out: Output = None,
    set_: Words = None,
    force: Flag = False,
    json: Flag = False,
) -> None:
    """Compute many variants of a case whose inputs are spread, and draw every figure with bands.

    Parameters
    ----------
    case : str
        Case file, or name of a built-in case.
    size : int
        Variants.
    method : str
        How they are drawn: "monte-carlo", "latin-hypercube" or "sobol".
    seed : int
        The same seed gives the same variants.
    out : Path
        Directory to write.
    set_ : list of str
        Changes of the case, such as "operation.torque=150 N*m +- 2 %".
    force : bool
        Replace an earlier directory.
    json : bool
        Write figures in SI as one JSON object to stdout.
    """
    from tribodyn.cli.progress_bar import progress_bar
    from tribodyn.errors import InputError
    from tribodyn.plot import ensemble as spread
    from tribodyn.plot import load_share_statistics, machine_ensemble
    from tribodyn.plot.signals.bands import banded
    from tribodyn.report.figure_blocks import sections_of
    from tribodyn.report.study_report_data import StudyReportData, figure_with_caption
    from tribodyn.study import ensemble as compute
    from tribodyn.study.pipeline.summary_figures import figure_of
    from tribodyn.study.uncertain.machine_ensemble import MachineEnsemble
    from tribodyn.uncertainty import bootstrap_band

    ready, target = prepare_study("ensemble", case, out, set_, force)
    if not ready.uncertain:
        remedy = 'Give a value its spread, as in --set "operation.torque=90 N*m +- 2 %"'
        raise InputError(
            "no value of the case is spread", case, "All variants would be equal", remedy
        )
    with progress_bar() as progress:
        result = compute(ready, size=size, method=method, seed=seed, progress=progress)
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
    statements += [f"{key} = {text}" for key, text in ready.uncertain.items()]
    if isinstance(result, MachineEnsemble):
        parts = (machine_ensemble, load_share_statistics)
        figures = [figure_with_caption(each, result) for each in parts if not each.missing(result)]
    else:
        figures = [figure_with_caption(spread, result), *banded(result, sections_of(ready))]
    share = f"{_SHARE:.0%} of the variants"
    head = ("figure", "middle", f"{share}: from", "to", "mean, 95%: from", "to")
    finish(
        "ensemble",
        ready,
        target,
        StudyReportData(result, figures, statements, head, rows, facts),
        force,
        json,
    )


def sobol(
    case: CaseName,
    /,
    *figures: str,
    size: int = 64,
    seed: int = 0,
    out: Output = None,
    set_: Words = None,
    force: Force = False,
    json: Flag = False,
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
    out : Path
        Directory to write; by default that of the case with "-sobol".
    set_ : list of str
        Tolerances and other changes of the case, such as "operation.torque=150 N*m +- 5 %".
    json : bool
        Write the shares of the variance as one JSON object to stdout.
    """
    from tribodyn.cli.progress_bar import progress_bar
    from tribodyn.errors import InputError
    from tribodyn.report.nonlinear_report_data import sobol_report_data

    ready, target = prepare_study("sobol", case, out, set_, force)
    if not ready.uncertain:
        remedy = 'Give values their tolerances, as in --set "operation.torque=90 N*m +- 5 %"'
        why = "Shares of a variance need keys with tolerances"
        raise InputError("no value of the case has a tolerance", case, why, remedy)
    with progress_bar() as progress:
        answer = sobol_report_data(ready, figures, size, seed, progress)
    finish("sobol", ready, target, answer, force, json)
