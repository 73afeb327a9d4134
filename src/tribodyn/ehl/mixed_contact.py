"""How film and asperities of a rough contact share its load: by a fit, and by their balance."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.ehl.asperities import Asperities, asperity_integral
from tribodyn.ehl.models import FILM_MODELS
from tribodyn.errors import ComputationError, InputError, quiet, require_between, require_positive
from tribodyn.lubricant import Lubricant
from tribodyn.nomenclature import positive, require_one_shape
from tribodyn.record import Record, fact, quantity, record
from tribodyn.types import Array

_POWERS = (0.64, 1.26)
#: Film ratio at which the fit is greatest, 2.2576; constant beyond.
_HELD = (_POWERS[0] / (0.37 * (_POWERS[1] - _POWERS[0]))) ** (1.0 / _POWERS[1])
#: Lubrication regimes, and the film ratios at which mixed lubrication begins and ends.
REGIMES = ("boundary", "mixed", "full film")
REGIME_LIMITS = (0.2, 2.0)


def lubrication_regime(film_ratio: ArrayLike) -> Array:
    """Lubrication regime by the film ratio: 0 boundary, 1 mixed from 0.2 on, 2 full film from 2 on.

    Parameters
    ----------
    film_ratio : float or array
        Minimum film over composite roughness; NaN where it is not known.

    Returns
    -------
    float or array
        Index into ``("boundary", "mixed", "full film")``, NaN where the ratio is NaN.

    Raises
    ------
    InputError
        If a film ratio is negative.

    The limits are those of gears, where :func:`film_load_share` is 0.41 and 1; textbooks of rolling
    bearings have 1 and 3. Source: Zhu and Hu, Tribol. Trans. 44 (2001).

    Examples
    --------
    >>> lubrication_regime([0.1, 0.2, 1.9, 2.0])
    array([0., 1., 1., 2.])
    """
    ratio = np.asarray(film_ratio, dtype=float)
    require_between("film_ratio", np.nan_to_num(ratio, posinf=1e50), 0.0, np.inf)
    regime = np.searchsorted(REGIME_LIMITS, ratio, side="right").astype(float)
    return np.where(np.isnan(ratio), np.nan, regime)[()]


def film_load_share(film_ratio: ArrayLike) -> Array:
    """Part of the load that the oil film carries.

    ``f = 1.21 L^0.64 / (1 + 0.37 L^1.26)``, at most 1 and held from L = 2.2576 on: the fit itself
    exceeds 1 there and then falls.

    Parameters
    ----------
    film_ratio : float or array
        Minimum film over composite roughness; infinity over smooth flanks.

    Returns
    -------
    float or array
        Load share, 0 to 1, of the same shape; what is missing to 1 the asperities carry.

    Raises
    ------
    InputError
        If a film ratio is negative or no number.

    Valid as a fit to measured rough contacts, Source: Zhu and Hu, Tribol. Trans. 44 (2001).

    Examples
    --------
    >>> [round(float(film_load_share(ratio)), 3) for ratio in (0.0, 0.2, 1.0, 10.0)]
    [0.0, 0.412, 0.883, 1.0]
    """
    ratio = np.minimum(np.asarray(film_ratio, dtype=float), 1e50)
    require_between("film_ratio", ratio, 0.0, np.inf)
    ratio = np.minimum(ratio, _HELD)
    share = 1.21 * ratio ** _POWERS[0] / (1.0 + 0.37 * ratio ** _POWERS[1])
    return np.asarray(np.minimum(share, 1.0))[()]


#: Fall of the central film with its own part of the load, where the flanks keep the shape that the
#: whole load gives them: ``(E'/f)^0.69 (f E')^0.56`` of Dowson and Toyoda.
FILM_EXPONENT = 0.13


def balanced_load_share(
    central_film: ArrayLike,
    hertz_pressure: ArrayLike,
    effective_modulus: ArrayLike,
    asperities: Asperities,
    *,
    film_exponent: ArrayLike = FILM_EXPONENT,
) -> tuple[Array, Array]:
    """Load share of the film, and the gap at which film and asperities carry the load together.

    The film carries ``f w`` at the gap ``h f^-n``, the asperities ``(1-f) w`` at the same gap; it
    is the mean one, the volume of the oil over the area, so that flanks may overlap.

    Parameters
    ----------
    central_film : float or array [m]
        Film in the centre of smooth flanks under the whole load.
    hertz_pressure : float or array [Pa]
        Greatest pressure of the dry contact under the whole load.
    effective_modulus : float or array [Pa]
        ``2/E' = (1-nu1^2)/E1 + (1-nu2^2)/E2``.
    asperities : Asperities
        Of both flanks.
    film_exponent : float or array
        The power n.

    Returns
    -------
    tuple of array
        Share from 0 to 1 and mean gap [m], of the common shape of the arguments. Without film the
        gap is that of the dry contact.

    Raises
    ------
    InputError
        If a value is not positive (the film may be zero), or the asperities are so few and blunt
        that they could not carry the load at all.

    Both pressures keep the Hertzian width of the whole load; elastic asperities. Source: Johnson,
    Greenwood and Poon, Wear 19 (1972); mean gap: Patir and Cheng (1978).

    Examples
    --------
    >>> flanks = Asperities.from_slope(0.7e-6, 0.1)
    >>> share, gap = balanced_load_share([0.05e-6, 0.35e-6, 5e-6], 0.8e9, 2.3e11, flanks)
    >>> print(np.round(share, 3), np.round(gap * 1e6, 3))
    [0.042 0.824 1.   ] [0.076 0.359 5.   ]
    """
    film = np.asarray(central_film, dtype=float)
    require_between("central_film", np.minimum(film, 1e50), 0.0, np.inf, "m")
    require_positive("film_exponent", film_exponent)
    pressure, modulus = positive(hertz_pressure=hertz_pressure, effective_modulus=effective_modulus)
    require_one_shape(central_film=film, hertz_pressure=pressure, effective_modulus=modulus)
    with np.errstate(divide="ignore"):
        ratio = np.log(film / asperities.rms_height)
    # Asperities carry evenly over the width: their pressure is compared with the mean one.
    hardness = np.log(asperities.stiffness * modulus / (0.25 * np.pi * pressure))
    exponent = np.asarray(film_exponent, dtype=float)
    log_share, log_gap = _balance(*np.broadcast_arrays(ratio, hardness, exponent))
    return np.exp(log_share)[()], np.asarray(asperities.rms_height * np.exp(log_gap))[()]


#: Most steps of Newton's method, and step size at convergence.
_STEPS, _LAST = 60, 1e-12
#: Logarithm of a vanishing share.
_NONE = -700.0
#: Contacts per block, so that the arrays stay in the processor cache.
_BLOCK = 8192


def _balance(log_ratio: Array, hardness: Array, exponent: Array) -> tuple[Array, Array]:
    """Logarithms of the share of the film and of the gap over the rms height.

    With y = ln f the sum of both shares, exp(y) + exp(hardness + carried(ln h - n y)), rises with y
    and is convex: Newton comes down on 1 from the least share at which the asperities do not carry
    more than all.
    """
    table = _table()
    share, gap = np.empty(log_ratio.shape), np.empty(log_ratio.shape)
    flat = [values.reshape(-1) for values in (log_ratio, hardness, exponent, share, gap)]
    for start in range(0, log_ratio.size, _BLOCK):
        ratio, hard, n, y, x = (values[start : start + _BLOCK] for values in flat)
        dry = table.dry_gap(hard)
        y[:] = np.clip((ratio - dry) / n, _NONE, 0.0)
        for _ in range(_STEPS):
            carried, slope = table.carried(np.maximum(ratio - n * y, dry - table.step))
            film, asperity = np.exp(y), np.exp(hard + carried)
            change = (film + asperity - 1.0) / (film - n * slope * asperity)
            y -= change
            if np.max(np.abs(change) * film) < _LAST:
                break
        x[:] = np.where(y < 0.9 * _NONE, dry, ratio - n * y)
    return share, gap


@dataclass(frozen=True, eq=False)
class _Table:
    """Logarithm of F_5/2 of the asperities over that of the mean gap, both over the rms height."""

    first: float
    step: float
    log_integral: Array
    coefficients: tuple[Array, ...]  #: of the cubics, highest power first

    def carried(self, log_gap: Array) -> tuple[Array, Array]:
        """Logarithm of F_5/2, and its slope."""
        place = np.clip((log_gap - self.first) / self.step, 0.0, self.log_integral.size - 1.001)
        index = place.astype(np.intp)
        offset = (place - index) * self.step
        a, b, c, d = (values[index] for values in self.coefficients)
        value = ((a * offset + b) * offset + c) * offset + d
        return value, (3.0 * a * offset + 2.0 * b) * offset + c

    def dry_gap(self, hardness: Array) -> Array:
        """Logarithm of the gap at which asperities carry the whole load."""
        least = float(np.min(hardness, initial=np.inf))
        if least < -self.log_integral[0]:
            raise InputError(
                f"asperities carry at most {np.exp(least + self.log_integral[0]):.3g} of the load",
                where="asperities",
                why=f"even if the flanks overlap by {-_REACH[0]:g} times their rms height: they "
                "are so few and blunt that their contact is not the elastic one of summits",
                remedy="Give a larger slope or more summits",
            )
        places = self.first + self.step * np.arange(self.log_integral.size)
        return np.asarray(np.interp(hardness, -self.log_integral, places))


#: Separations over the rms height covered by the table, and its number of grid points.
_REACH, _KNOTS = (-12.0, 36.0), 16385


@cache
def _table() -> _Table:
    """Tabulate once: the mean gap of a separation u is the integral F_1(-u)."""
    from scipy.interpolate import CubicSpline

    separation = np.linspace(*_REACH, _KNOTS)
    log_gap = np.log(asperity_integral(-separation, 1.0))
    spline_of_gap = CubicSpline(log_gap, np.log(asperity_integral(separation)))
    places = np.linspace(log_gap[0], log_gap[-1], _KNOTS)
    spline = CubicSpline(places, spline_of_gap(places))
    cubics = tuple(np.ascontiguousarray(row) for row in spline.c)
    return _Table(float(places[0]), float(places[1] - places[0]), spline_of_gap(places), cubics)


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
