"""Mean friction of a gear mesh: the formula of Schlenk."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.errors import require_positive
from tribodyn.friction.base import LAWS, TribologicalContact
from tribodyn.friction.mesh_means.pitch_point import OPTIONS, RA_OF_COMPOSITE
from tribodyn.friction.validity import Range, warn_outside
from tribodyn.types import Array

_FASTEST = 35.0  # [m/s] sum of the surface speeds, 50 m/s at the pitch circle


def schlenk(
    load_per_width: ArrayLike,
    sum_velocity: ArrayLike,
    equivalent_radius: ArrayLike,
    dynamic_viscosity: ArrayLike,
    roughness_ra: ArrayLike,
    lubricant_factor: ArrayLike = 1.0,
) -> Array:
    """Mean friction coefficient of a mesh by the formula of Schlenk.

    ``mu = 0.048 (F_bt/b / (v_sum rho))^0.2 eta^-0.05 Ra^0.25 X_L`` at the pitch point; N/mm, m/s,
    mm, mPa s and um.

    Parameters
    ----------
    load_per_width : float or array [N/m]
        Tangential load at the base circle per face width.
    sum_velocity : float or array [m/s]
        SUM of the surface speeds at the pitch point.
    equivalent_radius : float or array [m]
        Reduced radius of curvature at the pitch point.
    dynamic_viscosity : float or array [Pa*s]
        Viscosity at ambient pressure and oil temperature.
    roughness_ra : float or array [m]
        Mean of the arithmetical roughnesses Ra of both flanks.
    lubricant_factor : float or array
        X_L: mineral oil 1, PAO and esters 0.8, polyglycols about 0.7.

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
        Code ``friction-range`` where the speeds add up to more than 35 m/s, which is some 50 m/s
        at the pitch circle, Ra exceeds 4 um or the coefficient 0.2.

    Fitted to FZG tests of steel gears. Source: Schlenk, Diss. TU Munich (1994); ISO/TR 14179-2.

    Examples
    --------
    >>> round(float(schlenk(133022.0, 2.633310, 8.382091e-3, 0.082, 0.53e-6)), 5)
    0.04706
    """
    state = (load_per_width, sum_velocity, equivalent_radius, dynamic_viscosity, roughness_ra)
    coefficient = 0.048 * mean_friction(*state, 0.25, lubricant_factor)
    warn_of_mean("schlenk", coefficient, sum_velocity, roughness_ra)
    return coefficient


def mean_friction(
    load_per_width: ArrayLike,
    sum_velocity: ArrayLike,
    equivalent_radius: ArrayLike,
    dynamic_viscosity: ArrayLike,
    roughness_ra: ArrayLike,
    exponent: float,
    lubricant_factor: ArrayLike,
) -> Array:
    """What all formulas of this family share, in N/mm, m/s, mm, mPa s and um."""
    require_positive("load_per_width", load_per_width, "N/m", remedy="1 N/mm is 1000 N/m")
    require_positive("sum_velocity", sum_velocity, "m/s")
    require_positive("equivalent_radius", equivalent_radius, "m")
    require_positive("dynamic_viscosity", dynamic_viscosity, "Pa*s")
    require_positive("roughness_ra", roughness_ra, "m")
    require_positive("lubricant_factor", lubricant_factor)
    load, speed, radius, viscosity, roughness, factor = (
        scale * np.asarray(value, dtype=float)
        for scale, value in (
            (1e-3, load_per_width),
            (1.0, sum_velocity),
            (1e3, equivalent_radius),
            (1e3, dynamic_viscosity),
            (1e6, roughness_ra),
            (1.0, lubricant_factor),
        )
    )
    hardness = (load / (speed * radius)) ** 0.2 * viscosity**-0.05
    return np.asarray(hardness * roughness**exponent * factor)[()]


def warn_of_mean(
    law: str, coefficient: Array, sum_velocity: ArrayLike, roughness_ra: ArrayLike
) -> None:
    """Warn where a mean coefficient lies outside of what gear tests have shown."""
    warn_outside(
        law,
        (
            Range("sum_velocity", np.asarray(sum_velocity), 0.0, _FASTEST, "m/s"),
            Range("Ra", 1e6 * np.asarray(roughness_ra), 0.0, 4.0, "um"),
            Range("friction coefficient", coefficient, 0.0, 0.2),
        ),
        "Check the units, or compare with another friction law.",
    )


def pitch_state(contact: TribologicalContact, roughness_ra: float | None) -> dict[str, float]:
    """Arguments of the formulas of this family."""
    point = contact.known("pitch")
    ra = RA_OF_COMPOSITE * contact.composite_roughness if roughness_ra is None else roughness_ra
    return {
        "load_per_width": point.load_per_width,
        "sum_velocity": point.sum_velocity,
        "equivalent_radius": point.equivalent_radius,
        "dynamic_viscosity": contact.dynamic_viscosity,
        "roughness_ra": ra,
    }


@LAWS.define(
    "schlenk",
    source="Schlenk, Diss. TU Munich (1994)",
    meaning="mean friction coefficient of a mesh, fitted to FZG tests of loss",
    options=OPTIONS,
    papers=("schlenk",),
)
def _law(
    contact: TribologicalContact, *, roughness_ra: float | None, lubricant_factor: float
) -> Array:
    mean = schlenk(**pitch_state(contact, roughness_ra), lubricant_factor=lubricant_factor)
    return np.full(np.shape(contact.load_per_width), mean)
