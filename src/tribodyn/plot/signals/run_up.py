"""A run-up and run-down: level and mesh orders over the speed, and over frequency."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.drawing import drawing
from tribodyn.plot.look.labels import axis_label, displayed, readable, rounded, significant
from tribodyn.plot.look.panels import Panel, stack
from tribodyn.plot.look.style import MUTED, PAIR_COLORS, PINION, TOTAL, WHEEL, Trace, line
from tribodyn.plot.signals.maps import amplitude_heatmap
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.analysis import OrderMap
    from tribodyn.dynamics import RunUp

_COLORS = (PINION, WHEEL, *PAIR_COLORS)
#: Orders that are drawn by default, of those looked at, and resonances that are named.
_DRAWN, _LOOKED, _NAMED = 4, 12, 6
#: Fewest mesh cycles of a part that is drawn by itself.
_FEW = 32
#: Peaks of one order nearer than this share of the speed are one.
_APART = 0.05
_ROWS, _ORDERS = 320, 8
#: Modes with less of their strain in the contacts are not driven by the mesh.
_SHARE = 0.01


def signal_words(run: RunUp, signal: str) -> tuple[str, str]:
    """Words and display unit of a signal of a run-up."""
    unit = run.signal(signal)[1]
    words = signal.replace("_", " ")
    if signal in run.names:
        words = f"acceleration of {words}"
    return words, "µm" if unit == "m" else readable(unit)


def _parts(run: RunUp) -> list[tuple[Any, str]]:
    """Parts of the run and the dash of their curves."""
    rate = run.cycles.rate
    found: list[tuple[Any, str]] = [("up", "solid")] if np.count_nonzero(rate > 0.0) > _FEW else []
    return found + ([("down", "dot")] if np.count_nonzero(rate < 0.0) > _FEW else [])


def _strongest(run: RunUp, signal: str, part: Any) -> list[float]:
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
        + (
            f", mode {each.mode} at {significant(each.mode_frequency, 4)} Hz"
            if each.mode >= 0
            else ", no natural mode near"
        )
        + (f", near the mains of {each.mains:g} Hz" if each.mains else "")
        for each in found
    ]
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
        close = [
            abs(each.speed / one.speed - 1.0) < _APART for one in kept if one.order == each.order
        ]
        if not any(close):
            kept.append(each)
    return kept


def _title(levels: list[Any], found: Sequence[Any], unit: str, factor: float) -> str:
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
    of="RunUp",
    made_by="Call tribodyn.dynamics.run_up(...) or tribodyn.run_up(case) and its plot method.",
)
def run_up(
    run: RunUp, *, signal: str = "contact_force", orders: Sequence[float] | None = None
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
                displayed("speed", cut.speed),
                factor * cut.amplitude,
                f"order {order:g}",
                color,
                unit=unit,
                dash=dash,
                width=1.8,
            )
            cuts.append({**trace, "showlegend": number == 0, "legendgroup": f"{order:g}"})
    found = resonances(run, signal, orders=chosen, part=parts[0][0])
    if found:
        cuts.append(_marks(_apart(found)[:_NAMED], factor, unit))
    top = {"rangemode": "tozero"}
    return stack(
        _title(levels, found, unit, factor),
        axis_label("speed"),
        [
            Panel(f"Alternating rms of<br>{words} [{unit}]", overall, top),
            Panel(f"Amplitude [{unit}]", cuts, top, 1.5),
        ],
        {"hovermode": "closest"},
    )


def _over_frequency(made: OrderMap, frequency: Array) -> Array:
    """Amplitudes of an order map on a grid of frequencies; the largest in each row is kept."""
    per_order = made.speed / (2.0 * np.pi)
    found = np.empty((frequency.size, made.speed.size))
    step = frequency[1] - frequency[0]
    # The mean reaches into the orders beside zero as far as the main lobe of the window.
    lines = np.where(made.order[:, None] > 2.5 / made.revolutions, made.amplitude, 0.0)
    for block, turn in enumerate(per_order):
        own = made.order * turn
        found[:, block] = np.interp(frequency, own, lines[:, block], right=0.0)
        row = np.round((own - frequency[0]) / step).astype(int)
        inside = (row >= 0) & (row < frequency.size)
        np.maximum.at(found[:, block], row[inside], lines[inside, block])
    return found


def _orders(run: RunUp, speed: Array, top: float, several: bool) -> list[Trace]:
    low, high = float(speed.min()), float(speed.max())
    across = np.linspace(low, high, 200)
    traces = []
    for order in range(1, _ORDERS + 1):
        values = order * across * run.teeth / (2.0 * np.pi)
        seen = values <= 0.97 * top
        if not seen.any():
            continue
        words = [""] * across.size
        words[int(np.flatnonzero(seen)[-1])] = f"{order}×" if several else str(order)
        made = line(
            displayed("speed", across[seen]),
            values[seen],
            f"mesh order {order}",
            MUTED,
            unit="Hz",
            dash="dot",
            width=0.8,
        )
        text = {"mode": "lines+text", "text": words[: int(seen.sum())]}
        traces.append({**made, **text, "textposition": "top left", "showlegend": False})
    return traces


def _modes(run: RunUp, speed: Array, top: float) -> list[Trace]:
    if run.modes is None:
        return []
    ends = displayed("speed", np.array([speed.min(), speed.max()]))
    share = run.modes.contact_share if run.modes.contacts else np.ones(run.modes.frequency.size)
    traces = []
    for number, (natural, part) in enumerate(zip(run.modes.frequency, share, strict=True)):
        if 0.0 < natural < top and part >= _SHARE:
            name = f"mode {number}, {100.0 * part:.0f} % mesh"
            made = line(ends, [natural, natural], name, WHEEL, unit="Hz", dash="dash", width=1.2)
            text = [f"mode {number}: {significant(float(natural), 4)} Hz", ""]
            label = {"mode": "lines+text", "text": text, "textposition": "top right"}
            traces.append({**made, **label, "showlegend": False, "textfont": {"color": WHEEL}})
    return traces


def _top(run: RunUp) -> float:
    top = 6.0 * float(run.profile.highest)
    if run.modes is not None and run.modes.contacts:
        driven = run.modes.frequency[run.modes.contact_share >= 10.0 * _SHARE]
        driven = driven[driven > 0.0]
        reach = 0.5 * run.samples * float(run.profile.highest)
        if driven.size:
            top = max(top, min(1.25 * float(driven[0]), reach))
    return top


def _on_one_scale(surfaces: list[tuple[float, dict[str, Any]]]) -> None:
    """Let all panels count their colours from the largest amplitude of all."""
    largest = max(top for top, _ in surfaces)
    shown = False
    for top, surface in surfaces:
        surface["z"] = np.maximum(surface["z"] + np.log10(top / largest), surface["zmin"])
        surface["showscale"] = top == largest and not shown
        shown = shown or surface["showscale"]


@drawing(
    "run_up_map",
    heading="Run-up over frequency",
    caption="Which frequencies are there at what speed. Rising lines are orders of the mesh, "
    "level lines natural modes that strain the mesh; where they cross, an order resonates. What "
    "lies between the orders rings after a jump or never repeats.",
    of="RunUp",
    made_by="Call tribodyn.dynamics.run_up(...) or tribodyn.run_up(case) and its plot_map method.",
)
def run_up_map(
    run: RunUp, *, signal: str = "contact_force", highest_frequency: float | None = None
) -> Any:
    """Draw amplitudes over speed and frequency, one panel for each direction.

    Parameters
    ----------
    run : RunUp
        What :func:`tribodyn.dynamics.run_up` returns.
    signal : str
        ``"deflection"``, ``"contact_force"``, a coordinate (its acceleration) or an output.
    highest_frequency : float, optional
        Top of the panels [Hz]; by default six times the highest mesh frequency, and above the first
        mode that strains the mesh.

    Returns
    -------
    plotly.graph_objects.Figure
    """
    from tribodyn.analysis import run_up_order_map

    words, shown = signal_words(run, signal)
    unit = run.signal(signal)[1]
    top = highest_frequency or _top(run)
    panels, loudest, surfaces = [], (0.0, 0.0), []
    parts = _parts(run) or [("all", "")]
    for part, _ in parts:
        made = run_up_order_map(run, signal, part=part)
        order = np.argsort(made.speed, kind="stable")
        speed = made.speed[order]
        frequency = np.linspace(0.1 * run.profile.lowest, top, _ROWS)
        amplitude = _over_frequency(made, frequency)[:, order]
        factor = 1e6 if unit == "m" else 1.0
        surface = amplitude_heatmap(
            displayed("speed", speed),
            frequency,
            factor * amplitude,
            "um" if unit == "m" else unit,
            "%{y:.5g} Hz at %{x:.4g}",
        )
        surfaces.append((float(amplitude.max()) or 1.0, surface))
        line_number, block = made.strongest()
        if made.amplitude[line_number, block] > loudest[0]:
            turn = float(made.speed[block]) / (2.0 * np.pi)
            loudest = (float(made.amplitude[line_number, block]), made.order[line_number] * turn)
        traces = [surface, *_orders(run, speed, top, True), *_modes(run, speed, top)]
        label = axis_label("frequency", f"Frequency, {part}" if len(parts) > 1 else "Frequency")
        panels.append(Panel(label, traces, {"range": [0.0, top]}, 1.6))
    _on_one_scale(surfaces)
    ends = displayed("speed", np.array([run.speed.min(), run.speed.max()])).tolist()
    level = significant((1e6 if unit == "m" else 1.0) * loudest[0])
    return stack(
        f"Strongest line of the {words}: {level} {readable(shown)} at "
        f"{significant(loudest[1], 4)} Hz",
        axis_label("speed"),
        panels,
        {"hovermode": "closest", "xaxis": {"range": ends}},
    )
