"""Mean friction of a gear mesh for micropitting: ISO/TS 6336-22."""

from __future__ import annotations

from numpy.typing import ArrayLike

from tribodyn.friction.mesh_means.mean_law import mean_friction, mean_law
from tribodyn.friction.mesh_means.pitch_point import PitchPoint
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
    load_per_width, sum_velocity, equivalent_radius, dynamic_viscosity, roughness_ra
        State at the pitch point, each in the same unit as for :func:`schlenk`; the load times
        the load factors K of ISO 6336-1.
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

    No second source of the constants was found. Source: ISO/TS 6336-22:2018 (before: ISO/TR
    15144-1), mean coefficient of friction.

    Examples
    --------
    >>> print(round(float(iso_6336_22(133022.0, 2.6333, 8.382e-3, 0.082, 0.53e-6)), 4))
    0.057
    """
    state = (load_per_width, sum_velocity, equivalent_radius, dynamic_viscosity, roughness_ra)
    return mean_friction(
        "iso-6336-22", state, lubricant_factor, lambda _, v, rho, eta: 0.045 * 2.2 * rho**-0.25
    )


_LOAD_FACTOR = number(
    1.0,
    0.5,
    10.0,
    "load factors of ISO 6336-1 lie between 1 and 4",
    meaning="product of the load factors of ISO 6336-1 on the load",
    symbol="K",
    example="1.3",
)


@mean_law(
    "iso-6336-22",
    source="ISO/TS 6336-22:2018",
    meaning="mean friction coefficient of a mesh, as the micropitting standard has it",
    law_options={"load_factor": _LOAD_FACTOR},
    papers=("iso-6336-22",),
)
def _law(contact: object, point: PitchPoint, state: dict[str, float], load_factor: float) -> Array:
    return iso_6336_22(**{**state, "load_per_width": load_factor * point.load_per_width})
