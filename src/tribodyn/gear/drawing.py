"""What a drawing says of one gear of a pair, before its missing figures are found."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

from tribodyn.errors import InputError, Problem
from tribodyn.gear.modification import FlankModification
from tribodyn.gear.modification_checks import modification_gear_problems
from tribodyn.gear.rack import BasicRack
from tribodyn.gear.spur_gear import SpurGear
from tribodyn.gear.tooth_form import ToothForm
from tribodyn.gear.value_checks import body_value_problems

__all__ = ["GearDrawing"]

#: Stands in for a tip diameter that is not known yet; any positive value will do.
_UNKNOWN_TIP = 1.0
_SHARED = ("argument normal_module", "argument normal_pressure_angle")


@dataclass(frozen=True, kw_only=True)
class GearDrawing:
    """Figures of one gear; ``None`` is what was not given.

    Parameters
    ----------
    name : str
        ``"pinion"`` or ``"wheel"``, the prefix of argument names in messages.
    teeth : int
        Number of teeth.
    normal_module : float
        Module [m].
    normal_pressure_angle : float
        Pressure angle of the rack [rad].
    profile_shift_coefficient : float
        Profile shift over the module.
    rack : BasicRack
        Generating profile.
    tip_diameter : float or None
        Tip diameter [m].
    tooth_thinning : float or None
        Reduction of the tooth thickness along the base circle [m].
    face_width : float
        Width of the toothing [m].
    bore_diameter : float
        Bore diameter [m].
    mass : float or None
        Mass [kg].
    moment_of_inertia : float or None
        Polar moment of inertia [kg*m^2].
    modification : FlankModification
        What the loaded flanks have that the involute has not.
    """

    name: str
    teeth: int
    normal_module: float
    normal_pressure_angle: float
    profile_shift_coefficient: float
    rack: BasicRack
    tip_diameter: float | None
    tooth_thinning: float | None
    face_width: float
    bore_diameter: float
    mass: float | None
    moment_of_inertia: float | None
    modification: FlankModification

    def tooth_form(self, tip_diameter: float, tooth_thinning: float) -> ToothForm:
        """Tooth form with the figures that were missing.

        Parameters
        ----------
        tip_diameter : float
            Tip diameter [m].
        tooth_thinning : float
            Reduction of the tooth thickness along the base circle [m].

        Returns
        -------
        ToothForm
        """
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
        """Gear with the body of the drawing.

        Parameters
        ----------
        form : ToothForm
            Completed form.

        Returns
        -------
        SpurGear
        """
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
        """Name the gear in the arguments of problems.

        Parameters
        ----------
        problems : iterable of Problem
            Problems of this gear.

        Returns
        -------
        list of Problem
            The same, ``argument teeth`` having become ``argument pinion_teeth``.
        """
        return [
            replace(problem, where=problem.where.replace("argument ", f"argument {self.name}_", 1))
            if problem.where not in _SHARED
            else problem
            for problem in problems
        ]

    def value_problems(self) -> list[Problem]:
        """Find the given values that are out of range.

        Returns
        -------
        list of Problem
            Empty when the form can be computed.
        """
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
        """Tip diameter as given, else that of the rack's addendum.

        Parameters
        ----------
        tip_shortening_coefficient : float
            Shortening k over the module.

        Returns
        -------
        float
            Tip diameter [m], by default d + 2 m (h_aP* + x - k).
        """
        if self.tip_diameter is not None:
            return self.tip_diameter
        addendum = self.rack.addendum_coefficient + self.profile_shift_coefficient
        return self.normal_module * (self.teeth + 2.0 * (addendum - tip_shortening_coefficient))
