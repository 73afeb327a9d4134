"""Shear models of the oil by name."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

from tribodyn.ehl.traction import newtonian, ree_eyring
from tribodyn.model import Registry
from tribodyn.types import Array


@dataclass(frozen=True)
class ShearModel:
    """A shear model: mean shear stress over the film from what drives it."""

    name: str  #: name in the registry
    source: str  #: paper behind the model
    log_rate: Callable[[Array, Array, Array, float], Array] = field(repr=False)
    stress: Callable[[Array, float], tuple[Array, Array]] = field(repr=False)
    meaning: str = ""  #: one line


#: Shear models by name.
SHEAR_MODELS: Registry[ShearModel] = Registry("shear model")

for _model in (
    ShearModel(
        "newtonian",
        "Newton (1687)",
        newtonian.log_rate,
        newtonian.stress,
        "an oil whose shear stress is in proportion to the shear rate",
    ),
    ShearModel(
        "ree-eyring",
        "Ree and Eyring (1955); Conry, Wang and Cusano (1987)",
        ree_eyring.log_rate,
        ree_eyring.stress,
        "an oil that thins under shear after Ree and Eyring",
    ),
):
    SHEAR_MODELS.register(_model.name)(_model)
