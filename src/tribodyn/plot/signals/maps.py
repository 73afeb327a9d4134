"""Amplitudes over time or speed: spectrogram, order map, and spectra one behind the other."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.analysis import OrderMap
from tribodyn.drawing import drawing
from tribodyn.plot.look.labels import (
    axis_label,
    display_unit,
    displayed,
    readable,
    rounded,
    significant,
)
from tribodyn.plot.look.panels import Panel, stack
from tribodyn.plot.look.style import GRID, INK, MUTED, PINION, TOTAL, WHEEL, line
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.analysis import Spectrogram

#: From silence to the largest amplitude, and the decades between them.
_SCALE = [[0.0, "#ffffff"], [0.35, "#c6dbef"], [0.6, "#6baed6"], [0.8, "#2171b5"], [1.0, "#08306b"]]
_DECADES = 3
#: Height of the map relative to the curves below it.
MAP_HEIGHT = 1.9
#: Most cells along each side: more than the pixels of the panel show nothing more.
_MOST = 480
_BAR = {"len": 0.62, "y": 1.0, "yanchor": "top", "thickness": 14, "x": 1.01, "xanchor": "left"}
_CUTS = ((TOTAL, "solid"), (PINION, "dash"), (WHEEL, "dot"))
#: Most spectra drawn, most points in one, and how many steps up the largest amplitude reaches.
_CURVES, _POINTS, _REACH = 40, 600, 6.0


def with_unit(value: float, unit: str) -> str:
    """Write an amplitude with three digits and its unit."""
    return f"{significant(value)} {readable(unit)}".rstrip()


def amplitude_label(unit: str) -> str:
    """Label an axis of amplitudes."""
    return f"Amplitude [{readable(unit)}]" if unit else "Amplitude"


def amplitude_heatmap(
    x: Array, y: Array, amplitude: Array, unit: str, hover: str
) -> dict[str, Any]:
    """Describe a map of amplitudes on a logarithmic scale of colours."""
    rows, columns = (-(-size // _MOST) for size in amplitude.shape)
    across, along = np.arange(0, x.size, columns), np.arange(0, y.size, rows)
    most = np.maximum.reduceat(np.maximum.reduceat(amplitude, along, axis=0), across, axis=1)
    largest = float(most.max()) or 1.0
    decades = np.log10(np.maximum(most / largest, 10.0**-_DECADES))
    ticks = np.arange(-_DECADES, 1)
    return {
        "type": "heatmap",
        "x": np.add.reduceat(x, across) / np.diff(np.append(across, x.size)),
        "y": np.add.reduceat(y, along) / np.diff(np.append(along, y.size)),
        "z": np.round(decades, 3),
        "zmin": -_DECADES,
        "zmax": 0,
        "customdata": most,
        "colorscale": _SCALE,
        "colorbar": {
            **_BAR,
            "title": {
                "text": f"[{readable(unit)}]" if unit else "",
                "side": "top",
                "font": {"size": 13, "color": MUTED},
            },
            "tickvals": ticks.tolist(),
            "ticktext": [significant(largest * 10.0**tick, 2) for tick in ticks.tolist()],
            "outlinecolor": GRID,
            "tickfont": {"color": INK},
        },
        "hovertemplate": f"{hover}: %{{customdata:.3g}} {readable(unit)}<extra></extra>",
        "showlegend": False,
    }


@drawing(
    "spectrogram",
    heading="Spectrogram",
    caption="Which frequencies are there at what time. Lines that rise with the speed are orders "
    "of a shaft; level ones are natural frequencies. Below, the rms over time.",
    of="Spectrogram",
    made_by="Call tribodyn.analysis.spectrogram on a signal and its plot method.",
)
def spectrogram(result: Spectrogram) -> Any:
    """Draw amplitudes over time and frequency, and the rms over time."""
    number, block = result.strongest()
    frequency, moment = float(result.frequency[number]), float(result.time[block])
    panels = [
        Panel(
            axis_label("frequency"),
            [
                amplitude_heatmap(
                    result.time,
                    result.frequency[1:],
                    result.amplitude[1:],
                    result.unit,
                    "%{y:.5g} Hz at %{x:.4g} s",
                )
            ],
            height=MAP_HEIGHT,
        ),
        Panel(
            f"Rms [{readable(result.unit)}]" if result.unit else "Rms",
            [line(result.time, result.rms(), "rms", TOTAL, unit=readable(result.unit))],
            {"rangemode": "tozero"},
        ),
    ]
    return stack(
        f"Strongest at {significant(frequency)} Hz after {significant(moment)} s: "
        f"{with_unit(float(result.amplitude[number, block]), result.unit)}",
        "Time [s]",
        panels,
        {"hovermode": "closest"},
    )


def strongest_orders(result: OrderMap) -> list[float]:
    """Find the three orders that reach the largest amplitudes."""
    most = np.sqrt(np.mean(result.amplitude**2, axis=1))
    apart = 3  # lines: main lobe of the window
    most[:apart] = 0.0
    found: list[float] = []
    limit = 0.01 * float(most.max())
    peak = np.flatnonzero(
        (most >= np.append(0.0, most[:-1])) & (most > np.append(most[1:], 0.0)) & (most > limit)
    )
    taken: list[int] = []
    reach = result.amplitude.max(axis=1)
    for number in peak[np.argsort(reach[peak])[::-1]]:
        if all(abs(number - other) > apart for other in taken) and len(found) < 3:
            taken.append(int(number))
            found.append(float(result.order[number]))
    return found


def _axis(result: OrderMap) -> tuple[Array, str, str]:
    """Speed where it only rises or only falls, else time; label and unit on hovering."""
    change = np.diff(result.speed)
    least = 1e-6 * float(np.max(result.speed))
    if change.size and (np.all(change > least) or np.all(change < -least)):
        return displayed("speed", result.speed), axis_label("speed"), display_unit("speed")
    return np.asarray(result.time, dtype=float), "Time [s]", "s"


@drawing(
    "order_map",
    heading="Order map",
    caption="What turns with the shaft is a level line; its order counts the cycles in one "
    "revolution. Where a level line darkens, that order meets a natural frequency. Below, the "
    "strongest orders over the speed.",
    of="OrderMap",
    made_by="Call tribodyn.analysis.order_map on the record of a run-up and its plot method.",
)
def order_map(result: OrderMap) -> Any:
    """Draw amplitudes over orders and speed, and cuts at the strongest orders."""
    place, label, unit = _axis(result)
    orders = strongest_orders(result)
    surface = amplitude_heatmap(
        place, result.order, result.amplitude, result.unit, f"order %{{y:.4g}} at %{{x:.4g}} {unit}"
    )
    cuts = [
        line(
            place,
            result.cut(order).amplitude,
            f"order {order:.4g}",
            color,
            unit=readable(result.unit),
            dash=dash,
        )
        for order, (color, dash) in zip(orders, _CUTS, strict=False)
    ]
    title = "No order stands out"
    if orders:
        first = result.cut(orders[0])
        block = int(np.argmax(first.amplitude))
        title = (
            f"Order {orders[0]:.4g} is the strongest: "
            f"{with_unit(float(first.amplitude[block]), result.unit)} at "
            f"{rounded('speed', float(first.speed[block]))}"
        )
    panels = [
        Panel("Order", [surface], height=MAP_HEIGHT),
        Panel(amplitude_label(result.unit), cuts, {"rangemode": "tozero"}),
    ]
    return stack(title, label, panels, {"hovermode": "closest"})


@drawing(
    "waterfall",
    heading="Waterfall",
    caption="One spectrum behind the other, from the first at the bottom to the last at the top; "
    "all on one scale. The one with the highest peak is drawn in colour.",
    of=("OrderMap", "Spectrogram"),
    made_by="Call tribodyn.analysis.order_map or spectrogram on a signal and draw what it returns.",
)
def waterfall(result: OrderMap | Spectrogram) -> Any:
    """Draw the spectra of an order map or a spectrogram one behind the other."""
    by_order = isinstance(result, OrderMap)
    place = result.order if isinstance(result, OrderMap) else result.frequency
    words = "Order" if by_order else axis_label("frequency")
    number, block = result.strongest()
    peak = float(result.amplitude[number, block])
    few = min(result.time.size, _CURVES)
    chosen = np.unique(np.linspace(0, result.time.size - 1, few).round().astype(int))
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
        curve = line(across, level + height * (_REACH / (peak or 1.0)), name, color, width=width)
        hover = f"%{{x:.4g}}: %{{customdata:.3g}} {unit}".rstrip() + f"<extra>{name}</extra>"
        traces.append({**curve, "customdata": height, "hovertemplate": hover, "showlegend": False})
    ticks = np.unique(np.linspace(0, chosen.size - 1, 6).round().astype(int))
    what = f"order {place[number]:.4g}" if by_order else f"{significant(float(place[number]))} Hz"
    axis = {
        "tickvals": ticks.tolist(),
        "ticktext": [names[k] for k in ticks],
        "showgrid": False,
        "tickfont": {"color": MUTED},
    }
    label = "Speed" if by_order else "Time"
    return stack(
        f"The highest peak is {with_unit(peak, result.unit)}, {what} at {_when(result, block)}",
        words,
        [Panel(label, traces, axis, height=2.6)],
        {"hovermode": "closest"},
    )


def _when(result: OrderMap | Spectrogram, block: int) -> str:
    """Speed or time of a block."""
    if isinstance(result, OrderMap):
        return rounded("speed", float(result.speed[block]))
    return f"{significant(float(result.time[block]))} s"
