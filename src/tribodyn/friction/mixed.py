"""Mixed friction: film and asperities carry the load at one gap; the film by formula or solved."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from tribodyn.ehl import Asperities, FilmState, RoughnessProfile, balanced_load_share
from tribodyn.errors import Argument, InputError, warn
from tribodyn.friction.base import LAWS, FrictionParts, TribologicalContact
from tribodyn.friction.ehl import SHEAR_OPTIONS, ehl
from tribodyn.friction.mixed_ehl import BOUNDARY, FILM, friction_of_film, shared_friction
from tribodyn.model import Option, file_path, number
from tribodyn.types import Array

#: Options of the asperities.
_ASPERITIES: dict[str, Option] = {
    "boundary_friction_coefficient": BOUNDARY,
    "rms_slope": number(0.1, 0.005, 2.0, "from lapped to turned flanks", of="rms_slope"),
    "summit_density": number(
        None,
        1e6,
        1e14,
        "guards against a wrong unit",
        of="summit_density",
        basis="summit density times summit radius times composite roughness of 0.05",
    ),
    "roughness_profile": file_path(
        meaning="CSV file with a measured profile of the flanks, for its height, slope and summits",
        example='"profile.csv"',
    ),
}


#: Relative difference of the rms heights of profile and case above which a warning is issued.
_LIKE = 0.1


def _asperities_of(
    roughness: float, rms_slope: float, summit_density: float | None, profile: str | None
) -> Asperities | None:
    """Asperities of two equal flanks; None where they are smooth."""
    if profile is None and not roughness:
        return None
    try:
        if profile is None:
            return Asperities.from_slope(roughness, rms_slope, summit_density)
        measured = Asperities.from_profiles(RoughnessProfile.read(profile))
    except InputError as error:
        where = Argument("rms_slope" if profile is None else "roughness_profile")
        raise InputError([replace(each, where=where) for each in error.problems]) from None
    if abs(measured.rms_height - roughness) > _LIKE * measured.rms_height:
        warn(
            "roughness-differs",
            f"two flanks with the profile {Path(profile).name} have a composite rms roughness of "
            f"{measured.rms_height * 1e6:.4g} um, the film ratio is formed with "
            f"{roughness * 1e6:.4g} um. Give roughness_rms = "
            f'"{measured.rms_height * 1e6 / np.sqrt(2.0):.4g} um" to both gears',
            stacklevel=4,
        )
    return measured


def _load_share(contact: TribologicalContact, asperities: Asperities | None) -> tuple[Array, Array]:
    """Load share of the film of each contact, and the gap [m]."""
    central = contact.central_film
    film = np.asarray(contact.require("film_thickness") if central is None else central)
    if asperities is None:
        return np.ones(film.shape), film
    pressure = contact.hertz_pressure
    # Load, radius and pressure of Hertz tell the modulus.
    modulus = 2.0 * np.pi * contact.equivalent_radius * pressure**2 / contact.load_per_width
    return balanced_load_share(film, pressure, modulus, asperities)


def mixed(
    contact: TribologicalContact,
    *,
    boundary_friction_coefficient: float = 0.15,
    rms_slope: float = 0.1,
    summit_density: float | None = None,
    roughness_profile: str | None = None,
    ehl_friction_coefficient: float | None = None,
) -> FrictionParts:
    """Friction of a film and asperities that carry the load together at one gap.

    ``mu = mu_EHL f^1.2 + mu_b (1 - f)`` with the share f of
    :func:`tribodyn.ehl.balanced_load_share`.

    Parameters
    ----------
    contact : TribologicalContact
        Loaded contacts with their ``central_film`` or ``film_thickness``.
    boundary_friction_coefficient : float
        Coefficient of the asperities, 0.1 to 0.15.
    rms_slope : float
        Root mean square slope of a profile of one flank.
    summit_density : float, optional [1/m^2]
        Summits of one flank per area; by default as of
        :meth:`tribodyn.ehl.Asperities.from_slope`.
    roughness_profile : str, optional
        Path of a measured profile of a flank, see :meth:`tribodyn.ehl.RoughnessProfile.read`: it
        replaces all three.
    ehl_friction_coefficient : float, optional
        Coefficient of the film alone; by default that of :func:`tribodyn.friction.xu_2007`
        for smooth flanks, because asperities are counted apart.

    Returns
    -------
    FrictionParts
        Arrays of the shape of ``contact.load_per_width``; smooth flanks have no asperities.

    Raises
    ------
    InputError
        If the film is not known, heights, slope and summits do not belong together, or the
        profile cannot be read.

    Warns
    -----
    ModelWarning
        Code ``friction-range`` of the formula of the film, and where the coefficient of the
        asperities lies outside of 0.1 to 0.15; code ``roughness-differs`` where the profile has
        another height than the composite roughness.

    Elastic asperities of equal flanks. Source: Johnson, Greenwood and Poon, Wear 19 (1972);
    Greenwood and Tripp, Proc. IMechE 185 (1970); powers of f: Castro and Seabra (2007).

    Examples
    --------
    >>> one = np.ones(1)
    >>> contact = TribologicalContact(
    ...     1e5 * one, 8e8 * one, one, 2 * one, one / 2, 8e-3 * one, 0.08, 7e-7,
    ...     film_thickness=3e-7 * one,
    ... )
    >>> parts = mixed(contact)
    >>> print(np.round(parts.film_load_share, 3), np.round(parts.coefficient, 4))
    [0.697] [0.0751]
    """
    asperities = _asperities_of(
        contact.composite_roughness, rms_slope, summit_density, roughness_profile
    )
    share, _ = _load_share(contact, asperities)
    film = friction_of_film(contact, 0.0, ehl_friction_coefficient)
    return shared_friction(share, film, boundary_friction_coefficient)


LAWS.define(
    "mixed",
    source="Johnson, Greenwood and Poon (1972); Greenwood and Tripp (1970); film: Xu et al. (2007)",
    meaning="film and asperities carry the load together at one gap, each with its friction",
    options={**_ASPERITIES, "ehl_friction_coefficient": FILM},
    papers=("johnson-greenwood-poon", "greenwood-tripp", "mccool", "castro-seabra", "xu"),
    asperities=True,
)(mixed)


def mixed_solved(
    contact: TribologicalContact,
    *,
    boundary_friction_coefficient: float = 0.15,
    rms_slope: float = 0.1,
    summit_density: float | None = None,
    roughness_profile: str | None = None,
    **shear: Any,
) -> FrictionParts:
    """Friction as of :func:`mixed`, with the solved film sheared under its own part of the load.

    Parameters
    ----------
    contact : TribologicalContact
        Loaded contacts with their ``film``.
    boundary_friction_coefficient, rms_slope
        As there.
    summit_density : float, optional [1/m^2]
        As there.
    roughness_profile : str, optional
        As there.
    **shear : object
        Options of :func:`tribodyn.friction.ehl`, such as ``eyring_stress``.

    Raises
    ------
    InputError
        As there, and as the law ``ehl``.

    Warns
    -----
    ModelWarning
        As the law ``ehl``.

    The film has its pressure times f, at the gap of the balance; the heat of the asperities does
    not warm it. Source: as there, and Johnson and Tevaarwerk (1977).

    Examples
    --------
    >>> from tribodyn.lubricant import from_library
    >>> x = np.linspace(-1e-4, 1e-4, 401)
    >>> pressure = 0.8e9 * np.sqrt(1 - (x / 1e-4) ** 2)
    >>> film = FilmState(x, pressure, 3e-7 * np.ones(401), from_library("80W"), 2.2e11)
    >>> load = 0.5 * np.pi * 1e-4 * 0.8e9 * np.ones(1)
    >>> one = np.ones(1)
    >>> contact = TribologicalContact(
    ...     load, 8e8 * one, one / 2, 2 * one, one / 4, 8e-3 * one, 0.08, 7e-7, film
    ... )
    >>> parts = mixed_solved(contact)
    >>> print(np.round(parts.film, 3), np.round(parts.asperities, 3))
    [0.038] [0.037]
    """
    film: FilmState = contact.require("film")
    central = film.central_film[film.contacts].reshape(contact.load_per_width.shape)
    asperities = _asperities_of(
        contact.composite_roughness, rms_slope, summit_density, roughness_profile
    )
    share, gap = _load_share(replace(contact, central_film=central), asperities)
    oil = ehl(replace(contact, film=_lighter(film, share, gap / central)), **shear)
    return FrictionParts(oil, boundary_friction_coefficient * (1.0 - share), share)


LAWS.define(
    "mixed-solved",
    source="Johnson, Greenwood and Poon (1972); Greenwood and Tripp (1970); film: as the law ehl",
    meaning="as mixed, with the shear stress of the solved film under its own part of the load",
    options={**_ASPERITIES, **{n: o for n, o in SHEAR_OPTIONS.items() if n != "rolling"}},
    needs_film=True,
    rehearsal="mixed",
    asperities=True,
    papers=("johnson-greenwood-poon", "greenwood-tripp", "mccool", "johnson-tevaarwerk"),
)(mixed_solved)


def _lighter(film: FilmState, share: Array, growth: Array) -> FilmState:
    """Films with their part of the load: pressures of the same shape, thickness that has grown."""
    part, grown = np.ones(film.films), np.ones(film.films)
    part[film.contacts], grown[film.contacts] = np.ravel(share), np.ravel(growth)
    pressure = film.pressure * part[:, None]
    return replace(film, pressure=pressure, film_thickness=film.film_thickness * grown[:, None])
