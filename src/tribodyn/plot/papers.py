"""Deviation of computed values from the printed values of published papers."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from tribodyn.drawing import Sketch, drawing
from tribodyn.plot.theme.colors import MUTED, PINION, WHEEL
from tribodyn.plot.theme.panels import Panel, stack
from tribodyn.plot.theme.style import Trace, dots

if TYPE_CHECKING:
    from tribodyn.cases import PaperComparison

#: Smallest deviation on the logarithmic axis [%]; smaller ones are plotted there.
_LEAST = 1e-3
_COLORS = {"value": PINION, "trend": MUTED, "cannot-reproduce": WHEEL}


def _no_numbers(comparison: PaperComparison) -> str:
    if any(row["deviation"] is not None for row in comparison.rows):
        return ""
    return "No row of these tables has both a printed and a computed value."


def _symbol(percent: float) -> str:
    if abs(percent) <= _LEAST:
        return "circle"
    return "triangle-up" if percent > 0.0 else "triangle-down"


@drawing(
    heading="Printed and computed values",
    caption="Absolute deviation from every printed value, in the order of the tables; "
    "triangles point up where the computed value is larger. Rows that print a word or a range "
    "have no mark. The table of the report lists the numbers and the reasons.",
    of="PaperComparison",
    made_by="Call tribodyn.cases.compare_with_paper(name) and its plot method.",
    missing=_no_numbers,
)
def paper_comparison(comparison: PaperComparison) -> Sketch:
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
        x, y = np.array([number for number, _ in chosen]), np.maximum(np.abs(percent), _LEAST)
        marker = {"color": color, "size": 8, "symbol": [_symbol(each) for each in percent]}
        facts: Trace = {"customdata": names, "hovertemplate": "%{customdata}<extra></extra>"}
        traces.append(dots(x, y, verdict, marker, showlegend=True, **facts))
    inside = sum(abs(row["deviation"]) <= 0.01 for row in rows)
    return stack(
        f"{inside} of {len(rows)} printed values agree within 1 %",
        "Printed value, in the order of the tables",
        [Panel("Deviation [%]", traces, {"type": "log", "dtick": 1}, 1.6)],
        {"hovermode": "closest"},
    )
