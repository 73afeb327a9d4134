"""Hypoid pairs in the case file: their keys in ``[gears]``, and the flanks that they make."""

from __future__ import annotations

import inspect
import math
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.errors import Argument, InputError, ModelWarning, collected
from tribodyn.gear.hypoid.blank import HANDS, RANGES, hypoid_blank
from tribodyn.gear.hypoid.kinematics import ENTRAINMENTS
from tribodyn.model import REQUIRED, Option, choice, number, numbers
from tribodyn.study.case.section import Section, Table, table

if TYPE_CHECKING:
    from tribodyn.gear import HypoidFlanks, Misalignment
    from tribodyn.study.case.gears import Gears

_GUARD = "guards against a wrong unit"
_AMOUNT = 1e-3


def _amount(meaning: str, low: float = 0.0) -> Any:
    return number(
        0.0, low, _AMOUNT, _GUARD, unit="m", display_unit="um", example='"10 um"', meaning=meaning
    )


def _shift(meaning: str, most: float = 2e-3, unit: str = "m", shown: str = "mm") -> Any:
    return number(0.0, -most, most, "the gap is taken to first order", unit=unit,
                  display_unit=shown, example=f'"0.1 {shown}"', meaning=meaning)  # fmt: skip


class EaseOffData(Section):
    """The ``[gears.ease_off]`` table: what the pinion's flank has less than the conjugate one."""

    lengthwise_crowning: float = _amount("gap at toe and heel, as a parabola")
    profile_crowning: float = _amount("gap at tip and root, as a parabola")
    bias: float = _amount("gap added at heel and tip and at toe and root", -_AMOUNT)
    tip_relief: float = _amount("gap at the tip of the wheel")
    root_relief: float = _amount("gap at the lowest working depth of the wheel")
    relief_length: float | None = number(
        None,
        1e-6,
        0.1,
        _GUARD,
        unit="m",
        display_unit="mm",
        example='"3 mm"',
        meaning="length of both reliefs",
        basis="three tenths of the working depth",
    )
    center: tuple[float, ...] | None = numbers(
        -1.0,
        1.0,
        _GUARD,
        unit="m",
        display_unit="mm",
        example='"0 mm", "-2.2 mm"',
        meaning="place of the centre along and across the wheel's pitch cone",
        basis="the calculation point lengthwise, the middle of the working depth",
    )


class MountingData(Section):
    """The ``[gears.mounting]`` table: where the gears are not where they should be."""

    offset: float = _shift("by how much the offset is too large")
    pinion_axial: float = _shift("way of the pinion along its axis, away from the crossing point")
    wheel_axial: float = _shift("way of the wheel along its axis, away from the crossing point")
    shaft_angle: float = _shift("by how much the shaft angle is too large", 0.02, "rad", "deg")


_MEANINGS = {
    "offset": "distance of the axes; negative makes the pinion smaller",
    "outer_pitch_diameter_wheel": "outer pitch diameter of the wheel",
    "face_width_wheel": "face width of the wheel along its pitch cone",
    "mean_spiral_angle_pinion": "spiral angle of the pinion in the calculation point",
    "cutter_radius": "mean radius of the face-mill cutter",
    "pressure_angle_drive": "design pressure angle of the drive side",
    "pressure_angle_coast": "design pressure angle of the coast side",
    "limit_pressure_angle_factor": "part of the limit pressure angle that corrects both sides",
    "addendum_factor_wheel": "mean addendum of the wheel over the working depth",
    "depth_factor": "working depth over the mean normal module",
    "clearance_factor": "clearance over the working depth",
    "thickness_factor": "by how much the pinion's tooth is thicker than half the pitch, in modules",
    "outer_backlash": "transverse backlash at the outer pitch diameter of the wheel",
    "addendum_angle_wheel": "angle between tip and pitch cone of the wheel",
    "dedendum_angle_wheel": "angle between pitch and root cone of the wheel",
}
_SHOWN = {"m": ("mm", '"30 mm"'), "rad": ("deg", '"45 deg"'), "": ("", "1.0")}
_TAPER = "the standard taper"


def _of_blank(name: str) -> Option:
    default = inspect.signature(hypoid_blank).parameters[name].default
    (low, high, unit), given = RANGES[name], default is not inspect.Parameter.empty
    shown, example = _SHOWN[unit]
    option: Option = number(
        default if given else REQUIRED,
        low,
        high,
        "designs in use lie well within",
        unit=unit,
        display_unit=shown,
        example=example,
        meaning=_MEANINGS[name],
        basis=_TAPER if default is None else "",
    )
    return option


#: Keys of ``[gears]`` that only hypoid pairs have.
HYPOID_KEYS: dict[str, Option | Table] = {
    **{name: _of_blank(name) for name in _MEANINGS},
    "side": choice(
        "drive",
        {
            "drive": "the concave flank of the pinion pushes",
            "coast": "its convex flank pushes, and both gears turn the other way",
        },
        meaning="side of the teeth that carries",
    ),
    "hand_pinion": choice("left", HANDS, meaning="hand of the pinion; the wheel has the other one"),
    "line_stiffness": number(
        14e9,
        1e8,
        1e12,
        _GUARD,
        unit="N/m^2",
        display_unit="N/(mm*um)",
        example='"14 N/(mm*um)"',
        meaning="stiffness of the teeth of a pair over the length of their contact line",
    ),
    "entrainment": choice(
        "contact",
        ENTRAINMENTS,
        meaning="entrainment relative to the moving contact line, or in the fixed frame",
    ),
    "ease_off": table(EaseOffData, "what the pinion has less than the conjugate flank", "empty"),
    "mounting": table(MountingData, "displacements of the gears from their places", "empty"),
}
#: Keys that both kinds of gears with flanks have.
ALSO_OF_HYPOID = ("composite_roughness", "roughness_rms", "roughness_ra")


@contextmanager
def _placed_in(table: str) -> Iterator[None]:
    """Place the arguments of the physics under the table of the case that they came from."""
    try:
        yield
    except InputError as error:
        raise InputError(
            [
                replace(each, where=Argument(table + each.where.name.removeprefix("blank.")))
                if isinstance(each.where, Argument)
                else each
                for each in error.problems
            ]
        ) from None


def hypoid_flanks(gears: Gears) -> HypoidFlanks:
    """Flanks of the side that carries, silently; what was to be said is in the warnings."""
    return _built(gears)[0]


def hypoid_warnings(gears: Gears) -> tuple[ModelWarning, ...]:
    """Warnings about blank and flanks."""
    return _built(gears)[1]


@lru_cache(maxsize=16)
def _built(gears: Gears) -> tuple[HypoidFlanks, tuple[ModelWarning, ...]]:
    from tribodyn.gear import EaseOff
    from tribodyn.gear import hypoid_flanks as flanks_of

    values = {name: getattr(gears, name) for name in (*_MEANINGS, "hand_pinion")}
    eased = {name: getattr(gears.ease_off, name) for name, _ in EaseOffData.specs()}
    with collected() as found:
        with _placed_in("ease_off."):
            ease_off = EaseOff(**eased)
        with _placed_in(""):
            blank = hypoid_blank(gears.pinion.teeth, gears.wheel.teeth, **values)
            flanks = flanks_of(blank, gears.side, ease_off)
    return flanks, tuple(found)


@lru_cache(maxsize=16)
def contact_ratio(gears: Gears) -> float:
    """Rotation over which a pair has contact lines, over the pitch."""
    from tribodyn.gear.hypoid.contact_lines import ContactLines

    flanks = hypoid_flanks(gears)
    low, high = ContactLines(flanks.conjugate).span()
    return (high - low) * flanks.blank.teeth_wheel / (2.0 * math.pi)


def mounting(gears: Gears) -> Misalignment:
    """Displacements of both gears."""
    from tribodyn.gear import Misalignment

    return Misalignment(**{n: getattr(gears.mounting, n) for n, _ in MountingData.specs()})


def levers(flanks: HypoidFlanks) -> tuple[float, float]:
    """Levers of the normal in the calculation point about the axes of pinion and wheel [m]."""
    wheel = float(flanks.conjugate.touch(np.zeros(2)).lever)
    return wheel / flanks.blank.ratio, wheel


def solid(flanks: HypoidFlanks, density: float) -> dict[str, tuple[float, float]]:
    """Mass and polar inertia of both toothed cones, cut at the pitch cone, without shafts."""
    found, blank = {}, flanks.blank
    for gear in ("pinion", "wheel"):
        cone = getattr(blank, f"pitch_angle_{gear}")
        outer, inner = (getattr(blank, f"{end}_cone_distance_{gear}") for end in ("outer", "inner"))
        one, two, height = (
            outer * math.sin(cone),
            inner * math.sin(cone),
            (outer - inner) * math.cos(cone),
        )
        scale = math.pi * density * height
        mass = scale / 3.0 * (one**2 + one * two + two**2)
        found[gear] = (mass, scale / 10.0 * sum(one**k * two ** (4 - k) for k in range(5)))
    return found
