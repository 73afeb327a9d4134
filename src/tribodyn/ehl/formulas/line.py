"""Films of line contacts by formulas: products of powers, and Moes over all regimes."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.ehl.formulas.dimensionless_groups import (
    Groups,
    elastic_isoviscous,
    elastic_piezoviscous,
    film_formula,
    rigid_isoviscous,
    rigid_piezoviscous,
    warn_outside_elastic_piezoviscous,
)
from tribodyn.errors import require_positive
from tribodyn.types import Array, Numbers


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


def moes_dimensionless_central(load: ArrayLike, material: ArrayLike) -> Array:
    """Central film in the numbers of Moes, joining the four asymptotes.

    ``H = [(RI^(7/3) + EI^(7/3))^(3s/7) + (RP^(-7/2) + EP^(-7/2))^(-2s/7)]^(1/s)`` with
    ``s = (7 + 8 exp(-2 EI/RI))/5``.

    Parameters
    ----------
    load : float or array [-]
        Load number M.
    material : float or array [-]
        Material number L.

    Returns
    -------
    float or array
        ``H_Moes = (h/R) (2 U)^(-1/2)``, of the common shape of the arguments.

    Raises
    ------
    InputError
        If a number is not finite and positive.

    Valid in all four regimes, for an incompressible oil. Source: Moes (1965, 2000).

    Examples
    --------
    >>> round(float(moes_dimensionless_central(5.0, 5.0)), 3)
    4.105
    """
    require_positive("load", load)
    require_positive("material", material)
    loads, materials = np.asarray(load, dtype=float), np.asarray(material, dtype=float)
    thin = rigid_isoviscous(loads), elastic_isoviscous(loads)
    thick = rigid_piezoviscous(materials), elastic_piezoviscous(loads, materials)
    return np.asarray(blended(*thin, *thick))[()]


def isoviscous(rigid: Numbers, elastic: Numbers) -> Any:
    """Film between its asymptotes where pressure thickens no oil."""
    return (rigid ** (7 / 3) + elastic ** (7 / 3)) ** (3 / 7)


def blended(rigid: Numbers, elastic: Numbers, rigid_thick: Numbers, elastic_thick: Numbers) -> Any:
    """Film between its four asymptotes, isoviscous and piezoviscous."""
    s = (7.0 + 8.0 * np.exp(-2.0 * elastic / rigid)) / 5.0
    piezoviscous = (rigid_thick**-3.5 + elastic_thick**-3.5) ** (-2 / 7)
    return (isoviscous(rigid, elastic) ** s + piezoviscous**s) ** (1.0 / s)


@film_formula
def moes_central(groups: Groups) -> Array:
    """Central film: see :func:`moes_dimensionless_central`.

    Valid in all regimes; incompressible, hence 12 to 16 % above the solved film of a
    compressible oil in a gear contact at 0.46 to 0.8 GPa.
    Source: Moes (1965, 2000).

    Examples
    --------
    >>> film = moes_central(147802.0, 8e-3, 3.0722, 0.082, 2.19e-8, 2.2e11)
    >>> round(float(film) * 1e6, 4)
    1.1853
    """
    film = moes_dimensionless_central(groups.moes_load, groups.moes_material)
    return film * groups.moes_film_unit


@film_formula
def moes_load_exponent(groups: Groups) -> Array:
    """Slope ``d ln(h)/d ln(w)`` of the central film of :func:`tribodyn.ehl.moes_central`.

    Returns
    -------
    float or array
        Between -1 (rigid, isoviscous) and 0 (rigid, piezoviscous), of the common shape of the
        arguments.

    Valid in all regimes. Source: derivative of the formula of Moes (1965, 2000).

    Examples
    --------
    >>> slope = moes_load_exponent(147802.0, 8e-3, 3.0722, 0.082, 2.19e-8, 2.2e11)
    >>> round(float(slope), 4)
    -0.0764
    """
    load, material = groups.moes_load, groups.moes_material
    rigid, elastic = rigid_isoviscous(load), elastic_isoviscous(load)
    rigid_thick, elastic_thick = rigid_piezoviscous(material), elastic_piezoviscous(load, material)
    # Both branches with their slopes over ln(M), then the exponent that joins them.
    parts = rigid ** (7 / 3), elastic ** (7 / 3)
    isoviscous = (parts[0] + parts[1]) ** (3 / 7)
    slope = -(parts[0] + 0.2 * parts[1]) / (parts[0] + parts[1])
    thick = rigid_thick**-3.5, elastic_thick**-3.5
    piezoviscous = (thick[0] + thick[1]) ** (-2 / 7)
    thick_slope = -0.125 * thick[1] / (thick[0] + thick[1])
    decay = np.exp(-2.0 * elastic / rigid)
    s = (7.0 + 8.0 * decay) / 5.0
    s_slope = -2.56 * elastic / rigid * decay
    weight = 1.0 / (1.0 + (piezoviscous / isoviscous) ** s)
    logarithm = weight * np.log(isoviscous) + (1.0 - weight) * np.log(piezoviscous)
    film = np.log(isoviscous**s + piezoviscous**s) / s
    joined = weight * slope + (1.0 - weight) * thick_slope
    return joined + s_slope / s * (logarithm - film)
