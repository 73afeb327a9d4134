"""What follows from two tooth forms and a centre distance, before anybody asks if it can run."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

from tribodyn.gear.pair_geometry import operating_pressure_angle, tip_shortening_coefficient
from tribodyn.gear.tooth_form import ToothForm


@dataclass(frozen=True)
class MeshGeometry:
    """Geometry of two tooth forms in mesh.

    Parameters
    ----------
    pinion : ToothForm
        Tooth form of the pinion.
    wheel : ToothForm
        Tooth form of the wheel.
    center_distance : float
        Distance of the axes [m].

    Notes
    -----
    Source: ISO 21771, cylindrical gear pairs. Positions on the line of action are called
    ``path``: the distance from the pinion's base tangent point, whichever gear drives.
    """

    pinion: ToothForm
    wheel: ToothForm
    center_distance: float

    @property
    def ratio(self) -> float:
        """Gear ratio z_wheel / z_pinion, at least one."""
        return self.wheel.teeth / self.pinion.teeth

    @property
    def base_pitch(self) -> float:
        """Distance of neighbouring flanks along the line of action [m]."""
        return self.pinion.base_pitch

    @cached_property
    def operating_pressure_angle(self) -> float:
        """Pressure angle at the operating pitch circles [rad]."""
        return operating_pressure_angle(
            self.pinion.teeth + self.wheel.teeth,
            self.pinion.normal_module,
            self.pinion.normal_pressure_angle,
            self.center_distance,
        )

    @property
    def line_of_action_length(self) -> float:
        """Distance of the two base tangent points, a sin(alpha_wt) [m]."""
        return self.center_distance * math.sin(self.operating_pressure_angle)

    @property
    def path_limits(self) -> tuple[float, float]:
        """Ends of the path of contact as ``path`` [m]: at the wheel's tip, at the pinion's tip."""
        wheel_reach = self.wheel.roll_angle(self.wheel.tip_radius) * self.wheel.base_radius
        pinion_reach = self.pinion.roll_angle(self.pinion.tip_radius) * self.pinion.base_radius
        return self.line_of_action_length - wheel_reach, pinion_reach

    @property
    def transverse_contact_ratio(self) -> float:
        """Length of the path of contact over the base pitch."""
        first, last = self.path_limits
        return (last - first) / self.base_pitch

    @property
    def backlash(self) -> float:
        """Total play on the line of action [m]; rounding of the shifts below zero counts as zero.

        The pitch at the operating circle less both tooth thicknesses there, projected on the
        line of action: (p_w - s_w1 - s_w2) cos(alpha_wt).
        """
        return max(self.geometric_backlash, 0.0)

    @cached_property
    def geometric_backlash(self) -> float:
        """Total play on the line of action as the thicknesses give it [m], rounding included."""
        cosine = math.cos(self.operating_pressure_angle)
        radii = (self.pinion.base_radius / cosine, self.wheel.base_radius / cosine)
        thickness = self.pinion.tooth_thickness(radii[0]) + self.wheel.tooth_thickness(radii[1])
        return (2.0 * math.pi * radii[0] / self.pinion.teeth - thickness) * cosine

    @property
    def tip_shortening_coefficient(self) -> float:
        """Shortening of the addenda that default tip diameters have, over the module."""
        return tip_shortening_coefficient(
            self.pinion.teeth + self.wheel.teeth,
            self.pinion.normal_module,
            self.pinion.profile_shift_coefficient + self.wheel.profile_shift_coefficient,
            self.center_distance,
        )
