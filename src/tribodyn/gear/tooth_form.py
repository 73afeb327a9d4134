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


@dataclass(frozen=True)
class BasicRack:
    """Basic rack tooth profile; the defaults are profile A of ISO 53.

    Parameters
    ----------
    addendum_coefficient : float
        Addendum divided by the module.
    dedendum_coefficient : float
        Dedendum divided by the module: the depth to which the generating rack cuts.
    tip_radius_coefficient : float
        Tip radius of the generating rack divided by the module.

    Raises
    ------
    InputError
        If a coefficient is not finite, the addendum or dedendum is not positive, or the tip
        radius is negative.

    Examples
    --------
    >>> round(BasicRack().largest_tip_radius_coefficient(math.radians(20.0)), 4)
    0.4719
    """

    addendum_coefficient: float = 1.0
    dedendum_coefficient: float = 1.25
    tip_radius_coefficient: float = 0.38

    def __post_init__(self) -> None:
        limits = {
            "addendum_coefficient": (self.addendum_coefficient, False),
            "dedendum_coefficient": (self.dedendum_coefficient, False),
            "tip_radius_coefficient": (self.tip_radius_coefficient, True),
        }
        problems = [
            Problem(
                what=f"{name} = {value:.6g}",
                where=Argument(name),
                why="It must be finite and " + ("not negative" if zero else "greater than zero"),
                remedy="ISO 53 profile A has 1.0, 1.25 and 0.38",
            )
            for name, (value, zero) in limits.items()
            if not math.isfinite(value) or value < 0.0 or (value == 0.0 and not zero)
        ]
        if problems:
            raise InputError(problems)

    def tip_half_width_coefficient(self, pressure_angle: float) -> float:
        """Half width of the sharp rack tooth at its tip line, over the module.

        Parameters
        ----------
        pressure_angle : float
            Pressure angle of the rack [rad].

        Returns
        -------
        float
            pi/4 - h_fP* tan(alpha); not positive when the flanks meet before the tip line.
        """
        return math.pi / 4.0 - self.dedendum_coefficient * math.tan(pressure_angle)

    def largest_tip_radius_coefficient(self, pressure_angle: float) -> float:
        """Tip radius over the module at which the rack tip is one full round.

        Parameters
        ----------
        pressure_angle : float [rad]
            Of the rack.

        Returns
        -------
        float
            Radius of the circle that touches both flanks and the tip line, over the module.
        """
        width = self.tip_half_width_coefficient(pressure_angle)
        return width * math.cos(pressure_angle) / (1.0 - math.sin(pressure_angle))

    def fitting_tip_radius_coefficient(self, pressure_angle: float) -> float:
        """Tip radius over the module that is cut: the given one, or the full round if smaller.

        Parameters
        ----------
        pressure_angle : float [rad]
            Of the rack.

        Returns
        -------
        float
            Smaller one of the given and the largest tip radius coefficient.
        """
        largest = self.largest_tip_radius_coefficient(pressure_angle)
        return min(self.tip_radius_coefficient, largest)

    def shape_problems(self, pressure_angle: float) -> list[Problem]:
        """Find why a rack of this pressure angle has no tip line, or no flank below its round.

        Parameters
        ----------
        pressure_angle : float
            Pressure angle of the rack [rad].

        Returns
        -------
        list of Problem
        """
        if self.tip_half_width_coefficient(pressure_angle) <= 0.0:
            limit = math.pi / 4.0 / math.tan(pressure_angle)
            what = f"dedendum_coefficient = {self.dedendum_coefficient:.6g}"
            why = f"The flanks of the rack meet at a depth of {limit:.6g} modules"
            remedy = "Reduce the dedendum or the pressure angle"
            return [Problem(what, Argument("rack"), why, remedy)]
        height = self.fitting_tip_radius_coefficient(pressure_angle) * (
            1.0 - math.sin(pressure_angle)
        )
        if height <= self.dedendum_coefficient:
            return []
        return [
            Problem(
                what=f"tip_radius_coefficient = {self.tip_radius_coefficient:.6g}",
                where=Argument("rack"),
                why=f"The tip round is {height:.6g} modules high, more than the dedendum "
                f"of {self.dedendum_coefficient:.6g} modules",
                remedy="Reduce the tip radius",
            )
        ]


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
    quantity = f"{float(value) * factor:.6g} {symbol}".rstrip() if number else repr(value)
    bound = f"{'greater than' if open_low else 'at least'} {low * factor:g}"
    if high < math.inf:
        bound += f" and at most {high * factor:g}"
    why = f"{name} must be finite, {bound} {symbol}".rstrip()
    return [Problem(f"{name} = {quantity}", Argument(name), why, "Check the value and its unit")]


def _teeth_problems(teeth: int) -> list[Problem]:
    problems = range_problems("teeth", teeth, 5, 500, unit=PURE)
    if problems or teeth == int(teeth):
        return problems
    why = "A gear has a whole number of teeth"
    return [Problem(f"teeth = {teeth:g}", Argument("teeth"), why, f"Use {math.floor(teeth + 0.5)}")]


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
        radius : float [m]
            As for :meth:`roll_angle`.

        Returns
        -------
        float
            Pressure angle [rad].
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
            why = f"The involute begins at the base radius {base * 1e3:.6g} mm"
            remedy = "Use half_tooth for points of the fillet"
            raise InputError(f"radius = {radius * 1e3:.6g} mm", Argument("radius"), why, remedy)
        return math.sqrt(max((radius - base) * (radius + base), 0.0)) / base

    def half_tooth_angle(self, radius: float) -> float:
        """Angle between the tooth axis and the involute flank.

        Parameters
        ----------
        radius : float [m]
            As for :meth:`roll_angle`.

        Returns
        -------
        float
            Half of the angle that the tooth covers [rad]; negative beyond a pointed tip.
        """
        return self.base_half_angle - involute(self.pressure_angle_at(radius))

    def tooth_thickness(self, radius: float) -> float:
        """Tooth thickness along the circle through a point of the involute.

        Parameters
        ----------
        radius : float [m]
            As for :meth:`roll_angle`.

        Returns
        -------
        float
            Arc length [m].
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
