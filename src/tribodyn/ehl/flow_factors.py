"""Flow factors of rough surfaces: Reynolds' equation for the mean of the pressure, after Patir.

The mean flow between rough surfaces is that between smooth ones, times a factor where pressure
drives it, plus a part that the sliding roughness carries along.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.errors import require_between, require_positive
from tribodyn.types import Array


class _Row(NamedTuple):
    """Printed constants of one orientation of the roughness."""

    orientation: float
    C: float
    r: float
    least: float  #: film ratio from which the pressure flow factor holds
    A1: float
    a1: float
    a2: float
    a3: float
    A2: float


_TABLE = (
    _Row(1 / 9, 1.48, 0.42, 1.0, 2.046, 1.12, 0.78, 0.03, 1.856),
    _Row(1 / 6, 1.38, 0.42, 1.0, 1.962, 1.08, 0.77, 0.03, 1.754),
    _Row(1 / 3, 1.18, 0.42, 0.75, 1.858, 1.01, 0.76, 0.03, 1.561),
    _Row(1.0, 0.90, 0.56, 0.5, 1.899, 0.98, 0.92, 0.05, 1.126),
    _Row(3.0, 0.225, 1.5, 0.5, 1.560, 0.85, 1.13, 0.08, 0.556),
    _Row(6.0, 0.520, 1.5, 0.5, 1.290, 0.62, 1.09, 0.08, 0.388),
    _Row(9.0, 0.870, 1.5, 0.5, 1.011, 0.54, 1.07, 0.08, 0.295),
)
#: Logarithms of the orientations.
_PLACES = np.log([row.orientation for row in _TABLE])
#: Film ratio from which the shear flow factor decays alone.
_FAR = 5.0


def pressure_flow_factor(film_ratio: ArrayLike, orientation: float = 1.0) -> Array:
    """Flow that pressure drives between rough surfaces, over that between smooth ones.

    ``1 - C exp(-r h/s)`` for orientations up to 1, ``1 + C (h/s)^-r`` above.

    Parameters
    ----------
    film_ratio : float or array [-]
        Distance h of the mean surfaces over the composite rms roughness s.
    orientation : float [-]
        Length of the asperities along the flow over that across it, 1/9 to 9: 1 is isotropic, 9
        are ridges along the flow. Interpolated in its logarithm between printed values.

    Returns
    -------
    float or array
        Factor phi_x; below 1 for ridges across the flow and isotropic surfaces.

    Raises
    ------
    InputError
        If the film ratio is below the range of the fit, 0.5, for orientations below 1 up to 1, or
        the orientation is out of range.

    Source: Patir and Cheng (1978), of numerical flow between Gaussian surfaces.

    Examples
    --------
    >>> float(pressure_flow_factor(3.0).round(4))
    0.8323
    """
    ratio, shares = _of_range(film_ratio, orientation)
    return _mixed(shares, [_pressure(row, ratio) for row in _TABLE])


def shear_flow_factor(film_ratio: ArrayLike, orientation: float = 1.0) -> Array:
    """Flow that a rough surface carries along while a smooth one slides over it.

    ``A1 (h/s)^a1 exp(-a2 h/s + a3 (h/s)^2)`` up to a film ratio of 5, ``A2 exp(-0.25 h/s)`` above,
    in units of half the sliding speed times the rms roughness s.

    Parameters
    ----------
    film_ratio : float or array [-]
        Distance h of the mean surfaces over the rms roughness s.
    orientation : float [-]
        As for :func:`pressure_flow_factor`.

    Returns
    -------
    float or array
        Factor Phi_s, positive: the valleys of the rough surface move oil with it.

    Raises
    ------
    InputError
        As :func:`pressure_flow_factor`.

    Source: Patir and Cheng (1979).

    Examples
    --------
    >>> float(shear_flow_factor(3.0).round(4))
    0.5532
    """
    ratio, shares = _of_range(film_ratio, orientation)
    return _mixed(shares, [_shear(row, ratio) for row in _TABLE])


def mean_gap(film_ratio: ArrayLike) -> Array:
    """Mean gap between rough surfaces over the distance of their mean surfaces.

    Where asperities would overlap the gap is zero, not negative: ``h_T`` exceeds h, by 1e-4 of it
    at a film ratio of 3.

    Parameters
    ----------
    film_ratio : float or array [-]
        That distance over the composite rms roughness.

    Returns
    -------
    float or array
        At least 1.

    Source: Patir and Cheng (1978), Gaussian heights.

    Examples
    --------
    >>> float(mean_gap(1.0).round(4))
    1.0833
    """
    from scipy.special import ndtr

    ratio = np.asarray(film_ratio, dtype=float)
    density = np.exp(-0.5 * ratio**2) / math.sqrt(2.0 * math.pi)
    return np.asarray(ndtr(ratio) + density / ratio)


@dataclass(frozen=True)
class FlowFactors:
    """Roughness of two surfaces that enters Reynolds' equation by flow factors.

    Parameters
    ----------
    roughness : float [m]
        Composite rms roughness of both surfaces.
    orientation : float [-]
        Length of the asperities along the flow over that across it, 1/9 to 9; 1 is isotropic.
    first_share : float [-]
        Part of the mean square roughness that is on surface 1; it matters where they slide.

    Raises
    ------
    InputError
        If a value is out of range.

    Source: Patir and Cheng (1978, 1979).

    Examples
    --------
    >>> from tribodyn.ehl import solve_line_contact
    >>> from tribodyn.lubricant import Lubricant
    >>> contact = 147802.0, 8e-3, 3.0722, Lubricant(0.082, 880.0, 2.19e-8), 2.2e11
    >>> across = FlowFactors(5e-7, orientation=1 / 6)
    >>> films = [solve_line_contact(*contact, flow_factors=each) for each in (None, across)]
    >>> [round(film.central_film * 1e6, 2) for film in films]
    [1.02, 1.17]
    """

    roughness: float
    orientation: float = 1.0
    first_share: float = 0.5

    def __post_init__(self) -> None:
        """Check the fields."""
        require_positive("roughness", self.roughness, "m")
        require_between("orientation", self.orientation, 1.0 / 9.0 - 1e-12, 9.0 + 1e-12)
        require_between("first_share", self.first_share, 0.0, 1.0)

    def flow(self, film: Array, slide_to_roll_ratio: float = 0.0) -> tuple[Array, Array]:
        """Factors on the flow by pressure and on that by entrainment.

        Parameters
        ----------
        film : array [m]
            Distance of the mean surfaces.
        slide_to_roll_ratio : float [-]
            Speed of surface 1 less that of surface 2, over the entrainment speed.

        Returns
        -------
        (pressure, entrainment) : arrays

        Raises
        ------
        InputError
            If the film is too thin for the factors.
        """
        ratio = film / self.roughness
        carried = (2.0 * self.first_share - 1.0) * shear_flow_factor(ratio, self.orientation)
        sheared = 0.5 * slide_to_roll_ratio * carried / ratio
        return pressure_flow_factor(ratio, self.orientation), mean_gap(ratio) + sheared


def _of_range(film_ratio: ArrayLike, orientation: float) -> tuple[Array, Array]:
    """Film ratio in the range of the fit, and the shares of the printed orientations."""
    require_between("orientation", orientation, 1.0 / 9.0 - 1e-12, 9.0 + 1e-12)
    place = math.log(orientation)
    shares = np.array([np.interp(place, _PLACES, unit) for unit in np.eye(len(_TABLE))])
    least = max(row.least for row, share in zip(_TABLE, shares, strict=True) if share > 1e-9)
    ratio = np.asarray(film_ratio, dtype=float)
    remedy = "Thinner films rest on asperities: use mixed_line_contact"
    require_between("film_ratio", ratio, least, np.inf, remedy=remedy)
    return ratio, shares


def _mixed(shares: Array, values: list[Array]) -> Array:
    """Values of the printed orientations by their shares."""
    used = [share * value for share, value in zip(shares, values, strict=True) if share > 0.0]
    return np.asarray(sum(used))


def _pressure(row: _Row, ratio: Array) -> Array:
    if row.orientation > 1.0:
        return np.asarray(1.0 + row.C * ratio**-row.r)
    return np.asarray(1.0 - row.C * np.exp(-row.r * ratio))


def _shear(row: _Row, ratio: Array) -> Array:
    limited = np.minimum(ratio, _FAR)
    fit = row.A1 * limited**row.a1 * np.exp(-row.a2 * limited + row.a3 * limited**2)
    return np.where(ratio > _FAR, row.A2 * np.exp(-0.25 * ratio), fit)
