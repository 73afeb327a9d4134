"""Common part of the laws of a mean coefficient: formula, range, and options."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.errors import require_positive
from tribodyn.friction.base import LAWS, Range, TribologicalContact, warn_outside
from tribodyn.friction.mesh_means.pitch_point import PitchPoint
from tribodyn.model import number
from tribodyn.types import Array

_FASTEST = 35.0  # [m/s] sum of the surface speeds, 50 m/s at the pitch circle
#: Arguments of the formula: unit, and the factor that makes N/mm, m/s, mm, mPa s and um of it.
_STATE = {
    "load_per_width": ("N/m", 1e-3),
    "sum_velocity": ("m/s", 1.0),
    "equivalent_radius": ("m", 1e3),
    "dynamic_viscosity": ("Pa*s", 1e3),
    "roughness_ra": ("m", 1e6),
}

#: Mean Ra of both flanks over their composite rms roughness, heights being Gaussian and both
#: flanks equal: sqrt(2/pi) of the rms of one, which is composite/sqrt(2).
RA_OF_COMPOSITE = math.sqrt(1.0 / math.pi)

#: Options of every law that is fitted to Ra and knows oils by a factor.
OPTIONS = {
    "roughness_ra": number(
        None,
        1e-9,
        1e-4,
        "guards against a wrong unit",
        unit="m",
        display_unit="um",
        symbol="Ra",
        example='"0.3 um"',
        meaning="mean Ra of both flanks",
        basis="0.564 times the composite rms roughness: Gaussian heights, the same on both flanks",
    ),
    "lubricant_factor": number(
        1.0,
        0.3,
        2.0,
        "published factors lie between 0.5 and 1.5",
        symbol="X_L",
        meaning="factor of the base oil: mineral 1, PAO and esters 0.8, polyglycols 0.6 to 0.7",
        example="0.8",
    ),
}


def mean_friction(
    law: str,
    state: tuple[ArrayLike, ...],
    lubricant_factor: ArrayLike,
    factor: Callable[[Array, Array, Array, Array], Any],
    fastest: float = _FASTEST,
) -> Array:
    """Formula of this family, times a factor of load, speed, radius and viscosity.

    ``state`` is that of ``_STATE`` in SI; the formula and the factor have engineers' units.
    """
    values = []
    for (name, (unit, scale)), value in zip(_STATE.items(), state, strict=True):
        require_positive(name, value, unit, remedy="1 N/mm is 1000 N/m" if unit == "N/m" else "")
        values.append(scale * np.asarray(value, dtype=float))
    require_positive("lubricant_factor", lubricant_factor)
    load, speed, radius, viscosity, roughness = values
    formula = (load / (speed * radius)) ** 0.2 * viscosity**-0.05 * roughness**0.25
    family = factor(load, speed, radius, viscosity) * formula
    coefficient = np.asarray(family * np.asarray(lubricant_factor, dtype=float))[()]
    warn_outside(
        law,
        (
            Range("sum_velocity", speed, 0.0, fastest, "m/s"),
            Range("Ra", roughness, 0.0, 4.0, "um"),
            Range("friction coefficient", coefficient, 0.0, 0.2),
        ),
        "Check the units, or compare with another friction law.",
    )
    return coefficient


def mean_law(
    name: str, *, law_options: Mapping[str, Any] | None = None, rough: bool = True, **about: Any
) -> Callable[[Callable[..., Any]], None]:
    """Register a function of contacts and their pitch point as a law with one value everywhere.

    With ``rough`` it receives the arguments of the formula above as ``state``, and its own options.
    """

    def keep(function: Callable[..., Any]) -> None:
        def law(contact: TribologicalContact, **options: Any) -> Array:
            point: PitchPoint = contact.require("pitch")
            if rough:
                options["state"] = _state(contact, point, options.pop("roughness_ra"))
                options["state"]["lubricant_factor"] = options.pop("lubricant_factor")
            return np.full(np.shape(contact.load_per_width), function(contact, point, **options))

        shared = OPTIONS if rough else {}
        LAWS.define(name, options={**(law_options or {}), **shared}, **about)(law)

    return keep


def _state(contact: TribologicalContact, point: PitchPoint, ra: float | None) -> dict[str, float]:
    return {
        "load_per_width": point.load_per_width,
        "sum_velocity": point.sum_velocity,
        "equivalent_radius": point.equivalent_radius,
        "dynamic_viscosity": contact.dynamic_viscosity,
        "roughness_ra": RA_OF_COMPOSITE * contact.composite_roughness if ra is None else ra,
    }
