"""``tribodyn ensemble`` and ``sobol``: what tolerances of a case lead to."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from tribodyn.cli.commands.study_commands import answer
from tribodyn.cli.settings import SPREAD, CaseName, Spread
from tribodyn.errors import InputError

if TYPE_CHECKING:
    from tribodyn.progress import Progress
    from tribodyn.report.study_report_data import StudyReportData

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
            what, why = (
                "no value of the case has a tolerance",
                "Shares of a variance need keys with tolerances",
            )
            remedy = 'Give values their tolerances, as in --set "operation.torque=90 N*m +- 5 %"'
            raise InputError(what, case, why, remedy)
        return sobol_report_data(ready, figures, size, seed, progress)

    answer("sobol", case, at, compute)
