"""Shear models of the oil by name."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from tribodyn.ehl import newtonian, ree_eyring
from tribodyn.registry import Registry

__all__ = ["SHEAR_MODELS", "ShearModel"]

Array = NDArray[np.float64]


@dataclass(frozen=True)
class ShearModel:
    """A shear model: mean shear stress over the film from what drives it.

    The first step does not know the sliding speed, so it is done once for all contacts that have
    the same film.

    Parameters
    ----------
    name : str
        Name in the registry.
    source : str
        Paper behind the model.
    log_rate : callable
        ``log_rate(log_viscosity, film_thickness, pressure_gradient, eyring_stress)``: logarithm
        of the factor that turns the sliding speed into the argument of ``stress``.
    stress : callable
        ``stress(rate, eyring_stress)``: mean shear stress [Pa] and its slope over the logarithm
        of the rate.

    Examples
    --------
    >>> SHEAR_MODELS.names()
    ['newtonian', 'ree-eyring']
    """

    name: str
    source: str
    log_rate: Callable[[Array, Array, Array, float], Array] = field(repr=False)
    stress: Callable[[Array, float], tuple[Array, Array]] = field(repr=False)


#: Shear models by name.
SHEAR_MODELS: Registry[ShearModel] = Registry("shear model")

for _model in (
    ShearModel("newtonian", "Newton (1687)", newtonian.log_rate, newtonian.stress),
    ShearModel(
        "ree-eyring",
        "Ree and Eyring (1955); Conry, Wang and Cusano (1987)",
        ree_eyring.log_rate,
        ree_eyring.stress,
    ),
):
    SHEAR_MODELS.register(_model.name)(_model)
