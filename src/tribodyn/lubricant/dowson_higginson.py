"""Density under pressure: the relation of Dowson and Higginson."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.errors import require_between, require_positive
from tribodyn.types import Array

_RISE = 0.6e-9  # [1/Pa], compressibility at ambient pressure
_LIMIT = 1.7e-9  # [1/Pa], bounds the rise to 0.6/1.7 = 35 %


def dowson_higginson_density(pressure: ArrayLike, density: float) -> Array:
    """Density under pressure: ``rho0 [1 + 0.6e-9 p / (1 + 1.7e-9 p)]`` with p in Pa.

    Parameters
    ----------
    pressure : float or array [Pa]
        Pressure above ambient, not negative.
    density : float [kg/m^3]
        Density at ambient pressure.

    Returns
    -------
    float or array [kg/m^3]
        Same shape as ``pressure``.

    Raises
    ------
    InputError
        If the pressure is negative or the density is not positive.

    A fit to mineral oils up to about 0.4 GPa, used far above in the literature.
    Source: Dowson and Higginson (1966).

    Examples
    --------
    >>> round(float(dowson_higginson_density(1e9, 880.0)), 3)
    1075.556
    """
    require_between("pressure", pressure, 0.0, np.inf, "Pa")
    require_positive("density", density, "kg/m^3")
    pressures = np.asarray(pressure, dtype=float)
    return np.asarray(density * (1.0 + _RISE * pressures / (1.0 + _LIMIT * pressures)))[()]
