"""Dimensionless numbers of a line contact in the scales of the dry contact."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from tribodyn.errors import InputError, Problem
from tribodyn.lubricant.roelands import ROELANDS_PRESSURE
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.lubricant import Lubricant


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
    """Numbers M and L of Moes of a contact in SI.

    Parameters
    ----------
    load_per_width : float [N/m]
        Normal load per face width.
    equivalent_radius : float [m]
        Reduced radius of curvature.
    entrainment_speed : float [m/s]
        HALF the sum of the surface speeds.
    lubricant : Lubricant
        Oil at the temperature of the inlet.
    effective_modulus : float [Pa]
        ``2/E' = (1-nu1^2)/E1 + (1-nu2^2)/E2``.

    Returns
    -------
    tuple of float
        ``M = w/(E'R) (2U)^(-1/2)`` and ``L = alpha E' (2U)^(1/4)`` with ``U = eta0 u_e/(E'R)``.

    Source: Moes (1965).
    """
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
    """Numbers of the equations from those of Moes.

    Parameters
    ----------
    M, L : float
        Numbers of Moes.
    hertz_pressure : float [Pa]
        Maximum pressure of the dry contact.
    pressure_viscosity_coefficient : float [1/Pa]
        Slope of ln(viscosity) over pressure at ambient pressure.
    pressure_viscosity_index : float
        Index z of Roelands.
    viscosity_law : str
        Name in :data:`LAWS`.
    compressible : bool
        Whether the density rises with pressure.

    Returns
    -------
    ContactScales

    Raises
    ------
    InputError
        If the law is unknown.

    Source: Roelands (1966); Dowson and Higginson (1966).
    """
    if viscosity_law not in LAWS:
        raise InputError(
            Problem(
                what=f'viscosity_law = "{viscosity_law}"',
                where="argument viscosity_law",
                why=f"Known: {', '.join(LAWS)}",
            )
        )
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
