"""The form of a tooth as the rack cuts it: circles, thickness, flank and fillet.

A tooth form says what would be cut, even if nobody could use it; :class:`tribodyn.gear.SpurGear`
is a tooth form that can be made.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import cached_property

from tribodyn.errors import Argument, InputError, Problem
from tribodyn.gear.curves import Trochoid, form_point, involute
from tribodyn.gear.rack import BasicRack

#: Units of the messages: name, and what a value in SI is multiplied by.
MILLIMETRES, DEGREES, PURE = ("mm", 1e3), ("deg", math.degrees(1.0)), ("", 1.0)


def range_problems(
    name: str,
    value: float,
    low: float = 0.0,
    high: float = math.inf,
    *,
    unit: tuple[str, float] = MILLIMETRES,
    open_low: bool = False,
) -> list[Problem]:
    """One problem if ``value`` is not a finite number between the limits."""
    number = isinstance(value, (int, float)) or hasattr(value, "__float__")
    inside = number and math.isfinite(value) and (value > low if open_low else value >= low)
    if inside and value <= high:
        return []
    symbol, factor = unit
    shown = f"{float(value) * factor:.6g} {symbol}".rstrip() if number else repr(value)
    bound = f"{'greater than' if open_low else 'at least'} {low * factor:g}"
    if high < math.inf:
        bound += f" and at most {high * factor:g}"
    why = f"{name} must be finite, {bound} {symbol}".rstrip()
    return [Problem(f"{name} = {shown}", Argument(name), why, "Check the value and its unit")]


def _teeth_problems(teeth: int) -> list[Problem]:
    problems = range_problems("teeth", teeth, 5, 500, unit=PURE)
    if problems or teeth == int(teeth):
        return problems
    return [
        Problem(
            what=f"teeth = {teeth:g}",
            where=Argument("teeth"),
            why="A gear has a whole number of teeth",
            remedy=f"Use {math.floor(teeth + 0.5)}",
        )
    ]


@dataclass(frozen=True, kw_only=True)
class ToothForm:
    """Rack-generated involute tooth of an external spur gear.

    Parameters
    ----------
    teeth : int
        Number of teeth, 5 to 500.
    normal_module : float
        Module [m].
    normal_pressure_angle : float
        Pressure angle of the rack [rad], 10 to 30 degrees.
    profile_shift_coefficient : float
        Rack displacement over the module, positive outwards.
    tip_diameter : float
        Diameter of the tip circle [m].
    tooth_thinning : float
        Reduction of the tooth thickness along the base circle [m], which is the play that it
        adds on the line of action. The rack is fed deeper by thinning / (2 sin(alpha)).
    rack : BasicRack
        Generating profile.

    Raises
    ------
    InputError
        Listing every value that is out of range.

    Notes
    -----
    Source: ISO 21771, sections on the involute, tooth thickness and generating profile shift.

    Examples
    --------
    >>> form = ToothForm(teeth=20, normal_module=2e-3, normal_pressure_angle=math.radians(20.0),
    ...                  profile_shift_coefficient=0.0, tip_diameter=44e-3)
    >>> round(form.base_radius * 1e3, 4), form.undercut
    (18.7939, False)
    """

    teeth: int
    normal_module: float
    normal_pressure_angle: float
    profile_shift_coefficient: float
    tip_diameter: float
    tooth_thinning: float = 0.0
    rack: BasicRack = field(default_factory=BasicRack)

    def __post_init__(self) -> None:
        problems = self.value_problems()
        if problems:
            raise InputError(problems)

    def value_problems(self) -> list[Problem]:
        """Find the values that are out of range.

        Returns
        -------
        list of Problem
            Empty when the form can be computed.
        """
        slack, shift = 1e-12, self.profile_shift_coefficient
        limits = math.radians(10.0) - slack, math.radians(30.0) + slack
        angle = self.normal_pressure_angle
        problems = [
            *_teeth_problems(self.teeth),
            *range_problems("normal_module", self.normal_module, open_low=True),
            *range_problems("normal_pressure_angle", angle, *limits, unit=DEGREES),
            *range_problems("profile_shift_coefficient", shift, -10.0, 10.0, unit=PURE),
            *range_problems("tip_diameter", self.tip_diameter, open_low=True),
            *range_problems("tooth_thinning", self.tooth_thinning),
        ]
        return problems or [*self.rack.shape_problems(angle), *self._root_problems()]

    def _root_problems(self) -> list[Problem]:
        if self.root_radius > 0.0:
            return []
        return [
            Problem(
                what=f"profile_shift_coefficient = {self.profile_shift_coefficient:.6g}",
                where=Argument("profile_shift_coefficient"),
                why="The rack would cut through the axis: root radius "
                f"{self.root_radius * 1e3:.6g} mm",
                remedy="Increase the shift or the number of teeth",
            )
        ]

    @cached_property
    def generating_shift_coefficient(self) -> float:
        """Profile shift that is cut, tooth thinning included."""
        infeed = self.tooth_thinning / (2.0 * math.sin(self.normal_pressure_angle))
        return self.profile_shift_coefficient - infeed / self.normal_module

    @cached_property
    def reference_radius(self) -> float:
        """Radius of the reference circle m z / 2 [m]."""
        return 0.5 * self.normal_module * self.teeth

    @cached_property
    def base_radius(self) -> float:
        """Radius of the base circle [m]."""
        return self.reference_radius * math.cos(self.normal_pressure_angle)

    @cached_property
    def tip_radius(self) -> float:
        """Radius of the tip circle [m]."""
        return 0.5 * self.tip_diameter

    @cached_property
    def root_radius(self) -> float:
        """Radius of the root circle that the rack cuts [m]."""
        depth = self.rack.dedendum_coefficient - self.generating_shift_coefficient
        return self.reference_radius - depth * self.normal_module

    @cached_property
    def base_pitch(self) -> float:
        """Distance of neighbouring flanks along the line of action [m]."""
        return math.pi * self.normal_module * math.cos(self.normal_pressure_angle)

    @cached_property
    def base_half_angle(self) -> float:
        """Half of the tooth thickness at the base circle as an angle [rad]."""
        shift = self.generating_shift_coefficient
        tangent = math.tan(self.normal_pressure_angle)
        reference = (math.pi / 2.0 + 2.0 * shift * tangent) / self.teeth
        return reference + involute(self.normal_pressure_angle)

    def pressure_angle_at(self, radius: float) -> float:
        """Pressure angle of the involute.

        Parameters
        ----------
        radius : float
            Distance from the axis [m], at least the base radius.

        Returns
        -------
        float
            Pressure angle [rad].

        Raises
        ------
        InputError
            If the radius lies below the base circle, where there is no involute.
        """
        return math.atan(self.roll_angle(radius))

    def roll_angle(self, radius: float) -> float:
        """Roll angle of the involute: radius of curvature over base radius.

        Parameters
        ----------
        radius : float
            Distance from the axis [m], at least the base radius.

        Returns
        -------
        float
            Roll angle [rad].

        Raises
        ------
        InputError
            If the radius lies below the base circle, where there is no involute.
        """
        base = self.base_radius
        if not radius >= base * (1.0 - 1e-12):
            raise InputError(
                f"radius = {radius * 1e3:.6g} mm",
                where=Argument("radius"),
                why=f"The involute begins at the base radius {base * 1e3:.6g} mm",
                remedy="Use half_tooth for points of the fillet",
            )
        return math.sqrt(max((radius - base) * (radius + base), 0.0)) / base

    def half_tooth_angle(self, radius: float) -> float:
        """Angle between the tooth axis and the involute flank.

        Parameters
        ----------
        radius : float
            Distance from the axis [m], at least the base radius.

        Returns
        -------
        float
            Half of the angle that the tooth covers [rad]; negative beyond a pointed tip.

        Raises
        ------
        InputError
            If the radius lies below the base circle, where there is no involute.
        """
        return self.base_half_angle - involute(self.pressure_angle_at(radius))

    def tooth_thickness(self, radius: float) -> float:
        """Tooth thickness along the circle through a point of the involute.

        Parameters
        ----------
        radius : float
            Distance from the axis [m], at least the base radius.

        Returns
        -------
        float
            Arc length [m].

        Raises
        ------
        InputError
            If the radius lies below the base circle, where there is no involute.
        """
        return 2.0 * radius * self.half_tooth_angle(radius)

    @cached_property
    def tip_thickness(self) -> float:
        """Tooth thickness along the tip circle [m]."""
        return self.tooth_thickness(self.tip_radius)

    @cached_property
    def trochoid(self) -> Trochoid:
        """The fillet curve."""
        module, angle = self.normal_module, self.normal_pressure_angle
        round_ = self.rack.fitting_tip_radius_coefficient(angle)
        depth = self.rack.dedendum_coefficient - self.generating_shift_coefficient - round_
        offset = self.rack.tip_half_width_coefficient(angle) - round_ * (
            (1.0 - math.sin(angle)) / math.cos(angle)
        )
        return Trochoid(
            reference_radius=self.reference_radius,
            teeth=self.teeth,
            pressure_angle=angle,
            tip_radius=round_ * module,
            center_offset=max(offset, 0.0) * module,
            center_depth=depth * module,
        )

    @cached_property
    def undercut(self) -> bool:
        """Whether the rack tip removes involute near the base circle."""
        return self.trochoid.undercuts

    @cached_property
    def form_normal_angle(self) -> float:
        """Parameter of the fillet curve where it meets the involute [rad]."""
        return form_point(self.trochoid, self.base_radius, self.base_half_angle)

    @cached_property
    def form_radius(self) -> float:
        """Radius where involute and fillet meet, by tangency or, undercut, by crossing [m]."""
        return float(self.trochoid.radius(self.form_normal_angle))
