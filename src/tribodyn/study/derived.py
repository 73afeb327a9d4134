"""Values that a case leaves to be derived from its geometry."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tribodyn.study.case import Case


#: Keys whose missing value is derived, and from what.
BASIS = {
    "face_width": "that of the other gear",
    "tip_diameter": "the standard addendum less the tip shortening",
    "mass": "the solid gear",
    "moment_of_inertia": "the solid gear",
    "center_distance": "the profile shifts, without backlash",
    "tip_relief_length": "the place where the number of tooth pairs changes",
    "root_relief_length": "the place where the number of tooth pairs changes",
    "steps_per_mesh_cycle": "the fastest motion of the structure, from 1024 to 65536",
    "backlash": "the tooth thicknesses at the operating pitch circles",
}


def derived_values(case: Case) -> dict[str, float]:
    """All values that are derived because the case does not give them."""
    from tribodyn.gear import default_relief_length, mass_properties

    pair, values = case.gear_pair, {}
    for name, gear in (("pinion", pair.pinion), ("wheel", pair.wheel)):
        solid = mass_properties(gear, case.material.density)
        values[f"gears.{name}.face_width"] = gear.face_width
        values[f"gears.{name}.tip_diameter"] = gear.tip_diameter
        values[f"gears.{name}.mass"] = solid.mass
        values[f"gears.{name}.moment_of_inertia"] = solid.moment_of_inertia
        for end in ("tip_relief", "root_relief"):
            values[f"gears.{name}.modification.{end}_length"] = default_relief_length(pair)
    values["gears.center_distance"] = pair.center_distance
    values["dynamics.backlash"] = case.backlash
    given = dict(case.values())
    return {key: value for key, value in values.items() if given.get(key, value) is None}
