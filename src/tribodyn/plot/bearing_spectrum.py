"""Amplitudes of the bearing forces by mesh harmonic."""

from __future__ import annotations

from typing import Any

from tribodyn.drawing import drawing
from tribodyn.plot import signals
from tribodyn.plot.both_gears import harmonic_panels, no_translation
from tribodyn.plot.harmonics import harmonic_layout, no_harmonics, strongest
from tribodyn.plot.style import stack


def _missing(result: Any) -> str:
    return no_translation(result) or no_harmonics(result)


@drawing(
    "bearing_spectrum",
    heading="Spectra of the bearing forces",
    caption="What the bearings pass on to the housing, by mesh harmonic. A harmonic that meets a "
    "natural frequency of the housing is the one that is heard.",
    needs=_missing,
)
def bearing_spectrum(result: Any) -> Any:
    """Draw the mesh harmonics of the bearing forces.

    Parameters
    ----------
    result : Result
        What :func:`tribodyn.run` returns; its response is a steady state.

    Returns
    -------
    plotly.graph_objects.Figure
    """
    panels = harmonic_panels(result, "bearing_force", signals.bearing_force)
    return stack(
        f"Mesh harmonic {strongest(panels[0])} is the strongest on the pinion's bearing",
        "Mesh harmonic",
        panels,
        harmonic_layout(panels),
    )
