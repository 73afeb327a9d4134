"""Amplitude over time and frequency as a map in colours."""

from __future__ import annotations

from typing import Any

import numpy as np

from tribodyn.drawing import drawing
from tribodyn.plot.labels import axis_label, readable, significant
from tribodyn.plot.style import GRID, INK, MUTED, TOTAL, Panel, line, stack
from tribodyn.types import Array

#: From silence to the largest amplitude, and the decades between them.
_SCALE = [[0.0, "#ffffff"], [0.35, "#c6dbef"], [0.6, "#6baed6"], [0.8, "#2171b5"], [1.0, "#08306b"]]
_DECADES = 3
#: Height of the map relative to the curves below it.
MAP_HEIGHT = 1.9
#: Most cells along each side: more than the pixels of the panel show nothing more.
_MOST = 480
_BAR = {"len": 0.62, "y": 1.0, "yanchor": "top", "thickness": 14, "x": 1.01, "xanchor": "left"}


def with_unit(value: float, unit: str) -> str:
    """Write an amplitude with three digits and its unit."""
    return f"{significant(value)} {readable(unit)}".rstrip()


def amplitude_label(unit: str) -> str:
    """Label an axis of amplitudes."""
    return f"Amplitude [{readable(unit)}]" if unit else "Amplitude"


def amplitude_heatmap(
    x: Array, y: Array, amplitude: Array, unit: str, hover: str
) -> dict[str, Any]:
    """Describe a map of amplitudes on a logarithmic scale of colours."""
    rows, columns = (-(-size // _MOST) for size in amplitude.shape)
    across, along = np.arange(0, x.size, columns), np.arange(0, y.size, rows)
    most = np.maximum.reduceat(np.maximum.reduceat(amplitude, along, axis=0), across, axis=1)
    largest = float(most.max()) or 1.0
    decades = np.log10(np.maximum(most / largest, 10.0**-_DECADES))
    ticks = np.arange(-_DECADES, 1)
    return {
        "type": "heatmap",
        "x": np.add.reduceat(x, across) / np.diff(np.append(across, x.size)),
        "y": np.add.reduceat(y, along) / np.diff(np.append(along, y.size)),
        "z": np.round(decades, 3),
        "zmin": -_DECADES,
        "zmax": 0,
        "customdata": most,
        "colorscale": _SCALE,
        "colorbar": {
            **_BAR,
            "title": {
                "text": f"[{readable(unit)}]" if unit else "",
                "side": "top",
                "font": {"size": 13, "color": MUTED},
            },
            "tickvals": ticks.tolist(),
            "ticktext": [significant(largest * 10.0**tick, 2) for tick in ticks.tolist()],
            "outlinecolor": GRID,
            "tickfont": {"color": INK},
        },
        "hovertemplate": f"{hover}: %{{customdata:.3g}} {readable(unit)}<extra></extra>",
        "showlegend": False,
    }


def _missing(result: Any) -> str:
    if hasattr(result, "block_duration"):
        return ""
    return (
        "This figure shows amplitudes over time and frequency. Call tribodyn.analysis.spectrogram "
        "on a signal and tribodyn.plot.spectrogram.spectrogram on what it returns."
    )


@drawing(
    "spectrogram",
    heading="Spectrogram",
    caption="Which frequencies are there at what time. Lines that rise with the speed are orders "
    "of a shaft; level ones are natural frequencies. Below, the rms over time.",
    needs=_missing,
)
def spectrogram(result: Any) -> Any:
    """Draw amplitudes over time and frequency, and the rms over time.

    Parameters
    ----------
    result : Spectrogram
        What :func:`tribodyn.analysis.spectrogram` returns.

    Returns
    -------
    plotly.graph_objects.Figure
    """
    number, block = result.strongest()
    frequency, moment = float(result.frequency[number]), float(result.time[block])
    panels = [
        Panel(
            axis_label("frequency"),
            [
                amplitude_heatmap(
                    result.time,
                    result.frequency[1:],
                    result.amplitude[1:],
                    result.unit,
                    "%{y:.5g} Hz at %{x:.4g} s",
                )
            ],
            height=MAP_HEIGHT,
        ),
        Panel(
            f"Rms [{readable(result.unit)}]" if result.unit else "Rms",
            [line(result.time, result.rms(), "rms", TOTAL, unit=readable(result.unit))],
            {"rangemode": "tozero"},
        ),
    ]
    made = stack(
        f"Strongest at {significant(frequency)} Hz after {significant(moment)} s: "
        f"{with_unit(float(result.amplitude[number, block]), result.unit)}",
        "Time [s]",
        panels,
    )
    return made.update_layout(hovermode="closest")
