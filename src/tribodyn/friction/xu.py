"""Friction of the EHL contact: the regression of Xu (2007)."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.errors import InputError, require_between
from tribodyn.friction.base import DRY_STEEL, LAWS, Range, of_columns, warn_outside
from tribodyn.nomenclature import positive
from tribodyn.types import Array

#: Constants b1 to b9 of the regression.
CONSTANTS = (
    -8.916465,
    1.03303,
    1.036077,
    -0.354068,
    2.812084,
    -0.100601,
    0.752755,
    -0.390958,
    0.620305,
)

_SOURCE = "Xu, Kahraman, Anderson and Maddock, ASME J. Mech. Des. 129 (2007)"


def xu_2007(
    slide_to_roll_ratio: ArrayLike,
    hertz_pressure: ArrayLike,
    dynamic_viscosity: ArrayLike,
    roughness_rms: ArrayLike,
    entrainment_speed: ArrayLike,
    equivalent_radius: ArrayLike,
) -> Array:
    """Friction coefficient by the regression of Xu on EHL simulations.

    ``mu = exp(f) P_h^b2 |SR|^b3 V_e^b6 nu^b7 R^b8`` with
    ``f = b1 + b4 |SR| P_h log10(nu) + b5 exp(-|SR| P_h log10(nu)) + b9 exp(S)``;
    P_h in GPa, nu in cP, S in um, V_e in m/s and R in m. Zero in pure rolling.

    Parameters
    ----------
    slide_to_roll_ratio : float or array
        Sliding speed over entrainment speed; its sign does not matter.
    hertz_pressure : float or array [Pa]
        Maximum Hertzian pressure.
    dynamic_viscosity : float or array [Pa*s]
        Viscosity at ambient pressure and inlet temperature.
    roughness_rms : float or array [m]
        Composite rms roughness.
    entrainment_speed : float or array [m/s]
        HALF the sum of the surface speeds.
    equivalent_radius : float or array [m]
        Reduced radius of curvature.

    Returns
    -------
    float or array
        Friction coefficient, of the common shape of the arguments.

    Raises
    ------
    InputError
        If a value is not finite or not positive (the roughness may be zero), or so far out of
        range that the coefficient exceeds 0.78, that of dry steel.

    Warns
    -----
    ModelWarning
        Code ``friction-range`` outside |SR| 0-1, P_h 0.5-2.5 GPa, V_e 1-20 m/s, R 5-80 mm,
        S 0-0.6 um, below 1 mPa*s, where its logarithm changes sign, and where the coefficient
        exceeds 0.2.

    Source: Xu, Kahraman, Anderson and Maddock (2007), with unrounded coefficients: the rounded
    ones in print are 2 to 3 % low.

    Examples
    --------
    >>> round(float(xu_2007(0.648486, 0.754725e9, 0.082, 0.53e-6, 1.407953, 8.577181e-3)), 6)
    0.067992
    """
    require_between("slide_to_roll_ratio", slide_to_roll_ratio, -np.inf, np.inf)
    require_between("roughness_rms", roughness_rms, 0.0, np.inf, "m")
    pressure, viscosity, speed, radius = positive(
        hertz_pressure=hertz_pressure,
        dynamic_viscosity=dynamic_viscosity,
        entrainment_speed=entrainment_speed,
        equivalent_radius=equivalent_radius,
    )
    ratio = np.abs(np.asarray(slide_to_roll_ratio, dtype=float))
    roughness = np.asarray(roughness_rms, dtype=float) * 1e6
    pressure, viscosity = pressure * 1e-9, viscosity * 1e3
    coefficient = _regression(ratio, pressure, viscosity, roughness, speed, radius)
    _require_plausible(coefficient, float(np.max(roughness)))
    warn_outside(
        "xu-2007",
        (
            Range("|slide_to_roll_ratio|", ratio, 0.0, 1.0),
            Range("hertz_pressure", pressure, 0.5, 2.5, "GPa"),
            Range("entrainment_speed", speed, 1.0, 20.0, "m/s"),
            Range("equivalent_radius", radius * 1e3, 5.0, 80.0, "mm"),
            Range("roughness", roughness, 0.0, 0.6, "um"),
            Range("dynamic_viscosity", viscosity, 1.0, np.inf, "mPa*s"),
            Range("friction coefficient", coefficient, 0.0, 0.2),
        ),
        "The regression extrapolates there: compare with another friction law.",
    )
    return coefficient


def _regression(
    ratio: Array, pressure: Array, viscosity: Array, roughness: Array, speed: Array, radius: Array
) -> Array:
    """Evaluate the regression in its own units; an overflow becomes infinity."""
    b1, b2, b3, b4, b5, b6, b7, b8, b9 = CONSTANTS
    with np.errstate(over="ignore", invalid="ignore"):
        shear = ratio * pressure * np.log10(viscosity)
        f = b1 + b4 * shear + b5 * np.exp(-shear) + b9 * np.exp(roughness)
        powers = pressure**b2 * ratio**b3 * speed**b6 * viscosity**b7 * radius**b8
        return np.asarray(np.exp(f) * powers)[()]


def _require_plausible(coefficient: Array, roughness: float) -> None:
    """Refuse what the double exponential of the roughness makes of a slip in a unit."""
    if np.all(coefficient <= DRY_STEEL):  # false for NaN as well
        return
    raise InputError(
        f"xu-2007 gives a friction coefficient of {np.max(coefficient):.3g} "
        f"with a roughness of up to {roughness:.4g} um; dry steel has {DRY_STEEL:g}",
        where="argument roughness",
        why="The regression grows with exp(exp(S)) and means nothing far beyond the 0.6 um "
        "and the other limits of its fit",
        remedy="Check the roughness and its unit, or choose another friction law, such as mixed",
    )


LAWS.define(
    "xu-2007",
    source=_SOURCE,
    together=True,
    meaning="regression of the friction coefficient to computed elastohydrodynamic contacts",
    papers=("xu",),
)(of_columns(xu_2007))
