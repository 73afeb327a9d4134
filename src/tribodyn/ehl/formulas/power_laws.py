"""Films by formulas that are products of powers: of line contacts, and of ellipses."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.checks import positive
from tribodyn.ehl.formulas.dimensionless_groups import (
    Groups,
    film_formula,
    warn_outside_elastic_piezoviscous,
)
from tribodyn.errors import Argument, real_numbers, require_between
from tribodyn.types import Array


def _power_law(
    name: str, groups: Groups, factor: float, speed: float, material: float, load: float
) -> Array:
    """Film ``R factor U^speed G^material W^load``, with a warning outside of its regime."""
    warn_outside_elastic_piezoviscous(groups, name)
    film = factor * groups.speed**speed * groups.material**material * groups.load**load
    return film * groups.equivalent_radius


@film_formula
def dowson_1968_minimum(groups: Groups) -> Array:
    """Minimum film: ``h/R = 2.65 U^0.7 G^0.54 W^-0.13``.

    Warns
    -----
    ModelWarning
        Code ``film-range`` clearly outside of the elastic-piezoviscous regime.

    Within 0.4 % of the solved film of a gear contact at 0.8 GPa, 5 % high at 0.46 GPa.
    Source: Dowson (1968), revising Dowson and Higginson (1966).

    Examples
    --------
    >>> film = dowson_1968_minimum(147802.0, 8e-3, 3.0722, 0.082, 2.19e-8, 2.2e11)
    >>> round(float(film) * 1e6, 4)
    0.8994
    """
    return _power_law("dowson-1968", groups, 2.65, 0.7, 0.54, -0.13)


@film_formula
def dowson_toyoda_central(groups: Groups) -> Array:
    """Central film: ``h/R = 3.06 U^0.69 G^0.56 W^-0.10``.

    Warns
    -----
    ModelWarning
        Code ``film-range`` clearly outside of the elastic-piezoviscous regime.

    14 % above the solved film of a gear contact at 0.46 and 0.8 GPa.
    Source: Dowson and Toyoda (1979).

    Examples
    --------
    >>> film = dowson_toyoda_central(147802.0, 8e-3, 3.0722, 0.082, 2.19e-8, 2.2e11)
    >>> round(float(film) * 1e6, 4)
    1.1648
    """
    return _power_law("dowson-toyoda", groups, 3.06, 0.69, 0.56, -0.1)


@film_formula
def pan_hamrock_minimum(groups: Groups) -> Array:
    """Minimum film: ``h/R = 1.714 U^0.694 G^0.568 W^-0.128``.

    Warns
    -----
    ModelWarning
        Code ``film-range`` clearly outside of the elastic-piezoviscous regime.

    4 to 7 % below the solved film of a gear contact at 0.46 to 0.8 GPa.
    Source: Pan and Hamrock (1989).

    Examples
    --------
    >>> film = pan_hamrock_minimum(147802.0, 8e-3, 3.0722, 0.082, 2.19e-8, 2.2e11)
    >>> round(float(film) * 1e6, 4)
    0.8294
    """
    return _power_law("pan-hamrock", groups, 1.714, 0.694, 0.568, -0.128)


@film_formula
def pan_hamrock_central(groups: Groups) -> Array:
    """Central film: ``h/R = 2.922 U^0.692 G^0.470 W^-0.166``.

    Warns
    -----
    ModelWarning
        Code ``film-range`` clearly outside of the elastic-piezoviscous regime.

    3 to 10 % below the solved film of a gear contact at 0.46 to 0.8 GPa.
    Source: Pan and Hamrock (1989).

    Examples
    --------
    >>> film = pan_hamrock_central(147802.0, 8e-3, 3.0722, 0.082, 2.19e-8, 2.2e11)
    >>> round(float(film) * 1e6, 4)
    0.9206
    """
    return _power_law("pan-hamrock", groups, 2.922, 0.692, 0.47, -0.166)


def hamrock_dowson_minimum(
    normal_force: ArrayLike,
    equivalent_radius: ArrayLike,
    side_radius: ArrayLike,
    entrainment_speed: ArrayLike,
    dynamic_viscosity: ArrayLike,
    pressure_viscosity_coefficient: ArrayLike,
    effective_modulus: ArrayLike,
) -> Array:
    """Minimum film of an elliptical contact: ``3.63 U^0.68 G^0.49 W^-0.073 (1 - exp(-0.68 k))``.

    Parameters
    ----------
    normal_force : float or array [N]
        Load of the contact.
    equivalent_radius : float or array [m]
        Radius of the gap along the entrainment.
    side_radius : float or array [m]
        Radius of the gap across it; infinite for a line.
    entrainment_speed : float or array [m/s]
        HALF the sum of the surface speeds.
    dynamic_viscosity : float or array [Pa*s]
        Viscosity at ambient pressure.
    pressure_viscosity_coefficient : float or array [1/Pa]
        Slope of ln(viscosity) over pressure.
    effective_modulus : float or array [Pa]
        ``2/E' = (1-nu1^2)/E1 + (1-nu2^2)/E2``.

    Returns
    -------
    float or array [m]
        Film thickness, of the common shape of the arguments.

    Raises
    ------
    InputError
        If a value is not positive, or not finite; the side radius may be infinite.

    Notes
    -----
    ``U = eta u / (E' R)``, ``G = alpha E'``, ``W = F / (E' R^2)`` and the ellipticity
    ``k = 1.03 (R_side / R)^0.64``. The film is that of flooded, isothermal, smooth contacts in the
    elastic-piezoviscous regime. Source: Hamrock and Dowson, Trans. ASME J. Lubr. Technol. 99
    (1977), 264-276; ellipticity by Brewe and Hamrock (1977).

    Examples
    --------
    >>> film = hamrock_dowson_minimum(5000.0, 0.03, 0.5, 5.0, 0.01, 2e-8, 2.2637e11)
    >>> f"{float(film):.5e}"
    '3.87441e-07'
    """
    groups = ellipse_groups(
        normal_force, equivalent_radius, side_radius, entrainment_speed, dynamic_viscosity,
        pressure_viscosity_coefficient, effective_modulus,
    )  # fmt: skip
    speed, material, load, ellipticity, radius = groups
    ends = 1.0 - np.exp(-0.68 * ellipticity)
    return np.asarray(3.63 * speed**0.68 * material**0.49 * load**-0.073 * ends * radius)[()]


def ellipse_groups(
    normal_force: ArrayLike,
    equivalent_radius: ArrayLike,
    side_radius: ArrayLike,
    entrainment_speed: ArrayLike,
    dynamic_viscosity: ArrayLike,
    pressure_viscosity_coefficient: ArrayLike,
    effective_modulus: ArrayLike,
) -> tuple[Array, Array, Array, Array, Array]:
    """Groups U, G, W of Hamrock and Dowson, the ellipticity k, and the checked radius [m]."""
    force, radius, speed, viscosity, coefficient, modulus = positive(
        normal_force=normal_force,
        equivalent_radius=equivalent_radius,
        entrainment_speed=entrainment_speed,
        dynamic_viscosity=dynamic_viscosity,
        pressure_viscosity_coefficient=pressure_viscosity_coefficient,
        effective_modulus=effective_modulus,
    )
    side = real_numbers(Argument("side_radius"), side_radius)
    require_between("side_radius", np.minimum(side, 1e9), 1e-12, 1e9, "m")
    moving = viscosity * speed / (modulus * radius)
    loaded = force / (modulus * radius**2)
    return moving, coefficient * modulus, loaded, 1.03 * (side / radius) ** 0.64, radius
