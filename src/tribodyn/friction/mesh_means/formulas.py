"""Mean friction of a gear mesh: Schlenk, Niemann and Winter, ISO/TS 6336-22, ISO/TR 14179."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.errors import require_one_of, require_positive
from tribodyn.friction.base import Range, TribologicalContact, warn_outside
from tribodyn.friction.mesh_means.mean_law import mean_friction, mean_law
from tribodyn.friction.mesh_means.pitch_point import PitchPoint
from tribodyn.model import choice, number
from tribodyn.types import Array


def schlenk(
    load_per_width: ArrayLike,
    sum_velocity: ArrayLike,
    equivalent_radius: ArrayLike,
    dynamic_viscosity: ArrayLike,
    roughness_ra: ArrayLike,
    lubricant_factor: ArrayLike = 1.0,
) -> Array:
    """Mean friction coefficient of a mesh by the formula of Schlenk.

    ``mu = 0.048 (F_bt/b / (v_sum rho))^0.2 eta^-0.05 Ra^0.25 X_L`` at the pitch point; N/mm, m/s,
    mm, mPa s and um.

    Parameters
    ----------
    load_per_width : float or array [N/m]
        Tangential load at the base circle per face width.
    sum_velocity : float or array [m/s]
        SUM of the surface speeds at the pitch point.
    equivalent_radius : float or array [m]
        Reduced radius of curvature at the pitch point.
    dynamic_viscosity : float or array [Pa*s]
        Viscosity at ambient pressure and oil temperature.
    roughness_ra : float or array [m]
        Mean of the arithmetical roughnesses Ra of both flanks.
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
        Code ``friction-range`` where the speeds add up to more than 35 m/s, which is some 50 m/s
        at the pitch circle, Ra exceeds 4 um or the coefficient 0.2.

    Fitted to FZG tests of steel gears; open programs for gearbox losses have the same constants.
    Source: Schlenk, Diss. TU Munich (1994); ISO/TR 14179-2.

    Examples
    --------
    >>> round(float(schlenk(133022.0, 2.633310, 8.382091e-3, 0.082, 0.53e-6)), 5)
    0.04706
    """
    state = (load_per_width, sum_velocity, equivalent_radius, dynamic_viscosity, roughness_ra)
    return mean_friction("schlenk", state, lubricant_factor, lambda *_: 0.048)


mean_law(
    "schlenk",
    source="Schlenk, Diss. TU Munich (1994)",
    meaning="mean friction coefficient of a mesh, fitted to FZG tests of loss",
    papers=("schlenk",),
)(lambda contact, point, state: schlenk(**state))


#: Published forms and what they are.
FORMS = {
    "winter-michaelis": "0.045 (F_bt/b / (v_sum rho))^0.2 eta^-0.05 X_R X_L with "
    "X_R = 3.8 (Ra/d_1)^0.25",
    "iso-tc60": "the older 0.12 (F_bt/b Ra / (eta v_sum rho))^0.25, without a factor of the oil",
}


def niemann(
    load_per_width: ArrayLike,
    sum_velocity: ArrayLike,
    equivalent_radius: ArrayLike,
    dynamic_viscosity: ArrayLike,
    roughness_ra: ArrayLike,
    pinion_diameter: ArrayLike,
    lubricant_factor: ArrayLike = 1.0,
    *,
    form: str = "winter-michaelis",
) -> Array:
    """Mean friction coefficient of a mesh by Niemann and Winter.

    ``mu = 0.045 (F_bt/b / (v_sum rho))^0.2 eta^-0.05 X_R X_L`` with ``X_R = 3.8 (Ra/d_1)^0.25``, or
    the older ``mu = 0.12 (F_bt/b Ra / (eta v_sum rho))^0.25`` of ISO/TC 60; N/mm, m/s, mm, mPa s
    and um.

    Parameters
    ----------
    load_per_width, sum_velocity, equivalent_radius, dynamic_viscosity, roughness_ra
        State at the pitch point, each in the same unit as for :func:`schlenk`.
    pinion_diameter : float or array [m]
        Pitch diameter of the pinion.
    lubricant_factor : float or array
        X_L: mineral oil 1, PAO and esters 0.8, polyglycols about 0.7.
    form : {"winter-michaelis", "iso-tc60"}
        Published form.

    Returns
    -------
    float or array
        Friction coefficient, of the common shape of the arguments.

    Raises
    ------
    InputError
        If a value is not finite or not positive, or the form is unknown.

    Warns
    -----
    ModelWarning
        Code ``friction-range`` where the speeds add up to more than 35 m/s, Ra exceeds 4 um or the
        coefficient 0.2.

    No second source of the constants was found. Source: Niemann and Winter, Maschinenelemente II;
    Winter and Michaelis (1985); the older form as listed by Xu et al. (2007).

    Examples
    --------
    >>> print(round(float(niemann(133022.0, 2.6333, 8.382e-3, 0.082, 0.53e-6, 73.2e-3)), 4))
    0.0573
    """
    require_one_of("form", form, FORMS)
    require_positive("pinion_diameter", pinion_diameter, "m")
    state = (load_per_width, sum_velocity, equivalent_radius, dynamic_viscosity, roughness_ra)
    size = 3.8 * (1e3 * np.asarray(pinion_diameter, dtype=float)) ** -0.25

    def old(load: Array, speed: Array, radius: Array, viscosity: Array) -> Array:
        """Powers 0.25 of all instead of the family's 0.2 and -0.05, and no factor of the oil."""
        rest = (load / (speed * radius)) ** 0.05 * viscosity**-0.2
        return np.asarray(0.12 * rest / np.asarray(lubricant_factor, dtype=float))

    factor = old if form == "iso-tc60" else lambda *_: 0.045 * size
    return mean_friction("niemann", state, lubricant_factor, factor)


@mean_law(
    "niemann",
    source="Niemann and Winter, Maschinenelemente II (2003)",
    meaning="mean friction coefficient of a mesh, as the textbook on machine elements has it",
    own={"form": choice("winter-michaelis", FORMS, meaning="published form")},
    papers=("niemann-winter",),
)
def _niemann(contact: object, point: PitchPoint, state: dict[str, float], form: str) -> Array:
    return niemann(**state, pinion_diameter=point.pinion_pitch_diameter, form=form)


def iso_6336_22(
    load_per_width: ArrayLike,
    sum_velocity: ArrayLike,
    equivalent_radius: ArrayLike,
    dynamic_viscosity: ArrayLike,
    roughness_ra: ArrayLike,
    lubricant_factor: ArrayLike = 1.0,
) -> Array:
    """Mean friction coefficient of a mesh by ISO/TS 6336-22.

    ``mu = 0.045 (K F_bt/b / (v_sum rho))^0.2 eta^-0.05 X_R X_L`` at the pitch point with
    ``X_R = 2.2 (Ra/rho)^0.25``; N/mm, m/s, mm, mPa s and um.

    Parameters
    ----------
    load_per_width, sum_velocity, equivalent_radius, dynamic_viscosity, roughness_ra
        State at the pitch point, each in the same unit as for :func:`schlenk`; the load times
        the load factors K of ISO 6336-1.
    lubricant_factor : float or array
        X_L: mineral oil 1, PAO 0.8, polyglycols 0.6 (water-soluble) or 0.7, phosphate ester 1.3,
        traction fluid 1.5.

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
        Code ``friction-range`` where the speeds add up to more than 35 m/s, Ra exceeds 4 um or the
        coefficient 0.2.

    No second source of the constants was found. Source: ISO/TS 6336-22:2018 (before: ISO/TR
    15144-1), mean coefficient of friction.

    Examples
    --------
    >>> print(round(float(iso_6336_22(133022.0, 2.6333, 8.382e-3, 0.082, 0.53e-6)), 4))
    0.057
    """
    state = (load_per_width, sum_velocity, equivalent_radius, dynamic_viscosity, roughness_ra)
    return mean_friction(
        "iso-6336-22", state, lubricant_factor, lambda _, v, rho, eta: 0.045 * 2.2 * rho**-0.25
    )


_LOAD_FACTOR = number(
    1.0,
    0.5,
    10.0,
    "load factors of ISO 6336-1 lie between 1 and 4",
    meaning="product of the load factors of ISO 6336-1 on the load",
    symbol="K",
    example="1.3",
)


@mean_law(
    "iso-6336-22",
    source="ISO/TS 6336-22:2018",
    meaning="mean friction coefficient of a mesh, as the micropitting standard has it",
    own={"load_factor": _LOAD_FACTOR},
    papers=("iso-6336-22",),
)
def _iso_6336_22(
    contact: object, point: PitchPoint, state: dict[str, float], load_factor: float
) -> Array:
    return iso_6336_22(**{**state, "load_per_width": load_factor * point.load_per_width})


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
        K-factor: pitch-line load over face width and pitch diameter of the pinion, times (u + 1)/u.
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
        "Part 1 asks for experience there: compare with another friction law.",
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
    held = np.minimum(1.0, _FASTEST / np.asarray(pitch_line_velocity, dtype=float))
    speed = np.asarray(sum_velocity, dtype=float) * held
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
    own={"part": choice("2", _PARTS, meaning="part of ISO/TR 14179")},
    papers=("iso-14179",),
)
def _iso_14179(
    contact: TribologicalContact, point: PitchPoint, state: dict[str, float], part: str
) -> Array:
    speed = point.pitch_line_velocity
    if part == "1":
        return iso_14179_1(speed, point.load_intensity, contact.kinematic_viscosity)
    return iso_14179_2(**state, pitch_line_velocity=speed)
