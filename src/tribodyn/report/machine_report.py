"""Report of a machine: its picture, flow of power, forces, orders, modes and all figures."""

from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn import plot
from tribodyn.drawing import report_of
from tribodyn.errors import InputError
from tribodyn.gear import Misalignment
from tribodyn.interrupt import single_blas_thread
from tribodyn.machine import machine_modes
from tribodyn.model import Option
from tribodyn.progress import SILENT, Progress
from tribodyn.report.figure_blocks import Block, block_of_figure
from tribodyn.report.html import embedded_figures, plotly_script, template, text_of
from tribodyn.report.numbers import Number, describe
from tribodyn.report.provenance import operating_point, provenance, version
from tribodyn.report.study_report_data import (
    StudyReportData,
    figure_with_caption,
    modes_report_data,
)
from tribodyn.study.case.values import FaultError, read_value
from tribodyn.study.machine.housing_files import HOUSING
from tribodyn.study.machine.modes import (
    MODES_HEAD,
    axial_notes,
    campbell_of,
    mode_rows,
    modes_facts,
)
from tribodyn.study.machine.run import structure_at_rest
from tribodyn.study.machine.tables import OperationTable
from tribodyn.study.pipeline.save import write_file
from tribodyn.study.pipeline.summary_figures import by_topic
from tribodyn.study.pipeline.summary_labels import in_words
from tribodyn.study.studies.needs import PAIRS, kind_of

if TYPE_CHECKING:
    from tribodyn.study.case.case import Case
    from tribodyn.study.machine.case import MachineCase
    from tribodyn.study.machine.result import MachineResult

#: Figures of the report in order.
FIGURES_OF_MACHINES = (
    plot.machine,
    plot.machine_power,
    plot.machine_orders,
    plot.machine_forces,
    plot.machine_modes,
    plot.machine_campbell,
)
#: Figures before the maps of the meshes.
_BEFORE_MAPS = 2
#: Figures on the cards: those of every part with these ends.
_CARDS = (
    "machine.input_power",
    "machine.efficiency",
    ".load_factor",
    "mesh_frequency",
    "dynamic_factor_peak",
    "transmission_error_peak_to_peak",
)
_MOST_CARDS = 12


def number_of_part(key: str, value: float, digits: int = 5) -> Number:
    """A figure of a part, under the heading of the part."""
    return replace(describe(key, value, digits), label=in_words(key.rpartition(".")[2]))


def _cards(summary: dict[str, float]) -> list[Number]:
    keys: dict[tuple[str, Any], str] = {}
    for end in _CARDS:
        for key in summary:
            if key.endswith(end) and not key.startswith("load_cases"):
                # The meshes of all planets have one frequency.
                keys.setdefault((end, summary[key] if end == "mesh_frequency" else key), key)
    cards = []
    for key in list(keys.values())[:_MOST_CARDS]:
        card = number_of_part(key, summary[key], 4)
        cards.append(replace(card, label=in_words(key)) if key.startswith("meshes.") else card)
    return cards


def _blocks(result: MachineResult) -> list[Block]:
    figures = [(figure, result, figure.name, figure.heading) for figure in FIGURES_OF_MACHINES]
    maps = _of_maps(result)
    maps += [
        (
            plot.hypoid_misalignment,
            result.mounting_study(mesh),
            f"mounting-{number}",
            f"Mesh {mesh}: contact with deflected shafts",
        )
        for number, (mesh, errors) in enumerate(result.operation.misalignment.items(), 1)
        if isinstance(errors, Misalignment)
    ]
    places = [*figures[:_BEFORE_MAPS], *_of_stages(result), *maps, *figures[_BEFORE_MAPS:]]
    return [
        block_of_figure(name, heading, figure.sketch(part), figure.caption_of(part))
        for figure, part, name, heading in places
        if not figure.missing(part)
    ]


def _of_stages(result: MachineResult) -> list[tuple[Any, Any, str, str]]:
    """Figures of each planetary stage with what they draw, their names and headings."""
    places: list[tuple[Any, Any, str, str]] = []
    for number, name in enumerate(result.machine.planets):
        stage, end = result.operation.stage(name), f"-{number + 1}" if number else ""
        # As Inalpolat and Kahraman: the sensor feels the planet that passes it.
        sensor = stage.ring_sensor(window=2.0 * np.pi / stage.stage.count)
        for figure, part, place in (
            (plot.planetary_stage, result, "stage"),
            (plot.planetary_forces, stage.motion, "forces"),
            (plot.ring_sensor, sensor, "ring-sensor"),
            (plot.planetary_modes, stage.modes, "mode-shapes"),
        ):
            if not (number and part is result):
                places.append((figure, part, f"{place}{end}", f"{name}: {figure.heading}"))
    return places


def _of_maps(result: MachineResult) -> list[tuple[Any, Any, str, str]]:
    """Maps of the meshes; those of planets with equal teeth once."""
    maps: dict[int, tuple[Any, Any, str, str]] = {}
    for number, (mesh, table) in enumerate(result.operation.tables.items(), 1):
        heading = f"Mesh {mesh}: maps over the face"
        maps.setdefault(id(table), (plot.face_maps, table, f"face-maps-{number}", heading))
    return [*maps.values()]


def machine_content(result: MachineResult) -> dict[str, Any]:
    """Cards, tables, warnings and figures of a machine for the page."""
    summary = result.summary()
    rows = []
    for topic, keys in by_topic(summary).items():
        numbers = [number_of_part(key, summary[key]) for key in keys]
        rows += [[topic, n.label, f"{n.value} {n.unit}".strip(), n.meaning] for n in numbers]
    return {
        "cards": [[card.label, card.value, card.unit] for card in _cards(summary)],
        "sentences": [],
        "warnings": [str(warning) for warning in result.warnings],
        "tables": [
            ["Natural modes", list(MODES_HEAD), mode_rows(result.modes)],
            ["All numbers", ["Part", "Quantity", "Value", "Meaning"], rows],
        ],
        "blocks": _blocks(result),
    }


def render_machine_report(result: MachineResult) -> str:
    """Write the result of a machine as one self-contained HTML page.

    Parameters
    ----------
    result : MachineResult
        What :func:`tribodyn.run` returns for a machine.

    Returns
    -------
    str
        HTML with embedded scripts, styles and data. User texts are escaped.
    """
    summary, blocks = result.summary(), _blocks(result)
    return str(
        template("template.html.j2").render(
            title=result.case.title,
            version=version(),
            operating_point=operating_point(result.case),
            cards=_cards(summary),
            rows=[
                number_of_part(k, summary[k]) for keys in by_topic(summary).values() for k in keys
            ],
            modes=mode_rows(result.modes),
            modes_head=MODES_HEAD,
            modes_text="About the static load, at the speed of the case, with the mean stiffness "
            "of the meshes. For each mode: which parts move, and where its energy is. "
            + " ".join(axial_notes(result.modes)),
            compared=[],
            blocks=blocks,
            warnings=[str(warning) for warning in result.warnings],
            assumptions=result.assumptions,
            citations=result.cite().splitlines(),
            provenance=provenance(None),
            case_text=result.case.with_files(HOUSING).to_toml(),
            figures=embedded_figures(blocks),
            style=text_of("report.css"),
            script=text_of("report.js"),
            plotly_js=plotly_script(),
        )
    )


def any_modes_report_data(
    case: Case | MachineCase, ends: Any, progress: Progress = SILENT
) -> StudyReportData:
    """Natural modes of a pair or a machine; ``ends`` limits the speeds."""
    if kind_of(case) in PAIRS:
        return modes_report_data(case, ends, progress)  # type: ignore[arg-type]
    return machine_modes_report_data(case, ends, progress)  # type: ignore[arg-type]


def machine_modes_report_data(
    case: MachineCase, ends: Any, progress: Progress = SILENT
) -> StudyReportData:
    """Natural modes of a machine and what excites them; ``ends`` limits the speeds."""
    with single_blas_thread():
        structure = structure_at_rest(case, progress)
        progress.start("Natural modes")
        modes = machine_modes(structure)
        campbell = campbell_of(structure, diagram_speeds(ends), modes)
    figures = [
        figure_with_caption(plot.machine_modes, modes),
        figure_with_caption(plot.machine_campbell, campbell),
    ]
    progress.finish()
    statements = [f"{figures[1][1].layout.title.text}.", *axial_notes(modes)]
    facts = modes_facts(modes, campbell)
    rows = mode_rows(modes)
    return StudyReportData(campbell, figures, statements, MODES_HEAD, rows, facts)


def diagram_speeds(ends: Any) -> Any:
    """Speeds of a diagram between two ends, given as text or in rad/s."""
    if ends is None:
        return None
    spec = OperationTable.fields["speed"]
    assert isinstance(spec, Option)
    try:
        first, last = (read_value(spec, "speed", end) for end in ends)
    except FaultError as fault:
        raise InputError(replace(fault.problem, where="operation.speed")) from None
    return np.linspace(max(first, 0.0), last, 8)


@report_of("MachineResult")
def write_machine_report(result: MachineResult, path: str | os.PathLike[str]) -> Path:
    """Write the report of a machine to a file.

    Parameters
    ----------
    result : MachineResult
        What :func:`tribodyn.run` returns for a machine.
    path : path
        File to write; an existing one is replaced.

    Raises
    ------
    InputError
        If the place cannot be written to.
    """
    target = Path(path)
    write_file(target, render_machine_report(result))
    return target
