"""Mean friction of a gear mesh: the formula of Schlenk."""

from __future__ import annotations

from numpy.typing import ArrayLike

from tribodyn.friction.mesh_means.mean_law import mean_friction, mean_law
from tribodyn.types import Array


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

    Fitted to FZG tests of steel gears; open programs for gearbox losses have the same constants.
    Source: Schlenk, Diss. TU Munich (1994); ISO/TR 14179-2.

    Examples
    --------
    >>> round(float(schlenk(133022.0, 2.633310, 8.382091e-3, 0.082, 0.53e-6)), 5)
    0.04706
    """
    state = (load_per_width, sum_velocity, equivalent_radius, dynamic_viscosity, roughness_ra)
    return mean_friction("schlenk", state, lubricant_factor, lambda *_: 0.048)


mean_law(
    "schlenk",
    source="Schlenk, Diss. TU Munich (1994)",
    meaning="mean friction coefficient of a mesh, fitted to FZG tests of loss",
    papers=("schlenk",),
)(lambda contact, point, state: schlenk(**state))
