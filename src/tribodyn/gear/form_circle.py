"""The form circle: where the fillet ends and the involute begins."""

from __future__ import annotations

import math
from collections.abc import Callable

from tribodyn.gear.involute import involute
from tribodyn.gear.trochoid import Trochoid

__all__ = ["form_point"]


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
    """Angle of the fillet's normal at the point where the fillet meets the involute.

    Parameters
    ----------
    trochoid : Trochoid
        Fillet curve.
    base_radius : float
        Radius of the base circle [m].
    base_half_angle : float
        Half tooth thickness at the base circle as an angle [rad].

    Returns
    -------
    float
        Parameter of the fillet [rad]: the pressure angle when the curves are tangent, more when
        the gear is undercut and the curves cross.

    Notes
    -----
    An undercutting fillet leaves the base circle inside the tooth that the involute bounds and
    ends outside of it, because the end of the rack flank has then passed the base tangent point
    and lies on the mirror branch of the involute. One crossing lies between.

    Examples
    --------
    >>> curve = Trochoid(20e-3, 20, math.radians(20.0), 0.76e-3, 0.3e-3, 1.74e-3)
    >>> form_point(curve, 18.79e-3, 0.09) == curve.pressure_angle
    True
    """
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
