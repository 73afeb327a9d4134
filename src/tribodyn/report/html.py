"""Report of a result as HTML, with its operating point, software versions and date."""

from __future__ import annotations

import os
import platform
import sys
from collections.abc import Sequence
from datetime import UTC, datetime
from functools import lru_cache
from importlib.metadata import version as installed
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tribodyn.drawing import report_of
from tribodyn.errors import collected
from tribodyn.plot.theme.labels import display_unit, displayed, engineering
from tribodyn.report.figure_blocks import Block, figure_blocks
from tribodyn.report.numbers import (
    MOST_MODES,
    compared_friction,
    headlines,
    modes_of,
    number_tables,
)
from tribodyn.study.case.provenance import Assumption, assumptions
from tribodyn.study.machine.housing_files import HOUSING
from tribodyn.study.pipeline.save import write_file
from tribodyn.study.rating_summary import factor_tables, main_tables, sentences
from tribodyn.study.studies.needs import PAIRS, kind_of
from tribodyn.types import Tree

if TYPE_CHECKING:
    from tribodyn.study import Result
    from tribodyn.study.planetary.machine_stages import CaseStage

#: Packages whose version may change a figure.
_PACKAGES = ("numpy", "scipy", "numba")


def version() -> str:
    """Version of the package."""
    import tribodyn

    return tribodyn.__version__


def _with_unit(name: str, value: float) -> str:
    return " ".join(engineering(float(displayed(name, value)), display_unit(name))).rstrip()


def operating_point(case: Any) -> list[tuple[str, str]]:
    """Speed, load, surfaces, oil and models of a case as formatted (name, value) pairs."""
    if kind_of(case) not in PAIRS:
        start, end = case.ends
        return [
            ("Speed", _with_unit("speed", case.operating_point.speed)),
            ("Torque", _with_unit("torque", case.operating_point.torque)),
            ("Input", start),
            ("Output", end),
            ("Meshes", ", ".join(case.meshes)),
            *(row for stage in case.stages.values() for row in _of_stage(stage)),
        ]
    gears, operation = case.gears, case.operation
    stiffness, film = case.contact_models
    point = [
        ("Teeth", " : ".join(str(gear.teeth) for gear in gears.by_name.values())),
        ("Speed", f"{_with_unit('speed', operation.speed)} ({operation.speed_of})"),
        ("Torque", f"{_with_unit('torque', operation.torque)} ({operation.speed_of})"),
        ("Driver", gears.driver),
        ("Film model", film),
        ("Friction law", case.friction.law),
        ("Stiffness model", stiffness),
        ("Structure", case.dynamics.model),
        ("Method", case.solver.method),
    ]
    if case.composite_roughness is not None:
        roughness = _with_unit("composite_roughness", case.composite_roughness)
        point.insert(4, ("Composite roughness", roughness))
    if case.lubricant is not None and case.lubricant.name:
        point.insert(4, ("Oil", case.lubricant.name))
    return point


def _of_stage(stage: CaseStage) -> list[tuple[str, str]]:
    teeth = [stage.gears[stage.table.sun], *stage.planets, stage.gears[stage.table.ring]]
    return [
        (f"Planets of {stage.name}", str(stage.table.count)),
        (f"Teeth of {stage.name}", ", ".join(str(abs(gear.teeth)) for gear in teeth)),
    ]


def case_text(case: Any) -> str:
    """The case file, with the files of a housing called as in a directory of results."""
    named = case if kind_of(case) in PAIRS else case.with_files(HOUSING)
    return str(named.to_toml())


def assumptions_of(case: Any) -> Sequence[Assumption]:
    """What a case of any kind assumes; nothing without a case."""
    if case is None:
        return ()
    stated: Sequence[Assumption] = assumptions(case) if kind_of(case) in PAIRS else case.assumptions
    return stated


def provenance(result: object) -> list[tuple[str, str]]:
    """Software versions and date of a report as (name, value) pairs."""
    from tribodyn.study.pipeline.stored_motion import describe_stored_cycles

    packages = ", ".join(f"{name} {installed(name)}" for name in _PACKAGES)
    return [
        ("Software", f"tribodyn {version()}"),
        ("Built on", f"Python {platform.python_version()}, {packages}"),
        *(
            [("Motion in response.nc", describe_stored_cycles(result.response))]
            if hasattr(result, "response")
            else []
        ),
        ("Report written", f"{datetime.now(UTC):%Y-%m-%d %H:%M} UTC"),
    ]


_FOLDER = Path(__file__).parent


@lru_cache(maxsize=4)
def template(name: str) -> Any:
    """Read a template of this package."""
    from jinja2 import Environment, FileSystemBytecodeCache, FileSystemLoader, StrictUndefined

    folder = _FOLDER / "__pycache__"
    cacheable = not sys.dont_write_bytecode and os.access(folder, os.W_OK)
    environment = Environment(
        loader=FileSystemLoader(_FOLDER),
        bytecode_cache=FileSystemBytecodeCache(str(folder)) if cacheable else None,
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


def render_report(result: Result) -> str:
    """Write a result as one self-contained HTML page.

    Parameters
    ----------
    result : Result
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


def result_content(result: Result) -> Tree:
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


def _warnings(result: Result) -> list[str]:
    """Warnings of the run and of its rating."""
    with collected():
        rating = result.rating
    return [str(each) for each in (*result.warnings, *(rating.warnings if rating else ()))]


def _rating(result: Result) -> Tree | None:
    """Sentences, tables and factors of the load capacity; None without ``[rating]``."""
    with collected():  # the run has raised the warnings of its models
        if (rating := result.rating) is None:
            return None
        factors = [*factor_tables(rating)]
        return {"sentences": sentences(rating), "tables": main_tables(rating), "factors": factors}


def _lines(citations: Any) -> list[str]:
    """Citations as separate lines, from one text or several."""
    return citations.splitlines() if isinstance(citations, str) else [str(c) for c in citations]


@report_of("ResultOfCase")
def write_report(result: Result, path: str | os.PathLike[str]) -> Path:
    """Write the report of a result to a file.

    The file is written atomically: first to a temporary file, which is then renamed.

    Parameters
    ----------
    result : Result
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
