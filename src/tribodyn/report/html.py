"""HTML report of a result in one self-contained file that needs no network."""

from __future__ import annotations

import os
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tribodyn.drawing import report_of
from tribodyn.errors import collected
from tribodyn.report.figure_blocks import Block, figure_blocks
from tribodyn.report.numbers import (
    MOST_MODES,
    compared_friction,
    headlines,
    modes_of,
    number_tables,
)
from tribodyn.report.provenance import case_text, operating_point, provenance, version
from tribodyn.study.pipeline.save import write_file
from tribodyn.study.rating_summary import factor_tables, main_tables, sentences

if TYPE_CHECKING:
    from tribodyn.study import Result
    from tribodyn.study.machine.result import MachineResult

_FOLDER = Path(__file__).parent


@lru_cache(maxsize=4)
def template(name: str) -> Any:
    """Read a template of this package."""
    from jinja2 import Environment, FileSystemLoader, StrictUndefined

    environment = Environment(
        loader=FileSystemLoader(_FOLDER),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    return environment.get_template(name)


def text_of(name: str) -> Any:
    """Read a file of this package."""
    from markupsafe import Markup

    return Markup((_FOLDER / name).read_text(encoding="utf-8"))


def plotly_script() -> Any:
    """Return the plotly script for embedding."""
    from markupsafe import Markup
    from plotly.offline import get_plotlyjs

    return Markup(get_plotlyjs())


def embedded_figures(blocks: list[Block]) -> Any:
    """Figures of a report as one JavaScript object."""
    from markupsafe import Markup

    entries = [f'"{block.name}": {block.json}' for block in blocks if not block.missing]
    return Markup("{\n" + ",\n".join(entries) + "\n}")


def render_report(result: Result | MachineResult) -> str:
    """Write a result as one self-contained HTML page.

    Parameters
    ----------
    result : Result or MachineResult
        What :func:`tribodyn.run` returns.

    Returns
    -------
    str
        HTML with embedded scripts, styles and data. User texts are escaped.
    """
    case, summary, blocks = result.case, result.summary(), figure_blocks(result)
    return str(
        template("template.html.j2").render(
            title=case.title,
            version=version(),
            operating_point=operating_point(case),
            cards=headlines(summary),
            tables=number_tables(summary),
            modes=modes_of(result),
            most_modes=MOST_MODES,
            compared=compared_friction(summary),
            rating=_rating(result),
            blocks=blocks,
            warnings=_warnings(result),
            assumptions=result.assumptions,
            citations=_lines(result.cite()),
            provenance=provenance(result),
            case_text=case_text(case),
            figures=embedded_figures(blocks),
            style=text_of("report.css"),
            script=text_of("report.js"),
            plotly_js=plotly_script(),
        )
    )


def result_content(result: Result | MachineResult) -> dict[str, Any]:
    """Cards, tables, warnings and figures of a result of any kind for the page."""
    summary, modes = result.summary(), modes_of(result)
    tables = [["Natural modes", list(modes.head), modes.rows]] if modes.rows else []
    for each in number_tables(summary):
        tables.append(["All numbers", *each.cells(), each.title])
    rating = _rating(result) or {}
    for table in (*rating.get("tables", ()), *rating.get("factors", ())):
        rows = [list(row) for row in table.rows]
        tables.append(["Load capacity", [*table.head], rows, table.title])
    return {
        "cards": [[card.label, card.value, card.unit] for card in headlines(summary)],
        "sentences": rating.get("sentences", []),
        "warnings": _warnings(result),
        "tables": tables,
        "blocks": figure_blocks(result),
    }


def _warnings(result: Result | MachineResult) -> list[str]:
    """Warnings of the run and of its rating."""
    with collected():
        rating = result.rating
    return [str(each) for each in (*result.warnings, *(rating.warnings if rating else ()))]


def _rating(result: Result | MachineResult) -> dict[str, Any] | None:
    """Sentences, tables and factors of the load capacity; None without ``[rating]``."""
    with collected():  # the run has raised the warnings of its models
        if (rating := result.rating) is None:
            return None
        factors = [*factor_tables(rating)]
        return {"sentences": sentences(rating), "tables": main_tables(rating), "factors": factors}


def _lines(citations: Any) -> list[str]:
    """Citations as separate lines, from one text or several."""
    return citations.splitlines() if isinstance(citations, str) else [str(c) for c in citations]


@report_of("Result")
@report_of("MachineResult")
def write_report(result: Result | MachineResult, path: str | os.PathLike[str]) -> Path:
    """Write the report of a result to a file.

    The file is written atomically: first to a temporary file, which is then renamed.

    Parameters
    ----------
    result : Result or MachineResult
        What :func:`tribodyn.run` returns.
    path : path
        File to write; an existing one is replaced.

    Raises
    ------
    InputError
        If the place cannot be written to.
    """
    target = Path(path)
    write_file(target, render_report(result))
    return target
