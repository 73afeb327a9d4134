"""The fillet curve: what the rounded tip of the generating rack cuts into the tooth root.

The rack rolls without slip on the reference circle. Wherever its tip round cuts, the common
normal passes through the rolling point, so that the angle between this normal and the reference
tangent is a parameter free of singular points: pi/2 at the root circle, down to the pressure
angle where the round ends and the straight flank of the rack begins.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from tribodyn.types import Array


@dataclass(frozen=True)
class Trochoid:
    """Envelope of the rack's tip round in the frame of the gear."""

    reference_radius: float  #: radius of the reference circle [m]
    teeth: int  #: number of teeth
    pressure_angle: float  #: pressure angle of the rack [rad]
    tip_radius: float  #: radius of the rack's tip round [m]
    center_offset: float  #: [m]
    center_depth: float

    def _reach(self, normal_angle: Any) -> Array:
        """Distance from the rolling point to the cutting point along the normal [m]."""
        return np.asarray(self.center_depth / np.sin(normal_angle) + self.tip_radius, dtype=float)

    def radius(self, normal_angle: Any) -> Array:
        """Radius of the fillet."""
        reach = self._reach(normal_angle)
        across = reach * np.cos(normal_angle)
        radius: Array = np.hypot(across, self.reference_radius - reach * np.sin(normal_angle))
        return radius

    def half_tooth_angle(self, normal_angle: Any) -> Array:
        """Angle between the tooth axis and the fillet."""
        reach = self._reach(normal_angle)
        rolled = self.center_depth / np.tan(normal_angle) - self.center_offset
        from_space = np.arctan2(
            reach * np.cos(normal_angle), self.reference_radius - reach * np.sin(normal_angle)
        )
        half: Array = math.pi / self.teeth - from_space + rolled / self.reference_radius
        return half

    def squared_radius_slope(self, normal_angle: Any) -> Array:
        """Derivative of the squared radius by the angle of the normal."""
        pull = self.reference_radius * self.tip_radius + (
            self._reach(normal_angle) * self.center_depth / np.sin(normal_angle) ** 2
        )
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
