"""Blank of a hypoid or spiral bevel pair: all of its dimensions after ISO 23509, Method 1."""

from __future__ import annotations

import math
from collections.abc import Mapping

from tribodyn.errors import Argument, InputError, Problem, require_between, require_one_of
from tribodyn.gear.hypoid.dimensions import dimensions
from tribodyn.gear.hypoid.pitch_cones import PitchInput
from tribodyn.gear.mass_properties import MassProperties
from tribodyn.nomenclature import require_number, require_whole
from tribodyn.record import Parts, Record, fact, labels_of, quantity, record
from tribodyn.types import Tree

#: Hands of a pinion; the wheel has the other one.
HANDS = ("left", "right")
#: How the wheel's teeth are cut along their length, and across it.
PROCESSES = ("face-milling", "face-hobbing")
GENERATIONS = ("formate", "generated")


@record
class HypoidBlank(Record):
    """Dimensions of both blanks; made by :func:`hypoid_blank`.

    Places along an axis count from the crossing point, where the common perpendicular of the axes
    meets them, towards the teeth; an apex beyond the crossing point is positive.

    Parameters
    ----------
    teeth_pinion, teeth_wheel : int
        Numbers of teeth.
    hand_pinion : str
        ``"left"`` or ``"right"``; the wheel has the other hand.
    offset : float [m]
        Offset of the pinion; positive with the larger spiral angle on the pinion.
    face_width_pinion, face_width_wheel : float [m]
        Face widths along the pitch cones.
    cutter_radius : float [m]
        Mean radius of the cutter.
    pitch_angle_pinion, pitch_angle_wheel : float [rad]
        Half angles of the pitch cones.
    face_angle_pinion, face_angle_wheel : float [rad]
        Half angles of the tip cones.
    root_angle_pinion, root_angle_wheel : float [rad]
        Half angles of the root cones.
    mean_spiral_angle_pinion, mean_spiral_angle_wheel : float [rad]
        Spiral angles in the calculation point.
    outer_spiral_angle_pinion, outer_spiral_angle_wheel : float [rad]
        At the heel, of a trace that is a circle of the cutter on the crown gear.
    inner_spiral_angle_pinion, inner_spiral_angle_wheel : float [rad]
        At the toe, likewise.
    offset_angle_axial, offset_angle_pitch : float [rad]
        Offset angle of the pinion in the axial plane of the wheel, and in the pitch plane.
    limit_pressure_angle : float [rad]
        Pressure angle at which the contact line does not move over the wheel in the calculation
        point.
    limit_curvature : float [1/m]
        Curvature of the tooth trace that goes with it; that of the cutter.
    normal_pressure_angle_drive, normal_pressure_angle_coast : float [rad]
        Generated pressure angles of drive and coast side.
    mean_normal_module : float [m]
        Module in the normal section of the calculation point.
    mean_cone_distance_pinion, mean_cone_distance_wheel : float [m]
        From the pitch apex to the calculation point.
    outer_cone_distance_pinion, outer_cone_distance_wheel : float [m]
        To the heel.
    inner_cone_distance_pinion, inner_cone_distance_wheel : float [m]
        To the toe.
    mean_pitch_diameter_pinion, mean_pitch_diameter_wheel : float [m]
        Pitch diameters at the calculation point.
    outer_tip_diameter_pinion, outer_tip_diameter_wheel : float [m]
        Diameters of the tip cones at the heel.
    mean_addendum_pinion, mean_addendum_wheel : float [m]
        Across the pitch cone in the calculation point.
    mean_dedendum_pinion, mean_dedendum_wheel : float [m]
        Likewise.
    mean_normal_thickness_pinion, mean_normal_thickness_wheel : float [m]
        Normal circular tooth thickness in the calculation point, less the backlash.
    clearance : float [m]
        Between tip and root.
    calculation_point_pinion, calculation_point_wheel : float [m]
        Place of the calculation point along the axis.
    crown_pinion, crown_wheel : float [m]
        Place of the outer edge of the tip cone along the axis.
    pitch_apex_pinion, pitch_apex_wheel : float [m]
        Apex of the pitch cone beyond the crossing point.
    face_apex_pinion, face_apex_wheel : float [m]
        Apex of the tip cone.
    root_apex_pinion, root_apex_wheel : float [m]
        Apex of the root cone.
    process, wheel_generation : str
        ``"face-milling"`` or ``"face-hobbing"``; ``"formate"`` or ``"generated"``.
    blade_groups : int
        Blade groups of a face-hobbing cutter; zero for face milling.
    shaft_angle : float [rad]
        Angle between the axes.

    Notes
    -----
    Source: ISO 23509, clauses 6 and 7.
    """

    teeth_pinion: int = fact()
    teeth_wheel: int = fact()
    hand_pinion: str = fact()
    offset: float = quantity(unit="m")
    face_width_pinion: float = quantity(unit="m")
    face_width_wheel: float = quantity(unit="m")
    cutter_radius: float = quantity(unit="m")
    pitch_angle_pinion: float = quantity(unit="rad")
    pitch_angle_wheel: float = quantity(unit="rad")
    face_angle_pinion: float = quantity(unit="rad")
    face_angle_wheel: float = quantity(unit="rad")
    root_angle_pinion: float = quantity(unit="rad")
    root_angle_wheel: float = quantity(unit="rad")
    mean_spiral_angle_pinion: float = quantity(unit="rad")
    mean_spiral_angle_wheel: float = quantity(unit="rad")
    outer_spiral_angle_pinion: float = quantity(unit="rad")
    outer_spiral_angle_wheel: float = quantity(unit="rad")
    inner_spiral_angle_pinion: float = quantity(unit="rad")
    inner_spiral_angle_wheel: float = quantity(unit="rad")
    offset_angle_axial: float = quantity(unit="rad")
    offset_angle_pitch: float = quantity(unit="rad")
    limit_pressure_angle: float = quantity(unit="rad")
    limit_curvature: float = quantity(unit="1/m")
    normal_pressure_angle_drive: float = quantity(unit="rad")
    normal_pressure_angle_coast: float = quantity(unit="rad")
    mean_normal_module: float = quantity(unit="m")
    mean_cone_distance_pinion: float = quantity(unit="m")
    mean_cone_distance_wheel: float = quantity(unit="m")
    outer_cone_distance_pinion: float = quantity(unit="m")
    outer_cone_distance_wheel: float = quantity(unit="m")
    inner_cone_distance_pinion: float = quantity(unit="m")
    inner_cone_distance_wheel: float = quantity(unit="m")
    mean_pitch_diameter_pinion: float = quantity(unit="m")
    mean_pitch_diameter_wheel: float = quantity(unit="m")
    outer_tip_diameter_pinion: float = quantity(unit="m")
    outer_tip_diameter_wheel: float = quantity(unit="m")
    mean_addendum_pinion: float = quantity(unit="m")
    mean_addendum_wheel: float = quantity(unit="m")
    mean_dedendum_pinion: float = quantity(unit="m")
    mean_dedendum_wheel: float = quantity(unit="m")
    mean_normal_thickness_pinion: float = quantity(unit="m")
    mean_normal_thickness_wheel: float = quantity(unit="m")
    clearance: float = quantity(unit="m")
    calculation_point_pinion: float = quantity(unit="m")
    calculation_point_wheel: float = quantity(unit="m")
    crown_pinion: float = quantity(unit="m")
    crown_wheel: float = quantity(unit="m")
    pitch_apex_pinion: float = quantity(unit="m")
    pitch_apex_wheel: float = quantity(unit="m")
    face_apex_pinion: float = quantity(unit="m")
    face_apex_wheel: float = quantity(unit="m")
    root_apex_pinion: float = quantity(unit="m")
    root_apex_wheel: float = quantity(unit="m")
    process: str = fact(default="face-milling")
    wheel_generation: str = fact(default="formate")
    blade_groups: int = fact(default=0)
    shaft_angle: float = quantity(unit="rad", default=0.5 * math.pi)

    @property
    def ratio(self) -> float:
        """Teeth of the wheel over those of the pinion."""
        return self.teeth_wheel / self.teeth_pinion

    def __repr__(self) -> str:
        """One line with units."""
        spiral = [self.mean_spiral_angle_pinion, self.mean_spiral_angle_wheel]
        return (
            f"HypoidBlank(z {self.teeth_pinion}/{self.teeth_wheel}, "
            f"offset {self.offset * 1e3:g} mm, m_mn {self.mean_normal_module * 1e3:.4g} mm, "
            f"delta {math.degrees(self.pitch_angle_pinion):.4g}/"
            f"{math.degrees(self.pitch_angle_wheel):.4g} deg, "
            f"beta {math.degrees(spiral[0]):.4g}/{math.degrees(spiral[1]):.4g} deg)"
        )

    def _parts(self) -> Parts:
        """Dimensions are variables with units, not attributes."""
        parts = super()._parts()
        for name, labels in labels_of(type(self)).items():
            if labels.unit:
                value = parts.attributes.pop(name)
                parts.variables[name] = ((), value, self._attributes(name, labels))
        return parts


#: Argument -> least and greatest value, and unit.
RANGES: dict[str, tuple[float, float, str]] = {
    "offset": (-1.0, 1.0, "m"),
    "outer_pitch_diameter_wheel": (1e-3, 10.0, "m"),
    "face_width_wheel": (1e-4, 2.0, "m"),
    "mean_spiral_angle_pinion": (0.0, 1.2, "rad"),
    "cutter_radius": (1e-3, 10.0, "m"),
    "shaft_angle": (math.radians(20.0), math.radians(160.0), "rad"),
    "pressure_angle_drive": (0.1, 0.6, "rad"),
    "pressure_angle_coast": (0.1, 0.6, "rad"),
    "limit_pressure_angle_factor": (0.0, 1.0, ""),
    "addendum_factor_wheel": (0.05, 0.95, ""),
    "depth_factor": (0.5, 3.0, ""),
    "clearance_factor": (0.0, 0.5, ""),
    "thickness_factor": (-0.5, 0.5, ""),
    "outer_backlash": (0.0, 5e-3, "m"),
    "addendum_angle_wheel": (0.0, 0.3, "rad"),
    "dedendum_angle_wheel": (0.0, 0.3, "rad"),
}
_REMEDIES = {"m": "Lengths are in metres: 30 mm is 0.03", "rad": "Angles are in radians"}


def hypoid_blank(
    teeth_pinion: int,
    teeth_wheel: int,
    offset: float,
    outer_pitch_diameter_wheel: float,
    face_width_wheel: float,
    mean_spiral_angle_pinion: float,
    cutter_radius: float,
    *,
    shaft_angle: float = math.radians(90.0),
    pressure_angle_drive: float = math.radians(20.0),
    pressure_angle_coast: float = math.radians(20.0),
    limit_pressure_angle_factor: float = 1.0,
    addendum_factor_wheel: float = 0.3,
    depth_factor: float = 2.0,
    clearance_factor: float = 0.125,
    thickness_factor: float = 0.0,
    outer_backlash: float = 0.0,
    addendum_angle_wheel: float | None = None,
    dedendum_angle_wheel: float | None = None,
    hand_pinion: str = "left",
    process: str = "face-milling",
    wheel_generation: str = "formate",
    blade_groups: int | None = None,
) -> HypoidBlank:
    """Blank of a hypoid or spiral bevel pair.

    Parameters
    ----------
    teeth_pinion, teeth_wheel : int
        Numbers of teeth.
    offset : float
        Offset of the pinion [m]: positive enlarges the pinion, negative makes it smaller; zero
        gives the spiral bevel pair.
    outer_pitch_diameter_wheel : float
        Outer pitch diameter of the wheel [m].
    face_width_wheel : float
        Face width of the wheel [m].
    mean_spiral_angle_pinion : float
        Desired spiral angle of the pinion in the calculation point [rad].
    cutter_radius : float
        Mean radius of the cutter [m].
    shaft_angle : float
        Angle between the axes [rad]: that between their directions from the crossing point to the
        teeth.
    pressure_angle_drive, pressure_angle_coast : float
        Design pressure angles of drive and coast side [rad].
    limit_pressure_angle_factor : float
        Share of the limit pressure angle by which both sides are corrected.
    addendum_factor_wheel : float
        Mean addendum of the wheel over the working depth [-].
    depth_factor : float
        Working depth over the mean normal module.
    clearance_factor : float
        Clearance over the working depth.
    thickness_factor : float
        By how much the pinion's tooth is thicker than half the pitch, over the module.
    outer_backlash : float
        Transverse backlash at the outer pitch diameter of the wheel [m].
    addendum_angle_wheel, dedendum_angle_wheel : float, optional
        Angles between pitch cone and tip and root cone of the wheel [rad]; by default those of the
        standard taper.
    hand_pinion : str
        ``"left"`` or ``"right"``.
    process : str
        ``"face-milling"``, with teeth of standard taper along circles, or ``"face-hobbing"``, with
        teeth of uniform depth along extended epicycloids.
    wheel_generation : str
        ``"formate"`` for a wheel that the cutter forms without rolling, or ``"generated"``.
    blade_groups : int, optional
        Blade groups of a face-hobbing cutter, which needs it.

    Raises
    ------
    InputError
        Listing what is out of range, or telling why no such pair exists.

    Notes
    -----
    The wheel's mean radius is fixed, and the pitch cones are those whose limit curvature is that of
    the trace that the cutter leaves. ISO stops its iteration at 1 % of that, here it is solved to
    the last digit.
    Source: ISO 23509, clauses 6.3.2 and 7, data type II.

    Examples
    --------
    >>> blank = hypoid_blank(13, 42, 15e-3, 170e-3, 30e-3, math.radians(50.0), 63.5e-3,
    ...                      addendum_factor_wheel=0.35)
    >>> blank
    HypoidBlank(z 13/42, offset 15 mm, m_mn 2.64 mm, delta 21.29/68.32 deg, beta 50/38.61 deg)
    >>> round(math.degrees(blank.limit_pressure_angle), 4)
    -2.2535
    """
    arguments = dict(locals())
    hand = require_one_of("hand_pinion", arguments.pop("hand_pinion"), HANDS)
    teeth = _teeth(arguments.pop("teeth_pinion"), arguments.pop("teeth_wheel"))
    cut: Tree = {
        name: require_one_of(name, arguments.pop(name), choices)
        for name, choices in (("process", PROCESSES), ("wheel_generation", GENERATIONS))
    }
    groups = _blade_groups(cut["process"], arguments.pop("blade_groups"), arguments)
    values = _checked(arguments)
    sizes: Tree = {name: values[name] for name in PitchInput._fields if name in values}
    pitch_input = PitchInput(*teeth, blade_groups=groups, **sizes)
    _require_face_fits(pitch_input)
    cut |= dimensions(pitch_input, values)
    return HypoidBlank(hand_pinion=hand, blade_groups=groups, **cut)


def _blade_groups(process: str, groups: int | None, arguments: Mapping[str, object]) -> int:
    """Blade groups of the cutter; zero for face milling."""
    if process == "face-milling":
        if groups is not None:
            what, why = f"blade_groups = {groups} for face milling", "Only face hobbing has them"
            raise InputError(what, Argument("blade_groups"), why, 'Set process = "face-hobbing"')
        return 0
    if groups is None:
        why = "They decide by how much the work turns while one of them cuts"
        remedy = "Give those of the cutter, for example blade_groups = 13"
        raise InputError("blade_groups is missing", Argument("blade_groups"), why, remedy)
    for name in ("addendum_angle_wheel", "dedendum_angle_wheel"):
        if arguments[name]:
            why = "Face hobbing cuts teeth of uniform depth"
            raise InputError(f"{name} is given", Argument(name), why, "Remove it")
    count = require_whole("blade_groups", groups, 3)
    require_between("blade_groups", count, 3, 40)
    return count


def _teeth(pinion: int, wheel: int) -> tuple[int, int]:
    pinion = require_whole("teeth_pinion", pinion, 3)
    wheel = require_whole("teeth_wheel", wheel, 3)
    if not pinion <= wheel <= 500:
        what = f"teeth_wheel = {wheel} with {pinion} teeth of the pinion"
        why = "The wheel has as many teeth as the pinion or more, and at most 500"
        raise InputError(what, Argument("teeth_wheel"), why, "Exchange the two, or correct them")
    return pinion, wheel


def _checked(arguments: dict[str, float | None]) -> dict[str, float]:
    """Values of the arguments that are given, each in its range; all faults in one error."""
    problems: list[Problem] = []
    values: dict[str, float] = {}
    for name, value in arguments.items():
        if value is None and name.endswith("_angle_wheel"):
            continue
        low, high, unit = RANGES[name]
        try:
            values[name] = require_number(name, value)
            require_between(name, values[name], low, high, unit, remedy=_REMEDIES.get(unit, ""))
        except InputError as error:
            problems += error.problems
    if problems:
        raise InputError(problems)
    return values


def _require_face_fits(pitch_input: PitchInput) -> None:
    """A face that reaches the wheel's axis leaves no cone."""
    most = 0.45 * pitch_input.outer_pitch_diameter_wheel
    if pitch_input.face_width_wheel <= most:
        return
    what = f"face_width_wheel = {pitch_input.face_width_wheel * 1e3:.6g} mm"
    why = f"A wheel of this diameter allows at most {most * 1e3:.6g} mm"
    remedy = "Reduce the face width; usual is up to a third of the outer cone distance"
    raise InputError(what, Argument("face_width_wheel"), why, remedy)


def cone_bodies(blank: HypoidBlank, density: float) -> dict[str, MassProperties]:
    """Mass and moments of inertia of both gears, about the middle of the cone."""
    properties = {}
    for gear in ("pinion", "wheel"):
        cone = getattr(blank, f"pitch_angle_{gear}")
        outer, inner = (getattr(blank, f"{end}_cone_distance_{gear}") for end in ("outer", "inner"))
        large, small = outer * math.sin(cone), inner * math.sin(cone)
        height = (outer - inner) * math.cos(cone)
        scale = math.pi * density * height
        mass = scale / 3.0 * (large**2 + large * small + small**2)
        polar = scale / 10.0 * sum(large**k * small ** (4 - k) for k in range(5))
        properties[gear] = MassProperties(mass, polar, 0.5 * polar + mass * height**2 / 12.0)
    return properties
