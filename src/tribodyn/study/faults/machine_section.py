"""Faults of the named parts of a machine or a stage: what they can have, and in which meshes."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
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

if TYPE_CHECKING:
    from tribodyn.faults import BearingForce, BearingImpacts, Fault, ShaftExcitation
    from tribodyn.machine import Machine
    from tribodyn.study.machine.case import MachineCase
    from tribodyn.study.planetary.case import PlanetaryCase

_GEOMETRY = ("rolling_elements", "element_diameter", "pitch_diameter")


def machine_fault_problems(case: MachineCase) -> KeyedProblems:
    """Report faults that are incomplete, or whose gear or bearing does not exist."""
    parts = {"gear": [*case.gears], "bearing": [*case.bearings], "shaft": [*case.shafts]}
    return fault_problems(case.faults, "machine", parts)


def stage_fault_problems(case: PlanetaryCase) -> KeyedProblems:
    """Report faults that are incomplete, or whose gear, planet or member does not exist."""
    gears = [getattr(case.table, role) for role in ("sun", "planet", "ring")]
    parts = {"gear": gears, "shaft": tuple(case.members.values())}
    if problems := fault_problems(case.faults, "stage", parts):
        return problems
    for name, fault in case.faults.items():
        key = f"faults.{name}"
        if fault.shaft is not None:
            speed = float(part_of(fault.shaft) in case.ends)
            problems += list(_located(key, partial(check_shaft, fault, speed)))
        elif fault.planet and (part_of(fault.gear) != gears[1] or fault.planet > case.table.count):
            what = f"planet = {fault.planet} of the gear {fault.gear}"
            why = f"The stage has {case.table.count} planets; sun and ring are one each"
            problems.append((f"{key}.planet", Problem(what, "", why, "Correct the number")))
        if fault.lead_angle:
            what, why = f"lead_angle = {fault.lead_angle:g} rad", "All slices of a stage are equal"
            problems.append((f"{key}.lead_angle", Problem(what, "", why, "Remove it")))
    return problems


def impossible_faults(case: MachineCase) -> KeyedProblems:
    """Report faults that a gear or a bearing cannot have."""
    problems: KeyedProblems = []
    for name, fault in case.faults.items():
        checks: list[Callable[[], object]] = [
            partial(_check_gear_fault, case, fault, mesh)
            for mesh in case.meshes
            if fault.gear is not None and part_of(fault.gear) in case._names(mesh)
        ]
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
        what, why = f"{excitation.gear} stands", "The torque varies over its turns"
        raise InputError(what, Argument("shaft"), why, "Name a shaft that turns")


def shaft_excitation(fault: Any) -> ShaftExcitation:
    """The torque or the speed of a named shaft."""
    excitation: Any = read_fault(fault, gear=part_of(fault.shaft))
    return excitation  # type: ignore[no-any-return]


def _check_gear_fault(case: MachineCase, fault: PartFaultTable, mesh: str) -> None:
    if mesh in case.meshes_with_teeth:
        check_fault(case.pair(mesh, case.operating_point), fault, gear=_role(case, fault, mesh))
    elif fault.kind not in WAVES or fault.lead_angle:
        what = f"mesh {mesh} has a constant stiffness, and the fault is of the kind {fault.kind}"
        why = "Of a constant stiffness the teeth are not computed one by one"
        raise InputError(what, Argument("kind"), why, "Remove stiffness from the mesh")


def _role(case: MachineCase, fault: PartFaultTable, mesh: str) -> str:
    """The gear with a fault as the pair of a mesh names it."""
    return GEARS[case._pinion_and_wheel(mesh).index(part_of(fault.gear))]


def faults_of_mesh(case: MachineCase, machine: Machine, mesh: str) -> list[Fault]:
    """Faults of both gears of a mesh, with the teeth counted as they come into contact there."""
    faults: list[Any] = []
    for fault in case.faults.values():
        gear = part_of(fault.gear)
        if gear not in machine.meshes[mesh].gears:
            continue
        first = next(name for name, each in machine.meshes.items() if gear in each.gears)
        changes = _changes(machine, fault, gear, (first, mesh))
        if changes is not None:
            faults.append(read_fault(fault, gear=_role(case, fault, mesh), **changes))
    return faults


def _changes(
    machine: Machine, fault: PartFaultTable, gear: str, meshes: tuple[str, str]
) -> dict[str, Any] | None:
    """Changed keys of a fault in another mesh of its gear; None where it does not act there."""
    first, other = meshes
    if first == other:
        return {}
    flows = machine.kinematics.meshes
    same_flank = len({flows[name].driver == gear for name in meshes}) == 1
    if not same_flank and fault.kind not in ("eccentricity", "broken-tooth"):
        return None  # it is on the flank that the first mesh loads
    teeth, turn = abs(machine.gears[gear].teeth), 2.0 * math.pi
    speed = machine.kinematics.shafts[machine.gears[gear].shaft].speed
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
    values: dict[str, Any] = {
        key: getattr(fault, key) for key in (*_GEOMETRY, "contact_angle", "slip")
    }
    if rolling is not None:
        geometry = (rolling.elements, rolling.element_diameter, rolling.pitch)
        known = {**dict(zip(_GEOMETRY, geometry, strict=True))}
        known["contact_angle"] = float(getattr(rolling, "contact_angle", 0.0))
        values = {k: known.get(k) if v is None else v for k, v in values.items()}
    for key in _GEOMETRY:
        if values[key] is None:
            why = f"Bearing {name} has no type, whose geometry states it"
            remedy = f"Give {key}, or the type and the diameters of the bearing"
            raise InputError(f"{key} is missing", Argument(key), why, remedy)
    values |= {"place": fault.place, "force": fault.impact_force, "duration": fault.impact_duration}
    return BearingForce(**{key: value for key, value in values.items() if value is not None})
