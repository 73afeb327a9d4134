"""The derived geometry of a case as one flat dictionary in SI: what ``tribodyn check`` prints."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tribodyn.gear import SpurGear
    from tribodyn.mesh.table_file import TableFile
    from tribodyn.study.case.case import Case


#: Modifications that are one figure each.
_AMOUNTS = (
    "tip_relief", "root_relief", "profile_crowning", "profile_slope", "crowning", "lead_slope",
    "run_out",
)  # fmt: skip


def geometry(case: Case) -> dict[str, float]:
    """Geometry, masses and inertias that follow from a case."""
    if case.mesh_table is not None:
        return _of_mesh_table(case, case.mesh_table)
    from tribodyn.contact import gear_loss_factor, path_of_contact

    pair = case.gear_pair
    values = {
        "transverse_contact_ratio": pair.transverse_contact_ratio,
        "gear_ratio": pair.ratio,
        "operating_pressure_angle": pair.operating_pressure_angle,
        "center_distance": pair.center_distance,
        "tip_shortening_coefficient": pair.tip_shortening_coefficient,
        "base_pitch": pair.base_pitch,
        "line_of_action_length": pair.line_of_action_length,
        "common_face_width": pair.common_face_width,
        "backlash": case.backlash,
        "gear_loss_factor": gear_loss_factor(pair),
    }
    for place, angle in path_of_contact(pair).roll_angles.items():
        values[f"roll_angle_{place}"] = angle
    gears = (("pinion", pair.pinion), ("wheel", pair.wheel))
    bodies = {name: _body(case, gear) for name, gear in gears}
    for key in bodies["pinion"]:
        for name, body in bodies.items():
            values[f"{key}_{name}"] = body[key]
    values |= _modifications(case)
    return {name: float(value) for name, value in values.items()}


def _of_mesh_table(case: Case, table: TableFile) -> dict[str, float]:
    """What is known of gears behind a mesh table: levers, and the bodies that the case gives."""
    values = {"gear_ratio": case.gear_ratio, "backlash": case.backlash}
    for name, gear in (("pinion", case.gears.pinion), ("wheel", case.gears.wheel)):
        values[f"base_radius_{name}"] = table.lever(f"{name}_theta")
        for key in ("mass", "moment_of_inertia"):
            if getattr(gear, key) is not None:
                values[f"{key}_{name}"] = getattr(gear, key)
    return {name: float(value) for name, value in values.items()}


def _body(case: Case, gear: SpurGear) -> dict[str, float]:
    from tribodyn.gear import mass_properties

    solid = mass_properties(gear, case.material.density)
    return {
        "reference_diameter": 2.0 * gear.reference_radius,
        "base_radius": gear.base_radius,
        "tip_diameter": 2.0 * gear.tip_radius,
        "root_diameter": 2.0 * gear.root_radius,
        "tip_thickness": gear.tip_thickness,
        "tooth_thinning": gear.tooth_thinning,
        "face_width": gear.face_width,
        "mass": solid.mass,
        "moment_of_inertia": solid.moment_of_inertia,
    }


def _modifications(case: Case) -> dict[str, float]:
    """Amounts that are not zero, with the lengths of the reliefs in force."""
    from tribodyn.gear import default_relief_length, hunting_period

    pair = case.gear_pair
    values = {"misalignment": pair.misalignment} if pair.misalignment else {}
    for name, gear in (("pinion", pair.pinion), ("wheel", pair.wheel)):
        given = gear.modification
        for key in _AMOUNTS:
            if getattr(given, key) != 0.0:
                values[f"{key}_{name}"] = getattr(given, key)
                if key in ("tip_relief", "root_relief"):
                    length = getattr(given, f"{key}_length")
                    own = default_relief_length(pair) if length is None else length
                    values[f"{key}_length_{name}"] = own
    if pair.has_pitch_deviation:
        values["hunting_period"] = hunting_period(pair)
    return values
