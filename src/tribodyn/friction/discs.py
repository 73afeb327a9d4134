"""Friction of rolling and sliding discs by formula: Misharin, Drozdov, O'Donoghue and Cameron."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.errors import InputError, require_between, require_positive
from tribodyn.friction.base import LAWS, Range, of_columns, warn_outside
from tribodyn.types import Array

#: Range of the coefficients measured, in which the formula is held: it has a pole where sliding
#: stops, and no end at high speed.
LIMITS = (0.02, 0.08)


def misharin(
    sliding_speed: ArrayLike,
    entrainment_speed: ArrayLike,
    kinematic_viscosity: ArrayLike,
    hertz_pressure: ArrayLike | None = None,
) -> Array:
    """Friction coefficient by Misharin, held within 0.02 and 0.08.

    ``mu = 0.325 (v_s v_r nu)^-0.25`` with speeds in m/s and nu in mm^2/s; v_r is the SUM of the
    surface speeds.

    Parameters
    ----------
    sliding_speed : float or array [m/s]
        Difference of the surface speeds; its sign does not matter.
    entrainment_speed : float or array [m/s]
        HALF the sum of the surface speeds; the formula itself takes the sum.
    kinematic_viscosity : float or array [m^2/s]
        Viscosity over density at the inlet.
    hertz_pressure : float or array [Pa], optional
        Maximum Hertzian pressure, for the range only.

    Returns
    -------
    float or array
        Friction coefficient, of the common shape of speeds and viscosity.

    Raises
    ------
    InputError
        If a value is not finite, or not positive where it must be.

    Warns
    -----
    ModelWarning
        Code ``friction-range`` below 245 MPa (2500 kgf/cm^2), and where the formula leaves 0.02
        to 0.08, as it does where sliding stops.

    Fitted to disc tests. No second source of the constants was found. Source: Misharin, Proc. Int.
    Conf. Gearing, IMechE (1958), as listed by Xu et al. (2007).

    Examples
    --------
    >>> round(float(misharin(1.0, 2.0, 93e-6)), 4)
    0.074
    """
    require_between("sliding_speed", sliding_speed, -np.inf, np.inf, "m/s")
    require_positive("entrainment_speed", entrainment_speed, "m/s")
    require_positive("kinematic_viscosity", kinematic_viscosity, "m^2/s")
    sliding = np.abs(np.asarray(sliding_speed, dtype=float))
    rolling = 2.0 * np.asarray(entrainment_speed, dtype=float)
    viscosity = 1e6 * np.asarray(kinematic_viscosity, dtype=float)
    with np.errstate(divide="ignore"):
        formula = np.asarray(0.325 / np.sqrt(np.sqrt(sliding * rolling * viscosity)))
    ranges = [Range("friction coefficient", formula, *LIMITS)]
    if hertz_pressure is not None:
        require_positive("hertz_pressure", hertz_pressure, "Pa")
        ranges.append(
            Range("hertz_pressure", 1e-6 * np.asarray(hertz_pressure), 245, np.inf, "MPa")
        )
    warn_outside("misharin", ranges, "The coefficient is held within 0.02 and 0.08.")
    return np.asarray(np.clip(formula, *LIMITS))[()]


LAWS.define(
    "misharin",
    source="Misharin, Int. Conf. Gearing, IMechE (1958)",
    meaning="friction coefficient of discs: falls with speeds and viscosity, whatever the load",
    papers=("misharin", "xu"),
)(of_columns(misharin))


_KGF_PER_CM2 = 98066.5  # [Pa]


def drozdov(
    sliding_speed: ArrayLike,
    entrainment_speed: ArrayLike,
    kinematic_viscosity: ArrayLike,
    hertz_pressure: ArrayLike,
) -> Array:
    """Friction coefficient by Drozdov and Gavrikov.

    ``mu = 1 / (0.8 sqrt(nu) v_s + v_r phi + 13.4)`` with
    ``phi = 0.47 - 0.13e-4 p_max - 0.4e-3 nu``; speeds in m/s, nu in mm^2/s and p_max in kgf/cm^2;
    v_r is the SUM of the surface speeds.

    Parameters
    ----------
    sliding_speed : float or array [m/s]
        Difference of the surface speeds; its sign does not matter.
    entrainment_speed : float or array [m/s]
        HALF the sum of the surface speeds; the formula itself takes the sum.
    kinematic_viscosity : float or array [m^2/s]
        Viscosity over density at the inlet.
    hertz_pressure : float or array [Pa]
        Maximum Hertzian pressure.

    Returns
    -------
    float or array
        Friction coefficient, of the common shape of the arguments.

    Raises
    ------
    InputError
        If a value is not finite, or not positive where it must be, or so far out of range that the
        denominator is no more positive.

    Warns
    -----
    ModelWarning
        Code ``friction-range`` outside of |v_s| 0 to 15 m/s, v_r 3 to 20 m/s, nu 4 to 500 mm^2/s
        and p_max 4000 to 20000 kgf/cm^2.

    Fitted to disc tests. No second source of the constants was found. Source: Drozdov and Gavrikov,
    Wear 11 (1968), as listed by Xu et al. (2007).

    Examples
    --------
    >>> round(float(drozdov(1.0, 2.0, 93e-6, 0.8e9)), 4)
    0.0446
    """
    require_between("sliding_speed", sliding_speed, -np.inf, np.inf, "m/s")
    require_positive("entrainment_speed", entrainment_speed, "m/s")
    require_positive("kinematic_viscosity", kinematic_viscosity, "m^2/s")
    require_positive("hertz_pressure", hertz_pressure, "Pa")
    sliding = np.abs(np.asarray(sliding_speed, dtype=float))
    rolling = 2.0 * np.asarray(entrainment_speed, dtype=float)
    viscosity = 1e6 * np.asarray(kinematic_viscosity, dtype=float)
    pressure = np.asarray(hertz_pressure, dtype=float) / _KGF_PER_CM2
    phi = 0.47 - 0.13e-4 * pressure - 0.4e-3 * viscosity
    denominator = np.asarray(0.8 * np.sqrt(viscosity) * sliding + rolling * phi + 13.4)
    least = float(np.min(denominator))
    if least < 1.0:
        what = f"drozdov gives a friction coefficient of 1/{least:.3g}"
        why = "pressure and viscosity are far beyond the discs that it was fitted to"
        remedy = "Check the units (Pa, m^2/s), or choose another friction law"
        raise InputError(what, "drozdov", why, remedy)
    warn_outside(
        "drozdov",
        (
            Range("|sliding_speed|", sliding, 0.0, 15.0, "m/s"),
            Range("sum of the surface speeds", rolling, 3.0, 20.0, "m/s"),
            Range("kinematic_viscosity", viscosity, 4.0, 500.0, "mm^2/s"),
            Range("hertz_pressure", pressure, 4e3, 2e4, "kgf/cm^2"),
        ),
        "Compare with another friction law.",
    )
    return np.asarray(1.0 / denominator)[()]


LAWS.define(
    "drozdov",
    source="Drozdov and Gavrikov, Wear 11 (1968)",
    meaning="friction coefficient of discs: falls with sliding and viscosity, grows with pressure",
    papers=("drozdov-gavrikov", "xu"),
)(of_columns(drozdov))


_INCH = 0.0254  # [m]
#: Floor of the sliding speed [m/s]: the formula grows without bound as sliding stops, and 0.1 m/s
#: keeps it below what lubricated steel shows.
_LEAST_SLIDING = 0.1


def odonoghue_cameron(
    sliding_speed: ArrayLike,
    entrainment_speed: ArrayLike,
    dynamic_viscosity: ArrayLike,
    roughness: ArrayLike,
    equivalent_radius: ArrayLike,
) -> Array:
    """Friction coefficient by O'Donoghue and Cameron.

    ``mu = 0.6 (S + 22)/35 / (eta^(1/8) v_s^(1/3) v_r^(1/6) R^(1/2))`` in units of the inch: S in
    microinches, eta in cP, speeds in in/s, R in in; v_r is the SUM of the surface speeds.

    Parameters
    ----------
    sliding_speed : float or array [m/s]
        Difference of the surface speeds; its sign does not matter. Held at 0.1 m/s and above.
    entrainment_speed : float or array [m/s]
        HALF the sum of the surface speeds; the formula itself takes the sum.
    dynamic_viscosity : float or array [Pa*s]
        Viscosity at ambient pressure and inlet temperature.
    roughness : float or array [m]
        Composite roughness.
    equivalent_radius : float or array [m]
        Reduced radius of curvature.

    Returns
    -------
    float or array
        Friction coefficient, of the common shape of the arguments.

    Raises
    ------
    InputError
        If a value is not finite, or not positive where it must be.

    Warns
    -----
    ModelWarning
        Code ``friction-range`` where the coefficient exceeds 0.2.

    Fitted to disc tests. No second source of the constants was found. Source: O'Donoghue and
    Cameron, ASLE Trans. 9 (1966), as listed by Xu et al. (2007).

    Examples
    --------
    >>> round(float(odonoghue_cameron(0.913038, 1.407953, 0.082, 0.53e-6, 8.577181e-3)), 4)
    0.1008
    """
    require_between("sliding_speed", sliding_speed, -np.inf, np.inf, "m/s")
    require_positive("entrainment_speed", entrainment_speed, "m/s")
    require_positive("dynamic_viscosity", dynamic_viscosity, "Pa*s")
    require_between("roughness", roughness, 0.0, np.inf, "m")
    require_positive("equivalent_radius", equivalent_radius, "m")
    sliding = np.maximum(np.abs(np.asarray(sliding_speed, dtype=float)), _LEAST_SLIDING) / _INCH
    rolling = 2.0 * np.asarray(entrainment_speed, dtype=float) / _INCH
    viscosity = 1e3 * np.asarray(dynamic_viscosity, dtype=float)
    rough = (np.asarray(roughness, dtype=float) / (1e-6 * _INCH) + 22.0) / 35.0
    radius = np.asarray(equivalent_radius, dtype=float) / _INCH
    divisor = viscosity**0.125 * np.cbrt(sliding) * rolling ** (1.0 / 6.0) * np.sqrt(radius)
    coefficient = np.asarray(0.6 * rough / divisor)[()]
    warn_outside(
        "odonoghue-cameron",
        (Range("friction coefficient", coefficient, 0.0, 0.2),),
        "Compare with another friction law.",
    )
    return coefficient


LAWS.define(
    "odonoghue-cameron",
    source="O'Donoghue and Cameron, ASLE Trans. 9 (1966)",
    meaning="friction coefficient of discs: falls with speeds and radius, whatever the load",
    papers=("odonoghue-cameron", "xu"),
)(of_columns(odonoghue_cameron))
