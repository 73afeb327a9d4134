"""The transmission error of the loaded mesh at rest: its course and its mesh harmonics."""

from __future__ import annotations

from typing import Any

import numpy as np

from tribodyn.drawing import drawing
from tribodyn.plot.cycle import CYCLES, cycles, mesh_events
from tribodyn.plot.labels import axis_label, display_unit, displayed, rounded
from tribodyn.plot.separate import Row, separate
from tribodyn.plot.style import MUTED, TOTAL, Panel, line

_QUANTITY = "static_transmission_error"
#: Mesh harmonics drawn.
_ORDERS = 8


def _course(mesh: Any, mean: float) -> Row:
    """Transmission error over the mesh cycles, and its mean."""
    unit = display_unit(_QUANTITY)
    phase, shown = cycles(mesh.phase, displayed(_QUANTITY, mesh.static_transmission_error))
    level = np.full(2, displayed(_QUANTITY, mean))
    curves = [
        line(phase, shown, "under load", TOTAL, unit=unit),
        line(np.array([0.0, CYCLES]), level, "mean", MUTED, unit=unit, dash="dash", width=1.2),
    ]
    return Row(
        axis_label("mesh_phase", "Mesh cycles"),
        Panel(axis_label(_QUANTITY, "Transmission error"), curves),
        {"range": [0, CYCLES]},
        mesh_events(mesh),
    )


def _bars(mesh: Any) -> Row:
    """Amplitudes of the mesh harmonics."""
    unit = display_unit(_QUANTITY)
    bars = {
        "type": "bar",
        "x": np.arange(1, _ORDERS + 1),
        "y": displayed(_QUANTITY, mesh.harmonics(_QUANTITY, _ORDERS)),
        "name": "amplitude",
        "marker": {"color": TOTAL},
        "width": 0.35,
        "hovertemplate": f"%{{y:.4g}} {unit}<extra>harmonic %{{x}}</extra>",
    }
    return Row(
        "Mesh harmonic",
        Panel(axis_label(_QUANTITY, "Amplitude"), [bars], {"rangemode": "tozero"}, 0.7),
        {"dtick": 1, "range": [0.4, _ORDERS + 0.6], "showgrid": False},
    )


@drawing(
    "static_transmission_error",
    heading="Static transmission error",
    caption="How far the gears approach along the line of action when they turn very slowly under "
    "load. What varies is the excitation of the vibration; the bars show how much of it falls on "
    "each harmonic of the mesh frequency.",
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
    mesh = result.mesh
    mean = float(mesh.grid.mean(mesh.static_transmission_error))
    swing = float(np.ptp(mesh.static_transmission_error))
    return separate(
        f"At rest the transmission error is {rounded(_QUANTITY, mean)} on average and varies by "
        f"{rounded(_QUANTITY, swing)}",
        [_course(mesh, mean), _bars(mesh)],
    )
