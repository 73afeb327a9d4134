"""Mean friction of a gear mesh for micropitting: ISO/TS 6336-22."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.errors import require_positive
from tribodyn.friction.base import LAWS, TribologicalContact
from tribodyn.friction.mesh_means.pitch_point import OPTIONS
from tribodyn.friction.mesh_means.schlenk import mean_friction, pitch_state, warn_of_mean
from tribodyn.model import number
from tribodyn.types import Array


def iso_6336_22(
    load_per_width: ArrayLike,
    sum_velocity: ArrayLike,
    equivalent_radius: ArrayLike,
    dynamic_viscosity: ArrayLike,
    roughness_ra: ArrayLike,
    lubricant_factor: ArrayLike = 1.0,
) -> Array:
    """Mean friction coefficient of a mesh by ISO/TS 6336-22.

    ``mu = 0.045 (K F_bt/b / (v_sum rho))^0.2 eta^-0.05 X_R X_L`` at the pitch point with
    ``X_R = 2.2 (Ra/rho)^0.25``; N/mm, m/s, mm, mPa s and um.

    Parameters
    ----------
    load_per_width : float or array [N/m]
        Tangential load at the base circle per face width, times the load factors K of ISO 6336-1.
    sum_velocity : float or array [m/s]
        SUM of the surface speeds at the pitch point.
    equivalent_radius : float or array [m]
        Reduced radius of curvature at the pitch point.
    dynamic_viscosity : float or array [Pa*s]
        Viscosity at ambient pressure and oil temperature.
    roughness_ra : float or array [m]
        Mean of the arithmetical roughnesses Ra of both flanks.
    lubricant_factor : float or array
        X_L: mineral oil 1, PAO 0.8, polyglycols 0.6 (water-soluble) or 0.7, phosphate ester 1.3,
        traction fluid 1.5.

    Returns
    -------
    float or array
        Friction coefficient, of the common shape of the arguments.

    Raises
    ------
    InputError
        If a value is not finite or not positive.

    Warns
    -----
    ModelWarning
        Code ``friction-range`` where the speeds add up to more than 35 m/s, Ra exceeds 4 um or the
        coefficient 0.2.

    Source: ISO/TS 6336-22:2018 (before: ISO/TR 15144-1), mean coefficient of friction.

    Examples
    --------
    >>> print(round(float(iso_6336_22(133022.0, 2.6333, 8.382e-3, 0.082, 0.53e-6)), 4))
    0.057
    """
    require_positive("equivalent_radius", equivalent_radius, "m")
    state = (load_per_width, sum_velocity, equivalent_radius, dynamic_viscosity, roughness_ra)
    radius = 1e3 * np.asarray(equivalent_radius, dtype=float)
    smooth = mean_friction(*state, 0.25, lubricant_factor)
    coefficient = np.asarray(0.045 * 2.2 * smooth * radius**-0.25)[()]
    warn_of_mean("iso-6336-22", coefficient, sum_velocity, roughness_ra)
    return coefficient


@LAWS.define(
    "iso-6336-22",
    source="ISO/TS 6336-22:2018",
    meaning="mean friction coefficient of a mesh, as the micropitting standard has it",
    options={
        "load_factor": number(
            1.0,
            0.5,
            10.0,
            "load factors of ISO 6336-1 lie between 1 and 4",
            meaning="product of the load factors of ISO 6336-1 on the load",
            symbol="K",
            example="1.3",
        ),
        **OPTIONS,
    },
    papers=("iso-6336-22",),
)
def _law(
    contact: TribologicalContact,
    *,
    load_factor: float,
    roughness_ra: float | None,
    lubricant_factor: float,
) -> Array:
    state = pitch_state(contact, roughness_ra)
    state["load_per_width"] *= load_factor
    mean = iso_6336_22(**state, lubricant_factor=lubricant_factor)
    return np.full(np.shape(contact.load_per_width), mean)
