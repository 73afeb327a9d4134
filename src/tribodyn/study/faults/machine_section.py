"""The ``[faults.NAME]`` tables of a machine: on which gears and bearings they act."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from functools import partial
from typing import TYPE_CHECKING, Any, ClassVar

from tribodyn.errors import Argument, InputError, Problem, did_you_mean
from tribodyn.model import REQUIRED, choice, number, text
from tribodyn.study.faults.section import (
    KINDS,
    MEANINGS,
    FaultTable,
    fault_problems,
    located_in,
    read_fault,
)

if TYPE_CHECKING:
    from tribodyn.faults import BearingForce, Fault, ShaftExcitation
    from tribodyn.machine import Machine
    from tribodyn.study.machine.case import MachineCase

#: Kinds that act on a shaft, and their keys where the shaft has a name.
OF_SHAFTS = {
    kind: (("shaft", *KINDS[kind][0][1:]), KINDS[kind][1])
    for kind in ("torque-ripple", "speed-fluctuation", "random-load")
}
SHAFT = text(None, meaning="shaft that is driven or loaded so", example='"input"')
_GEOMETRY = ("rolling_elements", "element_diameter", "pitch_diameter")
_FORCE = number(
    None, 0.0, 1e7, "guards against a wrong unit", unit="N", example='"200 N"',
    meaning="greatest force of an impact in a bearing",
)  # fmt: skip
_DURATION = number(
    None, 1e-7, 0.1, "guards against a wrong unit", unit="s", display_unit="ms",
    example='"0.1 ms"', meaning="duration of an impact, 0.1 ms by default",
)  # fmt: skip


class MachineFaultTable(FaultTable):
    """A ``[faults.NAME]`` table of a machine: a fault of any of its gears and bearings."""

    kinds: ClassVar = {
        **KINDS,
        **OF_SHAFTS,
        "bearing-defect": (
            ("bearing", "place", "impact_force"),
            (*_GEOMETRY, "contact_angle", "impact_duration", "slip"),
        ),
        "looseness": (("bearing", "stiffness_share"), ("press_angle",)),
    }
    kind: str = choice(
        REQUIRED, {**MEANINGS, "looseness": "a seat that is softer while the shaft lifts from it"},
        meaning="what it is",
    )  # fmt: skip
    gear: str | None = text(None, meaning="gear that has it", example='"z1"')  # type: ignore[assignment]
    shaft: str | None = SHAFT
    bearing: str | None = text(None, meaning="bearing that has it", example='"A"')
    impact_force: float | None = _FORCE
    impact_duration: float | None = _DURATION
    stiffness_share: float | None = number(
        None, 0.0, 1.0, "a share", example="0.3",
        meaning="radial stiffness of a lifted seat over that of the pressed one",
    )  # fmt: skip
    press_angle: float | None = number(
        None, -2.0 * math.pi, 2.0 * math.pi, "one turn", unit="rad", display_unit="deg",
        example='"-90 deg"', meaning="direction from y towards z in which the shaft presses on a "
        "loose seat; that of its mean load by default",
    )  # fmt: skip


def name_of(reference: str, group: str) -> str:
    """Name of a part, which may be written as ``gears.z1``."""
    return reference.removeprefix(f"{group}.")


def machine_fault_problems(
    case: MachineCase, faults: Mapping[str, MachineFaultTable]
) -> list[tuple[str, Problem]]:
    """Report faults that are incomplete, or whose gear or bearing does not exist."""
    problems = fault_problems(faults)
    for name, fault in faults.items():
        for key, group, parts in (
            ("gear", "gears", case.gears),
            ("bearing", "bearings", case.bearings),
            ("shaft", "shafts", case.shafts),
        ):
            reference = getattr(fault, key)
            if reference is not None and name_of(reference, group) not in parts:
                why = f"Known: {', '.join(parts) or 'none'}"
                remedy = did_you_mean(name_of(reference, group), list(parts), "Correct the name")
                problem = Problem(f'there is no {key} "{reference}"', "", why, remedy)
                problems.append((f"faults.{name}.{key}", problem))
    return problems


def impossible_faults(case: MachineCase) -> list[tuple[str, Problem]]:
    """Report faults that a gear or a bearing cannot have."""
    problems = []
    for name, fault in case.faults.items():
        checks: list[Callable[[], object]] = [
            partial(_check_gear_fault, case, fault, mesh)
            for mesh in case.meshes
            if fault.gear is not None and name_of(fault.gear, "gears") in case._names(mesh)
        ]
        if fault.kind == "looseness":
            checks = [partial(_check_seat, case, fault)]
        elif fault.bearing:
            checks = [partial(bearing_impacts, case, fault)]
        elif fault.shaft:
            speed = case.machine().kinematics.shafts[name_of(fault.shaft, "shafts")].speed
            checks = [partial(check_shaft, fault, speed)]
        for check in checks:
            try:
                with located_in(fault):
                    check()
            except InputError as error:
                for problem in error.problems:
                    where = problem.where
                    key = f".{where.name}" if isinstance(where, Argument) else ""
                    problems.append((f"faults.{name}{key}", problem))
                break
    return problems


def _check_seat(case: MachineCase, fault: MachineFaultTable) -> None:
    """Raise InputError if a bearing has no seat that could be loose."""
    bearing = case.bearings[name_of(fault.bearing or "", "bearings")]
    if bearing.carrier is not None:
        what, why = f"{fault.bearing} is on the pin of a planet", "It turns with the carrier"
        raise InputError(what, Argument("bearing"), why, "Name a bearing of the housing")


def check_shaft(fault: FaultTable, speed: float) -> None:
    """Raise InputError if a shaft of this speed cannot be driven so."""
    if speed == 0.0:
        what, why = f"{shaft_excitation(fault).gear} stands", "The torque varies over its turns"
        raise InputError(what, Argument("shaft"), why, "Name a shaft that turns")
    shaft_excitation(fault)


def shaft_excitation(fault: Any) -> ShaftExcitation:
    """The torque or the speed of a named shaft."""
    excitation: Any = read_fault(fault, gear=name_of(fault.shaft, "shafts"))
    return excitation  # type: ignore[no-any-return]


def _check_gear_fault(case: MachineCase, fault: MachineFaultTable, mesh: str) -> None:
    if mesh in case.meshes_with_teeth:
        pair = case.pair(mesh, case.operating_point)
        if pair.spur_pair is None:
            what = f"mesh {mesh} is a {pair.gears.kind} pair"
            why = "Faults act on cylindrical pairs, whose teeth are computed one by one"
            raise InputError(what, Argument("gear"), why, "Name another gear")
        gear_fault = _on_mesh(case, fault, mesh)
        gear_fault._check(pair.spur_pair)
        gear_fault._check_model(pair.spur_pair, pair.stiffness.model)
    elif fault.kind not in ("eccentricity", "waviness") or fault.lead_angle:
        what = f"mesh {mesh} has a constant stiffness, and the fault is of the kind {fault.kind}"
        why = "Of a constant stiffness the teeth are not computed one by one"
        raise InputError(what, Argument("kind"), why, "Remove stiffness from the mesh")


def _on_mesh(case: MachineCase, fault: MachineFaultTable, mesh: str, **changes: Any) -> Fault:
    role = case._pinion_and_wheel(mesh).index(name_of(fault.gear or "", "gears"))
    gear = ("pinion", "wheel")[role]
    return read_fault(fault, gear=gear, **changes)  # type: ignore[return-value]


def faults_of_mesh(case: MachineCase, machine: Machine, mesh: str) -> list[Fault]:
    """Faults of both gears of a mesh, with the teeth counted as they come into contact there."""
    faults = []
    for fault in case.faults.values():
        gear = name_of(fault.gear or "", "gears")
        if gear not in machine.meshes[mesh].gears:
            continue
        first = next(name for name, each in machine.meshes.items() if gear in each.gears)
        changes = _changes(machine, fault, gear, (first, mesh))
        if changes is not None:
            faults.append(_on_mesh(case, fault, mesh, **changes))
    return faults


def _changes(
    machine: Machine, fault: MachineFaultTable, gear: str, meshes: tuple[str, str]
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


def defects_of(case: MachineCase) -> list[tuple[str, BearingForce]]:
    """Bearings of a machine that are damaged, and their defects."""
    return [
        (name_of(fault.bearing, "bearings"), bearing_impacts(case, fault))
        for fault in case.faults.values()
        if fault.kind == "bearing-defect" and fault.bearing is not None
    ]


def bearing_impacts(case: MachineCase, fault: MachineFaultTable) -> BearingForce:
    """Impacts of a defect, with the geometry of the bearing where the table does not give it."""
    from tribodyn.faults import BearingForce

    name = name_of(fault.bearing or "", "bearings")
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
