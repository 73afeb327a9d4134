"""The form circle: where the fillet ends and the involute begins."""

from __future__ import annotations

import math
from collections.abc import Callable

from tribodyn.gear.involute import involute
from tribodyn.gear.trochoid import Trochoid


def _bisect(function: Callable[[float], float], low: float, high: float) -> float:
    """Root of a function that is positive at ``low`` and not positive at ``high``."""
    while True:
        middle = 0.5 * (low + high)
        if middle in (low, high):
            return middle
        if function(middle) > 0.0:
            low = middle
        else:
            high = middle


def form_point(trochoid: Trochoid, base_radius: float, base_half_angle: float) -> float:
    """Angle of the fillet's normal at the point where the fillet meets the involute."""
    if not trochoid.undercuts:
        return trochoid.pressure_angle

    def above_base(angle: float) -> float:
        return float(trochoid.radius(angle)) - base_radius

    def outside_involute(angle: float) -> float:
        radius = max(float(trochoid.radius(angle)), base_radius)
        roll = math.sqrt((radius - base_radius) * (radius + base_radius)) / base_radius
        flank = base_half_angle - involute(math.atan(roll))
        return float(trochoid.half_tooth_angle(angle)) - flank

    at_base = _bisect(above_base, trochoid.pressure_angle, math.pi / 2.0)
    return _bisect(outside_involute, trochoid.pressure_angle, at_base)
