"""Range checks of single values: what a tooth form needs before anything can be computed."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from tribodyn.errors import Argument, Problem

if TYPE_CHECKING:
    from tribodyn.gear.tooth_form import ToothForm


_NO_LIMIT = math.inf


def _out_of_range(
    name: str, value: float, low: float, high: float, unit: str, factor: float, *, open_low: bool
) -> list[Problem]:
    """One problem if ``value`` is not a finite number between the limits."""
    number = isinstance(value, (int, float)) or hasattr(value, "__float__")
    inside = number and math.isfinite(value) and (value > low if open_low else value >= low)
    if inside and value <= high:
        return []
    shown = f"{float(value) * factor:.6g} {unit}".rstrip() if number else repr(value)
    floor = f"{'greater than' if open_low else 'at least'} {low * factor:g}"
    bound = floor if high == _NO_LIMIT else f"{floor} and at most {high * factor:g}"
    return [
        Problem(
            what=f"{name} = {shown}",
            where=Argument(name),
            why=f"{name} must be finite, {bound} {unit}".rstrip(),
            remedy="Check the value and its unit",
        )
    ]


def _positive(name: str, value: float) -> list[Problem]:
    return _out_of_range(name, value, 0.0, _NO_LIMIT, "mm", 1e3, open_low=True)


def _teeth(teeth: int) -> list[Problem]:
    problems = _out_of_range("teeth", teeth, 5, 500, "", 1.0, open_low=False)
    if not problems and teeth != int(teeth):
        problems = [
            Problem(
                what=f"teeth = {teeth:g}",
                where=Argument("teeth"),
                why="A gear has a whole number of teeth",
                remedy=f"Use {math.floor(teeth + 0.5)}",
            )
        ]
    return problems


def _rack(form: ToothForm) -> list[Problem]:
    """The rack must have a tip line, and its round must end on the straight flank."""
    angle, rack = form.normal_pressure_angle, form.rack
    width = rack.tip_half_width_coefficient(angle)
    if width <= 0.0:
        limit = math.pi / 4.0 / math.tan(angle)
        return [
            Problem(
                what=f"dedendum_coefficient = {rack.dedendum_coefficient:.6g}",
                where=Argument("rack"),
                why=f"The flanks of the rack meet at a depth of {limit:.6g} modules",
                remedy="Reduce the dedendum or the pressure angle",
            )
        ]
    depth = rack.fitting_tip_radius_coefficient(angle) * (1.0 - math.sin(angle))
    if depth > rack.dedendum_coefficient:
        return [
            Problem(
                what=f"tip_radius_coefficient = {rack.tip_radius_coefficient:.6g}",
                where=Argument("rack"),
                why=f"The tip round is {depth:.6g} modules high, more than the dedendum "
                f"of {rack.dedendum_coefficient:.6g} modules",
                remedy="Reduce the tip radius",
            )
        ]
    return []


def _root(form: ToothForm) -> list[Problem]:
    if form.root_radius > 0.0:
        return []
    return [
        Problem(
            what=f"profile_shift_coefficient = {form.profile_shift_coefficient:.6g}",
            where=Argument("profile_shift_coefficient"),
            why=f"The rack would cut through the axis: root radius {form.root_radius * 1e3:.6g} mm",
            remedy="Increase the shift or the number of teeth",
        )
    ]


def form_value_problems(form: ToothForm) -> list[Problem]:
    """Find the values of a tooth form that are out of range."""
    low, high = math.radians(10.0), math.radians(30.0)
    slack = 1e-12
    problems = [
        *_teeth(form.teeth),
        *_positive("normal_module", form.normal_module),
        *_out_of_range(
            "normal_pressure_angle",
            form.normal_pressure_angle,
            low - slack,
            high + slack,
            "deg",
            math.degrees(1.0),
            open_low=False,
        ),
        *_out_of_range(
            "profile_shift_coefficient",
            form.profile_shift_coefficient,
            -10.0,
            10.0,
            "",
            1.0,
            open_low=False,
        ),
        *_positive("tip_diameter", form.tip_diameter),
        *_out_of_range(
            "tooth_thinning", form.tooth_thinning, 0.0, _NO_LIMIT, "mm", 1e3, open_low=False
        ),
    ]
    return problems or [*_rack(form), *_root(form)]


def body_value_problems(
    face_width: float, bore_diameter: float, mass: float | None, moment_of_inertia: float | None
) -> list[Problem]:
    """Find the values of a gear body that are out of range."""
    problems = _positive("face_width", face_width)
    problems += _out_of_range(
        "bore_diameter", bore_diameter, 0.0, _NO_LIMIT, "mm", 1e3, open_low=False
    )
    for name, value, unit, factor in (
        ("mass", mass, "kg", 1.0),
        ("moment_of_inertia", moment_of_inertia, "kg*mm^2", 1e6),
    ):
        if value is not None:
            problems += _out_of_range(name, value, 0.0, _NO_LIMIT, unit, factor, open_low=True)
    return problems
