"""Bair and Winer's oil: a limiting shear stress that grows with the pressure."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.checks import positive
from tribodyn.ehl.traction.shear_models import LIMIT, SHEAR_MODELS
from tribodyn.errors import require_between
from tribodyn.types import Array


def bair_winer_shear_stress(
    viscosity: ArrayLike,
    sliding_speed: ArrayLike,
    film_thickness: ArrayLike,
    pressure: ArrayLike,
    limiting_stress: float = 2e6,
    limiting_stress_slope: float = 0.05,
) -> Array:
    """Shear stress of a film that yields at ``tau_L = tau_L0 + Lambda p``.

    ``v_s/h = -(tau_L/eta) ln(1 - tau/tau_L)``, hence ``tau = tau_L [1 - exp(-eta v_s/(h tau_L))]``.

    Parameters
    ----------
    viscosity, sliding_speed, film_thickness : float or array [Pa*s], [m/s], [m]
        As for :func:`ree_eyring_shear_stress`.
    pressure : float or array [Pa]
        Pressure above ambient.
    limiting_stress : float [Pa]
        Limiting stress ``tau_L0`` at ambient pressure.
    limiting_stress_slope : float
        Rise ``Lambda`` of the limiting stress per pressure; 0.02 to 0.12 for oils.

    Returns
    -------
    float or array [Pa]
        Of the common shape and the sign of the sliding speed.

    Raises
    ------
    InputError
        If a value is not finite, the pressure or slope negative, or another one not positive.

    Valid where the stress hardly varies across the film, ``h dp/dx << tau``. Source: Bair and
    Winer (1979).

    Examples
    --------
    >>> round(float(bair_winer_shear_stress(1000.0, 0.5, 1e-6, 1e9)) / 1e6, 3)
    51.997
    >>> round(float(bair_winer_shear_stress(10.0, 0.5, 1e-6, 1e9, 1e12)) / 1e6, 3)
    5.0
    """
    eta, film, limit = positive(
        viscosity=viscosity, film_thickness=film_thickness, limiting_stress=limiting_stress
    )
    require_between("sliding_speed", sliding_speed, -np.inf, np.inf, "m/s")
    require_between("pressure", pressure, 0.0, np.inf, "Pa")
    require_between("limiting_stress_slope", limiting_stress_slope, 0.0, np.inf)
    speed, load = np.asarray(sliding_speed, dtype=float), np.asarray(pressure, dtype=float)
    limit = limit + limiting_stress_slope * load
    return np.asarray(np.copysign(_bair_winer(eta * np.abs(speed) / film, limit)[0], speed))[()]


@SHEAR_MODELS.define(
    "bair-winer",
    source="Bair and Winer (1979)",
    options=LIMIT,
    meaning="an oil whose shear stress tends to a limit that grows with the pressure",
    papers=("bair-winer",),
)
def _bair_winer(rate: Array, limit: Array, **others: float) -> tuple[Array, Array]:
    return -limit * np.expm1(-rate / limit), rate * np.exp(-rate / limit)
