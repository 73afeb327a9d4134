"""Recordings of a test rig: channels, analysis, orders, comparison with a run."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np

from tribodyn.drawing import Sketch, drawing
from tribodyn.plot.signals.spectra import (
    amplitude_label,
    spectrum_panel,
    strongest_lines,
    with_unit,
)
from tribodyn.plot.theme.colors import MUTED, PAIR_COLORS, PINION, TOTAL
from tribodyn.plot.theme.labels import axis_label, displayed, label_with, readable, significant
from tribodyn.plot.theme.panels import Panel, Row, event_lines, from_zero, stack, stack_rows
from tribodyn.plot.theme.style import Trace, line, marked
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.measurement import (
        Comparison,
        OrderSpectrum,
        Recording,
        SignalAnalysis,
        TrackedOrders,
    )

#: Most panels of a recording, most points of a curve, and names in a title.
_PANELS, _POINTS, _NAMED = 8, 4000, 3
_DASHES = ("solid", "dash", "dot", "dashdot")


@drawing(
    heading="Recording",
    of="Recording",
    made_by="Call tribodyn.measurement.read(path) and its plot method.",
)
def recording(recording: Recording) -> Sketch:
    """Draw the channels over time, one panel each, at most eight.

    The channels as they were recorded. Where there are more samples than the screen has pixels, the
    largest and the smallest sample of each interval are drawn.
    """
    names = list(recording.channels)
    panels = []
    for name in names[:_PANELS]:
        time, values = outline(recording.time, recording[name])
        unit = recording.units[name]
        panels.append(Panel(label_with(name, unit), [line(time, values, name, TOTAL, unit=unit)]))
    left_out = f"; {len(names) - _PANELS} more channels" if len(names) > _PANELS else ""
    channels = ", ".join(names[:_NAMED]) + (" and others" if len(names) > _NAMED else "")
    return stack(f"{recording.duration:.4g} s of {channels}{left_out}", "Time [s]", panels)


def outline(time: Array, values: Array) -> tuple[Array, Array]:
    """Thin a signal to the minimum and maximum of every interval, which preserves peaks."""
    if values.size <= _POINTS:
        return time, values
    length = -(-values.size // (_POINTS // 2))
    starts = np.arange(0, values.size, length)
    ends = [np.minimum.reduceat(values, starts), np.maximum.reduceat(values, starts)]
    return np.repeat(time[starts], 2), np.stack(ends, axis=1).ravel()


@drawing(
    heading="Orders",
    of="OrderSpectrum",
    made_by="Call tribodyn.measurement.order_spectrum(...) and its plot method.",
)
def order_spectrum(spectrum: OrderSpectrum, *, marks: Iterable[tuple[str, float]] = ()) -> Sketch:
    """Draw the amplitudes over the orders of a shaft.

    Amplitude over multiples of the shaft speed, as a mean over the angle of the shaft. Vibration
    synchronous with the shaft is a line; other vibration is spread.

    Parameters
    ----------
    spectrum : OrderSpectrum
        What :func:`tribodyn.measurement.order_spectrum` returns.
    marks : iterable of (str, float)
        Names and orders of dotted lines, such as the mesh at its number of teeth.

    Returns
    -------
    plotly.graph_objects.Figure
    """
    top = 1 + int(np.argmax(spectrum.amplitudes[1:]))
    order, size = strongest_lines(spectrum.orders[1:], spectrum.amplitudes[1:])
    curve = line(order, size, "amplitude", TOTAL, unit=spectrum.unit, width=1.2)
    title = (
        f"Order {significant(spectrum.orders[top], 4)} is the strongest: "
        f"{with_unit(spectrum.amplitudes[top], spectrum.unit)}"
    )
    panel = from_zero(amplitude_label(spectrum.unit), [curve], 1.4)
    return stack(title, "Order [cycles per revolution]", [panel], event_lines(marks))


@drawing(
    heading="Orders over time",
    of="TrackedOrders",
    made_by="Call tribodyn.measurement.track_orders(...) and its plot method.",
)
def tracked_orders(tracked: TrackedOrders) -> Sketch:
    """Draw the amplitudes of the tracked orders and the shaft speed over time.

    Amplitude of every tracked order while the speed changes, and the speed.
    """
    curves: list[Trace] = []
    for number, (order, size) in enumerate(zip(tracked.order, tracked.amplitude, strict=True)):
        time, values = outline(tracked.time, size)
        color, dash = PAIR_COLORS[number % 4], _DASHES[number // 4 % 4]
        name = f"order {order:g}"
        curves.append(line(time, values, name, color, unit=tracked.unit, dash=dash))
    row, column = np.unravel_index(int(np.argmax(tracked.amplitude)), tracked.amplitude.shape)
    rpm = np.gradient(tracked.angle, tracked.time) * 30.0 / np.pi
    speed = line(*outline(tracked.time, rpm), "speed", TOTAL, unit="rpm")
    title = (
        f"Order {tracked.order[row]:g} reaches "
        f"{with_unit(tracked.amplitude[row, column], tracked.unit)} at "
        f"{significant(rpm[column], 4)} rpm"
    )
    amplitudes = from_zero(amplitude_label(tracked.unit), curves, 1.4)
    return stack(title, "Time [s]", [amplitudes, from_zero("Speed [rpm]", [speed], 0.8)])


@drawing(
    heading="Computed and measured",
    of="Comparison",
    made_by="Call tribodyn.measurement.compare(result, recording, channels) and its plot method.",
)
def comparison(comparison: Comparison) -> Sketch:
    """Draw the measured spectra with the computed mesh harmonics.

    Spectra of the measured channels over the mesh order, with the computed mesh harmonics
    multiplied by the gain of the channel. Lines between the harmonics have other sources than the
    mesh. If the speed of the recording was not found, its spectrum is scaled with the computed
    speed.
    """
    panels, ends = [], []
    ratio = comparison.speed_ratio if np.isfinite(comparison.speed_ratio) else 1.0
    for name, lines in comparison.lines.items():
        unit = str(comparison.unit[comparison.channel == name][0])
        rows = (comparison.channel == name) & np.char.startswith(comparison.measure, "mesh harm")
        top = int(rows.sum()) + 0.5
        order = lines.measured[0] / (ratio * comparison.mesh_frequency)
        visible = (order > 0.1) & (order < top)
        curve = outline(order[visible], lines.measured[1][visible])
        harmonic, amplitude = lines.computed[0] / comparison.mesh_frequency, lines.computed[1]
        inside = (harmonic > 0.0) & (harmonic < top)
        gain = f", gain {comparison.gains[name]:.4g}{' fitted' if comparison.fitted else ''}"
        measured = line(*curve, "measured", MUTED, unit=unit, width=1.2)
        place = (harmonic[inside], amplitude[inside], f"computed{gain}")
        computed = marked(*place, PINION, 9, "circle-open", unit=unit)
        panels.append(from_zero(f"{name} [{readable(unit)}]", [measured, computed], 1.2))
        ends.append(top)
    layout = {"xaxis": {"range": [0.0, max(ends)]}, "hovermode": "closest"}
    return stack(_comparison_title(comparison), _mesh_axis(comparison), panels, layout)


def _comparison_title(comparison: Comparison) -> str:
    """Title: largest error of a harmonic, if the harmonics are compared."""
    harmonics = np.char.startswith(comparison.measure, "mesh harm")
    if not np.isfinite(comparison.speed_ratio):
        return "The speed of the recording was not found: its harmonics are not compared"
    worst = int(np.argmax(np.where(harmonics, np.abs(comparison.error), -1.0)))
    return (
        f"Largest error of a harmonic: {100.0 * comparison.error[worst]:+.3g} % of the "
        f"{comparison.base} value, {comparison.measure[worst]} of {comparison.channel[worst]}"
    )


def _mesh_axis(comparison: Comparison) -> str:
    """Label of the axis of mesh orders with the computed and the measured mesh frequency."""
    computed = f"computed at {comparison.mesh_frequency:.5g} Hz"
    if not np.isfinite(comparison.speed_ratio):
        return f"Mesh order ({computed})"
    measured = comparison.speed_ratio * comparison.mesh_frequency
    ratio = f"{comparison.speed_ratio:.4f} times that"
    return f"Mesh order ({computed}, recorded at {measured:.5g} Hz, {ratio})"


#: Points of the curve of the speed.
_SPEEDS = 1500
#: Multiples of the strongest line of the envelope that its axis reaches at least.
_MULTIPLES = 6.5
_MADE_BY = "Call tribodyn.measurement.analyse_signal(recording, channel) and its plot method."


def _signal_panel(analysis: SignalAnalysis) -> Panel:
    unit = readable(analysis.unit)
    curves = [
        line(*outline(analysis.time, analysis.signal), "signal", TOTAL, unit=unit, width=1.0),
        line(*outline(analysis.time, analysis.envelope), "envelope", PINION, unit=unit, width=1.0),
    ]
    return Panel(label_with(analysis.channel, unit), curves, height=1.2)


def _speed(analysis: SignalAnalysis) -> tuple[Array, Array] | None:
    """Mean speed of the shaft between even times."""
    if analysis.speed is None:
        return None
    count = min(_SPEEDS, int(np.ptp(analysis.speed.angle) / (2.0 * np.pi)))
    if count < 2:
        return None
    time = np.linspace(analysis.time[0], analysis.time[-1], count + 1)
    angle = np.interp(time, analysis.time, analysis.speed.angle)
    return 0.5 * (time[1:] + time[:-1]), np.diff(angle) / np.diff(time)


def order_panel(lines: OrderSpectrum) -> Panel:
    """Amplitudes over the orders."""
    order, size = strongest_lines(lines.orders[1:], lines.amplitudes[1:])
    curve = line(order, size, "amplitude", TOTAL, unit=readable(lines.unit), width=1.2)
    return from_zero(amplitude_label(lines.unit), [curve], 1.4)


@drawing(heading="Signal at a glance", of="SignalAnalysis", made_by=_MADE_BY)
def signal_analysis(analysis: SignalAnalysis) -> Sketch:
    """Draw signal, spectrum, envelope spectrum and orders in stacked panels.

    The channel over the time with its envelope, its spectrum, the spectrum of its envelope, and its
    orders where the speed of the shaft is known.
    """
    hertz = axis_label("frequency")
    reach = visible_frequency(analysis)
    envelope = spectrum_panel(analysis.envelope_spectrum, reach)
    rows = [
        Row("Time [s]", _signal_panel(analysis)),
        Row(hertz, spectrum_panel(analysis.spectrum)),
        Row(
            axis_label("frequency", "Frequency of the envelope"), envelope, {"range": [0.0, reach]}
        ),
    ]
    if analysis.orders is not None:
        rows.append(Row("Order [cycles per revolution]", order_panel(analysis.orders)))
    numbers = analysis.figures()
    title = f"{analysis.channel}: alternating rms " + with_unit(
        numbers["alternating_rms"], analysis.unit
    )
    if "order_peak_1" in numbers:
        title += f", strongest at order {significant(numbers['order_peak_1'], 4)}"
    elif "spectrum_peak_1_frequency" in numbers:
        title += f", strongest at {significant(numbers['spectrum_peak_1_frequency'], 4)} Hz"
    return stack_rows(title, rows, {"hovermode": "closest"})


@drawing(heading="Signal", of="SignalAnalysis", made_by=_MADE_BY)
def signal_history(analysis: SignalAnalysis) -> Sketch:
    """Draw signal, envelope and speed of the shaft over the time.

    The channel as it was recorded, the envelope of its band, and the speed of the shaft. Where
    there are more samples than the screen has pixels, the largest and the smallest of each interval
    are drawn.
    """
    panels = [_signal_panel(analysis)]
    speed = _speed(analysis)
    if speed is not None:
        rpm = displayed("speed", speed[1])
        curve = line(speed[0], rpm, "speed", MUTED, unit="rpm")
        margin = max(0.6 * float(np.ptp(rpm)), 0.01 * float(rpm.mean()))
        middle = 0.5 * float(rpm.min() + rpm.max())
        ends = {"range": [middle - margin, middle + margin]}
        panels.append(Panel(axis_label("speed"), [curve], ends, 0.6))
    numbers = analysis.figures()
    title = (
        f"{significant(numbers['duration'], 4)} s: alternating rms "
        f"{with_unit(numbers['alternating_rms'], analysis.unit)}, crest factor "
        f"{significant(numbers['crest_factor'])}, kurtosis {significant(numbers['kurtosis'])}"
    )
    return stack(title, "Time [s]", panels)


def visible_frequency(analysis: SignalAnalysis) -> float:
    """Frequency above which all lines of the envelope are small [Hz]."""
    lines = analysis.envelope_spectrum
    size = np.where(lines.frequency > 0.0, lines.amplitude, 0.0)
    last = float(lines.frequency[np.flatnonzero(size >= 0.05 * size.max())[-1]])
    strongest = float(lines.frequency[int(np.argmax(size))])
    return float(min(max(1.15 * last, _MULTIPLES * strongest), lines.frequency[-1]))
