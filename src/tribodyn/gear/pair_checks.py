"""Checks of two gears in mesh: can they run together, and is anything near a limit."""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import suppress

from tribodyn.errors import Argument, InputError, Problem
from tribodyn.gear.mesh_geometry import MeshGeometry
from tribodyn.gear.pair_geometry import zero_backlash_center_distance
from tribodyn.gear.tooth_form import ToothForm

#: Negative play over the module that printed, hence rounded, shift coefficients may leave.
ROUNDING_TOLERANCE = 0.002
#: Negative play over the module above which the rounding is worth a warning.
ROUNDING_WARNING = 0.0005


def match_problems(pinion: ToothForm, wheel: ToothForm, driver: str) -> list[Problem]:
    """Find what makes two gears no pair at all."""
    problems = []
    if pinion.teeth > wheel.teeth:
        problems.append(
            Problem(
                what=f"the pinion has {pinion.teeth} teeth, the wheel {wheel.teeth}",
                where=Argument("teeth", "pinion"),
                why="The pinion is the gear with fewer teeth, whichever drives",
                remedy='Exchange the two gears and set driver to "wheel" if the larger one drives',
            )
        )
    for name, unit, factor in (
        ("normal_module", "mm", 1e3),
        ("normal_pressure_angle", "deg", math.degrees(1.0)),
    ):
        values = getattr(pinion, name), getattr(wheel, name)
        if not math.isclose(*values, rel_tol=1e-12):
            problems.append(
                Problem(
                    what=f"{name} = {values[0] * factor:.6g} {unit} on the pinion and "
                    f"{values[1] * factor:.6g} {unit} on the wheel",
                    where=Argument(name),
                    why="Gears in mesh have the same base pitch",
                    remedy="Give both gears the same value",
                )
            )
    if driver not in ("pinion", "wheel"):
        problems.append(
            Problem(
                what=f'driver = "{driver}"',
                where=Argument("driver"),
                why='One of the two gears drives: "pinion" or "wheel"',
                remedy='Write "pinion" or "wheel"',
            )
        )
    return problems


def _used_flanks(mesh: MeshGeometry) -> Iterator[tuple[str, str, ToothForm, ToothForm, float]]:
    """Each gear's name, its mate's name, both forms, and its least used radius of curvature."""
    first, last = mesh.path_limits
    yield "pinion", "wheel", mesh.pinion, mesh.wheel, first
    yield "wheel", "pinion", mesh.wheel, mesh.pinion, mesh.line_of_action_length - last


def _interference(mesh: MeshGeometry) -> list[Problem]:
    """The tip of each gear must meet involute on its mate, not base circle nor fillet."""
    problems = []
    for name, mate_name, gear, mate, least in _used_flanks(mesh):
        form = gear.roll_angle(gear.form_radius) * gear.base_radius
        if least >= form - 1e-6 * gear.normal_module:
            continue
        largest = 2e3 * math.hypot(mate.base_radius, max(mesh.line_of_action_length - form, 0.0))
        if least < 0.0:
            why = f"It passes the base tangent point of the {name} by {-least * 1e3:.6g} mm"
        else:
            end = "undercut removes flank" if gear.undercut else "fillet reaches"
            why = (
                f"It needs the {name}'s flank from the diameter "
                f"{2e3 * math.hypot(gear.base_radius, least):.6g} mm on, but its {end} up to "
                f"{2e3 * gear.form_radius:.6g} mm"
            )
        problems.append(
            Problem(
                what=f"interference: the tip diameter of the {mate_name} is "
                f"{mate.tip_diameter * 1e3:.6g} mm",
                where=Argument("tip_diameter", mate_name),
                why=why,
                remedy=f"Reduce it to {largest:.6g} mm or less, or shift the {name} outwards",
            )
        )
    return problems


def _clearance(mesh: MeshGeometry) -> list[Problem]:
    problems = []
    for name, mate_name, gear, mate in (
        ("pinion", "wheel", mesh.pinion, mesh.wheel),
        ("wheel", "pinion", mesh.wheel, mesh.pinion),
    ):
        clearance = mesh.center_distance - gear.tip_radius - mate.root_radius
        if clearance <= 0.0:
            problems.append(
                Problem(
                    what=f"the bottom clearance at the {name}'s tip is {clearance * 1e3:.6g} mm",
                    where=Argument("tip_diameter", name),
                    why=f"Tip diameter {gear.tip_diameter * 1e3:.6g} mm and the {mate_name}'s root "
                    f"diameter {2e3 * mate.root_radius:.6g} mm overlap at the centre distance "
                    f"{mesh.center_distance * 1e3:.6g} mm",
                    remedy="Reduce the tip diameter or increase the centre distance",
                )
            )
    return problems


def _contact_ratio(mesh: MeshGeometry) -> list[Problem]:
    ratio = mesh.transverse_contact_ratio
    if ratio >= 1.0:
        return []
    return [
        Problem(
            what=f"transverse contact ratio {ratio:.6g}",
            why="Below 1 the contact is lost between two tooth pairs",
            remedy="Increase the tip diameters or reduce the centre distance",
        )
    ]


def fitting_center_distance(mesh: MeshGeometry) -> float | None:
    """Least centre distance for the tooth thicknesses where the given one is too small."""
    pinion, wheel, module = mesh.pinion, mesh.wheel, mesh.pinion.normal_module
    with suppress(InputError):
        if mesh.geometric_backlash >= -ROUNDING_TOLERANCE * module:
            return None
    with suppress(InputError):
        return zero_backlash_center_distance(
            pinion.teeth + wheel.teeth,
            module,
            pinion.normal_pressure_angle,
            pinion.generating_shift_coefficient + wheel.generating_shift_coefficient,
        )
    return None


def too_close(mesh: MeshGeometry, fitting: float) -> Problem:
    """Say that the flanks interfere and which centre distance fits."""
    return Problem(
        what=f"the centre distance must be at least {fitting * 1e3:.6g} mm for these tooth "
        f"thicknesses; {mesh.center_distance * 1e3:.6g} mm is given and the flanks interfere",
        where=Argument("center_distance"),
        why=f"Both flanks touch at {fitting * 1e3:.6g} mm already",
        remedy="Increase the centre distance or reduce a profile shift",
    )


def mesh_problems(mesh: MeshGeometry) -> list[Problem]:
    """Find the reasons why two gears cannot run together."""
    fitting = fitting_center_distance(mesh)
    if fitting is not None:
        # All else that is wrong follows from it.
        return [too_close(mesh, fitting)]
    try:
        _ = mesh.operating_pressure_angle
    except InputError as error:
        return list(error.problems)
    problems = _clearance(mesh)
    if all(form.tip_radius > form.base_radius for form in (mesh.pinion, mesh.wheel)):
        problems += [*_interference(mesh), *_contact_ratio(mesh)]
    return problems


def mesh_warnings(mesh: MeshGeometry) -> list[tuple[str, str]]:
    """Find what runs but is near a limit."""
    found = []
    module, play = mesh.pinion.normal_module, mesh.geometric_backlash
    if play < -ROUNDING_WARNING * module:
        found.append(
            (
                "flank-interference-rounding",
                f"the play on the line of action is {play * 1e6:.4g} um; down to "
                f"{-ROUNDING_TOLERANCE * module * 1e6:.4g} um it is taken as rounding of the shift "
                "coefficients and counts as zero. Give the shifts with more digits",
            )
        )
    for name, _, gear, _, least in _used_flanks(mesh):
        used = math.hypot(gear.base_radius, max(least, 0.0))
        if gear.undercut:
            found.append(
                (
                    "undercut",
                    f"the {name} is undercut up to the diameter {2e3 * gear.form_radius:.6g} mm, "
                    f"its flank is used from {2e3 * used:.6g} mm on: no contact is lost, but the "
                    "root is weaker. A profile shift further outwards avoids it",
                )
            )
    return found
