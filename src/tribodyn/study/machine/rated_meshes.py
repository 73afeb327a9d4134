"""Meshes, bearings and shafts of a machine under its loads, as they are rated."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.errors import collected, warn
from tribodyn.machine.shaft_matrices import ShaftMatrices
from tribodyn.study.case.to_models import lubricant
from tribodyn.study.machine.pair_cases import read_teeth, teeth_under
from tribodyn.study.rated_parts import (
    BearingLoad,
    BearingRating,
    NotchRating,
    PartBearing,
    PartRatings,
    SectionLoad,
    internal_loads,
    rate_bearing,
    rate_notch,
)
from tribodyn.study.rating import RatedMesh, case_rating, computed_factors
from tribodyn.study.rating_summary import rating_figures
from tribodyn.types import Array

if TYPE_CHECKING:
    from tribodyn.study.case.pair import PairCase
    from tribodyn.study.machine.case import MachineCase
    from tribodyn.study.machine.result import LoadResult, MachineResult


Loads = Mapping[str, "LoadResult"]


def rated_loads(result: MachineResult) -> Loads:
    """Loads that the machine has to last: its load cases, else the operating point."""
    loads = dict(result.loads) if result.case.is_rated else {}
    if len(loads) > 1:
        del loads["operation"]
    return loads


def rated_figures(case: MachineCase, load: LoadResult) -> dict[str, float]:
    """Safeties and lives of a machine under one load, by the keys of its summary."""
    if not case.is_rated:
        return {}
    loads = {"operation": load}
    with collected():
        rating = case_rating(rated_meshes(case, loads), rated_parts(case, loads))
        return {} if rating is None else rating_figures(rating).get("operation", {})


def rated_meshes(case: MachineCase, loads: Loads) -> Iterator[RatedMesh]:
    """Each group of equal meshes with computed teeth under each load, if there is ``[rating]``."""
    for name, load in loads.items():
        rated_groups = set()
        for mesh in case.meshes_with_teeth:
            under = teeth_under(case, mesh, load.load)
            pair, _ = read_teeth(case, mesh, under)
            if pair.rating is None or (group := case.tooth_group(mesh)) in rated_groups:
                continue
            rated_groups.add(group)
            yield _rated_mesh(case, load, (name, mesh), pair, under.names)


def _rated_mesh(
    case: MachineCase,
    load: LoadResult,
    place: tuple[str, str],
    pair: PairCase,
    names: tuple[str, str],
) -> RatedMesh:
    """One mesh with speed, torque and load factors of a load."""
    name, mesh = place
    flow = load.machine.kinematics.meshes
    gears = load.machine.meshes[mesh].gears
    torques = dict(zip(gears, flow[mesh].torque, strict=True))
    pinion, wheel = case._pinion_and_wheel(mesh)
    forwards = case.machine().kinematics.meshes[mesh].sense
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
        operation=(speed, math.copysign(torques[pinion], flow[mesh].sense * forwards)),
        computed=factors,
        meshes_per_turn=counts,
        reversed=reversed_,
        inertia_shares=(
            _inertia_share(case, load, (mesh, pinion), len(equal)),
            _inertia_share(case, load, (mesh, wheel), len(equal)),
        ),
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


def _inertia_share(
    case: MachineCase, load: LoadResult, place: tuple[str, str], planets: int
) -> float:
    """Part of the inertia of a gear that moves with one mesh: all but of a sun or a ring."""
    mesh, gear = place
    if mesh not in case._stage_of:
        return 1.0
    table, machine = case._stage_of[mesh][0].table, load.machine
    if gear not in (table.sun, table.ring):
        return 1.0
    turns = machine.kinematics.shafts[machine.gears[gear].shaft].speed
    return 1.0 / planets if abs(turns) > 1e-12 * abs(load.load.speed) else math.inf


def _flanks(load: LoadResult, gear: str, mesh: str) -> tuple[int, bool]:
    """Meshes that load the same flanks of a gear as this one, and whether others load the back."""
    meshes, flow = load.machine.meshes, load.machine.kinematics.meshes
    drives = {
        name: flow[name].driver == gear for name, part in meshes.items() if gear in part.gears
    }
    same = sum(value == drives[mesh] for value in drives.values())
    return same, same < len(drives)


def rated_parts(case: MachineCase, loads: Loads) -> PartRatings:
    """Life of all bearings and fatigue of the notches of a machine, if there is ``[rating]``."""
    rated = case.rated_parts
    if not loads or rated.rating is None:
        return PartRatings()
    with collected() as caught:
        bearings = [_bearing(case, loads, name) for name in _bearings(case)]
        notches = [
            _notch(load, (shaft, place, name), rated)
            for shaft, place in rated.notches
            for name, load in loads.items()
        ]
    for warning in caught:
        warn(warning.code, warning.message)
    required = rated.rating.required_life, rated.rating.minimum_safety
    return PartRatings(tuple(bearings), tuple(notches), *required, tuple(caught))


def _bearings(case: MachineCase) -> Iterator[str]:
    """Bearings of the file, and the pins of its planets; stiffnesses of supports are none."""
    yield from case.data.get("bearings", {})
    stages = tuple(f"{name}_" for name in case.stages)
    for name, bearing in case.machine().bearings.items():
        if bearing.carrier is not None and name.startswith(stages):
            yield name


def _bearing(case: MachineCase, loads: Loads, name: str) -> BearingRating:
    """Life of a bearing, or of a pin, under all loads."""
    part, rated = case.machine().bearings[name], case.rated_parts
    stage = next((s for s in case.stages if part.carrier and name.startswith(f"{s}_")), "")
    catalogue = rated.catalogues.get(f"planets.{stage}" if stage else name)
    prefix = "pin_" if stage else ""
    if catalogue is None:
        return BearingRating(name, (), reason=f"no {prefix}dynamic_load_rating")
    kind = str(case.data["bearings"][name].get("type", "")) if not stage else ""
    bearing = PartBearing(catalogue, rated.rating, part.rolling, kind, prefix)
    exponent, rows = bearing.rated.exponent, []
    for label, load in loads.items():
        flow, balance = load.machine.kinematics.shafts, load.static.bearings[name]
        speed = flow[part.shaft].speed - (flow[part.carrier].speed if part.carrier else 0.0)
        force = load.motion.radial_force[:, load.motion.bearing.index(name)]
        mean = float(load.motion.mean(force))
        swing = float(load.motion.mean(force**exponent)) ** (1.0 / exponent) / mean if mean else 1.0
        x, y, z = balance.load[:3].tolist()
        share = load.load.share if label != "operation" else None
        values = math.hypot(y, z), abs(x), abs(speed), _viscosity(case, load), max(swing, 1.0)
        rows.append(BearingLoad(label, share, *values, balance.state))
    with collected() as caught:
        rating = rate_bearing(name, bearing, rows, rated.rating.application_factor)
    for warning in caught:
        warn(warning.code, f'bearing "{name}": {warning.message}')
    return rating


def _viscosity(case: MachineCase, load: LoadResult) -> float | None:
    """Kinematic viscosity of the oil of the machine under a load [m^2/s]."""
    for mesh in case.meshes_with_teeth:
        oil = read_teeth(case, mesh, teeth_under(case, mesh, load.load))[0].lubricant
        if oil is not None:
            return float(lubricant(oil).kinematic_viscosity)
    oil = case.oil
    return None if oil is None else lubricant(oil, load.load.temperature).kinematic_viscosity


def _notch(load: LoadResult, names: tuple[str, str, str], rated: Any) -> NotchRating:
    """Safety of a notched section, on the side of it that carries more."""
    shaft, place, _ = names
    position, notch, material = rated.notches[shaft, place]
    sections = [
        SectionLoad(*loads, rated.rating.application_factor, *_motion_of(load, shaft))
        for loads in section_loads(load, shaft, position)
    ]
    ratings = [rate_notch(names, notch, material, section) for section in sections]
    return min(ratings, key=lambda rating: rating.safety)


def section_loads(
    load: LoadResult, shaft: str, position: float
) -> list[tuple[float, float, float]]:
    """Axial force, bending moment and torque just before and behind a position of a shaft."""
    machine, bent = load.machine, load.static.shafts[shaft]
    places = [gear.node_position for gear in machine.gears.values() if gear.shaft == shaft]
    for bearing in machine.bearings.values():
        places += [bearing.position] * (bearing.shaft == shaft)
        places += [bearing.carrier_position] * (bearing.carrier == shaft)
    beam = ShaftMatrices(machine.shafts[shaft], tuple(places), machine.shafts[shaft].length)
    rows = np.abs(bent.position - beam.nodes[:, None]).argmin(axis=1)
    forces = (beam.stiffness @ bent.displacement[rows].ravel()).reshape(-1, 6)
    values = []
    for side in (-1e-7, 1e-7):
        total = internal_loads(beam.nodes.tolist(), forces, position + side)
        values.append((total[0], math.hypot(total[4], total[5]), total[3]))
    return values


def _motion_of(load: LoadResult, shaft: str) -> tuple[float, bool]:
    """Greatest dynamic factor of the meshes of a shaft, and whether the shaft turns."""
    machine, factors = load.machine, [1.0]
    for name, mesh in machine.meshes.items():
        if shaft in {machine.gears[gear].shaft for gear in mesh.gears}:
            factors.append(load.figures.get(f"meshes.{name}.dynamic_factor_peak") or 1.0)
    return max(factors), bool(machine.kinematics.shafts[shaft].speed)
