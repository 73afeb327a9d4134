"""Density over temperature, as in ISO/TR 15144-1."""

from __future__ import annotations

from tribodyn.errors import require_between

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
