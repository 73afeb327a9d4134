"""Oil film columns of the mesh table: films, their ratio to the roughness, pressure, stiffness."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

import numpy as np

from tribodyn.contact import effective_modulus
from tribodyn.ehl import FILM_MODELS
from tribodyn.ehl.steady.solved_films import Films
from tribodyn.friction import TribologicalContact
from tribodyn.gear import Material
from tribodyn.lubricant import Lubricant
from tribodyn.types import Array

_NO_OPTIONS: Mapping[str, Any] = MappingProxyType({})

#: Columns that a film model may fill.
FILM_COLUMNS = ("central_film", "minimum_film", "film_ratio", "film_pressure", "film_stiffness")


def film_columns(
    film_model: str,
    contact: TribologicalContact,
    material: Material,
    lubricant: Lubricant,
    *,
    common_face_width: float = 1.0,
    film_options: Mapping[str, Any] = _NO_OPTIONS,
) -> dict[str, Array]:
    """Films of the loaded contacts, as far as the model gives them; every contact on its own.

    Parameters
    ----------
    film_model : str
        Name in ``tribodyn.ehl.FILM_MODELS``.
    contact : TribologicalContact
        Loaded contacts.
    material : Material
        Material of both gears.
    lubricant : Lubricant
        Oil at working temperature.
    common_face_width : float [m]
        Length of the contact line, for the film stiffness.
    film_options : mapping
        Options of the film model.

    Returns
    -------
    dict of str to array
        ``central_film`` and ``minimum_film`` [m], ``film_pressure`` [Pa] and ``film_stiffness``
        [N/m] where the model has them, and ``film_ratio``, the smallest film known over the
        composite roughness where there is one. Empty for the model ``none``.

    Raises
    ------
    InputError
        If the model or an option is unknown.
    ComputationError
        If a contact cannot be solved.

    Notes
    -----
    Range and source: those of the chosen model.

    Examples
    --------
    >>> one = np.ones(1)
    >>> contact = TribologicalContact(
    ...     1e5 * one, 8e8 * one, one, 2 * one, one / 2, 8e-3 * one, 0.08, 5e-7
    ... )
    >>> list(film_columns("moes", contact, Material(), Lubricant(0.08, 880.0, 2e-8)))
    ['central_film', 'film_ratio', 'film_stiffness']
    """
    films = FILM_MODELS[film_model].films(
        contact.load_per_width,
        contact.equivalent_radius,
        contact.entrainment_speed,
        lubricant,
        effective_modulus(material, material),
        length=common_face_width,
        **film_options,
    )
    return as_columns(films, contact.composite_roughness)


def as_columns(films: Films, composite_roughness: float) -> dict[str, Array]:
    """Name the films as columns and add their ratio to the roughness."""
    known = {name: getattr(films, name, None) for name in FILM_COLUMNS}
    thin = [film for film in (films.central_film, films.minimum_film) if film is not None]
    if thin and composite_roughness > 0.0:
        known["film_ratio"] = np.min(thin, axis=0) / composite_roughness
    return {name: values for name, values in known.items() if values is not None}
