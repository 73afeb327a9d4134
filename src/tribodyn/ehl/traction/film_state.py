"""Solved films as traction needs them: pressure and film of every contact, and the oil."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

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
