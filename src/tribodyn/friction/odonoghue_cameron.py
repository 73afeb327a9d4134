"""Friction of rolling and sliding discs: the formula of O'Donoghue and Cameron."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.errors import require_between, require_positive
from tribodyn.friction.base import LAWS, TribologicalContact
from tribodyn.friction.validity import Range, warn_outside
from tribodyn.types import Array

_INCH = 0.0254  # [m]
#: Floor of the sliding speed [m/s]: the formula grows without bound as sliding stops, and 0.1 m/s
#: keeps it below what lubricated steel shows.
_LEAST_SLIDING = 0.1


def odonoghue_cameron(
    sliding_speed: ArrayLike,
    entrainment_speed: ArrayLike,
    dynamic_viscosity: ArrayLike,
    roughness: ArrayLike,
    equivalent_radius: ArrayLike,
) -> Array:
    """Friction coefficient by O'Donoghue and Cameron.

    ``mu = 0.6 (S + 22)/35 / (eta^(1/8) v_s^(1/3) v_r^(1/6) R^(1/2))`` in units of the inch: S in
    microinches, eta in cP, speeds in in/s, R in in; v_r is the SUM of the surface speeds.

    Parameters
    ----------
    sliding_speed : float or array [m/s]
        Difference of the surface speeds; its sign does not matter. Held at 0.1 m/s and above.
    entrainment_speed : float or array [m/s]
        HALF the sum of the surface speeds; the formula itself takes the sum.
    dynamic_viscosity : float or array [Pa*s]
        Viscosity at ambient pressure and inlet temperature.
    roughness : float or array [m]
        Composite roughness.
    equivalent_radius : float or array [m]
        Reduced radius of curvature.

    Returns
    -------
    float or array
        Friction coefficient, of the common shape of the arguments.

    Raises
    ------
    InputError
        If a value is not finite, or not positive where it must be.

    Warns
    -----
    ModelWarning
        Code ``friction-range`` where the coefficient exceeds 0.2.

    Fitted to disc tests. No second source of the constants was found. Source: O'Donoghue and
    Cameron, ASLE Trans. 9 (1966), as listed by Xu et al. (2007).

    Examples
    --------
    >>> round(float(odonoghue_cameron(0.913038, 1.407953, 0.082, 0.53e-6, 8.577181e-3)), 4)
    0.1008
    """
    require_between("sliding_speed", sliding_speed, -np.inf, np.inf, "m/s")
    require_positive("entrainment_speed", entrainment_speed, "m/s")
    require_positive("dynamic_viscosity", dynamic_viscosity, "Pa*s")
    require_between("roughness", roughness, 0.0, np.inf, "m")
    require_positive("equivalent_radius", equivalent_radius, "m")
    sliding = np.maximum(np.abs(np.asarray(sliding_speed, dtype=float)), _LEAST_SLIDING) / _INCH
    rolling = 2.0 * np.asarray(entrainment_speed, dtype=float) / _INCH
    viscosity = 1e3 * np.asarray(dynamic_viscosity, dtype=float)
    rough = (np.asarray(roughness, dtype=float) / (1e-6 * _INCH) + 22.0) / 35.0
    radius = np.asarray(equivalent_radius, dtype=float) / _INCH
    divisor = viscosity**0.125 * np.cbrt(sliding) * rolling ** (1.0 / 6.0) * np.sqrt(radius)
    coefficient = np.asarray(0.6 * rough / divisor)[()]
    warn_outside(
        "odonoghue-cameron",
        (Range("friction coefficient", coefficient, 0.0, 0.2),),
        "Compare with another friction law.",
    )
    return coefficient


@LAWS.define(
    "odonoghue-cameron",
    source="O'Donoghue and Cameron, ASLE Trans. 9 (1966)",
    meaning="friction coefficient of discs: falls with speeds and radius, whatever the load",
    papers=("odonoghue-cameron", "xu"),
)
def _law(contact: TribologicalContact) -> Array:
    return odonoghue_cameron(
        contact.sliding_speed,
        contact.entrainment_speed,
        contact.dynamic_viscosity,
        contact.composite_roughness,
        contact.equivalent_radius,
    )
