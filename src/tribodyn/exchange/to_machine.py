"""Convert a REXS model to a machine: shafts, bearings, stages as meshes, and load cases."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np

from tribodyn.errors import InputError, Problem
from tribodyn.exchange.case_tree import tree_of
from tribodyn.exchange.gearbox import GearboxModel, Load, Stage, add_remark
from tribodyn.exchange.machine_parts import Axis, axes_of, bearing_tables, gear_table, part_name
from tribodyn.exchange.planet_stages import PlanetStage, planet_stages
from tribodyn.exchange.rexs_file import model_of
from tribodyn.exchange.to_case import (
    NOT_THERE,
    case_from_rexs,
    changed_values,
    material_values,
    nested,
    shared_models,
    teeth_table,
)
from tribodyn.study.case.section import flat_keys
from tribodyn.study.case.user_input import Source, plain
from tribodyn.study.machine.case import AnyCase, MachineCase
from tribodyn.study.machine.read import read_case
from tribodyn.study.machine.unused_keys import changed_machine
from tribodyn.types import Array, Tree

#: Part of a face without a mate that is rounding of the positions [m].
_FACE = 1e-5
#: Deviation of the axes from a centre distance that is worth a remark [m].
_APART = 1e-5
_FORCES = ("force_u_direction", "force_v_direction", "force_w_direction",
           "torque_around_v_axis", "torque_around_w_axis")  # fmt: skip


def machine_from_rexs(
    model: GearboxModel, load_case: int | None = None, *, changes: Tree | None = None, by: str = ""
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
        are the remarks on the model. From a machine written by tribodyn the complete case is
        restored, with the changes by other programs, which ``model.remarks`` lists.

    Raises
    ------
    InputError
        Naming each stage that is not computed (bevel, worm, other planetary designs), or if the
        machine cannot be composed.
    """
    changes = dict(changes or {})
    if load_case is None and (stored := _stored_machine(model)) is not None:
        return stored.replace(changes, by=by) if changes else stored
    load = model.load(load_case)
    data, assumed = file_tables(model, load, changes)
    shared, notes = shared_models(model, load, changes)
    for name, values in shared.pop("gears", {}).items():
        if name in data["gears"]:  # of equal planets the first one represents all
            data["gears"][name] |= values
    data |= shared
    assumed |= {k: v for k, v in notes.items() if _of_case(k, data["gears"])}
    _remark_on_forces(model)
    assumed |= {f"remark {n}": text for n, text in enumerate(model.remarks, 1)}
    data["assumed"] = {key: reason for key, reason in assumed.items() if key not in changes}
    origin = f"REXS {model.version} file of {model.application or 'an unnamed program'}"
    tables = changed_machine(
        plain({"title": _title(data), "origin": origin, **data}), changes, by=by
    )
    if "operation" not in tables or {"speed", "torque"} - tables["operation"].keys():
        remedy = 'Give both: --set "operation.speed=1500 rpm" --set "operation.torque=100 N*m"'
        what = "the speed and the torque of the gearbox are not known"
        raise InputError(what, model.path, "No load case specifies them on one shaft", remedy)
    source = Source(model.path).with_replaced(changes, by or "changes:")
    return MachineCase(source, **tables)


def stage_from_rexs(
    model: GearboxModel, load_case: int | None = None, *, changes: Tree | None = None, by: str = ""
) -> MachineCase:
    """Case of the planetary stage of a gearbox model that has no other stage.

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
    planetary, others = planet_stages(model)
    if len(planetary) != 1 or others:
        what = f"there are {len(planetary)} planetary stages and {len(others)} other stages"
        remedy = "Compute the machine: machine_from_rexs, or tribodyn import FILE --machine"
        raise InputError(what, model.path, "A lone planetary stage is one", remedy)
    return machine_from_rexs(model, load_case, changes=changes, by=by)


def case_from_model(model: GearboxModel, changes: Tree, by: str) -> AnyCase:
    """Case of a REXS file: the one that tribodyn stored in it, or that of its stages."""
    if model.file.stored_case and _stored_machine(model) is None:
        case = case_from_rexs(model)
        return case.replace(changes, by=by) if changes else case
    return machine_from_rexs(model, changes=changes, by=by)


def _stored_machine(model: GearboxModel) -> MachineCase | None:
    """Machine that tribodyn stored in the file, with the changes made since."""
    if not model.file.stored_case:
        return None
    stored: AnyCase = read_case(model.file.stored_case, model.path, Path(model.path).parent)
    if stored.lumped:
        return None
    written = GearboxModel(model_of(tree_of(stored).model, "the case in the file"))
    before, now = (dict(flat_keys(file_tables(m, m.load(), {})[0])) for m in (written, model))
    changes = changed_values(model, before, now)
    return stored.replace(changes) if changes else stored


def file_tables(model: GearboxModel, load: Load, changes: Tree) -> tuple[Tree, dict[str, str]]:
    """Tables of a machine with the values of the file in SI, and what of them is assumed."""
    if problems := _unsupported(model):
        raise InputError(problems)
    model.stage(model.stages[0].id if model.stages else None)  # refuses a model without stages
    planetary, stages = planet_stages(model)
    lone = len(planetary) == 1 and not stages
    senses = _shaft_senses(model, load, planetary, stages)
    names = {number: part_name(model, number) for number in senses}
    alone = [] if lone else list(names)
    for stage in planetary:
        names |= stage.shaft_names(lone=lone)
    shared = material_values(model, *(s.sun.id for s in planetary if lone), *senses)
    axes, directions = axes_of(model, [n for n in alone if names[n] == part_name(model, n)])
    tables, assumed = _parts(model, axes, directions, stages, shared, changes)
    for stage in planetary:
        tables.setdefault("planets", {})[stage.name] = stage.table(lone=lone)
        tables["gears"] |= stage.gear_tables(axes)
    operation, note = _operation(model, load, senses, names)
    tables = {group: body for group, body in tables.items() if body}
    return tables | nested(shared) | operation, assumed | note


def _title(data: Tree) -> str:
    meshes, planets = data.get("meshes", {}), data.get("planets", {})
    if not meshes:
        counts = " and ".join(str(stage["count"]) for stage in planets.values())
        return f"Planetary stage with {counts} planets"
    count = len(meshes) + len(planets)
    return f"Gearbox of {count} stage{'s' * (count > 1)}"


def _of_case(key: str, gears: Tree) -> bool:
    """Whether a note is on a gear of the case, or on no gear."""
    group, _, inner = key.partition(".")
    return group != "gears" or inner.rpartition(".")[0] in gears


def _unsupported(model: GearboxModel) -> list[Problem]:
    why = "The axes of a machine are parallel"
    remedy = f"List the data of its gears: tribodyn import {model.path}"
    return [
        Problem(f"{stage} is not computed", model.path, why, remedy)
        for stage in model.file.of_kind("bevel_stage", "worm_stage")
    ]


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


def _shaft_senses(
    model: GearboxModel, load: Load, planetary: list[PlanetStage], stages: list[Stage]
) -> dict[int, int]:
    """Shafts from the input on, with 1 or -1 where they turn against it."""
    edges = [edge for stage in planetary for edge in stage.senses()]
    edges += [(*_shafts_of(model, stage), -1 if stage.ratio > 0.0 else 1) for stage in stages]
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
    model: GearboxModel,
    axes: dict[int, Axis],
    directions: Array | None,
    stages: list[Stage],
    shared: dict[str, float],
    changes: Tree,
) -> tuple[Tree, dict[str, str]]:
    """Tables of shafts, gears, meshes and bearings, and what is assumed."""
    assumed: dict[str, str] = {}
    tables: Tree = {"shafts": {}, "bearings": {}, "gears": {}, "meshes": {}}
    for number, axis in axes.items():
        material = {**shared, **material_values(model, number)}
        values = {k.partition(".")[2]: v for k, v in material.items() if shared.get(k) != v}
        tables["shafts"][axis.name] = axis.table | values
    for stage in stages:
        numbers = _shafts_of(model, stage)
        if not set(numbers) <= axes.keys():
            continue
        for gear, number in zip((stage.gear_1, stage.gear_2), numbers, strict=True):
            tables["gears"][part_name(model, gear.id)] = gear_table(model, gear, axes[number])
        name = part_name(model, stage.id)
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
    return tables, assumed


def _mesh(
    model: GearboxModel, stage: Stage, ends: tuple[Axis, Axis], directions: Any
) -> tuple[Tree, str]:
    """Table of a stage as a mesh, and the reason of its angle where that is assumed."""
    table = {
        "gears": [part_name(model, g.id) for g in (stage.gear_1, stage.gear_2)],
        **teeth_table(model, stage),
    }
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
    model: GearboxModel, load: Load, senses: dict[int, int], names: dict[int, str]
) -> tuple[Tree, dict[str, str]]:
    """Operating point, and load cases where there are several; and what is assumed of the ends."""
    first, *others = names
    loaded = [
        names[number]
        for number in others
        if names[number] != names[first] and any(
            relation.of("assembly") == number
            for c in model.file.of_kind("external_load")
            if (flag := c.values.get("transmits_torque")) is None or flag.content is True
            for relation in model.file.related("assembly", part=c.id)
        )
    ]  # fmt: skip
    rings = {model.shaft_of(c.id) for c in model.file.of_kind("ring_gear")}
    usual = [name for n, name in names.items() if n not in rings and name != names[first]]
    run = {"input": names[first], "output": [names[first], *usual, *loaded][-1]}
    tables: Tree = {"operation": run | _point(model, load, senses)}
    if len(model.loads) > 1:
        tables["load_cases"] = [
            {"name": _load_name(model, each)}
            | ({} if each.share is None else {"share": each.share})
            | _point(model, each, senses)
            for each in model.loads
        ]
    return tables, {} if loaded else {"operation.output": NOT_THERE + "the last shaft"}


def _load_name(model: GearboxModel, load: Load) -> str:
    """Name of a load case: its number, in a file of ours that of the case."""
    parts = model.file.load_cases[load.id].values()
    names = (part.name for part in parts if part.kind == "gear_unit" and model.file.stored_case)
    return next(names, "") or f"case_{load.id}"


def _point(model: GearboxModel, load: Load, shafts: dict[int, int]) -> dict[str, float]:
    """Speed and torque of the input under a load case, as far as the file has them."""
    first, point = next(iter(shafts)), {}
    if first in load.speeds:
        point["speed"] = abs(load.speeds[first]) * _sense(model, load, shafts)
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
