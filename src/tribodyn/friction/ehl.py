"""Friction of the solved oil film: its shear, with or without the heat that it makes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tribodyn.ehl.thermal.thermal_model import BodyHeat, ThermalModel
from tribodyn.ehl.traction.film_temperature import (
    film_temperature_rise,
    film_thermal_resistance,
    inlet_heating_factor,
    thermal_oil,
)
from tribodyn.ehl.traction.shear_models import EYRING, EYRING_STRESS, LIMIT, SHEAR_MODELS, THINNING
from tribodyn.ehl.traction.traction import FilmShear, FilmState
from tribodyn.errors import Argument, InputError, warn
from tribodyn.friction.base import LAWS, TribologicalContact
from tribodyn.model import choice, flag
from tribodyn.types import Array, ByName

_GREATEST = 0.2  # friction coefficient that lubricated steel hardly exceeds


def ehl(
    contact: TribologicalContact,
    *,
    shear_model: str = "ree-eyring",
    eyring_stress: float = EYRING_STRESS,
    inlet_heating: bool = False,
    flash_temperature: bool = False,
    rolling: bool = False,
    **oil: float | None,
) -> Array:
    """Friction coefficient of solved films: integral of their shear stress over the load.

    With ``flash_temperature`` the viscosity is that at the mean temperature of the film: inlet
    plus mean flash temperature of Blok plus ``q h/(12 k)`` across the oil, where the heat q is
    that of the friction itself. A heated film has its own viscosity, and takes neither option.

    Parameters
    ----------
    contact : TribologicalContact
        Loaded contacts with their ``film``.
    shear_model : str
        How the oil shears: a name of :data:`tribodyn.ehl.SHEAR_MODELS`.
    eyring_stress : float [Pa]
        Stress from which an oil thins, by the models that have it; 2 to 10 MPa for oils.
    inlet_heating : bool
        Thin the film by the heat made in the inlet.
    flash_temperature : bool
        Take the viscosity at the mean temperature of the film, between the ``bodies`` of the
        contact.
    rolling : bool
        Add the rolling traction, so that the coefficient is that on the faster surface.
    **oil : float
        Other numbers of the shear model, such as ``limiting_stress`` [Pa]; those not given, or
        None, have its defaults.

    Returns
    -------
    array
        Friction coefficient, never negative; without sliding zero, or the rolling part.

    Raises
    ------
    InputError
        If the contacts have no film, the oil lacks the thermal data that an option needs, a
        number does not belong to the shear model, or a heated film would be heated again.

    Warns
    -----
    ModelWarning
        Code ``friction-range`` where the coefficient exceeds 0.2; code ``film-range`` of a
        heated inlet.

    Valid for a full film: asperities are not counted. Source: Johnson and Tevaarwerk (1977), with
    the models of the single effects, each named in its function.

    Examples
    --------
    >>> from tribodyn.lubricant import from_library
    >>> x = np.linspace(-1e-4, 1e-4, 401)
    >>> pressure = 0.8e9 * np.sqrt(1 - (x / 1e-4) ** 2)
    >>> film = FilmState(x, pressure, 1e-6 * np.ones(401), from_library("80W"), 2.2e11)
    >>> load = 0.5 * np.pi * 1e-4 * 0.8e9 * np.ones(1)
    >>> one = np.ones(1)
    >>> contact = TribologicalContact(
    ...     load, 0.8e9 * one, 0.5 * one, 2.0 * one, 0.25 * one, 8e-3 * one, 0.082, 0.0, film
    ... )
    >>> print(np.round(ehl(contact), 4), np.round(ehl(contact, flash_temperature=True), 4))
    [0.044] [0.035]
    """
    film = contact.require("film")
    if film.heated is not None and (inlet_heating or flash_temperature):
        _refuse_heat("inlet_heating" if inlet_heating else "flash_temperature")
    speed = np.abs(np.ravel(contact.sliding_speed))
    factor = _film_factor(contact, film) if inlet_heating else None
    model = SHEAR_MODELS[shear_model]
    shear = FilmShear(film, model, model.complete(eyring_stress, oil), factor)
    rise = _temperature_rise(contact, shear, speed) if flash_temperature else None
    traction, _ = shear.sliding(speed, rise)
    if rolling:
        traction = traction + shear.rolling
    coefficient = traction / np.ravel(contact.load_per_width)
    _warn_of_solid(coefficient, shear_model)
    return coefficient.reshape(np.shape(contact.load_per_width))


def _refuse_heat(option: str) -> None:
    """Refuse a correction for heat that the film already contains."""
    what, why = f"{option} = true with a heated film", "its heat would count twice"
    raise InputError(what, Argument(option), why, f"Set {option} = false")


#: Change of film and traction from one pass to the next at which a contact of the path has
#: settled, a tenth of what interpolation along the path may err, and most passes.
_ALONG_PATH, _PASSES = 2e-3, 120
#: Options of a law that a heated film takes over.
_OF_SHEAR = ("eyring_stress", *LIMIT, *THINNING)


def film_heat(law: str, options: ByName, bodies: tuple[float, float]) -> ThermalModel:
    """Shear and bodies of a heated film: the shear of the friction law, if it shears the film."""
    shear, numbers = "ree-eyring", {}
    if LAWS[law].needs_film and "shear_model" in LAWS[law].options:
        chosen = LAWS[law].complete(options)
        shear = chosen["shear_model"]
        numbers = {name: chosen[name] for name in _OF_SHEAR if chosen.get(name) is not None}
    surfaces = BodyHeat(bodies[0]), BodyHeat(bodies[1])
    return ThermalModel(shear, numbers, surfaces, tolerance=_ALONG_PATH, passes=_PASSES)


def _film_factor(contact: TribologicalContact, film: FilmState) -> Array:
    oil = thermal_oil(film.lubricant)
    return np.ravel(
        inlet_heating_factor(
            contact.entrainment_speed,
            contact.slide_to_roll_ratio,
            contact.hertz_pressure,
            film.lubricant.dynamic_viscosity,
            oil.temperature_viscosity_coefficient,
            oil.thermal_conductivity,
            film.effective_modulus,
        )
    )


def _temperature_rise(contact: TribologicalContact, shear: FilmShear, speed: Array) -> Array:
    """Mean rise of the film temperature in each contact."""
    film = shear.film
    entrainment, half = np.ravel(contact.entrainment_speed), 0.5 * np.ravel(contact.sliding_speed)
    half_width = 2.0 * np.ravel(contact.load_per_width / contact.hertz_pressure) / np.pi
    thickness = film.central_film[film.contacts]
    resistance = film_thermal_resistance(
        half_width,
        thickness if shear.film_factor is None else thickness * shear.film_factor,
        entrainment + half,
        entrainment - half,
        thermal_oil(film.lubricant).thermal_conductivity,
        contact.bodies,
    )

    def heat(rise: Array) -> tuple[Array, Array]:
        traction, slope = shear.sliding(speed, rise)
        return speed * traction, speed * slope

    return film_temperature_rise(heat, resistance)


def _warn_of_solid(coefficient: Array, shear_model: str) -> None:
    """Say where the oil would have to be stronger than any oil is."""
    greatest = float(np.max(coefficient))
    if greatest > _GREATEST:
        if shear_model == "newtonian":
            remedy = 'Set friction.shear_model = "ree-eyring"'
        else:
            remedy = (
                "Give friction.limiting_stress_slope, lower the stress from which the oil thins, "
                "or set friction.flash_temperature = true"
            )
        warn(
            "friction-range",
            f"ehl: friction coefficient up to {greatest:.3g} with {shear_model} shear; oil films "
            f"stay below {_GREATEST:g}, because oil under pressure thins and yields. {remedy}.",
            stacklevel=4,
        )


#: Numbers of single shear models; those not given are the model's own.
_OWN = {
    name: replace(
        option, default=None, origin=f"{option.show(option.default)} if not given; {option.origin}"
    )
    for name, option in {**LIMIT, **THINNING}.items()
}
SHEAR_OPTIONS = {
    "shear_model": choice(
        "ree-eyring",
        {name: SHEAR_MODELS[name].meaning for name in sorted(SHEAR_MODELS)},
        meaning="how the oil film shears under the solved pressure",
    ),
    **EYRING,
    **_OWN,
    "inlet_heating": flag(False, meaning="thin the film by the heat that shear makes in the inlet"),
    "flash_temperature": flag(
        False, meaning="take the viscosity at the mean temperature of the film"
    ),
    "rolling": flag(False, meaning="add the rolling traction to the sliding one"),
}

LAWS.define(
    "ehl",
    source="Johnson and Tevaarwerk, Proc. R. Soc. A 356 (1977); Conry, Wang and Cusano (1987)",
    options=SHEAR_OPTIONS,
    needs_film=True,
    meaning="friction of the solved oil film: its shear stress summed over the contact",
    papers=("johnson-tevaarwerk", "conry-wang-cusano"),
)(ehl)
