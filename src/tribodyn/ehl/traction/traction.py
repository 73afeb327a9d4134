"""Traction of solved films on both surfaces: the sliding and the rolling part."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.ehl.traction.film_state import FilmState
from tribodyn.ehl.traction.film_temperature import heated_log_viscosity
from tribodyn.ehl.traction.shear_models import EYRING_STRESS, SHEAR_MODELS, ShearModel
from tribodyn.errors import InputError, require_between, require_positive
from tribodyn.types import Array

#: Contacts sheared at a time: their arrays stay in the cache of the processor.
_BLOCK = 32


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
    eyring_stress: float = EYRING_STRESS  #: stress from which the oil thins [Pa]
    film_factor: Array | None = None  #: factor on the film of each contact

    @cached_property
    def log_rate(self) -> Array:
        """Logarithm of what turns speed into shear without heating, of each film or contact."""
        film, index = self.film, self.film.contacts
        if self.film_factor is None:
            arguments = (film.log_viscosity, film.interval_film, film.pressure_gradient)
            return self.model.log_rate(*arguments, self.eyring_stress)
        return self.model.log_rate(
            film.log_viscosity[index],
            film.interval_film[index] * self.film_factor[:, None],
            film.pressure_gradient[index],
            self.eyring_stress,
        )

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
        """Return the same of some contacts."""
        film, index = self.film, self.film.contacts[block]
        log_rate = self.log_rate[index if self.film_factor is None else block]
        width, fall = film.interval_width[index], np.zeros((1, 1))
        if rise is not None:
            cold = film.log_viscosity[index]
            warm, fall = heated_log_viscosity(cold, rise, film.lubricant, film.viscosity_law)
            log_rate = log_rate + (warm - cold)
        stress, steep = self.model.stress(speed[:, None] * np.exp(log_rate), self.eyring_stress)
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
    shear_model : {"ree-eyring", "newtonian"}
        How the oil shears.
    eyring_stress : float [Pa]
        Stress from which a Ree-Eyring oil thins.
    film_factor : float or (contacts,) array
        Factor on the films, such as that of a heated inlet.
    temperature_rise : float or (contacts,) array [K]
        Film temperature above that of the inlet, not negative.

    Returns
    -------
    Traction
        Arrays (contacts,).

    Raises
    ------
    InputError
        If a value is out of range or the shear model unknown.

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
    require_positive("eyring_stress", eyring_stress, "Pa", remedy="5 MPa is 5e6 Pa")
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
    shear = FilmShear(film, SHEAR_MODELS[shear_model], eyring_stress, factor)
    sliding, _ = shear.sliding(np.abs(speed), rise if np.any(rise > 0.0) else None)
    return Traction(np.copysign(sliding, speed), shear.rolling)


def _spread(name: str, value: ArrayLike, contacts: int) -> Array:
    """Broadcast one value, or one of each contact."""
    array = np.asarray(value, dtype=float)
    if array.shape not in {(), (1,), (contacts,)}:
        raise InputError(
            f"{name} has the shape {array.shape}",
            where=f"argument {name}",
            why=f"there are {contacts} contacts",
            remedy="Give one value, or one of each contact",
        )
    return np.broadcast_to(array, (contacts,))
