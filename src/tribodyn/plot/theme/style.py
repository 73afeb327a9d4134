"""Style of all figures: colours with fixed roles, fonts, grids, curves, bars, maps, buttons.

The colours are those of Okabe and Ito, which remain distinguishable under the
common forms of colour blindness; curves that share a panel differ in dash as well.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from tribodyn.drawing import Sketch
from tribodyn.types import Array

#: One curve as plotly describes it.
Trace = dict[str, Any]

FONT = "system-ui, -apple-system, 'Segoe UI', Roboto, 'Helvetica Neue', Arial, sans-serif"
INK = "#1f2933"
MUTED = "#6b7785"
GRID = "#e4e8ec"
#: Axis that marks its zero.
GREY_ZERO = {"zeroline": True, "zerolinecolor": "#c5ccd3"}
#: Fixed roles, so that a colour means the same thing in every figure.
PINION = "#0072B2"
WHEEL = "#D55E00"
TOTAL = INK
PAIR_COLORS = ("#009E73", "#CC79A7", "#56B4E9", "#E69F00")
#: Colours of maps of values, from the smallest to the largest.
HEAT = [[0.0, "#f2f6fa"], [0.5, "#56B4E9"], [0.75, PINION], [1.0, WHEEL]]
#: Light fill that goes with a line colour.
FILLS = {PINION: "rgba(0, 114, 178, 0.14)", WHEEL: "rgba(213, 94, 0, 0.14)"}
#: Pixels above and below the panels of a figure.
TOP, BOTTOM = 74, 58
#: The line that follows the pointer, and the number that it points at.
_SPIKE = {"spikecolor": MUTED, "spikethickness": 1, "spikedash": "solid", "hoverformat": ".4g"}


def _axis(**more: Any) -> dict[str, Any]:
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


def figure(
    title: str, traces: Sequence[dict[str, Any]], layout: dict[str, Any] | None = None
) -> Sketch:
    """Describe a figure in the style of the package."""
    common: dict[str, Any] = {
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


def button_row(choices: Sequence[tuple[str, dict[str, Any]]]) -> dict[str, Any]:
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


#: Points of a curve up to which each of them is drawn.
_MOST_POINTS = 20_000


def line(
    x: Any,
    y: Any,
    name: str,
    color: str,
    *,
    unit: str = "",
    dash: str = "solid",
    width: float = 2.0,
    **more: Any,
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


def between(x: Any, low: Any, high: Any, name: str, fill: str, **more: Any) -> list[Trace]:
    """Fill between two curves; ``more`` are properties of the filled one."""
    edge = {"type": "scatter", "mode": "lines", "line": {"width": 0}, "hoverinfo": "skip", "x": x}
    lower = {**edge, "y": low, "showlegend": False, "name": name}
    return [lower, {**edge, "y": high, "fill": "tonexty", "fillcolor": fill, "name": name, **more}]


def bars(x: Any, y: Any, name: str, color: Any, hover: str, **more: Any) -> Trace:
    """Describe bars; ``hover`` is the template of their hover text."""
    marker = color if isinstance(color, dict) else {"color": color}
    return {"type": "bar", "x": x, "y": y, "name": name, "marker": marker,
            "hovertemplate": hover, **more}  # fmt: skip


def heat(x: Any, y: Any, z: Any, colors: Any, hover: str, **more: Any) -> Trace:
    """Describe a map of values; ``hover`` is the template of its hover text."""
    return {"type": "heatmap", "x": x, "y": y, "z": z, "colorscale": colors,
            "hovertemplate": f"{hover}<extra></extra>", "showlegend": False, **more}  # fmt: skip


def color_bar(title: str) -> dict[str, Any]:
    """Colour bar beside the map at the top of a figure."""
    place = {"len": 0.62, "y": 1.0, "yanchor": "top", "thickness": 14, "x": 1.01, "xanchor": "left"}
    return {**place, "title": {"text": title, "side": "top", "font": {"size": 13, "color": MUTED}}}


def stems(x: Array, y: Array, foot: float = 0.0) -> tuple[Array, Array]:
    """Points of vertical lines from a foot up to each value, with gaps between them."""
    gap = np.full(len(x), np.nan)
    feet = np.full(len(x), foot)
    return np.stack((x, x, gap), axis=1).ravel(), np.stack((feet, y, gap), axis=1).ravel()


def translucent(color: str, opacity: float) -> str:
    """Return a colour with an opacity between 0 and 1."""
    red, green, blue = (int(color[place : place + 2], 16) for place in (1, 3, 5))
    return f"rgba({red}, {green}, {blue}, {opacity})"


def player(
    labels: Sequence[str],
    milliseconds: int,
    *,
    redraw: bool,
    slider: dict[str, Any],
    buttons: float,
) -> dict[str, Any]:
    """Slider over frames named 0, 1, ... with a label each, and buttons that play them.

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
    x: Any, y: Any, name: str, color: str, *, size: float, symbol: str, unit: str = "", **more: Any
) -> Trace:
    """Describe marked points whose hover text carries their unit."""
    marker = {"size": size, "symbol": symbol, "color": color}
    points = line(x, y, name, color, unit=unit, mode="markers", marker=marker, **more)
    del points["line"]
    return points
