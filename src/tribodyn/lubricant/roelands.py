"""Viscosity under pressure: the law of Roelands."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.errors import Argument, InputError, require_between, require_positive
from tribodyn.lubricant.barus import exponential_growth
from tribodyn.types import Array

#: Reference pressure of the law [Pa].
ROELANDS_PRESSURE = 1.0 / 5.1e-9

#: ln of the viscosity [Pa*s] in which all isotherms of the law meet, with the sign changed.
_LOG_POLE = 9.67


def _log_viscosity_ratio(dynamic_viscosity: float) -> float:
    """Return ln(eta0) + 9.67, the height above the pole of the law."""
    require_positive("dynamic_viscosity", dynamic_viscosity, "Pa*s")
    ratio = math.log(dynamic_viscosity) + _LOG_POLE
    if ratio <= 0.0:
        raise InputError(
            f"dynamic_viscosity = {dynamic_viscosity:.6g} Pa*s",
            where=Argument("dynamic_viscosity"),
            why=f"the Roelands law needs more than exp(-{_LOG_POLE}) = 6.32e-5 Pa*s",
            remedy="Check the unit: 82 mPa*s is 0.082 Pa*s",
        )
    return ratio


def roelands_index(dynamic_viscosity: float, pressure_viscosity_coefficient: float) -> float:
    """Pressure-viscosity index z of the Roelands law from the slope at ambient pressure.

    Parameters
    ----------
    dynamic_viscosity : float [Pa*s]
        Viscosity at ambient pressure.
    pressure_viscosity_coefficient : float [1/Pa]
        Slope of ln(viscosity) over pressure at ambient pressure.

    Returns
    -------
    float
        ``z = alpha p0 / (ln(eta0) + 9.67)`` with ``p0 = 1/5.1e-9 Pa``.

    Raises
    ------
    InputError
        If a value is out of range.

    Valid for liquids with a viscosity above 6.3e-5 Pa*s; mineral oils have z of 0.5 to 0.7.
    Source: Roelands (1966).

    Examples
    --------
    >>> round(roelands_index(0.082, 2.19e-8), 3)
    0.599
    """
    require_between(
        "pressure_viscosity_coefficient", pressure_viscosity_coefficient, 0.0, 1e-6, "1/Pa"
    )
    ratio = _log_viscosity_ratio(dynamic_viscosity)
    return pressure_viscosity_coefficient * ROELANDS_PRESSURE / ratio


def roelands_viscosity(
    pressure: ArrayLike, dynamic_viscosity: float, pressure_viscosity_coefficient: float
) -> Array:
    """Viscosity under pressure by Roelands.

    ``eta = eta0 exp{(ln(eta0) + 9.67) [(1 + p/p0)^z - 1]}`` with ``p0 = 1/5.1e-9 Pa``.

    Parameters
    ----------
    pressure : float or array [Pa]
        Pressure above ambient, not negative.
    dynamic_viscosity, pressure_viscosity_coefficient : float [Pa*s], [1/Pa]
        As for :func:`roelands_index`.

    Returns
    -------
    float or array [Pa*s]
        Same shape as ``pressure``.

    Raises
    ------
    InputError
        If a value is out of range or the viscosity overflows.

    Measured up to about 1 GPa; an extrapolation above. Source: Roelands (1966).

    Examples
    --------
    >>> round(float(roelands_viscosity(0.5e9, 0.082, 2.19e-8)), 2)
    282.07
    """
    require_between("pressure", pressure, 0.0, np.inf, "Pa")
    index = roelands_index(dynamic_viscosity, pressure_viscosity_coefficient)
    relative = 1.0 + np.asarray(pressure, dtype=float) / ROELANDS_PRESSURE
    exponent = _log_viscosity_ratio(dynamic_viscosity) * (relative**index - 1.0)
    return dynamic_viscosity * exponential_growth(exponent, pressure, "Roelands")
