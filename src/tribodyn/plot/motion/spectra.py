"""Amplitudes of the mesh harmonics as bars, on a linear or a logarithmic scale."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.analysis import Spectrum, amplitude_spectrum
from tribodyn.plot.look.labels import axis_label, display_unit, displayed, rounded, significant
from tribodyn.plot.look.panels import Panel, event_lines, stack
from tribodyn.plot.look.style import TOTAL, button_row
from tribodyn.plot.mesh.cycle import run_drawing
from tribodyn.plot.motion.courses import DIRECTIONS, GEARS, words_of
from tribodyn.plot.motion.motion import Motion, no_translation
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.study import Result

#: Highest mesh harmonic drawn.
_HIGHEST = 80
#: Decades below the largest line that count on the logarithmic scale.
_DECADES = 4.0
#: The same on a linear scale.
_SEEN = 1.8
#: Left end of the axis of the orders, and the part of it within which marks share a name.
_FIRST, _APART = 0.4, 0.04


def _no_harmonics(result: Result) -> str:
    """Tell why a result has no mesh harmonics."""
    if Motion(result).periodic:
        return ""
    return (
        "Mesh harmonics belong to a steady state; this run is a transient. Choose "
        'solver.method = "steady".'
    )


def _spectrum(result: Result, signal: Array) -> Spectrum:
    """Spectrum as far as the steps resolve it, eight to a wave, and no further than is readable."""
    steps = result.response.time.size // result.response.periods
    return amplitude_spectrum(result.response, signal, highest=min(_HIGHEST, steps // 8))


def _panel(
    result: Result, quantity: str, label: str, signals: Sequence[tuple[str, str, Array]]
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


def _gear_panels(result: Result, quantity: str) -> list[Panel]:
    """Show the mesh harmonics of a signal of both gears."""
    if no_translation(result):
        return []
    motion = Motion(result)
    return [
        _panel(
            result,
            quantity,
            words_of(quantity, words),
            [(gear, color, motion.of_gear(quantity, gear, axis)) for gear, color in GEARS],
        )
        for axis, words in DIRECTIONS
    ]


def _strongest(panel: Panel) -> str:
    """Name the mesh harmonic with the largest amplitude in the first curve of a panel."""
    bars = panel.traces[0]
    top = int(np.argmax(bars["y"]))
    frequency = significant(float(bars["customdata"][top]))
    return f"{bars['x'][top]:g} ({frequency} {display_unit('frequency')})"


def _natural(result: Result, last: float) -> dict[str, Any]:
    """Mark the natural frequencies as far as the harmonics go, their names within the panel."""
    modes, marks = result.natural_modes, dict[float, list[str]]()
    for hertz in modes.frequency[modes.rigid :]:
        place = float(hertz) / result.mesh.mesh_frequency
        if _FIRST < place <= last:
            near = [at for at in marks if place - at < _APART * last]
            told = rounded("frequency", float(hertz))
            marks.setdefault(place, []).append("" if near else told)
            for at in near[:1]:
                marks[at].append(told)
    lines = event_lines((", ".join(filter(None, names)), at) for at, names in marks.items())
    upright = {"textangle": -90, "yanchor": "top", "xanchor": "left", "yshift": 0,
               "bgcolor": "rgba(255, 255, 255, 0.75)"}  # fmt: skip
    lines["annotations"] = [{**note, **upright} for note in lines["annotations"] if note["text"]]
    return lines


def _harmonic_layout(result: Result, panels: Sequence[Panel]) -> dict[str, Any]:
    """Layout of a figure of harmonics, with buttons for a linear and a logarithmic scale."""
    ends = [_last_order(panels, decades) + 0.6 for decades in (_SEEN, _DECADES)]
    linear: dict[str, Any] = {"xaxis.range": [_FIRST, ends[0]]}
    logarithmic: dict[str, Any] = {"xaxis.range": [_FIRST, ends[1]]}
    for number, panel in enumerate(panels, start=1):
        axis = f"yaxis{'' if number == 1 else number}"
        linear |= {f"{axis}.type": "linear", f"{axis}.autorange": True}
        logarithmic |= {f"{axis}.type": "log", f"{axis}.range": _decades(panel)}
    orders = {"range": [_FIRST, ends[0]], "showgrid": False}
    menu = button_row([("linear", linear), ("logarithmic", logarithmic)])
    return {"xaxis": orders, "updatemenus": [menu], **_natural(result, ends[0])}


def _last_order(panels: Sequence[Panel], decades: float) -> float:
    """Highest order whose line counts beside the largest of its unit in the figure."""
    largest: dict[str, float] = {}
    for panel in panels:
        unit = panel.label.rpartition("[")[2]
        top = max(float(np.max(trace["y"])) for trace in panel.traces)
        largest[unit] = max(top, largest.get(unit, 0.0))
    last = 1.0
    for panel in panels:
        least = 10.0**-decades * largest[panel.label.rpartition("[")[2]]
        for trace in panel.traces:
            seen = np.asarray(trace["x"])[np.asarray(trace["y"]) > least]
            last = max(last, float(np.max(seen, initial=1.0)))
    return last


def _decades(panel: Panel) -> list[float]:
    """Range of a logarithmic axis: below it there is only rounding."""
    top = max(float(np.max(trace["y"])) for trace in panel.traces)
    exponent = math.log10(top) if top > 0.0 else 0.0
    return [exponent - _DECADES, exponent + 0.3]


@run_drawing(
    "spectrum",
    heading="Spectra",
    caption="How strong each mesh harmonic is. Harmonic 1 is the mesh frequency, the teeth that "
    "pass in a second. Dotted lines are natural frequencies: a bar near one is amplified by it. "
    "The buttons switch to a logarithmic scale, on which small harmonics show.",
    missing=_no_harmonics,
)
def spectrum(result: Result) -> Any:
    """Draw the mesh harmonics of the transmission error and of the accelerations."""
    error = Motion(result).transmission_error
    panels = [
        _panel(
            result,
            "dynamic_transmission_error",
            "Transmission error",
            [("transmission error", TOTAL, error)],
        ),
        *_gear_panels(result, "acceleration"),
    ]
    return stack(
        f"Mesh harmonic {_strongest(panels[0])} is the strongest in the transmission error",
        "Mesh harmonic",
        panels,
        _harmonic_layout(result, panels),
    )


def _no_bearing_harmonics(result: Result) -> str:
    return no_translation(result) or _no_harmonics(result)


@run_drawing(
    "bearing_spectrum",
    heading="Spectra of the bearing forces",
    caption="What the bearings pass on to the housing, by mesh harmonic. A harmonic that meets a "
    "natural frequency of the housing is the one that is heard. Dotted lines are natural "
    "frequencies of the gears on their supports.",
    missing=_no_bearing_harmonics,
)
def bearing_spectrum(result: Result) -> Any:
    """Draw the mesh harmonics of the bearing forces."""
    panels = _gear_panels(result, "bearing_force")
    return stack(
        f"Mesh harmonic {_strongest(panels[0])} is the strongest on the pinion's bearing",
        "Mesh harmonic",
        panels,
        _harmonic_layout(result, panels),
    )
