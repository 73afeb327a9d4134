"""Variance shares of summary figures by uncertain input (Sobol indices of a case)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.drawing import drawing
from tribodyn.plot.theme.style import GRID, MUTED, PAIR_COLORS, PINION, Trace, figure
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.study import CaseSensitivity

#: Height of a row, and of the margins above and below the rows [px].
_ROW, _FRAME = 46, 190
#: Names and colours of the two kinds of share.
_KINDS = (("alone", PINION), ("with interactions", PAIR_COLORS[0]))


@drawing(
    "sensitivity",
    heading="Contribution of each tolerance",
    caption="Share of the variance due to each input: alone, and with interactions, "
    "which is the share that would vanish if the input were known exactly. Thin lines are "
    "bootstrap intervals: use a larger sample where they are long.",
    of="CaseSensitivity",
    made_by='Call tribodyn.sobol_indices(case, "peak_mesh_force", {"operation.torque": '
    '"90 N*m +- 5 %"}, seed=1) and its plot method.',
)
def sensitivity(shares: CaseSensitivity) -> Any:
    """Draw the shares of the inputs as bars, one group per summary figure."""
    figures, inputs = [str(name) for name in shares.figure], [str(key) for key in shares.input]
    orders = (shares.first_order, shares.total_order)
    bands = (shares.first_order_band, shares.total_order_band)
    labels = [[_wrapped_name(name) for name in figures for _ in inputs], inputs * len(figures)]
    traces = [
        _bars(labels, np.asarray(order), band, name, color)
        for order, band, (name, color) in zip(orders, bands, _KINDS, strict=True)
    ]
    count = len(inputs) * len(figures)
    layout = {
        "barmode": "group",
        "bargap": 0.25,
        "hovermode": "closest",
        "height": _FRAME + _ROW * count,
        "xaxis": {"title": {"text": "Share of the variance [%]"}, "rangemode": "tozero"},
        "yaxis": {
            "autorange": "reversed",
            "automargin": True,
            "dividercolor": GRID,
            "title": {"text": ""},
        },
        "legend": {"orientation": "h", "x": 0.0, "y": 1.0, "yanchor": "bottom"},
    }
    return figure(_title(figures, inputs, shares.total_order), traces, layout)


def _bars(labels: Any, order: Array, band: Array, name: str, color: str) -> Trace:
    values = 100.0 * order.ravel()
    trace: Trace = {
        "type": "bar",
        "orientation": "h",
        "x": values,
        "y": labels,
        "name": name,
        "marker": {"color": color},
        "hovertemplate": f"%{{x:.3g}} % {name}<extra></extra>",
    }
    # Estimates may lie outside 0 to 100 %; the intervals are clipped.
    ends = np.clip(100.0 * np.asarray(band), 0.0, 100.0)
    low, high = (ends[..., end, :].ravel() for end in (0, 1))
    trace["error_x"] = {
        "type": "data",
        "array": np.maximum(high - values, 0.0),
        "arrayminus": np.maximum(values - low, 0.0),
        "color": MUTED,
        "thickness": 1.2,
        "width": 3,
    }
    return trace


def _wrapped_name(name: str) -> str:
    """Name of a summary figure, wrapped at 20 characters."""
    parts, lines = name.split("_"), [""]
    for part in parts:
        if len(lines[-1]) + len(part) > 20:
            lines.append("")
        lines[-1] = f"{lines[-1]} {part}".strip()
    return "<br>".join(lines)


def _title(figures: list[str], inputs: list[str], total: Array) -> str:
    largest = [int(row.argmax()) for row in total]
    share = f"{100.0 * min(max(total[0, largest[0]], 0.0), 1.0):.0f} %"
    if len(figures) == 1:
        quantity = figures[0].replace("_", " ")
        return f"{share} of the variance of the {quantity} comes from {inputs[largest[0]]}"
    if len(set(largest)) == 1:
        return f"Most of the spread comes from {inputs[largest[0]]}"
    return f"The spread comes from {len(set(largest))} inputs, by figure"
