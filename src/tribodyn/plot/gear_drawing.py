"""Both gears at their true places with two flanks touching on the line of action.

The pinion's axis is the origin, the wheel's axis lies at the center distance on the horizontal
axis. The line of action leaves the pinion's base circle upwards, which holds for a pinion that
turns anticlockwise when it drives and clockwise when it is driven.
"""

from __future__ import annotations

import cmath
import math
from typing import Any

import numpy as np

from tribodyn.gear import gear_outline
from tribodyn.types import Array

#: Array of each tooth: enough for a smooth trochoid on the screen.
_TOOTH_POINTS = 60


def on_line_of_action(pair: Any, path: Any) -> Array:
    """Place positions on the line of action in the plane."""
    angle, radius = pair.operating_pressure_angle, pair.pinion.base_radius
    along = np.asarray(path, dtype=float)
    x = radius * math.cos(angle) + along * math.sin(angle)
    y = -radius * math.sin(angle) + along * math.cos(angle)
    return np.array([x, y])


def tooth_angles(pair: Any, path: float) -> tuple[float, float]:
    """Directions of the two teeth that touch at a position."""
    x, y = on_line_of_action(pair, path)
    places = ((pair.pinion, x, y), (pair.wheel, x - pair.center_distance, y))
    first, second = (
        math.atan2(v, u) - float(gear.half_tooth_angle(math.hypot(u, v))) for gear, u, v in places
    )
    return first, second


def placed_outline(gear: Any, center: float, angle: float, points: int = _TOOTH_POINTS) -> Array:
    """Outline of a whole gear at its place."""
    x, y = gear_outline(gear, points)
    turned = (x + 1j * y) * cmath.exp(1j * (angle - math.pi / 2.0))
    return np.array([center + turned.real, turned.imag])


def circle(center: float, radius: float, points: int = 181) -> Array:
    """Array of a circle around a point of the horizontal axis."""
    angle = np.linspace(0.0, 2.0 * np.pi, points)
    return np.array([center + radius * np.cos(angle), radius * np.sin(angle)])


def rotation_arc(center: float, radius: float, sense: int, points: int = 25) -> Array:
    """Array of an arc above a gear's axis, in the order in which the gear turns."""
    angle = 0.5 * np.pi + sense * np.linspace(-0.25 * np.pi, 0.25 * np.pi, points)
    return np.array([center + radius * np.cos(angle), radius * np.sin(angle)])
