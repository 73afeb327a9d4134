"""Viscosity under pressure: Barus and Roelands; its coefficient from the viscosity, AGMA 925."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.errors import Argument, InputError, require_between, require_positive
from tribodyn.model import Registry
from tribodyn.types import Array

#: exp(700) is the last decade that a double holds; no liquid comes near it.
_LARGEST_EXPONENT = 700.0


def exponential_growth(exponent: ArrayLike, pressure: ArrayLike, law: str) -> Array:
    """Factor exp(exponent) by which pressure raises the viscosity."""
    exponents = np.asarray(exponent, dtype=float)
    if np.any(exponents > _LARGEST_EXPONENT):
        what = f"pressure = {np.max(pressure):.6g} Pa"
        why = f"the {law} law raises the viscosity there by more than exp(700), beyond any liquid"
        remedy = "Check the units of pressure (Pa) and coefficient (1/Pa), or use the Roelands law"
        raise InputError(what, Argument("pressure"), why, remedy)
    return np.asarray(np.exp(exponents))[()]


def barus_viscosity(
    pressure: ArrayLike, dynamic_viscosity: float, pressure_viscosity_coefficient: float
) -> Array:
    """Viscosity under pressure by Barus: ``eta0 exp(alpha p)``.

    Parameters
    ----------
    pressure : float or array [Pa]
        Pressure above ambient, not negative.
    dynamic_viscosity, pressure_viscosity_coefficient : float [Pa*s], [1/Pa]
        Viscosity at ambient pressure, and slope of its logarithm over the pressure.

    Returns
    -------
    float or array [Pa*s]
        Same shape as ``pressure``.

    Raises
    ------
    InputError
        If a value is out of range or the viscosity overflows.

    Valid to about 0.1 GPa; above, it exceeds measured viscosities by orders of magnitude.
    Source: Barus (1893).

    Examples
    --------
    >>> round(float(barus_viscosity(100e6, 0.082, 2.19e-8)), 6)
    0.732687
    """
    require_between("pressure", pressure, 0.0, np.inf, "Pa")
    require_positive("dynamic_viscosity", dynamic_viscosity, "Pa*s")
    require_between(
        "pressure_viscosity_coefficient", pressure_viscosity_coefficient, 0.0, 1e-6, "1/Pa"
    )
    exponent = pressure_viscosity_coefficient * np.asarray(pressure, dtype=float)
    return dynamic_viscosity * exponential_growth(exponent, pressure, "Barus")


#: Reference pressure of the law [Pa].
ROELANDS_PRESSURE = 1.0 / 5.1e-9

#: ln of the viscosity [Pa*s] in which all isotherms of the law meet, with the sign changed.
_LOG_POLE = 9.67


def _log_viscosity_ratio(dynamic_viscosity: float) -> float:
    """Return ln(eta0) + 9.67, the height above the pole of the law."""
    require_positive("dynamic_viscosity", dynamic_viscosity, "Pa*s")
    ratio = math.log(dynamic_viscosity) + _LOG_POLE
    if ratio <= 0.0:
        what = f"dynamic_viscosity = {dynamic_viscosity:.6g} Pa*s"
        why = f"the Roelands law needs more than exp(-{_LOG_POLE}) = 6.32e-5 Pa*s"
        remedy = "Check the unit: 82 mPa*s is 0.082 Pa*s"
        raise InputError(what, Argument("dynamic_viscosity"), why, remedy)
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


#: Base oil -> (factor, exponent) of ``alpha = factor * eta^exponent`` [mm^2/N, mPa*s].
BASE_OILS: Registry[tuple[float, float]] = Registry("base oil")
BASE_OILS.register("mineral")((0.010471, 0.1348))
BASE_OILS.register("polyalphaolefin")((0.010326, 0.0507))
BASE_OILS.register("polyalkylene glycol")((0.0047, 0.1572))


def agma_925_coefficient(dynamic_viscosity: float, base_oil: str = "mineral") -> float:
    """Pressure-viscosity coefficient of an oil whose base oil is all that is known.

    Parameters
    ----------
    dynamic_viscosity : float [Pa*s]
        Viscosity at ambient pressure and working temperature.
    base_oil : {"mineral", "polyalphaolefin", "polyalkylene glycol"}
        Kind of the base oil.

    Returns
    -------
    float [1/Pa]
        ``alpha = k eta^s`` with alpha in mm^2/N and eta in mPa*s.

    Raises
    ------
    InputError
        If the viscosity is not positive or the base oil is unknown.

    An estimate for when nothing is measured: it lies 13 % below the coefficient printed for the
    80W oil of the library. Source: AGMA 925-A03, coefficients of the three base oils;
    ISO/TR 15144-1 has the same law with the viscosity in Pa*s.

    Examples
    --------
    >>> round(agma_925_coefficient(0.082) * 1e9, 2)
    18.97
    """
    require_positive("dynamic_viscosity", dynamic_viscosity, "Pa*s")
    factor, exponent = BASE_OILS[base_oil]
    return float(factor * (dynamic_viscosity * 1e3) ** exponent) * 1e-6
