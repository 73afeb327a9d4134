"""Viscosity and density of an oil under pressure, and its density over temperature."""

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


#: Temperature [K] at which data sheets state the density (15 degC).
REFERENCE_TEMPERATURE = 288.15

#: Fall of the density per kelvin [kg/(m^3 K)].
DENSITY_FALL = 0.7


def density_at_temperature(temperature: float, density_at_15_degc: float) -> float:
    """Density of an oil at ambient pressure: ``rho = rho_15 - 0.7 (T - T_15)``.

    Parameters
    ----------
    temperature : float [K]
        Wanted temperature.
    density_at_15_degc : float [kg/m^3]
        Density at 15 degC.

    Returns
    -------
    float [kg/m^3]

    Raises
    ------
    InputError
        If a value is outside the range of lubricating oils.

    Valid for liquid oils of 700 to 1300 kg/m^3 between -50 and 250 degC.
    Source: ISO/TR 15144-1, calculation of the density.

    Examples
    --------
    >>> round(density_at_temperature(313.15, 892.2), 1)
    874.7
    """
    require_between("temperature", temperature, 223.15, 523.15, "K", remedy="0 degC is 273.15 K")
    require_between("density_at_15_degc", density_at_15_degc, 700.0, 1300.0, "kg/m^3")
    return density_at_15_degc - DENSITY_FALL * (temperature - REFERENCE_TEMPERATURE)


_RISE = 0.6e-9  # [1/Pa], compressibility at ambient pressure
_LIMIT = 1.7e-9  # [1/Pa], bounds the rise to 0.6/1.7 = 35 %


def dowson_higginson_density(pressure: ArrayLike, density: float) -> Array:
    """Density under pressure: ``rho0 [1 + 0.6e-9 p / (1 + 1.7e-9 p)]`` with p in Pa.

    Parameters
    ----------
    pressure : float or array [Pa]
        Pressure above ambient, not negative.
    density : float [kg/m^3]
        Density at ambient pressure.

    Returns
    -------
    float or array [kg/m^3]
        Same shape as ``pressure``.

    Raises
    ------
    InputError
        If the pressure is negative or the density is not positive.

    A fit to mineral oils up to about 0.4 GPa, used far above in the literature.
    Source: Dowson and Higginson (1966).

    Examples
    --------
    >>> round(float(dowson_higginson_density(1e9, 880.0)), 3)
    1075.556
    """
    require_between("pressure", pressure, 0.0, np.inf, "Pa")
    require_positive("density", density, "kg/m^3")
    pressures = np.asarray(pressure, dtype=float)
    return np.asarray(density * (1.0 + _RISE * pressures / (1.0 + _LIMIT * pressures)))[()]
