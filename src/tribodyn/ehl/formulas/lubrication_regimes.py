"""Which of the four regimes a line contact lies in, after the survey diagram of Moes."""

from __future__ import annotations

import numpy as np

from tribodyn.ehl.formulas.dimensionless_groups import Groups
from tribodyn.errors import warn
from tribodyn.types import Array

#: The rigid asymptote is left gradually; below this part of the elastic one the film formulas of
#: the elastic regime exceed the film that the piezoviscous oil can build between rigid bodies.
_RIGID_SHARE = 1.0 / 1.5


def rigid_isoviscous(load: Array) -> Array:
    """Film where neither the bodies yield nor the oil thickens.

    Parameters
    ----------
    load : array
        Load number M of Moes.

    Returns
    -------
    array
        ``H_Moes = 3/M``. Source: Moes (1965), after Martin and Guembel.

    Examples
    --------
    >>> float(rigid_isoviscous(np.array(0.1)))
    30.0
    """
    return np.asarray(3.0 / load)


def elastic_isoviscous(load: Array) -> Array:
    """Film where the bodies yield and the oil does not thicken.

    Parameters
    ----------
    load : array
        Load number M of Moes.

    Returns
    -------
    array
        ``H_Moes = 2.621 M^(-1/5)``, 5 % above the numerical asymptote. Source: Moes (1965),
        after Herrebrugh.

    Examples
    --------
    >>> float(elastic_isoviscous(np.array(1.0)))
    2.621
    """
    return np.asarray(2.621 * load**-0.2)


def rigid_piezoviscous(material: Array) -> Array:
    """Film where the oil thickens and the bodies do not yield.

    Parameters
    ----------
    material : array
        Material number L of Moes.

    Returns
    -------
    array
        ``H_Moes = 1.287 L^(2/3)``. Source: Moes (1965), after Blok.

    Examples
    --------
    >>> round(float(rigid_piezoviscous(np.array(8.0))), 3)
    5.148
    """
    return np.asarray(1.287 * material ** (2.0 / 3.0))


def elastic_piezoviscous(load: Array, material: Array) -> Array:
    """Film where the bodies yield and the oil thickens: the regime of gears.

    Parameters
    ----------
    load, material : array
        Load number M and material number L of Moes.

    Returns
    -------
    array
        ``H_Moes = 1.311 M^(-1/8) L^(3/4)``. Source: Moes (1965), after Grubin.

    Examples
    --------
    >>> float(elastic_piezoviscous(np.array(1.0), np.array(16.0)))
    10.488
    """
    return np.asarray(1.311 * load**-0.125 * material**0.75)


def warn_outside_elastic_piezoviscous(groups: Groups, formula: str) -> None:
    """Warn once if a formula of the elastic-piezoviscous regime is used clearly outside of it.

    Parameters
    ----------
    groups : Groups
        Groups of the contacts.
    formula : str
        Name of the formula, for the message.

    Warns
    -----
    ModelWarning
        Code ``film-range``: where an isoviscous asymptote gives the greater film, or the rigid
        one less than two thirds of the elastic one.

    Source: survey diagram of Moes (1965).

    Examples
    --------
    >>> groups = Groups(np.array(1e-11), np.array(5000.0), np.array(1e-4), np.array(0.01))
    >>> warn_outside_elastic_piezoviscous(groups, "dowson-1968")
    """
    load, material = groups.moes_load, groups.moes_material
    elastic = elastic_piezoviscous(load, material)
    rigid = rigid_piezoviscous(material)
    isoviscous = np.maximum(rigid_isoviscous(load), elastic_isoviscous(load))
    outside = (isoviscous > np.minimum(elastic, rigid)) | (rigid < _RIGID_SHARE * elastic)
    if not np.any(outside):
        return
    low, high = np.min(load[outside]), np.max(load[outside])
    warn(
        "film-range",
        f"{formula} holds in the elastic-piezoviscous regime; {np.count_nonzero(outside)} of "
        f"{outside.size} contacts with a Moes load number M from {low:.3g} to {high:.3g} and a "
        f"material number L down to {np.min(material[outside]):.3g} lie outside, where the "
        "survey diagram of Moes puts another asymptote, and the film can be wrong by more than "
        '20 %. Use the film model "moes", which covers all regimes.',
        stacklevel=6,
    )
