"""A line contact: checked, its dimensionless numbers, and the problem of an engine on its grid."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np

from tribodyn.contact.hertz import dry_half_width
from tribodyn.errors import (
    Argument,
    InputError,
    real_numbers,
    require_between,
    require_one_of,
    require_positive,
)
from tribodyn.lubricant import Lubricant
from tribodyn.lubricant.pressure_laws import ROELANDS_PRESSURE
from tribodyn.nomenclature import require_flag
from tribodyn.types import Array

#: Pressure laws of the viscosity, by the number that the kernels know them by.
LAWS = {"isoviscous": 0.0, "barus": 1.0, "roelands": 2.0}

#: Density after Dowson and Higginson, [1/Pa].
_RISE, _LIMIT = 0.6e-9, 1.7e-9


@dataclass(frozen=True, eq=False)
class ContactScales:
    """What the equations know of a contact."""

    moes_load: float
    moes_viscosity: float
    lam: float  #: ``12 eta0 u_e R^2/(b^3 p_h) = 3 pi^2/(8 M^2)``
    oil: Array = field(repr=False)  #: law, its three numbers, and two of the density
    density_ratio: float  #: density at the Hertz pressure over that at ambient pressure
    viscosity_law: str  #: law that was used: isoviscous where the coefficient is zero


def moes_numbers(
    load_per_width: float,
    equivalent_radius: float,
    entrainment_speed: float,
    lubricant: Lubricant,
    effective_modulus: float,
) -> tuple[float, float]:
    """Numbers ``M = w/(E'R) (2U)^(-1/2)``, ``L = alpha E' (2U)^(1/4)`` of Moes (1965), from SI."""
    stiffness = effective_modulus * equivalent_radius
    speed = lubricant.dynamic_viscosity * entrainment_speed / stiffness
    load = load_per_width / stiffness / math.sqrt(2.0 * speed)
    viscosity = lubricant.pressure_viscosity_coefficient * effective_modulus
    return load, viscosity * (2.0 * speed) ** 0.25


def contact_scales(
    M: float,
    L: float,
    hertz_pressure: float,
    pressure_viscosity_coefficient: float,
    pressure_viscosity_index: float,
    viscosity_law: str,
    compressible: bool,
) -> ContactScales:
    """Numbers of the equations from those of Moes; oil of Roelands, Dowson and Higginson (1966)."""
    require_one_of("viscosity_law", viscosity_law, LAWS)
    require_flag("compressible", compressible)
    if L == 0.0:
        viscosity_law = "isoviscous"
    oil = np.zeros(6)
    oil[0] = LAWS[viscosity_law]
    growth = L * math.sqrt(M / (2.0 * math.pi))  # alpha p_h
    if viscosity_law == "barus":
        oil[1] = growth
    elif viscosity_law == "roelands":
        reference = pressure_viscosity_coefficient * ROELANDS_PRESSURE
        oil[1] = reference / pressure_viscosity_index
        oil[2] = reference / growth
        oil[3] = pressure_viscosity_index
    if compressible:
        oil[4], oil[5] = _RISE * hertz_pressure, _LIMIT * hertz_pressure
    return ContactScales(
        moes_load=M,
        moes_viscosity=L,
        lam=3.0 * math.pi**2 / (8.0 * M * M),
        oil=oil,
        density_ratio=float(1.0 + oil[4] / (1.0 + oil[5])),
        viscosity_law=viscosity_law,
    )


#: Hertz pressure [Pa] up to which the viscosity laws are carried on, far above their data.
_HIGHEST_PRESSURE = 4.05e9
#: ln(viscosity ratio) at the Hertz pressure beyond which the law of Barus overflows at the spike.
_GREATEST_GROWTH = 450.0
#: Load numbers for which the solvers were tested, with a margin.
_LOADS = (1e-4, 5e3)


@dataclass(frozen=True, eq=False)
class ContactCase:
    """A checked contact: its numbers, its units and its oil."""

    scales: ContactScales  #: numbers of the equations
    hertz_pressure: float  #: [Pa]
    half_width: float  #: [Pa]
    load_per_width: float  #: as given, or pi/2 in the dimensionless form [N/m]
    equivalent_radius: float  #: as given, or 1 in the dimensionless form [m]
    entrainment_speed: float  #: as given, or 1 in the dimensionless form [m/s]
    effective_modulus: float  #: as given, or 4 in the dimensionless form [Pa]
    lubricant: Lubricant | None  #: ``None`` in the dimensionless form
    compressible: bool  #: whether the density rises with pressure


def _scalar(name: str, value: object, unit: str) -> float:
    """One finite number, or a message that names the field."""
    number = real_numbers(Argument(name), value, f"a number {unit}".rstrip())
    if number.ndim:
        what, why = f"{name} has the shape {number.shape}", "one contact takes single numbers"
        raise InputError(what, f"argument {name}", why, "Use solve_line_contacts for arrays")
    return float(number)


def positive_scalar(name: str, value: float, unit: str, remedy: str) -> float:
    """One positive number."""
    number = _scalar(name, value, f"[{unit}]")
    require_positive(name, number, unit, remedy=remedy)
    return number


def speed_and_modulus(entrainment_speed: float, effective_modulus: float) -> tuple[float, float]:
    """Entrainment speed and effective modulus of any contact."""
    remedy = "A film needs a rolling motion: give half the sum of the surface speeds"
    speed = positive_scalar("entrainment_speed", entrainment_speed, "m/s", remedy)
    modulus = _scalar("effective_modulus", effective_modulus, "[Pa]")
    require_between("effective_modulus", modulus, 1e5, 1e13, "Pa", remedy="220 GPa are 2.2e11 Pa")
    return speed, modulus


def si_case(
    load_per_width: float,
    equivalent_radius: float,
    entrainment_speed: float,
    lubricant: Lubricant,
    effective_modulus: float,
    viscosity_law: str,
    compressible: bool,
) -> ContactCase:
    """Check a contact in SI."""
    load = positive_scalar("load_per_width", load_per_width, "N/m", "1 N/mm is 1000 N/m")
    radius = positive_scalar("equivalent_radius", equivalent_radius, "m", "8 mm are 8e-3 m")
    speed, modulus = speed_and_modulus(entrainment_speed, effective_modulus)
    _check_lubricant(lubricant)
    M, L = moes_numbers(load, radius, speed, lubricant, modulus)
    if require_one_of("viscosity_law", viscosity_law, LAWS) == "isoviscous":
        L = 0.0
    pressure = math.sqrt(load * modulus / (2.0 * math.pi * radius))
    half_width = float(dry_half_width(load, radius, modulus))
    _check_pressure(pressure, load, modulus, radius)
    _check_width(half_width, radius)
    _check_numbers(M, L, "load_per_width, equivalent_radius, entrainment_speed")
    # Everything dimensionless follows from M, L, z and alpha, so that contacts with equal
    # numbers have equal films to the last digit.
    alpha = lubricant.pressure_viscosity_coefficient
    scaled = L * math.sqrt(M / (2.0 * math.pi)) / alpha if L > 0.0 else pressure
    scales = contact_scales(
        M, L, scaled, alpha, lubricant.roelands_index, viscosity_law, compressible
    )
    _check_growth(scales, pressure)
    return ContactCase(
        scales, pressure, half_width, load, radius, speed, modulus, lubricant, bool(compressible)
    )


def moes_case(
    M: object,
    L: object,
    pressure_viscosity_index: object,
    pressure_viscosity_coefficient: object,
    viscosity_law: str,
    compressible: bool,
) -> ContactCase:
    """Check a contact that is given by the numbers of Moes."""
    require_one_of("viscosity_law", viscosity_law, LAWS)
    load, viscosity = _scalar("M", M, ""), _scalar("L", L, "")
    index = _scalar("pressure_viscosity_index", pressure_viscosity_index, "")
    alpha = _scalar("pressure_viscosity_coefficient", pressure_viscosity_coefficient, "[1/Pa]")
    require_between("pressure_viscosity_index", index, 0.05, 2.0)
    remedy, name = "22 1/GPa are 2.2e-8 1/Pa", "pressure_viscosity_coefficient"
    require_between(name, alpha, 1e-9, 1e-7, "1/Pa", remedy=remedy)
    _check_numbers(load, viscosity, "M, L")
    pressure = viscosity * math.sqrt(load / (2.0 * math.pi)) / alpha
    if viscosity_law == "isoviscous":
        viscosity = 0.0
    scales = contact_scales(load, viscosity, pressure, alpha, index, viscosity_law, compressible)
    _check_growth(scales, pressure)
    return ContactCase(scales, 1.0, 1.0, 0.5 * math.pi, 1.0, 1.0, 4.0, None, bool(compressible))


def require_kind(name: str, value: object, fits: bool, why: str, remedy: str) -> None:
    """Raise :class:`InputError` for an object of another type than wanted."""
    if not fits:
        what = f"{name} is of the type {type(value).__name__}"
        raise InputError(what, f"argument {name}", why, remedy)


def _check_lubricant(lubricant: object) -> None:
    why = "the viscosity, its rise with pressure and the density are needed"
    remedy = (
        "Give tribodyn.lubricant.Lubricant(dynamic_viscosity, density, "
        "pressure_viscosity_coefficient), or one of tribodyn.lubricant.library()"
    )
    require_kind("lubricant", lubricant, isinstance(lubricant, Lubricant), why, remedy)


def _check_width(half_width: float, radius: float) -> None:
    if half_width > radius:
        raise InputError(
            f"the dry contact is {2e3 * half_width:.4g} mm wide on bodies with an "
            f"equivalent radius of {1e3 * radius:.4g} mm",
            where="arguments load_per_width, equivalent_radius",
            why="the contact must be narrow against the radius",
            remedy="Check the units: load in N/m, radius in m, modulus in Pa",
        )


def _check_pressure(pressure: float, load: float, modulus: float, radius: float) -> None:
    if pressure > _HIGHEST_PRESSURE:
        raise InputError(
            f"the Hertz pressure is {pressure * 1e-9:.4g} GPa at {load:.4g} N/m, "
            f"a modulus of {modulus:.4g} Pa and a radius of {radius:.4g} m",
            where="arguments load_per_width, equivalent_radius, effective_modulus",
            why="the laws of viscosity are carried on to 4 GPa at most, measured to about 1",
            remedy="Check the units: load in N/m, radius in m, modulus in Pa",
        )


def _check_numbers(M: float, L: float, where: str) -> None:
    require_between(
        "M", M, *_LOADS, remedy=f"The load number follows from {where}: check their units"
    )
    require_between("L", L, 0.0, 1e4, remedy=f"The number follows from {where}: check the units")


def _check_growth(scales: ContactScales, pressure: float) -> None:
    growth = scales.oil[1] if scales.viscosity_law == "barus" else 0.0
    if growth > _GREATEST_GROWTH:
        raise InputError(
            f"at the Hertz pressure of {pressure * 1e-9:.4g} GPa the law of Barus raises "
            f"the viscosity by exp({growth:.4g})",
            where="argument viscosity_law",
            why=f"computable up to exp({_GREATEST_GROWTH:g}), and measured to 0.1 GPa",
            remedy='Use viscosity_law = "roelands"',
        )


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
