"""Convert the planetary stage of a REXS model to a case."""

from __future__ import annotations

from typing import Any

import numpy as np

from tribodyn.errors import InputError, Problem
from tribodyn.exchange.gearbox import GearboxModel, Load, StageGear
from tribodyn.exchange.to_case import NOT_THERE, material_values, nested, rack_values, shared_models
from tribodyn.study.case.user_input import Source, plain
from tribodyn.study.machine.case import MachineCase
from tribodyn.study.machine.unused_keys import changed_machine
from tribodyn.types import Array

_SPUR = 1e-6
#: Deviation from equal spacing above which the angles are listed [rad].
_UNEQUAL = 1e-6


def stage_from_rexs(
    model: GearboxModel,
    load_case: int | None = None,
    *,
    changes: dict[str, Any] | None = None,
    by: str = "",
) -> MachineCase:
    """Case of the planetary stage of a gearbox model.

    Parameters
    ----------
    model : GearboxModel
        Result of :func:`read_rexs`.
    load_case : int, optional
        Number of the load case that is the operating point; the first by default.
    changes : dict, optional
        Values by dotted key that replace those of the file, as in :meth:`MachineCase.replace`.
    by : str
        Source of the changes, for messages; then a bare number for a dimension is refused.

    Returns
    -------
    MachineCase
        Its gears are named after their numbers in the file, such as ``gear_53``. Values that the
        file does not contain are in its ``assumptions``, and so are the remarks on the model.

    Raises
    ------
    InputError
        If the gearbox is another one than a single stage with a sun, a ring and equal planets, or
        speed and torque are not known.
    """
    changes, load = dict(changes or {}), model.load(load_case)
    sun, planets, ring = _gears(model)
    planet, carriers = planets[0], model.file.of_kind("planet_carrier")
    roles = {"sun": f"gear_{sun.id}", "planet": f"gear_{planet.id}", "ring": f"gear_{ring.id}"}
    roles["carrier"] = f"carrier_{carriers[0].id}" if carriers else "carrier"
    angles = _angles(model, sun, planets)
    equal = 2.0 * np.pi * np.arange(len(planets)) / len(planets)
    pair = next(stage for stage in model.stages if stage.ratio > 0.0)
    stage: dict[str, Any] = {
        **roles,
        "count": len(planets),
        "normal_module": planet.normal_module,
        "normal_pressure_angle": planet.normal_pressure_angle,
        "center_distance": pair.center_distance,
    }
    if angles is not None and np.abs(angles - equal).max() > _UNEQUAL:
        stage["angles"] = angles.tolist()
    if abs(sun.helix_angle) > _SPUR:
        stage["helix_angle"] = abs(sun.helix_angle)
        stage["hand"] = "right" if sun.helix_angle > 0.0 else "left"
    rack = rack_values(model, sun, planet)
    stage |= {key.partition(".")[2]: value for key, value in rack.items()}
    data: dict[str, Any] = {
        "gears": {roles[role]: _gear_table(gear) for role, gear in
                  (("sun", sun), ("planet", planet), ("ring", ring))},
        "planets": {f"stage_{model.file.of_kind('planetary_stage')[0].id}": stage},
    }  # fmt: skip
    data["operation"], assumed = _operation(model, load, (sun, ring), roles)
    shared, notes = shared_models(model, load, changes)
    for name, values in shared.pop("gears", {}).items():
        if name in data["gears"]:
            data["gears"][name] |= values
    notes = {k: v for k, v in notes.items() if _of_case(k, data["gears"])}
    material = nested(material_values(model, sun.id, model.shaft_of(sun.id)))
    data |= {**material, **shared}
    assumed |= notes | {f"remark {n}": text for n, text in enumerate(model.remarks, 1)}
    data["assumed"] = {key: reason for key, reason in assumed.items() if key not in changes}
    origin = f"REXS {model.version} file of {model.application or 'an unnamed program'}"
    title = f"Planetary stage with {len(planets)} planets"
    tables = changed_machine(plain({"title": title, "origin": origin, **data}), changes, by=by)
    if {"speed", "torque"} - tables["operation"].keys():
        remedy = 'Give both: --set "operation.speed=1500 rpm" --set "operation.torque=100 N*m"'
        what = "the speed and the torque of the stage are not known"
        raise InputError(what, model.path, "No load case specifies them on one member", remedy)
    return MachineCase(Source(model.path).with_replaced(changes, by or "changes:"), **tables)


def _of_case(key: str, gears: dict[str, Any]) -> bool:
    """Whether a note is on a gear of the case, or on no gear."""
    group, _, inner = key.partition(".")
    return group != "gears" or inner.partition(".")[0] in gears


def _gears(model: GearboxModel) -> tuple[StageGear, list[StageGear], StageGear]:
    """Sun, planets and ring of the only stage of a model; others are refused."""
    stages = model.file.of_kind("planetary_stage")
    problems = [
        Problem(f"{stage} is not computed", model.path, why, remedy)
        for stage, why, remedy in [
            *((s, "One planetary stage is computed by itself",
               f"List the data of its gears: tribodyn import {model.path}") for s in stages[1:]),
            *((model.file.components[s.id], "It is in one gearbox with a planetary stage",
               "Remove it from the model") for s in model.stages if not s.planetary),
        ]
    ]  # fmt: skip
    inner = [s for s in model.stages if s.planetary and s.ratio > 0.0]
    outer = [s for s in model.stages if s.planetary and s.ratio < 0.0]
    if not problems and (not inner or len(inner) != len(outer)):
        why = "A stage has a sun and a ring that mesh with every planet"
        remedy = f"List the data of its gears: tribodyn import {model.path}"
        problems = [Problem(f"{stages[0]} has another design", model.path, why, remedy)]
    if problems:
        raise InputError(problems)
    rings = [s.gear_1 if s.gear_1.teeth < 0 else s.gear_2 for s in outer]
    planets = [s.gear_2 if s.gear_1.teeth < 0 else s.gear_1 for s in outer]
    numbers = {planet.id for planet in planets}
    suns = [s.gear_2 if s.gear_1.id in numbers else s.gear_1 for s in inner]
    planet_types = {(p.teeth, p.profile_shift_coefficient, p.helix_angle) for p in planets}
    if max(len({sun.id for sun in suns}), len({ring.id for ring in rings}), len(planet_types)) > 1:
        why = "All planets are equal and mesh with one sun and one ring"
        remedy = f"List the data of its gears: tribodyn import {model.path}"
        raise InputError(f"{stages[0]} has another design", model.path, why, remedy)
    return suns[0], planets, rings[0]


def _angles(model: GearboxModel, sun: StageGear, planets: list[StageGear]) -> Array | None:
    """Angles of the planets, rising from the first; None where the file has no positions."""
    places = []
    for gear in (sun, *planets):
        number = model.shaft_of(gear.id)
        component = model.file.components[gear.id if number is None else number]
        places.append(component.vector("support_vector", "m"))
    number = model.shaft_of(sun.id)
    axis = model.file.components[number].vector("u_axis_vector", "m") if number else None
    if axis is None or None in places:
        return None
    along = np.array(axis) / np.linalg.norm(axis)
    offsets = np.array(places[1:], dtype=float) - np.array(places[0], dtype=float)
    offsets -= np.outer(offsets @ along, along)
    if not np.linalg.norm(offsets, axis=1).min() > 0.0:
        return None
    first = offsets[0] / np.linalg.norm(offsets[0])
    angles = np.arctan2(offsets @ np.cross(along, first), offsets @ first) % (2.0 * np.pi)
    return np.sort(np.where(angles > 2.0 * np.pi - _UNEQUAL, 0.0, angles))


def _gear_table(gear: StageGear) -> dict[str, Any]:
    names = ("profile_shift_coefficient", "face_width", "tip_diameter", "roughness_ra")
    table: dict[str, Any] = {"teeth": gear.teeth}
    table |= {name: value for name in names if (value := getattr(gear, name)) is not None}
    return {**table, "modification": gear.modification} if gear.modification else table


def _operation(
    model: GearboxModel, load: Load, gears: tuple[StageGear, StageGear], roles: dict[str, str]
) -> tuple[dict[str, Any], dict[str, str]]:
    """Operating point of the member that the file drives, and what is assumed of the output."""
    members = {model.shaft_of(gears[0].id): "sun", model.shaft_of(gears[1].id): "ring"}
    for relation in model.file.related("planet_carrier_shaft"):
        members[relation.of("shaft")] = "carrier"
    named = [load.source, *load.speeds]
    shaft = next((number for number in named if number in members), None)
    driver = members.get(shaft, "sun")
    loaded = [
        members[number]
        for part in model.file.of_kind("external_load")
        for relation in model.file.related("assembly", part=part.id)
        if (number := relation.of("assembly")) in members and members[number] != driver
    ]
    fallback = "sun" if driver == "carrier" else "carrier"
    output = loaded[0] if loaded else fallback
    run: dict[str, Any] = {"input": roles[driver], "output": roles[output]}
    if shaft in load.speeds:
        run["speed"] = load.speeds[shaft]
    if shaft in load.torques:
        run["torque"] = load.torques[shaft] * (-1.0 if load.driven else 1.0)
    note = {} if loaded else {"operation.output": NOT_THERE + "the usual member"}
    return run, note
