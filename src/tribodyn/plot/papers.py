"""Printed figures of sources, and how far what is computed is from them."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.drawing import drawing
from tribodyn.plot.look.panels import Panel, stack
from tribodyn.plot.look.style import MUTED, PINION, WHEEL, Trace

if TYPE_CHECKING:
    from tribodyn.cases import PaperComparison

#: Deviations below it [%] are drawn at it.
_LEAST = 1e-3
_COLORS = {"value": PINION, "trend": MUTED, "cannot-reproduce": WHEEL}


def _no_numbers(comparison: PaperComparison) -> str:
    if any(row["deviation"] is not None for row in comparison.rows):
        return ""
    return "No row of these tables has both a printed and a computed number."


def _symbol(percent: float) -> str:
    if abs(percent) <= _LEAST:
        return "circle"
    return "triangle-up" if percent > 0.0 else "triangle-down"


@drawing(
    "paper_comparison",
    heading="Printed and computed",
    caption="Amount of the deviation of every printed number, in the order of the tables; "
    "triangles point up where the computed one is greater. Rows whose print is a word or a range "
    "have none. The table of the report holds the numbers and the reasons.",
    of="PaperComparison",
    made_by="Call tribodyn.cases.compare_with_paper(name) and its plot method.",
    missing=_no_numbers,
)
def paper_comparison(comparison: PaperComparison) -> Any:
    """Draw the deviation of every printed number on a logarithmic scale."""
    rows = [row for row in comparison.rows if row["deviation"] is not None]
    traces: list[Trace] = []
    for verdict, color in _COLORS.items():
        chosen = [(number, row) for number, row in enumerate(rows, 1) if row["verdict"] == verdict]
        if not chosen:
            continue
        percent = np.array([100.0 * row["deviation"] for _, row in chosen])
        names = [
            f"{row['table']}, {row['row']}: printed {row['printed']:.5g}, computed "
            f"{row['computed']:.5g}, {each:+.3g} %"
            for (_, row), each in zip(chosen, percent, strict=True)
        ]
        traces.append(
            {
                "type": "scatter",
                "mode": "markers",
                "x": np.array([number for number, _ in chosen]),
                "y": np.maximum(np.abs(percent), _LEAST),
                "name": verdict,
                "customdata": names,
                "hovertemplate": "%{customdata}<extra></extra>",
                "marker": {
                    "color": color,
                    "size": 8,
                    "symbol": [_symbol(each) for each in percent],
                },
                "showlegend": True,
            }
        )
    inside = sum(abs(row["deviation"]) <= 0.01 for row in rows)
    return stack(
        f"{inside} of {len(rows)} printed numbers are met within 1 %",
        "Printed number, in the order of the tables",
        [Panel("Deviation [%]", traces, {"type": "log", "dtick": 1}, 1.6)],
        {"hovermode": "closest"},
    )
