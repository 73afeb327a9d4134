"""Convert an external stage of a REXS model, spur or helical, to a case."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

from tribodyn import units
from tribodyn.errors import InputError
from tribodyn.exchange.case_tree import tree_of
from tribodyn.exchange.gearbox import GearboxModel, Load, Stage, StageGear, add_remark
from tribodyn.exchange.machine_parts import part_name
from tribodyn.exchange.rexs_file import WHOLE_CASE, model_of
from tribodyn.lubricant import Lubricant
from tribodyn.study.case.pair import PairCase
from tribodyn.study.case.read import parse_toml
from tribodyn.study.machine.read import kind_of_tables, read_case
from tribodyn.types import Tree

#: Values closer than this are the same: files hold decimal fractions of millimetres.
_SAME = 1e-9
#: Helix angle of rounding [rad].
SPUR = 1e-6
MODELS = {
    "film.model": "moes",
    "stiffness.model": "fe2d",
    "friction.law": "xu-2007",
    "dynamics.model": "spur-6dof",
    "dynamics.mesh_law": "force-law",
}
_OIL_TEMPERATURE = 333.15
ASSUMED = {
    "dynamics.bearing_stiffness": (500e6, "a usual stiffness of shaft and bearings together"),
    "dynamics.backlash": (0.1e-3, "a usual backlash"),
    "gears.driver": ("pinion", "the file does not specify where a torque comes from"),
    "lubricant.name": ("ISO VG 220", "a usual gear oil"),
    "lubricant.temperature": (_OIL_TEMPERATURE, "a usual temperature of gear oil"),
}
#: Density of mineral oil at 15 degC [kg/m^3].
_DENSITY = 880.0
NOT_THERE = "not in the REXS file; "


def case_from_rexs(
    model: GearboxModel,
    stage: int | None = None,
    load_case: int | None = None,
    *,
    changes: Tree | None = None,
) -> PairCase:
    """Case of an external stage of a gearbox model under one load.

    Parameters
    ----------
    model : GearboxModel
        Result of :func:`read_rexs`.
    stage, load_case : int, optional
        Numbers; not needed for a single stage; by default the first load case is used.
    changes : dict, optional
        Values by dotted key that replace those of the file, as in :meth:`Case.replace`.

    Returns
    -------
    Case
        Values that the file does not contain are marked as assumed. From a file written by
        tribodyn the complete case is restored, with the changes by other programs, which
        ``model.remarks`` lists.

    Raises
    ------
    InputError
        If the stage has a ring gear or is part of a planetary stage, or speed and
        torque are not known.
    """
    return _case(model, model.stage(stage), model.load(load_case), dict(changes or {}))


def _case(model: GearboxModel, stage: Stage, load: Load, changes: Tree) -> PairCase:
    _require_external(model, stage)
    if "lubricant.temperature" in changes:  # the viscosity of the file depends on it
        load = replace(load, oil_temperature=_kelvin(changes["lubricant.temperature"]))
    file_values, notes = pair_values(model, stage, load)
    if "lubricant.name" in changes:  # another oil than that of the file
        file_values = {key: v for key, v in file_values.items() if not key.startswith("lubricant.")}
        notes = {key: note for key, note in notes.items() if not key.startswith("lubricant.")}
    text = model.file.stored_case
    if text and kind_of_tables(parse_toml(text, model.path)).lumped:
        stored_case = read_case(text, f"{model.path}: {WHOLE_CASE}")
        return _updated(model, stored_case, file_values).replace(changes)
    data: Tree = {**file_values, **MODELS, **changes}
    for key in ("operation.speed", "operation.torque"):
        if key not in data:
            what = f"the speed and torque of stage {stage.id} are not known"
            remedy = 'Give both: --set "operation.speed=1500 rpm" --set "operation.torque=100 N*m"'
            raise InputError(what, model.path, "No load case specifies them", remedy)
    oil = any(key.startswith("lubricant.") for key in data)
    rough = any("roughness" in key for key in data)
    for key, (value, reason) in ASSUMED.items():
        if key not in data and not (oil and key.startswith("lubricant.")):
            data[key] = value
            notes[key] = NOT_THERE + reason
    if not rough:
        for gear in ("pinion", "wheel"):
            data[f"gears.{gear}.roughness_ra"] = 0.4e-6
            notes[f"gears.{gear}.roughness_ra"] = NOT_THERE + "ground flanks"
    title = f"Stage {stage.id}: {stage.gear_1.name or 'gear 1'}, {stage.gear_2.name or 'gear 2'}"
    origin = f"REXS {model.version} file of {model.application or 'an unnamed program'}"
    assumed = {key: note for key, note in notes.items() if key not in changes}
    return PairCase(title=title, origin=origin, **nested(data), assumed=assumed)


def _kelvin(value: Any) -> float:
    """Temperature in kelvin from the input of the user."""
    if not isinstance(value, str):
        return float(value)
    try:
        return units.parse(value, "K")
    except units.UnitProblemError as error:
        raise InputError(f'lubricant.temperature = "{value}"', "", str(error)) from None


def _require_external(model: GearboxModel, stage: Stage) -> None:
    what = ""
    if stage.planetary:
        what = f"stage {stage.id} is part of a planetary stage"
    elif min(stage.gear_1.teeth, stage.gear_2.teeth) < 0:
        what = f"stage {stage.id} has a ring gear"
    if what:
        why = "Only external pairs on fixed axes are supported"
        remedy = f"Compute all stages together: tribodyn run {model.path}"
        raise InputError(what, model.path, why, remedy)


def in_order(stage: Stage) -> tuple[StageGear, StageGear]:
    """Pinion and wheel: the pinion has fewer teeth."""
    first, second = stage.gear_1, stage.gear_2
    return (first, second) if first.teeth <= second.teeth else (second, first)


def pair_values(model: GearboxModel, stage: Stage, load: Load) -> tuple[Tree, dict[str, str]]:
    """Values of the case from the file, in SI, and notes on those that are partly assumed."""
    pinion, wheel = in_order(stage)
    data: Tree = {
        "gears.normal_module": pinion.normal_module,
        "gears.normal_pressure_angle": pinion.normal_pressure_angle,
        "gears.center_distance": stage.center_distance,
        **rack_values(model, pinion, wheel),
        **material_values(model, pinion.id, model.shaft_of(pinion.id)),
    }
    if pinion.helix_angle:
        data["gears.helix_angle"] = abs(pinion.helix_angle)
        for name, gear in (("pinion", pinion), ("wheel", wheel)):
            data[f"gears.{name}.hand"] = "right" if gear.helix_angle > 0.0 else "left"
    for name, gear in (("pinion", pinion), ("wheel", wheel)):
        data |= {
            f"gears.{name}.{key}": value
            for key in (
                "teeth",
                "profile_shift_coefficient",
                "face_width",
                "tip_diameter",
                "roughness_ra",
            )
            if (value := getattr(gear, key)) is not None
        }
        data |= {f"gears.{name}.modification.{k}": v for k, v in gear.modification.items()}
    shaft = model.shaft_of(pinion.id)
    if shaft in load.speeds and shaft in load.torques:
        data["operation.speed"] = load.speeds[shaft]
        data["operation.torque"] = load.torques[shaft]
        data["operation.speed_of"] = "pinion"
        data["gears.driver"] = _driver(model, stage, load)
    oil, notes = oil_values(model, load)
    return data | oil, notes


def rack_values(model: GearboxModel, pinion: StageGear, wheel: StageGear) -> dict[str, float]:
    """Basic rack of both gears if the same rack-shaped tool cuts them."""
    racks = [_racks(model, gear) for gear in (pinion, wheel)]
    if racks[0] != racks[1] or len(racks[0]) != 1 or None in racks[0][0]:
        return {}
    dedendum, round_ = racks[0][0]
    return {
        "gears.dedendum_coefficient": float(dedendum or 0.0),
        "gears.rack_tip_radius_coefficient": float(round_ or 0.0),
    }


def teeth_table(model: GearboxModel, stage: Stage) -> Tree:
    """Keys of a mesh or a planetary stage that describe the teeth, the hand that of gear 1."""
    gear = stage.gear_1
    table: Tree = {
        "normal_module": gear.normal_module,
        "normal_pressure_angle": gear.normal_pressure_angle,
        "center_distance": stage.center_distance,
    }
    if abs(gear.helix_angle) > SPUR:
        table["helix_angle"] = abs(gear.helix_angle)
        table["hand"] = "right" if gear.helix_angle > 0.0 else "left"
    rack = rack_values(model, gear, stage.gear_2)
    return table | {key.partition(".")[2]: value for key, value in rack.items()}


def _racks(model: GearboxModel, gear: StageGear) -> list[tuple[float | None, float | None]]:
    """Dedendum and tip radius of the rack-shaped tools of a gear or its flanks, each once."""
    file = model.file
    flanks = [
        n for r in file.related("flank", gear=gear.id) for role, n in r.refs if role != "gear"
    ]
    numbers = [r.of("referenced") for r in file.related("ordered_reference", origin=gear.id)]
    for flank in flanks:
        numbers += [r.of("tool") for r in file.related("manufacturing_step", workpiece=flank)]
    tools = [file.components[n] for n in dict.fromkeys(numbers) if n is not None]
    racks = [tool for tool in tools if tool.kind == "rack_shaped_tool"]
    for rack in racks:
        if rack.number("protuberance_amount", "m") or rack.number("protuberance_amount_factor", ""):
            add_remark(model, f"{rack}: its protuberance is ignored")
    names = ("addendum_coefficient_reference_profile", "tip_radius_factor")
    sizes = ((rack.number(names[0], ""), rack.number(names[1], "")) for rack in racks)
    return list(dict.fromkeys(sizes))


def material_values(model: GearboxModel, *origins: int | None) -> dict[str, float]:
    """Material of the first of some components that has one."""
    for origin in origins:
        for relation in model.file.related("reference", origin=origin) if origin else ():
            part = model.file.components[relation.of("referenced") or origin or 0]
            if part.kind == "material":
                properties = {
                    "material.youngs_modulus": part.number("elastic_modulus", "Pa"),
                    "material.poissons_ratio": part.number("poisson_ratio", ""),
                    "material.density": part.number("density", "kg/m^3"),
                }
                return {key: value for key, value in properties.items() if value is not None}
    return {}


def _driver(model: GearboxModel, stage: Stage, load: Load) -> str:
    """The gear nearer to the shaft with the specified torque; the other one if it brakes."""
    pinion, _ = in_order(stage)
    gears = {model.shaft_of(g.id): g.id for g in (stage.gear_1, stage.gear_2)}
    steps, visited = {load.source}, {load.source}
    while steps and not steps & gears.keys():
        steps = {
            other
            for s in model.stages
            for a, b in ((s.gear_1, s.gear_2), (s.gear_2, s.gear_1))
            if model.shaft_of(a.id) in steps and (other := model.shaft_of(b.id)) not in visited
        }
        visited |= steps
    nearest = next(gears[shaft] for shaft in steps & gears.keys())
    return "pinion" if (nearest == pinion.id) != load.driven else "wheel"


def oil_values(model: GearboxModel, load: Load) -> tuple[Tree, dict[str, str]]:
    """Oil at its temperature, from its viscosities at 40 and 100 degC."""
    for part in model.file.of_kind("lubricant"):
        cold = part.number("viscosity_at_40_degree_celsius", "m^2/s")
        warm = part.number("viscosity_at_100_degree_celsius", "m^2/s")
        if not (cold and warm):
            continue
        density = part.number("density_at_15_degree_celsius", "kg/m^3") or _DENSITY
        temperature = load.oil_temperature or _OIL_TEMPERATURE
        oil = Lubricant.from_temperature(
            temperature, ((313.15, cold), (373.15, warm)), density, base_oil="mineral"
        )
        keys = (
            "dynamic_viscosity",
            "density",
            "pressure_viscosity_coefficient",
            "temperature_viscosity_coefficient",
            "temperature",
        )
        data = {f"lubricant.{key}": getattr(oil, key) for key in keys}
        estimate = "as of a mineral oil, from the viscosity by AGMA 925"
        notes = {"lubricant.pressure_viscosity_coefficient": NOT_THERE + estimate}
        if not load.oil_temperature:
            reason = ASSUMED["lubricant.temperature"][1]
            notes["lubricant.temperature"] = NOT_THERE + str(reason)
        if "density_at_15_degree_celsius" not in part.values:
            notes["lubricant.density"] = NOT_THERE + "a usual one of mineral oil"
        return {key: value for key, value in data.items() if value is not None}, notes
    return {}, {}


def _updated(model: GearboxModel, case: PairCase, file_values: Tree) -> PairCase:
    """Case stored in the file, with the changes that another program has made since."""
    written = GearboxModel(model_of(tree_of(case).model, "the case in the file"))
    before, _ = pair_values(written, written.stage(), written.load())
    changes = changed_values(model, before, file_values)
    return case.replace(changes) if changes else case


def changed_values(model: GearboxModel, before: Tree, now: Tree) -> Tree:
    """Values that another program has changed since a case was written, with a remark on each."""
    changes = {
        key: value
        for key, value in now.items()
        if not same_value(before.get(key), value) and not key.startswith("lubricant.")
    }
    for key, value in changes.items():
        shown_value = f"{value:.9g} (SI)" if isinstance(value, float) else value
        model.remarks.append(f"{key} was changed to {shown_value} by another program")
    return changes


def same_value(first: object, second: object) -> bool:
    """Whether two values differ by no more than the digits of a file."""
    if isinstance(first, list | tuple) and isinstance(second, list | tuple):
        return len(first) == len(second) and all(map(same_value, first, second))
    if isinstance(first, float) and isinstance(second, float | int):
        return math.isclose(first, second, rel_tol=_SAME, abs_tol=1e-15)
    return bool(first == second)


def nested(data: Tree) -> Tree:
    """Tables of dotted keys."""
    tree: Tree = {}
    for key, value in data.items():
        place = tree
        *tables, name = key.split(".")
        for table in tables:
            place = place.setdefault(table, {})
        place[name] = value
    return tree


def shared_models(model: GearboxModel, load: Load, changes: Tree) -> tuple[Tree, dict[str, str]]:
    """Tables of models that all meshes share, and what is assumed for their teeth."""
    computed = [
        s for s in model.stages if f"meshes.{part_name(model, s.id)}.stiffness" not in changes
    ]
    values: Tree = {"dynamics.backlash": ASSUMED["dynamics.backlash"][0]}
    notes = {"dynamics.backlash": NOT_THERE + str(ASSUMED["dynamics.backlash"][1])}
    if computed:
        values |= {k: v for k, v in MODELS.items() if not k.startswith("dynamics.")}
        if any(abs(stage.gear_1.helix_angle) > SPUR for stage in computed):
            values["stiffness.model"] = "fe3d"  # thin slices are too stiff
        oil, oil_notes = oil_values(model, load)
        values |= oil
        notes |= oil_notes
        for key in () if oil else ("lubricant.name", "lubricant.temperature"):
            values[key], reason = ASSUMED[key]
            notes[key] = NOT_THERE + str(reason)
    for stage in computed:
        for gear in (stage.gear_1, stage.gear_2):
            if gear.roughness_ra is None:
                key = f"gears.{part_name(model, gear.id)}.roughness_ra"
                values[key], notes[key] = 0.4e-6, NOT_THERE + "ground flanks"
    return nested(values), notes
