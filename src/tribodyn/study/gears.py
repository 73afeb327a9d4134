"""The ``[gears]`` section of the case file: the pair, the pinion and the wheel."""

from __future__ import annotations

from pydantic import Field

from tribodyn.study.fields import choice, integer, number
from tribodyn.study.modification import Modification
from tribodyn.study.section import Section

_GUARD = "guards against a wrong unit"
_RACK = "ISO 53 profiles lie between 0.2 and 1.4"


class Gear(Section):
    """The ``[gears.pinion]`` and ``[gears.wheel]`` tables; None where a default is derived."""

    teeth: int = integer(
        ..., 5, 1000, "the range of ISO 1328-1", symbol="z", example="16", meaning="number of teeth"
    )
    profile_shift_coefficient: float = number(
        0.0, -3.0, 3.0, "shifts in use lie between -1 and 1.5", of="profile_shift_coefficient"
    )
    face_width: float | None = number(None, 1e-4, 2.0, _GUARD, of="face_width")
    tip_diameter: float | None = number(None, 1e-4, 20.0, _GUARD, of="tip_diameter")
    bore_diameter: float = number(0.0, 0.0, 20.0, _GUARD, of="bore_diameter")
    mass: float | None = number(None, 1e-7, 1e6, _GUARD, of="mass")
    moment_of_inertia: float | None = number(None, 1e-14, 1e7, _GUARD, of="moment_of_inertia")
    roughness_rms: float | None = number(
        None, 0.0, 20e-6, "ground to milled flanks; " + _GUARD, of="roughness_rms"
    )
    modification: Modification | None = Field(
        None, description="what the loaded flanks have that the involute has not"
    )


class Gears(Section):
    """The ``[gears]`` table."""

    kind: str = choice("spur", ("spur",), later=("hypoid",), meaning="kind of gear pair")
    normal_module: float = number(
        ..., 0.05e-3, 0.1, "ISO 54 modules run from 1 to 50 mm", of="normal_module"
    )  # fmt: skip
    normal_pressure_angle: float = number(
        ..., 0.17453292519943295, 0.6108652381980153, "basic racks lie between 14.5 and 30 deg",
        of="normal_pressure_angle"
    )  # fmt: skip
    center_distance: float | None = number(None, 1e-4, 10.0, _GUARD, of="center_distance")
    driver: str = choice(..., ("pinion", "wheel"), meaning="the gear that drives")
    composite_roughness: float | None = number(
        None, 0.0, 20e-6, "ground to milled flanks; " + _GUARD, of="composite_roughness"
    )
    addendum_coefficient: float = number(1.0, 0.2, 1.5, _RACK, of="addendum_coefficient")
    dedendum_coefficient: float = number(1.25, 0.2, 1.8, _RACK, of="dedendum_coefficient")
    rack_tip_radius_coefficient: float = number(
        0.38,
        0.0,
        0.6,
        "ISO 53 profiles lie between 0.25 and 0.39",
        of="rack_tip_radius_coefficient",
    )
    misalignment: float = number(0.0, -0.5e-3, 0.5e-3, _GUARD, of="misalignment")
    pinion: Gear = Field(description="the smaller gear")
    wheel: Gear = Field(description="the larger gear")
