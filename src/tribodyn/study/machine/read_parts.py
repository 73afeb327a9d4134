"""Read the tables of the parts of a machine into its objects, collecting every problem."""

from __future__ import annotations

import math
import re
from bisect import bisect
from collections.abc import Callable, Mapping
from dataclasses import MISSING, fields
from functools import partial
from typing import Any, NamedTuple

from tribodyn.errors import Argument, InputError, Problem, did_you_mean
from tribodyn.gear import Material
from tribodyn.machine import COUPLINGS, ROLLING_BEARINGS, Bearing, Coupling, Gear, Section, Shaft
from tribodyn.model import REQUIRED, Option, flag, integer, number, text
from tribodyn.rating import ShaftMaterial, ShaftNotch
from tribodyn.rating.elements.bearing_life import RELIABILITY
from tribodyn.study.case.rating_tables import (
    BearingCatalogue,
    NotchTable,
    PartRating,
    RatingTable,
    ShaftStrength,
)
from tribodyn.study.case.section import Section as Table
from tribodyn.study.case.sections import LubricantData, MaterialData, heat_problems
from tribodyn.study.case.user_input import UserInput
from tribodyn.study.case.values import (
    FaultError,
    KeyedProblems,
    Plain,
    read_table,
    read_value,
    written,
)
from tribodyn.study.faults.section import PartFaultTable
from tribodyn.study.machine.tables import (
    SOLVER_OF_PAIRS,
    BearingTable,
    GearTable,
    ShaftTable,
    SolverTable,
    part_table,
)

LENGTH = number(
    REQUIRED, 0.0, 100.0, "guards against a wrong unit", unit="m", display_unit="mm",
    example='"60 mm"', meaning="a length of the shaft",
)  # fmt: skip
_SECTION = (
    'Write sections = [["60 mm", "40 mm"], ...]: length, outer and inner diameter, and for a cone '
    "both diameters of the end"
)
_PARTS = ("length", "outer_diameter", "inner_diameter", "end_outer_diameter", "end_inner_diameter")
#: Tables of parts, each with a name.
_NAMED = ("shafts", "bearings", "gears", "meshes", "couplings", "planets", "faults")
#: Distance on both sides of a notch at which the diameters are read [m].
_BESIDE = 1e-7
_SHARE = re.compile(r"\s*([\d.]+)\s*%\s*")


def in_si(data: Any) -> Any:
    """Mark numbers of tables from Python as SI; lists of numbers as a whole."""
    if isinstance(data, Mapping):
        return {str(name): in_si(value) for name, value in data.items()}
    if isinstance(data, list | tuple) and any(
        isinstance(x, str | list | tuple | dict) for x in data
    ):
        return [in_si(item) for item in data]
    return data if isinstance(data, str | bool | Plain) else Plain(data)


def tables_of(data: Mapping[str, Any], group: str, problems: KeyedProblems) -> dict[str, Any]:
    """Tables of a group by name; anything else in it is a problem."""
    tables = {}
    for name, body in data.get(group, {}).items():
        if not name:
            what, remedy = "a part has no name", f"Write [{group}.NAME]"
            problems.append((group, Problem(what, "", "Others refer to it by name", remedy)))
        elif isinstance(body, Mapping):
            tables[str(name)] = dict(body)
            continue
        what, why = f"{name} = {body!r}", f"[{group}] holds one table for each part"
        problems.append((f"{group}.{name}", Problem(what, "", why, f"Write [{group}.NAME]")))
    return tables


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


def read_shaft(name: str, body: dict[str, Any], problems: KeyedProblems) -> Shaft | None:
    """Shaft of a table."""
    key = f"shafts.{name}"
    rows, count = body.pop("sections", ()), len(problems)
    body.pop("notches", None)  # read with the rating
    table = read_table(ShaftTable, body, key, {}, problems)
    sections = [
        _section(f"{key}.sections", number, row, problems) for number, row in enumerate(rows)
    ] if isinstance(rows, list | tuple) else []  # fmt: skip
    if not isinstance(rows, list | tuple):
        what = f"sections = {rows!r}"
        problems.append((f"{key}.sections", Problem(what, "", "It is a list of lists", _SECTION)))
    if len(problems) > count:
        return None
    material = Material(table.youngs_modulus, table.poissons_ratio, table.density)
    valid = tuple(section for section in sections if section is not None)
    part: Shaft | None = built(
        key, lambda: Shaft(valid, material, table.moment_of_inertia), problems
    )
    return part


def _section(key: str, place: int, row: Any, problems: KeyedProblems) -> Section | None:
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
    part: Section | None = built(
        key, lambda: Section(**dict(zip(_PARTS, values, strict=False))), problems
    )
    return part


def read_bearing(name: str, body: dict[str, Any], problems: KeyedProblems) -> Bearing | None:
    """Bearing of a table: a linear support, or a rolling bearing by its ``type``."""
    key, count = f"bearings.{name}", len(problems)
    rolling = None
    if "type" in body:
        rolling = _rolling(key, body, problems)
    table = read_table(BearingTable, body, key, {}, problems)
    if len(problems) > count:
        return None
    names = [name for name in BearingTable.fields if name not in BearingCatalogue.fields]
    values = {k: getattr(table, k) for k in names}
    part: Bearing | None = built(key, lambda: Bearing(**values, rolling=rolling), problems)
    return part


def _rolling(key: str, body: dict[str, Any], problems: KeyedProblems) -> Any:
    kind = body.pop("type")
    kind = kind if isinstance(kind, str) else written(kind)
    if kind not in ROLLING_BEARINGS:
        names = list(ROLLING_BEARINGS)
        why, remedy = f"Known: {', '.join(names)}", did_you_mean(kind, names, "Choose one of these")
        problems.append((f"{key}.type", Problem(f'type = "{kind}"', "", why, remedy)))
        for name in [name for name in body if name not in BearingTable.fields]:
            del body[name]
        return None
    law, values, count = ROLLING_BEARINGS[kind], {}, len(problems)
    for option, spec in rolling_options(law).items():
        if option in body:
            try:
                values[option] = read_value(spec, option, body.pop(option))
            except FaultError as fault:
                problems.append((f"{key}.{option}", fault.problem))
    return built(key, lambda: law(**values), problems) if len(problems) == count else None


#: Units of the geometry of rolling bearings by the end of the name.
_UNITS = {
    "diameter": ("m", "mm"), "length": ("m", "mm"), "width": ("m", "mm"), "clearance": ("m", "um"),
    "angle": ("rad", "deg"), "modulus": ("Pa", "GPa"), "preload": ("N", "N"),
    "temperature": ("K", "degC"),
}  # fmt: skip


def rolling_options(law: type) -> dict[str, Option]:
    """Options of a rolling bearing from the fields of its class."""
    options = {}
    for field in fields(law):
        if not field.init:
            continue
        default = None if field.default is MISSING else field.default
        kind, meaning = str(field.type), field.name.replace("_", " ")
        if "int" in kind and "float" not in kind:
            options[field.name] = integer(default, -1000, 1000, "counted", meaning=meaning)
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


class RatedParts(NamedTuple):
    """What a machine is rated by besides its teeth."""

    rating: Any = None  #: table ``[rating]``
    conditions: Any = None  #: its keys of bearings
    catalogues: Mapping[str, BearingCatalogue] = {}  #: of bearings; of pins by ``planets.NAME``
    notches: Mapping[tuple[str, str], tuple[float, ShaftNotch, ShaftMaterial]] = {}


def read_rated_parts(
    data: Mapping[str, Any], shafts: Mapping[str, Shaft], problems: KeyedProblems
) -> RatedParts:
    """Read what the lives of bearings and the safeties of shafts are computed from."""
    if not isinstance(body := data.get("rating"), Mapping):
        return RatedParts()
    of_parts = {k: v for k, v in body.items() if k in PartRating.fields}
    others = {k: v for k, v in body.items() if k not in of_parts}
    rating = table_of(RatingTable, others, "rating", problems)
    conditions = table_of(PartRating, of_parts, "rating", problems)
    if conditions is not None and conditions.reliability not in RELIABILITY:
        why = f"ISO 281 has: {', '.join(f'{value:g}' for value in RELIABILITY)}"
        what = f"reliability = {conditions.reliability:g}"
        problems.append(("rating.reliability", Problem(what, "", why, "Choose one of these")))
    catalogues = {}
    for group, prefix in (("bearings", ""), ("planets", "pin_")):
        for name, part in data.get(group, {}).items():
            keys = {k: f"{prefix}{k}" for k in BearingCatalogue.fields}
            stated = part if isinstance(part, Mapping) else {}
            values = {k: stated[key] for k, key in keys.items() if key in stated}
            if "dynamic_load_rating" in values:
                key = f"planets.{name}" if prefix else name
                catalogues[key] = read_table(BearingCatalogue, values, f"{group}.{name}", {}, [])
    notches: dict[tuple[str, str], tuple[float, ShaftNotch, ShaftMaterial]] = {}
    for name, part in data.get("shafts", {}).items():
        if isinstance(part, Mapping) and isinstance(part.get("notches"), Mapping):
            notches |= _read_notches(name, part, shafts.get(name), problems)
    return RatedParts(rating, conditions, catalogues, notches)


def _read_notches(
    name: str, body: Mapping[str, Any], shaft: Shaft | None, problems: KeyedProblems
) -> dict[tuple[str, str], tuple[float, ShaftNotch, ShaftMaterial]]:
    """Notched sections of a shaft, with its material."""
    key = f"shafts.{name}"
    values = {k: v for k, v in body.items() if k in ShaftStrength.fields}
    strength: Any = read_table(ShaftStrength, values, key, {}, [])
    notches: dict[tuple[str, str], tuple[float, ShaftNotch, ShaftMaterial]] = {}
    if shaft is None or strength is None:  # reported where it is read
        return notches
    for missing in ("tensile_strength", "yield_strength", "sections"):
        if not getattr(shaft if missing == "sections" else strength, missing):
            what, why = f"{missing} is missing", "Notches are rated by section and strength"
            remedy = f"Add {missing} to [{key}], or remove the notches"
            problems.append((f"{key}.{missing}", Problem(what, "", why, remedy)))
            return notches
    steel = {k: getattr(strength, k) for k in ShaftStrength.fields}
    steel["kind"] = steel.pop("heat_treatment")
    for place, each in body["notches"].items():
        at = f"{key}.notches.{place}"
        table: Any = table_of(NotchTable, each, at, problems)
        if table is not None and not 0.0 < table.position < shaft.length:
            what = f"position = {1e3 * table.position:.6g} mm"
            why = f"The shaft extends from 0 to {1e3 * shaft.length:.6g} mm"
            problem = Problem(what, "", why, "Give a position on the shaft")
            problems.append((f"{at}.position", problem))
        elif table is not None:
            notch = built(at, partial(notch_of, table, shaft), problems)
            material = built(key, partial(ShaftMaterial, **steel), problems)
            if notch is not None and material is not None:
                notches[name, place] = table.position, notch, material
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


def read_coupling(name: str, body: dict[str, Any], problems: KeyedProblems) -> Coupling | None:
    """Coupling of a table."""
    key, count = f"couplings.{name}", len(problems)
    shafts: Any = body.pop("shafts", ())
    shafts = shafts if isinstance(shafts, list | tuple) else written(shafts)
    kind = part_table("couplings", body)
    table: Any = read_table(kind, body, key, {}, problems)
    if len(problems) > count:
        return None
    values = {k: getattr(table, k) for k in kind.fields if k != "model"}
    model = COUPLINGS[table.model]
    part: Coupling | None = built(key, lambda: model.function(shafts, **values), problems)
    return part


def read_gear(name: str, body: dict[str, Any], problems: KeyedProblems) -> Gear | None:
    """Gear of a table."""
    key, count = f"gears.{name}", len(problems)
    table = read_table(GearTable, body, key, {}, problems)
    if len(problems) > count:
        return None
    if table.face_width is None:
        remedy = f'Add for example face_width = "40 mm" to [{key}]'
        problem = Problem("face_width is missing", "", "A gear has a width", remedy)
        problems.append((f"{key}.face_width", problem))
        return None
    names = [field.name for field in fields(Gear) if field.name in GearTable.fields]
    values = {k: getattr(table, k) for k in names} | {"teeth": table.tooth_count}
    if table.density is None:
        del values["density"]
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


def check_tables(data: dict[str, Any], allowed: tuple[str, ...], problems: KeyedProblems) -> None:
    """Report keys that a case of parts does not have; remove what is no table or no text."""
    for name in list(data):
        if name not in allowed:
            remedy = did_you_mean(name, allowed, "Remove it")
            why = f"A machine has: {', '.join(allowed)}"
            problems.append((name, Problem(f"{name}: unknown key", "", why, remedy)))
            continue
        is_text = name in ("title", "origin")
        if isinstance(data[name], str if is_text else Mapping) or name == "load_cases":
            continue
        if data[name] is not None:
            what = f"{name} is {'no text' if is_text else 'not a table'}"
            table = f"{name}.NAME" if name in _NAMED else name
            remedy = "Write it in quotes" if is_text else f"Write [{table}] with its keys"
            problems.append((name, Problem(what, "", "", remedy)))
        del data[name]


def table_of(kind: type[Table], body: Any, key: str, problems: KeyedProblems) -> Any:
    """Read one table of fixed keys; None where it is not a table or has problems."""
    if not isinstance(body, Mapping):
        problems.append((key, Problem(f"{key} is not a table", "", "", f"Write [{key}]")))
        return None
    count = len(problems)
    table = read_table(kind, body, key, {}, problems)
    return table if len(problems) == count else None


def read_each(groups: Mapping[str, Any], group: str, read: Any, problems: KeyedProblems) -> Any:
    """Parts of a group by name; those that cannot be read are left out."""
    parts = {n: read(n, dict(body), problems) for n, body in groups[group].items()}
    return {name: part for name, part in parts.items() if part is not None}


def read_heat(oil: Mapping[str, object], problems: KeyedProblems) -> LubricantData | None:
    """Table ``[lubricant]`` where it has a heat balance."""
    problems += heat_problems(UserInput({"lubricant": oil}))
    table: LubricantData | None = None
    if "heat_transfer" in oil:
        table = table_of(LubricantData, oil, "lubricant", problems)
    return table


def read_solver(data: Mapping[str, Any], problems: KeyedProblems) -> SolverTable:
    """Table ``[solver]``, of which a machine has the coupling at rest."""
    values = {k: v for k, v in data.get("solver", {}).items() if k not in SOLVER_OF_PAIRS}
    table: SolverTable = table_of(SolverTable, values, "solver", problems)
    bodies = [data.get("dynamics", {})]
    bodies += [body for group in ("meshes", "planets") for body in data.get(group, {}).values()]
    follows = any(isinstance(b, Mapping) and b.get("friction_load") == "dynamic" for b in bodies)
    kind, what, why = getattr(table, "coupling", "none"), 'coupling = "dynamic"', ""
    if kind == "dynamic":
        why = "The load of a mesh of a machine is no function of its own phase alone"
    elif kind == "static" and follows:
        what = 'coupling = "static" and friction_load = "dynamic"'
        why = "The coupling already makes friction follow the load"
    if why:
        remedy = 'Write coupling = "static", or friction_load = "dynamic" without coupling'
        problems.append(("solver.coupling", Problem(what, "", why, remedy)))
    return table


def read_fault_table(name: str, body: dict[str, Any], problems: KeyedProblems) -> Any:
    """Table of a fault."""
    return table_of(PartFaultTable, body, f"faults.{name}", problems)


def add_material(data: Mapping[str, Any], groups: Mapping[str, Any]) -> dict[str, Any]:
    """Give shafts and gears the common material where they have none of their own; return it."""
    shared = data.get("material", {})
    values = shared if isinstance(shared, Mapping) else {}
    common = {key: value for key, value in values.items() if key in ShaftTable.fields}
    for name, body in groups["shafts"].items():
        groups["shafts"][name] = {**common, **body}
    material = {"density": Plain(MaterialData.fields["density"].default), **common}
    for body in groups["gears"].values():
        body.setdefault("density", material["density"])
    return material


def add_shafts(
    shafts: dict[str, Any], gears: Mapping[str, Gear], stages: Mapping[str, Any], material: Any
) -> tuple[str, ...]:
    """Add rigid shafts that only gears name, or the members of stages; return their names."""
    tables = [table for table, *_ in stages.values()]
    members = [gears[n].shaft for t in tables for n in (t.sun, t.ring) if n in gears]
    members += [table.carrier for table in tables]
    implied = members if shafts else [*(gear.shaft for gear in gears.values()), *members]
    added = tuple(dict.fromkeys(name for name in implied if name not in shafts))
    shafts.update(dict.fromkeys(added, material))
    return added
