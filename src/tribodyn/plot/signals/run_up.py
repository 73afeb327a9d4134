"""Run-up and run-down: level and mesh orders over the speed, map over frequency."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.drawing import Sketch, drawing
from tribodyn.plot.signals.spectra import amplitude_heatmap
from tribodyn.plot.theme.colors import COLORS, MUTED, TOTAL, WHEEL
from tribodyn.plot.theme.labels import axis_label, displayed, readable, rounded, significant
from tribodyn.plot.theme.panels import Panel, stack
from tribodyn.plot.theme.style import Trace, dots, line
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.analysis import OrderMap
    from tribodyn.dynamics import RunUp

#: Default number of order cuts, highest order of the search, most labelled resonances.
_ORDER_CURVES, _HIGHEST_ORDER, _NAMED = 4, 12, 6
#: A rising or falling part of the run is plotted separately from this many mesh cycles on.
_MIN_CYCLES = 32
#: Peaks of an order closer than this relative speed difference count as one.
_APART = 0.05
_ROWS, _ORDERS = 320, 8
#: Modes with less of their strain in the contacts are not driven by the mesh.
_SHARE = 0.01


def signal_label(run: RunUp, signal: str) -> tuple[str, str]:
    """Label and display unit of a signal of a run-up."""
    unit = run.signal(signal)[1]
    label = signal.replace("_", " ")
    if signal in run.names:
        label = f"acceleration of {label}"
    return label, "µm" if unit == "m" else readable(unit)


def _parts(run: RunUp) -> list[tuple[Any, str]]:
    """Rising and falling part of the run with the dash of their curves."""
    rate = run.cycles.rate
    parts = ((("up", "solid"), rate > 0.0), (("down", "dot"), rate < 0.0))
    return [part for part, cycles in parts if np.count_nonzero(cycles) > _MIN_CYCLES]


def _strongest(run: RunUp, signal: str, part: Any) -> list[float]:
    from tribodyn.analysis import order_cut

    highest = min(_HIGHEST_ORDER, run.samples // 2 - 1)
    cuts = (order_cut(run, order, signal, part=part) for order in range(1, highest + 1))
    tops = [float(cut.amplitude.max()) for cut in cuts]
    return sorted(float(k + 1) for k in np.argsort(tops)[::-1][:_ORDER_CURVES])


def _marks(peaks: Sequence[Any], factor: float, unit: str) -> Trace:
    """Markers on the peaks, labelled with order and mode."""
    texts, facts = [], []
    for peak in peaks:
        texts.append(f"{peak.order:g}×" + f"<br>mode {peak.mode}" * (peak.mode >= 0))
        mode = ", no natural mode close by"
        if peak.mode >= 0:
            mode = f", mode {peak.mode} at {significant(peak.mode_frequency, 4)} Hz"
        if peak.mains:
            mode += f", close to the mains frequency of {peak.mains:g} Hz"
        facts.append(f"order {peak.order:g} at {significant(peak.frequency, 4)} Hz{mode}")
    x = displayed("speed", np.array([peak.speed for peak in peaks]))
    marker = {"color": TOTAL, "size": 8, "symbol": "circle-open", "line": {"width": 2}}
    marks = dots(x, [factor * peak.amplitude for peak in peaks], "resonance", marker, text=texts,
                 textposition="top center", textfont={"size": 11, "color": MUTED})  # fmt: skip
    hover = f"%{{customdata}}: %{{y:.4g}} {unit}<extra>resonance</extra>"
    more = {"mode": "markers+text", "cliponaxis": False, "customdata": facts}
    return {**marks, **more, "hovertemplate": hover}


def _distinct(peaks: Sequence[Any]) -> list[Any]:
    """Drop resonances close to a stronger one of the same order."""
    distinct: list[Any] = []
    for peak in peaks:
        same = [other.speed for other in distinct if other.order == peak.order]
        if all(abs(peak.speed / speed - 1.0) >= _APART for speed in same):
            distinct.append(peak)
    return distinct


def _title(levels: list[Any], peaks: Sequence[Any], unit: str, factor: float) -> str:
    top = max(levels, key=lambda level: float(level.rms.max()))
    at = int(np.argmax(top.rms))
    direction = " while the speed falls" if len(levels) > 1 and top is levels[1] else ""
    text = f"Loudest at {rounded('speed', top.speed[at])}{direction}: "
    text += f"{significant(factor * float(top.rms[at]))} {unit} rms"
    close = [peak for peak in peaks if abs(peak.speed / top.speed[at] - 1.0) < 0.05]
    return text + (f", from order {close[0].order:g} of the mesh" if close else "")


@drawing(
    heading="Run-up",
    of="RunUp",
    made_by="Call tribodyn.dynamics.run_up(...) or tribodyn.run_up(case) and its plot method.",
)
def run_up(
    run: RunUp, *, signal: str = "contact_force", orders: Sequence[float] | None = None
) -> Sketch:
    """Draw overall level and order cuts over the speed.

    Overall level and mesh orders over the speed: solid for rising, dotted for falling speed. Where
    the two differ, the response jumps or the speed changes too quickly for a resonance to build up.
    Circles mark peaks of an order and the natural mode that it excites.

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

    label, unit = signal_label(run, signal)
    factor = 1e6 if unit == "µm" else 1.0
    parts = _parts(run) or [("all", "solid")]
    chosen = list(orders) if orders else _strongest(run, signal, parts[0][0])
    levels = [overall_level(run, signal, part=part) for part, _ in parts]
    overall = [
        line(displayed("speed", level.speed), factor * level.rms, part, TOTAL, unit=unit, dash=dash)
        for level, (part, dash) in zip(levels, parts, strict=True)
    ]
    cuts = []
    for color, order in zip(COLORS, chosen, strict=False):
        for number, (part, dash) in enumerate(parts):
            cut = order_cut(run, order, signal, part=part)
            style: Trace = {"unit": unit, "dash": dash, "width": 1.8, "legendgroup": f"{order:g}"}
            x, style["showlegend"] = displayed("speed", cut.speed), number == 0
            cuts.append(line(x, factor * cut.amplitude, f"order {order:g}", color, **style))
    peaks = resonances(run, signal, orders=chosen, part=parts[0][0])
    if peaks:
        cuts.append(_marks(_distinct(peaks)[:_NAMED], factor, unit))
    top = {"rangemode": "tozero"}
    panels = [
        Panel(f"Alternating rms of<br>{label} [{unit}]", overall, top),
        Panel(f"Amplitude [{unit}]", cuts, top, 1.5),
    ]
    title = _title(levels, peaks, unit, factor)
    return stack(title, axis_label("speed"), panels, {"hovermode": "closest"})


def _over_frequency(orders: OrderMap, frequency: Array) -> Array:
    """Resample an order map on a grid of frequencies, preserving the largest amplitudes."""
    per_order = orders.speed / (2.0 * np.pi)
    spectra = np.empty((frequency.size, orders.speed.size))
    step = frequency[1] - frequency[0]
    # The mean leaks into low orders within the main lobe of the window.
    lines = np.where(orders.order[:, None] > 2.5 / orders.revolutions, orders.amplitude, 0.0)
    for block, hertz in enumerate(per_order):
        frequencies = orders.order * hertz
        spectra[:, block] = np.interp(frequency, frequencies, lines[:, block], right=0.0)
        row = np.round((frequencies - frequency[0]) / step).astype(int)
        inside = (row >= 0) & (row < frequency.size)
        np.maximum.at(spectra[:, block], row[inside], lines[inside, block])
    return spectra


def _orders(run: RunUp, speed: Array, top: float, several: bool) -> list[Trace]:
    low, high = float(speed.min()), float(speed.max())
    across = np.linspace(low, high, 200)
    traces = []
    for order in range(1, _ORDERS + 1):
        values = order * across * run.teeth / (2.0 * np.pi)
        visible = values <= 0.97 * top
        if not visible.any():
            continue
        texts = [""] * across.size
        texts[int(np.flatnonzero(visible)[-1])] = f"{order}×" if several else str(order)
        style: Trace = {"unit": "Hz", "dash": "dot", "width": 0.8, "mode": "lines+text"}
        style |= {"text": texts[: int(visible.sum())], "textposition": "top left"}
        x, name = displayed("speed", across[visible]), f"mesh order {order}"
        traces.append(line(x, values[visible], name, MUTED, showlegend=False, **style))
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
            text = [f"mode {number}: {significant(natural, 4)} Hz", ""]
            style: Trace = {"mode": "lines+text", "text": text, "textposition": "top right"}
            style |= {"unit": "Hz", "dash": "dash", "width": 1.2, "textfont": {"color": WHEEL}}
            traces.append(line(ends, [natural] * 2, name, WHEEL, showlegend=False, **style))
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


def _on_one_scale(surfaces: list[tuple[float, Trace]]) -> None:
    """Give all panels one colour scale, relative to the largest amplitude."""
    largest = max(top for top, _ in surfaces)
    has_scale = False
    for top, surface in surfaces:
        surface["z"] = np.maximum(surface["z"] + np.log10(top / largest), surface["zmin"])
        surface["showscale"] = top == largest and not has_scale
        has_scale = has_scale or surface["showscale"]


@drawing(
    heading="Run-up over frequency",
    of="RunUp",
    made_by="Call tribodyn.dynamics.run_up(...) or tribodyn.run_up(case) and its plot_map method.",
)
def run_up_map(
    run: RunUp, *, signal: str = "contact_force", highest_frequency: float | None = None
) -> Sketch:
    """Draw amplitudes over speed and frequency, one panel for each direction.

    Amplitudes over speed and frequency. Rising lines are mesh orders, horizontal lines natural
    modes that strain the mesh; an order resonates where they cross. Amplitudes between the orders
    are transients after a jump or non-periodic motion.

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

    quantity, display_unit = signal_label(run, signal)
    unit = run.signal(signal)[1]
    top = highest_frequency or _top(run)
    panels, loudest, surfaces = [], (0.0, 0.0), []
    parts = _parts(run) or [("all", "")]
    for part, _ in parts:
        orders = run_up_order_map(run, signal, part=part)
        order = np.argsort(orders.speed, kind="stable")
        speed = orders.speed[order]
        frequency = np.linspace(0.1 * run.profile.lowest, top, _ROWS)
        amplitude = _over_frequency(orders, frequency)[:, order]
        factor = 1e6 if unit == "m" else 1.0
        place, level_unit = (displayed("speed", speed), frequency), "um" if unit == "m" else unit
        hover = "%{y:.5g} Hz at %{x:.4g}"
        surface = amplitude_heatmap(*place, factor * amplitude, level_unit, hover)
        surfaces.append((float(amplitude.max()) or 1.0, surface))
        line_number, block = orders.strongest()
        if orders.amplitude[line_number, block] > loudest[0]:
            hertz = orders.order[line_number] * float(orders.speed[block]) / (2.0 * np.pi)
            loudest = float(orders.amplitude[line_number, block]), hertz
        traces = [surface, *_orders(run, speed, top, True), *_modes(run, speed, top)]
        label = axis_label("frequency", f"Frequency, {part}" if len(parts) > 1 else "Frequency")
        panels.append(Panel(label, traces, {"range": [0.0, top]}, 1.6))
    _on_one_scale(surfaces)
    ends = displayed("speed", np.array([run.speed.min(), run.speed.max()])).tolist()
    level = significant((1e6 if unit == "m" else 1.0) * loudest[0])
    title = (
        f"Strongest line of the {quantity}: {level} {readable(display_unit)} at "
        f"{significant(loudest[1], 4)} Hz"
    )
    layout = {"hovermode": "closest", "xaxis": {"range": ends}}
    return stack(title, axis_label("speed"), panels, layout)
