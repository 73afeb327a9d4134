"""Losses of the bearings, the seals and the oil bath of a machine, by its ``[losses]``."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.errors import InputError, Problem, no_such
from tribodyn.machine.graph.directions import center_distance
from tribodyn.machine.plane_law import mean_in_space
from tribodyn.nomenclature import GEARS
from tribodyn.study.case import to_models
from tribodyn.study.case.values import KeyedProblems
from tribodyn.types import Array, ByName

if TYPE_CHECKING:
    from tribodyn.losses import ShaftParts
    from tribodyn.losses.gearbox import TurningBody
    from tribodyn.machine import Machine, StaticBalance
    from tribodyn.study.machine.case import MachineCase
    from tribodyn.study.machine.read_parts import LoadCase

#: Parts of a loss under the names of the figures of a summary.
FIGURES = {
    "bearing_power_loss": ("bearing_rolling", "bearing_sliding", "bearing_seal", "bearing_drag"),
    "seal_power_loss": ("seal",),
    "churning_power_loss": ("churning",),
    "windage_power_loss": ("windage",),
}
Loads = list[tuple[float, float]]


def loss_problems(case: MachineCase) -> KeyedProblems:
    """Problems of ``[losses]``: names without a part, keys without effect, depths out of range."""
    if case.losses is None:
        return []
    problems = [*_unknown(case), *_unused(case)]
    if not problems:
        try:
            part_losses(case, case.operating_point)
        except InputError as error:
            for problem in error.problems:
                where: Any = problem.where
                key = f"shafts.{where.gear}.{where.name}" if where.gear else where.name
                problems.append((f"losses.{key}", problem))
    return problems


def _unknown(case: MachineCase) -> Iterator[tuple[str, Problem]]:
    for group, parts in (("shafts", case.shafts), ("bearings", case.bearings)):
        for name in vars(getattr(case.losses, group)):
            if name not in parts:
                problem = no_such(group[:-1], name, parts, "", "Name one of these, or add it")
                yield f"losses.{group}.{name}", problem


def _unused(case: MachineCase) -> Iterator[tuple[str, Problem]]:
    """Keys that have no effect on a shaft."""
    stated: ByName = case.data["losses"]
    for name, body in stated.get("shafts", {}).items():
        bearings = [n for n, each in case.bearings.items() if each.shaft == name]
        reasons = {}
        if bearings:
            reasons["bearings"] = f"Its bearings are {', '.join(bearings)}"
        if any(stage.table.carrier == name for stage in case.stages.values()):
            reasons["immersion"] = "Churning is that of gears whose axes stand still"
        elif not _gears_on(case, name):
            reasons["immersion"] = "It has no gear"
        for key, why in reasons.items():
            if key in body:
                what = f"{key} has no effect on shaft {name}"
                yield f"losses.shafts.{name}.{key}", Problem(what, "", why, "Remove it")


def _gears_on(case: MachineCase, shaft: str) -> list[str]:
    """Gears that turn in the oil with a shaft."""
    return [name for name, gear in case.gears.items() if gear.shaft == shaft]


def part_losses(
    case: MachineCase, load: LoadCase, static: StaticBalance | None = None
) -> dict[str, float]:
    """Power that bearings, seals, oil and air take [W]; without a balance bearings idle."""
    from tribodyn.losses import Gearbox
    from tribodyn.losses.gearbox import ShaftParts, oil_losses, require_oil, shaft_losses

    if case.losses is None:
        return {}
    machine = case._machine_under(load) if static is None else static.machine
    oil = None if case.oil is None else to_models.lubricant(case.oil, load.temperature)
    shafts = {n: to_models.shaft_parts(each) for n, each in vars(case.losses.shafts).items()}
    deepest = ShaftParts(immersion=max([each.immersion for each in shafts.values()], default=0.0))
    box = Gearbox(wheel=deepest, oil_volume=case.losses.oil_volume, windage=case.losses.windage)
    lost = dict.fromkeys((part for parts in FIGURES.values() for part in parts), 0.0)
    for name in case.shafts:
        parts, speed = shafts.get(name, ShaftParts()), abs(machine.kinematics.shafts[name].speed)
        require_oil(parts, oil, name)
        bodies = [_body(case, machine, gear) for gear in _gears_on(case, name)]
        largest = max((body.pitch_radius for body in bodies), default=0.0)
        depths = [max(parts.immersion - largest + body.pitch_radius, 0.0) for body in bodies]
        loaded = _loaded(case, machine, static, name, parts)
        each = [shaft_losses(of, speed, loads, oil) for of, loads in loaded]
        each += [
            oil_losses(body._replace(name=name), box, depth, speed, oil)
            for body, depth in zip(bodies, depths, strict=True)
        ]
        for losses in each:
            for part, power in losses.items():
                lost[part] += power
    return {figure: sum(lost[part] for part in parts) for figure, parts in FIGURES.items()}


def _loaded(
    case: MachineCase,
    machine: Machine,
    static: StaticBalance | None,
    name: str,
    parts: ShaftParts,
) -> Iterator[tuple[ShaftParts, Loads]]:
    """What loses power on a shaft: all of it but its bearings, and these with their loads."""
    from tribodyn.losses.gearbox import shared_loads

    bearings = [n for n, each in machine.bearings.items() if each.shaft == name]
    if not bearings:
        force = np.zeros(3) if static is None else _mesh_force(machine, name)
        yield parts, shared_loads(parts.bearings, float(np.hypot(*force[1:])), abs(force[0]))
        return
    yield replace(parts, bearing=None), []
    for bearing in bearings:
        stated = vars(case.losses.bearings).get(bearing)
        of = replace(parts, seal_diameter=0.0) if stated is None else to_models.shaft_parts(stated)
        load = np.zeros(3) if static is None else static.bearings[bearing].load
        yield of, [(float(np.hypot(*load[1:3])), abs(float(load[0])))]


def _mesh_force(machine: Machine, shaft: str) -> Array:
    """Sum of the forces of the meshes on the gears of a shaft (3,) [N]."""
    total = np.zeros(3)
    for name, mesh in machine.meshes.items():
        along = mean_in_space(machine, name).reshape(2, 6)[:, :3]
        for gear, direction in zip(mesh.gears, along, strict=True):
            if machine.gears[gear].shaft == shaft:
                total += machine.kinematics.meshes[name].force * direction
    return total


def _body(case: MachineCase, machine: Machine, gear: str) -> TurningBody:
    """A gear as the oil sees it, by its first mesh."""
    from tribodyn.losses.gearbox import TurningBody, outer_pitch_radius

    name, mesh = next((n, each) for n, each in machine.meshes.items() if gear in each.gears)
    width, place = machine.gears[gear].face_width, mesh.gears.index(gear)
    if (blank := case._blanks.get(name)) is not None:
        radius, module = outer_pitch_radius(blank, GEARS[place]), blank.mean_normal_module
    else:
        first, second = (machine.gears[each] for each in mesh.gears)
        share = machine.gears[gear].teeth / (first.teeth + second.teeth)
        radius, module = abs(center_distance(mesh, (first, second)) * share), mesh.normal_module
    return TurningBody(gear, 1.0, 0.0, 0.0, radius, width, module)
