"""Temperature of a sheared film: warm oil, flash temperature, balance of heat, heated inlet."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.errors import (
    ComputationError,
    InputError,
    Problem,
    require_between,
    require_positive,
    warn,
)
from tribodyn.lubricant import Lubricant
from tribodyn.model import Registry
from tribodyn.nomenclature import positive
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
    """Thermal properties and heat source of a film."""

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
    require_known(lubricant, ThermalOil._fields, "leave out inlet_heating and flash_temperature")
    return ThermalOil(*(float(getattr(lubricant, name)) for name in ThermalOil._fields))


def require_known(lubricant: Lubricant, names: Iterable[str], otherwise: str) -> None:
    """Raise :class:`InputError` unless thermal properties of an oil are known."""
    why = "the temperature of the film depends on it"
    problems = [
        Problem(f"{name} of the oil is not known", f"argument lubricant.{name}", why,
                f"Give it ({_USUAL[name]}), take an oil of the library, or {otherwise}")
        for name in names
        if getattr(lubricant, name) is None
    ]  # fmt: skip
    if problems:
        raise InputError(problems)


#: Root of conductivity, density and specific heat of gear steel [J/(m^2 K s^0.5)]: the mean
#: 13.6 N/(mm s^0.5 K) of ISO/TR 13989-1 for conductivities of 41 to 52 W/(m K).
STEEL_THERMAL_CONTACT_COEFFICIENT = 13.6e3

#: Temperature of a surface under heat spread like the Hertz pressure, over the heat divided by
#: the root of the contact width: highest, and mean over the contact width. Blok prints 1.11.
FLASH_FACTORS: Registry[float] = Registry("flash temperature")
FLASH_FACTORS.register("maximum")(1.1115484)
FLASH_FACTORS.register("mean")(0.7662384)


def blok_flash_temperature(
    heat_per_width: ArrayLike,
    half_width: ArrayLike,
    surface_speed_1: ArrayLike,
    surface_speed_2: ArrayLike,
    thermal_contact_coefficient_1: float = STEEL_THERMAL_CONTACT_COEFFICIENT,
    thermal_contact_coefficient_2: float = STEEL_THERMAL_CONTACT_COEFFICIENT,
    *,
    kind: str = "maximum",
) -> Array:
    """Rise of the surface temperature in a line contact above the temperature of the bodies.

    ``1.11 q / [(B_1 sqrt(u_1) + B_2 sqrt(u_2)) sqrt(2 b)]``: the heat parts in such a way that both
    surfaces are equally hot everywhere in the contact.

    Parameters
    ----------
    heat_per_width : float or array [W/m]
        Friction power per face width: coefficient of friction, load per width and sliding speed.
    half_width : float or array [m]
        Half width b of the Hertzian contact.
    surface_speed_1, surface_speed_2 : float or array [m/s]
        Speeds of the surfaces relative to the contact; their signs do not matter.
    thermal_contact_coefficient_1, thermal_contact_coefficient_2 : float [J/m^2/K/s^0.5]
        ``B = sqrt(k rho c)`` of each body; by default gear steel.
    kind : {"maximum", "mean"}
        Highest temperature, or its mean over the contact width.

    Returns
    -------
    float or array [K]
        Of the common shape of the arguments.

    Raises
    ------
    InputError
        If a value is not finite, the heat negative, a width or coefficient not positive, or both
        surfaces at rest.

    Valid for surfaces that move fast against the spread of heat, ``u b/(2 kappa) > 5``, with heat
    spread like the Hertz pressure. Source: Blok (1937, 1963); ISO/TR 13989-1.

    Examples
    --------
    >>> # 0.05 times 150 N/mm times 1 m/s, contact 0.2 mm wide
    >>> round(float(blok_flash_temperature(7500.0, 1e-4, 2.0, 1.0)), 1)
    18.0
    """
    require_between("heat_per_width", heat_per_width, 0.0, np.inf, "W/m")
    require_positive("half_width", half_width, "m")
    first, second = thermal_contact_coefficient_1, thermal_contact_coefficient_2
    require_positive("thermal_contact_coefficient_1", first, "J/(m^2 K s^0.5)")
    require_positive("thermal_contact_coefficient_2", second, "J/(m^2 K s^0.5)")
    require_between("surface_speed_1", surface_speed_1, -np.inf, np.inf, "m/s")
    require_between("surface_speed_2", surface_speed_2, -np.inf, np.inf, "m/s")
    heat, width, speed_1, speed_2 = (
        np.asarray(a, dtype=float)
        for a in (heat_per_width, half_width, surface_speed_1, surface_speed_2)
    )
    carried = first * np.sqrt(np.abs(speed_1)) + second * np.sqrt(np.abs(speed_2))
    if np.any(carried == 0.0):
        what = "surface_speed_1 = surface_speed_2 = 0 m/s"
        why = "a contact at rest carries no heat away with its surfaces"
        remedy = "Give the speeds of the surfaces relative to the contact"
        raise InputError(what, "arguments surface_speed_1 and surface_speed_2", why, remedy)
    return np.asarray(FLASH_FACTORS[kind] * heat / (carried * np.sqrt(2.0 * width)))[()]


_MOST_STEPS = 200
#: Last relative step; Newton's method squares it.
_CLOSE = 1e-6


def film_thermal_resistance(
    half_width: Array,
    film_thickness: Array,
    surface_speed_1: Array,
    surface_speed_2: Array,
    thermal_conductivity: float,
    bodies: tuple[float, float] = (STEEL_THERMAL_CONTACT_COEFFICIENT,) * 2,
) -> Array:
    """Mean rise of the film temperature per heat made in it.

    Two resistances in series: the surfaces are warmer than the bodies by the mean flash
    temperature of Blok, and the oil is warmer than the surfaces by ``q h/(12 k)`` with ``q`` the
    heat per area, the mean of the parabola that even heating makes across the film.

    Parameters
    ----------
    half_width : array [m]
        Half width b of the Hertzian contact.
    film_thickness : array [m]
        Film in the contact.
    surface_speed_1, surface_speed_2 : array [m/s]
        Speeds of the surfaces relative to the contact.
    thermal_conductivity : float [W/m/K]
        Thermal conductivity of the oil.
    bodies : (float, float) [J/(m^2 K s^0.5)]
        ``sqrt(k rho c)`` of each body; gear steel by default.

    Returns
    -------
    array [K*m/W]
        Rise per heat per face width.

    Valid while the oil passes no heat on along the film, ``u_e h^2/(12 kappa b) << 1``. Source:
    Blok (1963); Archard (1959).

    Examples
    --------
    >>> one = np.ones(1)
    >>> resistance = film_thermal_resistance(1e-4 * one, 1e-6 * one, 2.0 * one, one, 0.13)
    >>> np.round(7500.0 * resistance, 1).tolist()
    [36.4]
    """
    flash = blok_flash_temperature(
        np.ones(np.shape(half_width)),
        half_width,
        surface_speed_1,
        surface_speed_2,
        *bodies,
        kind="mean",
    )
    across = film_thickness / (12.0 * thermal_conductivity * 2.0 * half_width)
    return np.asarray(flash + across)


def film_temperature_rise(heat: Callable[[Array], tuple[Array, Array]], resistance: Array) -> Array:
    """Temperature rise at which the film makes as much heat as is led away."""
    low = np.zeros(np.shape(resistance))
    rise, high = low, resistance * heat(low)[0]
    for _ in range(_MOST_STEPS):
        produced, slope = heat(rise)
        excess = resistance * produced - rise
        low, high = np.where(excess >= 0.0, rise, low), np.where(excess <= 0.0, rise, high)
        step = rise + excess / (1.0 - resistance * slope)
        outside = ((step <= low) | (step >= high)) & (step != rise)
        step = np.where(outside, 0.5 * (low + high), step)
        if np.all(np.abs(step - rise) <= _CLOSE * (step + 1e-6)):
            return step
        rise = step
    what = f"the film temperature did not settle in {_MOST_STEPS} steps"
    why = f"heat made and led away still differ by {np.max(np.abs(excess)):.3g} K"
    remedy = "Leave out flash_temperature, or check viscosity and speeds"
    raise ComputationError(what, "flash temperature", why, remedy)


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
    arguments = dict(locals())
    ratio = np.asarray(arguments.pop("slide_to_roll_ratio"), dtype=float)
    require_between("slide_to_roll_ratio", ratio, -np.inf, np.inf)
    speed, pressure, viscosity, coefficient, conductivity, modulus = positive(**arguments)
    loading = viscosity * coefficient * speed**2 / conductivity
    numerator = 1.0 - 13.2 * pressure / modulus * loading**0.42
    denominator = 1.0 + 0.213 * (1.0 + 2.23 * np.abs(ratio) ** 0.83) * loading**0.64
    factor = np.asarray(numerator / denominator)[()]
    _check(factor, float(np.max(loading)))
    return factor


def _check(factor: Array, loading: float) -> None:
    """Refuse invalid factors, and warn where the formula extrapolates."""
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
            f"about {_GREATEST_LOADING:g}. The film is a lower estimate.",
            stacklevel=3,
        )
