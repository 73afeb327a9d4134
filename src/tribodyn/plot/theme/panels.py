"""Vertically stacked panels with one common horizontal axis or one axis each."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

from tribodyn.drawing import Sketch
from tribodyn.plot.theme.style import BOTTOM, MUTED, TOP, Trace, figure

#: Pixels of one panel, of the gap between panels, and of the gap with an axis and a title in it.
_PANEL, _GAP, _WIDE_GAP = 230, 34, 84
#: Width of a character relative to the axis on a narrow screen, and height of a level [px].
_CHARACTER, _LEVEL = 0.015, 14


@dataclass(frozen=True)
class Panel:
    """One panel of a figure."""

    label: str  #: label of the vertical axis, with its unit
    traces: Sequence[Trace]  #: curves as :func:`line` returns them
    axis: dict[str, Any] = field(default_factory=dict)  #: further properties of the vertical axis
    height: float = 1.0  #: height relative to the other panels

    def with_axes(self, x: str, suffix: str) -> list[Trace]:
        """Assign the curves to their axes; a single curve has no legend entry."""
        place = {"xaxis": x, "yaxis": f"y{suffix}", "legend": f"legend{suffix}"}
        several = len(self.traces) > 1
        return [{"showlegend": several, **trace, **place} for trace in self.traces]


def from_zero(label: str, traces: Sequence[Trace], height: float = 1.0) -> Panel:
    """Panel whose vertical axis begins at zero."""
    return Panel(label, traces, {"rangemode": "tozero"}, height)


@dataclass(frozen=True)
class Row:
    """A panel with its own horizontal axis."""

    label: str  #: label of the horizontal axis, with its unit
    panel: Panel  #: curves and vertical axis
    axis: dict[str, Any] = field(default_factory=dict)  #: further properties of the horizontal axis
    marks: Iterable[tuple[str, float]] = ()  #: names and positions of vertical event lines


def _domains(panels: Sequence[Panel], gap: int) -> tuple[list[tuple[float, float]], float]:
    """Vertical domain of each panel from the top down, and the height of the figure [px]."""
    heights = [_PANEL * panel.height for panel in panels]
    total = sum(heights) + gap * (len(panels) - 1)
    domains, upper = [], total
    for height in heights:
        domains.append((max(upper - height, 0.0) / total, upper / total))
        upper -= height + gap
    return domains, total + TOP + BOTTOM


def _suffix(number: int) -> str:
    """Suffix of plotly's axis names for a panel; panels count from 0."""
    return str(number + 1) if number else ""


def stack(
    title: str, x_label: str, panels: Sequence[Panel], layout: dict[str, Any] | None = None
) -> Sketch:
    """Stack panels over one common horizontal axis, each with a legend to its right."""
    more = dict(layout or {})
    domains, height = _domains(panels, _GAP)
    x_axis = {"title": {"text": x_label}, "anchor": f"y{_suffix(len(panels) - 1)}"}
    merged: dict[str, Any] = {"xaxis": {**x_axis, **more.pop("xaxis", {})}, "height": height}
    traces: list[Trace] = []
    for number, (panel, domain) in enumerate(zip(panels, domains, strict=True)):
        suffix = _suffix(number)
        y_axis = {"title": {"text": panel.label}, "domain": domain}
        merged[f"yaxis{suffix}"] = {**y_axis, **panel.axis}
        merged[f"legend{suffix}"] = {**_legend(domain[1]), "tracegroupgap": 2}
        traces += panel.with_axes("x", suffix)
    return figure(title, traces, {**merged, **more})


def stack_rows(title: str, rows: Sequence[Row], layout: dict[str, Any] | None = None) -> Sketch:
    """Stack panels, each over its own horizontal axis and with its own legend."""
    more = dict(layout or {})
    domains, height = _domains([row.panel for row in rows], _WIDE_GAP)
    merged: dict[str, Any] = {"height": height, "hovermode": "x unified"}
    shapes, notes = list(more.pop("shapes", ())), list(more.pop("annotations", ()))
    traces: list[Trace] = []
    for number, (row, domain) in enumerate(zip(rows, domains, strict=True)):
        suffix = _suffix(number)
        x_axis = {"title": {"text": row.label}, "anchor": f"y{suffix}"}
        y_axis = {"title": {"text": row.panel.label}, "domain": domain, "anchor": f"x{suffix}"}
        merged[f"xaxis{suffix}"] = {**x_axis, **row.axis}
        merged[f"yaxis{suffix}"] = {**y_axis, **row.panel.axis}
        merged[f"legend{suffix}"] = _legend(domain[1])
        traces += row.panel.with_axes(f"x{suffix}", suffix)
        marks = event_lines(row.marks)
        place = {"xref": f"x{suffix}", "yref": f"y{suffix} domain"}
        shapes += [{**shape, **place} for shape in marks["shapes"]]
        notes += [{**note, **place} for note in marks["annotations"]]
    return figure(title, traces, {**merged, "shapes": shapes, "annotations": notes, **more})


def _legend(top: float) -> dict[str, Any]:
    return {"x": 1.01, "xanchor": "left", "y": top, "yanchor": "top"}


def event_lines(places: Iterable[tuple[str, float]], share: float = 1.0) -> dict[str, Any]:
    """Mark positions on the horizontal axis by dotted lines with a short name on top.

    ``share`` is the fraction of the figure's width that the axis takes.
    """
    joined: dict[float, list[str]] = {}
    for name, x in places:
        joined.setdefault(round(float(x), 9), []).append(name)
    common = {"yref": "paper", "xref": "x"}
    line = {"color": MUTED, "width": 1, "dash": "dot"}
    shapes = [
        {"type": "line", "x0": x, "x1": x, "y0": 0, "y1": 1, "layer": "below", "line": line}
        | common
        for x in joined
    ]
    names = {x: ", ".join(joined[x]) for x in sorted(joined)}
    font = {"size": 12, "color": MUTED}
    notes = [
        {"x": x, "y": 1, "yanchor": "bottom", "yshift": _LEVEL * level, "text": names[x]}
        | {"showarrow": False, "font": font, **common}
        for x, level in zip(names, _levels(names, share), strict=True)
    ]
    return {"shapes": shapes, "annotations": notes}


def _levels(names: dict[float, str], share: float) -> list[int]:
    """Raise a name by one level where it would overlap its left neighbour."""
    span = (max(names, default=0.0) - min(names, default=0.0)) / share
    levels = [0] * bool(names)
    for (left, first), (right, second) in pairwise(names.items()):
        needed = _CHARACTER * (1 + 0.5 * (len(first) + len(second))) * span
        levels.append(0 if right - left > needed or levels[-1] else 1)
    return levels
