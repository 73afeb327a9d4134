"""Deviations of a gear by its accuracy grade: ISO 1328-1, editions 1995 and 2013.

1995, at grade 5 and for the geometric means of ranges, in um and mm:
``f_pt = 0.3 (m + 0.4 sqrt d) + 4``, ``f_fa = 2.5 sqrt m + 0.17 sqrt d + 0.5``,
``f_Hb = 0.07 sqrt d + 0.45 sqrt b + 3``, by sqrt 2 per grade. 2013, class 5, at the values:
``f_pT = 0.001 d + 0.4 m + 5``, ``f_faT = 0.55 m + 5``, ``f_HbT = 0.05 sqrt d + 0.35 sqrt b + 4``.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Final, NamedTuple

from tribodyn.errors import Argument, InputError, require_between
from tribodyn.gear import CylindricalGear

_DIAMETERS: Final = (5.0, 20.0, 50.0, 125.0, 280.0, 560.0, 1000.0, 1600.0, 2500.0)
_MODULES: Final = (0.5, 2.0, 3.5, 6.0, 10.0, 16.0, 25.0, 40.0)
_WIDTHS: Final = (4.0, 10.0, 20.0, 40.0, 80.0, 160.0, 250.0, 400.0)


class Deviations(NamedTuple):
    """Deviations of a gear that a rating needs.

    Parameters
    ----------
    single_pitch : float [m]
        f_pt.
    profile_form : float [m]
        f_fa.
    helix_slope : float [m]
        f_Hb.
    """

    single_pitch: float
    profile_form: float
    helix_slope: float


def _geometric_mean(name: str, value: float, limits: tuple[float, ...]) -> float:
    for low, high in pairwise(limits):
        if low <= value <= high:
            return math.sqrt(low * high)
    raise InputError(
        f"{name} = {value:g} mm",
        Argument(name),
        f"The tolerances of ISO 1328-1:1995 go from {limits[0]:g} to {limits[-1]:g} mm",
        "Give pitch_deviation, profile_deviation and helix_deviation to td.rating.RatedGear",
    )


def _rounded(value: float) -> float:
    """Rounded as the standard has it, in um."""
    step = 1.0 if value > 10.0 else 0.5 if value >= 5.0 else 0.1
    return math.floor(value / step + 0.5) * step


def gear_tolerances(gear: CylindricalGear, grade: int, edition: int = 1995) -> Deviations:
    """Tolerances of a gear by accuracy grade.

    Parameters
    ----------
    gear : CylindricalGear
        The gear.
    grade : int
        Accuracy grade 0 to 12 of 1995, or tolerance class 1 to 11 of 2013.
    edition : int
        1995, with which the ratings were calibrated, or 2013.

    Returns
    -------
    Deviations

    Raises
    ------
    InputError
        If the edition or grade does not exist, or the gear is out of the range of the tables.

    Notes
    -----
    Source: ISO 1328-1:1995. The formulas of 2013 are from memory of the text, not compared with it.

    Examples
    --------
    >>> from tribodyn.gear import spur_pair
    >>> gear = spur_pair(pinion_teeth=20, wheel_teeth=30, normal_module=4e-3,
    ...     normal_pressure_angle=0.3490658504, pinion_face_width=50e-3).pinion
    >>> [round(value * 1e6, 1) for value in gear_tolerances(gear, 6)]
    [9.0, 10.0, 10.0]
    """
    if edition not in (1995, 2013):
        what, why = f"tolerance_edition = {edition}", "ISO 1328-1 has 1995 and 2013"
        raise InputError(what, Argument("tolerance_edition"), why, "Choose one of these")
    first, last = (0, 12) if edition == 1995 else (1, 11)
    require_between("accuracy_grade", grade, first, last)
    d, m, b = 2e3 * gear.reference_radius, 1e3 * gear.normal_module, 1e3 * gear.face_width
    if edition == 1995:
        d = _geometric_mean("reference_diameter", d, _DIAMETERS)
        m = _geometric_mean("normal_module", m, _MODULES)
        b = _geometric_mean("face_width", b, _WIDTHS)
        at_5 = (
            0.3 * (m + 0.4 * math.sqrt(d)) + 4.0,
            2.5 * math.sqrt(m) + 0.17 * math.sqrt(d) + 0.5,
            0.07 * math.sqrt(d) + 0.45 * math.sqrt(b) + 3.0,
        )
    else:
        at_5 = (
            0.001 * d + 0.4 * m + 5.0,
            0.55 * m + 5.0,
            0.05 * math.sqrt(d) + 0.35 * math.sqrt(b) + 4.0,
        )
    return Deviations(*(1e-6 * _rounded(value * 2.0 ** (0.5 * (grade - 5))) for value in at_5))
