"""Dry contact after Hertz: of two cylinders along a line, of two bodies in an ellipse."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.errors import require_between, require_positive
from tribodyn.gear import Material
from tribodyn.nomenclature import positive
from tribodyn.types import Array, Numbers


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
    maximum = np.sqrt(load * modulus / (2.0 * math.pi * radius))
    return HertzLine(dry_half_width(load, radius, modulus), maximum, math.pi / 4.0 * maximum)


def dry_half_width(load: Numbers, radius: Numbers, modulus: Numbers) -> Any:
    """Half width of a line contact, see :func:`hertz_line`."""
    return np.sqrt(8.0 * load * radius / (math.pi * modulus))


#: Steps of bisection in the logarithm of the ratio of both axes, and its least value.
_STEPS, _LEAST = 60, 1e-12
#: Steps after which both means agree to the last digit.
_MEANS = 10


@dataclass(frozen=True)
class HertzEllipse:
    """Hertzian contact over an ellipse.

    Parameters
    ----------
    first_semi_axis, second_semi_axis : float or array [m]
        Half axes along the directions of the first and of the second radius.
    maximum_pressure : float or array [Pa]
        Pressure in the middle.
    approach : float or array [m]
        By how much distant points of both bodies come nearer.
    """

    first_semi_axis: Array
    second_semi_axis: Array
    maximum_pressure: Array
    approach: Array


def hertz_ellipse(
    normal_force: ArrayLike,
    first_radius: ArrayLike,
    second_radius: ArrayLike,
    effective_modulus: ArrayLike,
) -> HertzEllipse:
    """Half axes, pressure and approach of an elliptical contact.

    Parameters
    ----------
    normal_force : float or array [N]
        Force of the contact.
    first_radius, second_radius : float or array [m]
        Principal radii of the gap: it opens by x^2 / (2 R_1) + y^2 / (2 R_2).
    effective_modulus : float or array [Pa]
        E' of :func:`effective_modulus`.

    Returns
    -------
    HertzEllipse
        Values of the broadcast shape.

    Raises
    ------
    InputError
        If a value is not finite and positive.

    Notes
    -----
    The ratio of both axes follows from that of the radii by complete elliptic integrals, solved to
    the last digit. Source: Hertz (1881); Johnson, Contact Mechanics, 1985, section 4.2.

    Examples
    --------
    >>> contact = hertz_ellipse(5000.0, 0.5, 1.0 / 32.6, 2.2637e11)
    >>> round(float(contact.first_semi_axis) * 1e3, 5), round(float(contact.approach) * 1e6, 4)
    (3.61194, 18.7486)
    """
    force, modulus = positive(normal_force=normal_force, effective_modulus=effective_modulus)
    radii = {"first_radius": first_radius, "second_radius": second_radius}
    for name, radius in radii.items():
        require_positive(name, radius, "m", remedy="A contact without curvature is a line")
    force, first_radii, second_radii, modulus = np.broadcast_arrays(
        force, *map(np.asarray, radii.values()), modulus
    )
    wide, narrow = np.maximum(first_radii, second_radii), np.minimum(first_radii, second_radii)
    low, high = np.full(wide.shape, math.log(_LEAST)), np.zeros(wide.shape)
    for _ in range(_STEPS):
        middle = 0.5 * (low + high)
        first_integral, second_integral = _complete_integrals(np.exp(middle))
        square = np.exp(2.0 * middle)
        slender = (first_integral - second_integral) / (square * second_integral) > wide / narrow
        low, high = np.where(slender, middle, low), np.where(slender, high, middle)
    ratio = np.exp(0.5 * (low + high))
    first_integral, second_integral = _complete_integrals(ratio)
    # Half the gap's curvature, over the reduced modulus of Johnson, which is half of E'.
    long = np.cbrt(6.0 * force * second_integral * wide / (math.pi * modulus))
    short = ratio * long
    first = first_radii >= second_radii
    return HertzEllipse(
        np.where(first, long, short)[()],
        np.where(first, short, long)[()],
        (1.5 * force / (math.pi * long * short))[()],
        (3.0 * force * first_integral / (math.pi * long * modulus))[()],
    )


def _complete_integrals(ratio: Array) -> tuple[Array, Array]:
    """Complete elliptic integrals K and (K - E) / k^2 of the complementary modulus."""
    # By the arithmetic-geometric mean: Abramowitz and Stegun, section 17.6, without differences.
    mean, root, square = 0.5 * (1.0 + ratio), np.sqrt(ratio), (1.0 - ratio) * (1.0 + ratio)
    part = 0.25 * (1.0 - ratio) / (1.0 + ratio)
    total = 0.5 + part
    for step in range(1, _MEANS):
        mean, root = 0.5 * (mean + root), np.sqrt(mean * root)
        part = square * (0.25 * part / mean) ** 2
        total = total + 2.0**step * part
    first = 0.5 * math.pi / mean
    return first, first * total
