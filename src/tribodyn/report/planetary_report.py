"""Report of a planetary stage: its picture, forces, modes, what excites them, and all figures."""

from __future__ import annotations

import math
import os
from pathlib import Path
from typing import TYPE_CHECKING, Any

from tribodyn import plot
from tribodyn.drawing import report_of
from tribodyn.report.figure_blocks import Block, block_of_figure
from tribodyn.report.html import embedded_figures, plotly_script, template, text_of
from tribodyn.report.machine_report import number_of_part
from tribodyn.report.numbers import describe
from tribodyn.report.provenance import operating_point, provenance, version
from tribodyn.report.study_report_data import StudyReportData, figure_with_caption
from tribodyn.study.pipeline.save import write_file
from tribodyn.study.pipeline.summary_figures import by_topic
from tribodyn.study.planetary.stage_modes import MODES_HEAD, StageModes, stage_modes

if TYPE_CHECKING:
    from tribodyn.progress import Progress
    from tribodyn.study.planetary.case import PlanetaryCase
    from tribodyn.study.planetary.result import PlanetaryResult
    from tribodyn.types import Array

_CARDS = (
    "machine.input_power",
    "machine.efficiency",
    "planets.{0}.ratio",
    "planets.{0}.load_factor",
    "planets.{0}.dynamic_load_factor",
    "meshes.sun.mesh_frequency",
    "meshes.sun.dynamic_factor_peak",
    "meshes.ring.dynamic_factor_peak",
)


def _modes_text(stage: StageModes) -> str:
    return (
        "About the static load, with the mean stiffness of the meshes. By the phases of the "
        "planets each harmonic of the mesh frequency excites modes of certain types: R rotational "
        "(central members turn), T translational, P of the planets alone. Harmonic "
        f"{stage.excitation_text()}. {stage.frame_effect()}"
    )


def _blocks(result: PlanetaryResult) -> list[Block]:
    # As Inalpolat and Kahraman: the sensor feels the planet that passes it.
    sensor = result.operation.ring_sensor(window=2.0 * math.pi / result.case.table.count)
    parts = [
        (plot.planetary_stage, result, "stage", plot.planetary_stage.heading),
        (plot.planetary_forces, result.motion, "forces", plot.planetary_forces.heading),
        (plot.ring_sensor, sensor, "ring-sensor", plot.ring_sensor.heading),
        (plot.planetary_modes, result.modes, "mode-shapes", plot.planetary_modes.heading),
        (plot.machine_campbell, result.campbell, "campbell", plot.machine_campbell.heading),
        *(
            (plot.face_maps, table, f"face-maps-{mesh}", f"Mesh {mesh}: maps over the face")
            for mesh, table in result.operation.tables.items()
        ),
    ]
    return [
        block_of_figure(name, heading, figure.sketch(part), figure.caption_of(part))
        for figure, part, name, heading in parts
        if not figure.missing(part)
    ]


def planetary_content(result: PlanetaryResult) -> dict[str, Any]:
    """Cards, tables, warnings and figures of a stage for the page."""
    summary = result.summary()
    stage = result.operation.stage_modes
    cards = [describe(key.format(result.case.name), summary[key.format(result.case.name)], 4)
             for key in _CARDS]  # fmt: skip
    numbers = [
        (topic, number_of_part(key, summary[key]))
        for topic, keys in by_topic(summary).items()
        for key in keys
    ]
    rows = [[topic, n.label, f"{n.value} {n.unit}".strip(), n.meaning] for topic, n in numbers]
    return {
        "cards": [[card.label, card.value, card.unit] for card in cards],
        "sentences": [stage.frame_effect()],
        "warnings": [str(warning) for warning in result.warnings],
        "tables": [
            ["Natural modes", list(MODES_HEAD), stage.rows()],
            ["All numbers", ["Part", "Quantity", "Value", "Meaning"], rows],
        ],
        "blocks": _blocks(result),
    }


def render_planetary_report(result: PlanetaryResult) -> str:
    """Write the result of a planetary stage as one self-contained HTML page.

    Parameters
    ----------
    result : PlanetaryResult
        What :func:`tribodyn.run` returns for a planetary stage.

    Returns
    -------
    str
        HTML with embedded scripts, styles and data. User texts are escaped.
    """
    summary, blocks = result.summary(), _blocks(result)
    keys = [key.format(result.case.name) for key in _CARDS]
    return str(
        template("template.html.j2").render(
            title=result.case.title,
            version=version(),
            operating_point=operating_point(result.case),
            cards=[describe(key, summary[key], 4) for key in keys],
            rows=[number_of_part(k, summary[k]) for ks in by_topic(summary).values() for k in ks],
            modes=result.operation.stage_modes.rows(),
            modes_head=MODES_HEAD,
            modes_text=_modes_text(result.operation.stage_modes),
            compared=[],
            blocks=blocks,
            warnings=[str(warning) for warning in result.warnings],
            assumptions=result.assumptions,
            citations=result.cite().splitlines(),
            provenance=provenance(None),
            case_text=result.case.to_toml(),
            figures=embedded_figures(blocks),
            style=text_of("report.css"),
            script=text_of("report.js"),
            plotly_js=plotly_script(),
        )
    )


def stage_modes_report_data(
    case: PlanetaryCase, speeds: Array | None, progress: Progress
) -> StudyReportData:
    """Natural modes of a stage by type, and what excites them over the speed [rad/s]."""
    stage = stage_modes(case, progress)
    campbell = stage.campbell(speeds)
    figures = [
        figure_with_caption(plot.planetary_modes, stage.modes),
        figure_with_caption(plot.machine_campbell, campbell),
    ]
    statements = [
        f"{figures[1][1].layout.title.text}.",
        f"Types of modes that harmonics of the mesh excite: {stage.excitation_text()}.",
        stage.frame_effect(),
    ]
    return StudyReportData(campbell, figures, statements, MODES_HEAD, stage.rows(), stage.facts())


@report_of("PlanetaryResult")
def write_planetary_report(result: PlanetaryResult, path: str | os.PathLike[str]) -> Path:
    """Write the report of a planetary stage to a file.

    Parameters
    ----------
    result : PlanetaryResult
        What :func:`tribodyn.run` returns for a planetary stage.
    path : path
        File to write; an existing one is replaced.

    Raises
    ------
    InputError
        If the place cannot be written to.
    """
    target = Path(path)
    write_file(target, render_planetary_report(result))
    return target
