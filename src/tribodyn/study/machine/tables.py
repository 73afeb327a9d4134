"""Tables of a machine in a case file: shafts, bearings, gears, meshes, planets, operation."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

from tribodyn.machine import COUPLINGS, ROLLING_BEARINGS, STEEL
from tribodyn.model import REQUIRED, choice, file_path, flag, integer, number, numbers, text
from tribodyn.study.case import gears
from tribodyn.study.case.rating_tables import BearingCatalogue, PartRating, ShaftStrength
from tribodyn.study.case.section import Section
from tribodyn.study.case.sections import Dynamics, MaterialData, Solver
from tribodyn.study.faults.section import PartFaultTable

_GUARD = "guards against a wrong unit"
_RPM = math.pi / 30.0
_TURN = 2.0 * math.pi


def _stiffness(meaning: str, unit: str = "N/m", **more: Any) -> Any:
    more.setdefault("example", f'"4e8 {unit}"')
    return number(more.pop("default", None), 0.0, 1e14, _GUARD, unit=unit, meaning=meaning, **more)


def _clearance(meaning: str) -> Any:
    length = {"unit": "m", "display_unit": "um", "example": '"20 um"', "meaning": meaning}
    return number(0.0, 0.0, 0.01, _GUARD, **length)


def _position(meaning: str, default: Any = REQUIRED, **more: Any) -> Any:
    length_in_mm = {"unit": "m", "display_unit": "mm", "example": '"85 mm"', "meaning": meaning}
    return number(default, -100.0, 100.0, _GUARD, **length_in_mm, **more)


class ShaftTable(MaterialData):
    """A ``[shafts.NAME]`` table; its ``sections`` and ``notches`` are read apart."""

    fields = {**MaterialData.fields, **ShaftStrength.fields}  # noqa: RUF012

    density: float = number(STEEL.density, 500.0, 25000.0, "polymers to tungsten", of="density")
    moment_of_inertia: float = number(
        0.0, 0.0, 1e7, _GUARD,
        of="moment_of_inertia",
        meaning="moment of inertia of what turns with its beginning, such as an engine",
    )  # fmt: skip


class BearingTable(BearingCatalogue):
    """A ``[bearings.NAME]`` table of a linear support; those of a rolling bearing are apart."""

    shaft: str = text(REQUIRED, meaning="shaft that it carries", example='"input"')
    position: float = _position("position of its mid plane on the shaft")
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
    clearance: float = _clearance(
        "radial distance that the shaft can move before it is held; half of the diametral clearance"
    )
    floating: bool = flag(
        False,
        meaning="whether its ring slides along its seat and takes no axial force; of a rolling "
        "bearing without contact angle, the other one of the shaft locates it",
    )
    node: str | None = text(None, meaning="node of the housing that carries it", example='"seat A"')


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
    position: float | None = _position(
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


class MeshTable(Section):
    """A ``[meshes.NAME]`` table; its tables of models are read with the pair of gears."""

    fields = {name: gears.Gears.fields[name] for name in _OF_PAIR}  # noqa: RUF012

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
    hand: str = choice("right", ("right", "left"), meaning="hand of the teeth of the first gear")
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


def _apex(gear: str) -> Any:
    return choice("+x", ("+x", "-x"), meaning=f"side of the {gear} on which its apex lies")


class HypoidMeshTable(Section):
    """A ``[meshes.NAME]`` table of hypoid or bevel gears; ``offset`` is that of the axes."""

    fields = {  # noqa: RUF012
        name: option
        for name, option in {
            **gears.HYPOID_KEYS,
            "composite_roughness": gears.Gears.fields["composite_roughness"],
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


def _coupling_table(name: str) -> type[Section]:
    """Table of a coupling of a model, whose options are its keys; its shafts are read apart."""
    model = COUPLINGS.all().get(name, COUPLINGS["linear"])
    kind = choice("linear", COUPLINGS.names, meaning="kind of coupling")
    fields = {"model": kind, **model.case_options}
    table: type[Section] = type("CouplingTable", (Section,), {"fields": fields})
    return table


#: The ``[couplings.NAME]`` table of a linear coupling.
CouplingTable = _coupling_table("linear")


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
    """The ``[housing]`` table; its nodes are read apart."""

    matrices: str | None = file_path(
        meaning="NumPy file with K, M, optional C, and names of the nodes", example='"housing.npz"'
    )
    stiffness_file: str | None = file_path(meaning="Matrix Market file", example='"K.mtx"')
    mass_file: str | None = file_path(meaning="Matrix Market file", example='"M.mtx"')
    damping_file: str | None = file_path(meaning="Matrix Market file", example='"C.mtx"')


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


class LoadCaseTable(Section):
    """A ``[[load_cases]]`` table; its share is read apart."""

    name: str | None = text(None, meaning="name of the load case", example='"cruise"')
    speed: float = OperationTable.fields["speed"]  # type: ignore[assignment]
    torque: float = OperationTable.fields["torque"]  # type: ignore[assignment]


class MotionTable(Section):
    """The ``[dynamics]`` table of a machine, without the keys of its meshes."""

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


class SolverTable(Section):
    """The ``[solver]`` table of a machine."""

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


#: Keys of a mesh that both meshes of a stage share.
_OF_STAGE = (
    "normal_module", "center_distance", "addendum_coefficient", "dedendum_coefficient",
    "rack_tip_radius_coefficient", "composite_roughness", "normal_pressure_angle", "helix_angle",
    "hand",
)  # fmt: skip
#: Stiffness of a support that is not given [N/m].
STIFF = 1e9


def _support(meaning: str, basis: str = "") -> Any:
    return number(
        STIFF, 0.0, 1e14, _GUARD, unit="N/m", example='"1e8 N/m"', meaning=meaning, basis=basis
    )


def _errors(meaning: str) -> Any:
    length = {"unit": "m", "display_unit": "um", "example": '["20 um", "0 um", "0 um"]'}
    return numbers(-1e-2, 1e-2, _GUARD, meaning=meaning, **length)


_PLANET_TYPES = {
    "single": "planets with one gear",
    "stepped": "planets with two gears on one shaft, the second at the ring",
    "meshed": "pairs of planets that mesh with each other, the second at the ring",
}


class PlanetsTable(Section):
    """A ``[planets.NAME]`` table."""

    fields = {  # noqa: RUF012
        **{name: MeshTable.fields[name] for name in _OF_STAGE},
        **{f"pin_{name}": option for name, option in BearingCatalogue.fields.items()},
    }

    sun: str = text(REQUIRED, meaning="gear in the middle", example='"s"')
    ring: str = text(REQUIRED, meaning="gear with internal teeth", example='"r"')
    planet: str = text(REQUIRED, meaning="gear between sun and ring", example='"p"')
    carrier: str = text(REQUIRED, meaning="name of the carrier", example='"c"')
    planet_type: str = choice("single", _PLANET_TYPES, meaning="kind of planets")
    ring_planet: str | None = text(
        None, meaning="gear at the ring of double planets; planet is that at the sun", example='"q"'
    )
    ring_normal_module: float | None = number(
        None, 0.05e-3, 0.1, "ISO 54 modules run from 1 to 50 mm", of="normal_module",
        meaning="module of the ring and its gears of stepped planets", basis="that of the sun",
    )  # fmt: skip
    ring_center_distance: float | None = _position(
        "distance from the sun to the planets at the ring of pairs, from the profile shifts of the "
        "ring mesh by default",
        None,
    )
    pair_center_distance: float | None = _position(
        "distance between the planets of a pair, from their profile shifts by default", None
    )
    count: int = integer(REQUIRED, 1, 24, "more do not fit", meaning="number of planets")
    angles: tuple[float, ...] | None = numbers(
        -_TURN, _TURN, "one turn", unit="rad", display_unit="deg",
        example='["0 deg", "120 deg", "240 deg"]',
        meaning="angles of the planets about the sun; equally spaced by default",
    )  # fmt: skip
    pin_stiffness: float = _support("radial stiffness of each planet on the carrier")
    pin_clearance: float = _clearance(
        "radial distance that each planet can move on its pin before it is held"
    )
    sun_support: float = _support("radial stiffness of the supports of the sun; 0 lets it float")
    ring_support: float = _support("radial stiffness of the supports of the ring; 0 lets it float")
    carrier_support: float = _support(
        "radial stiffness of the supports of the carrier; 0 lets it float"
    )
    torsional_support: float = _support(
        "stiffness of the held member against rotation, along its base circle or that of the pins"
    )
    carrier_position: float = _position(
        "position of the pins on the shaft of the carrier, in a machine with shafts", 0.0
    )
    carrier_mass: float | None = number(
        None, 1e-9, 1e6, _GUARD, of="mass", meaning="mass of the carrier", basis="a steel disc"
    )
    carrier_moment_of_inertia: float | None = number(
        None, 1e-14, 1e7, _GUARD, of="moment_of_inertia",
        meaning="moment of inertia of the carrier about its axis", basis="a steel disc",
    )  # fmt: skip
    pin_errors: tuple[float, ...] | None = _errors(
        "distance by which each pin is ahead of its place, from x towards y"
    )
    thickness_errors: tuple[float, ...] | None = _errors(
        "excess of the base tooth thickness of each planet"
    )


#: Tables by group of parts.
TABLES: dict[str, type[Section]] = {
    "shafts": ShaftTable,
    "bearings": BearingTable,
    "gears": GearTable,
    "meshes": MeshTable,
    "couplings": CouplingTable,
    "planets": PlanetsTable,
    "housing": HousingTable,
    "operation": OperationTable,
    "load_cases": LoadCaseTable,
    "dynamics": MotionTable,
    "solver": SolverTable,
    "faults": PartFaultTable,
    "rating": PartRating,
}


def part_table(group: str, body: Mapping[str, Any]) -> type[Section]:
    """Table of a part by its body: of a mesh by its kind, of a coupling by its model."""
    if group == "meshes":
        return mesh_table_kind(body)
    if group == "couplings":
        return _coupling_table(str(body.get("model", "linear")))
    return TABLES[group]


#: Keys that are read apart from the table of their group.
APART: dict[str, dict[str, Any]] = {
    "shafts": {
        "sections": text(
            None,
            meaning="sections along x: length, outer and inner diameter, and for a cone both "
            "diameters of the end; a rigid shaft by default",
            example='[["60 mm", "40 mm"], ["20 mm", "50 mm", "10 mm"]]',
        )
    },
    "bearings": {
        "type": choice(
            None,
            tuple(ROLLING_BEARINGS),
            meaning="rolling bearing, which is linearized at its load; a linear support by default",
        )
    },
    "meshes": {"gears": text(REQUIRED, meaning="names of both gears", example='["z1", "z2"]')},
    "couplings": {
        "shafts": text(REQUIRED, meaning="names of both shafts", example='["engine", "input"]')
    },
    "housing": {
        "nodes": text(
            None,
            meaning="rows of the matrices of each node along x, y, z and about them; -1 without",
            example='{ "seat A" = [0, 1, 2, -1, -1, -1] }',
        )
    },
    "load_cases": {
        "share": text(
            None, meaning="share of the time, a number up to 1 or a percentage", example='"30 %"'
        )
    },
}
