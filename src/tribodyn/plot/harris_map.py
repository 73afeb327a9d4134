"""Transmission error at rest over torque: curves, swing and mesh harmonics (Harris map)."""

from __future__ import annotations

from typing import Any

import numpy as np

from tribodyn.drawing import drawing
from tribodyn.plot.labels import axis_label, display_unit, displayed, rounded
from tribodyn.plot.loaded_life import mesh_marks, whole_cycles
from tribodyn.plot.separate import Row, separate
from tribodyn.plot.style import MUTED, PAIR_COLORS, TOTAL, Panel, line
from tribodyn.plot.torques import named, torque_colors, torque_names
from tribodyn.types import Array

_QUANTITY = "static_transmission_error"
#: Mesh harmonics drawn, each with a dash of its own; curves of the transmission error.
_HARMONICS = ("dash", "dot", "dashdot")
_MOST_CURVES = 25


def _missing(result: Any) -> str:
    if hasattr(result, "quietest_torque"):
        return ""
    return (
        "This figure shows the transmission error over torque. Call tribodyn.harris_map(case) "
        "and its plot method."
    )


def _curves(study: Any) -> Row:
    """Transmission error over the mesh cycles, one curve for each torque."""
    unit, cycles = display_unit(_QUANTITY), 2 if study.mesh_cycles == 1 else 1
    rigid = study.unloaded_transmission_error

    def over(values: Array) -> tuple[Array, Array]:
        return whole_cycles(study.phase, displayed(_QUANTITY, values), study.mesh_cycles, cycles)

    traces = []
    if np.any(rigid):
        phase, shown = over(rigid)
        traces.append(line(phase, shown, "no load", MUTED, unit=unit, dash="dash", width=1.2))
    count = study.torque.size
    chosen = np.unique(np.linspace(0, count - 1, min(count, _MOST_CURVES)).round().astype(int))
    labels, looks = torque_names(study), torque_colors(count)
    for number, known in zip(chosen[::-1], named(chosen.size)[::-1], strict=True):
        trace = line(
            *over(study.transmission_error[number]),
            labels[number],
            looks[number],
            unit=unit,
            width=1.6,
        )
        traces.append({**trace, "showlegend": known})
    return Row(
        axis_label("mesh_phase", "Mesh cycles"),
        Panel(axis_label(_QUANTITY, "Transmission error"), traces, height=1.5),
        {"range": [0, cycles * study.mesh_cycles]},
        mesh_marks(study.gear_pair, cycles) if study.mesh_cycles == 1 else (),
    )


def _swings(study: Any) -> Row:
    """Peak-to-peak value and mesh harmonics over the torque."""
    unit, torque = display_unit(_QUANTITY), displayed("torque", study.torque)
    mode = {"mode": "lines+markers", "marker": {"size": 5}}
    swing = displayed(_QUANTITY, study.peak_to_peak_transmission_error)
    traces = [{**line(torque, swing, "peak to peak", TOTAL, unit=unit), **mode}]
    for number, dash in enumerate(_HARMONICS[: study.harmonics.shape[1]]):
        amplitude = displayed(_QUANTITY, study.harmonics[:, number])
        name, color = f"harmonic {number + 1}", PAIR_COLORS[number]
        traces.append({**line(torque, amplitude, name, color, unit=unit, dash=dash), **mode})
    quietest = float(displayed("torque", study.quietest_torque))
    inside = study.torque.min() < study.quietest_torque < study.torque.max()
    return Row(
        axis_label("torque", "Torque on the pinion"),
        Panel(axis_label(_QUANTITY, "Swing, amplitude"), traces, {"rangemode": "tozero"}, 1.2),
        {"rangemode": "tozero"},
        [("least", quietest)] if inside else (),
    )


@drawing(
    "harris_map",
    heading="Transmission error over torque",
    caption="Above, the transmission error of the mesh at rest under rising torque; below, how far "
    "it swings and how much of that falls on each mesh harmonic. Modified flanks are quietest at "
    "the torque for which they were made.",
    needs=_missing,
)
def harris_map(study: Any) -> Any:
    """Draw the transmission error for each torque, and its swing and harmonics over the torque.

    Parameters
    ----------
    study : HarrisMap
        What :func:`tribodyn.harris_map` returns.

    Returns
    -------
    plotly.graph_objects.Figure
    """
    swings = study.peak_to_peak_transmission_error
    least = rounded(_QUANTITY, float(np.min(swings)))
    quietest = torque_names(study)[int(np.argmin(swings))]
    return separate(
        f"Quietest at {quietest}: there the transmission error swings by {least}",
        [_curves(study), _swings(study)],
    )
