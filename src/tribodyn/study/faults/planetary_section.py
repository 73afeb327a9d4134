"""The ``[faults.NAME]`` tables of a planetary stage: waves that turn with its gears."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, ClassVar

from tribodyn.errors import InputError, Problem, did_you_mean
from tribodyn.model import REQUIRED, choice, integer, text
from tribodyn.study.case.values import KeyedProblems
from tribodyn.study.faults.machine_section import OF_SHAFTS, SHAFT, check_shaft, name_of
from tribodyn.study.faults.section import KINDS, MEANINGS, FaultTable, fault_problems

if TYPE_CHECKING:
    from tribodyn.study.planetary.case import PlanetaryCase

_WAVES = ("eccentricity", "waviness")
_KINDS = (*_WAVES, *OF_SHAFTS)


class PlanetaryFaultTable(FaultTable):
    """A ``[faults.NAME]`` table of a stage; the teeth themselves are equal in all its meshes."""

    kinds: ClassVar = {
        **{kind: (KINDS[kind][0], (*KINDS[kind][1], "planet")) for kind in _WAVES},
        **OF_SHAFTS,
    }
    kind: str = choice(REQUIRED, {kind: MEANINGS[kind] for kind in _KINDS}, meaning="what it is")
    gear: str | None = text(None, meaning="sun, planet or ring", example='"sun"')  # type: ignore[assignment]
    planet: int | None = integer(
        None, 1, 24, "in the order of the angles", meaning="number of the planet", example="1"
    )
    shaft: str | None = SHAFT


def planetary_fault_problems(case: PlanetaryCase, faults: Mapping[str, Any]) -> KeyedProblems:
    """Report faults that are incomplete, or whose gear or planet does not exist."""
    problems = fault_problems(faults)
    gears = [getattr(case.table, role) for role in ("sun", "planet", "ring")]
    for name, fault in faults.items():
        key, gear = f"faults.{name}", name_of(fault.gear or "", "gears")
        if fault.kind in OF_SHAFTS:
            problems += _shaft_problems(case, key, fault)
        elif gear not in gears:
            why, remedy = f"Known: {', '.join(gears)}", did_you_mean(gear, gears, "Name one")
            problem = Problem(f'there is no gear "{fault.gear}"', "", why, remedy)
            problems.append((f"{key}.gear", problem))
        elif fault.planet is not None and (gear != gears[1] or fault.planet > case.table.count):
            what = f"planet = {fault.planet} of the gear {gear}"
            why = f"The stage has {case.table.count} planets; sun and ring are one each"
            problems.append((f"{key}.planet", Problem(what, "", why, "Correct the number")))
        if fault.lead_angle:
            what, why = f"lead_angle = {fault.lead_angle:g} rad", "All slices of a stage are equal"
            problems.append((f"{key}.lead_angle", Problem(what, "", why, "Remove it")))
    return problems


def _shaft_problems(case: PlanetaryCase, key: str, fault: PlanetaryFaultTable) -> KeyedProblems:
    """Report an excitation of a member that does not exist or stands."""
    turning = [name for name in case.ends if name in case.members.values()]
    shaft = name_of(fault.shaft or "", "shafts")
    if shaft not in turning:
        what = f'shaft = "{fault.shaft}"' if fault.shaft else "shaft is missing"
        why, remedy = f"The members that turn are {' and '.join(turning)}", "Name one of these"
        return [(f"{key}.shaft", Problem(what, "", why, remedy))] if fault.shaft else []
    try:
        check_shaft(fault, 1.0)
    except InputError as error:
        return [(f"{key}.{getattr(each.where, 'name', 'kind')}", each) for each in error.problems]
    return []
