"""Line contact on its grid: the problem and the outcome of an engine."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Protocol

import numpy as np

from tribodyn.types import Array


@dataclass(frozen=True, eq=False)
class DiscreteContact:
    """Dimensionless state of a line contact on a uniform grid: ``X = x/b``, ``P = p/p_h``."""

    n: int  #: intervals
    dx: float  #: width of an interval
    X: Array = field(repr=False)
    P: Array = field(repr=False)
    H: Array = field(repr=False)
    H0: float  #: rigid offset of the film
    lam: float
    oil: Array = field(repr=False)
    free: int  #: last node with pressure
    load: float
    tail: float
    shape: Array = field(repr=False)  #: gap of the undeformed bodies


def heat_factors(oil: Array, n: int) -> tuple[Array, Array]:
    """Logarithm of the factor on viscosity, and factor on density, of a film on n intervals."""
    columns = oil[6:].reshape(2, -1)
    if not columns.size:
        return np.zeros(n + 1), np.ones(n + 1)
    if columns.shape[1] == n + 1:
        return columns[0], columns[1]
    places = np.linspace(0.0, 1.0, columns.shape[1])
    viscosity, density = (np.interp(np.linspace(0.0, 1.0, n + 1), places, c) for c in columns)
    return viscosity, density


@dataclass(frozen=True, eq=False)
class ContactProblem:
    """A steady line contact, dimensionless, as an engine gets it."""

    nodes: int  #: nodes of the grid
    domain: tuple[float, float]  #: first and last position, in half widths
    lam: float
    oil: Array = field(repr=False)
    film: float  #: estimate of the central film ``H`` for the start
    load: float
    tail: float
    moes_load: float  #: load number M of Moes: decides how fine the first grid is
    profile: Array | None = field(default=None, repr=False)  #: heights added to the gap
    tolerance: float = 1e-4  #: relative change of the pressure at convergence
    flux_tolerance: float = 1e-3  #: relative deviation of the flux from its mean at convergence
    film_tolerance: float = 0.0
    levels: int | None = None  #: grids of the multigrid engine
    start: DiscreteContact | None = field(default=None, repr=False)
    coarsest: int | None = None  #: least number of intervals of the first grid

    @property
    def heated(self) -> bool:
        """Whether the oil has factors for the heat of a film, on the grid of its temperatures."""
        return self.oil.size > 6


@dataclass(frozen=True, eq=False)
class Outcome:
    """Answer of an engine."""

    converged: bool  #: whether all criteria are met
    grid: DiscreteContact | None = field(repr=False)  #: solution on the finest grid
    iterations: int  #: steps on the finest grid: Newton steps or multigrid cycles
    films: tuple[float, ...] = ()  #: central films of the grids, each half as fine as the next
    message: str = ""  #: why it failed


class SolvedContact(Protocol):
    """Properties of a solution that stiffness and damping need."""

    @property
    def _grid(self) -> DiscreteContact:
        """State on the grid, in half widths and Hertz pressures."""

    @property
    def hertz_pressure(self) -> float:
        """Maximum pressure of the dry contact [Pa]."""

    @property
    def half_width(self) -> float:
        """Half width b of the dry contact [m]."""

    @property
    def film_unit(self) -> float:
        """Film b^2/R [m]."""

    @property
    def entrainment_speed(self) -> float:
        """HALF the sum of the surface speeds [m/s]."""

    @property
    def moes_load(self) -> float:
        """Number M of Moes."""

    @property
    def moes_viscosity(self) -> float:
        """Number L of Moes."""

    @property
    def inlet(self) -> str:
        """Whether it is "flooded" or begins with pressure "zero"."""
