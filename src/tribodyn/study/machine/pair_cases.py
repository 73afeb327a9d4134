"""The pair of gears of a mesh as a case, with errors placed in the file of the machine."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.errors import Argument, InputError, Problem, did_you_mean
from tribodyn.gear import Misalignment
from tribodyn.machine import ROLLING_BEARINGS
from tribodyn.machine.graph.mesh_checks import gear_hand
from tribodyn.study.case import gears
from tribodyn.study.case.case import Case
from tribodyn.study.case.hypoid import blank_of
from tribodyn.study.case.provenance import spec_of
from tribodyn.study.case.rating_tables import NotchTable, PartRating
from tribodyn.study.case.section import Table
from tribodyn.study.case.sections import Dynamics, Operation
from tribodyn.study.case.to_models import usual_backlash
from tribodyn.study.case.user_input import Source
from tribodyn.study.case.values import (
    FaultError,
    KeyedProblems,
    Plain,
    read_table,
    read_value,
    unmarked,
)
from tribodyn.study.machine.read_parts import rolling_options
from tribodyn.study.machine.tables import (
    TABLES,
    HypoidMeshTable,
    MeshDynamics,
    mesh_table_kind,
    part_table,
)
from tribodyn.study.mesh_inputs import MeshInputs, mesh_inputs

if TYPE_CHECKING:
    from tribodyn.gear import HypoidBlank
    from tribodyn.machine import Gear
    from tribodyn.model import Option
    from tribodyn.study.machine.case import MachineCase
    from tribodyn.study.machine.load_cases import LoadCase
    from tribodyn.study.machine.user_tables import PartsBase

#: Tables of models that hold for all meshes, and that a mesh may have for itself.
SHARED = ("material", "lubricant", "film", "stiffness", "friction", "materials", "rating")
#: Those that meshes of hypoid gears have not.
_OF_CYLINDRICAL = ("stiffness", "materials", "rating")
#: Keys of ``[lubricant]`` of the heat balance, which is that of the whole machine.
HEAT = ("heat_transfer", "gear_heat_transfer", "ambient_temperature")
#: Keys of tables of models that are those of the whole machine.
_OF_MACHINE = (*HEAT, *PartRating.fields)
#: Keys of ``[dynamics]`` of a pair that belong to its mesh.
MESH_KEYS = tuple(n for n in Dynamics.fields if n not in ("model", "bearing_damping_ratio"))
#: Groups of parts, with a table for each part.
GROUPS = ("shafts", "bearings", "gears", "meshes", "couplings", "faults")
#: The machine is what vibrates: its pairs have no supports of their own.
_WITHOUT_SUPPORTS = {"model": "torsional"}
_ROLES = ("pinion", "wheel")
#: Torque of a mesh that is rounding [N*m].
_IDLE = 1e-9


@dataclass(frozen=True)
class PairSource(Source):
    """Origin of the values of a pair: keys of the machine in place of those of the pair."""

    mesh: str = ""
    gears: tuple[str, str] = ("", "")  #: pinion and wheel
    mesh_keys: frozenset[str] = frozenset()  #: keys inside the table of the mesh
    group: str = "meshes"  #: table that holds that of the mesh

    def key(self, key: str) -> str:
        """Key of the machine for a key of the pair."""
        table, _, name = key.partition(".")
        if table == "gears":
            role, _, gear_key = name.partition(".")
            if role in _ROLES:
                return f"gears.{self.gears[_ROLES.index(role)]}.{gear_key}".rstrip(".")
            return f"{self.group}.{self.mesh}.{name}".rstrip(".")
        if table == "dynamics":
            return f"{self.group}.{self.mesh}.{name}" if name in self.mesh_keys else key
        inside = {f"{table}.{name}", table} & self.mesh_keys
        return f"{self.group}.{self.mesh}.{key}" if inside else key

    def line(self, key: str) -> int:
        """Return the line of a key of the pair."""
        return super().line(self.key(key))

    def place(self, problems: Iterable[tuple[str, Problem]]) -> list[Problem]:
        """Set the location of each problem; those of keys that all meshes share name the mesh."""
        stage = f'stage "{self.mesh}", gears {" and ".join(self.gears)}'
        label = f'mesh "{self.mesh}"' if self.group == "meshes" else stage
        named = [
            (key, replace(problem, what=f"{label}: {problem.what}"))
            if self.key(key).partition(".")[0] in ("dynamics", "operation")
            else (key, problem)
            for key, problem in problems
        ]
        return super().place(named)

    def where(self, key: str) -> str:
        """Format the location of a key of the pair."""
        return Source(self.name, self.find, self.replaced).where(self.key(key))


@dataclass(frozen=True)
class TeethUnder:
    """Sense, speed and torque of the teeth of a mesh under a load of its machine."""

    names: tuple[str, str]  #: pinion and wheel in the case
    driver: str  #: name of the driving gear
    hand: str  #: of the pinion, of hypoid teeth the side; empty for straight teeth
    operation: tuple[float, float]  #: speed and torque of the pinion
    backwards: bool  #: whether the pinion turns about -x
    temperatures: Mapping[str, float]  #: of oil and gears, in place of those of ``[lubricant]``

    def along_path(self, misalignment: float | Misalignment) -> float | Misalignment:
        """Misalignment of the pair from an increase of the compression along x."""
        if isinstance(misalignment, Misalignment) or self.backwards:
            return misalignment
        return -misalignment  # the gap grows along the axis about which the pinion turns


def pinion_and_wheel(names: Sequence[str], gears: Mapping[str, Gear]) -> tuple[str, str]:
    """Gears of a mesh in the order pinion, wheel; of equal gears the first is the pinion."""
    first, second = names
    teeth = abs(gears[first].teeth), abs(gears[second].teeth)
    return (first, second) if teeth[0] <= teeth[1] else (second, first)


def with_forms(gears: Mapping[str, Gear], names: tuple[str, str], pair: Case) -> dict[str, Gear]:
    """Pinion and wheel with the tooth forms and the densities of their pair."""
    return {
        name: replace(gears[name], form=getattr(pair.gear_pair, role), density=pair.density(role))
        for role, name in zip(_ROLES, names, strict=True)
    }


def mesh_tables(body: Mapping[str, Any]) -> dict[str, Mapping[str, Any]]:
    """Tables of models inside the table of a mesh."""
    return {name: body[name] for name in SHARED if isinstance(body.get(name), Mapping)}


def pair_case(
    data: Mapping[str, Any],
    table: str,
    names: tuple[str, str],
    source: Source | None,
    *,
    driver: str,
    operation: tuple[float, float],
    hand: str = "",
    misalignment: float | Misalignment = 0.0,
) -> Case:
    """Case of the pair of a mesh; hand (of hypoid teeth side), speed and torque of its pinion."""
    group, _, mesh = table.partition(".")
    refuse_idle(data, mesh, operation[1], source)
    body = data[group][mesh]
    inner, crossed = mesh_tables(body), mesh_table_kind(body) is HypoidMeshTable
    tables: dict[str, Any] = {
        name: _merged(name, data.get(name, {}), inner.get(name, {}))
        for name in SHARED
        if name in inner or (name in data and not (crossed and name in _OF_CYLINDRICAL))
    }
    if "materials" in tables:
        used = {data["gears"][name].get("material") for name in names}
        tables["materials"] = {k: v for k, v in tables["materials"].items() if k in used}
    shared_dynamics = {k: v for k, v in data.get("dynamics", {}).items() if k in MESH_KEYS}
    mesh_dynamics = {k: v for k, v in body.items() if k in MESH_KEYS}
    pair = {k: v for k, v in body.items() if k in gears.Gears.fields and k not in inner}
    if not crossed:
        pair.setdefault("normal_pressure_angle", "20 deg")
    pair["driver"] = _ROLES[names.index(driver)]
    if crossed:
        pair |= {"side": hand or "drive", "mounting": _mounting(body, misalignment)}
    elif hand:
        pair["hand"] = hand
    if misalignment and not crossed:
        pair["misalignment"] = Plain(misalignment)
    for role, name in zip(_ROLES, names, strict=True):
        body_of_gear = data["gears"][name]
        pair[role] = {k: v for k, v in body_of_gear.items() if k in gears.Gear.fields}
    model_keys = (f"{model}.{key}" for model, values in inner.items() for key in values)
    mesh_keys = {*mesh_dynamics, *model_keys, *inner}
    origin = source or Source()
    speed, torque = map(Plain, operation)
    tables |= {
        "title": f"{data.get('title', 'Machine')}: {mesh}",
        "gears": pair,
        "dynamics": {**_WITHOUT_SUPPORTS, **shared_dynamics, **mesh_dynamics},
        "operation": {"speed": speed, "torque": torque, "speed_of": "pinion"},
    }
    places = origin.name, origin.find, origin.replaced
    keyed = PairSource(*places, mesh, names, frozenset(mesh_keys), group)
    case = Case(keyed, **tables)
    if case.gears.kind == "spur":
        # Shafts deflect and misalign the flanks, by amounts that are not known yet.
        play = usual_backlash(case.gears, case.dynamics, case.gear_pair)
        if play is not None:
            tables["dynamics"] = {**tables["dynamics"], "backlash": Plain(play)}
            case = Case(keyed, **tables)
    return case


def teeth_under(case: MachineCase, mesh: str, load: LoadCase) -> TeethUnder:
    """Sense, speed and torque of the teeth of a mesh under a load of its machine."""
    machine = case._machine_under(load)
    names, mesh_load = case._pinion_and_wheel(mesh), machine.kinematics.meshes[mesh]
    part, pinion = machine.meshes[mesh], names[0]
    place = part.gears.index(pinion)
    side = part.crossing.side(mesh_load.sense) if part.crossing else ""
    driver = mesh_load.driver
    if mesh in case._stage_of:
        stage, role = case._stage_of[mesh]
        names, driver = stage.names_of(role), stage.case_name(driver)
    return TeethUnder(
        names,
        # Hypoid teeth are those of a driving pinion; a driving wheel turns it back in time.
        driver=pinion if side else driver,
        hand=side or (gear_hand(pinion, case.gears, part) if part.helix_angle else ""),
        operation=(abs(mesh_load.speeds[place]), abs(mesh_load.torque[place])),
        backwards=mesh_load.speeds[place] < 0.0,
        temperatures=temperatures_of(load),
    )


def temperatures_of(load: LoadCase) -> dict[str, float]:
    """Temperatures of oil and gears that a load has for itself [K]."""
    known = {name: getattr(load, name) for name in ("temperature", "gear_temperature")}
    return {name: value for name, value in known.items() if value is not None}


def read_pair(
    case: MachineCase, mesh: str, under: TeethUnder, misalignment: float | Misalignment = 0.0
) -> Case:
    """Pair of gears of a mesh of a machine."""
    stage, role = case._stage_of.get(mesh, (None, ""))
    data, key = case.data, f"meshes.{mesh}"
    if stage is not None:
        data, key = stage.pair_data(role), stage.key
    if under.temperatures:
        warm = {name: Plain(value) for name, value in under.temperatures.items()}
        data = {**data, "lubricant": {**data["lubricant"], **warm}}
    return pair_case(
        *(data, key, under.names, case.source),
        driver=under.driver,
        operation=under.operation,
        hand=under.hand,
        misalignment=misalignment,
    )


def read_teeth(case: MachineCase, mesh: str, under: TeethUnder) -> tuple[Case, MeshInputs]:
    """Pair of gears and inputs of a mesh, read once for each sense of its load."""
    refuse_idle(case.data, mesh, under.operation[1], case.source)
    key = case.tooth_group(mesh), under.driver, under.hand, *under.temperatures.values()
    if key not in case._teeth:
        pair = read_pair(case, mesh, under)
        teeth = pair, mesh_inputs(pair)
        if pair._named_files():  # they may change
            return teeth
        case._teeth[key] = teeth
    return case._teeth[key]


def inputs_under(
    case: MachineCase, mesh: str, load: LoadCase, misalignment: float | Misalignment = 0.0
) -> MeshInputs:
    """What the teeth of a mesh of a machine are computed from, misaligned by its shafts."""
    under = teeth_under(case, mesh, load)
    pair, inputs = read_teeth(case, mesh, under)
    check_range(pair, under.operation)
    return inputs.under(*under.operation, under.along_path(misalignment))


def refuse_idle(data: Mapping[str, Any], mesh: str, torque: float, source: Source | None) -> None:
    """Refuse a mesh that carries no torque."""
    if torque >= _IDLE:
        return
    what, why = f"mesh {mesh} carries no torque", "Its teeth have no contact to compute"
    remedy = "Name the shaft where the power leaves behind it, or give it a constant stiffness"
    option = TABLES["operation"].spec("torque")
    assert option is not None
    stated = read_value(option, "torque", data["operation"]["torque"])
    key = "operation.output" if stated else "operation.torque"
    raise InputError((source or Source()).place([(key, Problem(what, "", why, remedy))]))


def check_range(pair: Case, operation: tuple[float, float]) -> None:
    """Refuse speed and torque of a pinion that are out of range."""
    problems: KeyedProblems = []
    for name, value in zip(("speed", "torque"), operation, strict=True):
        try:
            spec = Operation.spec(name)
            assert spec is not None
            read_value(spec, name, Plain(value))
        except FaultError as fault:
            problems.append((f"operation.{name}", fault.problem))
    if problems:
        raise InputError(pair.source.place(problems))


def _merged(name: str, shared: Mapping[str, Any], of_mesh: Mapping[str, Any]) -> dict[str, Any]:
    """Table of a mesh: a model of its own brings its options, other keys are added."""
    selector = Case.fields[name].kind.selector  # type: ignore[union-attr]
    values = {**({} if selector in of_mesh else shared), **of_mesh}
    return {key: value for key, value in values.items() if key not in _OF_MACHINE}


def read_blanks(
    groups: Mapping[str, Mapping[str, Any]], problems: KeyedProblems
) -> dict[str, HypoidBlank]:
    """Blanks of the hypoid meshes, which give their gears the face widths."""
    blanks = {}
    for name, body in groups["meshes"].items():
        names, bodies = body.get("gears"), groups["gears"]
        if mesh_table_kind(body) is not HypoidMeshTable or not isinstance(names, list | tuple):
            continue
        pair = [bodies.get(gear, {}) for gear in names if isinstance(gear, str)]
        teeth = [count for each in pair if type(count := unmarked(each.get("teeth"))) is int]
        inner = mesh_tables(body)
        values = {k: v for k, v in body.items() if k in HypoidMeshTable.fields and k not in inner}
        faults: KeyedProblems = []
        table = read_table(HypoidMeshTable, values, f"meshes.{name}", {}, faults)
        widths = [Plain(1.0)] * len(pair)
        try:
            if not faults and len(teeth) == len(_ROLES):  # others are reported where they are read
                blanks[name] = blank = blank_of(table, (teeth[0], teeth[1]))
                widths = [Plain(getattr(blank, f"face_width_{role}")) for role in _ROLES]
        except InputError as error:
            for problem in error.problems:
                place = problem.where.name if isinstance(problem.where, Argument) else "gears"
                key = place if place in HypoidMeshTable.fields else "gears"
                problems.append((f"meshes.{name}.{key}", problem))
        for each, width in zip(pair, widths, strict=True):
            each.setdefault("face_width", width)
    return blanks


def _mounting(body: Mapping[str, Any], misalignment: float | Misalignment) -> dict[str, Any]:
    """Table of the mounting errors of a mesh with those of its deflected shafts."""
    stated: dict[str, Any] = body.get("mounting", {})
    if not isinstance(misalignment, Misalignment) or not isinstance(stated, Mapping):
        return stated
    sums = {}
    for name, option in gears.MountingData.specs():
        value = read_value(option, name, stated[name]) if name in stated else 0.0
        sums[name] = Plain(value + getattr(misalignment, name))
    return {**stated, **sums}


def constant_law(law: Any) -> dict[str, Any]:
    """Damping, backlash and error of a mesh with a constant stiffness."""
    size, shift = law.transmission_error_amplitude, law.transmission_error_phase
    has_damping = law.mesh_damping is not None
    return {
        "gap": 0.5 * (law.backlash or 0.0),
        "damping": law.mesh_damping if has_damping else 0.0,
        "damping_ratio": None if has_damping else law.mesh_damping_ratio,
        "error": (lambda phase: size * np.cos(2.0 * np.pi * phase + shift)) if size else 0.0,
    }


def option_at(case: PartsBase, path: tuple[str, ...]) -> Option | None:
    """Option of the key at a path: of a part, of a value in a list, or of a model."""
    if len(path) < 2:
        return None
    group, *names, name = path
    if group == "shafts" and names[1:2] == ["notches"]:
        return NotchTable.spec(name) if len(names) == 3 else None
    if name.isdigit():
        listed = option_at(case, (group, *names))
        return replace(listed, kind="number") if listed and listed.kind == "numbers" else None
    table = _table(case.data, [group, *names[:1]])
    rolling = str(table.get("type")) if group == "bearings" and table is not None else ""
    options = rolling_options(ROLLING_BEARINGS[rolling]) if rolling in ROLLING_BEARINGS else {}
    if name in options:
        return options[name]
    part, of_parts = TABLES.get(group), group in (*GROUPS, "planets")
    if of_parts and table is None:
        return None
    if part is not None and (len(names) == of_parts or group == "load_cases"):
        part = part_table(group, table or {})
        option = part.spec(name) or (MeshDynamics.spec(name) if group == "meshes" else None)
        if option is not None:
            return option
    if (pair_key := _pair_key(case, group, names, name)) is not None:
        return spec_of(*pair_key)
    shared = Case.fields.get(group) if group in (*SHARED, "dynamics") else None
    return shared.kind.spec(name) if isinstance(shared, Table) else None


def unknown_key(case: PartsBase, key: str) -> Problem:
    """Problem of a key that a case of parts does not have, with the nearest one that it has."""
    keys = [
        f"{group}.{part}.{name}"
        for group in (*GROUPS, "planets")
        for part in case.data.get(group, {})
        for name in TABLES[group].fields
    ]
    keys += [f"operation.{name}" for name in TABLES["operation"].fields]
    keys += [name for name, _ in case.values()]
    what, why = f'there is no key "{key}"', "Keys name the part and its value"
    part = next((name for name in keys if name.startswith("planets.")), "")
    example = f"{part.rpartition('.')[0]}.pin_stiffness" if part else "bearings.A.radial_stiffness"
    remedy = f'Write, for example, "{example}" or "operation.speed"'
    return Problem(what, "", why, did_you_mean(key, list(dict.fromkeys(keys)), remedy))


def _table(data: Mapping[str, Any], path: list[str]) -> Mapping[str, Any] | None:
    """Table at a path; None where it is not given."""
    value: Any = data
    for name in path:
        value = value.get(name) if isinstance(value, Mapping) else None
    return value if isinstance(value, Mapping) else None


def _pair_key(case: PartsBase, group: str, names: list[str], name: str) -> tuple[Case, str] | None:
    """Pair of gears that has a value of the case, and its key there."""
    for key, pair, names_of_gears in case.mesh_pairs():
        if group in (*SHARED, "dynamics"):
            return pair, ".".join((group, *names, name))
        if key == ".".join([group, *names[:1]]):
            inner = names[1:] or ["dynamics"]
            inside = ["gears"] if inner[0] in HypoidMeshTable.fields else []
            return pair, ".".join([*inside, *inner, name])
        if group == "gears" and names and names[0] in names_of_gears:
            role = _ROLES[names_of_gears.index(names[0])]
            return pair, ".".join(("gears", role, *names[1:], name))
    return None
