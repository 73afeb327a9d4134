"""Keys of a machine or a stage that have no effect there: they are refused, never ignored."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import Any

from tribodyn.errors import Problem, did_you_mean
from tribodyn.model import NO_OPTIONS
from tribodyn.study.case.rating_tables import (
    HISTORY,
    BearingCatalogue,
    PartRating,
    ShaftStrength,
)
from tribodyn.study.case.section import entries, section_at, table_in
from tribodyn.study.case.user_input import changed_tables, with_values
from tribodyn.study.case.values import written
from tribodyn.study.machine.tables import (
    GROUPS,
    HEAT,
    MESH_KEYS,
    SHARED,
    SOLVER_OF_PAIRS,
    HypoidMeshTable,
    MeshDynamics,
    OperationTable,
    mesh_table_kind,
)
from tribodyn.study.machine_tables import MachineTables

KeyedProblems = Iterator[tuple[str, Problem]]

#: Keys of a mesh, and of a gear, that only computed teeth have.
_OF_TEETH = (
    "composite_roughness",
    "addendum_coefficient",
    "dedendum_coefficient",
    "rack_tip_radius_coefficient",
    "ease_off",
    "mounting",
    "line_stiffness",
    "stiffness_model",
    "entrainment",
    *(name for name in MESH_KEYS if name not in MeshDynamics.fields),
    *(name for name in SHARED if name != "stiffness"),
)
_OF_FLANKS = (
    "hand",
    "profile_shift_coefficient",
    "tip_diameter",
    "material",
    "roughness_rms",
    "roughness_ra",
    "thermal_conductivity",
    "specific_heat",
    "modification",
)


def _is_set(table: Any, name: str) -> bool:
    return isinstance(table, Mapping) and table.get(name) is not None


def _refused(key: str, table: Any, names: Iterable[str], why: str, remedy: str) -> KeyedProblems:
    """Problems of the keys of a table that have no effect."""
    for name in names:
        if _is_set(table, name):
            is_table = isinstance(table[name], Mapping)
            what = name if is_table else f"{name} = {written(table[name])}"
            place = f"{key}.{name}" if key else name
            yield place, Problem(f"{what} has no effect here", "", why, remedy)


def _tables(data: Mapping[str, Any], group: str) -> dict[str, Mapping[str, Any]]:
    tables = data.get(group, {})
    named = tables.items() if isinstance(tables, Mapping) else ()
    return {name: body for name, body in named if isinstance(body, Mapping)}


def unused_keys(data: Mapping[str, Any]) -> KeyedProblems:
    """Keys of a machine or of a lone stage that have no effect."""
    yield from _heat(data)
    why = "The motion of a machine is found by harmonic balance"
    yield from _refused("solver", data.get("solver"), SOLVER_OF_PAIRS, why, "Remove it")
    yield from _planets(data)
    yield from _constant_meshes(data)
    named = {body.get("material") for body in _tables(data, "gears").values()}
    unused = [name for name in data.get("materials") or () if name not in named]
    why, remedy = "No gear names it", "Name it as material of a gear, or remove it"
    yield from _refused("materials", data.get("materials"), unused, why, remedy)
    yield from _rated_parts(data)


def _catalogues(data: Mapping[str, Any]) -> Iterator[tuple[str, Mapping[str, Any], str]]:
    """Key and body of bearings and stages, and what the keys of their catalogue begin with."""
    for group, prefix in (("bearings", ""), ("planets", "pin_")):
        for name, body in _tables(data, group).items():
            yield f"{group}.{name}", body, prefix


def rates_parts(data: Mapping[str, Any], *, shafts: bool = True) -> bool:
    """Whether bearings have a dynamic load rating, or shafts have notches."""
    listed = [body.get(f"{prefix}dynamic_load_rating") for _, body, prefix in _catalogues(data)]
    listed += [body.get("notches") for body in _tables(data, "shafts").values() if shafts]
    return any(value is not None for value in listed)


def _rated_parts(data: Mapping[str, Any]) -> KeyedProblems:
    """Keys of the life of bearings and the fatigue of shafts that have no effect."""
    is_rated, add = _is_set(data, "rating"), "Add [rating], or remove it"
    rated = []
    for key, body, prefix in _catalogues(data):
        keys = [f"{prefix}{name}" for name in BearingCatalogue.fields]
        if "type" in body:  # its inner dimensions are those of the catalogue
            why = "The type of the bearing gives it"
            yield from _refused(key, body, ("elements",), why, "Remove it")
            keys = keys[:3]
        rated.append(is_rated and _is_set(body, keys[0]))
        if not is_rated:
            yield from _refused(key, body, keys, "Only a rating needs it", add)
        elif not rated[-1]:
            why = "The life of a bearing needs its dynamic load rating"
            yield from _refused(key, body, keys, why, f"Add {keys[0]}, or remove it")
    for name, body in _tables(data, "shafts").items():
        keys, why, remedy = ["notches"], "Only a rating needs it", add
        if is_rated:
            why, remedy = "Only notches need the strength of a shaft", "Add notches, or remove it"
            keys = []
        if not is_rated or not _is_set(body, "notches"):
            keys += ShaftStrength.fields
        yield from _refused(f"shafts.{name}", body, keys, why, remedy)
    if not any(rated):
        why = "No bearing has dynamic_load_rating"
        yield from _refused("rating", data.get("rating"), PartRating.fields, why, "Remove it")
    why, remedy = "It is that of the whole machine", "Write it in [rating]"
    for group in ("meshes", "planets"):
        for name, body in _tables(data, group).items():
            table = body.get("rating")
            parts = *PartRating.fields, *HISTORY
            yield from _refused(f"{group}.{name}.rating", table, parts, why, remedy)


def _heat(data: Mapping[str, Any]) -> KeyedProblems:
    """Keys of a mesh of the heat balance, which is that of the whole machine."""
    stated = "temperature", "gear_temperature", "dynamic_viscosity"
    why = "The housing has one heat balance, which finds the temperature of all meshes"
    remedy = (
        "Give heat_transfer in [lubricant], and oils whose viscosity at any temperature is known"
    )
    names = (*HEAT, *(stated if _is_set(data.get("lubricant"), HEAT[0]) else ()))
    for group in ("meshes", "planets"):
        for name, body in _tables(data, group).items():
            table = body.get("lubricant")
            yield from _refused(f"{group}.{name}.lubricant", table, names, why, remedy)


def _planets(data: Mapping[str, Any]) -> KeyedProblems:
    """Keys of other kinds of planets, and places of planets that their stage gives."""
    for name, body in _tables(data, "planets").items():
        kind, key = body.get("planet_type", "single"), f"planets.{name}"
        if kind != "meshed":
            why = 'Only planets in pairs, planet_type = "meshed", have it'
            distances = ("ring_center_distance", "pair_center_distance")
            yield from _refused(key, body, distances, why, "Remove it")
        if kind == "single":
            why = "Planets with one gear have the module of the sun"
            yield from _refused(key, body, ("ring_normal_module",), why, "Remove it")
        gears, ring = _tables(data, "gears"), str(body.get("ring"))
        if data.get("shafts") and ring in gears and "shaft" not in gears[ring]:
            why, remedy = "A held ring has a shaft of its own", f'Add shaft = "{ring}"'
            yield f"gears.{ring}.shaft", Problem("shaft is missing", "", why, remedy)
        for role in ("planet", "ring_planet"):
            gear, stepped = body.get(role), role == "ring_planet" and kind == "stepped"
            places = ("shaft",) if stepped else ("shaft", "position")
            why = "The stage gives planets their shafts and their places on the pins"
            table = gears.get(str(gear))
            yield from _refused(f"gears.{gear}", table, places, why, "Remove it")
        for role in ("sun", "ring", "carrier"):
            member = str(body.get(role))
            shaft = str(gears.get(member, {}).get("shaft", member))
            bearings = [b for b in _tables(data, "bearings").values() if b.get("shaft") == shaft]
            if bearings or _is_set(_tables(data, "shafts").get(shaft), "sections"):
                why = f"Shaft {shaft} has sections, or bearings that support it"
                yield from _refused(key, body, (f"{role}_support",), why, "Remove it")


def _constant_meshes(data: Mapping[str, Any]) -> KeyedProblems:
    """Keys of teeth and films of meshes with a constant stiffness."""
    meshes, gears = _tables(data, "meshes"), _tables(data, "gears")
    computed: set[str] = set()
    named: set[str] = set()
    crossed, plane = False, "planets" in data
    why = "A mesh with a constant stiffness has no computed teeth"
    remedy = "Remove it, or remove the stiffness of the mesh"
    for stage in _tables(data, "planets").values():
        roles = [role for role in ("sun", "planet", "ring_planet", "ring") if role in stage]
        computed |= {str(stage[role]) for role in roles}
    named |= computed
    for name, body in meshes.items():
        names = body.get("gears")
        named |= {str(gear) for gear in (names if isinstance(names, list | tuple) else ("",))}
        if _is_set(body, "stiffness") and not isinstance(body["stiffness"], Mapping):
            yield from _refused(f"meshes.{name}", body, _OF_TEETH, why, remedy)
            continue
        is_crossed = mesh_table_kind(body) is HypoidMeshTable
        crossed, plane = crossed or is_crossed, plane or not is_crossed
        computed |= {str(gear) for gear in (names if isinstance(names, list | tuple) else ())}
    complete = named <= {*gears}  # other meshes are reported where they are read
    for name, body in gears.items():
        if complete and name not in computed:
            yield from _refused(f"gears.{name}", body, _OF_FLANKS, why, remedy)
    if crossed and not plane:
        why = "The stiffness of hypoid teeth is line_stiffness or stiffness_model of their mesh"
        yield from _refused("", data, ("stiffness",), why, "Remove [stiffness]")
        why = "Bevel and hypoid gears are not rated"
        remedy = "Remove it, or rate bearings and shafts: dynamic_load_rating, notches"
        names = ("materials",) if rates_parts(data) else ("rating", "materials")
        yield from _refused("", data, names, why, remedy)
    elif meshes and not (crossed or plane):
        teeth = ["lubricant", "film", "stiffness", "friction", "materials", "rating"]
        if rates_parts(data):
            teeth.remove("rating")
        if _is_set(data, "losses") or rates_parts(data, shafts=False):
            teeth.remove("lubricant")
        yield from _refused("", data, teeth, why, remedy)
        coupling = ("coupling", "coupling_tolerance")
        yield from _refused("solver", data.get("solver"), coupling, why, remedy)
        keys = [name for name in _OF_TEETH if name in MESH_KEYS]
        yield from _refused("dynamics", data.get("dynamics"), keys, why, remedy)


def changed_machine(
    data: Mapping[str, Any],
    changes: Mapping[str, Any],
    spread: Mapping[str, str] = NO_OPTIONS,
    by: str = "",
) -> dict[str, Any]:
    """Tables of a machine with values changed, without what the changes leave without effect."""
    before = {key for key, _ in unused_keys(data)}
    changed_data = changed_tables(MachineTables, data, changes, spread, by)
    parts = [key.split(".") for key in changes]
    changed = {".".join(each[:depth]) for each in parts for depth in range(1, len(each) + 1)}
    unused = [k for k, _ in unused_keys(changed_data) if k not in before and k not in changed]
    data = with_values(changed_data, dict.fromkeys(unused))
    if isinstance(reasons := data.get("assumed"), Mapping):
        data["assumed"] = {key: why for key, why in reasons.items() if key not in unused}
    return data


def unknown_part_key(data: dict[str, Any], key: str) -> Problem:
    """Problem of a key that the tables of a machine do not have, with the closest one."""
    keys = [
        f"{group}.{part}.{name}"
        for group in (*GROUPS, "planets")
        for part, body in table_in(data, group).items()
        for name in section_at((group, part), MachineTables).keys_for(body)  # type: ignore[union-attr]
    ]
    keys += [f"operation.{name}" for name in OperationTable.fields]
    keys += [".".join(place) for _, _, place in entries(data)]
    what, why = f'there is no key "{key}"', "Keys name the part and its value"
    part = next((name for name in keys if name.startswith("planets.")), "")
    example = f"{part.rpartition('.')[0]}.pin_stiffness" if part else "bearings.A.radial_stiffness"
    remedy = f'Write, for example, "{example}" or "operation.speed"'
    return Problem(what, "", why, did_you_mean(key, list(dict.fromkeys(keys)), remedy))
