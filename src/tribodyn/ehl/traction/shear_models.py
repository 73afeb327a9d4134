"""Shear models of the oil by name, and the stress of each: Newton; Ree and Eyring."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.errors import require_between, require_positive
from tribodyn.model import Registry
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


def _newtonian_rate(
    log_viscosity: Array, film_thickness: Array, pressure_gradient: Array, eyring_stress: float
) -> Array:
    """Logarithm of the stress per sliding speed, see ``ShearModel``."""
    return np.asarray(log_viscosity - np.log(film_thickness))


def _newtonian_stress(rate: Array, eyring_stress: float) -> tuple[Array, Array]:
    """Mean shear stress, and its slope over the logarithm of the rate: both are the rate itself."""
    return rate, rate


#: Usual Eyring stress of a mineral oil [Pa]. Traction tests give 2 to 10 MPa.
EYRING_STRESS = 5e6

#: The largest exponent whose exponential, times a speed, a double holds.
_LARGEST_EXPONENT = 690.0
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
    logarithm = np.log(np.asarray(viscosity, dtype=float))
    rate = np.abs(speed) * np.exp(_ree_eyring_rate(logarithm, film, gradient, eyring_stress))
    return np.asarray(np.copysign(_ree_eyring_stress(rate, eyring_stress)[0], speed))[()]


def _log_shape(y: Array) -> Array:
    """Return ln(y/sinh(y)) of a positive array, where sinh itself would overflow."""
    safe = np.maximum(y, _SMALL)
    large = np.log(2.0 * safe) - safe - np.log1p(-np.exp(-2.0 * safe))
    return np.asarray(np.where(y < _SMALL, -(y**2) / 6.0, large))


def _ree_eyring_rate(
    log_viscosity: Array, film_thickness: Array, pressure_gradient: Array, eyring_stress: float
) -> Array:
    """Logarithm of ``eta/(tau_0 h) y/sinh(y)``: the sine hyperbolic of the stress per speed."""
    y = np.abs(film_thickness * pressure_gradient) / (2.0 * eyring_stress)
    logarithm = log_viscosity + _log_shape(y) - np.log(eyring_stress * film_thickness)
    return np.asarray(np.minimum(logarithm, _LARGEST_EXPONENT))


def _ree_eyring_stress(rate: Array, eyring_stress: float) -> tuple[Array, Array]:
    """Mean shear stress ``tau_0 asinh(rate)``, and its slope over the logarithm of the rate."""
    return eyring_stress * np.arcsinh(rate), eyring_stress * (rate / np.hypot(1.0, rate))


@dataclass(frozen=True)
class ShearModel:
    """A shear model: mean shear stress over the film from what drives it."""

    name: str  #: name in the registry
    source: str  #: paper behind the model
    log_rate: Callable[[Array, Array, Array, float], Array] = field(repr=False)
    stress: Callable[[Array, float], tuple[Array, Array]] = field(repr=False)
    meaning: str = ""  #: one line


#: Shear models by name.
SHEAR_MODELS: Registry[ShearModel] = Registry("shear model")

for _model in (
    ShearModel(
        "newtonian",
        "Newton (1687)",
        _newtonian_rate,
        _newtonian_stress,
        "an oil whose shear stress is in proportion to the shear rate",
    ),
    ShearModel(
        "ree-eyring",
        "Ree and Eyring (1955); Conry, Wang and Cusano (1987)",
        _ree_eyring_rate,
        _ree_eyring_stress,
        "an oil that thins under shear after Ree and Eyring",
    ),
):
    SHEAR_MODELS.register(_model.name)(_model)
