"""Flash temperature of a line contact: the formula of Blok."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.errors import InputError, Problem, require_between, require_positive
from tribodyn.model import Registry
from tribodyn.types import Array

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
        raise InputError(
            Problem(
                what="surface_speed_1 = surface_speed_2 = 0 m/s",
                where="arguments surface_speed_1 and surface_speed_2",
                why="a contact at rest carries no heat away with its surfaces",
                remedy="Give the speeds of the surfaces relative to the contact",
            )
        )
    return np.asarray(FLASH_FACTORS[kind] * heat / (carried * np.sqrt(2.0 * width)))[()]
