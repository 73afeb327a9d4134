"""Carreau's oil, which thins as a power of the shear rate; with Yasuda's width of the bend."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.checks import positive
from tribodyn.ehl.traction.shear_models import SHEAR_MODELS
from tribodyn.errors import require_between
from tribodyn.model import number
from tribodyn.types import Array

#: The numbers of the law as options.
THINNING = {
    "carreau_stress": number(
        5e6, 1e3, 1e9, "oils lie between 10 kPa and 10 MPa", of="carreau_stress"
    ),
    "carreau_exponent": number(
        0.5, 0.05, 1.0, "1 is Newton's oil, oils have 0.3 to 0.9", of="carreau_exponent"
    ),
    "yasuda_exponent": number(2.0, 0.2, 20.0, "2 is Carreau's own", of="yasuda_exponent"),
}


def carreau_shear_stress(
    viscosity: ArrayLike,
    sliding_speed: ArrayLike,
    film_thickness: ArrayLike,
    carreau_stress: float = 5e6,
    carreau_exponent: float = 0.5,
    yasuda_exponent: float = 2.0,
) -> Array:
    """Shear stress of a film that thins as a power of the rate: Carreau and Yasuda.

    ``tau = s [1 + (s/G)^a]^((n - 1)/a)`` with ``s = eta v_s/h``, the stress of Newton's oil.

    Parameters
    ----------
    viscosity, sliding_speed, film_thickness : float or array [Pa*s], [m/s], [m]
        As for :func:`ree_eyring_shear_stress`.
    carreau_stress : float [Pa]
        Stress ``G`` from which the oil thins.
    carreau_exponent : float
        Exponent ``n`` of the stress over the rate far beyond; 1 for Newton's oil.
    yasuda_exponent : float
        Sharpness ``a`` of the bend; 2 is Carreau's own.

    Returns
    -------
    float or array [Pa]
        Of the common shape and the sign of the sliding speed.

    Raises
    ------
    InputError
        If a value is not finite, or one but the sliding speed not positive.

    Valid where the stress hardly varies across the film, ``h dp/dx << tau``. Source: Carreau
    (1972); Yasuda, Armstrong and Cohen (1981).

    Examples
    --------
    >>> round(float(carreau_shear_stress(1000.0, 0.5, 1e-6)) / 1e6, 3)
    49.999
    >>> round(float(carreau_shear_stress(1000.0, 0.5, 1e-6, carreau_exponent=1.0)) / 1e6, 3)
    500.0
    """
    eta, film, *numbers = positive(
        viscosity=viscosity,
        film_thickness=film_thickness,
        carreau_stress=carreau_stress,
        carreau_exponent=carreau_exponent,
        yasuda_exponent=yasuda_exponent,
    )
    require_between("sliding_speed", sliding_speed, -np.inf, np.inf, "m/s")
    speed = np.asarray(sliding_speed, dtype=float)
    rate = np.abs(eta * speed / film)
    named = dict(zip(THINNING, map(float, numbers), strict=True))
    return np.asarray(np.copysign(carreau(rate, rate, **named)[0], speed))[()]


@SHEAR_MODELS.define(
    "carreau",
    source="Carreau (1972); Yasuda, Armstrong and Cohen (1981)",
    options=THINNING,
    meaning="an oil that thins as a power of the shear rate after Carreau and Yasuda",
    papers=("carreau", "yasuda-armstrong-cohen"),
)
def carreau(
    rate: Array,
    limit: Array,
    *,
    carreau_stress: float,
    carreau_exponent: float,
    yasuda_exponent: float,
    **others: float,
) -> tuple[Array, Array]:
    """Mean shear stress, and its slope over the logarithm of the rate."""
    with np.errstate(divide="ignore"):
        power = yasuda_exponent * np.log(rate / carreau_stress)
    bend = np.logaddexp(0.0, power)
    stress = rate * np.exp((carreau_exponent - 1.0) / yasuda_exponent * bend)
    return stress, stress * (1.0 + (carreau_exponent - 1.0) * np.exp(power - bend))
