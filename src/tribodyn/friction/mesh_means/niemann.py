"""Mean friction of a gear mesh: Niemann and Winter."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.errors import require_one_of, require_positive
from tribodyn.friction.base import LAWS, TribologicalContact
from tribodyn.friction.mesh_means.pitch_point import OPTIONS
from tribodyn.friction.mesh_means.schlenk import mean_friction, pitch_state, warn_of_mean
from tribodyn.model import choice
from tribodyn.types import Array

#: Published forms and what they are.
FORMS = {
    "winter-michaelis": "0.045 (F_bt/b / (v_sum rho))^0.2 eta^-0.05 X_R X_L with "
    "X_R = 3.8 (Ra/d_1)^0.25",
    "iso-tc60": "the older 0.12 (F_bt/b Ra / (eta v_sum rho))^0.25, without a factor of the oil",
}


def niemann(
    load_per_width: ArrayLike,
    sum_velocity: ArrayLike,
    equivalent_radius: ArrayLike,
    dynamic_viscosity: ArrayLike,
    roughness_ra: ArrayLike,
    pinion_diameter: ArrayLike,
    lubricant_factor: ArrayLike = 1.0,
    *,
    form: str = "winter-michaelis",
) -> Array:
    """Mean friction coefficient of a mesh by Niemann and Winter.

    ``mu = 0.045 (F_bt/b / (v_sum rho))^0.2 eta^-0.05 X_R X_L`` with ``X_R = 3.8 (Ra/d_1)^0.25``, or
    the older ``mu = 0.12 (F_bt/b Ra / (eta v_sum rho))^0.25`` of ISO/TC 60; N/mm, m/s, mm, mPa s
    and um.

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
    pinion_diameter : float or array [m]
        Pitch diameter of the pinion.
    lubricant_factor : float or array
        X_L: mineral oil 1, PAO and esters 0.8, polyglycols about 0.7.
    form : {"winter-michaelis", "iso-tc60"}
        Published form.

    Returns
    -------
    float or array
        Friction coefficient, of the common shape of the arguments.

    Raises
    ------
    InputError
        If a value is not finite or not positive, or the form is unknown.

    Warns
    -----
    ModelWarning
        Code ``friction-range`` where the speeds add up to more than 35 m/s, Ra exceeds 4 um or the
        coefficient 0.2.

    Source: Niemann and Winter, Maschinenelemente II; Winter and Michaelis (1985); the older form as
    listed by Xu et al. (2007).

    Examples
    --------
    >>> print(round(float(niemann(133022.0, 2.6333, 8.382e-3, 0.082, 0.53e-6, 73.2e-3)), 4))
    0.0573
    """
    require_one_of("form", form, FORMS)
    require_positive("pinion_diameter", pinion_diameter, "m")
    state = (load_per_width, sum_velocity, equivalent_radius, dynamic_viscosity, roughness_ra)
    family = mean_friction(*state, 0.25, lubricant_factor)
    if form == "iso-tc60":
        # The family has the powers 0.2, -0.05 and 0.25; all are 0.25 here.
        load, speed, radius, viscosity = (np.asarray(value, dtype=float) for value in state[:4])
        rest = 1e-6 * load / (speed * radius)
        bare = family / np.asarray(lubricant_factor, dtype=float)
        coefficient = 0.12 * bare * rest**0.05 * (1e3 * viscosity) ** -0.2
    else:
        coefficient = 0.045 * 3.8 * family * (1e3 * np.asarray(pinion_diameter)) ** -0.25
    coefficient = np.asarray(coefficient)[()]
    warn_of_mean("niemann", coefficient, sum_velocity, roughness_ra)
    return coefficient


@LAWS.define(
    "niemann",
    source="Niemann and Winter, Maschinenelemente II (2003)",
    meaning="mean friction coefficient of a mesh, as the textbook on machine elements has it",
    options={"form": choice("winter-michaelis", FORMS, meaning="published form"), **OPTIONS},
    papers=("niemann-winter",),
)
def _law(
    contact: TribologicalContact,
    *,
    form: str,
    roughness_ra: float | None,
    lubricant_factor: float,
) -> Array:
    mean = niemann(
        **pitch_state(contact, roughness_ra),
        pinion_diameter=contact.known("pitch").pinion_pitch_diameter,
        lubricant_factor=lubricant_factor,
        form=form,
    )
    return np.full(np.shape(contact.load_per_width), mean)
