"""Mean friction of a gear mesh: Niemann and Winter."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.errors import require_one_of, require_positive
from tribodyn.friction.mesh_means.mean_law import mean_friction, mean_law
from tribodyn.friction.mesh_means.pitch_point import PitchPoint
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
    load_per_width, sum_velocity, equivalent_radius, dynamic_viscosity, roughness_ra
        State at the pitch point, each in the same unit as for :func:`schlenk`.
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

    No second source of the constants was found. Source: Niemann and Winter, Maschinenelemente II;
    Winter and Michaelis (1985); the older form as listed by Xu et al. (2007).

    Examples
    --------
    >>> print(round(float(niemann(133022.0, 2.6333, 8.382e-3, 0.082, 0.53e-6, 73.2e-3)), 4))
    0.0573
    """
    require_one_of("form", form, FORMS)
    require_positive("pinion_diameter", pinion_diameter, "m")
    state = (load_per_width, sum_velocity, equivalent_radius, dynamic_viscosity, roughness_ra)
    size = 3.8 * (1e3 * np.asarray(pinion_diameter, dtype=float)) ** -0.25

    def old(load: Array, speed: Array, radius: Array, viscosity: Array) -> Array:
        """Powers 0.25 of all instead of the family's 0.2 and -0.05, and no factor of the oil."""
        powers = (load / (speed * radius)) ** 0.05 * viscosity**-0.2
        return np.asarray(0.12 * powers / np.asarray(lubricant_factor, dtype=float))

    factor = old if form == "iso-tc60" else lambda *_: 0.045 * size
    return mean_friction("niemann", state, lubricant_factor, factor)


@mean_law(
    "niemann",
    source="Niemann and Winter, Maschinenelemente II (2003)",
    meaning="mean friction coefficient of a mesh, as the textbook on machine elements has it",
    law_options={"form": choice("winter-michaelis", FORMS, meaning="published form")},
    papers=("niemann-winter",),
)
def _law(contact: object, point: PitchPoint, state: dict[str, float], form: str) -> Array:
    return niemann(**state, pinion_diameter=point.pinion_pitch_diameter, form=form)
