"""The curves of a tooth: the involute, and the fillet that the rack's tip round cuts.

The rack rolls without slip on the reference circle. Wherever its tip round cuts, the common
normal passes through the rolling point, so that the angle between this normal and the reference
tangent is a parameter free of singular points: pi/2 at the root circle, down to the pressure
angle where the round ends and the straight flank of the rack begins. In the transverse section of a
helical gear the tip round is an ellipse, wider along the rack. The fillet of a ring is an arc.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.errors import ComputationError, require_between
from tribodyn.types import Array


def involute(angle: float) -> float:
    """Involute function tan(angle) - angle.

    Parameters
    ----------
    angle : float
        Pressure angle [rad], 0 to below pi/2.

    Returns
    -------
    float
        Involute polar angle [rad].

    Notes
    -----
    Source: ISO 21771, involute function.

    Examples
    --------
    >>> round(involute(math.radians(20.0)), 9)
    0.014904384
    """
    return math.tan(angle) - angle


def inverse_involute(value: float) -> float:
    """Pressure angle whose involute function is ``value``."""
    require_between("value", value, 0.0, 1000.0, "rad")
    if value == 0.0:
        return 0.0
    angle = min(math.cbrt(3.0 * value), math.atan(value + math.pi / 2.0))
    for _ in range(60):
        step = (involute(angle) - value) / math.tan(angle) ** 2
        if step <= 1e-16:  # descending no more: rounding is reached
            return angle
        angle -= step
    raise ComputationError(
        f"no pressure angle found for the involute function {value!r}",
        why="The search left the range in which an angle was sought",
        remedy="Give a value of 0 or more that belongs to an angle below 80 degrees",
    )


@dataclass(frozen=True)
class Trochoid:
    """Envelope of the rack's tip round in the frame of the gear."""

    reference_radius: float  #: radius of the reference circle [m]
    teeth: int  #: number of teeth
    pressure_angle: float  #: pressure angle of the rack [rad]
    tip_radius: float  #: radius of the rack's tip round [m]
    center_offset: float  #: [m]
    center_depth: float
    stretch: float = 1.0  #: width of the tip round along the rack over its height

    @property
    def _excess(self) -> float:
        return self.stretch**2 - 1.0

    def _width(self, normal_angle: ArrayLike) -> Array:
        return np.asarray(np.sqrt(1.0 + self._excess * np.cos(normal_angle) ** 2))

    def _reach(self, normal_angle: ArrayLike) -> Array:
        """Distance from the rolling point to the cutting point along the normal [m]."""
        height = self.tip_radius / self._width(normal_angle)
        return np.asarray(self.center_depth / np.sin(normal_angle) + height, dtype=float)

    def radius(self, normal_angle: ArrayLike) -> Array:
        """Radius of the fillet."""
        reach = self._reach(normal_angle)
        across = reach * np.cos(normal_angle)
        radius: Array = np.hypot(across, self.reference_radius - reach * np.sin(normal_angle))
        return radius

    def half_tooth_angle(self, normal_angle: ArrayLike) -> Array:
        """Angle between the tooth axis and the fillet."""
        reach = self._reach(normal_angle)
        offset = self.center_offset + (
            self.tip_radius * self._excess * np.cos(normal_angle) / self._width(normal_angle)
        )
        rolled = self.center_depth / np.tan(normal_angle) - offset
        from_space = np.arctan2(
            reach * np.cos(normal_angle), self.reference_radius - reach * np.sin(normal_angle)
        )
        half: Array = math.pi / self.teeth - from_space + rolled / self.reference_radius
        return half

    def squared_radius_slope(self, normal_angle: ArrayLike) -> Array:
        """Derivative of the squared radius by the angle of the normal."""
        cube, reach = self._width(normal_angle) ** 3, self._reach(normal_angle)
        pull = self.reference_radius * self.tip_radius * (self.stretch**2 / cube) + (
            reach * self.center_depth / np.sin(normal_angle) ** 2
        )
        pull = pull - reach * (self.tip_radius * self._excess * np.sin(normal_angle) / cube)
        slope: Array = -2.0 * np.cos(normal_angle) * pull
        return slope

    @property
    def flank_end_reach(self) -> float:
        """Distance from the rolling point to the end of the rack's straight flank [m]."""
        return float(self._reach(self.pressure_angle))

    @property
    def undercuts(self) -> bool:
        """Whether the straight flank reaches past the base tangent point, so that it undercuts."""
        return self.flank_end_reach > self.reference_radius * math.sin(self.pressure_angle)


@dataclass(frozen=True)
class RootArc:
    """Root fillet of a ring: an arc that touches the flank and the root circle."""

    # Its parameter is the angle between its normal and the circumference at its centre: pi/2 at
    # the root circle, down to the pressure angle of its centre at the flank.
    arc_radius: float  #: radius of the arc [m]
    center_radius: float  #: distance of its centre from the axis of the ring [m]
    center_angle: float  #: angle of its centre from the axis of the tooth [rad]
    end_angle: float  #: parameter at the flank [rad]
    undercuts: bool = False

    def radius(self, normal_angle: ArrayLike) -> Array:
        """Radius of the fillet."""
        out = self.center_radius + self.arc_radius * np.sin(normal_angle)
        return np.asarray(np.hypot(self.arc_radius * np.cos(normal_angle), out))

    def half_tooth_angle(self, normal_angle: ArrayLike) -> Array:
        """Angle between the tooth axis and the fillet."""
        out = self.center_radius + self.arc_radius * np.sin(normal_angle)
        across = self.arc_radius * np.cos(normal_angle)
        return np.asarray(self.center_angle - np.arctan2(across, out))

    def squared_radius_slope(self, normal_angle: ArrayLike) -> Array:
        """Derivative of the squared radius by the angle of the normal."""
        return np.asarray(2.0 * self.center_radius * self.arc_radius * np.cos(normal_angle))


def root_arc(
    root_radius: float, base_radius: float, base_half_angle: float, teeth: int, arc_radius: float
) -> RootArc:
    """Root fillet of a ring with this radius, or the full round of its tooth space if smaller."""

    def arc(radius: float) -> RootArc:
        center = root_radius - radius
        roll = math.sqrt(max(center**2 - base_radius**2, 0.0)) / base_radius
        # A parallel curve of the involute is an involute: it turns by radius / base radius.
        turned = base_half_angle + radius / base_radius + roll - math.atan(roll)
        return RootArc(radius, center, turned, math.atan(roll))

    def fits(radius: float) -> float:
        return math.pi / abs(teeth) - arc(radius).center_angle

    full = arc_radius if fits(arc_radius) >= 0.0 else bisect(fits, 0.0, arc_radius)
    return arc(full)


def bisect(function: Callable[[float], float], low: float, high: float) -> float:
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

    at_base = bisect(above_base, trochoid.pressure_angle, math.pi / 2.0)
    return bisect(outside_involute, trochoid.pressure_angle, at_base)
