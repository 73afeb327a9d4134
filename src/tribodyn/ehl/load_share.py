"""How film and asperities of a rough contact share its load: by a fit, and by their balance."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.checks import positive, require_one_shape
from tribodyn.ehl.asperities import Asperities, asperity_integral
from tribodyn.errors import InputError, require_between, require_positive
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
