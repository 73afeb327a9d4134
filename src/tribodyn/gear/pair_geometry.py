"""Centre distance, operating pressure angle and tip shortening of a spur pair."""

from __future__ import annotations

import math

from tribodyn.errors import Argument, InputError, Problem, require_positive
from tribodyn.gear.involute import inverse_involute, involute


def operating_pressure_angle(
    teeth_sum: int, normal_module: float, normal_pressure_angle: float, center_distance: float
) -> float:
    """Pressure angle at the operating pitch circles: cos(alpha_wt) = a_0 cos(alpha) / a.

    Parameters
    ----------
    teeth_sum : int
        Sum of the numbers of teeth.
    normal_module : float
        Module [m].
    normal_pressure_angle : float
        Pressure angle of the rack [rad].
    center_distance : float
        Distance of the axes [m].

    Returns
    -------
    float
        Operating pressure angle [rad].

    Raises
    ------
    InputError
        If the centre distance is not greater than the sum of the base radii.

    Notes
    -----
    Source: ISO 21771, working transverse pressure angle.

    Examples
    --------
    >>> round(operating_pressure_angle(40, 4.5e-3, math.radians(20.0), 91.5e-3), 6)
    0.391631
    """
    require_positive("center_distance", center_distance, "m")
    reference = 0.5 * teeth_sum * normal_module
    cosine = reference * math.cos(normal_pressure_angle) / center_distance
    if cosine >= 1.0:
        raise InputError(
            Problem(
                what=f"center_distance = {center_distance * 1e3:.6g} mm",
                where=Argument("center_distance"),
                why="It must exceed the sum of the base radii, "
                f"{cosine * center_distance * 1e3:.6g} mm",
                remedy=f"The reference centre distance is {reference * 1e3:.6g} mm",
            )
        )
    return math.acos(cosine)


def zero_backlash_center_distance(
    teeth_sum: int, normal_module: float, normal_pressure_angle: float, shift_sum: float
) -> float:
    """Centre distance at which both flanks of the teeth touch.

    Parameters
    ----------
    teeth_sum : int
        Sum of the numbers of teeth.
    normal_module : float
        Module [m].
    normal_pressure_angle : float
        Pressure angle of the rack [rad].
    shift_sum : float
        Sum of the profile shift coefficients.

    Returns
    -------
    float
        Centre distance [m].

    Raises
    ------
    InputError
        If the shifts are so negative that no such distance exists.

    Notes
    -----
    inv(alpha_wt) = inv(alpha) + 2 (x_1 + x_2) tan(alpha) / (z_1 + z_2). Source: ISO 21771.

    Examples
    --------
    >>> round(zero_backlash_center_distance(40, 4.5e-3, math.radians(20.0), 0.3532) * 1e3, 3)
    91.5
    """
    angle = normal_pressure_angle
    value = involute(angle) + 2.0 * shift_sum * math.tan(angle) / teeth_sum
    if value < 0.0:
        least = -involute(angle) * teeth_sum / (2.0 * math.tan(angle))
        raise InputError(
            Problem(
                what=f"sum of the profile shift coefficients = {shift_sum:.6g}",
                where=Argument("profile_shift_coefficient"),
                why=f"No centre distance without play exists below a sum of {least:.6g}",
                remedy="Increase a shift, or give the centre distance",
            )
        )
    reference = 0.5 * teeth_sum * normal_module
    return reference * math.cos(angle) / math.cos(inverse_involute(value))


def tip_shortening_coefficient(
    teeth_sum: int, normal_module: float, shift_sum: float, center_distance: float
) -> float:
    """Shortening of both addenda that keeps the bottom clearance of the rack.

    Parameters
    ----------
    teeth_sum : int
        Sum of the numbers of teeth.
    normal_module : float
        Module [m].
    shift_sum : float
        Sum of the profile shift coefficients.
    center_distance : float
        Distance of the axes [m].

    Returns
    -------
    float
        k = x_1 + x_2 - (a - a_0)/m; zero where this is negative, because at a large centre
        distance the clearance is ample and the teeth are not lengthened.

    Notes
    -----
    Source: DIN 3960, tip alteration (there with the opposite sign).

    Examples
    --------
    >>> round(tip_shortening_coefficient(40, 4.5e-3, 0.8635 - 0.5103, 91.5e-3), 6)
    0.019867
    """
    reference = 0.5 * teeth_sum * normal_module
    return max(shift_sum - (center_distance - reference) / normal_module, 0.0)
