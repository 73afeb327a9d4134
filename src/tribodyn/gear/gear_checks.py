"""Checks of one gear's shape: can this tooth be made, and is anything near a limit."""

from __future__ import annotations

import math

import numpy as np

from tribodyn.errors import Argument, Problem
from tribodyn.gear.tooth_form import ToothForm

#: Tip thickness over the module below which a tip counts as thin (usual limit of hardened gears).
THIN_TIP = 0.2


def _tip_problem(form: ToothForm) -> Problem | None:
    tip, base = form.tip_radius, form.base_radius
    if tip <= base:
        return Problem(
            what=f"tip diameter {2e3 * tip:.6g} mm",
            where=Argument("tip_diameter"),
            why=f"It lies below the base circle of {2e3 * base:.6g} mm, where there is no involute",
            remedy="Increase the tip diameter or the profile shift",
        )
    if form.tip_thickness < 0.0:
        return Problem(
            what=f"the tooth is pointed: tip thickness {form.tip_thickness * 1e3:.6g} mm "
            f"at the tip diameter {2e3 * tip:.6g} mm",
            where=Argument("tip_diameter"),
            why="The two flanks meet below the tip circle",
            remedy="Reduce the tip diameter or the profile shift",
        )
    if tip <= form.form_radius:
        return Problem(
            what=f"tip diameter {2e3 * tip:.6g} mm",
            where=Argument("tip_diameter"),
            why=f"The fillet reaches up to {2e3 * form.form_radius:.6g} mm "
            "and leaves no involute flank",
            remedy="Increase the tip diameter, the profile shift or the number of teeth",
        )
    return None


def _waist_problem(form: ToothForm) -> Problem | None:
    """Extreme undercut from both sides meets in the middle and cuts the tooth off."""
    along = np.linspace(form.form_normal_angle, math.pi / 2.0, 129)
    half_angle = float(form.trochoid.half_tooth_angle(along).min())
    if half_angle > 0.0:
        return None
    return Problem(
        what=f"profile_shift_coefficient = {form.profile_shift_coefficient:.6g}",
        where=Argument("profile_shift_coefficient"),
        why=f"The undercut of a gear of {form.teeth} teeth meets in the middle of the tooth",
        remedy="Shift the gear outwards or use more teeth",
    )


def shape_problems(form: ToothForm, bore_diameter: float) -> list[Problem]:
    """Find the faults that make a gear impossible."""
    found = (_tip_problem(form), _waist_problem(form))
    problems = [problem for problem in found if problem is not None]
    if bore_diameter >= 2.0 * form.root_radius:
        problems.append(
            Problem(
                what=f"bore diameter {bore_diameter * 1e3:.6g} mm",
                where=Argument("bore_diameter"),
                why=f"The root circle has {2e3 * form.root_radius:.6g} mm",
                remedy="Reduce the bore below the root diameter",
            )
        )
    return problems


def shape_warnings(form: ToothForm) -> list[tuple[str, str]]:
    """Find what is possible but near a limit."""
    found = []
    thickness = form.tip_thickness / form.normal_module
    if thickness < THIN_TIP:
        found.append(
            (
                "thin-tip",
                f"gear with {form.teeth} teeth: the tip is {thickness:.3g} modules thick, less "
                f"than {THIN_TIP:g}; reduce the tip diameter or the profile shift",
            )
        )
    given = form.rack.tip_radius_coefficient
    fitting = form.rack.fitting_tip_radius_coefficient(form.normal_pressure_angle)
    if fitting < given:
        found.append(
            (
                "full-fillet",
                f"gear with {form.teeth} teeth: a rack tip radius of {given:.4g} modules does not "
                f"fit between the flanks; the full round of {fitting:.4g} modules is cut. Give a "
                "tip radius of at most this value, or a smaller dedendum",
            )
        )
    return found
