"""Newton's oil: shear stress in proportion to the shear rate."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.ehl.traction.shear_models import SHEAR_MODELS
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


@SHEAR_MODELS.define(
    "newtonian",
    source="Newton (1687)",
    meaning="an oil whose shear stress is in proportion to the shear rate",
    papers=("newton",),
)
def _newtonian(rate: Array, limit: Array, **others: float) -> tuple[Array, Array]:
    return rate, rate
