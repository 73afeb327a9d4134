"""Signal spectra, sidebands, order cuts and overall level over the speed."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np

from tribodyn.drawing import Sketch, drawing
from tribodyn.plot.signals.maps import amplitude_label, with_unit
from tribodyn.plot.theme.colors import MUTED, PINION, TOTAL, WHEEL
from tribodyn.plot.theme.labels import (
    axis_label,
    display_unit,
    displayed,
    label_with,
    readable,
    rounded,
    significant,
)
from tribodyn.plot.theme.panels import Panel, event_lines, from_zero, stack
from tribodyn.plot.theme.style import POWERS, Trace, bars, line, marked
from tribodyn.signals.spectrum import distinct_peaks
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.analysis import OrderCut, OverallLevel, Sidebands, SignalSpectrum, Spectrum

#: Most plotted lines of a spectrum, most marked peaks, and their least fraction of the largest.
_LINES, _PEAKS, _LEAST = 8000, 5, 0.02
#: Decades below the largest line of a power or density spectrum.
_DECADES = 8.0


def strongest_lines(place: Array, size: Array, most: int = _LINES) -> tuple[Array, Array]:
    """Thin a spectrum to the largest line of every interval, which preserves peaks."""
    if size.size <= most:
        return place, size
    starts = np.arange(0, size.size, -(-size.size // most))
    parts = np.split(size, starts[1:])
    largest = [a + int(np.argmax(part)) for a, part in zip(starts, parts, strict=True)]
    return place[largest], size[largest]


def spectrum_panel(spectrum: SignalSpectrum, to: float | None = None) -> Panel:
    """Panel of a spectrum without the line at zero; peaks of an amplitude spectrum are marked."""
    above = (spectrum.frequency > 0.0) & (spectrum.frequency <= (to or np.inf))
    frequency, size = strongest_lines(spectrum.frequency[above], spectrum.amplitude[above])
    unit = readable(spectrum.value_unit)
    curve = line(frequency, size, "spectrum", TOTAL, unit=unit, width=1.2)
    if spectrum.scaling == "amplitude":
        traces = [curve, *_peaks(spectrum, unit)]
        return from_zero(amplitude_label(spectrum.value_unit), traces, 1.4)
    scaling = "Mean square" if spectrum.scaling == "power" else "Spectral density"
    top = float(np.log10(size.max())) if size.max() > 0.0 else 0.0
    low = float(np.log10(max(size[size > 0.0].min(initial=1.0), 1e-300)))
    axis = {**POWERS, "range": [max(low, top - _DECADES) - 0.2, top + 0.3]}
    return Panel(label_with(scaling, unit), [curve], axis, 1.4)


def _peaks(spectrum: SignalSpectrum, unit: str) -> list[Trace]:
    if not spectrum.window_length:
        return []
    peaks = distinct_peaks(spectrum, _PEAKS)
    peaks = [each for each in peaks if each.amplitude > _LEAST * peaks[0].amplitude]
    if not peaks:
        return []
    place, size = np.array([(each.frequency, each.amplitude) for each in peaks]).T
    hover = f"%{{x:.6g}} Hz: %{{y:.4g}} {unit}<extra></extra>"
    return [marked(place, size, "largest peaks", WHEEL, 8, "circle-open", hovertemplate=hover)]


@drawing(
    heading="Spectrum",
    caption="Amplitude over the frequency; circles mark the largest peaks, interpolated between "
    "the lines. The mean of the signal, the line at zero, is left out. Mean square and "
    "density have a logarithmic scale.",
    of="SignalSpectrum",
    made_by="Call tribodyn.analysis.spectrum on a signal and its plot method.",
)
def signal_spectrum(
    spectrum: SignalSpectrum, *, marks: Iterable[tuple[str, float]] = (), to: float | None = None
) -> Sketch:
    """Draw the lines of a spectrum over the frequency.

    Parameters
    ----------
    spectrum : SignalSpectrum
        What :func:`tribodyn.analysis.spectrum` returns.
    marks : iterable of (str, float)
        Names and frequencies of dotted lines, such as the mesh frequency [Hz].
    to : float, optional
        Right end of the axis [Hz]; all lines by default.

    Returns
    -------
    plotly.graph_objects.Figure
    """
    layout: Trace = {"hovermode": "closest", **event_lines(marks)}
    if to is not None:
        layout["xaxis"] = {"range": [0.0, to]}
    panels = [spectrum_panel(spectrum, to)]
    return stack(spectrum_title(spectrum), axis_label("frequency"), panels, layout)


def spectrum_title(spectrum: SignalSpectrum) -> str:
    """Name the largest line above zero."""
    above = spectrum.frequency > 0.0
    frequency, size = spectrum.frequency[above], spectrum.amplitude[above]
    top = int(np.argmax(size))
    if not size[top] > 0.0:
        return f"No line above zero up to {significant(frequency[-1], 4)} Hz"
    return (
        f"Strongest at {significant(frequency[top], 4)} Hz: "
        f"{with_unit(size[top], spectrum.value_unit)}"
    )


@drawing(
    heading="Harmonics",
    caption="Peak amplitude over multiples of the mesh frequency. Lines between "
    "integer harmonics belong to a response with a period of several mesh cycles.",
    of="Spectrum",
    made_by="Call tribodyn.analysis.amplitude_spectrum(response, signal) and its plot method.",
)
def harmonic_spectrum(spectrum: Spectrum) -> Sketch:
    """Draw the amplitudes over the mesh harmonics as bars."""
    top = int(np.argmax(spectrum.amplitude))
    unit = readable(spectrum.unit)
    hover = f"%{{y:.4g}} {unit} at %{{customdata:.5g}} Hz<extra></extra>"
    lines = bars(spectrum.order, spectrum.amplitude, "amplitude", TOTAL, hover)
    lines["customdata"] = spectrum.frequency
    return stack(
        f"Harmonic {spectrum.order[top]:.4g} ({significant(spectrum.frequency[top])} Hz) "
        f"is the strongest: {with_unit(spectrum.amplitude[top], spectrum.unit)}",
        "Mesh harmonic",
        [from_zero(amplitude_label(spectrum.unit), [lines], 1.4)],
    )


@drawing(
    heading="Sidebands",
    caption="The carrier and its sidebands. Symmetric sidebands indicate a load that "
    "varies with the shaft (amplitude modulation), asymmetric sidebands additional uneven "
    "rotation (phase modulation).",
    of="Sidebands",
    made_by="Call tribodyn.analysis.sidebands(signal, rate, carrier, modulation) and its plot "
    "method.",
)
def sidebands(lines: Sidebands) -> Sketch:
    """Draw the amplitudes of the carrier and of its sidebands over the frequency."""
    unit = readable(lines.unit)
    width = 0.25 * lines.modulation
    traces: list[Trace] = []
    for name, chosen, color in (
        ("carrier", lines.number == 0, TOTAL),
        ("sidebands", lines.number != 0, PINION),
    ):
        hover = f"line %{{customdata:d}} at %{{x:.6g}} Hz: %{{y:.4g}} {unit}<extra></extra>"
        place, more = lines.frequency[chosen], Trace(customdata=lines.number[chosen], width=width)
        traces.append(bars(place, lines.amplitude[chosen], name, color, hover, **more))
    title = (
        f"Around {significant(lines.carrier, 4)} Hz: amplitude modulation "
        f"{significant(100.0 * lines.amplitude_modulation)} %, phase modulation "
        f"{significant(lines.phase_modulation)} rad"
    )
    panel = from_zero(amplitude_label(lines.unit), traces, 1.4)
    layout = {"hovermode": "closest", "bargap": 0.0}
    return stack(title, axis_label("frequency"), [panel], layout)


def _over_speed(speed: Array, values: Array, name: str, unit: str) -> Trace:
    mode = "lines+markers" if speed.size < 40 else "lines"
    return line(displayed("speed", speed), values, name, TOTAL, unit=readable(unit), mode=mode)


@drawing(
    heading="Order cut",
    caption="Amplitude of an order over the speed. A peak is a speed at which "
    "the order excites a natural frequency.",
    of="OrderCut",
    made_by="Call .cut(order) of an order map, or tribodyn.analysis.order_cut, and its plot "
    "method.",
)
def order_cut(cut: OrderCut) -> Sketch:
    """Draw the amplitude of an order over the speed."""
    top = int(np.argmax(cut.amplitude))
    title = (
        f"Order {cut.order:.4g} reaches {with_unit(cut.amplitude[top], cut.unit)} at "
        f"{rounded('speed', cut.speed[top], 4)}"
    )
    curve = _over_speed(cut.speed, cut.amplitude, f"order {cut.order:.4g}", cut.unit)
    return stack(title, axis_label("speed"), [from_zero(amplitude_label(cut.unit), [curve], 1.4)])


@drawing(
    heading="Overall level",
    caption="Alternating rms of the signal over the speed; the circle marks the largest value.",
    of="OverallLevel",
    made_by="Call tribodyn.analysis.overall_level(run_up) and its plot method.",
)
def overall_level(level: OverallLevel) -> Sketch:
    """Draw the alternating rms over the speed."""
    top = int(np.argmax(level.rms))
    unit = readable(level.unit)
    curve = _over_speed(level.speed, level.rms, "level", level.unit)
    hover = f"%{{y:.4g}} {unit} at %{{x:.5g}} {display_unit('speed')}, after %{{customdata:.4g}} s"
    curve |= {"customdata": level.time, "hovertemplate": f"{hover}<extra></extra>"}
    place = displayed("speed", level.speed[[top]])
    loudest = marked(place, level.rms[[top]], "largest", MUTED, 9, "circle-open", unit=unit)
    curves = [{**each, "showlegend": False} for each in (curve, loudest)]
    title = (
        f"Highest level at {rounded('speed', level.speed[top], 4)}: "
        f"{with_unit(level.rms[top], level.unit)} rms"
    )
    panel = from_zero(label_with("Alternating rms", unit), curves, 1.4)
    return stack(title, axis_label("speed"), [panel], {"hovermode": "closest"})
