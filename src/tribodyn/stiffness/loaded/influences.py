"""Structure of both gears of a pair by a stiffness model, kept for all loads."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import lru_cache
from typing import Any

from tribodyn.errors import ModelWarning, collected, warn
from tribodyn.gear import Material, SpurGear, SpurPair
from tribodyn.stiffness.model import StiffnessModel


def gear_influences(
    pair: SpurPair, material: Material, model: StiffnessModel, options: Mapping[str, Any]
) -> tuple[Any, Any]:
    """Structure of pinion and wheel by a model that knows it, the same under every load."""
    model.require_known_teeth(pair)
    reference = {**model.options, **options}["reference"]
    gears = pair.gears.values()
    pinion, wheel = (_influence(model.influence, gear, material, reference) for gear in gears)
    return pinion, wheel


def _influence(*arguments: Any) -> Any:
    influence, model_warnings = _cached_influence(*arguments)
    for warning in model_warnings:
        warn(warning.code, warning.message, stacklevel=4)
    return influence


@lru_cache(maxsize=8)
def _cached_influence(
    model: Callable[..., Any], gear: SpurGear, material: Material, reference: str
) -> tuple[Any, list[ModelWarning]]:
    with collected() as model_warnings:
        return model(gear, material, reference=reference), model_warnings
