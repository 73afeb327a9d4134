"""Amplitude over orders and speed as a map in colours, with the strongest orders below it."""

from __future__ import annotations

from typing import Any

import numpy as np

from tribodyn.drawing import drawing
from tribodyn.plot.labels import axis_label, display_unit, displayed, readable, rounded
from tribodyn.plot.spectrogram import MAP_HEIGHT, amplitude_heatmap, amplitude_label, with_unit
from tribodyn.plot.style import PINION, TOTAL, WHEEL, Panel, line, stack
from tribodyn.types import Array

_CUTS = ((TOTAL, "solid"), (PINION, "dash"), (WHEEL, "dot"))


def strongest_orders(result: Any, count: int = 3) -> list[float]:
    """Find the orders that reach the largest amplitudes."""
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
        if all(abs(number - other) > apart for other in taken) and len(found) < count:
            taken.append(int(number))
            found.append(float(result.order[number]))
    return found


def _missing(result: Any) -> str:
    if hasattr(result, "cut") and hasattr(result, "revolutions"):
        return ""
    return (
        "This figure shows amplitudes over orders and speed. Call tribodyn.analysis.order_map on "
        "the record of a run-up and tribodyn.plot.order_map.order_map on what it returns."
    )


def _axis(result: Any) -> tuple[Array, str, str]:
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
    needs=_missing,
)
def order_map(result: Any) -> Any:
    """Draw amplitudes over orders and speed, and cuts at the strongest orders.

    Parameters
    ----------
    result : OrderMap
        What :func:`tribodyn.analysis.order_map` returns.

    Returns
    -------
    plotly.graph_objects.Figure
    """
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
    return stack(title, label, panels).update_layout(hovermode="closest")
