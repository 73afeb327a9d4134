"""Mixed friction: film and asperities share the load by the film ratio, or by Matsumoto."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.ehl import film_load_share
from tribodyn.errors import require_between, require_positive
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


#: Sum of the maximum heights of both flanks over their composite rms roughness: Rz = 6 Ra as
#: ISO 6336-2 has it, heights Gaussian and both flanks equal.
_HEIGHTS_OF_COMPOSITE = 12.0 / np.sqrt(np.pi)


def matsumoto(
    film_thickness: ArrayLike,
    maximum_heights: ArrayLike,
    film_friction_coefficient: ArrayLike,
    boundary_friction_coefficient: ArrayLike = 0.15,
) -> Array:
    """Friction coefficient of mixed lubrication with the load share of Matsumoto.

    ``mu = mu_f (1 - a) + mu_b a`` with the share ``a = 0.5 log10(D)`` of the asperities, from 0 at
    D = 1 to 1 at D = 100, and D the maximum heights over the film.

    Parameters
    ----------
    film_thickness : float or array [m]
        Minimum film.
    maximum_heights : float or array [m]
        Sum of the maximum heights Rz of both flanks.
    film_friction_coefficient : float or array
        Coefficient of the film alone.
    boundary_friction_coefficient : float or array
        Coefficient of the asperities.

    Returns
    -------
    float or array
        Friction coefficient, of the common shape of the arguments.

    Raises
    ------
    InputError
        If a height is negative, the film not positive, or a coefficient outside of 0 to 1.

    Warns
    -----
    ModelWarning
        Code ``friction-range`` where D exceeds 100: there is no film any more.

    Source: Matsumoto and Morikawa, Int. Gear Conf. Lyon (2014). Their friction of the film is a
    model of its own; here any may be given. Of 0.5 log10(D) no second source was found: their
    abstract mentions a function of the maximum heights over the minimum film.

    Examples
    --------
    >>> round(float(matsumoto(0.5e-6, 5e-6, 0.03, 0.12)), 4)  # D = 10: half and half
    0.075
    """
    return _parts(
        film_thickness, maximum_heights, film_friction_coefficient, boundary_friction_coefficient
    ).coefficient[()]


def _parts(
    film_thickness: ArrayLike,
    maximum_heights: ArrayLike,
    film_friction_coefficient: ArrayLike,
    boundary_friction_coefficient: ArrayLike,
) -> FrictionParts:
    require_positive("film_thickness", film_thickness, "m")
    require_between("maximum_heights", maximum_heights, 0.0, np.inf, "m")
    require_between("film_friction_coefficient", film_friction_coefficient, 0.0, 1.0)
    require_between("boundary_friction_coefficient", boundary_friction_coefficient, 0.0, 1.0)
    ratio = np.asarray(maximum_heights, dtype=float) / np.asarray(film_thickness, dtype=float)
    warn_outside(
        "matsumoto",
        (Range("heights over film", ratio, 0.0, 100.0),),
        "Asperities carry the whole load there.",
    )
    share = 0.5 * np.log10(np.clip(ratio, 1.0, 100.0))
    film = np.asarray(film_friction_coefficient, dtype=float)
    boundary = np.asarray(boundary_friction_coefficient, dtype=float)
    return FrictionParts(film * (1.0 - share), boundary * share, 1.0 - share)


@LAWS.define(
    "matsumoto",
    source="Matsumoto and Morikawa, Int. Gear Conf. Lyon (2014); film: Xu et al. (2007)",
    meaning="film and asperities share the load by the logarithm of roughness over film",
    options={
        "boundary_friction_coefficient": BOUNDARY,
        "film_friction_coefficient": FILM,
        "maximum_heights": number(
            None,
            1e-9,
            1e-3,
            "guards against a wrong unit",
            unit="m",
            display_unit="um",
            meaning="sum of the maximum heights Rz of both flanks",
            example='"4 um"',
            basis="6.77 times the composite rms roughness: Rz = 6 Ra, Gaussian heights",
        ),
    },
    papers=("matsumoto-morikawa", "xu"),
)
def _matsumoto(
    contact: TribologicalContact,
    *,
    boundary_friction_coefficient: float,
    film_friction_coefficient: float | None,
    maximum_heights: float | None,
) -> FrictionParts:
    film = friction_of_film(contact, 0.0, film_friction_coefficient)
    heights = maximum_heights
    if heights is None:
        heights = _HEIGHTS_OF_COMPOSITE * contact.composite_roughness
    thickness = contact.require("film_thickness")
    return _parts(thickness, heights, film, boundary_friction_coefficient)
