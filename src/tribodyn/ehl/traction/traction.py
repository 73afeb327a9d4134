"""Solved films as traction needs them, and the tangential forces of the oil."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.ehl.traction.film_temperature import heated_log_viscosity
from tribodyn.ehl.traction.shear_models import EYRING_STRESS, SHEAR_MODELS, ShearModel
from tribodyn.errors import InputError, require_between, require_positive
from tribodyn.lubricant import Lubricant
from tribodyn.types import Array, Index

if TYPE_CHECKING:
    from tribodyn.ehl.steady.solution import LineContactSolution


@dataclass(frozen=True, eq=False)
class FilmState:
    """Films of line contacts, several contacts per film where only the sliding differs.

    Between two nodes pressure and film are taken as linear. Where the pressure is zero behind the
    outlet the oil has parted and carries no shear.

    Parameters
    ----------
    position : (films, nodes) array [m]
        Distance from the line of centres in the direction of rolling, increasing.
    pressure : (films, nodes) array [Pa]
        Pressure above ambient.
    film_thickness : (films, nodes) array [m]
        Distance of the surfaces.
    lubricant : Lubricant
        Oil at the temperature of the inlet.
    effective_modulus : float [Pa]
        ``2/E' = (1-nu1^2)/E1 + (1-nu2^2)/E2``.
    index : (contacts,) array of int, optional
        Film of each contact; by default every film has one contact.
    viscosity_law : str
        ``"roelands"``, ``"barus"`` or ``"isoviscous"``.
    heated : (films, nodes) array, optional
        Logarithm of the viscosity of heated films at low stress [Pa*s], the harmonic mean across.

    Raises
    ------
    InputError
        If shapes differ, a film is not positive, a pressure negative, a position does not increase
        or an index names no film.

    Examples
    --------
    >>> from tribodyn.lubricant import Lubricant
    >>> x = np.linspace(-1e-4, 1e-4, 101)
    >>> film = FilmState(
    ...     x, 1e9 * np.sqrt(1 - (x / 1e-4) ** 2), 1e-6 * np.ones(101),
    ...     Lubricant(0.08, 880.0, 2e-8), 2.3e11,
    ... )
    >>> film.size, film.films
    (1, 1)
    """

    position: Array = field(repr=False)
    pressure: Array = field(repr=False)
    film_thickness: Array = field(repr=False)
    lubricant: Lubricant
    effective_modulus: float
    index: Index | None = field(default=None, repr=False)
    viscosity_law: str = "roelands"
    heated: Array | None = field(default=None, repr=False)

    def __post_init__(self) -> None:
        """Convert and check the arrays."""
        for name in ("position", "pressure", "film_thickness"):
            array = np.atleast_2d(np.asarray(getattr(self, name), dtype=float))
            object.__setattr__(self, name, array)
        shapes = {self.position.shape, self.pressure.shape, self.film_thickness.shape}
        if len(shapes) > 1 or self.position.ndim != 2 or self.position.shape[1] < 2:
            raise _bad(
                f"shapes {', '.join(map(str, shapes))} of position, pressure and film",
                "each film has the same two or more nodes in all three",
            )
        require_between("pressure", self.pressure, 0.0, np.inf, "Pa")
        require_positive("film_thickness", self.film_thickness, "m")
        require_positive("position step", np.diff(self.position, axis=1), "m")
        require_positive("effective_modulus", self.effective_modulus, "Pa")
        index = np.arange(self.films) if self.index is None else np.atleast_1d(self.index)
        integer = index.ndim == 1 and np.issubdtype(index.dtype, np.integer)
        if not integer or np.any((index < 0) | (index >= self.films)):
            raise _bad(
                f"index {index}", f"it is a list of whole numbers from 0 to {self.films - 1}"
            )
        object.__setattr__(self, "index", index)

    @classmethod
    def from_solutions(
        cls, solutions: Sequence[LineContactSolution], index: ArrayLike | None = None
    ) -> FilmState:
        """Gather solved contacts.

        Parameters
        ----------
        solutions : sequence of LineContactSolution
            Contacts in SI on grids of the same number of nodes, with one oil.
        index : array of int, optional
            Solution of each contact; by default every solution has one contact.

        Raises
        ------
        InputError
            If there is none, or they differ in nodes, oil or modulus.
        """
        if not len(solutions):
            raise _bad("no solution", "traction needs a film")
        first = solutions[0]
        for name in ("nodes", "lubricant", "viscosity_law", "effective_modulus"):
            require_same(name, [getattr(solution, name) for solution in solutions])
        if first.lubricant is None:
            raise _bad(
                "the contact is given by the numbers of Moes", "traction needs a viscosity in Pa*s"
            )
        return cls(
            np.stack([solution.position for solution in solutions]),
            np.stack([solution.pressure for solution in solutions]),
            np.stack([solution.film for solution in solutions]),
            first.lubricant,
            first.effective_modulus,
            None if index is None else np.asarray(index),
            first.viscosity_law,
            None
            if first.log_mean_viscosity is None
            else np.stack([np.asarray(solution.log_mean_viscosity) for solution in solutions]),
        )

    @property
    def films(self) -> int:
        """Number of different films."""
        return int(self.position.shape[0])

    @property
    def size(self) -> int:
        """Number of contacts."""
        return int(np.size(self.contacts))

    @property
    def contacts(self) -> Index:
        """Film of each contact."""
        return np.asarray(self.index)

    @cached_property
    def interval_film(self) -> Array:
        """Film in the middle of each interval (films, nodes - 1) [m]."""
        return np.asarray(0.5 * (self.film_thickness[:, 1:] + self.film_thickness[:, :-1]))

    @cached_property
    def interval_width(self) -> Array:
        """Width of each interval that oil fills, zero for the others (films, nodes - 1) [m]."""
        return np.where(self.interval_pressure > 0.0, np.diff(self.position, axis=1), 0.0)

    @cached_property
    def pressure_gradient(self) -> Array:
        """Slope of the pressure in each interval (films, nodes - 1) [Pa/m]."""
        return np.asarray(np.diff(self.pressure, axis=1) / np.diff(self.position, axis=1))

    @cached_property
    def interval_pressure(self) -> Array:
        """Pressure in the middle of each interval (films, nodes - 1) [Pa]."""
        return np.asarray(0.5 * (self.pressure[:, 1:] + self.pressure[:, :-1]))

    @cached_property
    def log_viscosity(self) -> Array:
        """Logarithm of the viscosity in Pa*s in each interval (films, nodes - 1)."""
        if self.heated is not None:
            return np.asarray(0.5 * (self.heated[:, 1:] + self.heated[:, :-1]))
        middle = self.interval_pressure
        if self.viscosity_law == "isoviscous":
            return np.full(middle.shape, np.log(self.lubricant.dynamic_viscosity))
        return np.log(self.lubricant.viscosity(middle, self.viscosity_law))

    @cached_property
    def central_film(self) -> Array:
        """Film at position zero (films,) [m]."""
        pairs = zip(self.position, self.film_thickness, strict=True)
        return np.array([np.interp(0.0, x, h) for x, h in pairs])


def require_same(name: str, values: Sequence[object]) -> None:
    """Refuse values that are not all equal."""
    other = next((value for value in values if value != values[0]), None)
    if other is not None:
        raise _bad(f"{name} = {values[0]} and {name} = {other}", f"all films have the same {name}")


def _bad(what: str, why: str) -> InputError:
    return InputError(what, "FilmState", why, "Give films of equal nodes, oil and viscosity law")


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
