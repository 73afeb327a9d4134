"""A run-up and run-down: overall level and mesh orders over the speed, resonances marked."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from tribodyn.drawing import drawing
from tribodyn.plot.labels import axis_label, displayed, readable, rounded, significant
from tribodyn.plot.style import MUTED, PAIR_COLORS, PINION, TOTAL, WHEEL, Panel, line, stack

_COLORS = (PINION, WHEEL, *PAIR_COLORS)
#: Orders that are drawn by default, of those looked at, and resonances that are named.
_DRAWN, _LOOKED, _NAMED = 4, 12, 6
#: Fewest mesh cycles of a part that is drawn by itself.
_FEW = 32
#: Peaks of one order nearer than this share of the speed are one.
_APART = 0.05


def signal_words(run: Any, signal: str) -> tuple[str, str]:
    """Words and display unit of a signal of a run-up."""
    unit = run.signal(signal)[1]
    words = signal.replace("_", " ")
    if signal in run.names:
        words = f"acceleration of {words}"
    return words, "µm" if unit == "m" else readable(unit)


def _missing(result: Any) -> str:
    if hasattr(result, "profile") and hasattr(result, "cycles"):
        return ""
    return (
        "This figure shows a run-up. Call tribodyn.dynamics.run_up(...) or tribodyn.run_up(case) "
        "and its plot method."
    )


def _parts(run: Any) -> list[tuple[Any, str]]:
    """Parts of the run and the dash of their curves."""
    rate = run.cycles.rate
    found: list[tuple[Any, str]] = [("up", "solid")] if np.count_nonzero(rate > 0.0) > _FEW else []
    return found + ([("down", "dot")] if np.count_nonzero(rate < 0.0) > _FEW else [])


def _strongest(run: Any, signal: str, part: Any) -> list[float]:
    from tribodyn.analysis import order_cut

    most = min(_LOOKED, run.samples // 2 - 1)
    tops = [
        float(order_cut(run, order, signal, part=part).amplitude.max())
        for order in range(1, most + 1)
    ]
    return sorted(float(k + 1) for k in np.argsort(tops)[::-1][:_DRAWN])


def _marks(found: Sequence[Any], factor: float, unit: str) -> dict[str, Any]:
    """Dots on the peaks, named by order and mode."""
    words = [
        f"{each.order:g}×" + (f"<br>mode {each.mode}" if each.mode >= 0 else "") for each in found
    ]
    facts = [
        f"order {each.order:g} at {significant(each.frequency, 4)} Hz"
        + (f", mode {each.mode} at {significant(each.mode_frequency, 4)} Hz" if each.mode >= 0
           else ", no natural mode near")
        + (f", near the mains of {each.mains:g} Hz" if each.mains else "")
        for each in found
    ]  # fmt: skip
    return {
        "type": "scatter",
        "mode": "markers+text",
        "x": displayed("speed", np.array([each.speed for each in found])),
        "y": [factor * each.amplitude for each in found],
        "text": words,
        "textposition": "top center",
        "textfont": {"size": 11, "color": MUTED},
        "cliponaxis": False,
        "name": "resonance",
        "marker": {"color": TOTAL, "size": 8, "symbol": "circle-open", "line": {"width": 2}},
        "customdata": facts,
        "hovertemplate": f"%{{customdata}}: %{{y:.4g}} {unit}<extra>resonance</extra>",
    }


def _apart(found: Sequence[Any]) -> list[Any]:
    """Resonances of which no stronger one of the same order stands close by."""
    kept: list[Any] = []
    for each in found:
        close = [abs(each.speed / one.speed - 1.0) < _APART for one in kept
                 if one.order == each.order]  # fmt: skip
        if not any(close):
            kept.append(each)
    return kept


def _title(run: Any, levels: list[Any], found: Sequence[Any], unit: str, factor: float) -> str:
    top = max(levels, key=lambda level: float(level.rms.max()))
    at = int(np.argmax(top.rms))
    way = " on the way down" if len(levels) > 1 and top is levels[1] else ""
    told = f"Loudest at {rounded('speed', float(top.speed[at]))}{way}: "
    told += f"{significant(factor * float(top.rms[at]))} {unit} rms"
    near = [each for each in found if abs(each.speed / top.speed[at] - 1.0) < 0.05]
    return told + (f", from order {near[0].order:g} of the mesh" if near else "")


@drawing(
    "run_up",
    heading="Run-up",
    caption="Overall level and orders of the mesh over the speed. Solid on the way up, dotted on "
    "the way down; where the two differ, the motion jumps or the speed changes too quickly for a "
    "resonance to build up. Circles mark peaks of an order and the natural mode that it meets.",
    needs=_missing,
)
def run_up(
    run: Any, *, signal: str = "contact_force", orders: Sequence[float] | None = None
) -> Any:
    """Draw overall level and order cuts over the speed.

    Parameters
    ----------
    run : RunUp
        What :func:`tribodyn.dynamics.run_up` returns.
    signal : str
        ``"deflection"``, ``"contact_force"``, a coordinate (its acceleration) or an output.
    orders : sequence of float, optional
        Orders of the mesh; by default the four strongest of the first twelve.

    Returns
    -------
    plotly.graph_objects.Figure
    """
    from tribodyn.analysis import order_cut, overall_level, resonances

    words, unit = signal_words(run, signal)
    factor = 1e6 if unit == "µm" else 1.0
    parts = _parts(run) or [("all", "solid")]
    chosen = list(orders) if orders else _strongest(run, signal, parts[0][0])
    levels = [overall_level(run, signal, part=part) for part, _ in parts]
    overall = [
        line(displayed("speed", level.speed), factor * level.rms, part, TOTAL, unit=unit, dash=dash)
        for level, (part, dash) in zip(levels, parts, strict=True)
    ]
    cuts = []
    for color, order in zip(_COLORS, chosen, strict=False):
        for number, (part, dash) in enumerate(parts):
            cut = order_cut(run, order, signal, part=part)
            trace = line(
                displayed("speed", cut.speed), factor * cut.amplitude, f"order {order:g}", color,
                unit=unit, dash=dash, width=1.8,
            )  # fmt: skip
            cuts.append({**trace, "showlegend": number == 0, "legendgroup": f"{order:g}"})
    found = resonances(run, signal, orders=chosen, part=parts[0][0])
    if found:
        cuts.append(_marks(_apart(found)[:_NAMED], factor, unit))
    top = {"rangemode": "tozero"}
    return stack(
        _title(run, levels, found, unit, factor),
        axis_label("speed"),
        [
            Panel(f"Alternating rms of<br>{words} [{unit}]", overall, top),
            Panel(f"Amplitude [{unit}]", cuts, top, 1.5),
        ],
        {"hovermode": "closest"},
    )
