"""Panels below one another, each over a horizontal axis of its own."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any

from tribodyn.plot.events import event_lines
from tribodyn.plot.style import Panel, figure

#: Pixels of one panel, of the gap with axis and title between panels, above and below them.
_PANEL, _GAP, _TOP, _BOTTOM = 230, 84, 74, 58


@dataclass(frozen=True)
class Row:
    """A panel with its own horizontal axis."""

    label: str  #: label of the horizontal axis, with its unit
    panel: Panel  #: curves and vertical axis
    axis: dict[str, Any] = field(default_factory=dict)  #: further properties of the horizontal axis
    marks: Iterable[tuple[str, float]] = ()  #: names and places of lines across the panel


def _marks(row: Row, suffix: str) -> tuple[list[dict[str, Any]], list[dict[str, Any]]]:
    """Lines across one panel and their names above it."""
    made = event_lines(row.marks)
    place = {"xref": f"x{suffix}", "yref": f"y{suffix} domain"}
    shapes = [{**shape, **place} for shape in made["shapes"]]
    return shapes, [{**note, **place} for note in made["annotations"]]


def separate(title: str, rows: Sequence[Row], layout: dict[str, Any] | None = None) -> Any:
    """Stack panels, each over its own horizontal axis and with its own legend."""
    heights = [_PANEL * row.panel.height for row in rows]
    total = sum(heights) + _GAP * (len(rows) - 1)
    merged: dict[str, Any] = {"height": total + _TOP + _BOTTOM, "hovermode": "x unified"}
    traces: list[dict[str, Any]] = []
    more = dict(layout or {})
    shapes, notes = list(more.pop("shapes", ())), list(more.pop("annotations", ()))
    upper = total
    for number, (row, height) in enumerate(zip(rows, heights, strict=True), start=1):
        suffix = "" if number == 1 else str(number)
        top = upper / total
        merged[f"xaxis{suffix}"] = {
            "title": {"text": row.label},
            "anchor": f"y{suffix}",
            **row.axis,
        }
        merged[f"yaxis{suffix}"] = {
            "title": {"text": row.panel.label},
            "domain": (max(upper - height, 0.0) / total, top),
            "anchor": f"x{suffix}",
            **row.panel.axis,
        }
        merged[f"legend{suffix}"] = {"x": 1.01, "xanchor": "left", "y": top, "yanchor": "top"}
        place = {"xaxis": f"x{suffix}", "yaxis": f"y{suffix}", "legend": f"legend{suffix}"}
        several = len(row.panel.traces) > 1
        traces += [{"showlegend": several, **trace, **place} for trace in row.panel.traces]
        lines, names = _marks(row, suffix)
        shapes, notes = shapes + lines, notes + names
        upper -= height + _GAP
    return figure(title, traces, {**merged, "shapes": shapes, "annotations": notes, **more})
