"""Provenance of each value of a case: given by the user, assumed, or a default.

A reason in ``[assumed]`` refers to one value, and ``origin`` to the initial values of the case.
Both are stored with the values they refer to, so that a changed value loses its former reason.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Container, Iterable, Iterator, Mapping, Set
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from tribodyn.errors import Problem
from tribodyn.model import Model, Option
from tribodyn.study.case.checks import DEFAULT_MARK
from tribodyn.study.case.gears import HELICAL_STIFFNESS, RQ_OVER_RA, is_idle
from tribodyn.study.case.hypoid import bodies
from tribodyn.study.case.section import (
    RAW_KINDS,
    NamedTables,
    Section,
    Table,
    in_force,
    section_at,
)
from tribodyn.study.case.sections import PROPERTIES, SHEET
from tribodyn.study.case.to_models import USUAL_GEARS, has_usual_backlash, mesh_law_of
from tribodyn.study.case.user_input import Stated, UserInput, si_value
from tribodyn.study.case.values import FaultError, Plain, unmarked, written
from tribodyn.types import ByName, Tree

if TYPE_CHECKING:
    from tribodyn.study.case.case import Case
    from tribodyn.study.case.pair import PairCase


#: Relative tolerance for equal values.
_ROUNDING = 1e-9
_RECORD_KEYS = {"value", "reason"}
#: Problems that are reported, at most.
_MAX_PROBLEMS = 50

KeyedProblems = list[tuple[str, Problem]]
OptionOf = Callable[[str], Option | None]


def differing(before: ByName, now: ByName) -> set[str]:
    """Return the keys whose values differ by more than rounding."""
    return {key for key, value in before.items() if not same(value, now.get(key))}


def same(first: Any, second: Any) -> bool:
    """Return whether two values in SI are equal to rounding."""
    if isinstance(first, tuple) and isinstance(second, tuple):
        return len(first) == len(second) and all(map(same, first, second))
    numbers = all(isinstance(v, int | float) and not isinstance(v, bool) for v in (first, second))
    return math.isclose(first, second, rel_tol=_ROUNDING) if numbers else bool(first == second)


def reasons(data: ByName) -> Any:
    """Return the reasons in ``[assumed]``; invalid entries are left for the check."""
    marks = data["assumed"]
    if not isinstance(marks, Mapping):
        return marks
    return {
        key: mark["reason"] if _is_record(mark) and "reason" in mark else mark
        for key, mark in marks.items()
    }


def reason_faults(marks: object) -> KeyedProblems:
    """Report reasons in ``[assumed]`` that are not text."""
    if not isinstance(marks, Mapping):
        what = f"assumed = {written(marks)}"
        return [("assumed", Problem(what, "", "assumed is a table", "Write [assumed]"))]
    wrong = {k: f"{k} = {written(why)}" for k, why in marks.items() if not isinstance(why, str)}
    rule = "A reason must be text", "Write it in quotes"
    return [(f"assumed.{key}", Problem(what, "", *rule)) for key, what in wrong.items()]


def without_records(data: ByName) -> Tree:
    """Return the tables of a case file without recorded values."""
    body = {key: value for key, value in data.items() if key != "based_on"}
    return {**body, "assumed": reasons(data)} if "assumed" in data else body


def _is_record(mark: object) -> bool:
    return isinstance(mark, Mapping) and set(mark) <= _RECORD_KEYS


def _read(
    option_of: OptionOf, table: str, typed: ByName, free: Container[str]
) -> tuple[Tree, KeyedProblems]:
    values: Tree = {}
    problems: KeyedProblems = []
    for key, value in typed.items():
        if len(problems) > _MAX_PROBLEMS:
            break
        spec, location = option_of(key), f"{table}.{key}"
        if spec is None and key.partition(".")[0] in free:
            values[key] = unmarked(value)
            continue
        if spec is None:
            why, remedy = f"[{table}] may contain only keys of a case", "Remove the line"
            problems.append((location, Problem(f'there is no key "{key}"', "", why, remedy)))
            continue
        try:
            values[key] = si_value(spec, key.rpartition(".")[2], value)
        except FaultError as fault:
            problems.append((location, fault.problem))
    return values, problems


def read_stated(case: Case, data: ByName) -> tuple[Stated, KeyedProblems]:
    """Read recorded values and their problems; those of parts that are gone stay as typed."""
    table, base = data.get("assumed", {}), data.get("based_on", {})
    if not isinstance(base, Mapping):
        problem = Problem(f"based_on = {written(base)}", "", "It is a table", "Write [based_on]")
        return Stated({}, {}), [("based_on", problem)]
    records = table.items() if isinstance(table, Mapping) else ()
    typed = {k: m["value"] for k, m in records if _is_record(m) and "value" in m}
    free = {n for n, f in case.root.fields.items() if isinstance(f, Table) and _is_free(f.kind)}
    marks, problems = _read(case.option_of, "assumed", typed, free)
    initial, base_problems = _read(case.option_of, "based_on", _flat(base), free)
    return Stated(marks, initial), [*problems, *base_problems]


def _is_free(kind: type[Section]) -> bool:
    """Whether the user names tables in a table, or it has lists."""
    inner = [kind, *(each.kind for each in kind.fields.values() if isinstance(each, Table))]
    named = any(issubclass(each, NamedTables) for each in inner)
    return named or any(option.kind in RAW_KINDS for _, option in kind.specs())


def _flat(table: ByName, prefix: str = "") -> Tree:
    """Flatten a table with quoted or nested keys to dotted keys."""
    flat: Tree = {}
    for name, value in table.items():
        deeper = isinstance(value, Mapping)
        flat |= _flat(value, f"{prefix}{name}.") if deeper else {f"{prefix}{name}": value}
    return flat


def settled(
    case: Case, reasons: Mapping[str, str], inputs: UserInput, stated: Stated
) -> tuple[Stated, set[str]]:
    """Return records valid for the effective values, and keys whose reason is outdated."""
    # A reason without a recorded value refers to the value given with it.
    values = case._effective
    marks = {key: stated.marks.get(key, values.get(key)) for key in reasons}
    stale = differing(marks, values)
    author_marks = {key: value for key, value in marks.items() if reasons[key] != DEFAULT_MARK}
    current = {key: value for key, value in marks.items() if key not in stale}
    if stated.base and case.origin in (None, stated.base.get("origin")):
        return Stated(current, stated.base | author_marks | stated.base), stale
    base = {
        key: values[key]
        for key in inputs.typed
        if key in values and reasons.get(key) != DEFAULT_MARK
    }
    # A new origin documents the effective values, whatever they were before.
    return Stated(current, base if stated.base else base | author_marks), stale


def tables(stated: Stated, marks: Mapping[str, str]) -> Tree:
    """Return ``[assumed]`` and ``[based_on]``, from which an equal case can be read."""
    return {
        "assumed": {
            key: {"value": Plain(stated.marks[key]), "reason": reason}
            if stated.marks.get(key) is not None
            else reason
            for key, reason in marks.items()
        },
        "based_on": {key: Plain(value) for key, value in stated.base.items() if value is not None},
    }


_PROFILE = (
    "gears.normal_module",
    "gears.normal_pressure_angle",
    "gears.addendum_coefficient",
    "gears.dedendum_coefficient",
    "gears.rack_tip_radius_coefficient",
)
_TEETH = tuple(
    f"gears.{gear}.{name}"
    for gear in ("pinion", "wheel")
    for name in ("teeth", "profile_shift_coefficient")
)
_OIL = tuple(f"lubricant.{name}" for name in ("name", *PROPERTIES, *SHEET))
_LOAD = ("operation.speed", "operation.torque")
_ROUGHNESS = (
    "gears.composite_roughness",
    "gears.pinion.roughness_rms",
    "gears.wheel.roughness_rms",
    "gears.pinion.roughness_ra",
    "gears.wheel.roughness_ra",
)
_MASSES = tuple(
    f"gears.{gear}.{name}" for gear in ("pinion", "wheel") for name in ("mass", "moment_of_inertia")
)


def body(gear: str) -> tuple[str, ...]:
    """Return the keys that define the body of a gear."""
    names = (
        "teeth",
        "profile_shift_coefficient",
        "face_width",
        "tip_diameter",
        "bore_diameter",
        "rim_diameter",
        "density",
    )
    return (*_PROFILE, *(f"gears.{gear}.{name}" for name in names), "material.density")


_ELASTIC = (
    *dict.fromkeys((*body("pinion"), *body("wheel"))),
    "gears.center_distance",
    "material.youngs_modulus",
    "material.poissons_ratio",
)

_FOUNDATIONS: dict[str, tuple[str, ...]] = {
    "gears.center_distance": (*_PROFILE[:2], *_TEETH),
    "gears.pinion.mass": body("pinion"),
    "gears.pinion.moment_of_inertia": body("pinion"),
    "gears.wheel.mass": body("wheel"),
    "gears.wheel.moment_of_inertia": body("wheel"),
    "gears.pinion.tip_diameter": (*_PROFILE[:3], *_TEETH, "gears.center_distance"),
    "gears.wheel.tip_diameter": (*_PROFILE[:3], *_TEETH, "gears.center_distance"),
    "material.density": _MASSES,
    "material.youngs_modulus": ("material.poissons_ratio",),
    "lubricant.temperature": _OIL,
    "operation.torque": (*_PROFILE[:2], *_TEETH),
    "operation.speed_of": (*_LOAD, *_TEETH),
    "operation.torque_balance": (*_LOAD, *_TEETH),
    "friction.coefficient": (*_LOAD, *_OIL, "lubricant.temperature", *_ROUGHNESS),
    "dynamics.bearing_damping": (*_MASSES, "dynamics.bearing_stiffness"),
    "dynamics.mesh_damping": (*_MASSES, "stiffness.model"),
    "dynamics.backlash": ("gears.normal_module", "gears.center_distance"),
}
for _shaft in ("dynamics.shaft1", "dynamics.shaft2"):
    _disc, _spring = f"{_shaft}_moment_of_inertia", f"{_shaft}_stiffness"
    _FOUNDATIONS |= {_disc: (_spring,), _spring: (_disc,), f"{_shaft}_damping": (_disc, _spring)}
for _name in ("stiffness", "damping", "moment_of_inertia", "mass"):
    _twin = f"dynamics.shaft2_{_name}"  # Where it is taken as that of shaft 1.
    _FOUNDATIONS[_twin] = (*_FOUNDATIONS.get(_twin, ()), f"dynamics.shaft1_{_name}")
for _value in ("pair", "single_pair", "double_pair", "mean"):
    _FOUNDATIONS[f"stiffness.{_value}_stiffness"] = _ELASTIC
_FOUNDATIONS["stiffness.double_pair_stiffness"] = (*_ELASTIC, "stiffness.single_pair_stiffness")
for _value in ("cosine", "sine", "values"):
    _FOUNDATIONS[f"stiffness.{_value}"] = _ELASTIC


def foundations(key: str) -> tuple[str, ...]:
    """Return the keys whose change invalidates a reason given for this key."""
    return _FOUNDATIONS.get(key, ())


#: Cycles of a transient motion unless given, and keys of descriptive text.
_TRANSIENT_CYCLES, _TEXT_KEYS = 50, ("title", "origin")


@dataclass(frozen=True)
class Assumption:
    """A value that the user did not state, and the reason for it."""

    key: str  #: dotted key of the case file
    value: str  #: value with unit
    kind: str  #: ``"assumed"`` by the author of the case, or a ``"default"`` of tribodyn
    reason: str  #: why

    def __str__(self) -> str:
        """One line."""
        return f"{self.key} = {self.value} ({self.kind}): {self.reason}"


def _model_of(case: PairCase, path: list[str]) -> Model | None:
    """Return the model that a table of the case names."""
    section = vars(case).get(path[0]) if len(path) == 1 else None
    return section.chosen if isinstance(section, Section) else None


def _bored(case: PairCase, default: object) -> Any:
    """Return the reference of deflection: the rim where a gear has no bore and is no ring."""
    if case.gears.kind != "spur":
        return default
    gears = case.gears.pinion, case.gears.wheel
    supported = (gear.bore_diameter or gear.tooth_count < 0 for gear in gears)
    return "rim" if default == "bore" and not all(supported) else default


def effective_values(case: PairCase) -> Tree:
    """Return all effective values by dotted key, with defaults filled in."""
    values, kind = in_force(case), case.gears.kind
    values |= {key: None for key in values if is_idle(key, kind)}
    if kind == "table":
        values["film.model"] = "none"
    if case.stiffness.reference is None:
        values["stiffness.reference"] = _bored(case, values["stiffness.reference"])
    dampings = [f"dynamics.{name}" for name in ("mesh_damping", "bearing_damping")]
    values |= {f"{key}_ratio": None for key in dampings if values[key] is not None}
    values["dynamics.mesh_law"] = mesh_law_of(case)
    if case.solver.method == "transient":
        values["solver.cycles"] = values["solver.cycles"] or _TRANSIENT_CYCLES
    return values


def effective(case: Case) -> Tree:
    """Return all effective values by dotted key."""
    return dict(case._effective)


def default_of(case: PairCase, key: str) -> Any:
    """Return the default of a key for this case; None if it is derived."""
    *path, name = key.split(".")
    section = section_at(tuple(path))
    if key == "solver.cycles":
        return _TRANSIENT_CYCLES
    if key == "dynamics.mesh_law":
        return mesh_law_of(case)
    if key == "stiffness.model" and case.gears.helix_angle:
        return HELICAL_STIFFNESS
    model = _model_of(case, path)
    option = section.fields.get(name) if section else None
    standard = option.default if isinstance(option, Option) and not option.required else None
    if model is not None and (standard is None or name in model.options):
        standard = model.options.get(name)
    return _bored(case, standard) if key == "stiffness.reference" else standard


def changed_keys(case: Case) -> tuple[str, ...]:
    """Return the keys whose values differ from the initial values of the case."""
    if case._changed is None:
        case._changed = _keys_that_changed(case)
    return case._changed


def _keys_that_changed(case: Case) -> tuple[str, ...]:
    values, base = effective(case), case.stated.base
    if any(values.get(key) is None for key in base):
        derived = case._derived_values()
        values = {k: derived.get(k) if v is None else v for k, v in values.items()}
    before = {**_defaults_before(case, values), **base}
    return _in_order(case, differing(before, values) - set(_TEXT_KEYS))


def _defaults_before(case: Case, keys: Iterable[str]) -> Tree:
    """Return the initial defaults of keys that were given later."""
    inputs, base = case.user_input, case.stated.base
    return {
        key: case._default_of(key)
        for key in keys
        if key in inputs and key not in base and case.assumed.get(key) != DEFAULT_MARK
    }


def _in_order(case: Case, changed: Set[str]) -> tuple[str, ...]:
    keys = dict.fromkeys((*case._effective, *case.stated.base))
    return tuple(key for key in keys if key in changed)


def changed_after(before: Case, case: Case, numbers: ByName) -> None:
    """Set the changed keys of a case that differs from another only in some numbers."""
    base = case.stated.base
    if any(case._effective.get(key) is None for key in base):
        return  # derived values may depend on the numbers
    was = {**_defaults_before(case, numbers), **{k: base[k] for k in numbers if k in base}}
    changed = set(changed_keys(before)) - set(numbers) | differing(was, case._effective)
    case._changed = _in_order(case, changed)


def _marked(case: Case, key: str, value: object, changed: tuple[str, ...]) -> str:
    """Return the provenance of a value marked in ``[assumed]``."""
    reason = case.assumed[key]
    if reason != DEFAULT_MARK:
        changed_bases = [other for other in changed if other in foundations(key)]
        note = f"; stated before {', '.join(changed_bases)} changed" if changed_bases else ""
        return f"assumed: {reason}{note}"
    standard = case._default_of(key)
    if same(standard, value):
        return DEFAULT_MARK
    spec = case.option_of(key)
    current = spec.show(standard) if spec and standard is not None else "derived"
    return f"assumed: marked as default in the file, while this version has {current} for this case"


def _derived_from(case: PairCase, key: str) -> str:
    spec = case.option_of(key)
    is_usual = key == "dynamics.backlash" and has_usual_backlash(case)
    return USUAL_GEARS if is_usual else spec.basis if spec else ""


def _follows(case: Any, key: str) -> bool:
    """Whether a value that is not given follows from others; not that of another model."""
    *path, name = key.split(".")
    model, section = _model_of(case, path), section_at(tuple(path))
    chosen = model is None or section is None or name in {*section.fields, *model.options}
    return bool(_derived_from(case, key)) and chosen and not is_idle(key, case.gears.kind)


def provenance(case: Case) -> dict[str, str]:
    """Return the provenance of every effective value."""
    origins, changed, inputs = {}, changed_keys(case), case.user_input
    for key, value in effective(case).items():
        if key in case.assumed:
            origins[key] = _marked(case, key, value, changed)
        elif key in inputs:
            origins[key] = "given"
        elif value is not None or _follows(case, key):
            origins[key] = DEFAULT_MARK
    return origins


def assumptions(case: PairCase) -> tuple[Assumption, ...]:
    """List everything that the user did not state: assumed values and defaults."""
    values, derived, rows = effective(case), derived_values(case), []
    for key, origin in provenance(case).items():
        kind, _, reason = origin.partition(": ")
        spec = case.option_of(key)
        if kind == "given" or spec is None:
            continue
        if key in derived or (values[key] is None and spec.basis):
            reason = f"derived from {_derived_from(case, key)}"
        value = derived.get(key, values[key])
        display = "automatic" if value is None else spec.show(value)
        rows.append(Assumption(key, display, kind, reason or spec.meaning))
    return (*rows, *_heights(case), *_oil_assumptions(case))


def _heights(case: PairCase) -> Iterator[Assumption]:
    """Yield the rms roughness of flanks given as Ra."""
    for name, gear in (("pinion", case.gears.pinion), ("wheel", case.gears.wheel)):
        key = f"gears.{name}.roughness_rms"
        spec = case.option_of(key)
        if gear.roughness_ra is not None and gear.rms is not None and spec is not None:
            reason = f"Rq = {RQ_OVER_RA:g} Ra, as of ground flanks, whose heights are normal"
            yield Assumption(key, spec.show(gear.rms), "assumed", reason)


def _oil_assumptions(case: PairCase) -> list[Assumption]:
    """Return the assumptions of the oil library about the oil of a case."""
    oil = case.lubricant_properties
    if oil is None:
        return []
    return [Assumption("lubricant", oil.name, "assumed", reason) for reason in oil.assumptions]


def derived_values(case: PairCase) -> dict[str, float]:
    """Return all values that are derived because the case does not give them."""
    from tribodyn.gear import default_relief_length, mass_properties

    values = {"dynamics.backlash": case.backlash}
    if case.gears.kind != "spur":
        return _absent_from_case(case, values | _solid_cone_properties(case))
    pair = case.gear_pair
    for name, gear in (("pinion", pair.pinion), ("wheel", pair.wheel)):
        solid = mass_properties(gear, case.density(name))
        values[f"gears.{name}.face_width"] = gear.face_width
        values[f"gears.{name}.tip_diameter"] = gear.tip_diameter
        values[f"gears.{name}.mass"] = solid.mass
        values[f"gears.{name}.moment_of_inertia"] = solid.moment_of_inertia
        for end in ("tip_relief", "root_relief"):
            values[f"gears.{name}.modification.{end}_length"] = default_relief_length(pair)
    if pair.is_internal:
        values["gears.wheel.rim_diameter"] = 2.0 * pair.wheel.rim_radius
    values["gears.center_distance"] = pair.center_distance
    return _absent_from_case(case, values)


def _solid_cone_properties(case: PairCase) -> dict[str, float]:
    """Return masses and inertias of a hypoid pair."""
    if case.hypoid_flanks is None:
        return {}
    return {
        f"gears.{gear}.{name}": getattr(body, name)
        for gear, body in bodies(case.hypoid_flanks, case.material.density, case.gears).items()
        for name in ("mass", "moment_of_inertia")
    }


def _absent_from_case(case: PairCase, values: dict[str, float]) -> dict[str, float]:
    case_values = dict(case.values())
    return {key: value for key, value in values.items() if case_values.get(key, value) is None}
