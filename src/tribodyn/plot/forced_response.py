"""Mesh force and motion that a harmonic error excites, over its frequency."""

from __future__ import annotations

from typing import Any

import numpy as np

from tribodyn.drawing import drawing
from tribodyn.plot.labels import axis_label, display_unit, displayed, rounded
from tribodyn.plot.style import PAIR_COLORS, TOTAL, Panel, line, stack


def _missing(result: Any) -> str:
    if hasattr(result, "structure_force"):
        return ""
    return (
        "This figure shows the response to a harmonic error. Call "
        "tribodyn.dynamics.forced_response and its plot method."
    )


@drawing(
    "forced_response",
    heading="Response to a harmonic error",
    caption="Amplitudes over the frequency of the error. Slow errors turn the gears and press "
    "little; fast ones leave the inertias at rest and are taken up by the teeth; between "
    "them stand the natural modes of the mesh.",
    needs=_missing,
)
def forced_response(response: Any) -> Any:
    """Draw amplitudes of mesh force, deflection and transmission error over frequency.

    Parameters
    ----------
    response : ForcedResponse
        What :func:`tribodyn.dynamics.forced_response` returns.

    Returns
    -------
    plotly.graph_objects.Figure
    """
    x = displayed("frequency", response.frequency)
    force = np.abs(response.mesh_force)
    contact = response.contact[0]
    top = int(np.argmax(force))
    logarithmic = {"type": "log", "exponentformat": "power"}
    motions = [
        line(
            x,
            displayed(name, np.abs(values[:, contact])),
            words,
            color,
            unit=display_unit(name),
            dash=dash,
        )
        for name, values, words, color, dash in (
            ("transmission_error", response.transmission_error, "approach", TOTAL, "solid"),
            ("deflection", response.deflection, "compression", PAIR_COLORS[0], "dash"),
        )
    ]
    forces = [
        line(
            x, displayed("mesh_force", force), "mesh force", TOTAL, unit=display_unit("mesh_force")
        )
    ]
    error = rounded("deflection", float(response.error))
    return stack(
        f"An error of {error} makes {rounded('mesh_force', float(force[top]))} at "
        f"{rounded('frequency', float(response.frequency[top]))}",
        axis_label("frequency"),
        [
            Panel(axis_label("mesh_force", "Mesh force"), forces, logarithmic),
            Panel(axis_label("transmission_error", "Amplitude"), motions, logarithmic),
        ],
    )
