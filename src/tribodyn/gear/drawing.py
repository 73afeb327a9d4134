"""What a drawing says of one gear of a pair, before its missing figures are found."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

from tribodyn.errors import Argument, InputError, Problem
from tribodyn.gear.modification import FlankModification
from tribodyn.gear.modification_checks import modification_gear_problems
from tribodyn.gear.rack import BasicRack
from tribodyn.gear.spur_gear import SpurGear
from tribodyn.gear.tooth_form import ToothForm
from tribodyn.gear.value_checks import body_value_problems

#: Stands in for a tip diameter that is not known yet; any positive value will do.
_UNKNOWN_TIP = 1.0
_SHARED = ("normal_module", "normal_pressure_angle")


@dataclass(frozen=True, kw_only=True)
class GearDrawing:
    """Figures of one gear; ``None`` is what was not given."""

    name: str  #: ``"pinion"`` or ``"wheel"``, the prefix of argument names in messages
    teeth: int  #: number of teeth
    normal_module: float  #: module [m]
    normal_pressure_angle: float  #: pressure angle of the rack [rad]
    profile_shift_coefficient: float  #: profile shift over the module
    rack: BasicRack  #: generating profile
    tip_diameter: float | None  #: tip diameter [m]
    tooth_thinning: float | None  #: reduction of the tooth thickness along the base circle [m]
    face_width: float  #: width of the toothing [m]
    bore_diameter: float  #: bore diameter [m]
    mass: float | None  #: mass [kg]
    moment_of_inertia: float | None  #: polar moment of inertia [kg*m^2]
    modification: FlankModification  #: what the loaded flanks have that the involute has not

    def tooth_form(self, tip_diameter: float, tooth_thinning: float) -> ToothForm:
        """Tooth form with the figures that were missing."""
        return ToothForm(
            teeth=self.teeth,
            normal_module=self.normal_module,
            normal_pressure_angle=self.normal_pressure_angle,
            profile_shift_coefficient=self.profile_shift_coefficient,
            tip_diameter=tip_diameter,
            tooth_thinning=tooth_thinning,
            rack=self.rack,
        )

    def spur_gear(self, form: ToothForm) -> SpurGear:
        """Gear with the body of the drawing."""
        return SpurGear(
            teeth=form.teeth,
            normal_module=form.normal_module,
            normal_pressure_angle=form.normal_pressure_angle,
            profile_shift_coefficient=form.profile_shift_coefficient,
            tip_diameter=form.tip_diameter,
            tooth_thinning=form.tooth_thinning,
            rack=form.rack,
            face_width=self.face_width,
            bore_diameter=self.bore_diameter,
            mass=self.mass,
            moment_of_inertia=self.moment_of_inertia,
            modification=self.modification,
        )

    def named(self, problems: Iterable[Problem]) -> list[Problem]:
        """Name the gear in the arguments of problems."""
        return [
            replace(problem, where=replace(place, gear=self.name))
            if isinstance(place := problem.where, Argument) and place.name not in _SHARED
            else problem
            for problem in problems
        ]

    def value_problems(self) -> list[Problem]:
        """Find the given values that are out of range."""
        tip = _UNKNOWN_TIP if self.tip_diameter is None else self.tip_diameter
        problems = body_value_problems(
            self.face_width, self.bore_diameter, self.mass, self.moment_of_inertia
        )
        try:
            self.tooth_form(tip, self.tooth_thinning or 0.0)
        except InputError as error:
            problems = [*error.problems, *problems]
        else:
            problems += modification_gear_problems(self.modification, self.teeth)
        return self.named(problems)

    def completed_tip_diameter(self, tip_shortening_coefficient: float) -> float:
        """Tip diameter as given, else that of the rack's addendum."""
        if self.tip_diameter is not None:
            return self.tip_diameter
        addendum = self.rack.addendum_coefficient + self.profile_shift_coefficient
        return self.normal_module * (self.teeth + 2.0 * (addendum - tip_shortening_coefficient))
