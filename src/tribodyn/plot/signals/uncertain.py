"""Variance shares of inputs, confidence band of a mean, and columns of computed data."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.drawing import Sketch, drawing
from tribodyn.errors import Argument, InputError, did_you_mean
from tribodyn.plot.theme.colors import FILLS, GRID, MUTED, PAIR_COLORS, PINION, TOTAL, WHEEL
from tribodyn.plot.theme.labels import capitalized, label_with, readable, scaled, significant
from tribodyn.plot.theme.panels import Panel, stack
from tribodyn.plot.theme.style import ABOVE, Trace, axis, bars, between, line, marked, plane_figure
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.study import CaseSensitivity, DataSet, FailureProbability
    from tribodyn.uncertainty import Band, SobolIndices

#: Axis of shares of the variance.
_SHARE = axis("Share of the variance [%]", rangemode="tozero")
#: Panels of a table, and points of one.
_PANELS, _POINTS = 8, 3000


@drawing(
    heading="Contribution of each input to the variance",
    of="SobolIndices",
    made_by="Call tribodyn.uncertainty.sobol_indices(function, distributions, seed=1) and its "
    "plot method.",
)
def sobol_indices(indices: SobolIndices) -> Sketch:
    """Draw first-order and total shares of every input as bars, the largest on top.

    Shares of the variance of the output. The first-order index is the share of an input alone, the
    total-order index the share that would vanish if the input were fixed, with all its
    interactions. Where the total exceeds the first order, the input interacts with others. Shares
    slightly below zero or above 100 % are the sampling error of the estimate.
    """
    top = int(np.argsort(indices.total_order)[-1])
    title = (
        f"{significant(100.0 * float(indices.first_order[top]))} % of the variance comes from "
        f"{indices.name[top]} alone, {significant(100.0 * float(indices.total_order[top]))} % "
        "with its interactions"
    )
    columns = {"total order": indices.total_order, "first order": indices.first_order}
    return _paired_bars(title, indices.name, columns, _SHARE, "Input")


def _paired_bars(
    title: str, names: Any, columns: Mapping[str, Array], share: Trace, label: str
) -> Sketch:
    """Two shares of each name as bars, the largest on top."""
    order = np.argsort(next(iter(columns.values())))
    sorted_names = [str(names[k]) for k in order]
    traces = [
        bars(100.0 * values[order], sorted_names, name, color,
             f"%{{y}}, {name}: %{{x:.3g}} %<extra></extra>", orientation="h")
        for (name, values), color in zip(columns.items(), (WHEEL, PINION), strict=True)
    ]  # fmt: skip
    legend = {"traceorder": "reversed", "x": 1.01, "xanchor": "left", "y": 1.0}
    layout: Trace = {"height": 190 + 52 * len(order), "barmode": "group", "legend": legend}
    return plane_figure(title, traces, share, axis(label, ticks=""), **layout)


@drawing(
    heading="Probability of failure",
    of="FailureProbability",
    made_by="Call tribodyn.study.failure_probability(case, distributions, seed=1) and its plot "
    "method.",
)
def failure_probability(result: FailureProbability) -> Sketch:
    """Draw share and probability of every safety and life as bars, the largest on top.

    Share of the variants in which a safety or a life falls below what is required, and the
    probability of this by the lognormal distribution through all variants.
    """
    top = int(np.argmax(result.probability))
    title = (
        f"{result.figure[top]} falls below what is required with "
        f"{significant(100.0 * float(result.probability[top]))} %"
    )
    share = axis("Below what is required [%]", rangemode="tozero")
    columns = {"of the distribution": result.probability, "of the variants": result.share}
    return _paired_bars(title, result.figure, columns, share, "Safety or life")


@drawing(
    heading="Mean and its band",
    of="Band",
    made_by="Call tribodyn.uncertainty.bootstrap_band(samples, seed=1) and its plot method.",
)
def band(result: Band, x: object = None, label: str = "") -> Sketch:
    """Draw the mean curve with its band.

    The mean over the repeats, and the band that holds the true mean with the stated probability,
    for the entire curve at once or for each point separately.

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
        points = marked(place, mean, "mean", PINION, size=9, unit=unit)
        ends = {"array": high - mean, "arrayminus": mean - low, "color": PINION, "width": 6}
        traces: list[Trace] = [{**points, "error_y": ends}]
    else:
        edges = between(place, low, high, name, FILLS[PINION])
        traces = [*edges, line(place, mean, "mean", PINION, unit=unit)]
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
    heading="Columns of the table",
    of="DataSet",
    made_by="Call tribodyn.operating_data(case) or tribodyn.vibration_data(case) and its plot "
    "method.",
)
def data_set(data: DataSet, x: str = "") -> Sketch:
    """Draw the columns of a table over one of them, at most eight panels.

    The columns over one of them, each row a point. Name another column for the horizontal axis with
    x.

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
        points = marked(place, values, name, TOTAL, size=4, unit=unit)
        panels.append(Panel(label.replace(" [", "<br>["), [points], height=0.8))
    left_out = len(others) - _PANELS
    more = f"; {left_out} more columns" if left_out > 0 else ""
    title = f"{data.rows} rows of {len(names)} columns over {across.replace('_', ' ')}{more}"
    return stack(title, x_label, panels, {"hovermode": "closest"})


def _column(data: DataSet, name: str, rows: Array) -> tuple[Array, str]:
    """Values of a column in a unit that is read easily, and the label of its axis."""
    values = np.asarray(data[name], dtype=float)
    factor, unit = scaled(values, readable(data.units.get(name, "")))
    return factor * values[rows], label_with(capitalized(name), unit)


#: Height of a row, and of the margins above and below the rows [px].
_ROW, _FRAME = 46, 190
#: Names and colours of the two kinds of share.
_KINDS = (("alone", PINION), ("with interactions", PAIR_COLORS[0]))


@drawing(
    heading="Contribution of each tolerance",
    of="CaseSensitivity",
    made_by='Call tribodyn.sobol_indices(case, "peak_mesh_force", {"operation.torque": '
    '"90 N*m +- 5 %"}, seed=1) and its plot method.',
)
def sensitivity(shares: CaseSensitivity) -> Sketch:
    """Draw the shares of the inputs as bars, one group per summary figure.

    Share of the variance due to each input: alone, and with interactions, which is the share that
    would vanish if the input were known exactly. Thin lines are bootstrap intervals: use a larger
    sample where they are long.
    """
    figures, inputs = [str(name) for name in shares.figure], [str(key) for key in shares.input]
    orders = (shares.first_order, shares.total_order)
    bands = (shares.first_order_band, shares.total_order_band)
    labels = [[_wrapped_name(name) for name in figures for _ in inputs], inputs * len(figures)]
    traces = [
        _bars(labels, np.asarray(order), band, name, color)
        for order, band, (name, color) in zip(orders, bands, _KINDS, strict=True)
    ]
    count = len(inputs) * len(figures)
    y = axis("", autorange="reversed", automargin=True, dividercolor=GRID)
    layout = {"barmode": "group", "bargap": 0.25, "height": _FRAME + _ROW * count, "legend": ABOVE}
    return plane_figure(_title(figures, inputs, shares.total_order), traces, _SHARE, y, **layout)


def _bars(labels: object, order: Array, band: Array, name: str, color: str) -> Trace:
    values = 100.0 * order.ravel()
    hover = f"%{{x:.3g}} % {name}<extra></extra>"
    # Estimates may lie outside 0 to 100 %; the intervals are clipped.
    clipped = np.clip(100.0 * np.asarray(band), 0.0, 100.0)
    low, high = (clipped[..., end, :].ravel() for end in (0, 1))
    above, below = np.maximum(high - values, 0.0), np.maximum(values - low, 0.0)
    ends = {"type": "data", "array": above, "arrayminus": below, "color": MUTED, "width": 3}
    more: Trace = {"orientation": "h", "error_x": {**ends, "thickness": 1.2}}
    return bars(values, labels, name, color, hover, **more)


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
