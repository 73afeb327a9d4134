"""Dry line contact of two cylinders after Hertz."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.checks import positive
from tribodyn.errors import require_between
from tribodyn.gear import Material
from tribodyn.types import Array


@dataclass(frozen=True)
class HertzLine:
    """Hertzian line contact.

    Parameters
    ----------
    half_width : float or array
        Half width of the contact [m].
    maximum_pressure : float or array
        Pressure in the middle [Pa].
    mean_pressure : float or array
        Load over contact width, pi/4 of the maximum [Pa].
    """

    half_width: Array
    maximum_pressure: Array
    mean_pressure: Array


def effective_modulus(material_1: Material, material_2: Material) -> float:
    """Effective modulus of a contact in the convention of Dowson and Higginson.

    Parameters
    ----------
    material_1, material_2 : Material
        Materials of the two bodies.

    Returns
    -------
    float
        E' [Pa] with 2/E' = (1 - nu_1^2)/E_1 + (1 - nu_2^2)/E_2, twice the reduced modulus of
        Johnson.

    Notes
    -----
    Source: Dowson and Higginson, Elasto-hydrodynamic Lubrication, 1966.

    Examples
    --------
    >>> steel = Material(youngs_modulus=210e9, poissons_ratio=0.3)
    >>> round(effective_modulus(steel, steel) / 1e9, 3)
    230.769
    """
    compliance = sum(
        (1.0 - material.poissons_ratio**2) / material.youngs_modulus
        for material in (material_1, material_2)
    )
    return 2.0 / compliance


def hertz_line(
    load_per_width: ArrayLike, equivalent_radius: ArrayLike, effective_modulus: ArrayLike
) -> HertzLine:
    """Half width and pressure of a line contact.

    Parameters
    ----------
    load_per_width : float or array
        Normal load per width [N/m], not negative; zero gives a contact of no width.
    equivalent_radius : float or array
        Reduced radius of curvature, 1/R = 1/R_1 + 1/R_2 [m].
    effective_modulus : float or array
        E' of :func:`effective_modulus` [Pa].

    Returns
    -------
    HertzLine
        Values of the broadcast shape.

    Raises
    ------
    InputError
        If a load is negative or a radius or modulus is not positive.

    Notes
    -----
    b = sqrt(8 w R / (pi E')), p_max = sqrt(w E' / (2 pi R)). Valid while b is small against R.
    Source: Hertz (1881); Johnson, Contact Mechanics, 1985, equations 4.43 and 4.45.

    Examples
    --------
    >>> contact = hertz_line(66511.0, 7.523826e-3, 2.30769e11)
    >>> round(float(contact.maximum_pressure) / 1e9, 4)
    0.5698
    """
    require_between("load_per_width", load_per_width, 0.0, math.inf, "N/m")
    radius, modulus = positive(
        equivalent_radius=equivalent_radius, effective_modulus=effective_modulus
    )
    load = np.asarray(load_per_width, dtype=float)
    half_width = np.sqrt(8.0 * load * radius / (math.pi * modulus))
    maximum = np.sqrt(load * modulus / (2.0 * math.pi * radius))
    return HertzLine(half_width, maximum, math.pi / 4.0 * maximum)
