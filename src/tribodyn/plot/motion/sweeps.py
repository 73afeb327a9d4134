"""Steady states over the speed, and summary figures over keys of the case."""

from __future__ import annotations

from itertools import product
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.drawing import Sketch, drawing
from tribodyn.plot.theme.colors import COLORS, MUTED, PAIR_COLORS, PINION, WHEEL
from tribodyn.plot.theme.labels import (
    axis_label,
    capitalized,
    displayed,
    engineering,
    label_with,
    readable,
    rounded,
)
from tribodyn.plot.theme.panels import ROUNDING, Panel, stack
from tribodyn.plot.theme.style import Trace, axis, heat, line, marked, plane_figure
from tribodyn.study.pipeline.summary_figures import figure_of, in_a_sentence, in_words
from tribodyn.units import convert

if TYPE_CHECKING:
    from tribodyn.dynamics import SpeedSweep
    from tribodyn.study import Sweep
    from tribodyn.study.studies.study_axes import Axis

#: The broader curve is drawn first, so that both are visible where they agree.
_WAYS = {"up": ("upwards", PINION, "solid", 3.0), "down": ("downwards", WHEEL, "dash", 1.6)}
_CHANGES = {"up": "rising", "down": "falling"}
#: Number of curves above which a map is drawn.
_CURVES = len(COLORS)


def _axis(sweep: SpeedSweep) -> tuple[str, Any]:
    """Quantity of the horizontal axis: shaft speed if the teeth are given, else mesh frequency."""
    return ("speed", sweep.speed) if sweep.teeth > 1 else ("mesh_frequency", sweep.mesh_frequency)


def _places(sweep: SpeedSweep) -> Any:
    return displayed(*_axis(sweep))


def _speed_curves(sweep: SpeedSweep, values: Any, unit: str) -> list[Trace]:
    speed = _places(sweep)
    return [
        line(speed, row, name, color, unit=unit, dash=dash, width=width)
        for row, (name, color, dash, width) in zip(
            values, (_WAYS[direction] for direction in sweep.directions), strict=True
        )
    ]


def _dots(sweep: SpeedSweep, values: Any, chosen: Any, name: str, color: str, symbol: str) -> Any:
    x = np.concatenate([_places(sweep)[each] for each in chosen])
    y = np.concatenate([row[each] for row, each in zip(values, chosen, strict=True)])
    if not x.size:
        return []
    return [marked(x, y, name, color, size=6, symbol=symbol)]


def _jumps(sweep: SpeedSweep, values: Any, unit: str) -> list[Trace]:
    traces = []
    for number, jump in enumerate(sweep.jumps):
        row = sweep.directions.index(jump.direction)
        at = [int(np.argmin(np.abs(sweep.mesh_frequency - f))) for f in (jump.before, jump.after)]
        x = _places(sweep)[at]
        marker = {"symbol": "arrow", "angleref": "previous", "size": [0, 11], "color": MUTED}
        style: Trace = {"unit": unit, "dash": "dot", "width": 1.2, "marker": marker}
        style |= {"mode": "lines+markers", "showlegend": number == 0, "legendgroup": "jump"}
        traces.append(line(x, values[row][at], "jump", MUTED, **style))
    return traces


def _speed_title(sweep: SpeedSweep) -> str:
    where, (name, places) = np.flatnonzero(sweep.differs), _axis(sweep)
    if where.size:
        first, last = (rounded(name, places[k]) for k in (where[0], where[-1]))
        difference = f"The sweeps up and down differ at {where.size} of {sweep.differs.size} speeds"
        return f"{difference}, " + (f"from {first} to {last}" if where.size > 1 else f"at {first}")
    lost = int(np.count_nonzero(~sweep.stable))
    if lost:
        return f"{lost} of {sweep.stable.size} states are unstable or not periodic"
    top = int(np.argmax(sweep.rms[0, :, 0]))
    return f"The mesh vibrates most strongly at {rounded(name, places[top])}"


def _speed_caption(sweep: SpeedSweep) -> str:
    ways = " and for ".join(f"slowly {_CHANGES[way]}" for way in sweep.directions)
    sentences = [f"Amplitude of the steady state for {ways} speed."]
    if np.any(sweep.differs):
        sentences.append("Where the two differ, two steady states coexist and the history decides.")
    if sweep.jumps:
        sentences.append("Arrows are jumps.")
    if not np.all(sweep.stable):
        sentences.append("Crosses are states that are unstable or not periodic.")
    if np.any(np.asarray(sweep.period) > 1):
        sentences.append("Diamonds repeat after several mesh cycles.")
    return " ".join(sentences)


@drawing(
    heading="Steady states over the speed",
    caption=_speed_caption,
    of="SpeedSweep",
    made_by="Call tribodyn.dynamics.speed_sweep(...) and its plot method.",
)
def speed_sweep(sweep: SpeedSweep, *, signal: str | None = None) -> Sketch:
    """Draw rms, range and loss of contact over the speed.

    Parameters
    ----------
    sweep : SpeedSweep
        What :func:`tribodyn.dynamics.speed_sweep` returns.
    signal : str, optional
        Name of the signal; the first by default.

    Returns
    -------
    plotly.graph_objects.Figure
    """
    name = signal or sweep.signals[0]
    column = sweep.of(name)
    unit = sweep.units[column]
    small = unit == "m" and float(np.nanmax(sweep.peak_to_peak[..., column])) < 1e-2
    factor, display_unit = (1e6, "µm") if small else (1.0, readable(unit))
    rms, span = (factor * part[..., column] for part in (sweep.rms, sweep.peak_to_peak))
    signal_label, top = name.replace("_", " "), {"rangemode": "tozero"}
    if name in sweep.names:
        signal_label = f"acceleration of {signal_label}"
    several = [sweep.period[k] > 1 for k in range(len(sweep.directions))]
    marks = [
        *_dots(sweep, rms, list(~sweep.stable), "not stable", PAIR_COLORS[3], "x"),
        *_dots(sweep, rms, several, "several mesh cycles", PAIR_COLORS[0], "diamond-open"),
    ]
    levels, ranges = (
        [*_speed_curves(sweep, values, display_unit), *_jumps(sweep, values, display_unit)]
        for values in (rms, span)
    )
    label = f"Alternating rms of<br>{signal_label} [{display_unit}]"
    panels = [
        Panel(label, [*levels, *marks], top, 1.3),
        Panel(f"Range [{display_unit}]", ranges, top),
    ]
    loss = 100.0 * sweep.contact_loss.max(axis=-1, initial=0.0)
    if np.any(loss > 0.0):
        panels.append(Panel("Contact lost [%]", _speed_curves(sweep, loss, "%"), top, 0.8))
    label = axis_label(_axis(sweep)[0])
    return stack(_speed_title(sweep), label, panels, {"hovermode": "closest"})


def axis_text(axis: Axis) -> str:
    """Label of an axis with its unit."""
    return label_with(capitalized(axis.name), axis.display_unit)


def value_text(axis: Axis, value: object) -> str:
    """Format a value of an axis for a title or a legend."""
    number, _, unit = axis.show(value).partition(" ")
    if not axis.numeric:
        return str(axis.show(value))
    return f"{float(number):.4g} {readable(unit)}".rstrip()


def _values(study: Sweep, name: str) -> tuple[Any, str]:
    """Return a summary figure in its display unit, and that unit."""
    quantity = figure_of(name)
    factor = convert(1.0, quantity.unit, quantity.display_unit) if quantity.unit else 1.0
    return study[name] * factor, readable(quantity.display_unit)


def _case_title(study: Sweep, name: str, values: Any, unit: str) -> str:
    failed = sum(bool(point.failed) for point in study.points)
    if not np.any(np.isfinite(values)):
        return f"No run has this result; {failed} failed"
    place = np.unravel_index(int(np.nanargmax(values)), values.shape)
    where = ", ".join(
        value_text(axis, axis.values[at]) for axis, at in zip(study.axes, place, strict=True)
    )
    lost = f"; {failed} of {values.size} failed" if failed else ""
    greatest = " ".join(engineering(float(np.nanmax(values)), unit, 4)).rstrip()
    varies = np.nanmax(values) - np.nanmin(values) > ROUNDING * np.nanmax(abs(values))
    if values.size > 1 and not varies:
        return f"The {in_a_sentence(name)} does not vary: {greatest}{lost}"
    return f"The {in_a_sentence(name)} is largest at {where}: {greatest}{lost}"


def _marked(x: object, y: Any, failed: Any, name: str, color: str, unit: str) -> list[Trace]:
    """A curve with a cross at its minimum for every failed run."""
    curve = line(x, y, name, color, unit=unit, mode="lines+markers", marker={"size": 5})
    lost = np.array([bool(text) for text in failed])
    if not lost.any():
        return [curve]
    foot = float(np.nanmin(y)) if np.any(np.isfinite(y)) else 0.0
    feet, hover = np.full(int(lost.sum()), foot), "%{text}<extra>failed</extra>"
    style: Trace = {"text": list(failed[lost]), "hovertemplate": hover}
    return [curve, marked(np.asarray(x)[lost], feet, "failed", MUTED, 8, "x", **style)]


def _case_curves(study: Sweep, values: Any, unit: str) -> list[Trace]:
    """Curves over the first key, one per combination of the other keys."""
    x, traces = study.axes[0].display_values(), []
    others = list(product(*(range(len(axis.values)) for axis in study.axes[1:])))
    for number, place in enumerate(others):
        pairs = zip(study.axes[1:], place, strict=True)
        name = ", ".join(value_text(axis, axis.values[at]) for axis, at in pairs) or "figure"
        column: Any = (slice(None), *place)
        color = COLORS[number % len(COLORS)]
        traces += _marked(x, values[column], study.failed[column], name, color, unit)
    return traces


def _map(study: Sweep, values: Any, label: str, unit: str, title: str) -> Sketch:
    first, second = study.axes
    hover, bar = f"%{{x}}, %{{y}}<br>%{{z:.5g}} {unit} %{{text}}", axis(label)
    bar["title"]["side"] = "right"
    more: Trace = {"text": study.failed.T, "hoverongaps": True, "colorbar": bar}
    places = (first.display_values(), second.display_values())
    cells = heat(*places, values.T, "Viridis", hover, **more)
    return plane_figure(title, [cells], *(axis(axis_text(each)) for each in study.axes), height=460)


@drawing(
    heading="Sweep",
    of="Sweep",
    made_by='Call tribodyn.sweep(case, {"operation.speed": ("400 rpm", "3500 rpm", '
    "60)}) and its plot method.",
)
def sweep(study: Sweep, figure: str = "rms_mesh_force") -> Sketch:
    """Draw a summary figure over the keys that vary.

    A summary figure over the varied values. Peaks are resonances; a step is a jump of the response.
    A cross or an empty cell is a run that failed; the table lists the reason.

    Parameters
    ----------
    study : Sweep
        What :func:`tribodyn.sweep` returns.
    figure : str
        Name in the summary.

    Returns
    -------
    plotly.graph_objects.Figure
    """
    values, unit = _values(study, figure)
    title = _case_title(study, figure, values, unit)
    curves = int(np.prod(values.shape[1:]))
    label = label_with(in_words(figure), unit)
    if curves > _CURVES and values.ndim == 2 and all(axis.numeric for axis in study.axes):
        return _map(study, values, label, unit, title)
    panel = Panel(label, _case_curves(study, values, unit), height=1.6)
    sketch = stack(title, axis_text(study.axes[0]), [panel])
    varied = ", ".join(capitalized(axis.name) for axis in study.axes[1:])
    sketch.layout["legend"] |= {"title": {"text": varied, "font": {"size": 13}}}
    return sketch
