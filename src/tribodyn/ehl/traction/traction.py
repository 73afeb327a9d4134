"""Traction of solved films on both surfaces: the sliding and the rolling part."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.ehl.traction.film_state import FilmState
from tribodyn.ehl.traction.film_temperature import heated_log_viscosity
from tribodyn.ehl.traction.shear_models import EYRING_STRESS, SHEAR_MODELS, ShearModel
from tribodyn.errors import InputError, require_between, require_positive
from tribodyn.types import Array

#: Contacts per block, so that the arrays stay in the processor cache.
_BLOCK = 32
#: Largest exponent whose exponential, times a speed, does not overflow.
_LARGEST_EXPONENT = 690.0


@dataclass(frozen=True)
class Traction:
    """Tangential forces of the oil per face width; those on the surfaces count in their motion.

    Parameters
    ----------
    sliding : array [N/m]
        Force with which the faster surface is held back and the slower one driven: of the sign of
        the sliding speed ``u_1 - u_2``.
    rolling : array [N/m]
        Force that holds both surfaces back, ``1/2 int h dp``; it does not depend on sliding.
    """

    sliding: Array
    rolling: Array

    @property
    def on_surface_1(self) -> Array:
        """Force on surface 1 in the direction of its motion [N/m]."""
        return np.asarray(-self.sliding - self.rolling)

    @property
    def on_surface_2(self) -> Array:
        """Force on surface 2 in the direction of its motion [N/m]."""
        return np.asarray(self.sliding - self.rolling)


@dataclass(frozen=True, eq=False)
class FilmShear:
    """Films ready to be sheared at any speed and temperature."""

    film: FilmState  #: solved films
    model: ShearModel  #: how the oil shears
    numbers: Mapping[str, float]  #: all parameters of the model
    film_factor: Array | None = None  #: factor on the film of each contact

    @cached_property
    def thickness(self) -> Array:
        """Film of each interval, of each film or contact [m]."""
        if self.film_factor is None:
            return self.film.interval_film
        return np.asarray(self.film.interval_film[self.film.contacts] * self.film_factor[:, None])

    @cached_property
    def pressure_step(self) -> Array:
        """Pressure that rises over a length of one film, which shears both walls apart [Pa]."""
        gradient = self.film.pressure_gradient
        rows = gradient if self.film_factor is None else gradient[self.film.contacts]
        return np.asarray(self.thickness * np.abs(rows))

    @cached_property
    def log_rate(self) -> Array:
        """Logarithm of the rate per sliding speed without heating, of each film or contact."""
        viscosity = self.film.log_viscosity
        rows = viscosity if self.film_factor is None else viscosity[self.film.contacts]
        logarithm = rows - np.log(self.thickness)
        if self.model.across is not None:
            logarithm = logarithm + self.model.across(self.pressure_step, **self.numbers)
        return np.asarray(np.minimum(logarithm, _LARGEST_EXPONENT))

    def sliding(
        self, sliding_speed: Array, temperature_rise: Array | None = None
    ) -> tuple[Array, Array]:
        """Sliding traction per face width, and its slope over the temperature."""
        traction, slope = np.zeros(sliding_speed.size), np.zeros(sliding_speed.size)
        for start in range(0, sliding_speed.size, _BLOCK):
            block = slice(start, start + _BLOCK)
            rise = None if temperature_rise is None else temperature_rise[block]
            traction[block], slope[block] = self._sliding(block, sliding_speed[block], rise)
        return traction, slope

    def _sliding(self, block: slice, speed: Array, rise: Array | None) -> tuple[Array, Array]:
        """Sliding traction and its slope for some of the contacts."""
        film, index = self.film, self.film.contacts[block]
        rows = index if self.film_factor is None else block
        log_rate = self.log_rate[rows]
        width, fall = film.interval_width[index], np.zeros((1, 1))
        if rise is not None:
            cold = film.log_viscosity[index]
            warm, fall = heated_log_viscosity(cold, rise, film.lubricant, film.viscosity_law)
            log_rate = log_rate + (warm - cold)
        rate, limit = speed[:, None] * np.exp(log_rate), np.full((1, 1), np.inf)
        if "limiting_stress" in self.numbers:
            slope = self.numbers["limiting_stress_slope"]
            limit = self.numbers["limiting_stress"] + slope * film.interval_pressure[index]
        stress, steep = self.model.stress(rate, limit, **self.numbers)
        if "limiting_stress" in self.numbers:
            # The film yields where the stress at one of its walls reaches the limit.
            most = np.maximum(limit - 0.5 * self.pressure_step[rows], 0.0)
            stress, steep = np.minimum(stress, most), np.where(stress < most, steep, 0.0)
        return np.einsum("ij,ij->i", stress, width), np.einsum("ij,ij->i", steep * fall, width)

    @cached_property
    def rolling(self) -> Array:
        """Rolling traction per face width (contacts,) [N/m]."""
        film = self.film
        pressures = np.diff(film.pressure, axis=1)
        half = 0.5 * (film.interval_film * pressures).sum(axis=1)
        # What a flooded inlet adds beyond the first node: far out h grows as x^2, p falls as 1/x^3.
        half += 1.5 * film.pressure[:, 0] * film.film_thickness[:, 0]
        factor = 1.0 if self.film_factor is None else self.film_factor
        return np.asarray(half[film.contacts] * factor)


def film_traction(
    film: FilmState,
    sliding_speed: ArrayLike,
    *,
    shear_model: str = "ree-eyring",
    eyring_stress: float = EYRING_STRESS,
    film_factor: ArrayLike = 1.0,
    temperature_rise: ArrayLike = 0.0,
    **oil: float | None,
) -> Traction:
    """Traction of solved films.

    The shear stress is ``tau_m + z dp/dx`` across the film. Its mean drives the sliding, its ends
    act on the surfaces: the sliding part is the integral of ``tau_m``, the rolling part that of
    ``h/2 dp/dx``.

    Parameters
    ----------
    film : FilmState
        Solved films.
    sliding_speed : float or (contacts,) array [m/s]
        Speed of surface 1 less that of surface 2.
    shear_model : str
        How the oil shears: a name of :data:`tribodyn.ehl.SHEAR_MODELS`.
    eyring_stress : float [Pa]
        Stress from which an oil thins, by the models that have it.
    film_factor : float or (contacts,) array
        Factor on the films, such as that of a heated inlet.
    temperature_rise : float or (contacts,) array [K]
        Film temperature above that of the inlet, not negative.
    **oil : float
        Other numbers of the shear model, such as ``limiting_stress`` [Pa].

    Returns
    -------
    Traction
        Arrays (contacts,).

    Raises
    ------
    InputError
        If a value is out of range, the shear model unknown or a number not one of its own.

    Pressure and film come from a Newtonian oil: shear thinning in the inlet is not counted. Forces
    act along the mean of the two surfaces. Source: Johnson and Tevaarwerk, Proc. R. Soc. A 356
    (1977).

    Examples
    --------
    >>> from tribodyn.lubricant import Lubricant
    >>> x = np.linspace(-1e-4, 1e-4, 401)
    >>> pressure = 0.8e9 * np.sqrt(1 - (x / 1e-4) ** 2)
    >>> oil = Lubricant(0.082, 880.0, 2.19e-8)
    >>> film = FilmState(x, pressure, 1e-6 * np.ones(401), oil, 2.2e11)
    >>> load = 0.5 * np.pi * 1e-4 * 0.8e9
    >>> print(np.round(film_traction(film, 0.5).sliding / load, 4))
    [0.044]
    """
    require_between("sliding_speed", sliding_speed, -np.inf, np.inf, "m/s")
    require_positive("film_factor", film_factor)
    require_between("temperature_rise", temperature_rise, 0.0, np.inf, "K")
    speed, factor, rise = (
        _spread(name, value, film.size)
        for name, value in (
            ("sliding_speed", sliding_speed),
            ("film_factor", film_factor),
            ("temperature_rise", temperature_rise),
        )
    )
    model = SHEAR_MODELS[shear_model]
    shear = FilmShear(film, model, model.complete(eyring_stress, oil), factor)
    sliding, _ = shear.sliding(np.abs(speed), rise if np.any(rise > 0.0) else None)
    return Traction(np.copysign(sliding, speed), shear.rolling)


def _spread(name: str, value: ArrayLike, contacts: int) -> Array:
    """Broadcast one value, or one of each contact."""
    array = np.asarray(value, dtype=float)
    if array.shape not in {(), (1,), (contacts,)}:
        what, why = f"{name} has the shape {array.shape}", f"there are {contacts} contacts"
        raise InputError(what, f"argument {name}", why, "Give one value, or one of each contact")
    return np.broadcast_to(array, (contacts,))
