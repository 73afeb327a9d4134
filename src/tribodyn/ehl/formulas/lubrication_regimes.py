"""Asymptotes of the film in the survey diagram of Moes (1965), over his numbers M and L."""

from __future__ import annotations

import numpy as np

from tribodyn.ehl.formulas.dimensionless_groups import Groups
from tribodyn.errors import warn
from tribodyn.types import Array

#: The rigid asymptote is left gradually; below this part of the elastic one the film formulas of
#: the elastic regime exceed the film that the piezoviscous oil can build between rigid bodies.
_RIGID_SHARE = 1.0 / 1.5


def rigid_isoviscous(load: Array) -> Array:
    """Film ``H_Moes = 3/M``: neither the bodies yield nor the oil thickens (Martin, Guembel)."""
    return np.asarray(3.0 / load)


def elastic_isoviscous(load: Array) -> Array:
    """Film ``2.621 M^(-1/5)``: the bodies yield (Herrebrugh); 5 % above its exact asymptote."""
    return np.asarray(2.621 * load**-0.2)


def rigid_piezoviscous(material: Array) -> Array:
    """Film ``1.287 L^(2/3)``: the oil thickens (Blok)."""
    return np.asarray(1.287 * material ** (2.0 / 3.0))


def elastic_piezoviscous(load: Array, material: Array) -> Array:
    """Film ``1.311 M^(-1/8) L^(3/4)``: both, the regime of gears (Grubin)."""
    return np.asarray(1.311 * load**-0.125 * material**0.75)


def warn_outside_elastic_piezoviscous(groups: Groups, formula: str) -> None:
    """Warn once (``film-range``) where the survey diagram puts the contact clearly elsewhere."""
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
