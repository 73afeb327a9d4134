"""Signal spectra, sidebands, order cuts, overall level; amplitudes over time or speed."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, SupportsFloat

import numpy as np

from tribodyn.analysis import OrderMap
from tribodyn.drawing import Sketch, drawing
from tribodyn.plot.theme.colors import GRID, INK, MUTED, PINION, TOTAL, WHEEL
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
from tribodyn.plot.theme.style import POWERS, Trace, bars, color_bar, heat, line, marked
from tribodyn.signals.spectrum import distinct_peaks
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.analysis import (
        OrderCut,
        OverallLevel,
        Sidebands,
        SignalSpectrum,
        Spectrogram,
        Spectrum,
    )

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
    of="SignalSpectrum",
    made_by="Call tribodyn.analysis.spectrum on a signal and its plot method.",
)
def signal_spectrum(
    spectrum: SignalSpectrum, *, marks: Iterable[tuple[str, float]] = (), to: float | None = None
) -> Sketch:
    """Draw the lines of a spectrum over the frequency.

    Amplitude over the frequency; circles mark the largest peaks, interpolated between the lines.
    The mean of the signal, the line at zero, is left out. Mean square and density have a
    logarithmic scale.

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
    of="Spectrum",
    made_by="Call tribodyn.analysis.amplitude_spectrum(response, signal) and its plot method.",
)
def harmonic_spectrum(spectrum: Spectrum) -> Sketch:
    """Draw the amplitudes over the mesh harmonics as bars.

    Peak amplitude over multiples of the mesh frequency. Lines between integer harmonics belong to a
    response with a period of several mesh cycles.
    """
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
    of="Sidebands",
    made_by="Call tribodyn.analysis.sidebands(signal, rate, carrier, modulation) and its plot "
    "method.",
)
def sidebands(lines: Sidebands) -> Sketch:
    """Draw the amplitudes of the carrier and of its sidebands over the frequency.

    The carrier and its sidebands. Symmetric sidebands indicate a load that varies with the shaft
    (amplitude modulation), asymmetric sidebands additional uneven rotation (phase modulation).
    """
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
    of="OrderCut",
    made_by="Call .cut(order) of an order map, or tribodyn.analysis.order_cut, and its plot "
    "method.",
)
def order_cut(cut: OrderCut) -> Sketch:
    """Draw the amplitude of an order over the speed.

    Amplitude of an order over the speed. A peak is a speed at which the order excites a natural
    frequency.
    """
    top = int(np.argmax(cut.amplitude))
    title = (
        f"Order {cut.order:.4g} reaches {with_unit(cut.amplitude[top], cut.unit)} at "
        f"{rounded('speed', cut.speed[top], 4)}"
    )
    curve = _over_speed(cut.speed, cut.amplitude, f"order {cut.order:.4g}", cut.unit)
    return stack(title, axis_label("speed"), [from_zero(amplitude_label(cut.unit), [curve], 1.4)])


@drawing(
    heading="Overall level",
    of="OverallLevel",
    made_by="Call tribodyn.analysis.overall_level(run_up) and its plot method.",
)
def overall_level(level: OverallLevel) -> Sketch:
    """Draw the alternating rms over the speed.

    Alternating rms of the signal over the speed; the circle marks the largest value.
    """
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


#: Colours from the smallest to the largest amplitude, and the decades between them.
_SCALE = [[0.0, "#ffffff"], [0.35, "#c6dbef"], [0.6, "#6baed6"], [0.8, "#2171b5"], [1.0, "#08306b"]]
_MAP_DECADES = 3
#: Height of the map relative to the curves below it.
MAP_HEIGHT = 1.9
#: Most cells along each side, about the number of pixels of a panel.
_MOST = 480
_CUTS = ((TOTAL, "solid"), (PINION, "dash"), (WHEEL, "dot"))
#: Most spectra, most points of each, and the height of the largest peak in spacings.
_CURVES, _POINTS, _REACH = 40, 600, 6.0


def with_unit(value: SupportsFloat, unit: str) -> str:
    """Write an amplitude with three digits and its unit."""
    return f"{significant(value)} {readable(unit)}".rstrip()


def amplitude_label(unit: str) -> str:
    """Label an axis of amplitudes."""
    return label_with("Amplitude", unit)


def amplitude_heatmap(x: Array, y: Array, amplitude: Array, unit: str, hover: str) -> Trace:
    """Describe a map of amplitudes with a logarithmic colour scale."""
    rows, columns = (-(-size // _MOST) for size in amplitude.shape)
    across, along = np.arange(0, x.size, columns), np.arange(0, y.size, rows)
    most = np.maximum.reduceat(np.maximum.reduceat(amplitude, along, axis=0), across, axis=1)
    largest = float(most.max()) or 1.0
    decades = np.log10(np.maximum(most / largest, 10.0**-_MAP_DECADES))
    ticks = np.arange(-_MAP_DECADES, 1)
    title = label_with("", unit).strip()
    scale = {**color_bar(title), "tickvals": ticks.tolist(), "outlinecolor": GRID}
    scale["ticktext"] = [significant(largest * 10.0**tick, 2) for tick in ticks.tolist()]
    scale["tickfont"] = {"color": INK}
    return heat(
        np.add.reduceat(x, across) / np.diff(np.append(across, x.size)),
        np.add.reduceat(y, along) / np.diff(np.append(along, y.size)),
        np.round(decades, 3), _SCALE, f"{hover}: %{{customdata:.3g}} {readable(unit)}",
        zmin=-_MAP_DECADES, zmax=0, customdata=most, colorbar=scale,
    )  # fmt: skip


@drawing(
    heading="Spectrogram",
    of="Spectrogram",
    made_by="Call tribodyn.analysis.spectrogram on a signal and its plot method.",
)
def spectrogram(result: Spectrogram) -> Sketch:
    """Draw amplitudes over time and frequency, and the rms over time.

    Amplitudes over time and frequency. Lines that rise with the speed are orders of a shaft;
    horizontal lines are natural frequencies. Below, the rms over time.
    """
    number, block = result.strongest()
    frequency, moment = float(result.frequency[number]), float(result.time[block])
    place, hover = (result.time, result.frequency[1:]), "%{y:.5g} Hz at %{x:.4g} s"
    surface = amplitude_heatmap(*place, result.amplitude[1:], result.unit, hover)
    rms = line(result.time, result.rms(), "rms", TOTAL, unit=readable(result.unit))
    panels = [
        Panel(axis_label("frequency"), [surface], height=MAP_HEIGHT),
        from_zero(label_with("Rms", result.unit), [rms]),
    ]
    title = (
        f"Strongest at {significant(frequency)} Hz after {significant(moment)} s: "
        f"{with_unit(result.amplitude[number, block], result.unit)}"
    )
    return stack(title, "Time [s]", panels, {"hovermode": "closest"})


def strongest_orders(result: OrderMap) -> list[float]:
    """Find the three orders that reach the largest amplitudes."""
    rms = np.sqrt(np.mean(result.amplitude**2, axis=1))
    main_lobe = 3  # lines: main lobe of the window
    rms[:main_lobe] = 0.0
    above = (rms >= np.append(0.0, rms[:-1])) & (rms > np.append(rms[1:], 0.0))
    peak = np.flatnonzero(above & (rms > 0.01 * float(rms.max())))
    lines: list[int] = []
    reach = result.amplitude.max(axis=1)
    for number in peak[np.argsort(reach[peak])[::-1]]:
        if all(abs(number - other) > main_lobe for other in lines):
            lines.append(int(number))
    return [float(result.order[number]) for number in lines[:3]]


def _axis(result: OrderMap) -> tuple[Array, str, str]:
    """Horizontal axis: speed where it is monotonic, else time; with label and unit."""
    change = np.diff(result.speed)
    least = 1e-6 * float(np.max(result.speed))
    if change.size and (np.all(change > least) or np.all(change < -least)):
        return displayed("speed", result.speed), axis_label("speed"), display_unit("speed")
    return np.asarray(result.time, dtype=float), "Time [s]", "s"


@drawing(
    heading="Order map",
    of="OrderMap",
    made_by="Call tribodyn.analysis.order_map on the record of a run-up and its plot method.",
)
def order_map(result: OrderMap) -> Sketch:
    """Draw amplitudes over orders and speed, and cuts at the strongest orders.

    Vibration synchronous with the shaft is a horizontal line; its order is the number of cycles per
    revolution. Where the line darkens, the order excites a natural frequency. Below, the strongest
    orders over the speed.
    """
    place, label, unit = _axis(result)
    orders = strongest_orders(result)
    surface = amplitude_heatmap(
        place, result.order, result.amplitude, result.unit, f"order %{{y:.4g}} at %{{x:.4g}} {unit}"
    )
    cuts = [
        line(place, result.cut(order).amplitude, f"order {order:.4g}", color, dash=dash,
             unit=readable(result.unit))
        for order, (color, dash) in zip(orders, _CUTS, strict=False)
    ]  # fmt: skip
    title = "No dominant order"
    if orders:
        first = result.cut(orders[0])
        block = int(np.argmax(first.amplitude))
        title = (
            f"Order {orders[0]:.4g} is the strongest: "
            f"{with_unit(first.amplitude[block], result.unit)} at "
            f"{rounded('speed', first.speed[block])}"
        )
    panels = [
        Panel("Order", [surface], height=MAP_HEIGHT),
        from_zero(amplitude_label(result.unit), cuts),
    ]
    return stack(title, label, panels, {"hovermode": "closest"})


@drawing(
    heading="Waterfall",
    of=("OrderMap", "Spectrogram"),
    made_by="Call tribodyn.analysis.order_map or spectrogram on a signal and draw what it returns.",
)
def waterfall(result: OrderMap | Spectrogram) -> Sketch:
    """Draw the spectra of an order map or a spectrogram as a waterfall.

    Stacked spectra, from the first at the bottom to the last at the top, with a common scale. The
    spectrum with the highest peak is coloured.
    """
    by_order = isinstance(result, OrderMap)
    place = result.order if isinstance(result, OrderMap) else result.frequency
    x_label = "Order" if by_order else axis_label("frequency")
    number, block = result.strongest()
    peak = float(result.amplitude[number, block])
    count = min(result.time.size, _CURVES)
    chosen = np.unique(np.linspace(0, result.time.size - 1, count).round().astype(int))
    chosen[int(np.argmin(np.abs(chosen - block)))] = block
    groups = np.arange(1, place.size, -(-place.size // _POINTS))
    foot = np.diff(np.append(groups, place.size))
    across = np.add.reduceat(place, groups) / foot
    unit = readable(result.unit)
    names = [_when(result, int(k)) for k in chosen]
    traces = []
    for level, (k, name) in enumerate(zip(chosen, names, strict=True)):
        height = np.maximum.reduceat(result.amplitude[:, k], groups)
        color, width = (WHEEL, 2.2) if k == block else (INK, 1.0)
        hover = f"%{{x:.4g}}: %{{customdata:.3g}} {unit}".rstrip() + f"<extra>{name}</extra>"
        style: Trace = {"width": width, "hovertemplate": hover, "showlegend": False}
        values = level + height * (_REACH / (peak or 1.0))
        traces.append(line(across, values, name, color, customdata=height, **style))
    ticks = np.unique(np.linspace(0, chosen.size - 1, 6).round().astype(int))
    what = f"order {place[number]:.4g}" if by_order else f"{significant(place[number])} Hz"
    axis = {"tickvals": ticks.tolist(), "ticktext": [names[k] for k in ticks], "showgrid": False}
    axis["tickfont"] = {"color": MUTED}
    panel = Panel("Speed" if by_order else "Time", traces, axis, height=2.6)
    title = f"The highest peak is {with_unit(peak, result.unit)}, {what} at {_when(result, block)}"
    return stack(title, x_label, [panel], {"hovermode": "closest"})


def _when(result: OrderMap | Spectrogram, block: int) -> str:
    """Format the speed or the time of a block."""
    if isinstance(result, OrderMap):
        return rounded("speed", result.speed[block])
    return f"{significant(result.time[block])} s"
