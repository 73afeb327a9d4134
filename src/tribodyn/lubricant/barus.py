"""Viscosity under pressure: the exponential law of Barus, and the limit of every such law."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.errors import Argument, InputError, require_between, require_positive
from tribodyn.types import Array

#: exp(700) is the last decade that a double holds; no liquid comes near it.
_LARGEST_EXPONENT = 700.0


def exponential_growth(exponent: ArrayLike, pressure: ArrayLike, law: str) -> Array:
    """Factor exp(exponent) by which pressure raises the viscosity."""
    exponents = np.asarray(exponent, dtype=float)
    if np.any(exponents > _LARGEST_EXPONENT):
        raise InputError(
            f"pressure = {np.max(pressure):.6g} Pa",
            where=Argument("pressure"),
            why=f"the {law} law raises the viscosity there by more than exp(700), "
            "far beyond any liquid",
            remedy="Check the unit of the pressure (Pa) and of the pressure-viscosity "
            "coefficient (1/Pa), or use the Roelands law",
        )
    return np.asarray(np.exp(exponents))[()]


def barus_viscosity(
    pressure: ArrayLike, dynamic_viscosity: float, pressure_viscosity_coefficient: float
) -> Array:
    """Viscosity under pressure by Barus: ``eta0 exp(alpha p)``.

    Parameters
    ----------
    pressure : float or array [Pa]
        Pressure above ambient, not negative.
    dynamic_viscosity, pressure_viscosity_coefficient : float [Pa*s], [1/Pa]
        Viscosity at ambient pressure, and slope of its logarithm over the pressure.

    Returns
    -------
    float or array [Pa*s]
        Same shape as ``pressure``.

    Raises
    ------
    InputError
        If a value is out of range or the viscosity overflows.

    Valid to about 0.1 GPa; above, it exceeds measured viscosities by orders of magnitude.
    Source: Barus (1893).

    Examples
    --------
    >>> round(float(barus_viscosity(100e6, 0.082, 2.19e-8)), 6)
    0.732687
    """
    require_between("pressure", pressure, 0.0, np.inf, "Pa")
    require_positive("dynamic_viscosity", dynamic_viscosity, "Pa*s")
    require_between(
        "pressure_viscosity_coefficient", pressure_viscosity_coefficient, 0.0, 1e-6, "1/Pa"
    )
    exponent = pressure_viscosity_coefficient * np.asarray(pressure, dtype=float)
    return dynamic_viscosity * exponential_growth(exponent, pressure, "Barus")
