"""An oil with two ways to thin: its polymer after Carreau, its base oil after Eyring."""

from __future__ import annotations

import numpy as np

from tribodyn.ehl.traction.carreau import THINNING
from tribodyn.ehl.traction.carreau import carreau as _carreau
from tribodyn.ehl.traction.ree_eyring import EYRING
from tribodyn.ehl.traction.ree_eyring import eyring as _eyring
from tribodyn.ehl.traction.shear_models import SHEAR_MODELS
from tribodyn.types import Array


@SHEAR_MODELS.define(
    "carreau-eyring",
    source="Carreau (1972), inside of Ree and Eyring (1955)",
    options={**EYRING, **THINNING},
    across=SHEAR_MODELS["ree-eyring"].across,
    meaning="an oil that thins after Carreau, and what is left of it after Ree and Eyring",
    papers=("carreau", "yasuda-armstrong-cohen", "ree-eyring"),
)
def _carreau_eyring(
    rate: Array, limit: Array, *, eyring_stress: float, **thinning: float
) -> tuple[Array, Array]:
    """Eyring's stress ``tau_0 asinh(tau_C/tau_0)`` of the viscosity that Carreau leaves."""
    thinned, slope = _carreau(rate, limit, **thinning)
    stress, outer = _eyring(thinned, limit, eyring_stress=eyring_stress)
    # Slopes are over logarithms: the outer one is over that of the thinned stress.
    return stress, outer * np.divide(slope, thinned, out=np.ones_like(slope), where=thinned > 0.0)
