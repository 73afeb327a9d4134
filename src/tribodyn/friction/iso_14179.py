"""Mean friction of a gear mesh by the two parts of ISO/TR 14179, which differ."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.errors import require_positive
from tribodyn.friction.base import Range, TribologicalContact, warn_outside
from tribodyn.friction.mesh_means import PitchPoint, mean_friction, mean_law
from tribodyn.model import choice
from tribodyn.types import Array

_LEAST_LOAD = 150e3  # [N/m]
_FASTEST = 50.0  # [m/s]


def iso_14179_1(
    pitch_line_velocity: ArrayLike, load_intensity: ArrayLike, kinematic_viscosity: ArrayLike
) -> Array:
    """Mean friction coefficient of a mesh by part 1, the American method.

    ``f_m = nu^-0.223 K^-0.40 / (3.239 V^0.70)`` with nu in mm^2/s, K in N/mm^2 and V in m/s. It
    falls with the load.

    Parameters
    ----------
    pitch_line_velocity : float or array [m/s]
        Speed of the pitch circles.
    load_intensity : float or array [Pa]
        K-factor: pitch-line load over face width and pitch diameter of the smaller gear, times
        (u + 1)/u.
    kinematic_viscosity : float or array [m^2/s]
        Viscosity over density at the temperature of the sump.

    Returns
    -------
    float or array
        Friction coefficient, of the common shape of the arguments.

    Raises
    ------
    InputError
        If a value is not finite or not positive.

    Warns
    -----
    ModelWarning
        Code ``friction-range`` outside 2 to 25 m/s and K of 1.4 to 14 N/mm^2.

    No second source of the constants was found. Source: ISO/TR 14179-1:2001, mesh coefficient of
    friction.

    Examples
    --------
    >>> round(float(iso_14179_1(5.0, 5e6, 100e-6)), 4)
    0.0188
    """
    require_positive("pitch_line_velocity", pitch_line_velocity, "m/s")
    require_positive("load_intensity", load_intensity, "Pa", remedy="1 N/mm^2 is 1e6 Pa")
    require_positive("kinematic_viscosity", kinematic_viscosity, "m^2/s")
    speed = np.asarray(pitch_line_velocity, dtype=float)
    intensity = 1e-6 * np.asarray(load_intensity, dtype=float)
    viscosity = 1e6 * np.asarray(kinematic_viscosity, dtype=float)
    warn_outside(
        "iso-14179",
        (
            Range("pitch_line_velocity", speed, 2.0, 25.0, "m/s"),
            Range("load_intensity", intensity, 1.4, 14.0, "N/mm^2"),
        ),
        "Part 1 requires experience there: compare with another friction law.",
    )
    return np.asarray(viscosity**-0.223 * intensity**-0.4 / (3.239 * speed**0.7))[()]


def iso_14179_2(
    load_per_width: ArrayLike,
    sum_velocity: ArrayLike,
    equivalent_radius: ArrayLike,
    dynamic_viscosity: ArrayLike,
    roughness_ra: ArrayLike,
    pitch_line_velocity: ArrayLike,
    lubricant_factor: ArrayLike = 1.0,
) -> Array:
    """Mean friction coefficient of a mesh by part 2, the German method.

    The formula of Schlenk, with a load of at least 150 N/mm and the speed held above 50 m/s at the
    pitch circle.

    Parameters
    ----------
    load_per_width, sum_velocity, equivalent_radius, dynamic_viscosity, roughness_ra
        State at the pitch point, each in the same unit as for :func:`schlenk`.
    pitch_line_velocity : float or array [m/s]
        Speed of the pitch circles.
    lubricant_factor : float or array
        X_L: mineral oil 1, PAO and esters 0.8, polyglycols about 0.7.

    Returns
    -------
    float or array
        Friction coefficient, of the common shape of the arguments.

    Raises
    ------
    InputError
        If a value is not finite or not positive.

    Warns
    -----
    ModelWarning
        Code ``friction-range`` where Ra exceeds 4 um or the coefficient 0.2.

    The least load and the greatest speed stand without a second source. Source: ISO/TR
    14179-2:2001, mean coefficient of gear friction.

    Examples
    --------
    >>> print(round(float(iso_14179_2(133022.0, 2.6333, 8.382e-3, 0.082, 0.53e-6, 3.45)), 4))
    0.0482
    """
    require_positive("pitch_line_velocity", pitch_line_velocity, "m/s")
    require_positive("load_per_width", load_per_width, "N/m", remedy="1 N/mm is 1000 N/m")
    load = np.maximum(np.asarray(load_per_width, dtype=float), _LEAST_LOAD)
    speed_limit = np.minimum(1.0, _FASTEST / np.asarray(pitch_line_velocity, dtype=float))
    speed = np.asarray(sum_velocity, dtype=float) * speed_limit
    state = (load, speed, equivalent_radius, dynamic_viscosity, roughness_ra)
    return mean_friction("iso-14179", state, lubricant_factor, lambda *_: 0.048, np.inf)


_PARTS = {
    "1": "ISO/TR 14179-1: from pitch-line speed, load intensity and viscosity; falls with the load",
    "2": "ISO/TR 14179-2: the formula of Schlenk with its loads and speeds held",
}


@mean_law(
    "iso-14179",
    source="ISO/TR 14179-1 and -2 (2001)",
    meaning="mean friction coefficient of a mesh for the heat balance of gear units",
    law_options={"part": choice("2", _PARTS, meaning="part of ISO/TR 14179")},
    papers=("iso-14179",),
)
def _law(
    contact: TribologicalContact, point: PitchPoint, state: dict[str, float], part: str
) -> Array:
    speed = point.pitch_line_velocity
    if part == "1":
        return iso_14179_1(speed, point.load_intensity, contact.kinematic_viscosity)
    return iso_14179_2(**state, pitch_line_velocity=speed)
