"""Steady motions over the speed, upwards and downwards, with loss of contact and stability."""

from __future__ import annotations

from typing import Any

import numpy as np

from tribodyn.drawing import drawing
from tribodyn.plot.labels import axis_label, displayed, readable, rounded
from tribodyn.plot.style import MUTED, PAIR_COLORS, PINION, WHEEL, Panel, line, stack

_COLORS = {"up": (PINION, "solid"), "down": (WHEEL, "dash")}
_WORDS = {"up": "upwards", "down": "downwards"}


def _missing(result: Any) -> str:
    if hasattr(result, "jumps") and hasattr(result, "directions"):
        return ""
    return (
        "This figure shows steady motions over the speed. Call "
        "tribodyn.dynamics.speed_sweep(...) and its plot method."
    )


def _curves(sweep: Any, values: Any, unit: str) -> list[dict[str, Any]]:
    speed = displayed("speed", sweep.speed)
    traces = []
    for number, direction in enumerate(sweep.directions):
        color, dash = _COLORS[direction]
        # The broader curve below, so that both are seen where they agree.
        width = 3.0 if direction == "up" else 1.6
        words = _WORDS[direction]
        traces.append(line(speed, values[number], words, color, unit=unit, dash=dash, width=width))
    return traces


def _dots(sweep: Any, values: Any, chosen: Any, name: str, color: str, symbol: str) -> Any:
    x = np.concatenate([displayed("speed", sweep.speed[each]) for each in chosen])
    y = np.concatenate([row[each] for row, each in zip(values, chosen, strict=True)])
    if not x.size:
        return []
    made = line(x, y, name, color)
    del made["line"]
    return [{**made, "mode": "markers", "marker": {"color": color, "size": 6, "symbol": symbol}}]


def _jumps(sweep: Any, values: Any, unit: str) -> list[dict[str, Any]]:
    traces = []
    for number, jump in enumerate(sweep.jumps):
        row = sweep.directions.index(jump.direction)
        at = [int(np.argmin(np.abs(sweep.mesh_frequency - f))) for f in (jump.before, jump.after)]
        x = displayed("speed", sweep.speed[at])
        made = line(x, values[row][at], "jump", MUTED, unit=unit, dash="dot", width=1.2)
        marker = {"symbol": "arrow", "angleref": "previous", "size": [0, 11], "color": MUTED}
        mode = {"mode": "lines+markers", "marker": marker, "showlegend": number == 0}
        traces.append({**made, **mode, "legendgroup": "jump"})
    return traces


def _title(sweep: Any) -> str:
    where = np.flatnonzero(sweep.differs)
    if where.size:
        ends = (rounded("speed", float(sweep.speed[k])) for k in (where[0], where[-1]))
        told = f"The ways up and down differ at {where.size} of {sweep.differs.size} speeds"
        return "{}, from {} to {}".format(told, *ends)
    lost = int(np.count_nonzero(~sweep.stable))
    if lost:
        return f"{lost} of {sweep.stable.size} motions are not stable or do not repeat"
    top = int(np.argmax(sweep.rms[0, :, 0]))
    return f"The mesh vibrates most at {rounded('speed', float(sweep.speed[top]))}"


@drawing(
    "speed_sweep",
    heading="Steady motions over the speed",
    caption="How strong the steady motion is when the speed goes up slowly, and when it comes "
    "down. Where the two differ, two motions are possible and the one before decides; arrows are "
    "jumps. Crosses are motions that are not stable or do not repeat.",
    needs=_missing,
)
def speed_sweep(sweep: Any, *, signal: str | None = None) -> Any:
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
            [*_curves(sweep, rms, shown), *_jumps(sweep, rms, shown), *marks], top, 1.3,
        ),
        Panel(f"Range [{shown}]", [*_curves(sweep, span, shown), *_jumps(sweep, span, shown)], top),
    ]  # fmt: skip
    loss = 100.0 * sweep.contact_loss.max(axis=-1, initial=0.0)
    if np.any(loss > 0.0):
        panels.append(Panel("Contact lost [%]", _curves(sweep, loss, "%"), top, 0.8))
    return stack(_title(sweep), axis_label("speed"), panels, {"hovermode": "closest"})
