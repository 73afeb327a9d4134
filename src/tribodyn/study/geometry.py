"""The derived geometry of a case as one flat dictionary in SI: what ``tribodyn check`` prints."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from tribodyn.gear import SpurGear
    from tribodyn.study.case import Case

__all__ = ["geometry"]


def geometry(case: Case) -> dict[str, float]:
    """Geometry, masses and inertias that follow from a case.

    Parameters
    ----------
    case : Case
        The case.

    Returns
    -------
    dict of str to float
        Names and units as in :data:`tribodyn.study.SUMMARY`.

    Examples
    --------
    >>> import tribodyn
    >>> round(geometry(tribodyn.load_case("fzg-roughness"))["transverse_contact_ratio"], 6)
    1.326952
    """
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
