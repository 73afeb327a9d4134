"""Tables of a machine in a case file: the parts by their names, operation, motion, models."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import MISSING, fields, replace
from functools import cache
from typing import Any

from tribodyn.machine import COUPLINGS, ROLLING_BEARINGS, STEEL
from tribodyn.machine.rolling.roller_bearing import ROLLING_MEANINGS
from tribodyn.model import (
    REQUIRED,
    Option,
    choice,
    file_path,
    flag,
    integer,
    number,
    text,
)
from tribodyn.study.case import gears
from tribodyn.study.case.pair import PairCase
from tribodyn.study.case.rating_tables import BearingCatalogue, NotchTable, ShaftStrength
from tribodyn.study.case.section import NamedTables, Section, Table, table
from tribodyn.study.case.sections import AUTO, BALANCE, Dynamics, MaterialData, Solver

_GUARD = "guards against a wrong unit"
_RPM = math.pi / 30.0
_TURN = 2.0 * math.pi
#: Tables of models that hold for all meshes, and that a mesh may have for itself.
SHARED = ("material", "lubricant", "film", "stiffness", "friction", "materials", "rating")
_MODELS = {name: replace(PairCase.fields[name], default="none") for name in SHARED}  # type: ignore[type-var]
#: Keys of ``[dynamics]`` of a pair that belong to its mesh.
MESH_KEYS = tuple(n for n in Dynamics.fields if n not in ("model", "bearing_damping_ratio"))
_OF_DYNAMICS = {
    name: replace(option, default=None, basis="[dynamics]")
    for name, option in Dynamics.specs()
    if name in MESH_KEYS
}
#: Groups of parts, with a table for each part.
GROUPS = ("shafts", "bearings", "gears", "meshes", "couplings", "faults")
#: Keys of ``[lubricant]`` of the heat balance, which is that of the whole machine.
HEAT = ("heat_transfer", "gear_heat_transfer", "ambient_temperature")


def _stiffness(meaning: str, unit: str = "N/m", **more: Any) -> Any:
    more.setdefault("example", f'"4e8 {unit}"')
    return number(more.pop("default", None), 0.0, 1e14, _GUARD, unit=unit, meaning=meaning, **more)


def clearance(meaning: str) -> Any:
    """Declare a radial clearance."""
    length = {"unit": "m", "display_unit": "um", "example": '"20 um"', "meaning": meaning}
    return number(0.0, 0.0, 0.01, _GUARD, **length)


def _listed(default: Any, meaning: str, example: str, **more: Any) -> Any:
    """Declare a list that is checked where its part is made."""
    return Option("list", meaning, default, example=example, **more)


def position(meaning: str, default: Any = REQUIRED, **more: Any) -> Any:
    """Declare a place along an axis."""
    length_in_mm = {"unit": "m", "display_unit": "mm", "example": '"85 mm"', "meaning": meaning}
    return number(default, -100.0, 100.0, _GUARD, **length_in_mm, **more)


class Notches(NamedTables, inner=table(NotchTable, "a notched section")):
    """The table ``[shafts.NAME.notches]``."""


class ShaftTable(MaterialData):
    """A ``[shafts.NAME]`` table."""

    fields = {**MaterialData.fields, **ShaftStrength.fields}  # noqa: RUF012

    sections: Any = _listed(
        None,
        "sections along x: length, outer and inner diameter, and for a cone both diameters of the "
        "end; a rigid shaft by default",
        '[["60 mm", "40 mm"], ["20 mm", "50 mm", "10 mm"]]',
        unit="m",
        display_unit="mm",
    )
    density: float = number(STEEL.density, 500.0, 25000.0, "polymers to tungsten", of="density")
    moment_of_inertia: float = number(
        0.0, 0.0, 1e7, _GUARD,
        of="moment_of_inertia",
        meaning="moment of inertia of what turns with its beginning, such as an engine",
    )  # fmt: skip
    notches: Section | None = table(Notches, "notched sections, by name", "none")


#: Units of the geometry of rolling bearings by the end of the name.
_UNITS = {
    "diameter": ("m", "mm"), "length": ("m", "mm"), "width": ("m", "mm"), "clearance": ("m", "um"),
    "angle": ("rad", "deg"), "modulus": ("Pa", "GPa"), "preload": ("N", "N"),
    "temperature": ("K", "degC"),
}  # fmt: skip


@cache
def rolling_options(law: type) -> dict[str, Option]:
    """Options of a rolling bearing from the fields of its class."""
    options = {}
    for field in fields(law):
        if not field.init:
            continue
        default = None if field.default is MISSING else field.default
        kind = str(field.type)
        meaning = ROLLING_MEANINGS.get(field.name, field.name.replace("_", " "))
        counts = (-1, 1) if field.name == "direction" else (2, 1000)
        if "int" in kind and "float" not in kind:
            options[field.name] = integer(default, *counts, "counted", meaning=meaning)
        elif "bool" in kind:
            options[field.name] = flag(default, meaning=meaning)
        elif "str" in kind:
            options[field.name] = text(default, meaning=meaning)
        else:
            unit, display_unit = _UNITS.get(field.name.rpartition("_")[2], ("", ""))
            example = f'"1 {display_unit}"' if display_unit else "1.0"
            units = {"unit": unit, "display_unit": display_unit, "example": example}
            options[field.name] = number(default, -math.inf, math.inf, "", meaning=meaning, **units)
    return options


class BearingTable(BearingCatalogue):
    """A ``[bearings.NAME]`` table, with the geometry of the rolling bearing that it names."""

    shaft: str = text(REQUIRED, meaning="shaft that it carries", example='"input"')
    position: float = position("position of its mid plane on the shaft")
    type: str | None = choice(
        None,
        tuple(ROLLING_BEARINGS),
        meaning="rolling bearing, which is linearized at its load; a linear support by default",
    )
    radial_stiffness: tuple[float, ...] | float | None = _stiffness(
        "stiffness across the shaft, one value or those along y and z", pair=True
    )
    axial_stiffness: float = _stiffness("stiffness along the shaft", default=0.0)
    tilting_stiffness: tuple[float, ...] | float = _stiffness(
        "stiffness against tilting, one value or those about y and z",
        "N*m/rad",
        default=0.0,
        pair=True,
    )
    torsional_stiffness: float = _stiffness(
        "stiffness against rotation of a shaft that is held, such as that of a ring",
        "N*m/rad",
        default=0.0,
    )
    radial_damping: tuple[float, ...] | float = _stiffness(
        "damping across the shaft, one value or those along y and z",
        "N*s/m",
        default=0.0,
        pair=True,
    )
    axial_damping: float = _stiffness("damping along the shaft", "N*s/m", default=0.0)
    tilting_damping: tuple[float, ...] | float = _stiffness(
        "damping against tilting, one value or those about y and z",
        "N*m*s/rad",
        default=0.0,
        pair=True,
    )
    clearance: float = clearance(
        "radial distance that the shaft can move before it is held; half of the diametral clearance"
    )
    floating: bool = flag(
        False,
        meaning="whether its ring slides along its seat and takes no axial force; of a rolling "
        "bearing without contact angle, the other one of the shaft locates it",
    )
    node: str | None = text(None, meaning="node of the housing that carries it", example='"seat A"')

    @classmethod
    def keys_for(cls, data: Mapping[str, Any]) -> Mapping[str, Option | Table]:
        """Keys of a support, and those of its rolling bearing; of an unknown type those of all."""
        name, laws = str(data.get("type", "")), ROLLING_BEARINGS.all()
        named = [laws[name]] if name in laws else list(laws.values()) if name else []
        rolling = {key: option for law in named for key, option in rolling_options(law).items()}
        return {**cls.fields, **{k: o for k, o in rolling.items() if k not in cls.fields}}


# Keys of the life follow the others.
for _name in BearingCatalogue.fields:
    BearingTable.fields[_name] = BearingTable.fields.pop(_name)


class GearTable(gears.Gear):
    """A ``[gears.NAME]`` table of a machine: a gear of a pair, and its place on a shaft."""

    teeth: int = integer(
        REQUIRED,
        -1000,
        1000,
        "the range of ISO 1328-1; negative for internal teeth",
        symbol="z",
        example="27",
        meaning="number of teeth",
    )
    shaft: str = text(REQUIRED, meaning="shaft that carries it", example='"input"')
    position: float | None = position(
        "position of its mid face on the shaft; of a rigid shaft at its node if not given", None
    )
    transverse_moment_of_inertia: float | None = number(
        None, 1e-14, 1e7, _GUARD,
        of="moment_of_inertia",
        meaning="moment of inertia about an axis across the shaft",
        basis="the solid gear",
    )  # fmt: skip


#: Keys of ``[gears]`` of a pair that belong to one mesh of a machine.
_OF_PAIR = (
    "normal_module", "center_distance", "composite_roughness", "addendum_coefficient",
    "dedendum_coefficient", "rack_tip_radius_coefficient",
)  # fmt: skip


_KINDS = {
    "spur": "cylindrical gears, spur or helical, external or internal",
    "hypoid": "hypoid or bevel gears, whose axes cross or intersect",
}


def _kind_of_mesh(default: str) -> Any:
    return choice(default, _KINDS, meaning="kind of gear pair")


def _names(what: str, example: str) -> Any:
    return _listed(REQUIRED, f"names of both {what}", example)


class MeshTable(Section):
    """A ``[meshes.NAME]`` table; its tables of models are completed with the pair of gears."""

    fields = {  # noqa: RUF012
        "gears": _names("gears", '["z1", "z2"]'),
        **{name: gears.Gears.fields[name] for name in _OF_PAIR},
        **_OF_DYNAMICS,
    }

    kind: str = _kind_of_mesh("spur")

    normal_pressure_angle: float = number(
        math.radians(20.0), math.radians(10.0), math.radians(35.0),
        "basic racks lie between 14.5 and 30 deg",
        of="normal_pressure_angle",
    )  # fmt: skip
    helix_angle: float = number(
        0.0, 0.0, math.radians(60.0), "the hand gives its sign",
        unit="rad",
        display_unit="deg",
        example='"21 deg"',
        meaning="helix angle at the reference circle; 0 for spur gears",
    )  # fmt: skip
    hand: str | None = choice(
        None,
        ("right", "left"),
        meaning="hand of the teeth of the first gear",
        basis="the hand of a gear, right where none has one",
    )
    angle: float = number(
        0.0, -_TURN, _TURN, "one turn",
        unit="rad",
        display_unit="deg",
        example='"30 deg"',
        meaning="direction from the axis of the first gear to that of the second, from y towards z",
    )  # fmt: skip
    stiffness: float | None = number(
        None, 1e3, 1e13, _GUARD,
        unit="N/m",
        example='"5.2e8 N/m"',
        meaning="constant along the transverse line of action, in place of the model",
    )  # fmt: skip
    offset: float = number(
        0.0, 0.0, 1.0, "a part of the mesh cycle", meaning="mesh phase when the clock begins"
    )

    @classmethod
    def keys_for(cls, data: Mapping[str, Any]) -> Mapping[str, Option | Table]:
        """Keys of a mesh of its kind, and tables of its models."""
        return with_models(mesh_table_kind(data).fields, data)


def with_models(
    keys: Mapping[str, Option | Table], data: Mapping[str, Any]
) -> Mapping[str, Option | Table]:
    """Keys of a mesh or a stage with tables of models; ``stiffness`` may be a number too."""
    number = "stiffness" in keys and not isinstance(data.get("stiffness"), Mapping)
    return {**keys, **{k: table for k, table in _MODELS.items() if k != "stiffness" or not number}}


def _apex(gear: str) -> Any:
    return choice("+x", ("+x", "-x"), meaning=f"side of the {gear} on which its apex lies")


class HypoidMeshTable(Section):
    """A ``[meshes.NAME]`` table of hypoid or bevel gears; ``offset`` is that of the axes."""

    fields = {  # noqa: RUF012
        name: option
        for name, option in {
            "gears": _names("gears", '["z1", "z2"]'),
            **gears.HYPOID_KEYS,
            "composite_roughness": gears.Gears.fields["composite_roughness"],
            **_OF_DYNAMICS,
        }.items()
        if name != "side"
    }

    kind: str = _kind_of_mesh("hypoid")
    angle: float = number(
        0.0,
        -_TURN,
        _TURN,
        "one turn",
        unit="rad",
        display_unit="deg",
        example='"90 deg"',
        meaning="direction of the common perpendicular from the first axis, from y towards z",
    )
    apex_pinion: str = _apex("pinion")
    apex_wheel: str = _apex("wheel")
    stiffness: float | None = number(
        None,
        1e3,
        1e13,
        _GUARD,
        unit="N/m",
        example='"5.7e8 N/m"',
        meaning="constant along the normal of the flanks, in place of the model",
    )


def mesh_table_kind(body: Mapping[str, Any]) -> type[Section]:
    """Table of a mesh by its ``kind``; of an unknown one, which is reported, by its keys."""
    kind = str(body.get("kind", "spur"))
    crossed = kind == "hypoid" or (kind not in _KINDS and "cutter_radius" in body)
    return HypoidMeshTable if crossed else MeshTable


class CouplingTable(Section):
    """A ``[couplings.NAME]`` table, with the options of its model as keys."""

    fields = {  # noqa: RUF012
        "shafts": _names("shafts", '["engine", "input"]'),
        "model": choice("linear", COUPLINGS.names, meaning="kind of coupling"),
        **COUPLINGS["linear"].case_options,
    }

    @classmethod
    def keys_for(cls, data: Mapping[str, Any]) -> Mapping[str, Option | Table]:
        """Keys of a coupling of its model, of an unknown one those of a linear one."""
        model = COUPLINGS.all().get(str(data.get("model", "linear")))
        common = {name: cls.fields[name] for name in ("shafts", "model")}
        return cls.fields if model is None else {**common, **model.case_options}


class MeshDynamics(Section):
    """Keys of ``[dynamics]`` that a mesh with a constant stiffness has."""

    fields = {  # noqa: RUF012
        name: Dynamics.fields[name]
        for name in (
            "mesh_damping",
            "mesh_damping_ratio",
            "backlash",
            "transmission_error_amplitude",
            "transmission_error_phase",
        )
    }


class HousingTable(Section):
    """The ``[housing]`` table."""

    nodes: Any = _listed(
        None,
        "rows of the matrices of each node along x, y, z and about them; -1 without",
        '{ "seat A" = [0, 1, 2, -1, -1, -1] }',
    )
    matrices: str | None = file_path(
        meaning="NumPy file with K, M, optional C, and names of the nodes; a Nastran punch file "
        "with DMIG entries or an Abaqus substructure, whose nodes are named by their numbers",
        example='"housing.npz"',
    )
    units: str | None = choice(
        None,
        {"m-kg-s": "metres, kilograms", "mm-t-s": "millimetres, tonnes"},
        meaning="units of files of Nastran, Abaqus and Ansys, which do not state them",
    )
    stiffness_file: str | None = file_path(
        meaning="Matrix Market file, Abaqus matrix output or Ansys Harwell-Boeing file",
        example='"K.mtx"',
    )
    mass_file: str | None = file_path(meaning="file of the same kind", example='"M.mtx"')
    damping_file: str | None = file_path(meaning="file of the same kind", example='"C.mtx"')
    mapping_file: str | None = file_path(
        meaning="nodes of the rows of Harwell-Boeing files, as Ansys writes them",
        example='"K.mapping"',
    )


class OperationTable(Section):
    """The ``[operation]`` table of a machine."""

    input: str = text(REQUIRED, meaning="shaft whose speed and torque are given", example='"input"')
    output: str = text(REQUIRED, meaning="shaft where the power leaves", example='"output"')
    speed: float = number(
        REQUIRED, -2e5 * _RPM, 2e5 * _RPM, _GUARD, of="speed", meaning="speed of the input"
    )
    torque: float = number(
        REQUIRED, -1e8, 1e8, _GUARD, of="torque", meaning="torque on the input shaft"
    )


_OF_OPERATION: dict[str, Any] = {"default": None, "basis": "[operation]"}


class LoadCaseTable(Section):
    """A ``[[load_cases]]`` table."""

    share: Any = Option(
        "share", "share of the time, a number up to 1 or a percentage", example='"30 %"'
    )
    name: str | None = text(None, meaning="name of the load case", example='"cruise"')
    speed: float | None = replace(OperationTable.fields["speed"], **_OF_OPERATION)  # type: ignore[assignment]
    torque: float | None = replace(OperationTable.fields["torque"], **_OF_OPERATION)  # type: ignore[assignment]


class MotionTable(Section):
    """The ``[dynamics]`` table of a machine, with keys that its meshes share."""

    modal_damping_ratio: float = number(
        0.02,
        0.0,
        1.0,
        "gearboxes lie between 0.005 and 0.05",
        meaning="damping of each mode of shafts, bearings and housing over its critical value",
    )
    harmonics: int = integer(
        20, 1, 64, "more only cost time", meaning="harmonics of a mesh in its spectra", example="20"
    )
    frequency_limit: float | None = number(
        None, 1.0, 1e6, _GUARD, unit="Hz", example='"12 kHz"',
        meaning="highest frequency that the reduced structure meets",
        basis="six times the highest mesh frequency, at least 5 kHz",
    )  # fmt: skip
    seat_mass: float | None = number(
        None, 1e-6, 1e6, _GUARD, of="mass", meaning="mass of a bearing seat with its sensor"
    )
    seat_frequency: float | None = number(
        None,
        1.0,
        1e6,
        _GUARD,
        unit="Hz",
        example='"2 kHz"',
        meaning="natural frequency of a bearing seat",
    )
    seat_damping_ratio: float = number(
        0.05, 1e-4, 0.9, "over the critical damping", meaning="damping of a bearing seat"
    )


MotionTable.fields |= {
    name: replace(option, default=None) for name, option in Dynamics.specs() if name in MESH_KEYS
}


class SolverTable(Section):
    """The ``[solver]`` table of a machine."""

    engine: str = choice(AUTO, {
        AUTO: "harmonic balance; where it finds no motion, the march in modal coordinates",
        BALANCE: "the periodic motion from the harmonics of the contact forces, or an error",
    }, meaning="how the motion is found")  # fmt: skip
    coupling: str = Solver.fields["coupling"]  # type: ignore[assignment]
    coupling_tolerance: float = Solver.fields["coupling_tolerance"]  # type: ignore[assignment]
    phases: str = choice(
        "auto",
        {
            "auto": "over phases where the common period is long",
            "on": "over phases whatever the common period",
            "off": "over the common period of all meshes",
        },
        meaning="whether the motion is found over phases of the meshes, without a common period",
    )
    memory: float = number(
        4e9, 1e7, 1e13, _GUARD, unit="byte", display_unit="GB", example='"4 GB"',
        meaning="most memory of a motion; what needs more is refused before it is computed",
    )  # fmt: skip


SOLVER_OF_PAIRS = tuple(name for name in Solver.fields if name not in SolverTable.fields)
