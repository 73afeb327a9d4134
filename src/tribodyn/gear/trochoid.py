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
from numpy.typing import NDArray

__all__ = ["Trochoid"]

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Trochoid:
    """Envelope of the rack's tip round in the frame of the gear.

    Parameters
    ----------
    reference_radius : float
        Radius of the reference circle [m].
    teeth : int
        Number of teeth.
    pressure_angle : float
        Pressure angle of the rack [rad].
    tip_radius : float
        Radius of the rack's tip round [m].
    center_offset : float
        Distance of the centre of the round from the centre line of the rack tooth [m].
    center_depth : float
        Depth of the centre of the round below the reference circle [m], negative above it.

    Notes
    -----
    Source: envelope of a circle carried by a rolling line; Litvin and Fuentes, Gear Geometry and
    Applied Theory, 2004, chapter 6.
    """

    reference_radius: float
    teeth: int
    pressure_angle: float
    tip_radius: float
    center_offset: float
    center_depth: float

    def _reach(self, normal_angle: Any) -> Array:
        """Distance from the rolling point to the cutting point along the normal [m]."""
        return np.asarray(self.center_depth / np.sin(normal_angle) + self.tip_radius, dtype=float)

    def radius(self, normal_angle: Any) -> Array:
        """Radius of the fillet.

        Parameters
        ----------
        normal_angle : float or array
            Angle of the common normal [rad], pressure angle to pi/2, any shape.

        Returns
        -------
        array
            Distance from the gear axis [m], same shape.
        """
        reach = self._reach(normal_angle)
        across = reach * np.cos(normal_angle)
        radius: Array = np.hypot(across, self.reference_radius - reach * np.sin(normal_angle))
        return radius

    def half_tooth_angle(self, normal_angle: Any) -> Array:
        """Angle between the tooth axis and the fillet.

        Parameters
        ----------
        normal_angle : float or array
            Angle of the common normal [rad], pressure angle to pi/2, any shape.

        Returns
        -------
        array
            Half of the angle that the tooth covers at this point [rad], same shape.
        """
        reach = self._reach(normal_angle)
        rolled = self.center_depth / np.tan(normal_angle) - self.center_offset
        from_space = np.arctan2(
            reach * np.cos(normal_angle), self.reference_radius - reach * np.sin(normal_angle)
        )
        half: Array = math.pi / self.teeth - from_space + rolled / self.reference_radius
        return half

    def squared_radius_slope(self, normal_angle: Any) -> Array:
        """Derivative of the squared radius by the angle of the normal.

        Parameters
        ----------
        normal_angle : float or array
            Angle of the common normal [rad], any shape.

        Returns
        -------
        array
            Slope [m^2/rad], same shape; negative, because the fillet rises from pi/2 downwards.
        """
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
