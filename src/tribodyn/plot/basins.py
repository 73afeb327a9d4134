"""Basins of attraction: a plane of starts, coloured by the motion that they come to."""

from __future__ import annotations

from typing import Any

import numpy as np

from tribodyn.drawing import drawing
from tribodyn.plot.labels import significant
from tribodyn.plot.scaled import parameter_axis, scaled, unit_of
from tribodyn.plot.style import PAIR_COLORS, PINION, WHEEL, figure

#: Colours of the attractors in the order of their shares; more of them begin anew.
_COLORS = (PINION, PAIR_COLORS[3], PAIR_COLORS[0], PAIR_COLORS[1], PAIR_COLORS[2], WHEEL)
_NOWHERE = "#d5dae0"


def _missing(result: Any) -> str:
    if hasattr(result, "attractors"):
        return ""
    return "This figure shows a plane of starts. Call tribodyn.analysis.basins(...) and its plot."


def _name(found: Any, number: int, factor: float, unit: str) -> str:
    each = found.attractors[number]
    kind = f"period {each.period}" if each.period else "does not repeat"
    size = significant(factor * each.rms)
    return f"{kind}, rms {size} {unit}: {100.0 * each.share:.1f} %"


def _plane(found: Any, x: Any, y: Any) -> dict[str, Any]:
    """Heat map of the numbers of the attractors, in steps of one colour each."""
    count = len(found.attractors)
    colors = [_NOWHERE, *(_COLORS[n % len(_COLORS)] for n in range(count))]
    edges = np.linspace(0.0, 1.0, len(colors) + 1)
    scale = [[float(e), c] for n, c in enumerate(colors) for e in edges[n : n + 2]]
    words = ["no attractor", *(f"attractor {n + 1}" for n in range(count))]
    label = np.clip(found.attractor, -1, None).T
    return {
        "type": "heatmap",
        "x": x,
        "y": y,
        "z": label,
        "zmin": -1.5,
        "zmax": count - 0.5,
        "colorscale": scale,
        "showscale": False,
        "opacity": 0.85,
        "text": np.array(words)[label + 1],
        "hovertemplate": "%{x:.4g}, %{y:.4g}: %{text}<extra></extra>",
        "showlegend": False,
    }


def _component(found: Any, number: int, name: str) -> Any:
    """Component of the states of an attractor; ``found`` has names of coordinates only."""
    each = found.attractors[number]
    base, velocity = name.removesuffix("_velocity"), name.endswith("_velocity")
    column = found.names.index(base)
    return (each.velocity if velocity else each.position)[:, column]


@drawing(
    "basins",
    heading="Basins of attraction",
    caption="Every start of the plane has the colour of the motion that it comes to; crosses "
    "are the states of these motions at the mesh phase 0. Where colours mix finely, the motion "
    "cannot be foretold from the start.",
    needs=_missing,
)
def basins(found: Any) -> Any:
    """Draw the plane of starts.

    Parameters
    ----------
    found : Basins
        What :func:`tribodyn.analysis.basins` returns.

    Returns
    -------
    plotly.graph_objects.Figure
    """
    one, two = found.coordinates
    x, x_label = parameter_axis(one, found.first, found.units[0])
    y, y_label = parameter_axis(two, found.second, found.units[1])
    factors = [
        float(d[-1] / v[-1]) if v[-1] else 1.0 for d, v in ((x, found.first), (y, found.second))
    ]
    factor, unit = scaled([each.rms for each in found.attractors], unit_of(found.signal))
    traces = [_plane(found, x, y)]
    for number in range(len(found.attractors)):
        color = _COLORS[number % len(_COLORS)]
        traces.append({
            "type": "scatter", "mode": "markers",
            "x": factors[0] * _component(found, number, one),
            "y": factors[1] * _component(found, number, two),
            "name": _name(found, number, factor, unit),
            "marker": {
                "symbol": "x", "size": 11, "color": color,
                "line": {"color": "white", "width": 1.5},
            },
        })  # fmt: skip
    if found.unresolved:
        words = f"no attractor: {100.0 * found.unresolved:.2g} %"
        traces.append({
            "type": "scatter", "mode": "markers", "x": [None], "y": [None], "name": words,
            "marker": {"symbol": "square", "size": 11, "color": _NOWHERE},
        })  # fmt: skip
    layout = {
        "xaxis": {"title": {"text": x_label}, "range": [float(x[0]), float(x[-1])]},
        "yaxis": {"title": {"text": y_label}, "range": [float(y[0]), float(y[-1])]},
        "hovermode": "closest",
        "height": 620,
        "legend": {"orientation": "h", "x": 0.0, "y": -0.14, "yanchor": "top"},
    }  # fmt: skip
    return figure(_title(found), traces, layout)


def _title(found: Any) -> str:
    count = len(found.attractors)
    if not count:
        return "No start comes to a motion that repeats"
    if count == 1:
        return "All starts come to the same motion"
    first = found.attractors[0]
    factor, unit = scaled([each.rms for each in found.attractors], unit_of(found.signal))
    return (
        f"{count} motions are possible; {100.0 * first.share:.0f} % of the starts come to the one "
        f"of {significant(factor * first.rms)} {unit} rms"
    )
