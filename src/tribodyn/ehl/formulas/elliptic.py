"""Films of point and elliptical contacts: Nijenbanning and others, Hamrock and Dowson."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.ehl.formulas.dimensionless_groups import elsewhere, warn_of_regime
from tribodyn.errors import Argument, real_numbers, require_between, warn
from tribodyn.nomenclature import positive
from tribodyn.types import Array

#: Ratio of radii up to which the film formulas for ellipses are used, with a margin for rounding,
#: and the least for which the regime is judged.
_WIDEST, _NARROWEST = 1.05, 1e-3


def nijenbanning_dimensionless_central(
    load: ArrayLike, material: ArrayLike, radius_ratio: ArrayLike = 1.0
) -> Array:
    """Central film of an elliptical contact in the numbers of Moes, joining its asymptotes.

    ``H = [(RI^(3/2) + (EI^-4 + H0^-4)^(-3/8))^(2s/3) + (RP^-8 + EP^-8)^(-s/8)]^(1/s)`` with
    ``s = 3/2 (1 + exp(-1.2 EI/EP))``, ``H0 = 1.8/lambda``, the ratio of radii
    ``lambda = R_x/R_y`` and the asymptotes

    - ``RI = 145 (1 + 0.796 lambda^(14/15))^(-15/7) lambda^-1 M^-2``
    - ``RP = 1.29 (1 + 0.691 lambda)^(-2/3) L^(2/3)``
    - ``EI = 3.18 (1 + 0.006 ln lambda + 0.63 lambda^(4/7))^(-14/25) lambda^(-1/15) M^(-2/15)``
    - ``EP = 1.48 (1 + 0.006 ln lambda + 0.63 lambda^(4/7))^(-7/20) lambda^(-1/24) M^(-1/12)
      L^(3/4)``

    Parameters
    ----------
    load : float or array [-]
        Load number ``M = F/(E' R_x^2) (2U)^(-3/4)`` with ``U = eta0 u_e/(E' R_x)``.
    material : float or array [-]
        Material number ``L = alpha E' (2U)^(1/4)``, not negative.
    radius_ratio : float or array [-]
        Radius along the entrainment over that across it, up to 1.

    Returns
    -------
    float or array
        ``H = (h/R_x) (2U)^(-1/2)``, of the common shape of the arguments.

    Raises
    ------
    InputError
        If a number is not finite and positive (the material number may be zero).

    Warns
    -----
    ModelWarning
        Code ``film-range`` where the radius along the entrainment is the larger one.

    Valid for an incompressible oil. Source: Nijenbanning, Venner and Moes, Wear 176 (1994),
    217-229.

    Examples
    --------
    >>> round(float(nijenbanning_dimensionless_central(20.0, 10.0)), 3)
    4.265
    """
    load, ratio = positive(load=load, radius_ratio=radius_ratio)
    require_between("material", material, 0.0, np.inf)
    _warn_of_ratio("Nijenbanning", ratio, stacklevel=3)
    return nijenbanning_film(load, np.asarray(material, dtype=float), ratio)[()]


def ellipse_asymptotes(
    load: Array, material: Array, ratio: Array
) -> tuple[Array, Array, Array, Array]:
    """Films RI, EI, RP and EP in the numbers of Moes: rigid or elastic, iso- or piezoviscous."""
    thick = np.maximum(material, 1e-12)
    shape = 1.0 + 0.006 * np.log(ratio) + 0.63 * ratio ** (4 / 7)
    rigid = 145.0 * (1.0 + 0.796 * ratio ** (14 / 15)) ** (-15 / 7) / (ratio * load**2)
    rigid_thick = 1.29 * (1.0 + 0.691 * ratio) ** (-2 / 3) * thick ** (2 / 3)
    elastic = 3.18 * shape ** (-14 / 25) * ratio ** (-1 / 15) * load ** (-2 / 15)
    elastic_thick = 1.48 * shape ** (-7 / 20) * ratio ** (-1 / 24) * load ** (-1 / 12) * thick**0.75
    return rigid, elastic, rigid_thick, elastic_thick


def nijenbanning_film(load: Array, material: Array, ratio: Array) -> Array:
    """Film that joins the asymptotes, of checked numbers and without warnings."""
    rigid, elastic, rigid_thick, elastic_thick = ellipse_asymptotes(load, material, ratio)
    s = 1.5 * (1.0 + np.exp(-1.2 * elastic / elastic_thick))
    soft = (elastic**-4.0 + (1.8 / ratio) ** -4.0) ** (-3 / 8)
    isoviscous = (rigid**1.5 + soft) ** (2 / 3)
    piezoviscous = (rigid_thick**-8.0 + elastic_thick**-8.0) ** (-1 / 8)
    return np.asarray((isoviscous**s + piezoviscous**s) ** (1.0 / s))


def _warn_of_ratio(formula: str, ratio: Array, *, stacklevel: int) -> None:
    """Warn once (``film-range``) of contacts that are longer along the entrainment than across."""
    widest = float(np.max(ratio))
    if widest > _WIDEST:
        warn(
            "film-range",
            f"{formula} holds where the radius along the entrainment is not larger than that "
            f"across it; it is up to {widest:.3g} times as large. Solve the contact "
            "(tribodyn.ehl.solve_point_contact).",
            stacklevel=stacklevel,
        )


def nijenbanning_central(
    normal_force: ArrayLike,
    equivalent_radius: ArrayLike,
    side_radius: ArrayLike,
    entrainment_speed: ArrayLike,
    dynamic_viscosity: ArrayLike,
    pressure_viscosity_coefficient: ArrayLike,
    effective_modulus: ArrayLike,
) -> Array:
    """Central film of an elliptical contact: see :func:`nijenbanning_dimensionless_central`.

    Parameters
    ----------
    normal_force : float or array [N]
        As for :func:`tribodyn.ehl.hamrock_dowson_minimum`, as the others; the side radius is
        finite.
    equivalent_radius, side_radius : float or array [m]
    entrainment_speed : float or array [m/s]
    dynamic_viscosity : float or array [Pa*s]
    pressure_viscosity_coefficient : float or array [1/Pa]
    effective_modulus : float or array [Pa]

    Returns
    -------
    float or array [m]

    Raises
    ------
    InputError
        If a value is not finite and positive.

    Warns
    -----
    ModelWarning
        Code ``film-range`` where the radius along the entrainment is the larger one.

    Valid for an incompressible oil, with the smaller radius along the entrainment. Source:
    Nijenbanning, Venner and Moes, Wear 176 (1994), 217-229.

    Examples
    --------
    >>> film = nijenbanning_central(100.0, 0.01, 0.01, 1.0, 0.05, 2e-8, 2.2e11)
    >>> round(float(film) * 1e6, 4)
    0.2953
    """
    force, radius, side, speed, viscosity, coefficient, modulus = positive(**locals())
    viscous = 2.0 * viscosity * speed / (modulus * radius)
    load = force / (modulus * radius**2) * viscous**-0.75
    material = coefficient * modulus * viscous**0.25
    _warn_of_ratio("Nijenbanning", radius / side, stacklevel=3)
    film = nijenbanning_film(load, material, radius / side)
    return np.asarray(film * radius * np.sqrt(viscous))[()]


def hamrock_dowson_central(
    normal_force: ArrayLike,
    equivalent_radius: ArrayLike,
    side_radius: ArrayLike,
    entrainment_speed: ArrayLike,
    dynamic_viscosity: ArrayLike,
    pressure_viscosity_coefficient: ArrayLike,
    effective_modulus: ArrayLike,
) -> Array:
    """Central film of an ellipse: ``2.69 U^0.67 G^0.53 W^-0.067 (1 - 0.61 exp(-0.73 k))``.

    Parameters
    ----------
    normal_force : float or array [N]
        As for :func:`tribodyn.ehl.hamrock_dowson_minimum`, and so are the others.
    equivalent_radius, side_radius : float or array [m]
    entrainment_speed : float or array [m/s]
    dynamic_viscosity : float or array [Pa*s]
    pressure_viscosity_coefficient : float or array [1/Pa]
    effective_modulus : float or array [Pa]

    Returns
    -------
    float or array [m]

    Raises
    ------
    InputError
        If a value is not positive, or not finite; the side radius may be infinite.

    Warns
    -----
    ModelWarning
        Code ``film-range`` clearly outside of the elastic-piezoviscous regime, in which a side
        radius above a thousand times the other counts as that, and where the radius along the
        entrainment is the larger one.

    Groups and ellipticity ``k`` as for :func:`tribodyn.ehl.hamrock_dowson_minimum`, valid in the
    elastic-piezoviscous regime. Source: Hamrock and Dowson, Trans. ASME J. Lubr. Technol. 99
    (1977), 264-276.

    Examples
    --------
    >>> film = hamrock_dowson_central(5000.0, 0.03, 0.5, 5.0, 0.01, 2e-8, 2.2637e11)
    >>> f"{float(film):.5e}"
    '4.91422e-07'
    """
    groups = _ellipse_groups("Hamrock-Dowson central", **locals())
    speed, material, load, ellipticity, radius = groups
    ends = 1.0 - 0.61 * np.exp(-0.73 * ellipticity)
    return np.asarray(2.69 * speed**0.67 * material**0.53 * load**-0.067 * ends * radius)[()]


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

    Warns
    -----
    ModelWarning
        Code ``film-range`` clearly outside of the elastic-piezoviscous regime, in which a side
        radius above a thousand times the other counts as that, and where the radius along the
        entrainment is the larger one.

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
    groups = _ellipse_groups("Hamrock-Dowson minimum", **locals())
    speed, material, load, ellipticity, radius = groups
    ends = 1.0 - np.exp(-0.68 * ellipticity)
    return np.asarray(3.63 * speed**0.68 * material**0.49 * load**-0.073 * ends * radius)[()]


def _ellipse_groups(
    formula: str, side_radius: ArrayLike, **arguments: ArrayLike
) -> tuple[Array, Array, Array, Array, Array]:
    """Groups U, G, W of Hamrock and Dowson, the ellipticity k, and the checked radius [m]."""
    force, radius, speed, viscosity, coefficient, modulus = positive(**arguments)
    side = real_numbers(Argument("side_radius"), side_radius)
    require_between("side_radius", np.minimum(side, 1e9), 1e-12, 1e9, "m")
    moving = np.asarray(viscosity * speed / (modulus * radius))
    material, loaded = np.asarray(coefficient * modulus), np.asarray(force / (modulus * radius**2))
    _warn_of_ratio(formula, radius / side, stacklevel=4)
    numbers = loaded * (2.0 * moving) ** -0.75, material * (2.0 * moving) ** 0.25
    ratio = np.clip(radius / side, _NARROWEST, 1.0)
    load, thickening, ratio = np.broadcast_arrays(*numbers, ratio)
    rigid, elastic, rigid_thick, elastic_thick = ellipse_asymptotes(load, thickening, ratio)
    outside = elsewhere(np.maximum(rigid, elastic), rigid_thick, elastic_thick, elastic_thick)
    remedy = "Use tribodyn.ehl.nijenbanning_central, which covers all regimes."
    warn_of_regime(formula, outside, load, thickening, remedy, stacklevel=5)
    return moving, material, loaded, 1.03 * (side / radius) ** 0.64, radius
