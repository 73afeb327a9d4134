"""A rough line contact: oil film and asperities carry its load together."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.checks import positive
from tribodyn.ehl.asperities import Asperities
from tribodyn.ehl.load_share import FILM_EXPONENT, balanced_load_share
from tribodyn.ehl.models import FILM_MODELS
from tribodyn.errors import ComputationError, InputError, quiet
from tribodyn.lubricant import Lubricant
from tribodyn.record import Record, fact, quantity, record
from tribodyn.types import Array

#: Least share for which a film is computed; below, it is extrapolated.
_LEAST = 1e-3
#: Bounds of that slope: rigid and isoviscous films have 1.
_SLOPES = (0.02, 1.5)
#: Most iterations, and change of the share at convergence.
_ROUNDS, _SETTLED = 30, 1e-9


@record
class MixedLineContact(Record):
    """Rough line contacts in which film and asperities share the load.

    Parameters
    ----------
    load_per_width : array (contacts,) [N/m]
        Whole normal load.
    film_load_share : array (contacts,)
        Part of it on the film.
    gap : array (contacts,) [m]
        Mean gap in the contact, volume of the oil over the area.
    smooth_film : array (contacts,) [m]
        Film in the centre of smooth flanks under the whole load.
    film_ratio : array (contacts,)
        Least film known of smooth flanks over the composite rms height.
    hertz_pressure : array (contacts,) [Pa]
        Greatest pressure of the dry smooth contact.
    half_width : array (contacts,) [m]
        Its half width, over which the asperities carry.
    film_model : str
        Model of the film.
    """

    load_per_width: Array = quantity("contact", unit="N/m")
    film_load_share: Array = quantity("contact")
    gap: Array = quantity("contact", of="film_thickness")
    smooth_film: Array = quantity("contact", of="central_film")
    film_ratio: Array = quantity("contact")
    hertz_pressure: Array = quantity("contact")
    half_width: Array = quantity("contact")
    film_model: str = fact()

    @property
    def film_load(self) -> Array:
        """Load of the film per width [N/m]."""
        return self.load_per_width * self.film_load_share

    @property
    def asperity_load(self) -> Array:
        """Load of the asperities per width [N/m]."""
        return self.load_per_width - self.film_load

    @property
    def asperity_pressure(self) -> Array:
        """Mean pressure of the asperities over the width of the contact [Pa]."""
        return np.asarray(self.asperity_load / (2.0 * self.half_width))


def mixed_line_contact(
    load_per_width: ArrayLike,
    equivalent_radius: ArrayLike,
    entrainment_speed: ArrayLike,
    lubricant: Lubricant,
    effective_modulus: float,
    asperities: Asperities,
    *,
    film_model: str = "dowson-higginson",
    **options: Any,
) -> MixedLineContact:
    """Share the load of rough line contacts among film and asperities, each at the same gap.

    The film is that of ``film_model`` under its own load ``f w`` with the modulus ``f E'``: so its
    pressure, a part f of the whole, meets flanks that the whole pressure bends.

    Parameters
    ----------
    load_per_width, equivalent_radius, entrainment_speed : float or array [N/m], [m], [m/s]
        Whole load, reduced radius, HALF the sum of the surface speeds; they broadcast.
    lubricant, effective_modulus : Lubricant, float [Pa]
        Oil, and ``2/E' = (1-nu1^2)/E1 + (1-nu2^2)/E2``.
    asperities : Asperities
        Of both flanks.
    film_model : str
        Name in :data:`tribodyn.ehl.FILM_MODELS`; a solved one is solved some ten times a contact.
    **options : object
        Options of that model, such as ``nodes``.

    Raises
    ------
    InputError
        If a value is not positive, the model unknown or without film.
    ComputationError
        If a film cannot be solved, or the shares do not settle.

    Films of less than a thousandth of the load keep the slope that they have there. Source:
    Johnson, Greenwood and Poon, Wear 19 (1972); Greenwood and Tripp (1970).

    Examples
    --------
    >>> flanks = Asperities.from_slope(0.7e-6, 0.1)
    >>> oil = Lubricant(0.03, 860.0, 1.8e-8)
    >>> contact = mixed_line_contact(1e5, 8e-3, [0.5, 3.0, 30.0], oil, 2.3e11, flanks)
    >>> contact.film_load_share.round(3)
    array([0.451, 0.904, 1.   ])
    """
    values = positive(
        load_per_width=load_per_width,
        equivalent_radius=equivalent_radius,
        entrainment_speed=entrainment_speed,
    )
    load, radius, speed = np.broadcast_arrays(*map(np.atleast_1d, values))
    model = FILM_MODELS[film_model]
    if load.ndim != 1 or film_model == "none":
        raise InputError(
            f'film_model = "{film_model}"' if load.ndim == 1 else f"arrays of {load.ndim} axes",
            "mixed_line_contact",
            "It needs a film model and arrays of contacts",
            'Use film_model = "moes" and arrays of one axis',
        )
    pressure = np.sqrt(load * effective_modulus / (2.0 * np.pi * radius))

    def films(share: Array) -> tuple[Array, Array]:
        """Central and minimum films, each under its part of the load."""
        part = np.maximum(share, _LEAST)
        state = part * load, radius, speed, part * effective_modulus
        columns: list[Any] = [*zip(*state, strict=True)] if model.method else [state]
        solved = [model.films(w, r, u, lubricant, e, **options) for w, r, u, e in columns]
        pairs = [[h for h in (f.central_film, f.minimum_film) if h is not None] for f in solved]
        central = np.array([pair[0] for pair in pairs]).reshape(load.shape)
        return central, np.array([np.min(pair, axis=0) for pair in pairs]).reshape(load.shape)

    smooth, least = films(np.ones(load.shape))
    share, gap = _settled(
        smooth,
        lambda share: films(share)[0],
        lambda film, slope: balanced_load_share(
            film, pressure, effective_modulus, asperities, film_exponent=slope
        ),
    )
    return MixedLineContact(
        load_per_width=load,
        film_load_share=share,
        gap=gap,
        smooth_film=smooth,
        film_ratio=least / asperities.rms_height,
        hertz_pressure=pressure,
        half_width=2.0 * load / (np.pi * pressure),
        film_model=film_model,
    )


def _settled(
    smooth: Array,
    film: Callable[[Array], Array],
    balance: Callable[[Array, Array], tuple[Array, Array]],
) -> tuple[Array, Array]:
    """Share and gap that the film has under its own share, by the secant of both logarithms."""
    slope, height, before = np.full(smooth.shape, FILM_EXPONENT), np.log(smooth), 0.0 * smooth
    share, gap = balance(smooth, slope)
    for _ in range(_ROUNDS):
        now = np.log(np.maximum(share, _LEAST))
        with quiet("film-range"):  # Warnings of a formula were issued for the total load.
            new = np.log(film(share))
        moved = np.abs(now - before) > 1e-9
        fall = -(new - height)[moved] / (now - before)[moved]
        slope[moved] = np.clip(fall, *_SLOPES)
        height, before, last = new, now, share
        share, gap = balance(np.exp(height + slope * now), slope)
        if np.max(np.abs(share - last)) < _SETTLED:
            return share, gap
    raise ComputationError(
        f"the load share still moves by {np.max(np.abs(share - last)):.2g} after {_ROUNDS} rounds",
        where="mixed_line_contact",
        why="The film does not fall with its load as films do",
        remedy="Use another film model",
    )
