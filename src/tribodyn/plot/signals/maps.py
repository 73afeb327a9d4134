"""Amplitudes over time or speed: spectrogram, order map and waterfall."""

from __future__ import annotations

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
from tribodyn.plot.theme.panels import Panel, from_zero, stack
from tribodyn.plot.theme.style import Trace, color_bar, heat, line
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.analysis import Spectrogram

#: Colours from the smallest to the largest amplitude, and the decades between them.
_SCALE = [[0.0, "#ffffff"], [0.35, "#c6dbef"], [0.6, "#6baed6"], [0.8, "#2171b5"], [1.0, "#08306b"]]
_DECADES = 3
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
    decades = np.log10(np.maximum(most / largest, 10.0**-_DECADES))
    ticks = np.arange(-_DECADES, 1)
    title = label_with("", unit).strip()
    scale = {**color_bar(title), "tickvals": ticks.tolist(), "outlinecolor": GRID}
    scale["ticktext"] = [significant(largest * 10.0**tick, 2) for tick in ticks.tolist()]
    scale["tickfont"] = {"color": INK}
    return heat(
        np.add.reduceat(x, across) / np.diff(np.append(across, x.size)),
        np.add.reduceat(y, along) / np.diff(np.append(along, y.size)),
        np.round(decades, 3), _SCALE, f"{hover}: %{{customdata:.3g}} {readable(unit)}",
        zmin=-_DECADES, zmax=0, customdata=most, colorbar=scale,
    )  # fmt: skip


@drawing(
    heading="Spectrogram",
    caption="Amplitudes over time and frequency. Lines that rise with the speed are orders "
    "of a shaft; horizontal lines are natural frequencies. Below, the rms over time.",
    of="Spectrogram",
    made_by="Call tribodyn.analysis.spectrogram on a signal and its plot method.",
)
def spectrogram(result: Spectrogram) -> Sketch:
    """Draw amplitudes over time and frequency, and the rms over time."""
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
    caption="Vibration synchronous with the shaft is a horizontal line; its order is the number "
    "of cycles per revolution. Where the line darkens, the order excites a natural frequency. "
    "Below, the strongest orders over the speed.",
    of="OrderMap",
    made_by="Call tribodyn.analysis.order_map on the record of a run-up and its plot method.",
)
def order_map(result: OrderMap) -> Sketch:
    """Draw amplitudes over orders and speed, and cuts at the strongest orders."""
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
    title = "No order stands out"
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
    caption="Stacked spectra, from the first at the bottom to the last at the top, "
    "with a common scale. The spectrum with the highest peak is coloured.",
    of=("OrderMap", "Spectrogram"),
    made_by="Call tribodyn.analysis.order_map or spectrogram on a signal and draw what it returns.",
)
def waterfall(result: OrderMap | Spectrogram) -> Sketch:
    """Draw the spectra of an order map or a spectrogram as a waterfall."""
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
