"""HTML reports of sweeps, bifurcation diagrams and other studies in one file."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tribodyn import plot
from tribodyn.aliases import with_old_names
from tribodyn.drawing import report_of
from tribodyn.report.figure_blocks import Block, block_of_figure
from tribodyn.report.html import (
    assumptions_of,
    case_text,
    operating_point,
    plotly_script,
    provenance,
    template,
    text_of,
    version,
)
from tribodyn.study.pipeline.save import write_file
from tribodyn.study.pipeline.summary_figures import figure_of, in_words

if TYPE_CHECKING:
    from tribodyn.analysis import Bifurcation
    from tribodyn.study import Sweep
    from tribodyn.study.machine.case import AnyCase

#: Most rows of the table; the data files contain all rows.
_ROWS = 400


@dataclass(frozen=True)
class _Page:
    """Contents of the report of a study."""

    kind: str  #: of study
    lead: str  #: subtitle: what varies
    varied: Sequence[str]  #: keys of the case that vary
    blocks: Sequence[Block]  #: figures
    cards: Sequence[tuple[str, str]]  #: name and value of each card
    notice_heading: str
    notices: Sequence[str]
    head: Sequence[str]  #: of the table
    rows: Sequence[Sequence[str]]
    more: str = ""  #: note on rows that the table leaves out
    heading: str = ""  #: title of the report, where it is not that of the case


@report_of("Sweep")
@with_old_names
def write_sweep_report(sweep: Sweep, path: str | os.PathLike[str]) -> Path:
    """Write the figures and the table of a sweep to a file.

    Parameters
    ----------
    sweep : Sweep
        Sweep from :func:`tribodyn.sweep`.
    path
        As :func:`write_report` takes it.

    Raises
    ------
    InputError
        If the file cannot be written.
    """
    return _write(Path(path), sweep.case, _sweep_page(sweep))


def _sweep_page(sweep: Sweep) -> _Page:
    """Figures, cards, warnings and table of a sweep."""
    names = sweep.displayed_figures()
    failed = [point for point in sweep.points if point.failed]
    notices = list(dict.fromkeys(point.failed for point in failed))
    if not sweep.complete:
        done = f"{len(sweep.points)} of {sweep.failed.size}"
        notices.insert(0, f"Interrupted: {done} values are done.")
    truncated = len(sweep.points) > _ROWS
    head, rows = _sweep_table(sweep, names)
    return _Page(
        kind="sweep",
        lead=repr(sweep)[6:-1],
        blocks=_sweep_blocks(sweep, names),
        varied=[axis.key for axis in sweep.axes],
        notice_heading="Warnings",
        cards=[("Values", f"{len(sweep.points)}"), ("Failed", f"{len(failed)}")],
        notices=notices,
        head=head,
        rows=rows,
        more=f"The first {_ROWS} values; all of them are in sweep.csv." if truncated else "",
    )


def _sweep_blocks(sweep: Sweep, names: Sequence[str]) -> list[Block]:
    """Figures of a sweep: the levels of all parts of a machine in one, others one by one."""
    if not plot.machine_sweep.missing(sweep):
        figure, text = plot.machine_sweep, plot.machine_sweep.caption_of(sweep)
        return [block_of_figure(figure.name, figure.heading, figure.sketch(sweep), text)]
    caption = plot.sweep.caption_of(sweep)
    return [
        block_of_figure(n, in_words(n), sweep.plot(n), caption if n == names[0] else "")
        for n in names
    ]


def _sweep_table(sweep: Sweep, names: Sequence[str]) -> tuple[list[str], list[list[str]]]:
    """Head and first rows of the table of a sweep: axis values, results and failures."""
    head = [_headed(axis.name, axis.display_unit) for axis in sweep.axes]
    head += [_headed(in_words(name), figure_of(name).display_unit) for name in names]
    rows = []
    for point in sweep.points[:_ROWS]:
        keys = zip(sweep.axes, point.values, strict=True)
        cells = [axis.show(value).partition(" ")[0] for axis, value in keys]
        results = [
            figure_of(n).show(point.figures[n]).partition(" ")[0] if n in point.figures else ""
            for n in names
        ]
        rows.append([*cells, *results, point.failed])
    return [*head, "Failed"], rows


@with_old_names
def write_bifurcation_report(
    diagram: Bifurcation,
    case: AnyCase,
    path: str | os.PathLike[str],
    *,
    lead: str,
    results: Sequence[str],
    head: Sequence[str],
    rows: Sequence[Sequence[str]],
) -> Path:
    """Write a bifurcation diagram of a case to a file.

    Parameters
    ----------
    diagram : Bifurcation
        Diagram from :func:`tribodyn.bifurcation`.
    case : Case
        The case that was varied.
    path
        As :func:`write_report` takes it.
    lead : str
        Subtitle: what varies.
    results : sequence of str
        Results, one sentence each.
    head : sequence of str
        Head of the table.
    rows : sequence of sequence of str
        Its rows.

    Raises
    ------
    InputError
        If the file cannot be written.
    """
    caption = plot.bifurcation.caption_of(diagram)
    page = _Page(
        kind="bifurcation diagram",
        lead=lead,
        varied=[diagram.parameter_name],
        notice_heading="Results",
        blocks=[block_of_figure("bifurcation", "Bifurcation diagram", diagram.plot(), caption)],
        cards=_verdict_cards(diagram),
        notices=list(results),
        head=head,
        rows=rows,
    )
    return _write(Path(path), case, page)


def _verdict_cards(diagram: Bifurcation) -> list[tuple[str, str]]:
    """Cards with the numbers of motions, of each verdict and of motions that ran away."""
    cards = [("Motions", str(int(diagram.finished.sum())))]
    cards += [(verdict.capitalize(), str(count)) for verdict, count in diagram.verdicts().items()]
    if diverged := int(diagram.ran_away.sum()):
        cards.append(("Ran away", str(diverged)))
    return cards


@with_old_names
def write_study_report(
    case: AnyCase | None,
    path: str | os.PathLike[str],
    *,
    kind: str,
    results: Sequence[str],
    figures: Sequence[tuple[str, object, str]],
    head: Sequence[str],
    rows: Sequence[Sequence[str]],
    title: str = "",
    cards: Sequence[tuple[str, str]] = (),
) -> Path:
    """Write the report of any other study to a file.

    Parameters
    ----------
    case : Case, optional
        The case; None for a study of measurements alone.
    path
        As :func:`write_report` takes it.
    kind : str
        Name of the kind of study.
    results : sequence of str
        Results, one sentence each.
    figures : sequence of (str, figure, str)
        Heading, plotly figure and caption of each.
    head, rows : sequence of str, sequence of sequence of str
        The table.
    title : str
        Title of the report; that of the case, or the kind of study, by default.
    cards : sequence of (str, str)
        Headline figures: name and value with its unit.

    Raises
    ------
    InputError
        If the file cannot be written.
    """
    blocks = [
        block_of_figure(f"figure-{number}", heading, sketch, caption)
        for number, (heading, sketch, caption) in enumerate(figures, 1)
    ]
    page = _Page(
        kind=kind,
        lead=results[0],
        varied=[],
        blocks=blocks,
        cards=cards,
        notice_heading="Results",
        notices=list(results),
        head=head,
        rows=rows,
        heading=title,
    )
    return _write(Path(path), case, page)


@report_of("FrictionExperiment")
def write_friction_report(experiment: Any, path: str | os.PathLike[str]) -> Path:
    """Write the claims and figures of a friction experiment to a file."""
    figures = (plot.friction_effect, plot.friction_claims, plot.friction_harmonics)
    blocks = [
        block_of_figure(each.name, each.heading, each(experiment), each.caption_of(experiment))
        for each in figures
        if not each.missing(experiment)
    ]
    failed = dict.fromkeys(point.failed for point in experiment.points if point.failed)
    page = _Page(
        kind="friction experiment",
        lead=experiment.lead,
        varied=["gears.driver", "friction.law", "gears.composite_roughness"],
        blocks=blocks,
        cards=[(claim.case, claim.verdict) for claim in experiment.claims],
        notice_heading="Warnings",
        notices=[*failed],
        head=experiment.CLAIM_HEAD,
        rows=list(experiment.claim_rows()),
        more="The figures of every steady state are in sweep.csv and sweep.nc.",
    )
    return _write(Path(path), experiment.case, page)


@report_of("PaperComparison")
def write_paper_report(comparison: Any, path: str | os.PathLike[str]) -> Path:
    """Write the comparison of computed with printed values to a file."""
    single = len(comparison.papers) == 1
    counts = Counter(row["verdict"] for row in comparison.rows)
    origins = zip(comparison.table(), comparison.rows, strict=True)
    rows = [[*([] if single else [row["case"]]), *cells, row["reason"]] for cells, row in origins]
    head = [*([] if single else ["Case"]), *comparison.HEAD, "Reason"]
    deviations = [
        f"{row['case']}, {row['table']}, {row['row']}: {row['verdict']}, expected: "
        f"{row['expected']}"
        for row in comparison.surprises
    ]
    page = _Page(
        kind="printed and computed",
        lead=f"{', '.join(comparison.papers)}: {comparison.lead}",
        varied=[],
        blocks=[],
        cards=[(name, str(count)) for name, count in counts.most_common()],
        notice_heading="Unexpected results",
        notices=deviations,
        head=head,
        rows=rows,
    )
    return _write(Path(path), None, page)


def _headed(name: str, unit: str) -> str:
    text = name.replace("_", " ")
    return f"{text[:1].upper()}{text[1:]} [{unit}]" if unit else f"{text[:1].upper()}{text[1:]}"


#: Case keys and their names in the operating point.
_CHIPS = {
    "operation.speed": "Speed",
    "operation.torque": "Torque",
    "gears.driver": "Driver",
    "film.model": "Film model",
    "friction.law": "Friction law",
    "stiffness.model": "Stiffness model",
    "dynamics.model": "Structure",
    "gears.composite_roughness": "Composite roughness",
    "lubricant.name": "Oil",
}


def _write(path: Path, case: Any, page: _Page) -> Path:
    from markupsafe import Markup

    varied_chips = {_CHIPS.get(key, "") for key in page.varied}
    figures_json = ",\n".join(f'"{block.name}": {block.json}' for block in page.blocks)
    text = template("study.html.j2").render(
        title=page.heading or (case.title if case else page.kind.capitalize()),
        version=version(),
        operating_point=[
            chip for chip in (operating_point(case) if case else ()) if chip[0] not in varied_chips
        ],
        assumptions=[row for row in assumptions_of(case) if row.key not in page.varied],
        provenance=provenance(None),
        case_text=case_text(case) if case else "",
        figures=Markup("{\n" + figures_json + "\n}"),
        style=text_of("report.css"),
        script=text_of("report.js"),
        plotly_js=plotly_script(),
        **vars(page),
    )
    write_file(path, str(text))
    return path
