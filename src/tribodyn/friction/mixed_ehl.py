"""Mixed friction: an oil film and asperities share the load."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.ehl import film_load_share
from tribodyn.errors import require_between
from tribodyn.friction.base import LAWS, FrictionParts, Range, TribologicalContact, warn_outside
from tribodyn.friction.xu import xu_2007
from tribodyn.model import number
from tribodyn.types import Array


def mixed_ehl(
    film_ratio: ArrayLike,
    ehl_friction_coefficient: ArrayLike,
    boundary_friction_coefficient: ArrayLike = 0.15,
) -> Array:
    """Friction coefficient of a film and asperities that share the load.

    ``mu = mu_EHL f^1.2 + mu_b (1 - f)`` with the load share f of the film of
    :func:`tribodyn.ehl.film_load_share`.

    Parameters
    ----------
    film_ratio : float or array
        Minimum film over composite roughness; infinity over smooth flanks.
    ehl_friction_coefficient : float or array
        Coefficient of the film alone.
    boundary_friction_coefficient : float or array
        Coefficient of the asperities, 0.1 to 0.15.

    Returns
    -------
    float or array
        Friction coefficient, of the common shape of the arguments.

    Raises
    ------
    InputError
        If a value is negative or no number, or a coefficient above 1.

    Warns
    -----
    ModelWarning
        Code ``friction-range`` where the coefficient of the asperities lies outside of 0.1 to 0.15.

    Source: Castro and Seabra, Proc. IMechE J 221 (2007), with the load share of Zhu and Hu (2001).

    Examples
    --------
    >>> round(float(mixed_ehl(0.5, 0.05)), 4)
    0.0802
    >>> float(mixed_ehl(0.0, 0.05)), float(mixed_ehl(np.inf, 0.05))
    (0.15, 0.05)
    """
    return shared_friction(
        film_load_share(film_ratio), ehl_friction_coefficient, boundary_friction_coefficient
    ).coefficient[()]


def shared_friction(share: Array, film: ArrayLike, boundary: ArrayLike) -> FrictionParts:
    """Friction of a film that has this share of the load, and of asperities that have the rest."""
    require_between("ehl_friction_coefficient", film, 0.0, 1.0)
    require_between("boundary_friction_coefficient", boundary, 0.0, 1.0)
    limits = Range("boundary_friction_coefficient", np.asarray(boundary), 0.1, 0.15)
    warn_outside("mixed-ehl", (limits,), "Measure it, or take 0.1 to 0.15.")
    # The friction coefficient of a film rises with the power 0.2 of the load that it carries.
    return FrictionParts(np.asarray(film) * share**1.2, np.asarray(boundary) * (1.0 - share), share)


#: Option of the laws that add boundary friction.
BOUNDARY = number(
    0.15,
    0.0,
    1.0,
    "boundary films on steel have 0.1 to 0.15",
    of="friction_coefficient",
    meaning="friction coefficient of the asperities",
    example="0.12",
)
#: Option of the laws that take the friction of the film from elsewhere.
FILM = number(
    None,
    0.0,
    1.0,
    "lubricated steel lies below 0.2",
    of="friction_coefficient",
    meaning="friction coefficient of the film alone",
    basis="the law xu-2007 of the same contacts",
)


@LAWS.define(
    "mixed-ehl",
    source="Castro and Seabra (2007); Zhu and Hu (2001); film: Xu et al. (2007)",
    meaning="film and asperities share the load by the film ratio, each with its friction",
    options={"boundary_friction_coefficient": BOUNDARY, "ehl_friction_coefficient": FILM},
    papers=("castro-seabra", "zhu-hu", "xu"),
    asperities=True,
)
def _law(
    contact: TribologicalContact,
    *,
    boundary_friction_coefficient: float,
    ehl_friction_coefficient: float | None,
) -> FrictionParts:
    film = friction_of_film(contact, contact.composite_roughness, ehl_friction_coefficient)
    share = np.asarray(film_load_share(contact.film_ratio))
    return shared_friction(share, film, boundary_friction_coefficient)


def friction_of_film(
    contact: TribologicalContact, roughness: float, coefficient: float | None
) -> Array:
    """Friction of the film alone: as given, or by the regression of Xu."""
    if coefficient is not None:
        return np.full(np.shape(contact.load_per_width), coefficient)
    return xu_2007(
        contact.slide_to_roll_ratio,
        contact.hertz_pressure,
        contact.dynamic_viscosity,
        roughness,
        contact.entrainment_speed,
        contact.equivalent_radius,
    )
