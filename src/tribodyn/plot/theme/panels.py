"""Stacked panels over a common axis or one axis each, and curves of quantities in them."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import Any

import numpy as np

from tribodyn.drawing import Sketch
from tribodyn.plot.theme.colors import MUTED
from tribodyn.plot.theme.labels import axis_label, display_unit, displayed
from tribodyn.plot.theme.style import BOTTOM, TOP, Trace, axis, figure, line, note
from tribodyn.types import Array, Index

#: Pixels of one panel, of the gap between panels, and of the gap with an axis and a title in it.
_PANEL, _GAP, _WIDE_GAP = 230, 34, 84
#: Width of a character relative to the axis on a narrow screen, and height of a level [px].
_CHARACTER, _LEVEL = 0.015, 14
#: Variation over the size of values that is rounding, half of the axis of such values over their
#: size, and distance of two curves over the height of a panel that nobody sees.
ROUNDING, _FLAT, _COVERED = 1e-9, 0.01, 2e-3
#: Curves that a note about coincident ones names.
_NOTED = 3


@dataclass(frozen=True)
class Panel:
    """One panel of a figure."""

    label: str  #: label of the vertical axis, with its unit
    traces: Sequence[Trace]  #: curves as :func:`line` returns them
    axis: Trace = field(default_factory=dict)  #: further properties of the vertical axis
    height: float = 1.0  #: height relative to the other panels
    size: float = 0.0  #: of the values that cancel in the curves, in their unit
    note: str = ""  #: text above the panel

    def with_axes(self, x: str, suffix: str) -> list[Trace]:
        """Assign the curves to their axes; a single curve has no legend entry."""
        place = {"xaxis": x, "yaxis": f"y{suffix}", "legend": f"legend{suffix}"}
        several = len(self.traces) > 1
        return [{"showlegend": several, **trace, **place} for trace in self.traces]

    def notes(self, top: float) -> list[Trace]:
        """Text above the panel, and a note of curves that nobody sees, as they lie on others."""
        hidden = _covered(self.traces)
        texts = [f"{name} lies on {first}" for name, first in list(hidden.items())[:_NOTED]]
        texts += [f"{len(hidden) - _NOTED} more coincide"] * (len(hidden) > _NOTED)
        places = ((self.note, 0.0, "left", "bottom"), ("; ".join(texts), 1.0, "right", "top"))
        style = Trace(color=MUTED, xref="paper", yref="paper")
        return [
            note(x, top, text, xanchor=side, yanchor=end, **style)
            for text, x, side, end in places
            if text
        ]

    @property
    def vertical(self) -> Trace:
        """Properties of the vertical axis; rounding does not fill it."""
        values = np.concatenate([np.ravel(y) for y in map(_heights, self.traces)] or [np.zeros(0)])
        values = values[np.isfinite(values)]
        if not values.size or {"range", "type"} & self.axis.keys():
            return self.axis
        low, high = float(values.min()), float(values.max())
        size = max(abs(low), abs(high), self.size)
        if high - low > ROUNDING * size or size == 0.0:
            return self.axis
        middle = 0.5 * (low + high)
        return {**self.axis, "range": [middle - _FLAT * size, middle + _FLAT * size]}


def _heights(trace: Trace) -> Array:
    """Vertical values of a curve; none of other traces."""
    if trace.get("type") != "scatter" or "lines" not in trace.get("mode", ""):
        return np.zeros(0)
    values = np.asarray(trace["y"])
    return np.zeros(0) if values.dtype.kind in "US" else values.astype(float)


def _covered(traces: Sequence[Trace]) -> dict[str, str]:
    """Names of curves that lie on one before them, and the name of that."""
    curves = [(np.asarray(t.get("x")), _heights(t), t.get("name")) for t in traces]
    spans = [np.ptp(y[np.isfinite(y)]) for _, y, _ in curves if np.isfinite(y).any()]
    tolerance, covered = _COVERED * max(spans, default=0.0), dict[str, str]()
    for number, (x, y, name) in enumerate(curves):
        for x0, y0, first in curves[:number]:
            same = y.size > 1 and y.shape == y0.shape and first not in covered
            if same and name and first and name != first and np.array_equal(x, x0):
                distance = np.abs(y - y0)
                if np.isfinite(distance).any() and np.nanmax(distance) <= tolerance:
                    covered[name] = first
                    break
    return covered


def from_zero(label: str, traces: Sequence[Trace], height: float = 1.0) -> Panel:
    """Panel whose vertical axis begins at zero."""
    return Panel(label, traces, {"rangemode": "tozero"}, height)


@dataclass(frozen=True)
class Row:
    """A panel with its own horizontal axis."""

    label: str  #: label of the horizontal axis, with its unit
    panel: Panel  #: curves and vertical axis
    axis: Trace = field(default_factory=dict)  #: further properties of the horizontal axis
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


def _stacked(
    panels: Sequence[Panel], gap: int, alone: bool
) -> tuple[list[Trace], Trace, list[Trace]]:
    """Traces, layout and notes of stacked panels; ``alone`` with a horizontal axis each."""
    domains, height = _domains(panels, gap)
    traces, layout, notes = list[Trace](), Trace(height=height), list[Trace]()
    for number, (panel, domain) in enumerate(zip(panels, domains, strict=True)):
        suffix = _suffix(number)
        anchor = {"anchor": f"x{suffix}"} if alone else {}
        layout[f"yaxis{suffix}"] = {**axis(panel.label, domain=domain, **anchor), **panel.vertical}
        layout[f"legend{suffix}"] = {"x": 1.01, "xanchor": "left", "y": domain[1],
                                     "yanchor": "top", "tracegroupgap": 2}  # fmt: skip
        traces += panel.with_axes(f"x{suffix}" if alone else "x", suffix)
        notes += panel.notes(domain[1])
    return traces, layout, notes


def stack(title: str, x_label: str, panels: Sequence[Panel], layout: Trace | None = None) -> Sketch:
    """Stack panels over one common horizontal axis, each with a legend to its right."""
    more, (traces, merged, notes) = dict(layout or {}), _stacked(panels, _GAP, alone=False)
    x_axis = axis(x_label, anchor=f"y{_suffix(len(panels) - 1)}")
    merged["xaxis"] = {**x_axis, **more.pop("xaxis", {})}
    notes = [*more.pop("annotations", ()), *notes]
    return figure(title, traces, {**merged, **({"annotations": notes} if notes else {}), **more})


def stack_rows(title: str, rows: Sequence[Row], layout: Trace | None = None) -> Sketch:
    """Stack panels, each over its own horizontal axis and with its own legend."""
    more = dict(layout or {})
    traces, merged, notes = _stacked([row.panel for row in rows], _WIDE_GAP, alone=True)
    shapes, notes = list(more.pop("shapes", ())), [*more.pop("annotations", ()), *notes]
    for number, row in enumerate(rows):
        suffix, marks = _suffix(number), event_lines(row.marks)
        merged[f"xaxis{suffix}"] = {**axis(row.label, anchor=f"y{suffix}"), **row.axis}
        place = {"xref": f"x{suffix}", "yref": f"y{suffix} domain"}
        shapes += [{**shape, **place} for shape in marks["shapes"]]
        notes += [{**mark, **place} for mark in marks["annotations"]]
    return figure(title, traces, {**merged, "shapes": shapes, "annotations": notes, **more})


def event_lines(places: Iterable[tuple[str, float]], share: float = 1.0) -> Trace:
    """Mark positions on the horizontal axis by dotted lines with a short name on top.

    ``share`` is the fraction of the figure's width that the axis takes.
    """
    joined: dict[float, list[str]] = {}
    for name, x in places:
        joined.setdefault(round(float(x), 9), []).append(name)
    common = {"yref": "paper", "xref": "x"}
    line = {"color": MUTED, "width": 1, "dash": "dot"}
    upright = {"type": "line", "y0": 0, "y1": 1, "layer": "below", **common}
    shapes = [{**upright, "x0": x, "x1": x, "line": line} for x in joined]
    names = {x: ", ".join(joined[x]) for x in sorted(joined)}
    above = Trace(yanchor="bottom", color=MUTED, **common)
    notes = [
        note(x, 1, names[x], yshift=_LEVEL * level, **above)
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


#: Axes that begin at zero, and that mark their zero.
FROM_ZERO, ZERO = {"rangemode": "tozero"}, {"zeroline": True}


def curve(quantity: str, x: Any, values: Any, name: str, color: str, **style: Any) -> Trace:
    """Curve of SI values of a quantity in its display unit."""
    return line(x, displayed(quantity, values), name, color, unit=display_unit(quantity), **style)


def curves(
    quantity: str,
    label: str | None,
    x: object,
    rows: Iterable[tuple[Any, ...]],
    axis: Trace | None = None,
    height: float = 1.0,
    **style: object,
) -> Panel:
    """Panel with curves of a quantity over one axis; each row has name, values, colour, dash."""
    traces = [
        curve(quantity, x, values, name, color, dash=dash[0] if dash else "solid", **style)
        for name, values, color, *dash in rows
    ]
    return Panel(axis_label(quantity, label), traces, axis or {}, height)


def extremes(values: Array, most: int) -> Index:
    """Indices of the minimum and maximum of every group of samples, about ``most`` of them."""
    if values.size <= most:
        return np.arange(values.size)
    starts = np.arange(0, values.size, -(-2 * values.size // most))
    parts = np.split(values, starts[1:])
    ends = [(a + np.argmin(p), a + np.argmax(p)) for a, p in zip(starts, parts, strict=True)]
    return np.unique(np.array(ends).ravel())
