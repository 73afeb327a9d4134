"""The table ``[gears]``: pairs of each kind, both gears, and what their flanks have."""

from __future__ import annotations

import inspect
import math
from collections.abc import Iterator
from typing import Any

from tribodyn.errors import Problem
from tribodyn.gear.hypoid.blank import GENERATIONS, HANDS, PROCESSES, RANGES, hypoid_blank
from tribodyn.gear.hypoid.kinematics import ENTRAINMENTS
from tribodyn.model import REQUIRED, Option, choice, file_path, flag, integer, number, numbers, text
from tribodyn.study.case.rating_tables import CutterTable
from tribodyn.study.case.section import Section, Table
from tribodyn.study.case.section import table as inner_table
from tribodyn.study.case.user_input import UserInput, conflicting_keys, with_values
from tribodyn.types import Tree

_GUARD = "guards against a wrong unit"
_RACK = "ISO 53 profiles lie between 0.2 and 1.4"
_MOST = 0.5e-3
#: Rms over mean roughness: sqrt(pi/2), 1.253, of normally distributed heights.
RQ_OVER_RA = 1.25
_TURN = 2.0 * math.pi
_SHAPES = ("linear", "parabolic")


def _relief(of: str) -> Any:
    return number(0.0, 0.0, _MOST, _GUARD, of=of)


def _length(of: str, most: str, basis: str, high: float = 1.0) -> Any:
    return number(None, 0.0, high, f"no longer than {most}", of=of, positive=True, basis=basis)


_FLANK = ("the used flank", "the place where the number of tooth pairs changes")


def _signed(of: str) -> Any:
    return number(0.0, -_MOST, _MOST, _GUARD, of=of)


def _pitches(of: str, meaning: str) -> Any:
    return numbers(-_MOST, _MOST, _GUARD, of=of, meaning=meaning)


class Modification(Section):
    """Modification and deviations of the loaded flanks of a gear from the involute."""

    tip_relief: float = _relief("tip_relief")
    tip_relief_length: float | None = _length("tip_relief_length", *_FLANK)
    tip_relief_shape: str = choice("linear", _SHAPES, meaning="how the tip relief falls to zero")
    root_relief: float = _relief("root_relief")
    root_relief_length: float | None = _length("root_relief_length", *_FLANK)
    root_relief_shape: str = choice("linear", _SHAPES, meaning="how the root relief falls to zero")
    profile_crowning: float = _signed("profile_crowning")
    profile_slope: float = _signed("profile_slope")
    crowning: float = _signed("crowning")
    lead_slope: float = _signed("lead_slope")
    end_relief: float = _relief("end_relief")
    end_relief_length: float | None = _length(
        "end_relief_length", "half the face", "a tenth of the face width", 2.0
    )
    end_relief_shape: str = choice("linear", _SHAPES, meaning="how the end relief falls to zero")
    flank_twist: float = _signed("flank_twist")
    single_pitch_deviation: tuple[float, ...] | None = _pitches(
        "single_pitch_deviation",
        "deviation of the pitch from the flank before, in the order of contact",
    )
    cumulative_pitch_deviation: tuple[float, ...] | None = _pitches(
        "cumulative_pitch_deviation",
        "cumulative pitch deviation of each flank, in the order of contact",
    )
    run_out: float = number(0.0, 0.0, 1e-3, _GUARD, of="run_out")
    run_out_phase: float = number(0.0, -_TURN, _TURN, "one turn", of="run_out_phase")
    wear_depth: tuple[float, ...] | None = numbers(
        0.0,
        _MOST,
        _GUARD,
        of="wear_depth",
        meaning="depth of wear: one value, or several from the lowest point to the tip",
    )
    profile_map: str | None = file_path(
        meaning="CSV file with the measured deviation of the flank", example='"flank.csv"'
    )
    profile_map_interpolation: str = choice(
        "linear", ("linear", "cubic"), meaning="how the map is read between its points"
    )


class Gear(Section):
    """The ``[gears.pinion]`` and ``[gears.wheel]`` tables; None where a default is derived."""

    teeth: int = integer(
        REQUIRED,
        5,
        1000,
        "the range of ISO 1328-1",
        symbol="z",
        example="16",
        meaning="number of teeth, negative for a ring",
        signed=True,
    )
    internal: bool = flag(False, meaning="whether the teeth are internal, as those of a ring")
    hand: str | None = choice(
        None,
        ("right", "left"),
        meaning="hand of the helix of this gear",
        basis="the hand in [gears]",
    )
    profile_shift_coefficient: float = number(
        0.0, -3.0, 3.0, "shifts in use lie between -1 and 1.5", of="profile_shift_coefficient"
    )
    face_width: float | None = number(
        None, 1e-4, 2.0, _GUARD, of="face_width", basis="that of the other gear"
    )
    tip_diameter: float | None = number(
        None,
        1e-4,
        20.0,
        _GUARD,
        of="tip_diameter",
        basis="the standard addendum less the tip shortening",
    )
    bore_diameter: float = number(0.0, 0.0, 20.0, _GUARD, of="bore_diameter")
    material: str | None = text(
        None, meaning="name of its strength in [materials]", example='"18CrNiMo7-6"'
    )
    rim_diameter: float | None = number(
        None, 1e-4, 40.0, _GUARD, of="rim_diameter", basis="a rim of 3.5 modules"
    )
    mass: float | None = number(None, 1e-7, 1e6, _GUARD, of="mass", basis="the solid gear")
    moment_of_inertia: float | None = number(
        None, 1e-14, 1e7, _GUARD, of="moment_of_inertia", basis="the solid gear"
    )
    roughness_rms: float | None = number(
        None, 0.0, 20e-6, "ground to milled flanks; " + _GUARD, of="roughness_rms"
    )
    roughness_ra: float | None = number(
        None, 0.0, 16e-6, "ground to milled flanks; " + _GUARD, of="roughness_ra"
    )
    density: float | None = number(
        None, 500.0, 25000.0, "from polymers to tungsten", of="density",
        meaning="density of this gear, if not that of [material]",
    )  # fmt: skip
    thermal_conductivity: float | None = number(
        None, 0.05, 1000.0, "polymers have 0.2, copper 400 W/m/K", of="thermal_conductivity",
        meaning="thermal conductivity of the gear; steel if not given", example='"47 W/m/K"',
    )  # fmt: skip
    specific_heat: float | None = number(
        None, 100.0, 5000.0, _GUARD, of="specific_heat", example='"460 J/kg/K"'
    )
    cutter: CutterTable | None = inner_table(CutterTable, "cutter of its root, in a rating", "none")
    modification: Modification | None = inner_table(
        Modification, "what the loaded flanks have that the involute has not", "none"
    )

    @property
    def tooth_count(self) -> int:
        """Number of teeth, negative for a ring."""
        return -abs(self.teeth) if self.internal else self.teeth

    @property
    def rms(self) -> float | None:
        """Rms roughness of the flanks [m], given or from Ra; None where neither is."""
        if self.roughness_rms is None and self.roughness_ra is not None:
            return RQ_OVER_RA * self.roughness_ra
        return self.roughness_rms


_AMOUNT = 1e-3


def _amount(meaning: str, low: float = 0.0) -> Any:
    return number(
        0.0, low, _AMOUNT, _GUARD, unit="m", display_unit="um", example='"10 um"', meaning=meaning
    )


def _shift(meaning: str, most: float = 2e-3, unit: str = "m", display_unit: str = "mm") -> Any:
    of = {
        "unit": unit,
        "display_unit": display_unit,
        "example": f'"0.1 {display_unit}"',
        "meaning": meaning,
    }
    return number(0.0, -most, most, "the gap is taken to first order", **of)


class EaseOffData(Section):
    """The ``[gears.ease_off]`` table: material removed from the conjugate pinion flank."""

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
    """The ``[gears.mounting]`` table: mounting errors of the gears."""

    offset: float = _shift("by how much the offset is too large")
    pinion_axial: float = _shift(
        "displacement of the pinion along its axis, away from the crossing point"
    )
    wheel_axial: float = _shift(
        "displacement of the wheel along its axis, away from the crossing point"
    )
    shaft_angle: float = _shift("by how much the shaft angle is too large", 0.02, "rad", "deg")


#: Numbers of a blank as the case file has them.
MEANINGS = {
    "offset": "distance of the axes; negative makes the pinion smaller",
    "outer_pitch_diameter_wheel": "outer pitch diameter of the wheel",
    "face_width_wheel": "face width of the wheel along its pitch cone",
    "mean_spiral_angle_pinion": "spiral angle of the pinion in the calculation point",
    "cutter_radius": "mean radius of the face-mill cutter",
    "shaft_angle": "angle between the axes",
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
    (low, high, unit), inputs = RANGES[name], default is not inspect.Parameter.empty
    display_unit, example = _SHOWN[unit]
    units: Tree = {"unit": unit, "display_unit": display_unit, "example": example}
    basis, start = _TAPER if default is None else "", default if inputs else REQUIRED
    why = "designs in use lie well within"
    option: Option = number(start, low, high, why, meaning=MEANINGS[name], basis=basis, **units)
    return option


#: Keys of ``[gears]`` that only hypoid pairs have.
HYPOID_KEYS: dict[str, Option | Table] = {
    **{name: _of_blank(name) for name in MEANINGS},
    "side": choice(
        "drive",
        {
            "drive": "the concave flank of the pinion pushes",
            "coast": "its convex flank pushes, and both gears turn the other way",
        },
        meaning="side of the teeth that carries",
    ),
    "hand_pinion": choice("left", HANDS, meaning="hand of the pinion; the wheel has the other one"),
    "process": choice(
        "face-milling", PROCESSES, meaning="how the teeth are cut along their length"
    ),
    "wheel_generation": choice(
        "formate", GENERATIONS, meaning="whether the wheel rolls with the cutter or is formed by it"
    ),
    "blade_groups": integer(
        None,
        3,
        40,
        "cutters in use have 5 to 19",
        example="13",
        meaning="blade groups of a face-hobbing cutter, which needs them",
        basis="none, in face milling",
    ),
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
    "stiffness_model": choice(
        "line",
        {
            "line": "line_stiffness, the same for every length of contact line",
            "fe3d": "finite elements of the teeth of both gears, coupled along the contact lines",
        },
        meaning="how the teeth of the pair give way",
    ),
    "entrainment": choice(
        "contact",
        ENTRAINMENTS,
        meaning="entrainment relative to the moving contact line, or in the fixed frame",
    ),
    "ease_off": inner_table(
        EaseOffData, "what the pinion has less than the conjugate flank", "empty"
    ),
    "mounting": inner_table(MountingData, "displacements of the gears from their places", "empty"),
}
#: Keys that both kinds of gears with flanks have.
_ALSO_OF_HYPOID = ("composite_roughness", "roughness_rms", "roughness_ra")


class Gears(Section):
    """The ``[gears]`` table."""

    kind: str = choice(
        "spur",
        {
            "spur": "cylindrical gears, spur or helical, external or internal",
            "hypoid": "hypoid or spiral bevel gears",
            "table": "mesh table of another program",
        },
        meaning="kind of gear pair",
    )
    table: str | None = file_path(
        meaning="mesh table of another program, as CSV or netCDF", example='"mesh.csv"'
    )
    normal_module: float = number(
        REQUIRED, 0.05e-3, 0.1, "ISO 54 modules run from 1 to 50 mm", of="normal_module"
    )
    normal_pressure_angle: float = number(
        REQUIRED,
        math.radians(10.0),
        math.radians(35.0),
        "basic racks lie between 14.5 and 30 deg",
        of="normal_pressure_angle",
    )
    center_distance: float | None = number(
        None, 1e-4, 10.0, _GUARD, of="center_distance", basis="the profile shifts, without backlash"
    )
    driver: str = choice(REQUIRED, ("pinion", "wheel"), meaning="the gear that drives")
    helix_angle: float = number(
        0.0, 0.0, math.radians(60.0), "the hand gives its sign", of="helix_angle"
    )
    hand: str | None = choice(
        None,
        ("right", "left"),
        meaning="hand of the pinion's helix",
        basis="the hand of a gear, right where none has one",
    )
    composite_roughness: float | None = number(
        None,
        0.0,
        20e-6,
        "ground to milled flanks; " + _GUARD,
        of="composite_roughness",
        argument="roughness",
    )
    addendum_coefficient: float = number(1.0, 0.2, 1.5, _RACK, of="addendum_coefficient")
    dedendum_coefficient: float = number(
        1.25, 0.2, 1.8, _RACK, of="dedendum_coefficient", argument="rack"
    )
    rack_tip_radius_coefficient: float | None = number(
        None,
        0.0,
        0.6,
        "ISO 53 profiles lie between 0.25 and 0.39",
        basis="ISO 53: 0.38, or the full round where that is smaller",
        of="rack_tip_radius_coefficient",
        argument="tip_radius_coefficient",
    )
    misalignment: float = number(0.0, -0.5e-3, 0.5e-3, _GUARD, of="misalignment")
    pinion: Gear = inner_table(Gear, "the smaller gear")
    wheel: Gear = inner_table(Gear, "the larger gear")

    @property
    def by_name(self) -> dict[str, Gear]:
        """Both gears by name."""
        return {"pinion": self.pinion, "wheel": self.wheel}

    @property
    def driven(self) -> str:
        """Name of the driven gear."""
        return "wheel" if self.driver == "pinion" else "pinion"


Gears.needed = ("normal_module", "normal_pressure_angle", "driver", "pinion", "wheel")
# Keys of a hypoid pair stand before the tables of both gears.
_gear_tables = {name: Gears.fields.pop(name) for name in ("pinion", "wheel")}
Gears.fields |= {**HYPOID_KEYS, **_gear_tables}
#: Keys of ``[gears]`` that every kind of pair has, and those that other kinds than spur gears have.
_OF_ALL = ("kind", "driver", "teeth", "mass", "moment_of_inertia")
_OF = {"table": (*_OF_ALL, "table"), "hypoid": (*_OF_ALL, *_ALSO_OF_HYPOID)}
#: Tables of a case that say nothing about such a pair.
_IDLE = {
    "table": ("stiffness", "material", "film", "materials", "rating"),
    "hypoid": ("stiffness", "materials", "rating"),
}
_REQUIRED = {
    "spur": ("gears.normal_module", "gears.normal_pressure_angle"),
    "hypoid": tuple(f"gears.{n}" for n, o in HYPOID_KEYS.items() if getattr(o, "required", False)),
}


def is_idle(key: str, kind: str | None) -> bool:
    """Return whether a dotted key has no effect for this kind of gear pair."""
    section, _, name = key.partition(".")
    if section != "gears":
        return section in _IDLE.get(kind or "spur", ())
    if name.partition(".")[0] in HYPOID_KEYS:
        return kind != "hypoid"
    if name == "table":
        return kind != "table"
    return kind in _OF and name.rpartition(".")[2] not in _OF[str(kind)]


def is_needed(key: str, kind: str | None) -> bool:
    """Return whether a missing key is required for this kind of gear pair."""
    return all(
        key not in keys or kind_of == (kind or "spur") for kind_of, keys in _REQUIRED.items()
    )


#: Stiffness model of helical pairs unless one is chosen: slices of the face act on each other.
HELICAL_STIFFNESS = "fe3d"


def with_gear_defaults(inputs: UserInput) -> UserInput:
    """Return the input with the stiffness model of helical pairs where none is chosen."""
    helix = inputs.get("gears.helix_angle")
    plain = isinstance(inputs.get("stiffness"), str) or inputs.get("gears.kind", "spur") != "spur"
    if plain or "stiffness.model" in inputs or not helix or str(helix).split()[0] in ("0", "0.0"):
        return inputs
    return UserInput(with_values(inputs.data, {"stiffness.model": HELICAL_STIFFNESS}))


def heat_of_bodies(inputs: UserInput) -> Iterator[tuple[str, Problem]]:
    """Check that thermal conductivity and specific heat of a gear are given together."""
    for gear in ("pinion", "wheel"):
        keys = [f"gears.{gear}.{name}" for name in ("thermal_conductivity", "specific_heat")]
        present = [key for key in keys if key in inputs]
        if len(present) == 1:
            absent = next(key for key in keys if key not in inputs)
            name = absent.rpartition(".")[2]
            why = f"{inputs.show(present[0])} of the {gear} needs its counterpart"
            example = {"specific_heat": "460 J/kg/K", "thermal_conductivity": "47 W/m/K"}[name]
            remedy = f'Add {name} = "{example}", that of steel, or remove both'
            yield absent, Problem(f"{name} of the {gear} is missing", "", why, remedy)


def size_problems(inputs: UserInput) -> Iterator[tuple[str, Problem]]:
    """Check that the pinion has fewer teeth."""
    pinion, wheel = (inputs.get(f"gears.{gear}.teeth") for gear in ("pinion", "wheel"))
    ring = (type(wheel) is int and wheel < 0) or inputs.get("gears.wheel.internal")
    if type(pinion) is int and type(wheel) is int and not ring and pinion > wheel:
        what = f"teeth = {pinion} of the pinion and teeth = {wheel} of the wheel"
        why = "The pinion is the gear with fewer teeth, whichever drives"
        remedy = "Exchange the two tables, speed_of and driver"
        yield "gears.pinion.teeth", Problem(what, "", why, remedy)


def ring_problems(inputs: UserInput) -> Iterator[tuple[str, Problem]]:
    """Check the keys of internal teeth and of the hand of the helix."""
    spur = inputs.get("gears.kind", "spur") == "spur"
    for gear in ("pinion", "wheel"):
        key = f"gears.{gear}.teeth"
        if type(teeth := inputs.get(key)) is not int or teeth >= 0:
            continue
        if not spur:
            why = "Only cylindrical gears have internal teeth"
            yield key, Problem(inputs.show(key), "", why, f"Write teeth = {-teeth}")
        elif inputs.get(f"gears.{gear}.internal") is False:
            yield conflicting_keys(inputs, key, f"gears.{gear}.internal")
    if (
        (key := "gears.pinion.hand") in inputs
        and "gears.hand" in inputs
        and inputs[key] != inputs["gears.hand"]
    ):
        yield conflicting_keys(inputs, "gears.hand", key)
    if (key := "gears.pinion.rim_diameter") in inputs:
        why = "Only a ring, which is the wheel, has its rim outside"
        yield key, Problem(inputs.show(key), "", why, "Remove it, or give the bore diameter")
    if inputs.get(key := "gears.pinion.internal") is True:
        why = "Only the wheel of a pair may be a ring"
        yield key, Problem(inputs.show(key), "", why, "Exchange the two gears")
