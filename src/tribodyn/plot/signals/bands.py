"""Any figure of a run with the spread of many variants on it."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.drawing import FIGURES, drawing
from tribodyn.errors import InputError
from tribodyn.plot.look.style import MUTED, Trace, translucent
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.study import CaseEnsemble

#: Part of the variants in a band, least width of one over the range of its curve, and opacity.
_SHARE, _LEAST, _FAINT = 0.95, 1e-6, 0.22
#: Most curves of variants where a band has no meaning.
_CURVES = 12


@drawing(
    "bands",
    heading="Spread of the variants",
    caption="The curve is that of the middle of all inputs; the surface holds 95 % of the "
    "variants, point by point. Bars have ends for the same. Of a curve that comes back over its "
    "own axis single variants are drawn.",
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
    return _drawn(result, name)[0]


def banded(result: CaseEnsemble, names: Iterable[str]) -> list[tuple[str, Any, str]]:
    """Heading, figure and caption of those figures of a run on which the variants differ."""
    found = []
    for name in names:
        each: Any = FIGURES[name]
        if each.missing(result.results[0]):
            continue
        try:
            figure, differ = _drawn(result, name)
        except InputError:  # a variant lacks what the figure draws
            continue
        if differ:
            found.append((each.heading, figure, each.caption_of(result.results[0])))
    return found


def _drawn(result: CaseEnsemble, name: str) -> tuple[Any, bool]:
    """A figure of the middle with bands, and whether there are any."""
    middle, *variants = result.results
    figure = FIGURES[name](middle)
    if figure.frames:
        return figure, False
    others = [_by_place(FIGURES[name](each).data) for each in variants]
    made: list[Trace] = []
    for place, trace in _by_place(figure.data).items():
        made += _spread(trace, [each[place] for each in others if place in each])
    if made:
        told = {"showlegend": True, "name": f"{_SHARE:.0%} of {len(variants)} variants"}
        made[1 if len(made) > 1 else 0] |= told
    ends = any(
        trace.type in ("bar", "scatter") and trace.error_y.array is not None
        for trace in figure.data
    )
    return figure.add_traces(made), bool(made) or ends


def _by_place(traces: Sequence[Any]) -> dict[tuple[Any, ...], Any]:
    """Traces by name, axes and number, so that those of several figures are matched."""
    found: dict[tuple[Any, ...], Any] = {}
    for trace in traces:
        number = 0
        while (place := (trace.type, trace.name, trace.xaxis, trace.yaxis, number)) in found:
            number += 1
        found[place] = trace
    return found


def _spread(trace: Any, others: Sequence[Any]) -> list[Trace]:
    """Band about a curve, or ends on its bars and points, which are set on the trace itself."""
    curves = [points for points in map(_points, others) if points is not None]
    own = _points(trace)
    if own is None or len(curves) < 3 or getattr(trace, "fill", None):
        return []
    x, y = own
    if all(x.shape == a.shape and np.allclose(x, a) and np.allclose(y, b) for a, b in curves):
        return []
    axes = {"xaxis": trace.xaxis, "yaxis": trace.yaxis, "legend": trace.legend}
    plain: Trace = {"type": "scatter", "mode": "lines", "hoverinfo": "skip", "showlegend": False}
    rising = all(np.all(np.diff(each) >= 0.0) for each, _ in [own, *curves])
    lines = trace.type == "scatter" and "lines" in (trace.mode or "lines")
    if not rising:
        if not lines:
            return []
        look = {"color": _faint(trace.line.color), "width": 1}
        return [
            {**plain, **axes, "x": a, "y": b, "line": look, "name": "variants"}
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
    """Numbers of a curve, of bars or of points; None for anything else."""
    if trace.type not in ("scatter", "bar"):
        return None
    try:
        x, y = (np.asarray(each, dtype=float) for each in (trace.x, trace.y))
    except (TypeError, ValueError):
        return None
    whole = x.ndim == 1 and x.shape == y.shape and x.size and np.all(np.isfinite(x))
    return (x, y) if whole else None


def _at(x: Array, other_x: Array, y: Array, *, lines: bool) -> Array:
    """Values of a curve at other places; of bars and points at the same places only."""
    if lines:
        if x.shape == other_x.shape and np.allclose(x, other_x, rtol=1e-12, atol=1e-12):
            return y
        beside = 1e-9 * np.ptp(other_x)
        outside = (x < other_x[0] - beside) | (x > other_x[-1] + beside)
        return np.where(outside, np.nan, np.interp(x, other_x, y))
    found = np.full(x.size, np.nan)
    places = np.clip(np.searchsorted(other_x, x), 0, other_x.size - 1)
    same = np.isclose(other_x[places], x)
    found[same] = y[places[same]]
    return found


def _faint(color: str | None) -> str:
    """The colour of a curve for a surface about it."""
    text = color if color and len(color) == 7 and color.startswith("#") else MUTED
    return translucent(text, _FAINT)
