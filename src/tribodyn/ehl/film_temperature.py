"""Mean temperature of a sheared film: the point where heat made equals heat led away."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from tribodyn.ehl.flash_temperature import blok_flash_temperature
from tribodyn.errors import ComputationError, Problem
from tribodyn.types import Array

_MOST_STEPS = 200
#: Last relative step; Newton's method squares it.
_CLOSE = 1e-6


def film_thermal_resistance(
    half_width: Array,
    film_thickness: Array,
    surface_speed_1: Array,
    surface_speed_2: Array,
    thermal_conductivity: float,
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
        Speeds of the surfaces relative to the contact, of steel bodies.
    thermal_conductivity : float [W/m/K]
        Thermal conductivity of the oil.

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
        np.ones(np.shape(half_width)), half_width, surface_speed_1, surface_speed_2, kind="mean"
    )
    across = film_thickness / (12.0 * thermal_conductivity * 2.0 * half_width)
    return np.asarray(flash + across)


def film_temperature_rise(heat: Callable[[Array], tuple[Array, Array]], resistance: Array) -> Array:
    """Temperature rise at which the film makes as much heat as is led away."""
    low = np.zeros(np.shape(resistance))
    rise, high = low, resistance * heat(low)[0]
    for _ in range(_MOST_STEPS):
        made, slope = heat(rise)
        excess = resistance * made - rise
        low, high = np.where(excess >= 0.0, rise, low), np.where(excess <= 0.0, rise, high)
        step = rise + excess / (1.0 - resistance * slope)
        outside = ((step <= low) | (step >= high)) & (step != rise)
        step = np.where(outside, 0.5 * (low + high), step)
        if np.all(np.abs(step - rise) <= _CLOSE * (step + 1e-6)):
            return step
        rise = step
    raise ComputationError(
        Problem(
            what=f"the film temperature did not settle in {_MOST_STEPS} steps",
            where="flash temperature",
            why=f"heat made and led away still differ by {np.max(np.abs(excess)):.3g} K",
            remedy="Leave out flash_temperature, or check viscosity and speeds",
        )
    )
