"""Panels that show a signal of both gear centres, along the line of action and across it."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from tribodyn.plot.harmonics import harmonic_panel
from tribodyn.plot.labels import axis_label, axis_words, display_unit
from tribodyn.plot.motion import Motion
from tribodyn.plot.style import PINION, WHEEL, Panel, line
from tribodyn.study.pipeline.record import centre_column
from tribodyn.types import Array

#: Takes a result, a gear and an axis; returns the signal on the fine samples in SI.
Signal = Callable[[Any, str, str], Array]

#: Name and colour of each gear's curve.
_GEARS = (("pinion", PINION), ("wheel", WHEEL))
#: Axis of the coordinate and the words for it.
_DIRECTIONS = (("y", "along the line of action"), ("x", "across the line of action"))


def _words(quantity: str, direction: str) -> str:
    """Quantity and direction on two lines, which fit beside one panel."""
    return f"{axis_words(quantity)}<br>{direction}"


def no_translation(result: Any) -> str:
    """Tell why a result has no motion of the gear centres."""
    if centre_column(result.response.names, "pinion", "y") is not None:
        return ""
    return (
        "The model turns the gears only: their centres stay in place and no bearing is loaded. "
        'Choose dynamics.model = "spur-6dof" to let them move.'
    )


def motion_panels(result: Any, quantity: str, signal: Signal) -> list[Panel]:
    """Show a signal of both gears over the mesh cycle or over time."""
    motion, unit = Motion(result), display_unit(quantity)

    def curve(gear: str, axis: str, color: str) -> dict[str, Any]:
        x, y = motion.curve(quantity, signal(result, gear, axis))
        return line(x, y, gear, color, unit=unit, width=1.5)

    return [
        Panel(
            axis_label(quantity, _words(quantity, words)),
            [curve(gear, axis, color) for gear, color in _GEARS],
        )
        for axis, words in _DIRECTIONS
    ]


def harmonic_panels(result: Any, quantity: str, signal: Signal) -> list[Panel]:
    """Show the mesh harmonics of a signal of both gears."""
    if no_translation(result):
        return []
    return [
        harmonic_panel(
            result,
            quantity,
            _words(quantity, words),
            [(gear, color, signal(result, gear, axis)) for gear, color in _GEARS],
        )
        for axis, words in _DIRECTIONS
    ]
