"""Thinner film by the heat of the sheared inlet: the factor of Zhu and Cheng."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.checks import positive
from tribodyn.errors import InputError, require_between, warn
from tribodyn.types import Array

#: Thermal loading beyond which the fit was not made: bearings reach several tens.
_GREATEST_LOADING = 50.0


def inlet_heating_factor(
    entrainment_speed: ArrayLike,
    slide_to_roll_ratio: ArrayLike,
    hertz_pressure: ArrayLike,
    dynamic_viscosity: ArrayLike,
    temperature_viscosity_coefficient: ArrayLike,
    thermal_conductivity: ArrayLike,
    effective_modulus: ArrayLike,
) -> Array:
    """Film of a contact whose inlet heats up, over that of the same contact at one temperature.

    ``(1 - 13.2 (p_h/E') L^0.42) / [1 + 0.213 (1 + 2.23 |SR|^0.83) L^0.64]`` with the thermal
    loading ``L = eta_0 beta u_e^2/k``.

    Parameters
    ----------
    entrainment_speed : float or array [m/s]
        HALF the sum of the surface speeds.
    slide_to_roll_ratio : float or array
        Sliding speed over entrainment speed; its sign does not matter.
    hertz_pressure : float or array [Pa]
        Maximum Hertzian pressure.
    dynamic_viscosity : float or array [Pa*s]
        Viscosity at ambient pressure and the temperature of the oil supplied.
    temperature_viscosity_coefficient : float or array [1/K]
        Fall of ln(viscosity) per kelvin.
    thermal_conductivity : float or array [W/m/K]
        Thermal conductivity of the oil.
    effective_modulus : float or array [Pa]
        ``2/E' = (1-nu1^2)/E1 + (1-nu2^2)/E2``.

    Returns
    -------
    float or array
        Between 0 and 1, of the common shape of the arguments.

    Raises
    ------
    InputError
        If a value is not finite or not positive (the ratio may be zero), or so far out of range
        that the formula gives no film.

    Warns
    -----
    ModelWarning
        Code ``film-range`` above a thermal loading of 50.

    Without sliding it agrees to 7 % with Wilson and Sheu (1983), ``1/(1 + 0.241 L^0.64)``, up to
    L = 10. With sliding, inlets solved with conduction alone scatter by 0.1 about it; the factor
    of Wilson and Sheu, made for unlimited pressure, is far lower.
    Source: Zhu and Cheng, as printed by Zhou and Hoeprich, ASME J. Tribol. 113 (1991), equation
    21, and Gupta, Cheng, Zhu, Forster and Schrand (1992).

    Examples
    --------
    >>> factor = inlet_heating_factor(3.0722, 0.5, 0.8043e9, 0.082, 0.0533, 0.13, 2.2e11)
    >>> round(float(factor), 3)
    0.789
    """
    require_between("slide_to_roll_ratio", slide_to_roll_ratio, -np.inf, np.inf)
    ratio = np.asarray(slide_to_roll_ratio, dtype=float)
    speed, pressure, viscosity, coefficient, conductivity, modulus = positive(
        entrainment_speed=entrainment_speed,
        hertz_pressure=hertz_pressure,
        dynamic_viscosity=dynamic_viscosity,
        temperature_viscosity_coefficient=temperature_viscosity_coefficient,
        thermal_conductivity=thermal_conductivity,
        effective_modulus=effective_modulus,
    )
    loading = viscosity * coefficient * speed**2 / conductivity
    numerator = 1.0 - 13.2 * pressure / modulus * loading**0.42
    denominator = 1.0 + 0.213 * (1.0 + 2.23 * np.abs(ratio) ** 0.83) * loading**0.64
    factor = np.asarray(numerator / denominator)[()]
    _check(factor, float(np.max(loading)))
    return factor


def _check(factor: Array, loading: float) -> None:
    """Refuse factors that are none, and say where the formula extrapolates."""
    if np.any(factor <= 0.0):
        raise InputError(
            f"thermal loading eta_0 beta u_e^2/k = {loading:.4g}",
            where="inlet_heating_factor",
            why="the formula of Zhu and Cheng gives no film at this loading and pressure; it "
            f"was made for loadings up to about {_GREATEST_LOADING:g}",
            remedy="Check viscosity, speed and conductivity, or leave out inlet_heating",
        )
    if loading > _GREATEST_LOADING:
        warn(
            "film-range",
            f"inlet heating: thermal loading eta_0 beta u_e^2/k up to {loading:.4g}, fitted to "
            f"about {_GREATEST_LOADING:g}. Take the film as a lower estimate.",
            stacklevel=3,
        )
