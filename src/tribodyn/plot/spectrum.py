"""Amplitudes of transmission error and accelerations by mesh harmonic."""

from __future__ import annotations

from typing import Any

from tribodyn.drawing import drawing
from tribodyn.plot import signals
from tribodyn.plot.both_gears import harmonic_panels
from tribodyn.plot.harmonics import harmonic_layout, harmonic_panel, no_harmonics, strongest
from tribodyn.plot.style import TOTAL, stack


@drawing(
    "spectrum",
    heading="Spectra",
    caption="How strong each mesh harmonic is. Harmonic 1 is the mesh frequency, the teeth that "
    "pass in a second. A high bar at a higher harmonic tells of a natural frequency near it. The "
    "buttons switch to a logarithmic scale, on which small harmonics show.",
    needs=no_harmonics,
)
def spectrum(result: Any) -> Any:
    """Draw the mesh harmonics of the transmission error and of the accelerations.

    Parameters
    ----------
    result : Result
        What :func:`tribodyn.run` returns; its response is a steady state.

    Returns
    -------
    plotly.graph_objects.Figure
    """
    error = signals.transmission_error(result)
    panels = [
        harmonic_panel(
            result,
            "dynamic_transmission_error",
            "Transmission error",
            [("transmission error", TOTAL, error)],
        ),
        *harmonic_panels(result, "acceleration", signals.acceleration),
    ]
    return stack(
        f"Mesh harmonic {strongest(panels[0])} is the strongest in the transmission error",
        "Mesh harmonic",
        panels,
        harmonic_layout(panels),
    )
