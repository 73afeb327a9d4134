"""Natural frequencies and mesh harmonics over speed, with their crossings."""

from __future__ import annotations

from typing import Any

import numpy as np

from tribodyn.drawing import drawing
from tribodyn.plot.labels import axis_label, display_unit, displayed, rounded
from tribodyn.plot.style import MUTED, PAIR_COLORS, WHEEL, Panel, line, stack

#: Widths of the curve of a mode without and with all of its strain in the mesh [px].
_THIN, _THICK = 1.0, 4.0


def _missing(result: Any) -> str:
    if hasattr(result, "resonances"):
        return ""
    return (
        "This figure shows natural frequencies over speed. Call tribodyn.dynamics.campbell and "
        "its plot method."
    )


def _title(diagram: Any) -> str:
    if not diagram.resonances:
        return f"None of {len(diagram.orders)} mesh harmonics meets a natural frequency"
    worst = max(diagram.resonances, key=lambda met: met.contact_share / met.order)
    return (
        f"Harmonic {worst.order} meets {rounded('frequency', worst.frequency)}, "
        f"{100 * worst.contact_share:.0f} % mesh, at {rounded('speed', worst.speed)}"
    )


def _modes(diagram: Any, speed: Any, top: float) -> list[dict[str, Any]]:
    """Lines of the modes; those wholly above the picture have no place in its legend."""
    unit, traces = display_unit("frequency"), []
    for column in range(diagram.frequency.shape[1]):
        share = float(np.mean(diagram.contact_share[:, column]))
        name = f"mode {diagram.first_mode + column}"
        color = PAIR_COLORS[column % len(PAIR_COLORS)]
        values = displayed("frequency", diagram.frequency[:, column])
        width = _THIN + (_THICK - _THIN) * share
        trace = line(speed, values, name, color, unit=unit, width=width)
        traces.append({**trace, "showlegend": bool(np.min(values) <= top)})
    return traces


def _rising(diagram: Any, speed: Any, top: float) -> list[dict[str, Any]]:
    """Lines of the mesh harmonics, each with its number where it leaves the picture."""
    traces = []
    for order in diagram.orders:
        values = displayed("frequency", order * diagram.mesh_frequency)
        seen = np.flatnonzero(values <= 0.97 * top)
        words = [""] * len(values)
        if seen.size:
            words[seen[-1]] = str(order)
        name, unit = f"harmonic {order}", display_unit("frequency")
        rising = line(speed, values, name, MUTED, unit=unit, dash="dash", width=1.0)
        traces.append({**rising, "mode": "lines+text", "text": words, "textposition": "top left"})
    return traces


def _met(diagram: Any) -> list[dict[str, Any]]:
    if not diagram.resonances:
        return []
    met = diagram.resonances
    facts = [[each.order, 100.0 * each.contact_share] for each in met]
    return [
        {
            "type": "scatter",
            "mode": "markers",
            "x": displayed("speed", np.array([each.speed for each in met])),
            "y": displayed("frequency", np.array([each.frequency for each in met])),
            "name": "resonance",
            "marker": {
                "color": WHEEL,
                "size": 6.0 + 10.0 * np.array([each.contact_share for each in met]),
            },
            "customdata": facts,
            "hovertemplate": "harmonic %{customdata[0]}, %{y:.5g} "
            f"{display_unit('frequency')}, mesh %{{customdata[1]:.0f}} %"
            "<extra>resonance</extra>",
        }
    ]


@drawing(
    "campbell",
    heading="Campbell diagram",
    caption="Natural frequencies across, mesh harmonics rising with speed. Where two lines cross "
    "the mesh can drive a resonance; the thicker the line of a mode and the larger the dot, the "
    "more of the strain sits in the mesh.",
    needs=_missing,
)
def campbell(diagram: Any) -> Any:
    """Draw natural frequencies and mesh harmonics over speed.

    Parameters
    ----------
    diagram : Campbell
        What :func:`tribodyn.dynamics.campbell` returns.

    Returns
    -------
    plotly.graph_objects.Figure
    """
    speed = displayed("speed", diagram.speed)
    modes = float(np.max(displayed("frequency", diagram.frequency), initial=0.0))
    lines = float(np.max(displayed("frequency", max(diagram.orders) * diagram.mesh_frequency)))
    top = 1.1 * (min(modes, lines) or lines)
    axis = {"range": [0.0, top]}
    traces = [*_modes(diagram, speed, top), *_rising(diagram, speed, top), *_met(diagram)]
    return stack(
        _title(diagram),
        axis_label("speed"),
        [Panel(axis_label("frequency"), traces, axis, height=1.8)],
        {"hovermode": "closest"},
    )
