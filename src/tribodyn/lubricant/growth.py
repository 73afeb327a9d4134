"""The exponential of a viscosity law, refused before it overflows."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.errors import Argument, InputError, Problem
from tribodyn.types import Array

#: exp(700) is the last decade that a double holds; no liquid comes near it.
_LARGEST_EXPONENT = 700.0


def exponential_growth(exponent: ArrayLike, pressure: ArrayLike, law: str) -> Array:
    """Factor exp(exponent) by which pressure raises the viscosity."""
    exponents = np.asarray(exponent, dtype=float)
    if np.any(exponents > _LARGEST_EXPONENT):
        raise InputError(
            Problem(
                what=f"pressure = {np.max(pressure):.6g} Pa",
                where=Argument("pressure"),
                why=f"the {law} law raises the viscosity there by more than exp(700), "
                "far beyond any liquid",
                remedy="Check the unit of the pressure (Pa) and of the pressure-viscosity "
                "coefficient (1/Pa), or use the Roelands law",
            )
        )
    return np.asarray(np.exp(exponents))[()]
