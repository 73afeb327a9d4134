"""Density of an oil: over temperature as in ISO/TR 15144-1, under pressure by Dowson, Higginson."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.errors import require_between, require_positive
from tribodyn.types import Array

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
