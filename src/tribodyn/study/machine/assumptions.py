"""What a case of a machine does not give, and what is taken in its place."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import TYPE_CHECKING, Any

from tribodyn.machine.fields import display
from tribodyn.study.case.provenance import (
    Assumption,
)
from tribodyn.study.case.to_models import USUAL_GEARS
from tribodyn.study.case.write import written_value
from tribodyn.study.machine_tables import STIFF

if TYPE_CHECKING:
    from tribodyn.study.machine.case import MachineCase


def stated_assumptions(case: MachineCase) -> Iterator[Assumption]:
    """Reasons in ``[assumed]`` with the values they refer to."""
    for key, why in case.data.get("assumed", {}).items():
        *names, name = key.split(".")
        value: Any = case.data
        for each in (*names, name):
            value = value.get(each) if isinstance(value, Mapping) else None
        blank = value is None or isinstance(value, Mapping)
        text = "" if blank else written_value(value, case.option_of(key)).strip('"')
        yield Assumption(key, text, "assumed", why)


def default_assumptions(case: MachineCase) -> Iterator[Assumption]:
    """What the case does not give, and what is estimated in its place."""
    for name, shaft in case.shafts.items():
        if shaft.is_rigid:
            why = "a shaft without sections"
            yield Assumption(f"shafts.{name}", "rigid", "default", why)
    for name, bearing in case.bearings.items():
        if bearing.is_default:
            why = "a bearing without stiffness or type is stiff"
            yield Assumption(f"bearings.{name}", "1e9 N/m", "default", why)
        for key, value, why in _estimates(getattr(bearing.rolling, "assumptions", ())):
            yield Assumption(f"bearings.{name}.{key}", value, "default", why)
    for name, stage in case.stages.items():
        for role in ("sun", "ring", "carrier"):
            support = case.bearings.get(f"{name}_{role}")
            if support is not None and support.radial_stiffness is not None:
                value = f"{support.radial_stiffness:g} N/m"
                reason = f"support of shaft {stage.shaft_of(role)}, which has no bearing"
                yield Assumption(f"bearings.{name}_{role}", value, "default", reason)
        if case.lone_stage is None:
            reason = "planets stay at their angles while teeth turn: Coriolis forces are left out"
            yield Assumption(f"planets.{name}: carrier", "fixed position", "default", reason)
        yield from _of_stage(case, f"planets.{name}", case.data["planets"][name])
        if stage.is_stepped:
            reason = "ring meshes begin their cycle with the sun mesh of the first planet"
            yield Assumption(f"planets.{name}: phase of both gears", "0", "default", reason)
    yield from backlash_assumptions(case)
    if case.housing is None:
        yield Assumption("housing", "rigid", "default", "without [housing]")


def _of_stage(case: MachineCase, key: str, body: Mapping[str, Any]) -> Iterator[Assumption]:
    """What a stage does not give of its pins, its carrier and its gears."""
    if "pin_stiffness" not in body:
        yield Assumption(f"{key}.pin_stiffness", f"{STIFF:g} N/m", "default", "stiff")
    if "pin_clearance" not in body:
        yield Assumption(f"{key}.pin_clearance", "0 um", "default", "planets without clearance")
    for name in ("carrier_mass", "carrier_moment_of_inertia"):
        if name not in body:
            reason = "a steel disc of the radius of the pins and the face width of the planets"
            yield Assumption(f"{key}.{name}", "", "default", reason)
    for role in ("sun", "planet", "ring_planet", "ring"):
        gear = body.get(role)
        if gear is not None and "mass" not in case.data["gears"][str(gear)]:
            yield Assumption(f"gears.{gear}.mass", "", "default", "a solid body")
    if case.lone_stage is not None and not body.get("helix_angle"):
        why = "axial motion and tilting of the members are left out"
        yield Assumption(f"{key}: motion", "in the plane", "default", why)


def backlash_assumptions(case: MachineCase) -> Iterator[Assumption]:
    """Usual backlash of the meshes with computed teeth for which the case gives none."""
    usual = {}
    for key, pair, _ in case.mesh_pairs():
        group, _, name = key.partition(".")
        tables = case.data.get("dynamics", {}), case.data[group][name]
        if pair.gears.kind == "spur" and not any("backlash" in table for table in tables):
            usual[f"{key}.backlash"] = pair.dynamics.backlash
    for key, value in usual.items():
        if value is not None:
            yield Assumption(key, display(value, "m"), "default", USUAL_GEARS)


def _estimates(texts: Iterable[str]) -> Iterator[tuple[str, str, str]]:
    """Key, value and reason of estimates such as ``balls = 8, estimated: usual filling``."""
    for text in texts:
        key, _, value_and_reason = text.partition(" = ")
        value, _, why = value_and_reason.partition(", ")
        yield key, value, why
