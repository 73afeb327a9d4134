"""Faults of the named parts of a machine: what they can have, and in which meshes."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Any

from tribodyn.errors import Argument, InputError, Problem
from tribodyn.nomenclature import GEARS
from tribodyn.study.case.values import KeyedProblems
from tribodyn.study.faults.kinds import WAVES
from tribodyn.study.faults.section import (
    PartFaultTable,
    check_fault,
    fault_problems,
    fault_tables,
    part_of,
    read_fault,
)
from tribodyn.study.machine.pair_cases import PairSource
from tribodyn.types import Tree

if TYPE_CHECKING:
    from tribodyn.faults import BearingForce, BearingImpacts, Fault, ShaftExcitation
    from tribodyn.machine import Machine
    from tribodyn.study.machine.case import MachineCase

_GEOMETRY = ("rolling_elements", "element_diameter", "pitch_diameter")


def machine_fault_problems(case: MachineCase) -> KeyedProblems:
    """Report faults that are incomplete, or whose gear or bearing does not exist."""
    gears = [*case.gears, *case.planet_names]
    parts = {"gear": gears, "bearing": [*case.bearings], "shaft": [*case.shafts]}
    return fault_problems(case.faults, "machine", parts)


def gear_of(case: MachineCase, fault: PartFaultTable) -> str:
    """Name of the gear of a fault in the machine; of planets that of its number, or the first."""
    name = part_of(fault.gear)
    for stage in case.stages.values():
        for place, gear in zip(("planet", "ring_planet"), stage.planet_names, strict=False):
            if name == gear:
                return f"{stage.name}_{place}{fault.planet or 1}"
    return name


def _check_planet(case: MachineCase, fault: PartFaultTable) -> None:
    """Raise InputError if a gear is no planet, or its stage has fewer planets."""
    name = part_of(fault.gear)
    counts = [s.table.count for s in case.stages.values() if name in s.planet_names]
    if fault.planet is not None and fault.planet > max(counts, default=0):
        what = f"planet = {fault.planet} of the gear {name}"
        why = "Other gears are one each"
        if counts:
            why = f"Its stage has {counts[0]} planets"
        raise InputError(what, Argument("planet"), why, "Correct the number, or remove it")


def impossible_faults(case: MachineCase, named: KeyedProblems) -> KeyedProblems:
    """Report faults that a gear or a bearing cannot have, after those of keys and names."""
    problems, wrong = [*named], {key.split(".")[1] for key, _ in named}
    for name, fault in case.faults.items():
        if name in wrong:
            continue
        checks: list[Callable[[], object]] = [
            partial(_check_gear_fault, case, fault, mesh)
            for mesh in case.meshes
            if fault.gear is not None and gear_of(case, fault) in case._gears_of(mesh)
        ]
        if fault.planet is not None:
            checks.insert(0, partial(_check_planet, case, fault))
        if fault.kind == "looseness":
            checks = [partial(_check_seat, case, fault)]
        elif fault.bearing:
            checks = [partial(bearing_impacts, case, fault)]
        elif fault.shaft:
            speed = case.machine().kinematics.shafts[part_of(fault.shaft)].speed
            checks = [partial(check_shaft, fault, speed)]
        located = (list(_located(f"faults.{name}", check)) for check in checks)
        problems += next((each for each in located if each), [])
    return problems


def _located(key: str, check: Callable[[], object]) -> Iterator[tuple[str, Problem]]:
    """Problems of a check at the keys of a table."""
    try:
        check()
    except InputError as error:
        for problem in error.problems:
            where = problem.where
            yield (f"{key}.{where.name}" if isinstance(where, Argument) else key), problem


def _check_seat(case: MachineCase, fault: PartFaultTable) -> None:
    """Raise InputError if a bearing has no seat that could be loose."""
    bearing = case.bearings[part_of(fault.bearing)]
    if bearing.carrier is not None:
        what, why = f"{fault.bearing} is on the pin of a planet", "It turns with the carrier"
        raise InputError(what, Argument("bearing"), why, "Name a bearing of the housing")


def check_shaft(fault: PartFaultTable, speed: float) -> None:
    """Raise InputError if a shaft of this speed cannot be driven so."""
    excitation = shaft_excitation(fault)
    if speed == 0.0:
        what, why = f"{excitation.gear} does not turn", "The torque varies over its turns"
        raise InputError(what, Argument("shaft"), why, "Name a shaft that turns")


def shaft_excitation(fault: Any) -> ShaftExcitation:
    """The torque or the speed of a named shaft."""
    excitation: Any = read_fault(fault, gear=part_of(fault.shaft))
    return excitation  # type: ignore[no-any-return]


def _check_gear_fault(case: MachineCase, fault: PartFaultTable, mesh: str) -> None:
    if mesh in case.meshes_with_teeth:
        pair = case.pair(mesh, case.operating_point)
        try:
            check_fault(pair, fault, gear=_role(case, fault, mesh))
        except InputError as error:
            assert isinstance(pair.source, PairSource)
            name = pair.source.named
            texts = [{k: name(getattr(p, k)) for k in ("what", "why")} for p in error.problems]
            pairs = zip(error.problems, texts, strict=True)
            raise InputError([replace(p, **text) for p, text in pairs]) from None
    elif fault.kind not in WAVES or fault.lead_angle:
        what = f"mesh {mesh} has a constant stiffness, and the fault is of the kind {fault.kind}"
        why = "Of a constant stiffness the teeth are not computed one by one"
        raise InputError(what, Argument("kind"), why, "Remove stiffness from the mesh")


def _role(case: MachineCase, fault: PartFaultTable, mesh: str) -> str:
    """The gear with a fault as the pair of a mesh names it."""
    return GEARS[case._pinion_and_wheel(mesh).index(gear_of(case, fault))]


def faults_of_mesh(case: MachineCase, machine: Machine, mesh: str) -> list[Fault]:
    """Faults of both gears of a mesh, with the teeth counted as they come into contact there."""
    faults: list[Any] = []
    for fault in case.faults.values():
        gear = gear_of(case, fault)
        if gear not in machine.meshes[mesh].gears:
            continue
        first = next(name for name, each in machine.meshes.items() if gear in each.gears)
        changes = _changes(machine, fault, gear, (first, mesh))
        if changes is not None:
            faults.append(read_fault(fault, gear=_role(case, fault, mesh), **changes))
    return faults


def _changes(
    machine: Machine, fault: PartFaultTable, gear: str, meshes: tuple[str, str]
) -> Tree | None:
    """Changed keys of a fault in another mesh of its gear; None where it does not act there."""
    first, other = meshes
    if first == other:
        return {}
    flows = machine.kinematics.meshes
    same_flank = len({flows[name].driver == gear for name in meshes}) == 1
    if not same_flank and fault.kind not in ("eccentricity", "broken-tooth"):
        return None  # it is on the flank that the first mesh loads
    teeth, turn = abs(machine.gears[gear].teeth), 2.0 * math.pi
    speed = flows[other].speeds[machine.meshes[other].gears.index(gear)]
    angles = [_force_angle(machine, name, gear) for name in meshes]
    between = math.copysign(1.0, speed) * (angles[1] - angles[0]) % turn
    lag = machine.meshes[other].offset - machine.meshes[first].offset
    later = between / turn + lag / teeth  # turns of the gear, as the other mesh counts them
    if fault.kind in ("eccentricity", "waviness", "misalignment"):
        order = 1 if fault.kind == "eccentricity" else fault.order or 0
        return {"phase": math.remainder((fault.phase or 0.0) - order * turn * later, turn)}
    if fault.kind in ("pitch-deviations", "flank-deviations", "flank-topographies"):
        return {"first_tooth": round(-later * teeth) % teeth + 1}
    return {"tooth": ((fault.tooth or 1) - 1 + round(later * teeth)) % teeth + 1}


def _force_angle(machine: Machine, mesh: str, gear: str) -> float:
    """Angle in the (y, z) plane of the force of a gear on its mate [rad]."""
    normal = machine.directions[mesh].normal
    sign = 1.0 if machine.meshes[mesh].gears[0] == gear else -1.0
    return math.atan2(sign * normal[2], sign * normal[1])


def defects_of(case: Any) -> list[tuple[str, BearingImpacts]]:
    """Damaged bearings, of a pair by the gear of their shaft, and their defects."""
    defects: list[tuple[str, Any]] = []
    for fault in fault_tables(case.faults).values():
        if fault.kind == "bearing-defect" and fault.gear is not None:
            defects.append((fault.gear, read_fault(fault)))
        elif isinstance(fault, PartFaultTable) and fault.kind == "bearing-defect":
            defects.append((part_of(fault.bearing), bearing_impacts(case, fault)))
    return defects


def bearing_impacts(case: MachineCase, fault: PartFaultTable) -> BearingForce:
    """Impacts of a defect, with the geometry of the bearing where the table does not give it."""
    from tribodyn.faults import BearingForce

    name = part_of(fault.bearing)
    rolling = case.bearings[name].rolling
    values: Tree = {key: getattr(fault, key) for key in (*_GEOMETRY, "contact_angle", "slip")}
    if rolling is not None:
        geometry = (rolling.elements, rolling.element_diameter, rolling.pitch)
        bearing_data = {**dict(zip(_GEOMETRY, geometry, strict=True))}
        bearing_data["contact_angle"] = float(getattr(rolling, "contact_angle", 0.0))
        values = {k: bearing_data.get(k) if v is None else v for k, v in values.items()}
    for key in _GEOMETRY:
        if values[key] is None:
            why = f"Bearing {name} has no type, whose geometry states it"
            remedy = f"Give {key}, or the type and the diameters of the bearing"
            raise InputError(f"{key} is missing", Argument(key), why, remedy)
    values |= {"place": fault.place, "force": fault.impact_force, "duration": fault.impact_duration}
    return BearingForce(**{key: value for key, value in values.items() if value is not None})
