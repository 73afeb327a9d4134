"""Ree and Eyring's oil, which thins under shear: friction grows as the logarithm of the speed."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.ehl.traction.shear_models import SHEAR_MODELS
from tribodyn.errors import require_between, require_positive
from tribodyn.model import number
from tribodyn.types import Array

#: Usual Eyring stress of a mineral oil [Pa]. Traction tests give 2 to 10 MPa.
EYRING_STRESS = 5e6
#: The stress as an option.
EYRING = {
    "eyring_stress": number(
        EYRING_STRESS, 1e5, 1e8, "oils lie between 2 and 10 MPa", of="eyring_stress"
    )
}
#: Below this argument ``ln(y/sinh y)`` is its first term to the last bit.
_SMALL = 1e-4


def ree_eyring_shear_stress(
    viscosity: ArrayLike,
    sliding_speed: ArrayLike,
    film_thickness: ArrayLike,
    eyring_stress: float = EYRING_STRESS,
    pressure_gradient: ArrayLike = 0.0,
) -> Array:
    """Mean shear stress over a film that shears as ``(tau_0/eta) sinh(tau/tau_0)``.

    Across the film the stress is ``tau_m + z dp/dx``, with z from the middle. The shear rate,
    integrated over the film, is the sliding speed: with ``y = h dp/dx/(2 tau_0)``
    ``v_s = (2 tau_0^2/(eta dp/dx)) sinh(tau_m/tau_0) sinh(y)``, hence
    ``tau_m = tau_0 asinh[ eta v_s/(tau_0 h) y/sinh(y) ]``.

    Parameters
    ----------
    viscosity : float or array [Pa*s]
        Viscosity under the local pressure at small shear stress.
    sliding_speed : float or array [m/s]
        Difference of the surface speeds.
    film_thickness : float or array [m]
        Distance of the surfaces.
    eyring_stress : float [Pa]
        Stress ``tau_0`` from which the oil thins; 2 to 10 MPa for oils.
    pressure_gradient : float or array [Pa/m]
        Slope of the pressure along the film.

    Returns
    -------
    float or array [Pa]
        Of the common shape and the sign of the sliding speed.

    Raises
    ------
    InputError
        If a value is not finite, or a viscosity, film or Eyring stress not positive.

    Valid while the film is at one temperature across its thickness. Source: Ree and Eyring (1955);
    Conry, Wang and Cusano (1987) for the integral.

    Examples
    --------
    >>> round(float(ree_eyring_shear_stress(1000.0, 0.5, 1e-6)) / 1e6, 3)
    26.492
    >>> round(float(ree_eyring_shear_stress(1000.0, 0.5, 1e-6, 1e15)) / 1e6, 3)
    500.0
    """
    require_positive("viscosity", viscosity, "Pa*s")
    require_between("sliding_speed", sliding_speed, -np.inf, np.inf, "m/s")
    require_positive("film_thickness", film_thickness, "m")
    require_positive("eyring_stress", eyring_stress, "Pa", remedy="5 MPa is 5e6 Pa")
    require_between("pressure_gradient", pressure_gradient, -np.inf, np.inf, "Pa/m")
    speed, film, gradient = (
        np.asarray(a, dtype=float) for a in (sliding_speed, film_thickness, pressure_gradient)
    )
    rate = np.asarray(viscosity, dtype=float) * np.abs(speed) / film
    rate = rate * np.exp(_across(film * gradient, eyring_stress))
    return np.asarray(np.copysign(eyring_stress * np.arcsinh(rate / eyring_stress), speed))[()]


def _across(pressure_step: Array, eyring_stress: float, **others: float) -> Array:
    """Return ln(y/sinh(y)), which the pressure gradient leaves of the viscosity."""
    y = np.abs(pressure_step) / (2.0 * eyring_stress)
    safe = np.maximum(y, _SMALL)
    large = np.log(2.0 * safe) - safe - np.log1p(-np.exp(-2.0 * safe))
    return np.asarray(np.where(y < _SMALL, -(y**2) / 6.0, large))


@SHEAR_MODELS.define(
    "ree-eyring",
    source="Ree and Eyring (1955); Conry, Wang and Cusano (1987)",
    options=EYRING,
    across=_across,
    meaning="an oil that thins under shear after Ree and Eyring",
    papers=("ree-eyring", "conry-wang-cusano"),
)
def eyring(
    rate: Array, limit: Array, *, eyring_stress: float, **others: float
) -> tuple[Array, Array]:
    """Mean shear stress, and its slope over the logarithm of the rate."""
    sine = rate / eyring_stress
    return eyring_stress * np.arcsinh(sine), rate / np.hypot(1.0, sine)
