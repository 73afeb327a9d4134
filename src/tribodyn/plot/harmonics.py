"""Amplitudes of the mesh harmonics as bars, with a switch between linear and logarithmic."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from tribodyn.analysis import Spectrum, amplitude_spectrum
from tribodyn.plot.labels import axis_label, display_unit, displayed, significant
from tribodyn.plot.motion import is_periodic
from tribodyn.plot.style import Panel, button_row
from tribodyn.types import Array

#: Highest mesh harmonic drawn.
_HIGHEST = 80
#: Decades below the largest line that count: those that the logarithmic scale shows.
_DECADES = 4.0


def no_harmonics(result: Any) -> str:
    """Tell why a result has no mesh harmonics."""
    if is_periodic(result):
        return ""
    return (
        "Mesh harmonics belong to a steady state; this run is a transient. Choose "
        'solver.method = "steady".'
    )


def _spectrum(result: Any, signal: Array) -> Spectrum:
    """Spectrum as far as the steps resolve it, eight to a wave, and no further than is readable."""
    steps = result.response.time.size // result.response.periods
    return amplitude_spectrum(result.response, signal, highest=min(_HIGHEST, steps // 8))


def harmonic_panel(
    result: Any,
    quantity: str,
    label: str,
    signals: Sequence[tuple[str, str, Array]],
) -> Panel:
    """Show the harmonics of one or two signals side by side."""
    hertz, unit = display_unit("frequency"), display_unit(quantity)
    traces = []
    for name, color, signal in signals:
        spectrum = _spectrum(result, signal)
        hover = f"%{{y:.4g}} {unit} at %{{customdata:.5g}} {hertz}<extra>{name}</extra>"
        traces.append(
            {
                "type": "bar",
                "x": spectrum.order,
                "y": displayed(quantity, spectrum.amplitude),
                "name": name,
                "marker": {"color": color},
                "customdata": displayed("frequency", spectrum.frequency),
                "hovertemplate": hover,
            }
        )
    return Panel(axis_label(quantity, label), traces)


def strongest(panel: Panel) -> str:
    """Name the mesh harmonic with the largest amplitude in the first curve of a panel."""
    bars = panel.traces[0]
    top = int(np.argmax(bars["y"]))
    frequency = significant(float(bars["customdata"][top]))
    return f"{bars['x'][top]:g} ({frequency} {display_unit('frequency')})"


def harmonic_layout(panels: Sequence[Panel]) -> dict[str, Any]:
    """Layout of a figure of harmonics, with buttons for a linear and a logarithmic scale."""
    linear: dict[str, Any] = {}
    logarithmic: dict[str, Any] = {}
    for number, panel in enumerate(panels, start=1):
        axis = f"yaxis{'' if number == 1 else number}"
        linear |= {f"{axis}.type": "linear", f"{axis}.autorange": True}
        logarithmic |= {f"{axis}.type": "log", f"{axis}.range": _decades(panel)}
    orders = {"range": [0.4, _last_order(panels) + 0.6], "showgrid": False}
    menu = button_row([("linear", linear), ("logarithmic", logarithmic)])
    return {"xaxis": orders, "updatemenus": [menu]}


def _last_order(panels: Sequence[Panel]) -> float:
    """Highest order whose line counts beside the largest of its unit in the figure."""
    largest: dict[str, float] = {}
    for panel in panels:
        unit = panel.label.rpartition("[")[2]
        top = max(float(np.max(trace["y"])) for trace in panel.traces)
        largest[unit] = max(top, largest.get(unit, 0.0))
    last = 1.0
    for panel in panels:
        least = 10.0**-_DECADES * largest[panel.label.rpartition("[")[2]]
        for trace in panel.traces:
            seen = np.asarray(trace["x"])[np.asarray(trace["y"]) > least]
            last = max(last, float(np.max(seen, initial=1.0)))
    return last


def _decades(panel: Panel) -> list[float]:
    """Range of a logarithmic axis: below it there is only rounding."""
    top = max(float(np.max(trace["y"])) for trace in panel.traces)
    exponent = math.log10(top) if top > 0.0 else 0.0
    return [exponent - _DECADES, exponent + 0.3]
