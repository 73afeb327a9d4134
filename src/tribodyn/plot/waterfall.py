"""Spectra of a run-up one behind the other (waterfall)."""

from __future__ import annotations

from typing import Any

import numpy as np

from tribodyn.drawing import drawing
from tribodyn.plot.labels import axis_label, readable, rounded, significant
from tribodyn.plot.spectrogram import with_unit
from tribodyn.plot.style import INK, MUTED, WHEEL, Panel, line, stack

#: Most spectra drawn, most points in one, and how many steps up the largest amplitude reaches.
_CURVES, _POINTS, _REACH = 40, 600, 6.0


def _missing(result: Any) -> str:
    if hasattr(result, "strongest") and hasattr(result, "time"):
        return ""
    return (
        "This figure shows spectra one behind the other. Call tribodyn.analysis.order_map or "
        "spectrogram on a signal and tribodyn.plot.waterfall.waterfall on what it returns."
    )


@drawing(
    "waterfall",
    heading="Waterfall",
    caption="One spectrum behind the other, from the first at the bottom to the last at the top; "
    "all on one scale. The one with the highest peak is drawn in colour.",
    needs=_missing,
)
def waterfall(result: Any) -> Any:
    """Draw the spectra of an order map or a spectrogram one behind the other.

    Parameters
    ----------
    result : OrderMap or Spectrogram
        What :func:`tribodyn.analysis.order_map` or :func:`tribodyn.analysis.spectrogram` returns.

    Returns
    -------
    plotly.graph_objects.Figure
    """
    by_order = hasattr(result, "order")
    place = result.order if by_order else result.frequency
    words = "Order" if by_order else axis_label("frequency")
    number, block = result.strongest()
    peak = float(result.amplitude[number, block])
    few = min(result.time.size, _CURVES)
    chosen = np.unique(np.linspace(0, result.time.size - 1, few).round().astype(int))
    chosen[int(np.argmin(np.abs(chosen - block)))] = block
    groups = np.arange(1, place.size, -(-place.size // _POINTS))
    foot = np.diff(np.append(groups, place.size))
    across = np.add.reduceat(place, groups) / foot
    unit = readable(result.unit)
    names = [_when(result, int(k)) for k in chosen]
    traces = []
    for level, (k, name) in enumerate(zip(chosen, names, strict=True)):
        height = np.maximum.reduceat(result.amplitude[:, k], groups)
        color, width = (WHEEL, 2.2) if k == block else (INK, 1.0)
        curve = line(across, level + height * (_REACH / (peak or 1.0)), name, color, width=width)
        hover = f"%{{x:.4g}}: %{{customdata:.3g}} {unit}".rstrip() + f"<extra>{name}</extra>"
        traces.append({**curve, "customdata": height, "hovertemplate": hover, "showlegend": False})
    ticks = np.unique(np.linspace(0, chosen.size - 1, 6).round().astype(int))
    what = f"order {place[number]:.4g}" if by_order else f"{significant(float(place[number]))} Hz"
    axis = {
        "tickvals": ticks.tolist(),
        "ticktext": [names[k] for k in ticks],
        "showgrid": False,
        "tickfont": {"color": MUTED},
    }
    label = "Speed" if by_order else "Time"
    made = stack(
        f"The highest peak is {with_unit(peak, result.unit)}, {what} at {_when(result, block)}",
        words,
        [Panel(label, traces, axis, height=2.6)],
    )
    return made.update_layout(hovermode="closest")


def _when(result: Any, block: int) -> str:
    """Speed or time of a block."""
    if hasattr(result, "order"):
        return rounded("speed", float(result.speed[block]))
    return f"{significant(float(result.time[block]))} s"
