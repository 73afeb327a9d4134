"""Sobol indices, confidence band of a mean curve, and columns of computed data."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.drawing import drawing
from tribodyn.errors import Argument, InputError, did_you_mean
from tribodyn.plot.theme.labels import readable, scaled, significant
from tribodyn.plot.theme.panels import Panel, stack
from tribodyn.plot.theme.style import FILLS, PINION, TOTAL, WHEEL, Trace, figure, line, marked
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.study import DataSet
    from tribodyn.uncertainty import Band, SobolIndices

#: Panels of a table, and points of one.
_PANELS, _POINTS = 8, 3000


@drawing(
    "sobol_indices",
    heading="Contribution of each input to the variance",
    caption="Shares of the variance of the output. The first-order index is the share of an input "
    "alone, the total-order index the share that would vanish if the input were fixed, with all "
    "its interactions. Where the total exceeds the first order, the input interacts with others. "
    "Shares slightly below zero or above 100 % are the sampling error of the estimate.",
    of="SobolIndices",
    made_by="Call tribodyn.uncertainty.sobol_indices(function, distributions, seed=1) and its "
    "plot method.",
)
def sobol_indices(indices: SobolIndices) -> Any:
    """Draw first-order and total shares of every input as bars, the largest on top."""
    order = np.argsort(indices.total_order)
    names = [str(indices.name[k]) for k in order]
    traces = [
        {
            "type": "bar",
            "orientation": "h",
            "x": 100.0 * values[order],
            "y": names,
            "name": label,
            "marker": {"color": color},
            "hovertemplate": f"%{{y}}, {label}: %{{x:.3g}} %<extra></extra>",
        }
        for label, values, color in (
            ("total order", indices.total_order, WHEEL),
            ("first order", indices.first_order, PINION),
        )
    ]
    top = order[-1]
    title = (
        f"{significant(100.0 * float(indices.first_order[top]))} % of the variance comes from "
        f"{indices.name[top]} alone, {significant(100.0 * float(indices.total_order[top]))} % "
        "with its interactions"
    )
    return figure(
        title,
        traces,
        {
            "height": 190 + 52 * len(names),
            "hovermode": "closest",
            "barmode": "group",
            "xaxis": {"title": {"text": "Share of the variance [%]"}, "rangemode": "tozero"},
            "yaxis": {"title": {"text": "Input"}, "ticks": ""},
            "legend": {"traceorder": "reversed", "x": 1.01, "xanchor": "left", "y": 1.0},
        },
    )


@drawing(
    "band",
    heading="Mean and its band",
    caption="The mean over the repeats, and the band that holds the true mean with the stated "
    "probability, for the entire curve at once or for each point separately.",
    of="Band",
    made_by="Call tribodyn.uncertainty.bootstrap_band(samples, seed=1) and its plot method.",
)
def band(result: Band, x: Any = None, label: str = "") -> Any:
    """Draw the mean curve with its band.

    Parameters
    ----------
    result : Band
        What :func:`tribodyn.uncertainty.bootstrap_band` returns.
    x : array, optional
        Place of each point; their numbers by default.
    label : str
        Label of the horizontal axis, with its unit.

    Returns
    -------
    plotly.graph_objects.Figure

    Raises
    ------
    InputError
        If there is not one place for each point.
    """
    mean, low, high = (np.ravel(each) for each in (result.mean, result.low, result.high))
    place = np.arange(mean.size) if x is None else np.ravel(np.asarray(x, dtype=float))
    if place.size != mean.size:
        what, why = f"x has {place.size} places", f"The band has {mean.size} points"
        raise InputError(what, Argument("x"), why, "Give one place for each point")
    factor, unit = scaled([low, high], readable(result.unit))
    low, mean, high = factor * low, factor * mean, factor * high
    name = f"{100.0 * result.level:.3g} % band of " + (
        "the curve" if result.simultaneous else "each point"
    )
    if mean.size == 1:
        points = marked(place, mean, "mean", PINION, size=9, symbol="circle", unit=unit)
        ends = {"array": high - mean, "arrayminus": mean - low, "color": PINION, "width": 6}
        traces: list[Trace] = [{**points, "error_y": ends}]
    else:
        edge = {"type": "scatter", "mode": "lines", "line": {"width": 0}, "hoverinfo": "skip"}
        traces = [
            {**edge, "x": place, "y": low, "showlegend": False, "name": name},
            {**edge, "x": place, "y": high, "fill": "tonexty", "fillcolor": FILLS[PINION],
             "name": name},
            line(place, mean, "mean", PINION, unit=unit),
        ]  # fmt: skip
    layout = {"xaxis": {"showticklabels": False, "ticks": ""}} if mean.size == 1 else {}
    widest = int(np.argmax(high - low))
    half = 0.5 * float(high[widest] - low[widest])
    return stack(
        f"Mean of {result.repeats} repeats, within ±{significant(half)} {unit}".rstrip()
        + f" at {100.0 * result.level:.3g} %",
        label or "Point",
        [Panel(f"Mean [{unit}]" if unit else "Mean", traces, height=1.4)],
        layout,
    )


@drawing(
    "data_set",
    heading="Columns of the table",
    caption="The columns over one of them, each row a point. Name another column for the "
    "horizontal axis with x.",
    of="DataSet",
    made_by="Call tribodyn.operating_data(case) or tribodyn.vibration_data(case) and its plot "
    "method.",
)
def data_set(data: DataSet, x: str = "") -> Any:
    """Draw the columns of a table over one of them, at most eight panels.

    Parameters
    ----------
    data : DataSet
        The table.
    x : str
        Column on the horizontal axis; that of the time, or the first one, by default.

    Returns
    -------
    plotly.graph_objects.Figure

    Raises
    ------
    InputError
        If no column has that name.
    """
    names = list(data.columns)
    if x and x not in names:
        why = f"It has {', '.join(names)}"
        raise InputError(f'no column "{x}"', Argument("x"), why, did_you_mean(x, names, why))
    across = x or ("time" if "time" in names else names[0])
    chosen = np.unique(np.linspace(0, data.rows - 1, min(data.rows, _POINTS)).round().astype(int))
    place, x_label = _column(data, across, chosen)
    others = [name for name in names if name != across]
    panels = []
    for name in others[:_PANELS]:
        values, label = _column(data, name, chosen)
        unit = label.rpartition("[")[2].rstrip("]") if "[" in label else ""
        points = marked(place, values, name, TOTAL, size=4, symbol="circle", unit=unit)
        panels.append(Panel(label.replace(" [", "<br>["), [points], height=0.8))
    left_out = len(others) - _PANELS
    more = f"; {left_out} more columns" if left_out > 0 else ""
    title = f"{data.rows} rows of {len(names)} columns over {across.replace('_', ' ')}{more}"
    return stack(title, x_label, panels, {"hovermode": "closest"})


def _column(data: DataSet, name: str, rows: Array) -> tuple[Array, str]:
    """Values of a column in a unit that is read easily, and the label of its axis."""
    values = np.asarray(data[name], dtype=float)
    factor, unit = scaled(values, readable(data.units.get(name, "")))
    label = name.replace("_", " ")
    label = label[:1].upper() + label[1:]
    return factor * values[rows], label if unit in ("", "-", "1") else f"{label} [{unit}]"
