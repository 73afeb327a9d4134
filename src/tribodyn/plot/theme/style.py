"""Style of all figures: fonts, grids, curves, bars, maps, buttons."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from tribodyn.drawing import Sketch
from tribodyn.plot.theme.colors import GRID, INK, MUTED
from tribodyn.types import Array, Tree

#: Part of a figure, such as a curve or an axis, as plotly describes it.
Trace = Tree

FONT = "system-ui, -apple-system, 'Segoe UI', Roboto, 'Helvetica Neue', Arial, sans-serif"
#: Axis that marks its zero, one without a grid, and that of powers of ten; legend on top.
GREY_ZERO = {"zeroline": True, "zerolinecolor": "#c5ccd3"}
BARE = {"zeroline": False, "showgrid": False}
POWERS = {"type": "log", "exponentformat": "power"}
ABOVE = {"orientation": "h", "x": 0.0, "y": 1.0, "yanchor": "bottom"}
#: Pixels above and below the panels of a figure.
TOP, BOTTOM = 74, 58
#: The line that follows the pointer, and the number that it points at.
_SPIKE = {"spikecolor": MUTED, "spikethickness": 1, "spikedash": "solid", "hoverformat": ".4g"}


def _axis(**more: object) -> Trace:
    return {
        "gridcolor": GRID,
        "linecolor": MUTED,
        "showline": True,
        "ticks": "outside",
        "ticklen": 4,
        "tickcolor": MUTED,
        "zeroline": False,
        "automargin": True,
        "exponentformat": "none",
        "title": {"standoff": 10, "font": {"size": 13, "color": MUTED}},
        **more,
    }


def figure(title: str, traces: Sequence[Trace], layout: Trace | None = None) -> Sketch:
    """Describe a figure in the style of the package."""
    common: Trace = {
        "template": {"layout": {"xaxis": _axis(**_SPIKE), "yaxis": _axis()}},
        "title": {
            "text": title,
            "x": 0.0,
            "xref": "container",
            "y": 1.0,
            "yref": "container",
            "yanchor": "top",
            "pad": {"t": 12},
            "font": {"size": 17, "color": INK},
        },
        "font": {"family": FONT, "size": 13, "color": INK},
        "paper_bgcolor": "white",
        "plot_bgcolor": "white",
        "hovermode": "x unified",
        "hoverlabel": {"bgcolor": "white", "bordercolor": GRID, "font": {"family": FONT}},
        "margin": {"l": 70, "r": 24, "t": TOP, "b": BOTTOM},
    }
    return Sketch(list(traces), {**common, **(layout or {})})


def axis(label: str, **more: object) -> Trace:
    """Axis with a label; ``more`` are properties of plotly."""
    return {"title": {"text": label}, **more}


def note(
    x: object, y: object, text: str, *, size: int = 12, color: str = INK, **more: object
) -> Trace:
    """Text at a point; ``more`` are properties of plotly."""
    font = {"size": size, "color": color}
    return {"x": x, "y": y, "text": text, "showarrow": False, "font": font, **more}


def button_row(choices: Sequence[tuple[str, Trace]]) -> Trace:
    """Describe buttons above the left end of the panels, clear of plotly's mode bar."""
    return {
        "type": "buttons",
        "direction": "right",
        "buttons": [
            {"label": label, "method": "relayout", "args": [change]} for label, change in choices
        ],
        "x": 0.0,
        "xanchor": "left",
        "y": 1.0,
        "yanchor": "bottom",
        "pad": {"b": 6},
        "showactive": True,
        "bgcolor": "white",
        "font": {"size": 12},
    }


def plane_figure(
    title: str, traces: Sequence[Trace], x: Trace, y: Trace, **layout: object
) -> Sketch:
    """Describe a figure of one plane; ``x`` and ``y`` are its axes."""
    return figure(title, traces, {"hovermode": "closest", "xaxis": x, "yaxis": y, **layout})


def choice(
    labels: Sequence[str], titles: Sequence[str], visible: Sequence[list[bool]], first: int
) -> Trace:
    """Describe a menu; each entry shows its title and some of the traces."""
    entries = [
        {"label": label, "method": "update", "args": [{"visible": flags}, {"title.text": title}]}
        for label, title, flags in zip(labels, titles, visible, strict=True)
    ]
    place = {"x": 1.0, "xanchor": "right", "y": 1.12, "yanchor": "top", "bgcolor": "white"}
    return {"buttons": entries, "active": first, **place}


#: Points of a curve up to which each of them is drawn.
_MOST_POINTS = 20_000


def line(
    x: Any,
    y: object,
    name: str,
    color: str,
    *,
    unit: str = "",
    dash: str = "solid",
    width: float = 2.0,
    **more: object,
) -> Trace:
    """Describe one curve whose hover text carries its unit; ``more`` are properties of plotly."""
    # plotly leaves points out by default, which draws smooth curves as polygons.
    every = {"simplify": False} if len(x) <= _MOST_POINTS else {}
    return {
        "type": "scatter",
        "mode": "lines",
        "x": x,
        "y": y,
        "name": name,
        "line": {"color": color, "dash": dash, "width": width, **every},
        "hovertemplate": f"%{{y:.4g}} {unit}".rstrip() + f"<extra>{name}</extra>",
        **more,
    }


def between(
    x: object, low: object, high: object, name: str, fill: str, **more: object
) -> list[Trace]:
    """Fill between two curves; ``more`` are properties of the filled one."""
    edge = {"type": "scatter", "mode": "lines", "line": {"width": 0}, "hoverinfo": "skip", "x": x}
    lower = {**edge, "y": low, "showlegend": False, "name": name}
    return [lower, {**edge, "y": high, "fill": "tonexty", "fillcolor": fill, "name": name, **more}]


def strokes(x: object, y: object, color: str, width: float = 1.2, **more: object) -> Trace:
    """Describe lines without a hover text; ``more`` are properties of plotly."""
    style = {"line": {"color": color, "width": width}, "hoverinfo": "skip"}
    return {"type": "scatter", "mode": "lines", "x": x, "y": y, **style, **more}


def dots(x: object, y: object, name: str, marker: Trace, **more: object) -> Trace:
    """Describe points by the properties of their marker."""
    points = {"type": "scatter", "mode": "markers", "x": x, "y": y}
    return {**points, "name": name, "marker": marker, **more}


def bars(x: object, y: object, name: str, color: object, hover: str, **more: object) -> Trace:
    """Describe bars; ``hover`` is the template of their hover text."""
    marker = color if isinstance(color, dict) else {"color": color}
    return {"type": "bar", "x": x, "y": y, "name": name, "marker": marker,
            "hovertemplate": hover, **more}  # fmt: skip


def heat(x: object, y: object, z: object, colors: object, hover: str, **more: object) -> Trace:
    """Describe a map of values; ``hover`` is the template of its hover text."""
    return {"type": "heatmap", "x": x, "y": y, "z": z, "colorscale": colors,
            "hovertemplate": f"{hover}<extra></extra>", "showlegend": False, **more}  # fmt: skip


def contour(
    x: object, y: object, z: object, colors: object, hover: str, unit: str, length: float
) -> Trace:
    """Describe a map with labelled lines of equal values, and a colour bar of that length."""
    levels = {"showlabels": True, "labelfont": {"size": 10, "color": INK}}
    style = {"ncontours": 16, "contours": levels, "line": {"width": 0.6, "color": MUTED}}
    bar = {**color_bar(""), "title": {"text": f"[{unit}]"}, "len": length}
    return {**heat(x, y, z, colors, hover, colorbar=bar), "type": "contour", **style}


def over_map(cells: Trace, levels: Trace, width: float, name: str) -> Trace:
    """Describe lines of equal values over a map of them."""
    lines = {"type": "contour", "contours": levels, "line": {"color": INK, "width": width}}
    plain = {"showscale": False, "showlegend": False, "hoverinfo": "skip", "name": name}
    return {**{key: cells[key] for key in ("x", "y", "z")}, **lines, **plain}


def sankey(
    links: Iterable[tuple[int, int, float, str]], hover: str, node_hover: str, **node: object
) -> Trace:
    """Describe flows (source, target, value, colour) between nodes with these properties."""
    columns = zip(("source", "target", "value", "color"), zip(*links, strict=True), strict=True)
    flows = {**dict(columns), "hovertemplate": f"{hover}<extra></extra>"}
    nodes = {"hovertemplate": f"{node_hover}<extra></extra>", **node}
    return {"type": "sankey", "arrangement": "snap", "node": nodes, "link": flows}


def color_bar(title: str) -> Trace:
    """Colour bar to the right of the map at the top of a figure."""
    place = {"len": 0.62, "y": 1.0, "yanchor": "top", "thickness": 14, "x": 1.01, "xanchor": "left"}
    return {**place, "title": {"text": title, "side": "top", "font": {"size": 13, "color": MUTED}}}


def stems(x: Array, y: Array, foot: float = 0.0) -> tuple[Array, Array]:
    """Points of vertical lines from a foot up to each value, with gaps between them."""
    gap = np.full(len(x), np.nan)
    feet = np.full(len(x), foot)
    return np.stack((x, x, gap), axis=1).ravel(), np.stack((feet, y, gap), axis=1).ravel()


def animated(
    sketch: Sketch, frames: Iterable[list[Trace]], moving: Sequence[int] | None = None
) -> Sketch:
    """Add frames named 0, 1, ... to a figure, with the numbers of the traces that they replace."""
    which = {} if moving is None else {"traces": moving}
    sketch.frames = [{"name": str(k), "data": data, **which} for k, data in enumerate(frames)]
    return sketch


def player(
    labels: Sequence[str], milliseconds: int, *, redraw: bool, slider: Trace, buttons: float
) -> Trace:
    """Slider over :func:`animated` frames with a label each, and buttons that play them.

    ``slider`` places the slider, ``buttons`` is the height of the buttons.
    """
    at_once = {"duration": 0}
    still = {"frame": {"duration": 0, "redraw": redraw}, "mode": "immediate", "transition": at_once}
    animated = {"frame": {"duration": milliseconds, "redraw": redraw}, "transition": at_once}
    run = {"label": "play", "method": "animate", "args": [None, {**animated, "fromcurrent": True}]}
    steps = [
        {"label": label, "method": "animate", "args": [[str(number)], still]}
        for number, label in enumerate(labels)
    ]
    bar = {
        "yanchor": "top",
        "ticklen": 3,
        "font": {"color": "rgba(0,0,0,0)", "size": 1},
        "currentvalue": {"font": {"color": INK, "size": 13}, "xanchor": "left"},
        "steps": steps,
    }
    menu = {
        "type": "buttons",
        "direction": "right",
        "showactive": False,
        "x": 0.0,
        "xanchor": "left",
        "y": buttons,
        "yanchor": "top",
        "bgcolor": "white",
        "font": {"size": 12},
        "buttons": [run, {"label": "pause", "method": "animate", "args": [[None], still]}],
    }
    return {"sliders": [{**slider, **bar}], "updatemenus": [menu]}


def marked(
    x: Any, y: Any, name: str, color: str, size: float, symbol: str = "circle", **more: Any
) -> Trace:
    """Describe marked points whose hover text carries their ``unit``."""
    marker = {"size": size, "symbol": symbol, "color": color}
    points = line(x, y, name, color, mode="markers", marker=marker, **more)
    del points["line"]
    return points
