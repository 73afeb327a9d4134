"""Analysis of a recorded channel: overview and time history."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.drawing import drawing
from tribodyn.plot.signals.lines import spectrum_panel, strongest_lines
from tribodyn.plot.signals.maps import amplitude_label, with_unit
from tribodyn.plot.signals.recorded import outline
from tribodyn.plot.theme.labels import axis_label, displayed, label_with, readable, significant
from tribodyn.plot.theme.panels import Panel, Row, from_zero, stack, stack_rows
from tribodyn.plot.theme.style import MUTED, PINION, TOTAL, line
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.measurement import OrderSpectrum, SignalAnalysis

#: Points of the curve of the speed.
_POINTS = 1500
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
    count = min(_POINTS, int(np.ptp(analysis.speed.angle) / (2.0 * np.pi)))
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


@drawing(
    "signal_analysis",
    heading="Signal at a glance",
    caption="The channel over the time with its envelope, its spectrum, the spectrum of its "
    "envelope, and its orders where the speed of the shaft is known.",
    of="SignalAnalysis",
    made_by=_MADE_BY,
)
def signal_analysis(analysis: SignalAnalysis) -> Any:
    """Draw signal, spectrum, envelope spectrum and orders in stacked panels."""
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


@drawing(
    "signal_history",
    heading="Signal",
    caption="The channel as it was recorded, the envelope of its band, and the speed of the "
    "shaft. Where there are more samples than the screen has pixels, the largest and the smallest "
    "of each interval are drawn.",
    of="SignalAnalysis",
    made_by=_MADE_BY,
)
def signal_history(analysis: SignalAnalysis) -> Any:
    """Draw signal, envelope and speed of the shaft over the time."""
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
