"""Shear models of the oil by name: how its mean shear stress follows from the shear rate."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from tribodyn.errors import Argument, InputError, require_between, require_positive
from tribodyn.model import NO_OPTIONS, Model, Registry, number
from tribodyn.types import Array

#: Limiting stress ``tau_L0 + Lambda p``, which every model may have.
LIMIT = {
    "limiting_stress": number(2e6, 1e4, 1e9, "oils have a few MPa", of="limiting_stress"),
    "limiting_stress_slope": number(
        0.05, 0.0, 0.3, "oils lie between 0.02 and 0.12", of="limiting_stress_slope"
    ),
}


@dataclass(frozen=True)
class ShearModel(Model):
    """A shear model: ``stress(rate, limit, **numbers)`` is the mean over the film.

    The rate is ``eta v_s/h`` [Pa], the stress that Newton's oil would have; the limit is that of
    the stress [Pa], infinite for none. The stress comes with its slope over ``ln(rate)``.
    """

    name: str  #: name in the registry
    source: str  #: paper behind the model
    stress: Callable[..., tuple[Array, Array]] = field(repr=False)
    options: Mapping[str, Any] = field(default_factory=lambda: NO_OPTIONS)  #: numbers of the oil
    meaning: str = ""  #: one line
    papers: tuple[str, ...] = ()  #: keys of the bibliography
    #: Logarithm of what a pressure step h dp/dx leaves of the viscosity; None for all of it.
    across: Callable[..., Array] | None = field(default=None, repr=False)

    def complete(
        self, eyring_stress: float, numbers: Mapping[str, float | None]
    ) -> dict[str, float]:
        """All numbers of this model: those that are None at their defaults, others refused.

        The Eyring stress always has a value, so that a model without it leaves it alone. Without
        a number of the limit there is none, unless the model is made of it.
        """
        given = {name: value for name, value in numbers.items() if value is not None}
        known = {**self.declared, **(LIMIT if given.keys() & LIMIT.keys() else {})}
        for name in sorted(given.keys() - known.keys()):
            raise InputError(
                f'{name} does not belong to shear_model = "{self.name}"',
                Argument(name),
                f"Its numbers are: {', '.join({**known, **LIMIT})}",
                "Remove it, or choose another shear model",
            )
        require_positive("eyring_stress", eyring_stress, "Pa", remedy="5 MPa is 5e6 Pa")
        values = {**{n: o.default for n, o in known.items()}, "eyring_stress": eyring_stress}
        values |= given
        for name, option in known.items():
            require_between(name, values[name], 0.0, np.inf, option.unit)
            if option.low > 0.0:
                require_positive(name, values[name], option.unit)
        return {name: values[name] for name in known}


#: Shear models by name.
SHEAR_MODELS: Registry[ShearModel] = Registry("shear model", None, ShearModel, "stress")
