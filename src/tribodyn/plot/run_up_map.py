"""Amplitudes of a run-up over speed and frequency, with mesh orders and natural modes."""

from __future__ import annotations

from typing import Any

import numpy as np

from tribodyn.drawing import drawing
from tribodyn.plot.labels import axis_label, displayed, readable, significant
from tribodyn.plot.run_up import _missing, _parts, signal_words
from tribodyn.plot.spectrogram import amplitude_heatmap
from tribodyn.plot.style import MUTED, WHEEL, Panel, line, stack
from tribodyn.types import Array

_ROWS, _ORDERS = 320, 8
#: Modes with less of their strain in the contacts are not driven by the mesh.
_SHARE = 0.01


def _over_frequency(made: Any, teeth: int, frequency: Array) -> Array:
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


def _orders(run: Any, speed: Array, top: float, several: bool) -> list[dict[str, Any]]:
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
            displayed("speed", across[seen]), values[seen], f"mesh order {order}", MUTED,
            unit="Hz", dash="dot", width=0.8,
        )  # fmt: skip
        text = {"mode": "lines+text", "text": words[: int(seen.sum())]}
        traces.append({**made, **text, "textposition": "top left", "showlegend": False})
    return traces


def _modes(run: Any, speed: Array, top: float) -> list[dict[str, Any]]:
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


def _top(run: Any) -> float:
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
    needs=_missing,
)
def run_up_map(
    run: Any, *, signal: str = "contact_force", highest_frequency: float | None = None
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
        amplitude = _over_frequency(made, run.teeth, frequency)[:, order]
        factor = 1e6 if unit == "m" else 1.0
        surface = amplitude_heatmap(
            displayed("speed", speed), frequency, factor * amplitude,
            "um" if unit == "m" else unit, "%{y:.5g} Hz at %{x:.4g}",
        )  # fmt: skip
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
