"""Geometry of two tooth forms at a centre distance, without checks that the pair can run.

Formulas are those of ISO 21771 with its signs: a ring has a negative number of teeth, and what
follows from it (the ratio, the length of the line of action, the radius of curvature of the ring)
is negative too, so that every formula is the one of an external pair. The centre distance is
positive, as on a drawing.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

from tribodyn.errors import Argument, InputError, require_positive
from tribodyn.gear.curves import inverse_involute, involute
from tribodyn.gear.tooth_form import ToothForm, transverse_pressure_angle
from tribodyn.types import Tree


def _reference_distance(teeth_sum: int, normal_module: float, helix_angle: float) -> float:
    """Distance at which the reference circles touch [m]."""
    return 0.5 * abs(teeth_sum) * (normal_module / math.cos(helix_angle))


def operating_pressure_angle(
    teeth_sum: int,
    normal_module: float,
    normal_pressure_angle: float,
    center_distance: float,
    helix_angle: float = 0.0,
) -> float:
    """Pressure angle at the operating pitch circles: cos(alpha_wt) = a_0 cos(alpha_t) / a.

    Parameters
    ----------
    teeth_sum : int
        Sum of the numbers of teeth; those of a ring are negative.
    normal_module, normal_pressure_angle : float [m], [rad]
        Module, and pressure angle of the rack.
    center_distance : float
        Distance of the axes [m], positive.
    helix_angle : float
        Helix angle at the reference cylinders [rad].

    Returns
    -------
    float
        Operating pressure angle [rad].

    Raises
    ------
    InputError
        If the centre distance is not greater than the sum of the base radii (of an internal pair,
        their difference).

    Notes
    -----
    Source: ISO 21771, working transverse pressure angle.

    Examples
    --------
    >>> round(operating_pressure_angle(40, 4.5e-3, math.radians(20.0), 91.5e-3), 6)
    0.391631
    """
    require_positive("center_distance", center_distance, "m")
    reference = _reference_distance(teeth_sum, normal_module, helix_angle)
    angle = transverse_pressure_angle(normal_pressure_angle, helix_angle)
    cosine = reference * math.cos(angle) / center_distance
    if cosine >= 1.0:
        raise InputError(
            f"center_distance = {center_distance * 1e3:.6g} mm",
            where=Argument("center_distance"),
            why=f"It must exceed the {'difference' if teeth_sum < 0 else 'sum'} of the base radii, "
            f"{cosine * center_distance * 1e3:.6g} mm",
            remedy=f"The reference centre distance is {reference * 1e3:.6g} mm",
        )
    return math.acos(cosine)


#: Contact ratio by which a whole number may be missed, and play in modules that is rounding.
_ROUNDING = 1e-9


def zero_backlash_center_distance(
    teeth_sum: int,
    normal_module: float,
    normal_pressure_angle: float,
    shift_sum: float,
    helix_angle: float = 0.0,
) -> float:
    """Centre distance at which both flanks of the teeth touch.

    Parameters
    ----------
    teeth_sum, normal_module, normal_pressure_angle
        As for :func:`operating_pressure_angle`, in [m] and [rad].
    shift_sum : float
        Sum of the profile shift coefficients.
    helix_angle : float
        Helix angle at the reference cylinders [rad].

    Returns
    -------
    float
        Centre distance [m], positive.

    Raises
    ------
    InputError
        If the shifts are so negative that no such distance exists.

    Notes
    -----
    inv(alpha_wt) = inv(alpha_t) + 2 (x_1 + x_2) tan(alpha_n) / (z_1 + z_2). Source: ISO 21771.

    Examples
    --------
    >>> round(zero_backlash_center_distance(40, 4.5e-3, math.radians(20.0), 0.3532) * 1e3, 3)
    91.5
    """
    angle = transverse_pressure_angle(normal_pressure_angle, helix_angle)
    tangent = math.tan(normal_pressure_angle)
    value = involute(angle) + 2.0 * shift_sum * tangent / teeth_sum
    if value < 0.0:
        limit = -involute(angle) * teeth_sum / (2.0 * tangent)
        what = f"sum of the profile shift coefficients = {shift_sum:.6g}"
        side, change = ("above", "Reduce") if teeth_sum < 0 else ("below", "Increase")
        why = f"No centre distance without play exists {side} a sum of {limit:.6g}"
        remedy = f"{change} a shift, or give the centre distance"
        raise InputError(what, Argument("profile_shift_coefficient"), why, remedy)
    reference = _reference_distance(teeth_sum, normal_module, helix_angle)
    return reference * math.cos(angle) / math.cos(inverse_involute(value))


def tip_shortening_coefficient(
    teeth_sum: int,
    normal_module: float,
    shift_sum: float,
    center_distance: float,
    helix_angle: float = 0.0,
) -> float:
    """Shortening of both addenda that keeps the bottom clearance of the rack.

    Parameters
    ----------
    teeth_sum, normal_module
        As for :func:`operating_pressure_angle`, in [m].
    shift_sum : float
        Sum of the profile shift coefficients.
    center_distance : float
        Distance of the axes [m].
    helix_angle : float
        Helix angle at the reference cylinders [rad].

    Returns
    -------
    float
        k = x_1 + x_2 - (a - a_0)/m; zero where this is negative, because at a large centre
        distance the clearance is ample and the teeth are not lengthened; zero for an internal
        pair, whose clearance does not shrink.

    Notes
    -----
    Source: DIN 3960, tip alteration (there with the opposite sign).

    Examples
    --------
    >>> round(tip_shortening_coefficient(40, 4.5e-3, 0.8635 - 0.5103, 91.5e-3), 6)
    0.019867
    """
    if teeth_sum < 0:
        return 0.0
    reference = _reference_distance(teeth_sum, normal_module, helix_angle)
    return max(shift_sum - (center_distance - reference) / normal_module, 0.0)


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
    def gears(self) -> Tree:
        """Both tooth forms by the name of their gear."""
        return {"pinion": self.pinion, "wheel": self.wheel}

    @cached_property
    def ratio(self) -> float:
        """Gear ratio z_wheel / z_pinion: at least one, negative for an internal pair."""
        return self.wheel.teeth / self.pinion.teeth

    @property
    def is_internal(self) -> bool:
        """Whether the wheel is a ring."""
        return self.wheel.is_ring

    @cached_property
    def base_pitch(self) -> float:
        """Distance of neighbouring flanks along the transverse line of action [m]."""
        return self.pinion.base_pitch

    @cached_property
    def helix_angle(self) -> float:
        """Helix angle at the reference cylinders [rad]."""
        return self.pinion.helix_angle

    @cached_property
    def base_helix_angle(self) -> float:
        """Helix angle at the base cylinders [rad]."""
        return self.pinion.base_helix_angle

    @cached_property
    def transverse_pressure_angle(self) -> float:
        """Pressure angle at the reference circles in the transverse section [rad]."""
        return self.pinion.transverse_pressure_angle

    @cached_property
    def operating_pressure_angle(self) -> float:
        """Pressure angle at the operating pitch circles, in the transverse section [rad]."""
        return operating_pressure_angle(
            self.pinion.teeth + self.wheel.teeth,
            self.pinion.normal_module,
            self.pinion.normal_pressure_angle,
            self.center_distance,
            self.helix_angle,
        )

    @property
    def working_transverse_pressure_angle(self) -> float:
        """Pressure angle at the operating pitch circles, by its name in ISO 21771 [rad]."""
        return self.operating_pressure_angle

    @cached_property
    def working_helix_angle(self) -> float:
        """Helix angle at the operating pitch cylinders [rad]."""
        cosine = math.cos(self.operating_pressure_angle)
        return math.atan(math.tan(self.base_helix_angle) / cosine)

    @cached_property
    def line_of_action_length(self) -> float:
        """Distance of the base tangent points, a sin(alpha_wt); negative for an internal pair [m].

        It is the sum of the radii of curvature of both flanks, where that of a ring is negative.
        """
        length = self.center_distance * math.sin(self.operating_pressure_angle)
        return self.wheel.sign * length

    @cached_property
    def path_limits(self) -> tuple[float, float]:
        """Ends of the path of contact as ``path`` [m]: at the wheel's tip, at the pinion's tip."""
        wheel_reach = self.wheel.roll_angle(self.wheel.tip_radius) * self.wheel.base_radius
        pinion_reach = self.pinion.roll_angle(self.pinion.tip_radius) * self.pinion.base_radius
        return self.line_of_action_length - self.wheel.sign * wheel_reach, pinion_reach

    @cached_property
    def transverse_contact_ratio(self) -> float:
        """Length of the path of contact over the base pitch."""
        first, last = self.path_limits
        return (last - first) / self.base_pitch

    @cached_property
    def backlash(self) -> float:
        """Total play on the line of action [m]; rounding of the shifts below zero counts as zero.

        The pitch at the operating circle less both tooth thicknesses there, projected on the
        line of action: (p_w - s_w1 - s_w2) cos(alpha_wt).
        """
        play = self.geometric_backlash
        return play if play > _ROUNDING * self.pinion.normal_module else 0.0

    @cached_property
    def geometric_backlash(self) -> float:
        """Total play on the line of action from the tooth thicknesses [m], rounding included."""
        cosine = math.cos(self.operating_pressure_angle)
        radii = (self.pinion.base_radius / cosine, self.wheel.base_radius / cosine)
        thickness = self.pinion.tooth_thickness(radii[0]) + self.wheel.tooth_thickness(radii[1])
        return (2.0 * math.pi * radii[0] / self.pinion.teeth - thickness) * cosine

    @cached_property
    def tip_shortening_coefficient(self) -> float:
        """Shortening of the addenda that default tip diameters have, over the module."""
        return tip_shortening_coefficient(
            self.pinion.teeth + self.wheel.teeth,
            self.pinion.normal_module,
            self.pinion.profile_shift_coefficient + self.wheel.profile_shift_coefficient,
            self.center_distance,
            self.helix_angle,
        )


class FlankRange(NamedTuple):
    """Used part of a flank, in radii of curvature of the involute; those of a ring are negative.

    Parameters
    ----------
    lowest : float [m]
        Where the mate's tip touches.
    highest : float [m]
        The tip.
    """

    lowest: float
    highest: float

    @property
    def length(self) -> float:
        """Roll length of the used flank, the length of the path of contact [m]."""
        return self.highest - self.lowest


def flank_ranges(mesh: MeshGeometry) -> tuple[FlankRange, FlankRange]:
    """Used flanks of both gears.

    Parameters
    ----------
    mesh : MeshGeometry
        The gears in mesh.

    Returns
    -------
    tuple of FlankRange
        Pinion and wheel.

    Examples
    --------
    >>> from tribodyn.gear import spur_pair
    >>> pair = spur_pair(pinion_teeth=20, wheel_teeth=30, normal_module=4e-3,
    ...                  normal_pressure_angle=math.radians(20.0), pinion_face_width=50e-3)
    >>> pinion, wheel = flank_ranges(pair)
    >>> math.isclose(pinion.length, wheel.length)
    True
    """
    (first, last), length = mesh.path_limits, mesh.line_of_action_length
    return FlankRange(first, last), FlankRange(length - last, length - first)


def default_relief_length(mesh: MeshGeometry) -> float:
    """Length of a relief that nobody stated: to where the number of tooth pairs changes.

    Parameters
    ----------
    mesh : MeshGeometry
        The gears in mesh.

    Returns
    -------
    float
        Roll length [m]: (contact ratio - 1) base pitches up to a contact ratio of 2, and what
        exceeds the next lower whole number above it.

    Examples
    --------
    >>> from tribodyn.gear import spur_pair
    >>> pair = spur_pair(pinion_teeth=20, wheel_teeth=30, normal_module=4e-3,
    ...                  normal_pressure_angle=math.radians(20.0), pinion_face_width=50e-3)
    >>> round(default_relief_length(pair) / pair.base_pitch, 3)
    0.605
    """
    ratio = mesh.transverse_contact_ratio
    return (ratio - math.ceil(ratio - _ROUNDING) + 1.0) * mesh.base_pitch
