"""One figure of a summary over the keys of a sweep: curves, or a map of two keys."""

from __future__ import annotations

from itertools import product
from typing import Any

import numpy as np

from tribodyn.drawing import drawing
from tribodyn.plot.labels import readable
from tribodyn.plot.style import MUTED, PAIR_COLORS, PINION, WHEEL, Panel, figure, line, stack
from tribodyn.study.pipeline.summary_names import SUMMARY
from tribodyn.units import convert

_COLORS = (PINION, WHEEL, *PAIR_COLORS)
#: More curves than this make a map.
_CURVES = len(_COLORS)


def _missing(result: Any) -> str:
    if hasattr(result, "axes") and hasattr(result, "failed"):
        return ""
    return (
        "This figure shows one figure of the summary over values of the case. Call "
        'tribodyn.sweep(case, {"operation.speed": ("400 rpm", "3500 rpm", 60)}) and its plot '
        "method."
    )


def _words(name: str) -> str:
    words = name.replace("_", " ")
    return words[:1].upper() + words[1:]


def _axis_text(axis: Any) -> str:
    unit = readable(axis.display_unit)
    return f"{_words(axis.name)} [{unit}]" if unit else _words(axis.name)


def _told(axis: Any, value: Any) -> str:
    """A value as a title or a legend tells it."""
    number, _, unit = axis.show(value).partition(" ")
    if not axis.numeric:
        return str(axis.show(value))
    return f"{float(number):.4g} {readable(unit)}".rstrip()


def _values(found: Any, name: str) -> tuple[Any, str]:
    """Figure in its display unit, and that unit."""
    shown = SUMMARY[name]
    factor = convert(1.0, shown.unit, shown.display_unit) if shown.unit else 1.0
    return found[name] * factor, readable(shown.display_unit)


def _title(found: Any, name: str, values: Any, unit: str) -> str:
    failed = sum(bool(point.failed) for point in found.points)
    if not np.any(np.isfinite(values)):
        return f"No value has this figure; {failed} failed"
    place = np.unravel_index(int(np.nanargmax(values)), values.shape)
    where = ", ".join(
        _told(axis, axis.values[at]) for axis, at in zip(found.axes, place, strict=True)
    )
    lost = f"; {failed} of {values.size} failed" if failed else ""
    return f"Greatest {_words(name).lower()}: {np.nanmax(values):.4g} {unit}".rstrip() + (
        f" at {where}{lost}"
    )


def _marked(x: Any, y: Any, failed: Any, name: str, color: str, unit: str) -> list[dict[str, Any]]:
    """One curve, with a cross at its foot for every value that failed."""
    curve = {**line(x, y, name, color, unit=unit), "mode": "lines+markers", "marker": {"size": 5}}
    lost = np.array([bool(text) for text in failed])
    if not lost.any():
        return [curve]
    foot = float(np.nanmin(y)) if np.any(np.isfinite(y)) else 0.0
    cross = {
        "type": "scatter", "mode": "markers", "x": np.asarray(x)[lost],
        "y": np.full(int(lost.sum()), foot), "name": "failed", "text": list(failed[lost]),
        "marker": {"symbol": "x", "size": 8, "color": MUTED},
        "hovertemplate": "%{text}<extra>failed</extra>",
    }  # fmt: skip
    return [curve, cross]


def _curves(found: Any, values: Any, unit: str) -> list[dict[str, Any]]:
    """Curves over the first key, one for each combination of the others."""
    x, traces = found.axes[0].shown(), []
    others = list(product(*(range(len(axis.values)) for axis in found.axes[1:])))
    for number, place in enumerate(others):
        pairs = zip(found.axes[1:], place, strict=True)
        name = ", ".join(_told(axis, axis.values[at]) for axis, at in pairs) or "figure"
        column = (slice(None), *place)
        color = _COLORS[number % len(_COLORS)]
        traces += _marked(x, values[column], found.failed[column], name, color, unit)
    return traces


def _map(found: Any, values: Any, label: str, unit: str, title: str) -> Any:
    first, second = found.axes
    heat = {
        "type": "heatmap", "x": first.shown(), "y": second.shown(), "z": values.T,
        "colorscale": "Viridis", "colorbar": {"title": {"text": label, "side": "right"}},
        "text": found.failed.T, "hoverongaps": True,
        "hovertemplate": f"%{{x}}, %{{y}}<br>%{{z:.5g}} {unit} %{{text}}<extra></extra>",
    }  # fmt: skip
    return figure(
        title, [heat], {
            "height": 460, "hovermode": "closest", "xaxis": {"title": {"text": _axis_text(first)}},
            "yaxis": {"title": {"text": _axis_text(second)}},
        },
    )  # fmt: skip


@drawing(
    "sweep",
    heading="Sweep",
    caption="One figure of the summary over the values that were varied. Peaks are resonances; a "
    "step means that the motion jumped. A cross or an empty place is a value that could not be "
    "computed, and the reason stands in the table.",
    needs=_missing,
)
def sweep(found: Any, figure: str = "rms_mesh_force") -> Any:
    """Draw a figure of the summary over the keys that vary.

    Parameters
    ----------
    found : Sweep
        What :func:`tribodyn.sweep` returns.
    figure : str
        Name in the summary.

    Returns
    -------
    plotly.graph_objects.Figure
    """
    values, unit = _values(found, figure)
    title = _title(found, figure, values, unit)
    curves = int(np.prod(values.shape[1:]))
    label = f"{_words(figure)} [{unit}]" if unit else _words(figure)
    if curves > _CURVES and values.ndim == 2 and all(axis.numeric for axis in found.axes):
        return _map(found, values, label, unit, title)
    panel = Panel(label, _curves(found, values, unit), height=1.6)
    drawn = stack(title, _axis_text(found.axes[0]), [panel])
    varied = ", ".join(_words(axis.name) for axis in found.axes[1:])
    return drawn.update_layout(legend={"title": {"text": varied, "font": {"size": 13}}})
