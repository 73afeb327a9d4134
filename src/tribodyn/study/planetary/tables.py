"""The ``[planets.NAME]`` table of a case file."""

from __future__ import annotations

import math
from typing import Any

from tribodyn.model import REQUIRED, integer, number, numbers, text
from tribodyn.study.case.section import Section
from tribodyn.study.machine.tables import MeshTable

_GUARD = "guards against a wrong unit"
_TURN = 2.0 * math.pi
#: Keys of a mesh that both meshes of a stage share.
_SHARED = (
    "normal_module",
    "center_distance",
    "addendum_coefficient",
    "dedendum_coefficient",
    "rack_tip_radius_coefficient",
    "composite_roughness",
    "normal_pressure_angle",
    "helix_angle",
    "hand",
)
#: Stiffness of a support that is not given [N/m].
STIFF = 1e9


def _support(meaning: str, basis: str = "") -> Any:
    return number(
        STIFF, 0.0, 1e14, _GUARD, unit="N/m", example='"1e8 N/m"', meaning=meaning, basis=basis
    )


def _errors(meaning: str) -> Any:
    length = {"unit": "m", "display_unit": "um", "example": '["20 um", "0 um", "0 um"]'}
    return numbers(-1e-2, 1e-2, _GUARD, meaning=meaning, **length)


class PlanetsTable(Section):
    """A ``[planets.NAME]`` table."""

    fields = {name: MeshTable.fields[name] for name in _SHARED}  # noqa: RUF012

    sun: str = text(REQUIRED, meaning="gear in the middle", example='"s"')
    ring: str = text(REQUIRED, meaning="gear with internal teeth", example='"r"')
    planet: str = text(REQUIRED, meaning="gear between sun and ring", example='"p"')
    carrier: str = text(REQUIRED, meaning="name of the carrier", example='"c"')
    count: int = integer(REQUIRED, 1, 24, "more do not fit", meaning="number of planets")
    angles: tuple[float, ...] | None = numbers(
        -_TURN,
        _TURN,
        "one turn",
        unit="rad",
        display_unit="deg",
        example='["0 deg", "120 deg", "240 deg"]',
        meaning="angles of the planets about the sun; equally spaced by default",
    )
    pin_stiffness: float = _support("radial stiffness of each planet on the carrier")
    sun_support: float = _support("radial stiffness of the supports of the sun; 0 lets it float")
    ring_support: float = _support("radial stiffness of the supports of the ring; 0 lets it float")
    carrier_support: float = _support(
        "radial stiffness of the supports of the carrier; 0 lets it float"
    )
    torsional_support: float = _support(
        "stiffness of the held member against rotation, along its base circle or that of the pins"
    )
    carrier_mass: float | None = number(
        None, 1e-9, 1e6, _GUARD, of="mass", meaning="mass of the carrier", basis="a steel disc"
    )
    carrier_moment_of_inertia: float | None = number(
        None,
        1e-14,
        1e7,
        _GUARD,
        of="moment_of_inertia",
        meaning="moment of inertia of the carrier about its axis",
        basis="a steel disc",
    )
    pin_errors: tuple[float, ...] | None = _errors(
        "distance by which each pin is ahead of its place, from x towards y"
    )
    thickness_errors: tuple[float, ...] | None = _errors(
        "excess of the base tooth thickness of each planet"
    )
