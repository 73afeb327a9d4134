"""Films of line contacts by formulas that are products of powers."""

from __future__ import annotations

from tribodyn.ehl.formulas.dimensionless_groups import (
    Groups,
    film_formula,
    warn_outside_elastic_piezoviscous,
)
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
