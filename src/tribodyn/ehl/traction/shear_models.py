"""Shear models of the oil by name."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

from tribodyn.ehl.traction import newtonian, ree_eyring
from tribodyn.registry import Registry
from tribodyn.types import Array


@dataclass(frozen=True)
class ShearModel:
    """A shear model: mean shear stress over the film from what drives it."""

    name: str  #: name in the registry
    source: str  #: paper behind the model
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
