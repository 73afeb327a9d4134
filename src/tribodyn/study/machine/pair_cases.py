"""The pair of gears of a mesh as a case, with errors placed in the file of the machine."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import product
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.errors import Argument, InputError, Problem
from tribodyn.gear import Misalignment
from tribodyn.machine.graph.part_checks import gear_hand
from tribodyn.study.case import gears
from tribodyn.study.case.hypoid import blank_of
from tribodyn.study.case.pair import PairCase
from tribodyn.study.case.rating_tables import HISTORY, PartRating
from tribodyn.study.case.section import Section, named_rows, table_in
from tribodyn.study.case.sections import Operation
from tribodyn.study.case.to_models import usual_backlash
from tribodyn.study.case.user_input import Source
from tribodyn.study.case.values import FaultError, KeyedProblems, Plain, read_value
from tribodyn.study.machine.read_parts import is_faulty, parts_of, read_loads
from tribodyn.study.machine.tables import (
    HEAT,
    MESH_KEYS,
    SHARED,
    HypoidMeshTable,
    OperationTable,
    mesh_table_kind,
)
from tribodyn.study.mesh_inputs import MeshInputs, mesh_inputs
from tribodyn.types import ByName

if TYPE_CHECKING:
    from tribodyn.gear import HypoidBlank
    from tribodyn.machine import Gear
    from tribodyn.machine.mesh import Hand
    from tribodyn.study.machine.case import MachineCase
    from tribodyn.study.machine.read_parts import LoadCase

#: Those that meshes of hypoid gears have not.
_OF_CYLINDRICAL = ("stiffness", "materials", "rating")
#: Keys of tables of models that are those of the whole machine.
_OF_MACHINE = (*HEAT, *PartRating.fields, *HISTORY)
#: The machine is what vibrates: its pairs have no supports of their own.
_WITHOUT_SUPPORTS = {"model": "torsional"}
#: Tables with what a change of speed or torque needs.
_OF_LOADS = ("operation", "load_cases", "rating")
_ROLES = ("pinion", "wheel")
#: Names of gears that are words, which have an article.
_WORDS = (*_ROLES, "sun", "planet", "ring")
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
            if self.key(key).partition(".")[0] in ("dynamics", "operation", "load_cases")
            else (key, problem)
            for key, problem in problems
        ]
        texts = ("what", "why", "remedy")
        return super().place(
            (key, replace(each, **{name: self.named(getattr(each, name)) for name in texts}))
            for key, each in named
        )

    def named(self, text: str) -> str:
        """Text about a pair with the names of its gears in the machine."""

        def gear(match: re.Match[str]) -> str:
            name = self.gears[_ROLES.index(match[2])]
            return (match[1] or "") * (name in _WORDS) + name

        return re.sub(r"(?<![\w.])([Tt]he )?(pinion|wheel)\b", gear, text)

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


def with_forms(
    gears: Mapping[str, Gear], names: tuple[str, str], pair: PairCase
) -> dict[str, Gear]:
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
) -> PairCase:
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
        materials = {data["gears"][name].get("material") for name in names}
        tables["materials"] = {k: v for k, v in tables["materials"].items() if k in materials}
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
    case = PairCase(keyed, **tables)
    if case.gears.kind == "spur":
        # Shafts deflect and misalign the flanks, by amounts that are not known yet.
        play = usual_backlash(case.gears, case.dynamics, case.gear_pair)
        if play is not None:
            tables["dynamics"] = {**tables["dynamics"], "backlash": Plain(play)}
            case = PairCase(keyed, **tables)
    return case


def mesh_hand(
    table: Section, names: Sequence[str], data: ByName, *, internal: bool = False
) -> Hand:
    """Hand of the first gear of a mesh: stated, that of a gear, or right where none has one."""
    first, second = (data["gears"].get(name, {}).get("hand") for name in names)
    if second and not internal:
        second = "left" if second == "right" else "right"
    hand: Hand = table.hand or first or second or "right"
    return hand


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
    temperatures = {name: getattr(load, name) for name in ("temperature", "gear_temperature")}
    return {name: value for name, value in temperatures.items() if value is not None}


def read_pair(
    case: MachineCase, mesh: str, under: TeethUnder, misalignment: float | Misalignment = 0.0
) -> PairCase:
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


def read_teeth(case: MachineCase, mesh: str, under: TeethUnder) -> tuple[PairCase, MeshInputs]:
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
    speed, torque = (_key_of(case, load, name) for name in ("speed", "torque"))
    refuse_idle(case.data, mesh, under.operation[1], case.source, torque)
    pair, inputs = read_teeth(case, mesh, under)
    check_range(pair, under.operation, (speed, torque))
    return inputs.under(*under.operation, under.along_path(misalignment))


def _key_of(case: MachineCase, load: LoadCase, name: str) -> str:
    """Key that gives the speed or the torque of a load."""
    for number, (row, body) in enumerate(named_rows(case.data.get("load_cases")), 1):
        if load.name == body.get("name", f"load case {number}") and body.get(name) is not None:
            return f"load_cases.{row}.{name}"
    return f"operation.{name}"


def check_loads(case: MachineCase) -> None:
    """Refuse loads that computed teeth cannot carry, or under which they carry none."""
    for mesh in case.meshes_with_teeth:
        inputs_under(case, mesh, case.operating_point)
    for load, mesh in product(case.load_cases, list(case.meshes_with_teeth)[:1]):
        key = _key_of(case, load, "torque")
        refuse_idle(case.data, mesh, abs(load.torque), case.source, key)


def take_loads(case: MachineCase, before: MachineCase, numbers: Mapping[str, float]) -> bool:
    """Take another speed or torque in its sense, to which parts and teeth do not respond."""
    senses = {f"operation.{n}": getattr(case.operating_point, n) for n in ("speed", "torque")}
    if any(key not in senses or number * senses[key] <= 0.0 for key, number in numbers.items()):
        return False
    problems: KeyedProblems = []
    # A number of the operation leaves all other tables valid.
    tables = case._read_tables({n: case.data[n] for n in _OF_LOADS if n in case.data}, problems)
    loads = read_loads(case.data, tables, parts_of(tables, "load_cases"), problems)
    if loads is None or problems:
        return False
    machines = dict(before._machines)
    shared = {"_teeth": before._teeth, "_machines": machines, "_at_rest": before._at_rest}
    vars(case).update(loads._asdict(), **shared)
    try:
        check_loads(case)
    except InputError:  # whose message says what was replaced
        return False
    return not case._impossible()


def refuse_idle(
    data: Mapping[str, Any],
    mesh: str,
    torque: float,
    source: Source | None,
    key: str = "operation.torque",
) -> None:
    """Refuse a mesh that carries no torque; the key gives that of the input."""
    if torque >= _IDLE:
        return
    what, why = f"mesh {mesh} carries no torque", "Its teeth have no contact to compute"
    group, _, name = key.partition(".")
    option = OperationTable.spec("torque")
    assert option is not None
    body = table_in(data, group)
    value = body[name] if name in body else body[name.removesuffix(".torque")]["torque"]
    remedy = "Give a torque, or give the meshes a constant stiffness"
    if read_value(option, "torque", value):
        key = "operation.output"
        remedy = "Name the shaft where the power leaves behind it, or give it a constant stiffness"
    raise InputError((source or Source()).place([(key, Problem(what, "", why, remedy))]))


def check_range(pair: PairCase, operation: tuple[float, float], keys: tuple[str, str]) -> None:
    """Refuse speed and torque of a pinion that are out of range; the keys give them."""
    problems: KeyedProblems = []
    for key, name, value in zip(keys, ("speed", "torque"), operation, strict=True):
        try:
            spec = Operation.spec(name)
            assert spec is not None
            read_value(spec, name, Plain(value))
        except FaultError as fault:
            problems.append((key, fault.problem))
    if problems:
        raise InputError(pair.source.place(problems))


def _merged(name: str, shared: Mapping[str, Any], of_mesh: Mapping[str, Any]) -> dict[str, Any]:
    """Table of a mesh: a model of its own brings its options, other keys are added."""
    selector = PairCase.fields[name].kind.selector  # type: ignore[union-attr]
    values = {**({} if selector in of_mesh else shared), **of_mesh}
    return {key: value for key, value in values.items() if key not in _OF_MACHINE}


def read_blanks(
    tables: Mapping[str, Mapping[str, Any]], problems: KeyedProblems
) -> tuple[dict[str, HypoidBlank], dict[str, float]]:
    """Blanks of the hypoid meshes, and the face widths that they give their gears."""
    blanks: dict[str, HypoidBlank] = {}
    widths: dict[str, float] = {}
    for name, mesh in tables["meshes"].items():
        listed = isinstance(mesh.gears, list | tuple) and all(
            isinstance(g, str) for g in mesh.gears
        )
        if "cutter_radius" not in vars(mesh) or not listed:
            continue
        gears = [tables["gears"].get(gear) for gear in mesh.gears]
        teeth = [table.teeth for table in gears if table is not None and table.teeth]
        widths |= dict.fromkeys(mesh.gears, 1.0)
        if len(teeth) != len(_ROLES) or is_faulty(f"meshes.{name}", problems):
            continue  # others are reported where they are read
        try:
            blanks[name] = blank = blank_of(mesh, (teeth[0], teeth[1]))
            gear_roles = zip(mesh.gears, _ROLES, strict=True)
            widths |= {gear: getattr(blank, f"face_width_{role}") for gear, role in gear_roles}
        except InputError as error:
            for problem in error.problems:
                place = problem.where.name if isinstance(problem.where, Argument) else "gears"
                key = place if place in HypoidMeshTable.fields else "gears"
                problems.append((f"meshes.{name}.{key}", problem))
    return blanks, widths


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
