"""A sweep or a bifurcation diagram as one HTML file that needs nothing else."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tribodyn import plot
from tribodyn.drawing import report_of
from tribodyn.report.blocks import Block, drawn_block
from tribodyn.report.html import plotly_script, template, text_of
from tribodyn.report.origin import operating_point, provenance, version
from tribodyn.study.case.provenance import assumptions
from tribodyn.study.pipeline.save import write_file
from tribodyn.study.pipeline.summary import SUMMARY
from tribodyn.study.pipeline.words import in_words

if TYPE_CHECKING:
    from tribodyn.analysis import Bifurcation
    from tribodyn.study import Case, Sweep

#: Rows of the table; more are in the files beside it.
_ROWS = 400


@dataclass(frozen=True)
class _Page:
    """What a study puts into its report."""

    kind: str  #: of study
    lead: str  #: what varies, in a line
    varied: Sequence[str]  #: keys of the case that vary
    blocks: Sequence[Block]  #: figures
    cards: Sequence[tuple[str, str]]  #: counts, each with its word
    notice_heading: str
    notices: Sequence[str]
    head: Sequence[str]  #: of the table
    rows: Sequence[Sequence[str]]
    more: str = ""  #: where rows are that the table leaves out
    heading: str = ""  #: title of the report, where it is not that of the case


@report_of("Sweep")
def write_sweep_report(found: Sweep, path: str | os.PathLike[str]) -> Path:
    """Write the figures and the table of a sweep to a file.

    Parameters
    ----------
    found : Sweep
        What :func:`tribodyn.sweep` returns.
    path
        As :func:`write_report` takes it.

    Raises
    ------
    InputError
        If the place cannot be written to.
    """
    names = found.shown()
    caption = plot.sweep.caption_of(found)
    blocks = [
        drawn_block(name, in_words(name), found.plot(name), caption if name == names[0] else "")
        for name in names
    ]
    head = [_headed(axis.name, axis.display_unit) for axis in found.axes]
    head += [_headed(in_words(name), SUMMARY[name].display_unit) for name in names]
    rows = []
    for point in found.points[:_ROWS]:
        keys = zip(found.axes, point.values, strict=True)
        cells = [axis.show(value).partition(" ")[0] for axis, value in keys]
        shown = [
            SUMMARY[n].show(point.figures[n]).partition(" ")[0] if n in point.figures else ""
            for n in names
        ]
        rows.append([*cells, *shown, point.failed])
    failed = [point for point in found.points if point.failed]
    lacking = "" if found.complete else f"Interrupted: {len(found.points)} of {found.failed.size}"
    page = _Page(
        kind="sweep",
        lead=repr(found)[6:-1],
        blocks=blocks,
        varied=[axis.key for axis in found.axes],
        notice_heading="Take care",
        cards=[("Values", f"{len(found.points)}"), ("Failed", f"{len(failed)}")],
        notices=[
            *([f"{lacking} values are done."] if lacking else []),
            *dict.fromkeys(point.failed for point in failed),
        ],
        head=[*head, "Failed"],
        rows=rows,
        more=f"The first {_ROWS} values; all of them are in sweep.csv."
        if len(found.points) > _ROWS
        else "",
    )
    return _write(Path(path), found.case, page)


def write_bifurcation_report(
    found: Bifurcation,
    case: Case,
    path: str | os.PathLike[str],
    *,
    lead: str,
    told: Sequence[str],
    head: Sequence[str],
    rows: Sequence[Sequence[str]],
) -> Path:
    """Write a bifurcation diagram of a case to a file.

    Parameters
    ----------
    found : Bifurcation
        What :func:`tribodyn.bifurcation` returns.
    case : Case
        The case that was varied.
    path
        As :func:`write_report` takes it.
    lead : str
        What varies, in a line.
    told : sequence of str
        What was found, in sentences.
    head : sequence of str
        Head of the table.
    rows : sequence of sequence of str
        Its rows.

    Raises
    ------
    InputError
        If the place cannot be written to.
    """
    caption = plot.bifurcation.caption_of(found)
    counts = [(word.capitalize(), str(count)) for word, count in found.verdicts().items()]
    if lost := int(found.ran_away.sum()):
        counts.append(("Ran away", str(lost)))
    page = _Page(
        kind="bifurcation diagram",
        lead=lead,
        varied=[found.parameter_name],
        notice_heading="What it says",
        blocks=[drawn_block("bifurcation", "Motion once per mesh cycle", found.plot(), caption)],
        cards=[("Motions", str(int(found.finished.sum()))), *counts],
        notices=list(told),
        head=head,
        rows=rows,
    )
    return _write(Path(path), case, page)


def write_study_report(
    case: Case | None,
    path: str | os.PathLike[str],
    *,
    kind: str,
    told: Sequence[str],
    figures: Sequence[tuple[str, Any, str]],
    head: Sequence[str],
    rows: Sequence[Sequence[str]],
    title: str = "",
    cards: Sequence[tuple[str, str]] = (),
) -> Path:
    """Write any other study of a case to a file.

    Parameters
    ----------
    case : Case or None
        The case that was studied; None for a study of measurements alone.
    path
        As :func:`write_report` takes it.
    kind : str
        What kind of study it is.
    told : sequence of str
        What was found, in sentences.
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
        If the place cannot be written to.
    """
    blocks = [
        drawn_block(f"figure-{number}", heading, drawn, caption)
        for number, (heading, drawn, caption) in enumerate(figures, 1)
    ]
    page = _Page(
        kind=kind,
        lead=told[0],
        varied=[],
        blocks=blocks,
        cards=cards,
        notice_heading="What it says",
        notices=list(told),
        head=head,
        rows=rows,
        heading=title,
    )
    return _write(Path(path), case, page)


@report_of("FrictionExperiment")
def write_friction_report(found: Any, path: str | os.PathLike[str]) -> Path:
    """Write the claims and figures of a friction experiment to a file."""
    figures = (plot.friction_effect, plot.friction_claims, plot.friction_harmonics)
    blocks = [
        drawn_block(each.name, each.heading, each(found), each.caption_of(found))
        for each in figures
        if not each.missing(found)
    ]
    failed = dict.fromkeys(point.failed for point in found.points if point.failed)
    page = _Page(
        kind="friction experiment",
        lead=found.lead,
        varied=["gears.driver", "friction.law", "gears.composite_roughness"],
        blocks=blocks,
        cards=[(claim.case, claim.verdict) for claim in found.claims],
        notice_heading="Take care",
        notices=[*failed],
        head=found.CLAIM_HEAD,
        rows=list(found.claim_rows()),
        more="The figures of every steady state are in sweep.csv and sweep.nc.",
    )
    return _write(Path(path), found.case, page)


@report_of("PaperComparison")
def write_paper_report(found: Any, path: str | os.PathLike[str]) -> Path:
    """Write printed tables beside what is computed to a file."""
    one = len(found.papers) == 1
    counts = Counter(row["verdict"] for row in found.rows)
    origins = zip(found.table(), found.rows, strict=True)
    rows = [[*([] if one else [row["case"]]), *cells, row["reason"]] for cells, row in origins]
    head = [*([] if one else ["Case"]), *found.HEAD, "Reason"]
    odd = [
        f"{row['case']}, {row['table']}, {row['row']}: {row['verdict']}, expected was "
        f"{row['expected']}"
        for row in found.surprises
    ]
    page = _Page(
        kind="printed and computed",
        lead=f"{', '.join(found.papers)}: {found.lead}",
        varied=[],
        blocks=[],
        cards=[(name, str(count)) for name, count in counts.most_common()],
        notice_heading="Not as expected",
        notices=odd,
        head=head,
        rows=rows,
    )
    return _write(Path(path), None, page)


def _headed(words: str, unit: str) -> str:
    text = words.replace("_", " ")
    return f"{text[:1].upper()}{text[1:]} [{unit}]" if unit else f"{text[:1].upper()}{text[1:]}"


#: Keys of the case -> what the operating point calls them.
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

    gone = {_CHIPS.get(key, "") for key in page.varied}
    drawn = ",\n".join(f'"{block.name}": {block.json}' for block in page.blocks)
    text = template("study.html.j2").render(
        title=page.heading or (case.title if case else page.kind.capitalize()),
        version=version(),
        operating_point=[
            chip for chip in (operating_point(case) if case else ()) if chip[0] not in gone
        ],
        assumptions=[
            row for row in (assumptions(case) if case else ()) if row.key not in page.varied
        ],
        provenance=provenance(None),
        case_text=case.to_toml() if case else "",
        figures=Markup("{\n" + drawn + "\n}"),
        style=text_of("report.css"),
        script=text_of("report.js"),
        plotly_js=plotly_script(),
        **vars(page),
    )
    write_file(path, str(text))
    return path
