"""Create a checked gear pair from drawing data, and report all problems at once."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import fields, replace
from typing import NamedTuple

from tribodyn.errors import Argument, InputError, Problem, require_between, require_positive
from tribodyn.gear.contact_lines import FaceGeometry
from tribodyn.gear.cylindrical_gear import CylindricalGear, GearData, shape_problems
from tribodyn.gear.cylindrical_pair import CylindricalPair, SpurPair
from tribodyn.gear.mesh_geometry import (
    MeshGeometry,
    tip_shortening_coefficient,
    zero_backlash_center_distance,
)
from tribodyn.gear.modification import FlankModification
from tribodyn.gear.pair_checks import (
    ROUNDING_WARNING,
    fitting_center_distance,
    match_problems,
    mating_hand,
    mesh_problems,
    misalignment_problems,
    teeth_problems,
)
from tribodyn.gear.tooth_form import BasicRack, transverse_pressure_angle
from tribodyn.types import Tree

#: Placeholder of a tip diameter that is computed later; any positive value.
_UNKNOWN_TIP = 1.0
#: Arguments that both gears have in common.
_SHARED = ("normal_module", "normal_pressure_angle", "helix_angle")


class _Drawing(NamedTuple):
    """Drawing data of one gear before the missing values are computed."""

    name: str  #: ``"pinion"`` or ``"wheel"``
    figures: Tree  #: fields of :class:`GearData`; ``None`` is what was not given

    def data(self, tip_diameter: float = _UNKNOWN_TIP, tooth_thinning: float = 0.0) -> GearData:
        """Gear with the drawing data, and these values for what is missing."""
        missing = {
            name: value
            for name, value in (("tip_diameter", tip_diameter), ("tooth_thinning", tooth_thinning))
            if self.figures[name] is None
        }
        return GearData(**{**self.figures, **missing})

    def named(self, problems: Iterable[Problem]) -> list[Problem]:
        """Name the gear in the arguments of problems."""
        shared = (*_SHARED, "hand") if self.name == "pinion" else _SHARED
        return [
            replace(problem, where=replace(place, gear=self.name))
            if isinstance(place := problem.where, Argument) and place.name not in shared
            else problem
            for problem in problems
        ]

    def problems(self) -> list[Problem]:
        """Problems of values out of range."""
        return self.named(_problems_of(self.data))


def _problems_of(build: Callable[[], object]) -> tuple[Problem, ...]:
    try:
        build()
    except InputError as error:
        return error.problems
    return ()


def _raise_if_any(problems: Iterable[Problem]) -> None:
    distinct = tuple(dict.fromkeys(problems))
    if distinct:
        raise InputError(distinct)


class _Layout(NamedTuple):
    """Drawing data of both gears and of their arrangement."""

    drawings: tuple[_Drawing, _Drawing]
    center_distance: float | None
    backlash: float | None

    def problems(self) -> list[Problem]:
        """Problems of values out of range, and of values that are given twice."""
        problems = [problem for drawing in self.drawings for problem in drawing.problems()]
        problems += self._play_problems()
        if self.center_distance is not None:
            problems += _problems_of(
                lambda: require_positive("center_distance", self.center_distance, "m")
            )
        return problems

    def _play_problems(self) -> list[Problem]:
        """The backlash may be given directly or by tooth thinning, not both."""
        if self.backlash is None:
            return []
        wrong = _problems_of(lambda: require_between("backlash", self.backlash, 0.0, 1.0, "m"))
        return list(wrong) or [
            Problem(
                what=f"backlash = {self.backlash * 1e3:.6g} mm and {name}_tooth_thinning = "
                f"{figures['tooth_thinning'] * 1e3:.6g} mm",
                where=Argument("backlash"),
                why="Both set the play between the flanks",
                remedy="Give one of them",
            )
            for name, figures in self.drawings
            if figures["tooth_thinning"] is not None
        ]

    def mesh(self) -> FaceGeometry:
        """Complete the two gears: centre distance, then tips, then thinning."""
        gears = [drawing.data() for drawing in self.drawings]
        teeth = sum(gear.teeth for gear in gears)
        shifts = sum(gear.profile_shift_coefficient for gear in gears)
        module, angle = gears[0].normal_module, gears[0].normal_pressure_angle
        helix, distance = gears[0].helix_angle, self.center_distance
        if distance is None:
            distance = zero_backlash_center_distance(teeth, module, angle, shifts, helix)
        # Without a pressure angle the distance itself is the fault, and no reason to shorten teeth.
        transverse = transverse_pressure_angle(angle, helix)
        possible = distance > 0.5 * teeth * gears[0].transverse_module * math.cos(transverse)
        shortening = (
            tip_shortening_coefficient(teeth, module, shifts, distance, helix) if possible else 0.0
        )
        tips = [_tip_diameter(gear, shortening) for gear in gears]

        def completed(thinning: float) -> FaceGeometry:
            pinion, wheel = (
                drawing.data(tip, thinning)
                for drawing, tip in zip(self.drawings, tips, strict=True)
            )
            return FaceGeometry(pinion, wheel, distance)

        mesh = completed(0.0)
        return mesh if self.backlash is None else completed(_thinning_for(self.backlash, mesh))


def _tip_diameter(gear: GearData, tip_shortening_coefficient: float) -> float:
    """Tip diameter from the addendum of the rack."""
    addendum = gear.rack.addendum_coefficient + gear.profile_shift_coefficient
    height = 2.0 * gear.sign * (addendum - tip_shortening_coefficient)
    return gear.normal_module * (abs(gear.teeth) / math.cos(gear.helix_angle) + height)


def _thinning_for(backlash: float, mesh: MeshGeometry) -> float:
    """Thinning of each gear for the difference to the play of unthinned teeth."""
    if fitting_center_distance(mesh) is not None:
        return 0.0  # Thinning would only hide that the full teeth interfere.
    play, module = mesh.geometric_backlash, mesh.pinion.normal_module
    if backlash < play - ROUNDING_WARNING * module:
        raise InputError(
            f"backlash = {backlash * 1e3:.6g} mm",
            where=Argument("backlash"),
            why=f"The profile shifts and the centre distance {mesh.center_distance * 1e3:.6g} "
            f"mm leave {play * 1e3:.6g} mm already",
            remedy=_less_play(backlash, mesh),
        )
    return max(0.5 * (backlash - play), 0.0)


def _less_play(backlash: float, mesh: MeshGeometry) -> str:
    """Remedy for a smaller play: a centre distance, if the teeth still reach each other."""
    least = zero_backlash_center_distance(
        mesh.pinion.teeth + mesh.wheel.teeth,
        mesh.pinion.normal_module,
        mesh.pinion.normal_pressure_angle,
        mesh.pinion.profile_shift_coefficient + mesh.wheel.profile_shift_coefficient,
        mesh.helix_angle,
    )
    low, high = least, mesh.center_distance
    while abs(high - low) > 1e-7:
        middle = 0.5 * (low + high)
        wide = replace(mesh, center_distance=middle).geometric_backlash > backlash
        low, high = (low, middle) if wide else (middle, high)
    if mesh.is_internal:
        distance = math.ceil(low * 1e6) / 1e3
        return (
            f"Increase the centre distance to {distance:.7g} mm, or omit the backlash, which gives "
            "that play"
        )
    distance = math.floor(low * 1e6) / 1e3
    reach = mesh.pinion.tip_radius + mesh.wheel.tip_radius
    shorten = f"Reduce the centre distance to {distance:.7g} mm"
    if mesh.center_distance >= reach - mesh.pinion.normal_module:
        return (
            f"{shorten}: at {mesh.center_distance * 1e3:.6g} mm the teeth barely reach each other"
        )
    return f"{shorten}, or omit the backlash, which gives that play"


def _checked(layout: _Layout, driver: str, misalignment: float) -> CylindricalPair:
    """Pair from two drawings, or one error with all problems."""
    _raise_if_any([*layout.problems(), *misalignment_problems(misalignment)])
    pinion, wheel = (drawing.data() for drawing in layout.drawings)
    if pinion.is_ring or wheel.is_ring:
        _raise_if_any(teeth_problems(pinion, wheel))
    mesh = layout.mesh()
    problems = match_problems(mesh.pinion, mesh.wheel, driver)
    fitting = fitting_center_distance(mesh)
    # A centre distance that is too small also spoils the tips: they are looked at where it fits.
    shaped = mesh if fitting is None else layout._replace(center_distance=fitting).mesh()
    for drawing, gear in zip(layout.drawings, (shaped.pinion, shaped.wheel), strict=True):
        problems += drawing.named(shape_problems(gear))
    _raise_if_any([*mesh_problems(mesh), *problems])
    first, second = (
        CylindricalGear(**{field.name: getattr(gear, field.name) for field in fields(gear)})
        for gear in (mesh.pinion, mesh.wheel)
    )
    return CylindricalPair(first, second, mesh.center_distance, driver, misalignment)


def cylindrical_pair(
    *,
    pinion_teeth: int,
    wheel_teeth: int,
    normal_module: float,
    normal_pressure_angle: float,
    helix_angle: float,
    pinion_face_width: float,
    wheel_face_width: float | None = None,
    center_distance: float | None = None,
    pinion_profile_shift_coefficient: float = 0.0,
    wheel_profile_shift_coefficient: float = 0.0,
    pinion_tip_diameter: float | None = None,
    wheel_tip_diameter: float | None = None,
    pinion_bore_diameter: float = 0.0,
    wheel_bore_diameter: float = 0.0,
    pinion_tooth_thinning: float | None = None,
    wheel_tooth_thinning: float | None = None,
    backlash: float | None = None,
    pinion_rack: BasicRack | None = None,
    wheel_rack: BasicRack | None = None,
    pinion_mass: float | None = None,
    wheel_mass: float | None = None,
    pinion_moment_of_inertia: float | None = None,
    wheel_moment_of_inertia: float | None = None,
    pinion_modification: FlankModification | None = None,
    wheel_modification: FlankModification | None = None,
    misalignment: float = 0.0,
    driver: str = "pinion",
    hand: str = "right",
    wheel_hand: str | None = None,
    wheel_rim_diameter: float | None = None,
) -> CylindricalPair:
    """Create a cylindrical gear pair, spur or helical, external or internal, from drawing data.

    Parameters
    ----------
    pinion_teeth, wheel_teeth : int
        Numbers of teeth, 5 to 500; the pinion has the smaller one. A ring as the wheel has a
        negative number of teeth and positive lengths, as on a drawing.
    normal_module : float
        Module [m].
    normal_pressure_angle : float
        Pressure angle of the rack in the normal section [rad], 10 to 30 degrees.
    helix_angle : float
        Helix angle at the reference cylinders [rad], 0 to 60 degrees.
    pinion_face_width, wheel_face_width : float [m]
        Widths of the toothings; that of the pinion by default.
    center_distance : float, optional
        Distance of the axes [m]; by default the one without backlash.
    pinion_profile_shift_coefficient, wheel_profile_shift_coefficient : float
        Profile shift over the module.
    pinion_tip_diameter, wheel_tip_diameter : float, optional
        Tip diameters [m]; by default d + 2 m (h_aP* + x - k) with the tip shortening k, which is
        zero for an internal pair; of a ring d - 2 m (h_aP* + x).
    pinion_bore_diameter, wheel_bore_diameter : float
        Bore diameters [m]; zero for a solid gear.
    pinion_tooth_thinning, wheel_tooth_thinning : float, optional
        Reduction of the tooth thickness along the base circle [m].
    backlash : float, optional
        Total play on the line of action [m], by equal thinning of both gears; by default the
        play that follows from the other figures.
    pinion_rack, wheel_rack : BasicRack, optional
        Generating profiles; :meth:`BasicRack.usual` by default.
    pinion_mass, wheel_mass : float, optional
        Masses [kg] that replace those of the solids.
    pinion_moment_of_inertia, wheel_moment_of_inertia : float, optional
        Polar moments of inertia [kg*m^2] that replace those of the solids.
    pinion_modification, wheel_modification : FlankModification, optional
        Modifications and deviations of the loaded flanks; none by default.
    misalignment : float
        Difference of the gap over the common face width [m].
    driver : str
        Driving gear, ``"pinion"`` or ``"wheel"``.
    hand : str
        Hand of the pinion's helix, ``"right"`` or ``"left"``.
    wheel_hand : str, optional
        Hand of the wheel's helix; by default the one that runs with the pinion: the other hand,
        and the same hand for a ring.
    wheel_rim_diameter : float, optional
        Outer diameter of a ring [m]; by default its rim is 3.5 modules thick.

    Raises
    ------
    InputError
        Listing all faults found: first of the single values, and if these are sound, of the
        shapes of both gears and of their mesh. ``where`` names the argument of this function.

    Warns
    -----
    ModelWarning
        As :class:`CylindricalGear` and :class:`CylindricalPair` do.

    Notes
    -----
    Source: ISO 21771. A negative k (large centre distance) is taken as zero.

    Examples
    --------
    >>> import math
    >>> ring = cylindrical_pair(pinion_teeth=21, wheel_teeth=-72, normal_module=2e-3,
    ...                         normal_pressure_angle=math.radians(20.0),
    ...                         helix_angle=math.radians(15.0), pinion_face_width=25e-3,
    ...                         pinion_profile_shift_coefficient=0.2,
    ...                         wheel_profile_shift_coefficient=-0.1)
    >>> round(ring.wheel.tip_diameter * 1e3, 3), round(ring.transverse_contact_ratio, 4)
    (145.48, 1.7081)
    """
    rack = BasicRack.usual(normal_pressure_angle)
    inputs = locals() | {
        "pinion_rack": pinion_rack or rack,
        "wheel_rack": wheel_rack or rack,
        "wheel_face_width": pinion_face_width if wheel_face_width is None else wheel_face_width,
        "pinion_modification": pinion_modification or FlankModification(),
        "wheel_modification": wheel_modification or FlankModification(),
        "pinion_hand": hand,
        "wheel_hand": mating_hand(hand, wheel_teeth) if wheel_hand is None else wheel_hand,
        "pinion_rim_diameter": None,
    }
    pinion, wheel = (
        {
            field.name: inputs[field.name if field.name in _SHARED else f"{name}_{field.name}"]
            for field in fields(GearData)
        }
        for name in ("pinion", "wheel")
    )
    drawings = _Drawing("pinion", pinion), _Drawing("wheel", wheel)
    return _checked(_Layout(drawings, center_distance, backlash), driver, misalignment)


def spur_pair(
    *,
    pinion_teeth: int,
    wheel_teeth: int,
    normal_module: float,
    normal_pressure_angle: float,
    pinion_face_width: float,
    wheel_face_width: float | None = None,
    center_distance: float | None = None,
    pinion_profile_shift_coefficient: float = 0.0,
    wheel_profile_shift_coefficient: float = 0.0,
    pinion_tip_diameter: float | None = None,
    wheel_tip_diameter: float | None = None,
    pinion_bore_diameter: float = 0.0,
    wheel_bore_diameter: float = 0.0,
    pinion_tooth_thinning: float | None = None,
    wheel_tooth_thinning: float | None = None,
    backlash: float | None = None,
    pinion_rack: BasicRack | None = None,
    wheel_rack: BasicRack | None = None,
    pinion_mass: float | None = None,
    wheel_mass: float | None = None,
    pinion_moment_of_inertia: float | None = None,
    wheel_moment_of_inertia: float | None = None,
    pinion_modification: FlankModification | None = None,
    wheel_modification: FlankModification | None = None,
    misalignment: float = 0.0,
    driver: str = "pinion",
) -> SpurPair:
    """Create a spur gear pair from drawing data.

    Parameters
    ----------
    pinion_teeth, wheel_teeth : int
        Numbers of teeth, 5 to 500; the pinion has the smaller one.
    normal_module : float
        Module [m].
    normal_pressure_angle : float
        Pressure angle of the rack [rad], 10 to 30 degrees.
    pinion_face_width, wheel_face_width : float [m]
        Widths of the toothings; that of the pinion by default.
    center_distance : float, optional
        Distance of the axes [m]; by default the one without backlash.
    pinion_profile_shift_coefficient, wheel_profile_shift_coefficient : float
        Profile shift over the module.
    pinion_tip_diameter, wheel_tip_diameter : float, optional
        Tip diameters [m]; by default d + 2 m (h_aP* + x - k) with the tip shortening k.
    pinion_bore_diameter, wheel_bore_diameter : float
        Bore diameters [m]; zero for a solid gear.
    pinion_tooth_thinning, wheel_tooth_thinning : float, optional
        Reduction of the tooth thickness along the base circle [m].
    backlash : float, optional
        Total play on the line of action [m], by equal thinning of both gears; by default the
        play that follows from the other figures.
    pinion_rack, wheel_rack : BasicRack, optional
        Generating profiles; :meth:`BasicRack.usual` by default.
    pinion_mass, wheel_mass : float, optional
        Masses [kg] that replace those of the solids.
    pinion_moment_of_inertia, wheel_moment_of_inertia : float, optional
        Polar moments of inertia [kg*m^2] that replace those of the solids.
    pinion_modification, wheel_modification : FlankModification, optional
        Modifications and deviations of the loaded flanks; none by default.
    misalignment : float
        Difference of the gap over the common face width [m].
    driver : str
        Driving gear, ``"pinion"`` or ``"wheel"``.

    Raises
    ------
    InputError
        Listing all faults found: first of the single values, and if these are sound, of the
        shapes of both gears and of their mesh. ``where`` names the argument of this function.

    Warns
    -----
    ModelWarning
        As :class:`SpurGear` and :class:`SpurPair` do.

    Notes
    -----
    Source: ISO 21771. A negative k (large centre distance) is taken as zero.

    Examples
    --------
    >>> import math
    >>> pair = spur_pair(pinion_teeth=16, wheel_teeth=24, normal_module=4.5e-3,
    ...                  normal_pressure_angle=math.radians(20.0), center_distance=91.5e-3,
    ...                  pinion_profile_shift_coefficient=0.8635,
    ...                  wheel_profile_shift_coefficient=-0.5103, pinion_face_width=20e-3)
    >>> round(pair.pinion.tip_diameter * 1e3, 3), round(pair.transverse_contact_ratio, 6)
    (88.593, 1.326952)
    """
    return cylindrical_pair(helix_angle=0.0, **locals())
