"""Amplitudes of the mesh harmonics as bars, on a linear or a logarithmic scale."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from tribodyn.analysis import Spectrum, amplitude_spectrum
from tribodyn.drawing import Sketch
from tribodyn.plot.mesh.cycle import run_drawing
from tribodyn.plot.motion.motion import Motion, no_translation
from tribodyn.plot.motion.time_histories import GEARS, directions, wrapped_label
from tribodyn.plot.theme.colors import MUTED, TOTAL
from tribodyn.plot.theme.labels import axis_label, display_unit, displayed, rounded, significant
from tribodyn.plot.theme.panels import Panel, event_lines, stack
from tribodyn.plot.theme.style import TOP, Trace, bars, button_row
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.study import PairResult

#: Highest mesh harmonic drawn.
_HIGHEST = 80
#: Decades below the largest line that the logarithmic scale shows.
_DECADES = 4.0
#: The same on a linear scale.
_SEEN = 1.8
#: Left end of the axis of the orders, and the part of it within which marks share a name.
_FIRST, _APART = 0.4, 0.04
#: Last order up to which every order has its number.
_EVERY = 12.0
#: Least share of the strain in the mesh of modes that are marked, and most of them.
_REACHED, _MARKED = 0.01, 8
#: Height of two rows of numbers above the panels [px].
_NAMES = 30


def _no_harmonics(result: PairResult) -> str:
    """Reason why a result has no mesh harmonics; empty if it has."""
    if Motion(result).periodic:
        return ""
    return (
        "Mesh harmonics belong to a steady state; this run is a transient. Choose "
        'solver.method = "steady".'
    )


def _spectrum(result: PairResult, signal: Array) -> Spectrum:
    """Spectrum up to the order that eight steps per period resolve, at most 80."""
    steps = result.response.time.size // result.response.periods
    return amplitude_spectrum(result.response, signal, highest=min(_HIGHEST, steps // 8))


def _panel(
    result: PairResult, quantity: str, label: str, signals: Sequence[tuple[str, str, Array]]
) -> Panel:
    """Panel with the harmonics of one or two signals as grouped bars."""
    hertz, unit = display_unit("frequency"), display_unit(quantity)
    traces = []
    for name, color, signal in signals:
        spectrum = _spectrum(result, signal)
        hover = f"%{{y:.4g}} {unit} at %{{customdata:.5g}} {hertz}<extra>{name}</extra>"
        heights = displayed(quantity, spectrum.amplitude)
        at = displayed("frequency", spectrum.frequency)
        traces.append(bars(spectrum.order, heights, name, color, hover, customdata=at))
    return Panel(axis_label(quantity, label), traces)


def _gear_panels(result: PairResult, quantity: str) -> list[Panel]:
    """Panels with the mesh harmonics of a signal of both gears."""
    if no_translation(result):
        return []
    motion = Motion(result)
    return [
        _panel(
            result,
            quantity,
            wrapped_label(quantity, direction),
            [(gear, color, motion.of_gear(quantity, gear, axis)) for gear, color in GEARS],
        )
        for axis, direction in directions(result)
    ]


def _strongest(panels: Iterable[Panel]) -> str:
    """Name the mesh harmonic with the largest amplitude in the first curves of some panels."""
    tallest = max((panel.traces[0] for panel in panels), key=lambda bar: float(np.max(bar["y"])))
    top = int(np.argmax(tallest["y"]))
    frequency = significant(tallest["customdata"][top])
    return f"{tallest['x'][top]:g} ({frequency} {display_unit('frequency')})"


def _natural(result: PairResult, last: float) -> tuple[Trace, list[Trace]]:
    """Mark the natural frequencies in the range of the harmonics and list them in the legend."""
    # Numbers of close frequencies share one label above the panels.
    modes, places = result.natural_modes, list[tuple[str, float]]()
    shares, legend = modes.contact_share[modes.rigid :], list[Trace]()
    inside = modes.frequency[modes.rigid :] <= last * result.mesh.mesh_frequency
    least = max(_REACHED, float(np.sort([*np.zeros(_MARKED), *shares[inside]])[-_MARKED]))
    for number, hertz in enumerate(modes.frequency[modes.rigid :], start=1):
        place = float(hertz) / result.mesh.mesh_frequency
        if _FIRST < place <= last and shares[number - 1] >= least:
            places.append((str(number), place))
            name = f"{number}: {rounded('frequency', hertz)}"
            style = {"color": MUTED, "width": 1, "dash": "dot"}
            entry = {"type": "scatter", "mode": "lines", "x": [None], "y": [None]}
            legend.append({**entry, "name": name, "line": style})
    lines, groups = event_lines(places), list[list[tuple[str, float]]]()
    for mark in places:
        if groups and mark[1] - groups[-1][0][1] < _APART * last:
            groups[-1].append(mark)
        else:
            groups.append([mark])
    labels = [(", ".join(name for name, _ in group), group[0][1]) for group in groups]
    share = (places[-1][1] - places[0][1]) / last if len(places) > 1 else 1.0
    lines["annotations"] = event_lines(labels, share)["annotations"]
    return lines, legend


def _harmonic_figure(title: str, result: PairResult, panels: list[Panel]) -> Sketch:
    """Draw a figure of harmonics, with buttons for a linear and a logarithmic scale."""
    layout, legend = _harmonic_layout(result, panels)
    panels[0] = replace(panels[0], traces=[*panels[0].traces, *legend])
    sketch = stack(title, "Mesh harmonic", panels, layout)
    sketch.layout["margin"] |= {"t": TOP + _NAMES}
    sketch.layout["height"] += _NAMES
    return sketch


def _harmonic_layout(result: PairResult, panels: Sequence[Panel]) -> tuple[Trace, list[Trace]]:
    ends = [_last_order(panels, decades) + 0.6 for decades in (_SEEN, _DECADES)]
    linear: Trace = {"xaxis.range": [_FIRST, ends[0]]}
    logarithmic: Trace = {"xaxis.range": [_FIRST, ends[1]]}
    for number, panel in enumerate(panels, start=1):
        axis = f"yaxis{'' if number == 1 else number}"
        linear |= {f"{axis}.type": "linear", f"{axis}.autorange": True}
        logarithmic |= {f"{axis}.type": "log", f"{axis}.range": _decades(panel)}
    orders = {"range": [_FIRST, ends[0]], "showgrid": False}
    orders |= {"dtick": 1} if ends[0] < _EVERY else {}
    menu = button_row([("linear", linear), ("logarithmic", logarithmic)])
    menu["pad"] = {"b": 6 + _NAMES}
    lines, legend = _natural(result, ends[0])
    return {"xaxis": orders, "updatemenus": [menu], **lines}, legend


def _last_order(panels: Sequence[Panel], decades: float) -> float:
    """Highest order whose amplitude is within ``decades`` of the largest with the same unit."""
    largest: dict[str, float] = {}
    for panel in panels:
        unit = panel.label.rpartition("[")[2]
        top = max(float(np.max(trace["y"])) for trace in panel.traces)
        largest[unit] = max(top, largest.get(unit, 0.0))
    last = 1.0
    for panel in panels:
        least = 10.0**-decades * largest[panel.label.rpartition("[")[2]]
        for trace in panel.traces:
            visible = np.asarray(trace["x"])[np.asarray(trace["y"]) > least]
            last = max(last, float(np.max(visible, initial=1.0)))
    return last


def _decades(panel: Panel) -> list[float]:
    """Range of a logarithmic axis; amplitudes below it are rounding errors."""
    top = max(float(np.max(trace["y"])) for trace in panel.traces)
    exponent = math.log10(top) if top > 0.0 else 0.0
    return [exponent - _DECADES, exponent + 0.3]


@run_drawing(heading="Spectra", missing=_no_harmonics)
def spectrum(result: PairResult) -> Sketch:
    """Draw the mesh harmonics of the transmission error and of the accelerations.

    Amplitude of each mesh harmonic. Harmonic 1 is the mesh frequency, the number of teeth that
    engage per second. Dotted lines are the natural frequencies that the mesh strains most, numbered
    as in the table of results: they amplify the harmonics close to them. The buttons switch to a
    logarithmic scale, which shows the small harmonics.
    """
    quantity, error = "dynamic_transmission_error", Motion(result).transmission_error
    rows = [("transmission error", TOTAL, error)]
    panels = [
        _panel(result, quantity, "Transmission error", rows),
        *_gear_panels(result, "acceleration"),
    ]
    title = f"Mesh harmonic {_strongest(panels[:1])} is the strongest in the transmission error"
    return _harmonic_figure(title, result, panels)


def _no_bearing_harmonics(result: PairResult) -> str:
    return no_translation(result) or _no_harmonics(result)


@run_drawing(heading="Spectra of the bearing forces", missing=_no_bearing_harmonics)
def bearing_spectrum(result: PairResult) -> Sketch:
    """Draw the mesh harmonics of the bearing forces.

    Forces that the bearings transmit to the housing, by mesh harmonic. A harmonic close to a
    natural frequency of the housing dominates the noise. Dotted lines are the natural frequencies
    of the gears on their supports that the mesh strains most.
    """
    panels = _gear_panels(result, "bearing_force")
    title = f"Mesh harmonic {_strongest(panels)} is the strongest on the {GEARS[0][0]}'s bearing"
    return _harmonic_figure(title, result, panels)
