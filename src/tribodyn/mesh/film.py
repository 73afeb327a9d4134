"""Oil film columns of the mesh table: central and minimum film, film ratio."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tribodyn.contact import effective_modulus
from tribodyn.ehl import FILM_MODELS
from tribodyn.friction import TribologicalContact
from tribodyn.gear import Material
from tribodyn.lubricant import Lubricant

__all__ = ["film_columns"]

FloatArray = NDArray[np.float64]


def film_columns(
    film_model: str, contact: TribologicalContact, material: Material, lubricant: Lubricant
) -> dict[str, FloatArray]:
    """Films of the loaded contacts, as far as the model gives them.

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

    Returns
    -------
    dict of str to array
        ``central_film`` and ``minimum_film`` [m] where the model has them, and ``film_ratio``,
        the smallest film known over the composite roughness where there is one. Empty for the
        model ``none``.

    Raises
    ------
    InputError
        If the model is unknown.

    Notes
    -----
    Range and source: those of the chosen formula.

    Examples
    --------
    >>> one = np.ones(1)
    >>> contact = TribologicalContact(
    ...     1e5 * one, 8e8 * one, one, 2 * one, one / 2, 8e-3 * one, 0.08, 5e-7
    ... )
    >>> list(film_columns("moes", contact, Material(), Lubricant(0.08, 880.0, 2e-8)))
    ['central_film', 'film_ratio']
    """
    model = FILM_MODELS[film_model]
    arguments = (
        contact.load_per_width,
        contact.equivalent_radius,
        contact.entrainment_speed,
        lubricant.dynamic_viscosity,
        lubricant.pressure_viscosity_coefficient,
        effective_modulus(material, material),
    )
    formulas = {"central_film": model.central, "minimum_film": model.minimum}
    films = {name: film(*arguments) for name, film in formulas.items() if film is not None}
    if films and contact.composite_roughness > 0.0:
        films["film_ratio"] = np.min(list(films.values()), axis=0) / contact.composite_roughness
    return films
