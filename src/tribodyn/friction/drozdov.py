"""Friction of rolling and sliding discs: the formula of Drozdov and Gavrikov."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.errors import InputError, require_between, require_positive
from tribodyn.friction.base import LAWS, TribologicalContact
from tribodyn.friction.validity import Range, warn_outside
from tribodyn.types import Array

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
        raise InputError(
            f"drozdov gives a friction coefficient of 1/{least:.3g}",
            where="drozdov",
            why="pressure and viscosity are far beyond the discs that it was fitted to",
            remedy="Check the units (Pa, m^2/s), or choose another friction law",
        )
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


@LAWS.define(
    "drozdov",
    source="Drozdov and Gavrikov, Wear 11 (1968)",
    meaning="friction coefficient of discs: falls with sliding and viscosity, grows with pressure",
    papers=("drozdov-gavrikov", "xu"),
)
def _law(contact: TribologicalContact) -> Array:
    return drozdov(
        contact.sliding_speed,
        contact.entrainment_speed,
        contact.kinematic_viscosity,
        contact.hertz_pressure,
    )
