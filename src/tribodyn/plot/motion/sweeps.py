"""Steady motions over the speed, and figures of a summary over keys of the case."""

from __future__ import annotations

from itertools import product
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.drawing import drawing
from tribodyn.plot.look.labels import axis_label, displayed, engineering, readable, rounded
from tribodyn.plot.look.panels import Panel, stack
from tribodyn.plot.look.style import MUTED, PAIR_COLORS, PINION, WHEEL, Trace, figure, line, marked
from tribodyn.study.pipeline.summary import SUMMARY
from tribodyn.study.pipeline.words import in_a_sentence, in_words
from tribodyn.units import convert

if TYPE_CHECKING:
    from tribodyn.dynamics import SpeedSweep
    from tribodyn.study import Sweep
    from tribodyn.study.studies.axes import Axis

_WAYS = {"up": (PINION, "solid"), "down": (WHEEL, "dash")}
_WORDS = {"up": "upwards", "down": "downwards"}
_COLORS = (PINION, WHEEL, *PAIR_COLORS)
#: More curves than this make a map.
_CURVES = len(_COLORS)


def _axis(sweep: SpeedSweep) -> tuple[str, Any]:
    """Quantity of the horizontal axis: the speed of a shaft whose teeth are told, or the beat."""
    return ("speed", sweep.speed) if sweep.teeth > 1 else ("mesh_frequency", sweep.mesh_frequency)


def _places(sweep: SpeedSweep) -> Any:
    return displayed(*_axis(sweep))


def _speed_curves(sweep: SpeedSweep, values: Any, unit: str) -> list[Trace]:
    speed = _places(sweep)
    traces = []
    for number, direction in enumerate(sweep.directions):
        color, dash = _WAYS[direction]
        # The broader curve below, so that both are seen where they agree.
        width = 3.0 if direction == "up" else 1.6
        words = _WORDS[direction]
        traces.append(line(speed, values[number], words, color, unit=unit, dash=dash, width=width))
    return traces


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
        made = line(x, values[row][at], "jump", MUTED, unit=unit, dash="dot", width=1.2)
        marker = {"symbol": "arrow", "angleref": "previous", "size": [0, 11], "color": MUTED}
        mode = {"mode": "lines+markers", "marker": marker, "showlegend": number == 0}
        traces.append({**made, **mode, "legendgroup": "jump"})
    return traces


def _speed_title(sweep: SpeedSweep) -> str:
    where, (name, places) = np.flatnonzero(sweep.differs), _axis(sweep)
    if where.size:
        first, last = (rounded(name, float(places[k])) for k in (where[0], where[-1]))
        told = f"The ways up and down differ at {where.size} of {sweep.differs.size} speeds"
        return f"{told}, " + (f"from {first} to {last}" if where.size > 1 else f"at {first}")
    lost = int(np.count_nonzero(~sweep.stable))
    if lost:
        return f"{lost} of {sweep.stable.size} motions are not stable or do not repeat"
    top = int(np.argmax(sweep.rms[0, :, 0]))
    return f"The mesh vibrates most at {rounded(name, float(places[top]))}"


@drawing(
    "speed_sweep",
    heading="Steady motions over the speed",
    caption="How strong the steady motion is when the speed goes up slowly, and when it comes "
    "down. Where the two differ, two motions are possible and the one before decides; arrows are "
    "jumps. Crosses are motions that are not stable or do not repeat.",
    of="SpeedSweep",
    made_by="Call tribodyn.dynamics.speed_sweep(...) and its plot method.",
)
def speed_sweep(sweep: SpeedSweep, *, signal: str | None = None) -> Any:
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
    factor, shown = (1e6, "µm") if small else (1.0, readable(unit))
    rms, span = (factor * part[..., column] for part in (sweep.rms, sweep.peak_to_peak))
    words, top = name.replace("_", " "), {"rangemode": "tozero"}
    if name in sweep.names:
        words = f"acceleration of {words}"
    several = [sweep.period[k] > 1 for k in range(len(sweep.directions))]
    marks = [
        *_dots(sweep, rms, list(~sweep.stable), "not stable", PAIR_COLORS[3], "x"),
        *_dots(sweep, rms, several, "several mesh cycles", PAIR_COLORS[0], "diamond-open"),
    ]
    panels = [
        Panel(
            f"Alternating rms of<br>{words} [{shown}]",
            [*_speed_curves(sweep, rms, shown), *_jumps(sweep, rms, shown), *marks],
            top,
            1.3,
        ),
        Panel(
            f"Range [{shown}]",
            [*_speed_curves(sweep, span, shown), *_jumps(sweep, span, shown)],
            top,
        ),
    ]
    loss = 100.0 * sweep.contact_loss.max(axis=-1, initial=0.0)
    if np.any(loss > 0.0):
        panels.append(Panel("Contact lost [%]", _speed_curves(sweep, loss, "%"), top, 0.8))
    label = axis_label(_axis(sweep)[0])
    return stack(_speed_title(sweep), label, panels, {"hovermode": "closest"})


def _words(name: str) -> str:
    words = name.replace("_", " ")
    return words[:1].upper() + words[1:]


def _axis_text(axis: Axis) -> str:
    unit = readable(axis.display_unit)
    return f"{_words(axis.name)} [{unit}]" if unit else _words(axis.name)


def _told(axis: Axis, value: Any) -> str:
    """A value as a title or a legend tells it."""
    number, _, unit = axis.show(value).partition(" ")
    if not axis.numeric:
        return str(axis.show(value))
    return f"{float(number):.4g} {readable(unit)}".rstrip()


def _values(study: Sweep, name: str) -> tuple[Any, str]:
    """Figure in its display unit, and that unit."""
    shown = SUMMARY[name]
    factor = convert(1.0, shown.unit, shown.display_unit) if shown.unit else 1.0
    return study[name] * factor, readable(shown.display_unit)


def _case_title(study: Sweep, name: str, values: Any, unit: str) -> str:
    failed = sum(bool(point.failed) for point in study.points)
    if not np.any(np.isfinite(values)):
        return f"No value has this figure; {failed} failed"
    place = np.unravel_index(int(np.nanargmax(values)), values.shape)
    where = ", ".join(
        _told(axis, axis.values[at]) for axis, at in zip(study.axes, place, strict=True)
    )
    lost = f"; {failed} of {values.size} failed" if failed else ""
    greatest = " ".join(engineering(float(np.nanmax(values)), unit, 4)).rstrip()
    return f"The {in_a_sentence(name)} is greatest at {where}: {greatest}{lost}"


def _marked(x: Any, y: Any, failed: Any, name: str, color: str, unit: str) -> list[Trace]:
    """One curve, with a cross at its foot for every value that failed."""
    curve = {**line(x, y, name, color, unit=unit), "mode": "lines+markers", "marker": {"size": 5}}
    lost = np.array([bool(text) for text in failed])
    if not lost.any():
        return [curve]
    foot = float(np.nanmin(y)) if np.any(np.isfinite(y)) else 0.0
    cross = {
        "type": "scatter",
        "mode": "markers",
        "x": np.asarray(x)[lost],
        "y": np.full(int(lost.sum()), foot),
        "name": "failed",
        "text": list(failed[lost]),
        "marker": {"symbol": "x", "size": 8, "color": MUTED},
        "hovertemplate": "%{text}<extra>failed</extra>",
    }
    return [curve, cross]


def _case_curves(study: Sweep, values: Any, unit: str) -> list[Trace]:
    """Curves over the first key, one for each combination of the others."""
    x, traces = study.axes[0].shown(), []
    others = list(product(*(range(len(axis.values)) for axis in study.axes[1:])))
    for number, place in enumerate(others):
        pairs = zip(study.axes[1:], place, strict=True)
        name = ", ".join(_told(axis, axis.values[at]) for axis, at in pairs) or "figure"
        column: Any = (slice(None), *place)
        color = _COLORS[number % len(_COLORS)]
        traces += _marked(x, values[column], study.failed[column], name, color, unit)
    return traces


def _map(study: Sweep, values: Any, label: str, unit: str, title: str) -> Any:
    first, second = study.axes
    heat = {
        "type": "heatmap",
        "x": first.shown(),
        "y": second.shown(),
        "z": values.T,
        "colorscale": "Viridis",
        "colorbar": {"title": {"text": label, "side": "right"}},
        "text": study.failed.T,
        "hoverongaps": True,
        "hovertemplate": f"%{{x}}, %{{y}}<br>%{{z:.5g}} {unit} %{{text}}<extra></extra>",
    }
    return figure(
        title,
        [heat],
        {
            "height": 460,
            "hovermode": "closest",
            "xaxis": {"title": {"text": _axis_text(first)}},
            "yaxis": {"title": {"text": _axis_text(second)}},
        },
    )


@drawing(
    "sweep",
    heading="Sweep",
    caption="One figure of the summary over the values that were varied. Peaks are resonances; a "
    "step means that the motion jumped. A cross or an empty place is a value that could not be "
    "computed, and the reason stands in the table.",
    of="Sweep",
    made_by='Call tribodyn.sweep(case, {"operation.speed": ("400 rpm", "3500 rpm", '
    "60)}) and its plot method.",
)
def sweep(study: Sweep, figure: str = "rms_mesh_force") -> Any:
    """Draw a figure of the summary over the keys that vary.

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
    label = f"{in_words(figure)} [{unit}]" if unit else in_words(figure)
    if curves > _CURVES and values.ndim == 2 and all(axis.numeric for axis in study.axes):
        return _map(study, values, label, unit, title)
    panel = Panel(label, _case_curves(study, values, unit), height=1.6)
    drawn = stack(title, _axis_text(study.axes[0]), [panel])
    varied = ", ".join(_words(axis.name) for axis in study.axes[1:])
    drawn.layout["legend"] |= {"title": {"text": varied, "font": {"size": 13}}}
    return drawn
