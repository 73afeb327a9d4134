"""Make the parts and loads of a machine from the tables of its case, collecting every problem."""

from __future__ import annotations

import math
import re
from bisect import bisect
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, fields, replace
from functools import partial
from typing import Any, NamedTuple

from tribodyn.errors import Argument, InputError, Problem, no_such
from tribodyn.machine import COUPLINGS, ROLLING_BEARINGS, Bearing, Coupling, Gear, Shaft
from tribodyn.machine import Section as ShaftSection
from tribodyn.model import NO_OPTIONS, REQUIRED, number
from tribodyn.rating import ShaftMaterial, ShaftNotch
from tribodyn.rating.elements.bearing_life import RELIABILITY
from tribodyn.study.case import to_models
from tribodyn.study.case.rating_tables import (
    BearingCatalogue,
    NotchTable,
    ShaftStrength,
    history_classes,
    history_problems,
)
from tribodyn.study.case.section import Section, named_rows, table_in
from tribodyn.study.case.sections import MaterialData
from tribodyn.study.case.values import FaultError, KeyedProblems, Plain, read_value, written
from tribodyn.study.machine.tables import BearingTable, GearTable, SolverTable, rolling_options

LENGTH = number(
    REQUIRED, 0.0, 100.0, "guards against a wrong unit", unit="m", display_unit="mm",
    example='"60 mm"', meaning="a length of the shaft",
)  # fmt: skip
_SECTION = (
    'Write sections = [["60 mm", "40 mm"], ...]: length, outer and inner diameter, and for a cone '
    "both diameters of the end"
)
_PARTS = ("length", "outer_diameter", "inner_diameter", "end_outer_diameter", "end_inner_diameter")
_RPM = math.pi / 30.0
#: Lowest speed of a shaft, that of a pair [rad/s].
_SLOWEST = 0.01 * _RPM
#: Distance on both sides of a notch at which the diameters are read [m].
_BESIDE = 1e-7
_SHARE = re.compile(r"\s*([\d.]+)\s*%\s*")


def built(key: str, make: Callable[[], Any], problems: KeyedProblems) -> Any:
    """Build a part; its problems are placed at the keys of its table."""
    try:
        return make()
    except InputError as error:
        for problem in error.problems:
            where = problem.where
            name = where.name.partition(".")[2] if isinstance(where, Argument) else ""
            problems.append((f"{key}.{name}" if name else key, problem))
    return None


def read_shaft(name: str, table: Any, problems: KeyedProblems) -> Shaft | None:
    """Shaft of a table."""
    key, rows, count = f"shafts.{name}", table.sections or (), len(problems)
    sections = [
        _section(f"{key}.sections", number, row, problems) for number, row in enumerate(rows)
    ] if isinstance(rows, list | tuple) else []  # fmt: skip
    if not isinstance(rows, list | tuple):
        what = f"sections = {rows!r}"
        problems.append((f"{key}.sections", Problem(what, "", "It is a list of lists", _SECTION)))
    if len(problems) > count or is_faulty(key, problems):
        return None
    valid = tuple(section for section in sections if section is not None)
    part: Shaft | None = built(
        key, lambda: Shaft(valid, to_models.material(table), table.moment_of_inertia), problems
    )
    return part


def _section(key: str, place: int, row: Any, problems: KeyedProblems) -> ShaftSection | None:
    row = [Plain(item) for item in row.value] if isinstance(row, Plain) else row
    label = f"sections[{place}]"
    if not isinstance(row, list | tuple) or not 2 <= len(row) <= 5:
        why = "A section has a length, and one to four diameters"
        problems.append((key, Problem(f"{label} = {row!r}", "", why, _SECTION)))
        return None
    try:
        values = [read_value(LENGTH, f"{label}[{i}]", item) for i, item in enumerate(row)]
    except FaultError as fault:
        problems.append((key, fault.problem))
        return None
    part: ShaftSection | None = built(
        key, lambda: ShaftSection(**dict(zip(_PARTS, values, strict=False))), problems
    )
    return part


def read_bearing(name: str, table: Any, problems: KeyedProblems) -> Bearing | None:
    """Bearing of a table: a linear support, or a rolling bearing by its ``type``."""
    key, count, law = f"bearings.{name}", len(problems), ROLLING_BEARINGS.all().get(table.type)
    if is_faulty(key, problems):
        return None
    rolling = None
    if law is not None:
        stated = {option: getattr(table, option) for option in rolling_options(law)}
        stated = {option: value for option, value in stated.items() if value is not None}
        rolling = built(key, lambda: law(**stated), problems)
    if len(problems) > count:
        return None
    others = ("type", *BearingCatalogue.fields)
    values = {k: getattr(table, k) for k in BearingTable.fields if k not in others}
    part: Bearing | None = built(key, lambda: Bearing(**values, rolling=rolling), problems)
    return part


class RatedParts(NamedTuple):
    """What a machine is rated by besides its teeth."""

    rating: Any = None  #: table ``[rating]``, with its keys of bearings
    catalogues: Mapping[str, BearingCatalogue] = {}  #: of bearings; of pins by ``planets.NAME``
    notches: Mapping[tuple[str, str], tuple[float, ShaftNotch, ShaftMaterial]] = {}


def read_rated_parts(
    rating: Any,
    tables: Mapping[str, Mapping[str, Any]],
    shafts: Mapping[str, Shaft],
    problems: KeyedProblems,
) -> RatedParts:
    """Read what the lives of bearings and the safeties of shafts are computed from."""
    if rating is None:
        return RatedParts()
    if rating.reliability is not None and rating.reliability not in RELIABILITY:
        why = f"ISO 281 has: {', '.join(f'{value:g}' for value in RELIABILITY)}"
        what = f"reliability = {rating.reliability:g}"
        problems.append(("rating.reliability", Problem(what, "", why, "Choose one of these")))
    catalogues = dict(tables["bearings"])
    for name, stage in tables["planets"].items():
        catalogues[f"planets.{name}"] = pin = BearingCatalogue()
        vars(pin).update({key: getattr(stage, f"pin_{key}") for key in BearingCatalogue.fields})
    stated = {name: each for name, each in catalogues.items() if each.dynamic_load_rating}
    notches: dict[tuple[str, str], tuple[float, ShaftNotch, ShaftMaterial]] = {}
    for name, table in tables["shafts"].items():
        if table.notches is not None and name in shafts:  # others are reported where they are read
            notches |= _read_notches(name, table, shafts[name], problems)
    return RatedParts(rating, stated, notches)


def _read_notches(
    name: str, table: Any, shaft: Shaft, problems: KeyedProblems
) -> dict[tuple[str, str], tuple[float, ShaftNotch, ShaftMaterial]]:
    """Notched sections of a shaft, with its material."""
    key = f"shafts.{name}"
    notches: dict[tuple[str, str], tuple[float, ShaftNotch, ShaftMaterial]] = {}
    for missing in ("tensile_strength", "yield_strength", "sections"):
        if not getattr(shaft if missing == "sections" else table, missing):
            what, why = f"{missing} is missing", "Notches are rated by section and strength"
            remedy = f"Add {missing} to [{key}], or remove the notches"
            problems.append((f"{key}.{missing}", Problem(what, "", why, remedy)))
            return notches
    steel = {k: getattr(table, k) for k in ShaftStrength.fields}
    steel["kind"] = steel.pop("heat_treatment")
    for place, each in parts_of(table, "notches").items():
        at = f"{key}.notches.{place}"
        if is_faulty(at, problems):
            continue
        if not 0.0 < each.position < shaft.length:
            what = f"position = {1e3 * each.position:.6g} mm"
            why = f"The shaft extends from 0 to {1e3 * shaft.length:.6g} mm"
            problem = Problem(what, "", why, "Give a position on the shaft")
            problems.append((f"{at}.position", problem))
            continue
        notch = built(at, partial(notch_of, each, shaft), problems)
        material = built(key, partial(ShaftMaterial, **steel), problems)
        if notch is not None and material is not None:
            notches[name, place] = each.position, notch, material
    return notches


def notch_of(table: Any, shaft: Shaft) -> ShaftNotch:
    """Notched section of a table, with the diameters of the shaft where it gives none."""
    ends, sides = shaft.ends, []
    for place in (table.position - _BESIDE, table.position + _BESIDE):
        number = min(max(bisect(ends, place) - 1, 0), len(shaft.sections) - 1)
        section = shaft.sections[number]
        sides.append(section.diameters((place - ends[number]) / section.length))
    values = {name: getattr(table, name) for name in NotchTable.fields if name != "position"}
    thin, thick = sorted(side[0] for side in sides)
    values["diameter"] = table.diameter or thin
    if table.large_diameter is None and table.kind in ("shoulder", "groove"):
        values["large_diameter"] = thick
    return ShaftNotch(**values, bore_diameter=max(side[1] for side in sides))


def read_coupling(name: str, table: Any, problems: KeyedProblems) -> Coupling | None:
    """Coupling of a table."""
    key, shafts = f"couplings.{name}", table.shafts
    if is_faulty(key, problems):
        return None
    shafts = shafts if isinstance(shafts, list | tuple) else written(shafts)
    model = COUPLINGS[table.model]
    values = {option: getattr(table, option) for option in model.case_options}
    part: Coupling | None = built(key, lambda: model.function(shafts, **values), problems)
    return part


def read_gear(
    name: str, table: Any, problems: KeyedProblems, widths: Mapping[str, float] = NO_OPTIONS
) -> Gear | None:
    """Gear of a table; ``widths`` has the face widths of blanks."""
    key, width = f"gears.{name}", widths.get(name)
    if is_faulty(key, problems):
        return None
    if table.face_width is None and width is None:
        remedy = f'Add for example face_width = "40 mm" to [{key}]'
        problem = Problem("face_width is missing", "", "A gear has a width", remedy)
        problems.append((f"{key}.face_width", problem))
        return None
    names = [field.name for field in fields(Gear) if field.name in GearTable.fields]
    values = {k: getattr(table, k) for k in names} | {"teeth": table.tooth_count}
    values["face_width"] = width if table.face_width is None else table.face_width
    part: Gear | None = built(key, lambda: Gear(**values), problems)
    return part


def read_share(key: str, value: Any, problems: KeyedProblems) -> float | None:
    """Share of the time: a fraction, or text with a percent sign."""
    value = value.value if isinstance(value, Plain) else value
    if isinstance(value, str) and (percent := _SHARE.fullmatch(value)):
        value = float(percent[1]) / 100.0
    valid = isinstance(value, int | float) and not isinstance(value, bool) and 0.0 < value <= 1.0
    if not valid:
        why, remedy = "A share of the time is above 0 and at most 1", 'Write share = "30 %"'
        problems.append((key, Problem(f"share = {value!r}", "", why, remedy)))
        return None
    return float(value)


def parts_of(tables: Section, group: str) -> dict[str, Any]:
    """Tables of a group by name, without what is no table."""
    named = vars(tables)[group]
    return {n: table for n, table in (vars(named) if named else {}).items() if table is not None}


def each_part(
    tables: Mapping[str, Any], read: Callable[..., Any], problems: KeyedProblems
) -> dict[str, Any]:
    """Parts of a group by name; those that cannot be read are left out."""
    parts = {name: read(name, table, problems) for name, table in tables.items()}
    return {name: part for name, part in parts.items() if part is not None}


def is_faulty(key: str, problems: KeyedProblems) -> bool:
    """Whether the table of a part has problems."""
    return any(place == key or place.startswith(f"{key}.") for place, _ in problems)


def solver_problems(data: Mapping[str, Any], solver: SolverTable) -> KeyedProblems:
    """Problems of a coupling that a machine does not have."""
    bodies = [data.get("dynamics", {})]
    bodies += [body for group in ("meshes", "planets") for body in table_in(data, group).values()]
    follows = any(isinstance(b, Mapping) and b.get("friction_load") == "dynamic" for b in bodies)
    what, why = 'coupling = "dynamic"', ""
    if solver.coupling == "dynamic":
        why = "The load of a mesh of a machine is no function of its own phase alone"
    elif solver.coupling == "static" and follows:
        what = 'coupling = "static" and friction_load = "dynamic"'
        why = "The coupling already makes friction follow the load"
    remedy = 'Write coupling = "static", or friction_load = "dynamic" without coupling'
    return [("solver.coupling", Problem(what, "", why, remedy))] if why else []


def completed(data: Mapping[str, Any]) -> dict[str, Any]:
    """Tables as typed, with what parts take from others: their material, and shafts of a stage."""
    values = table_in(data, "material")
    common = {key: value for key, value in values.items() if key in MaterialData.fields}
    density = {"density": common.get("density", Plain(MaterialData.fields["density"].default))}
    shafts: dict[str, Any] = {}
    for stage in map(_as_table, table_in(data, "planets").values()):
        planets = (stage.get("planet"), stage.get("ring_planet"))
        shafts |= {str(name): {"shaft": "planet"} for name in planets if name is not None}
        if not data.get("shafts"):  # a lone stage: its members are shafts of their own
            for member in (str(stage.get(role)) for role in ("sun", "ring")):
                shafts[member] = {"shaft": member}
    parts: dict[str, Any] = {
        "shafts": {n: {**common, **b} for n, b in _bodies(data, "shafts")},
        "gears": {n: {**density, **shafts.get(n, {}), **b} for n, b in _bodies(data, "gears")},
    }
    return {k: {**table_in(data, k), **parts[k]} if k in parts else v for k, v in data.items()}


def for_each_planet(tables: dict[str, Any]) -> dict[str, Any]:
    """Tables in which one text for the errors of all planets is a list with one for each."""
    stages = tables.get("planets")
    for body in stages.values() if isinstance(stages, dict) else ():
        for name in ("pin_errors", "thickness_errors"):
            count = body.get("count") if isinstance(body, dict) else None
            count = count.value if isinstance(count, Plain) else count
            if isinstance(count, int) and isinstance(body.get(name), str):
                body[name] = [body[name]] * min(max(count, 1), 99)
    return tables


def _as_table(value: Any) -> Mapping[str, Any]:
    return value if isinstance(value, Mapping) else {}


def _bodies(data: Mapping[str, Any], group: str) -> Iterator[tuple[str, Mapping[str, Any]]]:
    tables = table_in(data, group).items()
    return ((name, body) for name, body in tables if isinstance(body, Mapping))


def add_shafts(
    shafts: dict[str, Shaft], gears: Mapping[str, Gear], stages: Mapping[str, Any], material: Any
) -> tuple[str, ...]:
    """Add rigid shafts that only gears name, or the members of stages; return their names."""
    tables = [table for table, *_ in stages.values()]
    members = [gears[n].shaft for t in tables for n in (t.sun, t.ring) if n in gears]
    members += [table.carrier for table in tables]
    implied = members if shafts else [*(gear.shaft for gear in gears.values()), *members]
    added = tuple(dict.fromkeys(name for name in implied if name not in shafts))
    shafts.update(dict.fromkeys(added, Shaft((), to_models.material(material))))
    return added


def unknown_gears(
    meshes: Mapping[str, tuple[str, str]], gears: Mapping[str, Gear]
) -> KeyedProblems:
    """Problems of meshes whose gears do not exist."""
    problems: KeyedProblems = []
    for name, names in meshes.items():
        for gear in names:
            if gear not in gears:
                problem = no_such("gear", gear, gears, "", "Add the gear, or correct the name")
                problems.append((f"meshes.{name}.gears", problem))
    return problems


@dataclass(frozen=True)
class LoadCase:
    """Speed and torque of the input, and the share of the time with them.

    Parameters
    ----------
    name : str
        Name of the load case.
    speed : float
        Speed of the input [rad/s].
    torque : float
        Torque on the input [N*m].
    share : float
        Share of the time [1].
    temperature, gear_temperature : float, optional
        Temperatures of oil and gears in place of those of the table ``lubricant`` [K].
    sharing : mapping of str to float
        Torques of the first gears of meshes in loops over that of the input at rest [1].
    """

    name: str
    speed: float
    torque: float
    share: float
    temperature: float | None = None
    gear_temperature: float | None = None
    sharing: Mapping[str, float] = field(default_factory=dict)


class Loads(NamedTuple):
    """Input and output, the operating point and the load cases."""

    ends: tuple[str, str]
    operating_point: LoadCase
    load_cases: tuple[LoadCase, ...]


def read_loads(
    data: Mapping[str, Any], tables: Any, named: Mapping[str, Any], problems: KeyedProblems
) -> Loads | None:
    """Read ``[operation]``, and ``[[load_cases]]`` or a history; None without operating point."""
    operation = tables.operation
    rows = data.get("load_cases", [])
    if not isinstance(rows, list | tuple) or not all(isinstance(r, Mapping) for r in rows):
        remedy = "Write [[load_cases]] with share, speed and torque"
        problems.append(("load_cases", Problem("load_cases is no list", "", "", remedy)))
    elif len({name for name, _ in named_rows(rows)}) < len(rows):
        what = "two load cases have one name"
        problems.append(("load_cases", Problem(what, "", "", "Rename one of them")))
    if operation is None or is_faulty("operation", problems):
        return None
    for end in ("input", "output"):
        if not getattr(operation, end):
            problem = Problem(f'{end} = ""', "", "It names a shaft or a member", "Give its name")
            problems.append((f"operation.{end}", problem))
    point = LoadCase("operation", operation.speed, operation.torque, 1.0)
    speeds = {f"load_cases.{row}": getattr(table, "speed", None) for row, table in named.items()}
    for key, speed in {"operation": operation.speed, **speeds}.items():
        if speed is not None and abs(speed) < _SLOWEST:
            what, why = f"speed = {speed / _RPM:.4g} rpm", "Allowed: 0.01 rpm or faster either way"
            problems.append((f"{key}.speed", Problem(what, "", why, "Correct the value")))
    loads = _history_loads(tables.rating, point, bool(named), problems)
    loads += tuple(_load_cases(named, point, problems))
    total = sum(load.share for load in loads)
    if total > 1.0 + 1e-9:
        what, why = f"the shares add up to {100.0 * total:.6g} %", "They are parts of one time"
        problems.append(("load_cases", Problem(what, "", why, "Correct the shares")))
    return Loads((operation.input, operation.output), point, loads)


def _history_loads(
    rating: Any, point: LoadCase, has_load_cases: bool, problems: KeyedProblems
) -> tuple[LoadCase, ...]:
    """Classes of the history of the torque as load cases."""
    if is_faulty("rating", problems):
        return ()
    faults = list(history_problems(rating, point.speed))
    if not faults and has_load_cases and rating is not None and rating.torque_history is not None:
        what = "torque_history and [[load_cases]] are both given"
        why = "Both are loads of the machine"
        faults = [("rating.torque_history", Problem(what, "", why, "Remove one of both"))]
    problems += faults
    return () if faults else tuple(
        LoadCase(each.name, math.copysign(each.speed, point.speed), each.torque, each.duration)
        for each in history_classes(rating, point.speed)
    )  # fmt: skip


def _load_cases(
    rows: Mapping[str, Any], point: LoadCase, problems: KeyedProblems
) -> Iterator[LoadCase]:
    for place, (row, table) in enumerate(rows.items()):
        key = f"load_cases.{row}"
        if is_faulty(key, problems):
            continue
        share: float | None = 1.0 / len(rows)
        if table.share is not None:
            share = read_share(f"{key}.share", table.share, problems)
        if share is not None:
            stated = {"speed": table.speed, "torque": table.torque}
            values = {name: value for name, value in stated.items() if value is not None}
            yield replace(point, name=table.name or f"load case {place + 1}", share=share, **values)
