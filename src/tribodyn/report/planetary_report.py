"""Report of a planetary stage: its picture, forces, modes, what excites them, and all figures."""

from __future__ import annotations

import math
import os
from pathlib import Path
from typing import TYPE_CHECKING

from tribodyn import plot
from tribodyn.drawing import report_of
from tribodyn.report.figure_blocks import Block, block_of_figure
from tribodyn.report.html import embedded_figures, plotly_script, template, text_of
from tribodyn.report.machine_report import number_of_part
from tribodyn.report.numbers import describe
from tribodyn.report.provenance import operating_point, provenance, version
from tribodyn.study.pipeline.save import write_file
from tribodyn.study.pipeline.summary_figures import by_topic

if TYPE_CHECKING:
    from tribodyn.study.planetary.result import PlanetaryResult

MODES_HEAD = ("Mode", "Frequency [Hz]", "Multiplicity", "Type", "Excited by mesh harmonics")
#: Harmonics of the mesh frequency in the table of modes.
_HARMONICS = 12
_TYPES = {"rotational": "R", "translational": "T", "planet": "P", "mixed": "RT"}
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


def excitation_rows(result: PlanetaryResult) -> list[list[str]]:
    """Natural modes with their types and the mesh harmonics that excite each of them."""
    modes, phases = result.modes, result.operation.phases
    harmonics = {k: phases.excitation(k).types for k in range(1, _HARMONICS + 1)}
    mesh_frequency = result.motion.mesh_frequency
    rows: list[list[str]] = []
    last = (-1.0, "")
    for frequency, kind in zip(modes.frequency.tolist(), modes.types, strict=True):
        if kind == last[1] and abs(frequency - last[0]) <= 1e-6 * frequency:
            rows[-1][2] = str(int(rows[-1][2]) + 1)
            continue
        last = frequency, kind
        exciting = [k for k, types in harmonics.items() if set(types) & set(_TYPES[kind])]
        text = ", ".join(map(str, exciting)) or "none"
        if exciting and frequency > 0.0:
            near = min(exciting, key=lambda k: abs(k * mesh_frequency - frequency))
            distance = near * mesh_frequency / frequency - 1.0
            text += f"; nearest {near}, {100.0 * distance:+.1f} %"
        rows.append([str(len(rows) + 1), f"{frequency:.5g}", "1", kind, text])
    return rows


def _modes_text(result: PlanetaryResult) -> str:
    harmonics = [
        f"{k}: {result.operation.phases.excitation(k).types}" for k in range(1, _HARMONICS + 1)
    ]
    return (
        "About the static load, with the mean stiffness of the meshes. By the phases of the "
        "planets each harmonic of the mesh frequency excites modes of certain types: R rotational "
        "(central members turn), T translational, P of the planets alone. Harmonic "
        f"{', '.join(harmonics)}."
    )


def _blocks(result: PlanetaryResult) -> list[Block]:
    # As Inalpolat and Kahraman: the sensor feels the nearest planet.
    sensor = result.operation.ring_sensor(window=2.0 * math.pi / result.case.table.count)
    parts = [
        (plot.planetary_stage, result, "stage", plot.planetary_stage.heading),
        (plot.planetary_forces, result.motion, "forces", plot.planetary_forces.heading),
        (plot.ring_sensor, sensor, "ring-sensor", plot.ring_sensor.heading),
        (plot.planetary_modes, result.modes, "mode-shapes", plot.planetary_modes.heading),
        *(
            (plot.face_maps, table, f"face-maps-{mesh}", f"Mesh {mesh}: maps over the face")
            for mesh, table in result.operation.tables.items()
        ),
    ]
    return [
        block_of_figure(name, heading, drawn.sketch(part), drawn.caption_of(part))
        for drawn, part, name, heading in parts
        if not drawn.missing(part)
    ]


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
            modes=excitation_rows(result),
            modes_head=MODES_HEAD,
            modes_text=_modes_text(result),
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
