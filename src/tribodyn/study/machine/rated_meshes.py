"""Meshes of a machine under its loads, as they are rated."""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import partial
from typing import TYPE_CHECKING

from tribodyn.study.machine.pair_cases import read_teeth, teeth_under
from tribodyn.study.rating import RatedMesh, computed_factors
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.study.case.case import Case
    from tribodyn.study.machine.case import MachineCase
    from tribodyn.study.machine.result import LoadResult, MachineResult


def rated_meshes(result: MachineResult) -> Iterator[RatedMesh]:
    """Each group of equal meshes with computed teeth under each load, if there is ``[rating]``."""
    case = result.case
    loads = dict(result.loads) if case.is_rated else {}
    if len(loads) > 1:  # load cases are what the machine has to last
        del loads["operation"]
    for name, load in loads.items():
        seen = set()
        for mesh in case.meshes_with_teeth:
            under = teeth_under(case, mesh, load.load)
            pair, _ = read_teeth(case, mesh, under)
            if pair.rating is None or (group := case.tooth_group(mesh)) in seen:
                continue
            seen.add(group)
            yield _rated_mesh(case, load, (name, mesh), pair, under.names)


def _rated_mesh(
    case: MachineCase, load: LoadResult, place: tuple[str, str], pair: Case, names: tuple[str, str]
) -> RatedMesh:
    """One mesh with speed, torque and load factors of a load."""
    name, mesh = place
    flow = load.machine.kinematics.meshes
    gears = load.machine.meshes[mesh].gears
    torques = dict(zip(gears, flow[mesh].torque, strict=True))
    pinion, wheel = case._pinion_and_wheel(mesh)
    speed = 2.0 * math.pi * flow[mesh].mesh_frequency / abs(load.machine.gears[pinion].teeth)
    prefix = f"meshes.{mesh}."
    figures = {
        key.removeprefix(prefix): value
        for key, value in load.figures.items()
        if key.startswith(prefix)
    }
    factors = computed_factors(figures)
    equal = [m for m in case.meshes_with_teeth if case.tooth_group(m) == case.tooth_group(mesh)]
    if mesh in case._stage_of:
        forces = [load.static.meshes[each].force for each in equal]
        factors["K_gamma"] = max(forces) * len(forces) / sum(forces)
    counts, reversed_ = zip(*(_flanks(load, gear, mesh) for gear in (pinion, wheel)), strict=True)
    return RatedMesh(
        load=name,
        mesh=mesh,
        case=pair,
        gears=names,
        operation=(speed, abs(torques[pinion])),
        computed=factors,
        meshes_per_turn=counts,
        reversed=reversed_,
        planets=len(equal) if mesh in case._stage_of else 1,
        share=load.load.share if name != "operation" else None,
        table=load.tables.get(mesh),
        motion=partial(_force_over_mean, load, mesh),
    )


def _force_over_mean(load: LoadResult, mesh: str) -> tuple[Array, Array]:
    motion = load.motion
    column = motion.mesh.index(mesh)
    force = motion.mesh_force[:, column]
    phase = load.machine.meshes[mesh].offset + motion.cycles[column] * motion.clock
    return phase, force / float(motion.mean(force))


def _flanks(load: LoadResult, gear: str, mesh: str) -> tuple[int, bool]:
    """Meshes that load the same flanks of a gear as this one, and whether others load the back."""
    meshes, flow = load.machine.meshes, load.machine.kinematics.meshes
    drives = {
        name: flow[name].driver == gear for name, part in meshes.items() if gear in part.gears
    }
    same = sum(value == drives[mesh] for value in drives.values())
    return same, same < len(drives)
