"""Any figure of a run with a band that holds 95 % of the case variants."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.drawing import FIGURES, drawing
from tribodyn.errors import InputError
from tribodyn.plot.theme.style import MUTED, Trace, translucent
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.study import CaseEnsemble

#: Fraction of the variants in a band, its least width over the range of the curve, opacity.
_SHARE, _LEAST, _FAINT = 0.95, 1e-6, 0.22
#: Traces that have a band or error bars; a field or a body has none.
_BANDED = ("scatter", "bar")
#: Most curves of variants where a band is not defined.
_CURVES = 12


@drawing(
    "bands",
    heading="Spread of the variants",
    caption="The curve belongs to the central values of all inputs; the band holds 95 % of the "
    "variants, point by point. Bars have error bars instead. Curves that turn back along their "
    "axis are plotted for single variants.",
    of="CaseEnsemble",
    made_by="Call tribodyn.ensemble(case, {...}, seed=1) and its plot method with a name.",
)
def bands(result: CaseEnsemble, name: str = "mesh_force") -> Any:
    """Draw a figure of a run with bands of the variants.

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
