"""All tables of a case of a machine or a stage, for reading, explain and documentation."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import Any

from tribodyn.machine import ROLLING_BEARINGS
from tribodyn.model import REQUIRED, Option, choice, integer, number, numbers, text
from tribodyn.study.case.pair import PairCase
from tribodyn.study.case.rating_tables import BearingCatalogue, PartRating, RatingTable
from tribodyn.study.case.reference import default_of, start_toml, walk
from tribodyn.study.case.section import NamedTables, Section, Table, section_at, table
from tribodyn.study.case.sections import Losses, ShaftData
from tribodyn.study.faults.section import PartFaultTable
from tribodyn.study.machine.tables import (
    MESH_KEYS,
    SHARED,
    BearingTable,
    CouplingTable,
    GearTable,
    HousingTable,
    HypoidMeshTable,
    LoadCaseTable,
    MeshTable,
    MotionTable,
    OperationTable,
    ShaftTable,
    SolverTable,
    clearance,
    position,
    rolling_options,
    with_models,
)
from tribodyn.types import ByName

_GUARD = "guards against a wrong unit"
_TURN = 2.0 * math.pi
#: Keys of a mesh that both meshes of a stage share.
_OF_STAGE = (
    "normal_module", "center_distance", "addendum_coefficient", "dedendum_coefficient",
    "rack_tip_radius_coefficient", "composite_roughness", "normal_pressure_angle", "helix_angle",
    "hand",
)  # fmt: skip
#: Stiffness of a support that is not given [N/m].
STIFF = 1e9


def _support(meaning: str, **more: Any) -> Any:
    unit = {"unit": "N/m", "example": '"1e8 N/m"'}
    return number(STIFF, 0.0, 1e14, _GUARD, meaning=meaning, **unit, **more)


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
        **{name: MeshTable.fields[name] for name in (*_OF_STAGE, *MESH_KEYS)},
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
    ring_center_distance: float | None = position(
        "distance from the sun to the planets at the ring of pairs, from the profile shifts of the "
        "ring mesh by default",
        None,
    )
    pair_center_distance: float | None = position(
        "distance between the planets of a pair, from their profile shifts by default", None
    )
    count: int = integer(REQUIRED, 1, 24, "more do not fit", meaning="number of planets")
    angles: tuple[float, ...] | None = numbers(
        -_TURN, _TURN, "one turn", unit="rad", display_unit="deg",
        example='["0 deg", "120 deg", "240 deg"]',
        meaning="angles of the planets about the sun; equally spaced by default",
    )  # fmt: skip
    pin_stiffness: float = _support("radial stiffness of each planet on the carrier", positive=True)
    pin_clearance: float = clearance(
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
    carrier_position: float = position(
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

    @classmethod
    def keys_for(cls, data: ByName) -> Mapping[str, Option | Table]:
        """Keys of a stage, and tables of the models of its meshes."""
        return with_models(cls.fields, data)


def _parts(kind: type[Section], meaning: str) -> Any:
    """Declare a table of parts that have names."""
    named: type[Section] = type(kind.__name__ + "s", (NamedTables,), {}, inner=table(kind, meaning))
    return table(named, f"{meaning}, by name", "empty")


class MachineRating(RatingTable):
    """The ``[rating]`` table of a machine, also for its bearings."""

    fields = {**RatingTable.fields, **PartRating.fields}  # noqa: RUF012


class BearingLosses(Section):
    """A ``[losses.bearings.NAME]`` table: a bearing that is unlike the others of its shaft."""

    fields = {  # noqa: RUF012
        name: replace(option, default=REQUIRED) if name == "bearing" else option
        for name, option in ShaftData.specs()
        if name.startswith("bearing") and name != "bearings"
    }


class MachineLosses(Section):
    """The ``[losses]`` table of a machine: power losses other than those of the teeth."""

    fields = dict(Losses.specs())  # noqa: RUF012
    shafts: Section = _parts(ShaftData, "a shaft with its bearings, seals and gears")
    bearings: Section = _parts(BearingLosses, "a bearing that is unlike the others of its shaft")


class MachineTables(Section):
    """All tables of a case of a machine."""

    title: str | None = text(None, meaning="one line that names this case", example='"My gearbox"')
    origin: str | None = PairCase.fields["origin"]  # type: ignore[assignment]
    shafts: Section = _parts(ShaftTable, "a shaft")
    bearings: Section = _parts(BearingTable, "a bearing")
    gears: Section = _parts(GearTable, "a gear")
    meshes: Section = _parts(MeshTable, "a mesh")
    couplings: Section = _parts(CouplingTable, "a coupling")
    planets: Section = _parts(PlanetsTable, "a planetary stage")
    housing: HousingTable | None = table(HousingTable, "the elastic housing", "none")
    operation: OperationTable = table(OperationTable, "speed and load")
    load_cases: Section = _parts(LoadCaseTable, "a load case")
    dynamics: MotionTable = table(MotionTable, "the motion", "empty")
    solver: SolverTable = table(SolverTable, "how the motion is computed", "empty")
    faults: Section = _parts(PartFaultTable, "a fault")


MachineTables.fields["load_cases"].kind.listed = True  # type: ignore[union-attr]
MachineTables.fields |= {name: PairCase.fields[name] for name in SHARED}
MachineTables.fields["losses"] = table(MachineLosses, "power losses of other parts", "none")
MachineTables.fields["rating"] = table(MachineRating, "load capacity of gears and parts", "none")


#: Files to start from.
STARTS = ("machine", "stage", "hypoid")


def machine_keys() -> Iterator[tuple[str, Option, str]]:
    """Iterate over the keys of parts with their tables; NAME is the name of a part."""
    for group, field in MachineTables.fields.items():
        if isinstance(field, Table) and group not in SHARED:
            yield from walk(field.kind, (group,))
        if group == "rating":
            yield from walk(PartRating, (group,))
        if group == "bearings":
            yield from _rolling_keys(group)
        if group == "meshes":
            yield from walk(HypoidMeshTable, (group, 'NAME with kind = "hypoid"'))


def _rolling_keys(group: str) -> Iterator[tuple[str, Option, str]]:
    """Keys of each type of rolling bearings."""
    for kind, law in ROLLING_BEARINGS.all().items():
        for name, option in rolling_options(law).items():
            yield f'{group}.NAME with type = "{kind}".{name}', option, default_of(option)


def start_of(kind: str) -> str:
    """Return a short case file of a machine, a stage or a hypoid pair, to be filled in."""
    return start_toml(f"start_{kind}", _section)


def _section(path: tuple[str, ...]) -> type[Section] | None:
    """Table of a case of parts or of a pair at a path."""
    pair = path[0] == "gears" and path[1:] in ((), ("pinion",), ("wheel",))
    return section_at(path, None if pair else MachineTables) or section_at(path)
