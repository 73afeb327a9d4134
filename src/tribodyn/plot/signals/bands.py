"""Spread of case variants in any figure, and the accuracy of a surrogate model."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.drawing import FIGURES, Sketch, drawing
from tribodyn.errors import InputError
from tribodyn.plot.theme.colors import COLORS, MUTED, PINION, TOTAL, translucent
from tribodyn.plot.theme.labels import label_with, readable, scaled, significant
from tribodyn.plot.theme.panels import Panel, Row, stack_rows
from tribodyn.plot.theme.style import Trace, between, line, marked
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.study import CaseEnsemble
    from tribodyn.surrogate import Surrogate

#: Most points per target, harmonics of the spectrum, and fraction of the variants in the band.
_POINTS, _HARMONICS, _SHARE = 2000, 12, 0.95
_LIGHT, _DARK = "rgba(0, 114, 178, 0.16)", "rgba(0, 114, 178, 0.45)"


def _curve(result: CaseEnsemble, signal: str, x: Array) -> tuple[list[Trace], str]:
    """Mean over the variants, its confidence band and the band of the variants."""
    band, spread = result.band(signal), result.spread(signal, _SHARE)
    factor, unit = scaled(band.mean, band.unit)
    name, (low, high) = f"{band.level:.0%} band of the mean", spread
    traces = [
        *between(x, factor * low, factor * high, f"{_SHARE:.0%} of the variants", _LIGHT),
        *between(x, factor * band.low, factor * band.high, name, _DARK),
        line(x, factor * band.mean, "mean", TOTAL, unit=unit),
    ]
    return traces, unit


def _lines(result: CaseEnsemble) -> tuple[list[Trace], str]:
    """Mesh harmonics with both bands as error bars."""
    band = result.band("mesh_force", harmonics=_HARMONICS)
    spread = result.spread("mesh_force", _SHARE, _HARMONICS)
    factor, unit = scaled(band.mean, band.unit)
    order, traces = np.arange(1, _HARMONICS + 1), []
    for low, high, name, color, width in (
        (*spread, f"{_SHARE:.0%} of the variants", MUTED, 8),
        (band.low, band.high, f"{band.level:.0%} band of the mean", PINION, 4),
    ):
        points = marked(order, factor * band.mean, name, color, size=6, unit=unit)
        bars = {"array": factor * (high - band.mean), "arrayminus": factor * (band.mean - low)}
        points["error_y"] = {"type": "data", "width": width, "color": color, **bars}
        traces.append(points)
    return traces, unit


@drawing(
    heading="Spread of the response",
    of="CaseEnsemble",
    made_by="Call tribodyn.ensemble(case, {...}, seed=1) and its plot method.",
)
def ensemble(result: CaseEnsemble) -> Sketch:
    """Draw force over time, transmission error over the phase, and the spectrum, with bands.

    Effect of uncertain inputs: the light band holds 95 % of the variants, the dark band is the
    confidence band of their mean. Over the time of a mesh cycle, over its phase, and by mesh
    harmonic.
    """
    time = 1e3 * result.phase / float(np.mean(result.mesh_frequency))
    force, newton = _curve(result, "mesh_force", time)
    error, metre = _curve(result, "dynamic_transmission_error", result.phase)
    lines, unit = _lines(result)
    peak = result.mesh_force.max(axis=1)
    rows = [
        Row("Time [ms]", Panel(f"Mesh force [{newton}]", force)),
        Row("Mesh phase", Panel(f"Transmission error [{metre}]", error)),
        Row("Mesh harmonic", Panel(f"Amplitude of the force [{unit}]", lines)),
    ]
    low, high = np.quantile(peak, (0.5 - 0.5 * _SHARE, 0.5 + 0.5 * _SHARE))
    title = (
        f"{_SHARE:.0%} of {peak.size} variants peak between {significant(low)} and "
        f"{significant(high)} N"
    )
    return stack_rows(title, rows)


@drawing(
    heading="Surrogate against computation",
    of="Surrogate",
    made_by="Call tribodyn.surrogate.train(data, ...) and its plot method.",
)
def surrogate(result: Surrogate) -> Sketch:
    """Draw predictions over computed values of the held-out rows, one panel per target.

    Predictions over computed values for rows that were not used in training. Points on the line are
    exact; a new prediction lies between the dotted lines with the stated probability.
    """
    rows, qualities = [], []
    for number, name in enumerate(result.targets):
        true, predicted = result.true[number], result.predicted[number]
        factor, unit = scaled(true, readable(str(result.target_unit[number])))
        chosen = np.linspace(0, true.size - 1, min(true.size, _POINTS)).round().astype(int)
        color = COLORS[number % len(COLORS)]
        ends = factor * np.array([true.min(), true.max()])
        half = factor * float(result.band[number])
        place = (factor * true[chosen], factor * predicted[chosen])
        points = marked(*place, "held-out rows", color, 4, unit=unit)
        traces = [points, line(ends, ends, "exact", TOTAL, width=1.2)]
        if np.isfinite(half):
            for edge in (half, -half):
                style: Trace = {"dash": "dot", "showlegend": edge > 0.0}
                traces.append(line(ends, ends + edge, f"{result.level:.0%} band", MUTED, **style))
        label = label_with(str(name).replace("_", " "), unit)
        rows.append(Row(f"Computed {label}", Panel("Predicted", traces)))
        quantity = str(name).replace("_", " ")
        qualities.append(f"{quantity} {result.errors[str(name)].determination:.4f}")
    title = f"R² over {result.true.shape[1]} held-out rows: {', '.join(qualities[:3])}"
    return stack_rows(title, rows, {"hovermode": "closest"})


#: Least width of a band over the range of the curve, opacity.
_LEAST, _FAINT = 1e-6, 0.22
#: Traces that have a band or error bars; a field or a body has none.
_BANDED = ("scatter", "bar")
#: Most curves of variants where a band is not defined.
_CURVES = 12


@drawing(
    heading="Spread of the variants",
    of="CaseEnsemble",
    made_by="Call tribodyn.ensemble(case, {...}, seed=1) and its plot method with a name.",
)
def bands(result: CaseEnsemble, name: str = "mesh_force") -> Any:
    """Draw a figure of a run with bands of the variants.

    The curve belongs to the central values of all inputs; the band holds 95 % of the variants,
    point by point. Bars have error bars instead. Curves that turn back along their axis are plotted
    for single variants.

    Parameters
    ----------
    result : CaseEnsemble
        What :func:`tribodyn.ensemble` returns, its inputs keys of the case.
    name : str
        Figure of a run, such as ``"spectrum"`` or ``"mesh_stiffness"``.

    Returns
    -------
    plotly.graph_objects.Figure
    """
    return _banded_figure(result, name)[0]


def banded(result: CaseEnsemble, names: Iterable[str]) -> list[tuple[str, Any, str]]:
    """Heading, figure and caption of the figures in which the variants differ."""
    figures = []
    for name in names:
        drawing: Any = FIGURES[name]
        if drawing.missing(result.results[0]):
            continue
        try:
            figure, differ = _banded_figure(result, name)
        except InputError:  # a variant lacks what the figure draws
            continue
        if differ:
            figures.append((drawing.heading, figure, drawing.caption_of(result.results[0])))
    return figures


def _banded_figure(result: CaseEnsemble, name: str) -> tuple[Any, bool]:
    """Figure of the central case with bands, and whether it has any."""
    middle, *variants = result.results
    figure = FIGURES[name](middle)
    if figure.frames:
        return figure, False
    variant_traces = [_by_name_and_axes(FIGURES[name](variant).data) for variant in variants]
    added: list[Trace] = []
    for place, trace in _by_name_and_axes(figure.data).items():
        added += _spread(trace, [variant[place] for variant in variant_traces if place in variant])
    if added:
        legend_entry = {"showlegend": True, "name": f"{_SHARE:.0%} of {len(variants)} variants"}
        added[1 if len(added) > 1 else 0] |= legend_entry
    ends = any(each.type in _BANDED and each.error_y.array is not None for each in figure.data)
    return figure.add_traces(added), bool(added) or ends


def _by_name_and_axes(traces: Sequence[Any]) -> dict[tuple[Any, ...], Any]:
    """Map (type, name, axes, number) to a curve, to match those of several figures."""
    numbered: dict[tuple[Any, ...], Any] = {}
    for trace in (each for each in traces if each.type in _BANDED):
        number = 0
        while (key := (trace.type, trace.name, trace.xaxis, trace.yaxis, number)) in numbered:
            number += 1
        numbered[key] = trace
    return numbered


def _spread(trace: Any, others: Sequence[Any]) -> list[Trace]:
    """Traces of the band about a curve; bars and points get error bars in place."""
    curves = [points for points in map(_points, others) if points is not None]
    nominal = _points(trace)
    if nominal is None or len(curves) < 3 or getattr(trace, "fill", None):
        return []
    x, y = nominal
    if all(x.shape == a.shape and np.allclose(x, a) and np.allclose(y, b) for a, b in curves):
        return []
    axes = {"xaxis": trace.xaxis, "yaxis": trace.yaxis, "legend": trace.legend}
    plain: Trace = {"type": "scatter", "mode": "lines", "hoverinfo": "skip", "showlegend": False}
    rising = all(np.all(np.diff(each) >= 0.0) for each, _ in [nominal, *curves])
    lines = trace.type == "scatter" and "lines" in (trace.mode or "lines")
    if not rising:
        if not lines:
            return []
        style = {"color": _faint(trace.line.color), "width": 1}
        return [
            {**plain, **axes, "x": a, "y": b, "line": style, "name": "variants"}
            for a, b in curves[:: -(-len(curves) // _CURVES)]
        ]
    values = np.array([_at(x, *each, lines=lines) for each in curves])
    inside = np.sum(np.isfinite(values), axis=0) >= 3
    if not inside.any():
        return []
    tails = 0.5 - 0.5 * _SHARE
    low, high = np.nanquantile(values[:, inside], (tails, 1.0 - tails), axis=0)
    if np.max(high - low) <= _LEAST * max(np.ptp(y), np.abs(y).max()):
        return []
    if not lines:
        ends = np.full((2, x.size), np.nan)
        ends[:, inside] = high - y[inside], y[inside] - low
        above, below = np.maximum(ends, 0.0)
        trace.error_y = {"array": above, "arrayminus": below, "color": MUTED, "width": 3}
        return []
    edge = {**plain, **axes, "x": x[inside], "line": {"width": 0}, "name": "variants"}
    color = _faint(trace.line.color)
    return [{**edge, "y": high}, {**edge, "y": low, "fill": "tonexty", "fillcolor": color}]


def _points(trace: Any) -> tuple[Array, Array] | None:
    """Coordinates of a curve, bars or points as floats; None where they are no numbers."""
    try:
        x, y = (np.asarray(each, dtype=float) for each in (trace.x, trace.y))
    except (TypeError, ValueError):
        return None
    valid = x.ndim == 1 and x.shape == y.shape and x.size and np.all(np.isfinite(x))
    return (x, y) if valid else None


def _at(x: Array, other_x: Array, y: Array, *, lines: bool) -> Array:
    """Values interpolated at ``x``; bars and points have values at their own positions only."""
    if lines:
        if x.shape == other_x.shape and np.allclose(x, other_x, rtol=1e-12, atol=1e-12):
            return y
        tolerance = 1e-9 * np.ptp(other_x)
        outside = (x < other_x[0] - tolerance) | (x > other_x[-1] + tolerance)
        return np.where(outside, np.nan, np.interp(x, other_x, y))
    result = np.full(x.size, np.nan)
    indices = np.clip(np.searchsorted(other_x, x), 0, other_x.size - 1)
    same = np.isclose(other_x[indices], x)
    result[same] = y[indices[same]]
    return result


def _faint(color: str | None) -> str:
    """Translucent colour of the band about a curve."""
    text = color if color and len(color) == 7 and color.startswith("#") else MUTED
    return translucent(text, _FAINT)
