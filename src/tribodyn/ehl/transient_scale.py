"""Fixed scale and grid of a contact whose load, radius and speed change over time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tribodyn.ehl.regimes import (
    elastic_isoviscous,
    elastic_piezoviscous,
    rigid_isoviscous,
    rigid_piezoviscous,
)
from tribodyn.lubricant import Lubricant
from tribodyn.types import Array


@dataclass(frozen=True)
class ReferenceScale:
    """Units of a transient contact: those of its widest dry contact."""

    instant: int  #: where in the series the dry contact is widest
    load: float  #: load there [N/m]
    radius: float  #: radius there [m]
    entrainment_speed: float  #: greatest entrainment speed [m/s]
    half_width: float  #: half width of the dry contact [m]
    pressure: float  #: hertz pressure [Pa]

    @property
    def time(self) -> float:
        """Time ``b/u`` [s]."""
        return self.half_width / self.entrainment_speed

    @property
    def film(self) -> float:
        """Film ``b^2/R`` [m]."""
        return self.half_width**2 / self.radius


def reference_scale(
    time: Array, load: Array, radius: Array, entrainment_speed: Array, effective_modulus: float
) -> ReferenceScale:
    """Scale of the widest dry contact of a series.

    Parameters
    ----------
    time : (m,) array [s]
        Instants.
    load : (m,) array [N/m]
        Load per width.
    radius : (m,) array [m]
        Reduced radius of curvature.
    entrainment_speed : (m,) array [m/s]
        HALF the sum of the surface speeds.
    effective_modulus : float [Pa]
        ``2/E' = (1-nu1^2)/E1 + (1-nu2^2)/E2``.

    Returns
    -------
    ReferenceScale

    Source: Hertz (1881) for the line contact.
    """
    width = np.sqrt(8.0 * load * radius / (np.pi * effective_modulus))
    instant = int(np.argmax(width))
    b = float(width[instant])
    fastest = float(np.max(entrainment_speed))
    if fastest == 0.0:
        fastest = b / float(time[-1] - time[0])
    pressure = 2.0 * float(load[instant]) / (np.pi * b)
    return ReferenceScale(
        instant, float(load[instant]), float(radius[instant]), fastest, b, pressure
    )


def flooded_domain(
    scale: ReferenceScale,
    load: Array,
    radius: Array,
    entrainment_speed: Array,
    lubricant: Lubricant,
    effective_modulus: float,
) -> tuple[float, float]:
    """Grid that holds the wedge of every instant, in half widths of the reference."""
    moving = np.maximum(entrainment_speed, 1e-6 * scale.entrainment_speed)
    numbers = 2.0 * lubricant.dynamic_viscosity * moving / (effective_modulus * radius)
    M = load / (effective_modulus * radius * np.sqrt(numbers))
    L = lubricant.pressure_viscosity_coefficient * effective_modulus * numbers**0.25
    isoviscous = np.maximum(rigid_isoviscous(M), elastic_isoviscous(M))
    thick = isoviscous
    if lubricant.pressure_viscosity_coefficient > 0.0:
        thick = np.maximum(
            isoviscous, np.minimum(rigid_piezoviscous(L), elastic_piezoviscous(M, L))
        )
    film = thick * radius * np.sqrt(numbers)
    width = np.sqrt(8.0 * load * radius / (np.pi * effective_modulus))
    local = np.minimum(film * radius / width**2, 1.0)
    round_width = np.sqrt(2.0 * radius * film)
    first = np.maximum((4.0 + 1.2 * local) * width, 3.6 * round_width)
    last = np.maximum((1.5 + 0.4 * np.maximum(local - 0.5, 0.0)) * width, 1.1 * round_width)
    return -float(np.max(first)) / scale.half_width, float(np.max(last)) / scale.half_width
