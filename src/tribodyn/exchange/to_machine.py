"""Convert a REXS model to a machine: shafts, bearings, stages as meshes, and load cases."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from tribodyn.errors import InputError, Problem
from tribodyn.exchange.gearbox import GearboxModel, Load, Stage, add_remark
from tribodyn.exchange.machine_parts import (
    Axis,
    axes_of,
    bearing_tables,
    gear_table,
)
from tribodyn.exchange.to_case import (
    SPUR,
    case_from_rexs,
    material_values,
    rack_values,
    shared_models,
    stored_case_text,
)
from tribodyn.exchange.to_planets import stage_from_rexs
from tribodyn.study.case.case import Case
from tribodyn.study.case.user_input import Source, plain
from tribodyn.study.machine.case import MachineCase
from tribodyn.study.machine.unused_keys import changed_machine

#: Part of a face without a mate that is rounding of the positions [m].
_FACE = 1e-5
#: Deviation of the axes from a centre distance that is worth a remark [m].
_APART = 1e-5
_FORCES = ("force_u_direction", "force_v_direction", "force_w_direction",
           "torque_around_v_axis", "torque_around_w_axis")  # fmt: skip


def machine_from_rexs(
    model: GearboxModel,
    load_case: int | None = None,
    *,
    changes: dict[str, Any] | None = None,
    by: str = "",
) -> MachineCase:
    """Machine of all stages of a gearbox model, with its shafts, bearings and load cases.

    Parameters
    ----------
    model : GearboxModel
        Result of :func:`read_rexs`.
    load_case : int, optional
        Number of the load case that is the operating point; the first by default.
    changes : dict, optional
        Values by dotted key that replace those of the file, as in :meth:`MachineCase.replace`:
        ``{"meshes.stage_19.stiffness": 5e8}`` for a stage without tooth contact.
    by : str
        Source of the changes, for messages; then a bare number for a dimension is refused.

    Returns
    -------
    MachineCase
        Parts are named after their numbers in the file: ``shaft_12``, ``gear_15``, ``stage_19``,
        ``bearing_33``. Values that the file does not contain are in its ``assumptions``, and so
        are the remarks on the model.

    Raises
    ------
    InputError
        Naming each stage that is not computed (planetary, bevel, worm), or if the machine cannot
        be composed.
    """
    changes = dict(changes or {})
    if problems := _unsupported(model):
        raise InputError(problems)
    model.stage(model.stages[0].id if model.stages else None)  # refuses a model without stages
    load = model.load(load_case)
    shafts = _shaft_senses(model, load)
    data, assumed = _parts(model, shafts, changes)
    data |= _operation(model, load, data, shafts)
    shared, notes = shared_models(model, load, changes)
    for name, values in shared.pop("gears", {}).items():
        data["gears"][name] |= values
    data |= shared
    assumed |= notes
    _remark_on_forces(model)
    assumed |= {f"remark {n}": text for n, text in enumerate(model.remarks, 1)}
    data["assumed"] = {key: reason for key, reason in assumed.items() if key not in changes}
    origin = f"REXS {model.version} file of {model.application or 'an unnamed program'}"
    title = f"Gearbox of {len(model.stages)} stage{'s' * (len(model.stages) > 1)}"
    tables = changed_machine(plain({"title": title, "origin": origin, **data}), changes, by=by)
    if "operation" not in tables or {"speed", "torque"} - tables["operation"].keys():
        remedy = 'Give both: --set "operation.speed=1500 rpm" --set "operation.torque=100 N*m"'
        what = "the speed and the torque of the gearbox are not known"
        raise InputError(what, model.path, "No load case specifies them on one shaft", remedy)
    source = Source(model.path).with_replaced(changes, by or "changes:")
    return MachineCase(source, **tables)


def case_from_model(model: GearboxModel, changes: dict[str, Any], by: str) -> Case | MachineCase:
    """Case of a REXS file: the one that tribodyn stored in it, or that of its stages."""
    if stored_case_text(model):
        case = case_from_rexs(model)
        return case.replace(changes, by=by) if changes else case
    if model.file.of_kind("planetary_stage"):
        return stage_from_rexs(model, changes=changes, by=by)
    return machine_from_rexs(model, changes=changes, by=by)


def _unsupported(model: GearboxModel) -> list[Problem]:
    problems = []
    for kind in ("planetary_stage", "bevel_stage", "worm_stage"):
        for stage in model.file.of_kind(kind):
            teeth = next((r for r in model.remarks if r.startswith(str(stage))), "")
            teeth = teeth.removeprefix(f"{stage}: ")
            what = f"{stage} is not computed" + (f" ({teeth})" if teeth else "")
            why = "The axes of a machine are parallel and fixed in the housing"
            remedy = f"List the data of its gears: tribodyn import {model.path}"
            problems.append(Problem(what, model.path, why, remedy))
    return problems


def _shafts_of(model: GearboxModel, stage: Stage) -> tuple[int, int]:
    numbers = []
    for gear in (stage.gear_1, stage.gear_2):
        number = model.shaft_of(gear.id)
        if number is None:
            component = model.file.components[gear.id]
            why, remedy = "A machine has its gears on shafts", "tribodyn import computes one stage"
            raise InputError("the gear is on no shaft", f"{model.path}: {component}", why, remedy)
        numbers.append(number)
    return numbers[0], numbers[1]


def _shaft_senses(model: GearboxModel, load: Load) -> dict[int, int]:
    """Shafts from the input on, with 1 or -1 where they turn against it."""
    edges = [(*_shafts_of(model, stage), -1 if stage.ratio > 0.0 else 1) for stage in model.stages]
    joined = {shaft for edge in edges for shaft in edge[:2]}
    named = [load.source, *load.speeds, edges[0][0]]
    senses = {next(number for number in named if number in joined): 1}
    for _ in edges:
        for first, second, turn in edges:
            for a, b in ((first, second), (second, first)):
                if a in senses:
                    senses.setdefault(b, turn * senses[a])
    for shaft in sorted(joined - senses.keys()):
        add_remark(model, f"{model.file.components[shaft]}: no stage joins it with the input")
    return senses


def _parts(
    model: GearboxModel, shafts: dict[int, int], changes: dict[str, Any]
) -> tuple[dict[str, Any], dict[str, str]]:
    """Tables of shafts, gears, meshes and bearings, and what is assumed."""
    axes, directions = axes_of(model, list(shafts))
    shared = material_values(model, *shafts)
    assumed: dict[str, str] = {}
    tables: dict[str, Any] = {"shafts": {}, "bearings": {}, "gears": {}, "meshes": {}}
    for number, axis in axes.items():
        material = {**shared, **material_values(model, number)}
        values = {k.partition(".")[2]: v for k, v in material.items() if shared.get(k) != v}
        tables["shafts"][axis.name] = axis.table | values
    for stage in model.stages:
        numbers = _shafts_of(model, stage)
        if not set(numbers) <= axes.keys():
            continue
        for gear, number in zip((stage.gear_1, stage.gear_2), numbers, strict=True):
            tables["gears"][f"gear_{gear.id}"] = gear_table(model, gear, axes[number])
        name = f"stage_{stage.id}"
        ends = axes[numbers[0]], axes[numbers[1]]
        _check_faces(model, stage, ends)
        tables["meshes"][name], note = _mesh(model, stage, ends, directions)
        if note:
            assumed[f"meshes.{name}.angle"] = note
    for name, table, reason in bearing_tables(model, axes):
        if f"bearings.{name}.type" in changes:
            table, reason = {key: table[key] for key in ("shaft", "position")}, ""
        tables["bearings"][name] = table
        if reason:
            assumed[f"bearings.{name}"] = reason
    if shared:
        tables["material"] = {key.partition(".")[2]: value for key, value in shared.items()}
    return tables, assumed


def _mesh(
    model: GearboxModel, stage: Stage, ends: tuple[Axis, Axis], directions: Any
) -> tuple[dict[str, Any], str]:
    """Table of a stage as a mesh, and the reason of its angle where that is assumed."""
    gear = stage.gear_1
    table = {
        "gears": [f"gear_{g.id}" for g in (stage.gear_1, stage.gear_2)],
        "normal_module": gear.normal_module,
        "normal_pressure_angle": gear.normal_pressure_angle,
        "center_distance": stage.center_distance,
    }
    if abs(gear.helix_angle) > SPUR:
        table["helix_angle"] = abs(gear.helix_angle)
        table["hand"] = "right" if gear.helix_angle > 0.0 else "left"
    rack = rack_values(model, stage.gear_1, stage.gear_2)
    table |= {key.partition(".")[2]: value for key, value in rack.items()}
    first, second = (axis.start for axis in ends)
    if directions is None or first is None or second is None:
        return table, "the file has no positions of the axes"
    y, z = directions @ (second - first)
    distance = math.hypot(y, z)
    if abs(distance - stage.center_distance) > _APART:
        add_remark(
            model,
            f"stage {stage.id}: the axes of its shafts are {1e3 * distance:.6g} mm apart; its "
            f"centre distance of {1e3 * stage.center_distance:.6g} mm is used",
        )
    table["angle"] = math.atan2(z, y)
    return table, ""


def _check_faces(model: GearboxModel, stage: Stage, ends: tuple[Axis, Axis]) -> None:
    """Remark on faces of which only a part meets, and refuse those that do not meet."""
    faces = [
        (place, gear.face_width)
        for axis, gear in zip(ends, (stage.gear_1, stage.gear_2), strict=True)
        if (place := axis.along_x(model.file.components[gear.id])) is not None and gear.face_width
    ]
    if len(faces) < 2:
        return
    (first, width), (second, other) = faces
    narrow, shift = min(width, other), abs(first - second)
    common = 0.5 * (width + other) - shift
    where = f"gear_{stage.gear_1.id} and gear_{stage.gear_2.id} of stage {stage.id}"
    what = f"the middles of {where} are {1e3 * shift:.4g} mm apart along their axes"
    if common <= 0.0:
        why = f"Their faces of {1e3 * width:.4g} and {1e3 * other:.4g} mm do not meet"
        raise InputError(
            what, model.path, why, "Correct the positions of the gears on their shafts"
        )
    if common < narrow - _FACE:
        meet = f"{1e3 * common:.4g} mm of the narrower face of {1e3 * narrow:.4g} mm meet"
        add_remark(model, f"{what}, so that {meet}; it is computed with the whole face, as if both "
                   "had one mid plane: correct the positions, or set face_width")  # fmt: skip


def _operation(
    model: GearboxModel, load: Load, data: dict[str, Any], shafts: dict[int, int]
) -> dict[str, Any]:
    """Operating point, and load cases where there are several."""
    first = next(iter(shafts))
    loaded = [
        number
        for number in list(shafts)[1:]
        if any(
            relation.of("assembly") == number
            for c in model.file.of_kind("external_load")
            if (flag := c.values.get("transmits_torque")) is not None and flag.content is True
            for relation in model.file.related("assembly", part=c.id)
        )
    ]
    last = (loaded or list(shafts))[-1]
    run = {"input": f"shaft_{first}", "output": f"shaft_{last}"}
    tables: dict[str, Any] = {"operation": run | _point(model, load, shafts)}
    if len(model.loads) > 1:
        tables["load_cases"] = [
            {"name": f"case_{each.id}"}
            | ({} if each.share is None else {"share": each.share})
            | _point(model, each, shafts)
            for each in model.loads
        ]
    return tables


def _point(model: GearboxModel, load: Load, shafts: dict[int, int]) -> dict[str, float]:
    """Speed and torque of the input under a load case, as far as the file has them."""
    first, point = next(iter(shafts)), {}
    if first in load.speeds:
        point["speed"] = load.speeds[first] * _sense(model, load, shafts)
    if first in load.torques:
        drives = load.driven == (load.source != first)
        point["torque"] = load.torques[first] * (1.0 if drives else -1.0)
    return point


def _sense(model: GearboxModel, load: Load, shafts: dict[int, int]) -> float:
    """Direction of rotation of the input about x: the sign of the speed in the file."""
    for number, sense in shafts.items():
        component = model.file.components[number]
        for part in (model.file.load_cases.get(load.id, {}).get(number), component):
            if part is not None and (speed := part.number("rotational_speed", "rad/s")):
                return math.copysign(1.0, speed) * sense * _along_x(model, number, shafts)
    return 1.0


def _along_x(model: GearboxModel, shaft: int, shafts: dict[int, int]) -> int:
    """1 where the u axis of a shaft points as that of the input, -1 where it is opposed."""
    axes = [model.file.components[n].vector("u_axis_vector", "m") for n in (shaft, *shafts)]
    pair = axes[0], axes[1]
    opposed = None not in pair and np.dot(np.array(pair[0]), np.array(pair[1])) < 0.0
    return -1 if opposed else 1


def _remark_on_forces(model: GearboxModel) -> None:
    """Forces on shafts other than torques are not part of a machine."""
    cases = [model.file.components, *model.file.load_cases.values()]
    parts = {
        c.id
        for case in cases
        for c in case.values()
        if c.kind == "external_load"
        and any(c.number(n, "N*m" if n.startswith("torque") else "N") for n in _FORCES)
    }
    for number in sorted(parts):
        part = model.file.components[number]
        add_remark(model, f"{part}: its forces and bending moments are ignored")
