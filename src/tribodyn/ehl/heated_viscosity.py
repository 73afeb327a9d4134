"""Viscosity of a film that is warmer than its inlet, under pressure."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from tribodyn.errors import InputError, Problem
from tribodyn.lubricant import Lubricant
from tribodyn.types import Array

#: ln of the viscosity [Pa*s] in which all curves of the Roelands law meet, with the sign changed.
_LOG_POLE = 9.67
_USUAL = {
    "temperature": "for example 313.15 K",
    "temperature_viscosity_coefficient": "gear oils lie between 0.02 and 0.07 1/K",
    "thermal_conductivity": "mineral oil has about 0.13 W/(m*K)",
}
#: Temperature [K] at which the Roelands law has its pole.
_POLE_TEMPERATURE = 138.0


class ThermalOil(NamedTuple):
    """What the temperature of a film depends on."""

    temperature: float  #: temperature of the oil at the inlet [K]
    temperature_viscosity_coefficient: float  #: [1/K]
    thermal_conductivity: float  #: thermal conductivity [W/m/K]


def heated_log_viscosity(
    log_viscosity: Array,
    temperature_rise: Array,
    lubricant: Lubricant,
    viscosity_law: str = "roelands",
) -> tuple[Array, Array]:
    """Logarithm of the viscosity of a film that is warmer than its inlet.

    Roelands: ``ln eta + 9.67`` falls by the factor ``[(T - 138)/(T_0 - 138)]^(-s)`` at every
    pressure, with ``s = beta (T_0 - 138)/(ln eta_0 + 9.67)``: a thick oil thins faster. Barus and
    isoviscous oils: ``eta exp(-beta (T - T_0))``.

    Parameters
    ----------
    log_viscosity : (contacts, n) array
        Logarithm of the viscosity in Pa*s under pressure at the inlet temperature.
    temperature_rise : (contacts,) array [K]
        Film temperature above that of the inlet, not negative.
    lubricant : Lubricant
        Oil at the inlet temperature, with its temperature and its fall of viscosity.
    viscosity_law : str
        ``"roelands"``, ``"barus"`` or ``"isoviscous"``.

    Returns
    -------
    (log_viscosity, slope) : (contacts, n) arrays
        Logarithm of the viscosity in Pa*s, and its slope over the temperature [1/K].

    Raises
    ------
    InputError
        If the oil does not know its temperature or its fall of viscosity.

    Fits measured viscosities of mineral oils to about 1 GPa. Source: Roelands (1966), in the form
    of Houpert, ASME J. Tribol. 107 (1985).

    Examples
    --------
    >>> oil = Lubricant(
    ...     0.082, 880.0, 2.19e-8, temperature=313.15,
    ...     temperature_viscosity_coefficient=0.05, thermal_conductivity=0.13,
    ... )
    >>> cold = np.log([[0.082, 282.07]])  # at 0 and 0.5 GPa
    >>> warm, slope = heated_log_viscosity(cold, np.array([10.0]), oil)
    >>> print(np.round(np.exp(warm - cold), 3), np.round(slope, 4))
    [[0.625 0.366]] [[-0.0442 -0.0944]]
    """
    temperature, beta, _ = thermal_oil(lubricant)
    rise = np.asarray(temperature_rise, dtype=float)[:, None]
    if viscosity_law != "roelands":
        return log_viscosity - beta * rise, np.full(log_viscosity.shape, -beta)
    above = temperature - _POLE_TEMPERATURE
    exponent = beta * above / (math.log(lubricant.dynamic_viscosity) + _LOG_POLE)
    height = (log_viscosity + _LOG_POLE) * (1.0 + rise / above) ** -exponent
    return height - _LOG_POLE, -exponent * height / (above + rise)


def thermal_oil(lubricant: Lubricant) -> ThermalOil:
    """Read the thermal properties of an oil that must have them all."""
    values = [getattr(lubricant, name) for name in ThermalOil._fields]
    missing = [
        name for name, value in zip(ThermalOil._fields, values, strict=True) if value is None
    ]
    if missing:
        raise InputError(
            [
                Problem(
                    what=f"{name} of the oil is not known",
                    where=f"argument lubricant.{name}",
                    why="the temperature of the film depends on it",
                    remedy=f"Give it ({_USUAL[name]}), take an oil of the library, or leave out "
                    "inlet_heating and flash_temperature",
                )
                for name in missing
            ]
        )
    return ThermalOil(*(float(value) for value in values))
