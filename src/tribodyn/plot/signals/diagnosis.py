"""Figures of diagnosis: mean revolution, demodulation, cepstrum, kurtogram, coherence."""

from __future__ import annotations

from itertools import cycle
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.drawing import Sketch, drawing
from tribodyn.plot.signals.recorded import outline
from tribodyn.plot.signals.spectra import amplitude_label, strongest_lines, with_unit
from tribodyn.plot.theme.colors import COLORS, FILLS, MUTED, PINION, TOTAL, WHEEL
from tribodyn.plot.theme.labels import axis_label, label_with, readable, significant
from tribodyn.plot.theme.panels import Panel, event_lines, from_zero, stack
from tribodyn.plot.theme.style import (
    GREY_ZERO,
    POWERS,
    Trace,
    between,
    color_bar,
    heat,
    line,
    marked,
)
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.analysis import (
        Cepstrum,
        CyclicCoherence,
        Kurtogram,
        NarrowbandDemodulation,
        SynchronousAverage,
    )
    from tribodyn.measurement import SidebandCursors
    from tribodyn.study import RecordingVerdict

#: Most points of a curve; a mean revolution has 2.6 per mesh harmonic.
_POINTS = 6000
#: Points per period of the highest order.
_FINE = 4


def finer(values: Array) -> Array:
    """Evaluate the Fourier series of a signal at more angles, for a smooth curve."""
    from scipy.signal import resample

    return np.asarray(resample(values, min(_FINE * values.size, max(_POINTS, values.size))))


@drawing(
    heading="Mean revolution",
    of="SynchronousAverage",
    made_by="Call tribodyn.analysis.time_synchronous_average(...) and its plot method.",
)
def synchronous_average(average: SynchronousAverage) -> Sketch:
    """Draw mean revolution, residual and difference over the angle of the shaft.

    Vibration synchronous with the shaft, over its angle from the first pulse of the tachometer, or
    from the first sample where there is none. Above, the mean revolution with a band of two
    standard errors; below, the residual, without the mesh harmonics and the lowest shaft orders,
    and the difference, without their first sidebands too. A local bump of the difference indicates
    a faulty tooth.
    """
    unit = readable(average.unit)
    mean = finer(average.signal)
    angle = 360.0 * np.arange(mean.size) / mean.size
    error = 2.0 * np.interp(angle, np.degrees(average.angle), average.scatter, period=360.0)
    band = between(angle, mean + error, mean - error, "2 standard errors", FILLS[PINION])
    band[0]["name"] = "standard error"
    difference = finer(average.difference())
    rows: tuple[tuple[Any, ...], ...] = (
        ("Mean revolution", mean, PINION, {}, 1.2),
        ("Residual", finer(average.residual()), TOTAL, GREY_ZERO, 1.0),
        ("Difference", difference, WHEEL, GREY_ZERO, 1.0),
    )
    panels: list[Panel] = []
    for name, values, color, axis, height in rows:
        trace = line(angle, values, name.lower(), color, unit=unit, width=1.4)
        traces = [trace] if panels else [*band, trace]
        panels.append(Panel(label_with(name.split()[0], unit), traces, axis, height))
    swing, bump = float(np.ptp(mean)), float(np.abs(difference).max())
    place, tooth = average.local_place()
    of_tooth = f", tooth {tooth} of {average.teeth}" if average.difference_is_clear else ""
    title = (
        f"{average.revolutions} revolutions: {with_unit(swing, average.unit)} peak to peak, "
        f"difference up to {with_unit(bump, average.unit)} "
        f"about {np.degrees(place):.0f}°{of_tooth}"
    )
    return over_a_turn(title, panels)


def over_a_turn(title: str, panels: list[Panel]) -> Sketch:
    """Stack panels over the angle of a shaft."""
    axis = {"range": [0.0, 360.0], "dtick": 45}
    return stack(title, "Angle of the shaft [°]", panels, {"xaxis": axis})


#: Colours from the smallest to the largest value.
_SCALE = [[0.0, "#ffffff"], [0.3, "#c6dbef"], [0.6, "#6baed6"], [0.8, "#2171b5"], [1.0, "#08306b"]]
#: Height of a map over that of a curve, and most columns and rows of one.
_MAP, _MOST = 1.8, 480


@drawing(
    heading="Demodulated mesh harmonic",
    of="NarrowbandDemodulation",
    made_by="Call tribodyn.analysis.narrowband_demodulation(average) and its plot method.",
)
def narrowband_demodulation(demodulation: NarrowbandDemodulation) -> Sketch:
    """Draw amplitude and phase modulation over the angle of the shaft.

    Amplitude and phase of a mesh harmonic over the angle of the shaft. A slow wave is run-out; a
    short dip of the phase is a tooth that yields, such as one with a root crack.
    """
    size = finer(100.0 * demodulation.amplitude_modulation)
    phase = finer(demodulation.phase_modulation)
    angle = 360.0 * np.arange(size.size) / size.size
    lowest = int(np.argmin(phase))
    panels = [
        Panel("Amplitude [%]", [line(angle, size, "amplitude", TOTAL, unit="%")], GREY_ZERO),
        Panel("Phase [rad]", [line(angle, phase, "phase", PINION, unit="rad")], GREY_ZERO),
    ]
    title = (
        f"Mesh harmonic {demodulation.harmonic}: amplitude {significant(size.min())} to "
        f"{significant(size.max())} %, phase lags most at "
        f"{significant(angle[lowest])}°, by {significant(-phase[lowest])} rad"
    )
    return over_a_turn(title, panels)


@drawing(
    heading="Cepstrum",
    of="Cepstrum",
    made_by="Call tribodyn.analysis.cepstrum on a signal and its plot method.",
)
def cepstrum(result: Cepstrum, *, shortest: float = 0.0) -> Sketch:
    """Draw the cepstrum over the quefrency.

    Each peak gathers a family of evenly spaced lines; its quefrency is the inverse of their
    spacing, such as the period of the shaft whose sidebands they are. Peaks at multiples are
    rahmonics of the same family.

    Parameters
    ----------
    result : Cepstrum
        What :func:`tribodyn.analysis.cepstrum` returns.
    shortest : float
        Quefrency at which the axis begins [s]; by default after the first hundredth, which holds
        the smooth course of the spectrum.

    Returns
    -------
    plotly.graph_objects.Figure
    """
    longest = float(result.quefrency[-1])
    start = shortest or 0.01 * longest
    top, size = result.peak(start, longest)
    beyond = result.quefrency >= start
    quefrency, values = outline(result.quefrency[beyond], result.cepstrum[beyond])
    largest = np.array([1e3 * top]), np.array([size])
    curves = [
        line(1e3 * quefrency, values, "cepstrum", TOTAL, width=1.0),
        marked(*largest, "largest", WHEEL, 8, "circle-open"),
    ]
    title = (
        f"Largest peak {significant(size)} at {significant(1e3 * top, 4)} ms: lines every "
        f"{significant(1.0 / top, 4)} Hz"
    )
    return stack(title, "Quefrency [ms]", [Panel("Cepstrum", curves, GREY_ZERO, 1.4)])


def _heatmap(x: Array, y: Array, values: Array, title: str, hover: str, top: float) -> Trace:
    """Map of values from zero, with its colour bar."""
    more = {"zmin": 0.0, "zmax": top, "colorbar": color_bar(title)}
    return heat(x, y, np.round(values, 4), _SCALE, f"{hover}: %{{z:.3g}}", **more)


@drawing(
    heading="Kurtogram",
    of="Kurtogram",
    made_by="Call tribodyn.analysis.kurtogram on a signal and its plot method.",
)
def kurtogram(result: Kurtogram) -> Sketch:
    """Draw the spectral kurtosis over the frequency and the number of bands.

    Spectral kurtosis of equal bands, more and narrower ones from top to bottom. The darkest band
    contains the most impulsive vibration; its envelope shows how often the impacts come. Bands
    below the limit of noise are white.
    """
    counts = np.unique(result.splits)
    half = float(result.width[0] * result.splits[0])
    columns = min(int(counts.max()) * 3, 3 * _MOST)
    frequency = half * (np.arange(columns) + 0.5) / columns
    rows = []
    for count in counts:
        above = np.where(result.kurtosis > result.limit, result.kurtosis, 0.0)
        above = above[result.splits == count]
        # A row with more bands than columns shows the largest band of each column.
        place = (np.arange(count) * columns) // count
        wide = np.zeros(columns)
        np.maximum.at(wide, place, above)
        rows.append(above[(np.arange(columns) * count) // columns] if count <= columns else wide)
    low, high = result.band
    best = int(result.splits[result.best])
    levels, most = np.arange(float(counts.size)), max(float(result.kurtosis.max()), 0.1)
    heatmap = _heatmap(frequency, levels, np.array(rows), "kurtosis", "%{x:.5g} Hz", most)
    title = (
        f"Most impulsive from {significant(low)} to {significant(high)} Hz (one of {best} bands): "
        f"kurtosis {significant(result.kurtosis[result.best])}"
    )
    axis: Trace = {"tickvals": np.arange(counts.size).tolist(), "autorange": "reversed"}
    axis |= {"ticktext": [str(count) for count in counts], "showgrid": False}
    row = float(np.searchsorted(counts, best))
    corners = np.array([low, high, high, low, low]), row + 0.5 * np.array([-1, -1, 1, 1, -1])
    frame = [line(*corners, "most impulsive", WHEEL, width=2.0)] if result.significant else []
    title = title if result.significant else "No band is more impulsive than noise"
    panel = Panel("Number of bands", [heatmap, *frame], axis, _MAP)
    layout = {"hovermode": "closest", "showlegend": False}
    return stack(title, axis_label("frequency"), [panel], layout)


@drawing(
    heading="Cyclic coherence",
    of="CyclicCoherence",
    made_by="Call tribodyn.analysis.cyclic_coherence on a signal and its plot method.",
)
def cyclic_coherence(result: CyclicCoherence) -> Sketch:
    """Draw the coherence over carrier and modulation, and its mean over the carriers.

    Squared coherence over the frequency of the carrier and of its modulation. Random impacts that
    repeat show as vertical lines at multiples of their rate. Below, the mean over the carriers; in
    19 of 20 records, noise remains below the dotted line.
    """
    alpha = result.cyclic_frequency
    groups = np.arange(0, alpha.size, -(-alpha.size // _MOST))
    most = np.maximum.reduceat(result.coherence, groups, axis=1)
    parts = np.split(result.coherence.max(axis=0), groups[1:])
    top = [a + int(np.argmax(part)) for a, part in zip(groups, parts, strict=True)]
    mean = result.enhanced_envelope_spectrum()
    largest = int(np.argmax(mean))
    hover, end = "%{y:.5g} Hz modulated with %{x:.5g} Hz", max(float(most.max()), result.threshold)
    heatmap = _heatmap(alpha[top], result.frequency, most, "coherence", hover, end)
    limit = result.noise_limit()
    curves = [
        line(alpha, mean, "mean", TOTAL, width=1.2),
        line(alpha[[0, -1]], np.full(2, limit), "limit of noise", PINION, dash="dot"),
    ]
    title = f"Most coherent modulation at {significant(alpha[largest], 4)} Hz: mean "
    title += f"{significant(mean[largest])}, noise up to {significant(limit)}"
    title = title if mean[largest] > limit else "No modulation is more coherent than noise"
    carriers = Panel("Carrier [Hz]", [heatmap], {"showgrid": False}, _MAP)
    panels = [carriers, from_zero("Mean coherence", curves)]
    return stack(title, "Frequency of the modulation [Hz]", panels, {"hovermode": "closest"})


@drawing(
    heading="Sidebands in the orders",
    of="SidebandCursors",
    made_by="Call tribodyn.measurement.sideband_cursors(orders, carrier, spacing) and its plot "
    "method.",
)
def sideband_cursors(cursors: SidebandCursors) -> Sketch:
    """Draw the orders around a carrier with the cursors of its sidebands.

    Orders around a carrier with cursors at even distances, on a logarithmic scale; the dashed line
    is the median of the lines between the cursors. Full circles stand out of it: the shaft whose
    order is the distance modulates the carrier.
    """
    low, high = (cursors.order[k] + s * cursors.spacing for k, s in ((0, -0.7), (-1, 0.7)))
    spectrum, unit = cursors.orders, readable(cursors.unit)
    in_range = (spectrum.orders >= low) & (spectrum.orders <= high)
    order, size = strongest_lines(spectrum.orders[in_range], spectrum.amplitudes[in_range])
    least = 0.1 * max(cursors.floor, 1e-6 * float(cursors.amplitude.max()))
    size = np.maximum(size, least)
    curves = [
        line(order, size, "amplitude", TOTAL, unit=unit, width=1.2),
        line(np.array([low, high]), np.full(2, max(cursors.floor, least)), "between the cursors",
             MUTED, unit=unit, dash="dash"),
    ]  # fmt: skip
    kinds = (("clear", cursors.clear, "circle"), ("in the noise", ~cursors.clear, "circle-open"))
    for name, rows, symbol in kinds:
        if rows.any():
            heights = np.maximum(cursors.amplitude[rows], least)
            curves.append(marked(cursors.order[rows], heights, name, WHEEL, 8, symbol, unit=unit))
    names = [f"{k:+d}" if k else "carrier" for k in cursors.number]
    marks = zip(names, cursors.order, strict=True)
    top = cursors.strongest
    title = (
        f"Order {significant(cursors.carrier, 4)}: strongest sideband {cursors.number[top]:+d} at "
        f"{significant(cursors.order[top], 4)}, {cursors.level[top]:.1f} dB"
    )
    panel = Panel(amplitude_label(cursors.unit), curves, POWERS, 1.5)
    layout = {"hovermode": "closest", "xaxis": {"range": [low, high]}, **event_lines(marks)}
    return stack(title, "Order [cycles per revolution]", [panel], layout)


@drawing(
    heading="Verdict on the recordings",
    of="RecordingVerdict",
    made_by="Call tribodyn.study.judge_recordings(...).",
)
def recording_verdict(verdict: RecordingVerdict) -> Sketch:
    """Draw severity, kurtosis and the lines of suspected parts over the recordings.

    Over the recordings, the oldest first: the velocity from 10 to 1000 Hz with the ends of the
    zones A, B and C, where limits were named and the velocity is known, the kurtosis, and the lines
    of the suspected parts over their first amplitude. What rises is worth a look.
    """
    number = np.arange(1, verdict.kurtosis.size + 1)
    panels = [from_zero("Kurtosis [-]", [marked(number, verdict.kurtosis, "kurtosis", MUTED, 8)])]
    if np.isfinite(verdict.velocity).any():
        points = [marked(number, 1e3 * verdict.velocity, "velocity", TOTAL, 8, unit="mm/s")]
        reach = np.array([0.5, number[-1] + 0.5])
        for name, end in zip("ABC", verdict.limits, strict=False):
            level = np.full(2, 1e3 * end)
            points.append(line(reach, level, f"end of zone {name}", MUTED, unit="mm/s", dash="dot"))
        panels.insert(0, from_zero("Velocity, rms [mm/s]", points))
    lines = []
    for each, color in zip(verdict.findings, cycle(COLORS), strict=False):
        growth = np.array(each.amplitudes) / (each.amplitudes[0] or np.nan)
        lines.append(marked(number, growth, each.part, color, 8, showlegend=True))
    if lines:
        panels.append(Panel("Lines over their first amplitude [-]", lines, POWERS))
    title = f"Zone {verdict.zone}" if verdict.zone else "Zone not known"
    title += f"; {verdict.findings[0].part}" if lines else "; no part stands out"
    title += f" and {len(lines) - 1} more" if len(lines) > 1 else ""
    ends = {"dtick": 1, "range": [0.5, number[-1] + 0.5]}
    return stack(title, "Recording", panels, {"xaxis": ends})
