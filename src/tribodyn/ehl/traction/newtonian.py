"""Shear stress of an oil whose viscosity does not depend on the shear."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.errors import require_between, require_positive
from tribodyn.types import Array


def newtonian_shear_stress(
    viscosity: ArrayLike, sliding_speed: ArrayLike, film_thickness: ArrayLike
) -> Array:
    """Mean shear stress over a film of a Newtonian oil: ``eta v_s / h``.

    Parameters
    ----------
    viscosity : float or array [Pa*s]
        Viscosity under the local pressure.
    sliding_speed : float or array [m/s]
        Difference of the surface speeds.
    film_thickness : float or array [m]
        Distance of the surfaces.

    Returns
    -------
    float or array [Pa]
        Of the common shape and the sign of the sliding speed. A pressure gradient does not change
        the mean; it adds ``-h/2 dp/dx`` at one surface and ``+h/2 dp/dx`` at the other.

    Raises
    ------
    InputError
        If a value is not finite, or a viscosity or film not positive.

    Valid while the stress stays below a few MPa. Source: Newton (1687).

    Examples
    --------
    >>> round(float(newtonian_shear_stress(10.0, 0.5, 1e-6)))
    5000000
    """
    require_positive("viscosity", viscosity, "Pa*s")
    require_between("sliding_speed", sliding_speed, -np.inf, np.inf, "m/s")
    require_positive("film_thickness", film_thickness, "m")
    eta, speed, film = (
        np.asarray(a, dtype=float) for a in (viscosity, sliding_speed, film_thickness)
    )
    return np.asarray(eta * speed / film)[()]


def log_rate(
    log_viscosity: Array, film_thickness: Array, pressure_gradient: Array, eyring_stress: float
) -> Array:
    """Logarithm of the stress per sliding speed, see ``ShearModel``."""
    return np.asarray(log_viscosity - np.log(film_thickness))


def stress(rate: Array, eyring_stress: float) -> tuple[Array, Array]:
    """Mean shear stress, and its slope over the logarithm of the rate: both are the rate itself."""
    return rate, rate
