"""The transmission error of the loaded mesh at rest: its course and its mesh harmonics."""

from __future__ import annotations

from typing import Any

import numpy as np

from tribodyn.plot.cycle import CYCLES, cycles, mesh_events
from tribodyn.plot.events import event_lines
from tribodyn.plot.labels import axis_label, display_unit, displayed, rounded
from tribodyn.plot.registry import drawing
from tribodyn.plot.style import MUTED, TOTAL, Panel, line, stack

__all__ = ["static_transmission_error"]

#: Mesh harmonics drawn.
_ORDERS = 8
#: Upper panel and lower panel: the lower one has a horizontal axis of its own.
_COURSE, _BARS, _HEIGHT = (0.5, 1.0), (0.0, 0.33), 540


@drawing(
    "static_transmission_error",
    heading="Static transmission error",
    caption="How far the gears approach along the line of action when they turn very slowly under "
    "load. What varies is the excitation of the vibration; the bars show how much of it falls on "
    "each harmonic of the mesh frequency. Tip relief and a suitable contact ratio make it small.",
)
def static_transmission_error(result: Any) -> Any:
    """Draw the static transmission error over two mesh cycles, and its mesh harmonics.

    Parameters
    ----------
    result : Result or MeshTable
        Anything that has a mesh table.

    Returns
    -------
    plotly.graph_objects.Figure
    """
    mesh, quantity = result.mesh, "static_transmission_error"
    unit, error = display_unit(quantity), mesh.static_transmission_error
    phase, shown = cycles(mesh.phase, displayed(quantity, error))
    orders = np.arange(1, _ORDERS + 1)
    amplitudes = displayed(quantity, mesh.harmonics(quantity, _ORDERS))
    mean = float(mesh.grid.mean(error))
    curves = [
        line(phase, shown, "static transmission error", TOTAL, unit=unit),
        {
            **line(
                [0, CYCLES], [float(displayed(quantity, mean))] * 2, "mean", MUTED, unit=unit,
                dash="dash", width=1.2,
            )
        },
    ]
    bars = {
        "type": "bar",
        "x": orders,
        "y": amplitudes,
        "name": "amplitude",
        "marker": {"color": TOTAL},
        "width": 0.35,
        "hovertemplate": f"%{{y:.4g}} {unit}<extra>harmonic %{{x}}</extra>",
        "showlegend": False,
        "xaxis": "x2",
        "yaxis": "y2",
    }
    layout = _layout(mesh)
    made = stack(
        f"At rest the transmission error is {rounded(quantity, mean)} on average and varies by "
        f"{rounded(quantity, float(np.ptp(error)))}",
        axis_label("mesh_phase", "Mesh cycles"),
        [Panel(axis_label(quantity), curves)],
        layout,
    )
    return made.add_trace(bars)


def _layout(mesh: Any) -> dict[str, Any]:
    """Axes of both panels: the harmonics have a horizontal axis of their own."""
    marks = event_lines(mesh_events(mesh))
    return {
        "shapes": [{**shape, "yref": "y domain"} for shape in marks["shapes"]],
        "annotations": [{**note, "yref": "y domain"} for note in marks["annotations"]],
        "xaxis": {"range": [0, CYCLES], "anchor": "y"},
        "yaxis": {"domain": _COURSE, "title": {"text": axis_label("static_transmission_error", "Transmission error")}},
        "xaxis2": {
            "anchor": "y2",
            "title": {"text": "Mesh harmonic"},
            "dtick": 1,
            "range": [0.4, _ORDERS + 0.6],
            "showgrid": False,
        },
        "yaxis2": {
            "domain": _BARS,
            "rangemode": "tozero",
            "title": {"text": axis_label("static_transmission_error", "Amplitude")},
        },
        "height": _HEIGHT,
    }
