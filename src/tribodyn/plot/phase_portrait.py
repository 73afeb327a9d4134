"""Phase portrait: velocity over position, with the points at the mesh phase 0."""

from __future__ import annotations

from typing import Any

import numpy as np

from tribodyn.drawing import drawing
from tribodyn.plot.scaled import scaled, unit_of
from tribodyn.plot.style import MUTED, PINION, WHEEL, figure


def _missing(result: Any) -> str:
    if hasattr(result, "section_position"):
        return ""
    return (
        "This figure shows a motion in its phase plane. Call "
        "tribodyn.analysis.phase_portrait(response) and its plot method."
    )


@drawing(
    "phase_portrait",
    heading="Phase portrait",
    caption="Velocity over position of one coordinate, or of the compression of a contact. A "
    "motion that repeats is a closed curve; the dots are its states at the mesh phase 0. Dashed "
    "lines are the ends of the backlash.",
    needs=_missing,
)
def phase_portrait(portrait: Any) -> Any:
    """Draw the curve and its points at the mesh phase 0.

    Parameters
    ----------
    portrait : PhasePortrait
        What :func:`tribodyn.analysis.phase_portrait` returns.

    Returns
    -------
    plotly.graph_objects.Figure
    """
    unit = unit_of(portrait.name)
    x_factor, x_unit = scaled(portrait.position, unit)
    y_factor, y_unit = scaled(portrait.velocity, f"{unit}/s")
    hover = f"%{{x:.5g}} {x_unit}, %{{y:.5g}} {y_unit}<extra></extra>"
    traces = [
        {
            "type": "scatter", "mode": "lines", "name": "motion", "hovertemplate": hover,
            "x": x_factor * portrait.position, "y": y_factor * portrait.velocity,
            "line": {"color": PINION, "width": 1.6 if portrait.period else 0.6},
        },
        {
            "type": "scatter", "mode": "markers", "name": "mesh phase 0", "hovertemplate": hover,
            "x": x_factor * portrait.section_position, "y": y_factor * portrait.section_velocity,
            "marker": {"color": WHEEL, "size": 9 if portrait.period else 5},
        },
    ]  # fmt: skip
    ends = [side * portrait.gap for side in (-1.0, 1.0)]
    dashed = {"color": MUTED, "dash": "dash", "width": 1}
    lines = [
        {
            "type": "line", "x0": x_factor * end, "x1": x_factor * end, "y0": 0, "y1": 1,
            "yref": "paper", "line": dashed, "name": "the flanks part", "showlegend": end > 0.0,
        }
        for end in ends
        if portrait.gap > 0.0 and (end > 0.0 or portrait.position.min() < 0.0)
    ]  # fmt: skip
    words = "Compression of the contact" if portrait.gap >= 0.0 else portrait.name.replace("_", " ")
    seen = np.append(portrait.position, [end for end in ends if lines and end > 0.0])
    layout = {
        "xaxis": {"title": {"text": f"{words} [{x_unit}]"}, "range": _around(x_factor * seen)},
        "yaxis": {
            "title": {"text": f"its velocity [{y_unit}]"},
            "range": _around(y_factor * portrait.velocity),
        },
        "hovermode": "closest",
        "height": 560,
        "shapes": lines,
    }
    return figure(_title(portrait), traces, layout)


def _around(values: Any) -> list[float]:
    """Range with a margin, so that the curve does not touch the frame."""
    low, high = float(np.min(values)), float(np.max(values))
    margin = 0.06 * (high - low) or 1.0
    return [low - margin, high + margin]


def _title(portrait: Any) -> str:
    if portrait.verdict == "step-limited":
        return "The motion is made by the step, not by physics"
    if portrait.period == 1:
        return "The motion closes after one mesh cycle"
    if portrait.period:
        return f"The motion closes after {portrait.period} mesh cycles"
    return "The motion does not close"
