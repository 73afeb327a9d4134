"""How teeth touch: material, roughness, oil, and the models of stiffness, film and friction."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from types import MappingProxyType
from typing import Any

from tribodyn.ehl import FILM_MODELS
from tribodyn.errors import require_between
from tribodyn.gear import Material
from tribodyn.lubricant import Lubricant

NO_OPTIONS: Mapping[str, Any] = MappingProxyType({})
#: Largest composite roughness that is a roughness and not a slip of the unit [m].
_LARGEST_ROUGHNESS = 1e-4
#: Kinds of film stiffness that are springs; the printed sum of one source has the unit of a length.
_IN_SERIES = ("tangent", "secant")


@dataclass(frozen=True, eq=False)
class ToothContact:
    """Settings of a tooth contact, whatever the gears, their speed and their load."""

    material: Material
    lubricant: Lubricant
    stiffness_model: str = "potential-energy"
    stiffness_options: Mapping[str, Any] = field(default_factory=dict)
    composite_roughness: float = 0.0  #: [m]
    film_model: str = "none"
    film_options: Mapping[str, Any] = field(default_factory=dict)
    friction_law: str = "none"
    friction_options: Mapping[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        require_between(
            "composite_roughness", self.composite_roughness, 0.0, _LARGEST_ROUGHNESS, "m"
        )

    @cached_property
    def film(self) -> dict[str, Any]:
        """Options of the film model, its defaults filled in."""
        return dict(FILM_MODELS[self.film_model].complete(self.film_options))

    @property
    def film_in_series(self) -> bool:
        """Whether the film of each pair is a spring in series with its teeth."""
        return self.film["stiffness"] in _IN_SERIES
