"""Two spur gears in mesh, with checks that they can run and that modifications fit the flanks."""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property
from typing import TypeVar

from tribodyn.errors import Argument, InputError, Problem, warn
from tribodyn.gear.mesh_geometry import (
    FlankRange,
    MeshGeometry,
    flank_ranges,
    zero_backlash_center_distance,
)
from tribodyn.gear.modification import (
    LARGEST_AMOUNT,
    FlankModification,
    ProfileMap,
    amount_problems,
)
from tribodyn.gear.spur_gear import SpurGear
from tribodyn.gear.tooth_form import ToothForm
from tribodyn.types import Array

_Path = TypeVar("_Path", float, Array)
#: Negative play over the module that printed, hence rounded, shift coefficients may leave.
ROUNDING_TOLERANCE = 0.002
#: Negative play over the module above which the rounding is worth a warning.
ROUNDING_WARNING = 0.0005
#: Part of the used flank by which a length or a map may miss it.
_SLACK = 1e-6


@dataclass(frozen=True)
class SpurPair(MeshGeometry):
    """External spur gear pair: two gears, their centre distance, and the driver.

    Parameters
    ----------
    pinion, wheel : SpurGear
        The gear with the smaller or equal number of teeth, and the other, of the same module and
        pressure angle.
    center_distance : float
        Distance of the axes [m].
    driver : str
        ``"pinion"`` or ``"wheel"``.
    misalignment : float
        Difference of the gap over the common face width [m] that the position of the axes makes;
        positive where the gap is wider at positive ``face_position``.

    Raises
    ------
    InputError
        Listing every reason why the two gears cannot run together, or why a modification does not
        fit the flank that is used.

    Warns
    -----
    ModelWarning
        ``undercut`` when a gear is undercut below its used flank, which runs but is weaker;
        ``flank-interference-rounding`` when rounded shift coefficients leave a negative play
        of more than 0.0005 modules.

    Notes
    -----
    Source: ISO 21771, cylindrical gear pairs. Positions on the line of action are called
    ``path``: the distance from the pinion's base tangent point, whichever gear drives.

    Examples
    --------
    >>> import math
    >>> from tribodyn.gear import spur_pair
    >>> pair = spur_pair(pinion_teeth=20, wheel_teeth=30, normal_module=4e-3,
    ...                  normal_pressure_angle=math.radians(20.0), pinion_face_width=50e-3)
    >>> pair
    SpurPair(z 20/30, m 4 mm, a 100 mm, contact ratio 1.605, pinion drives)
    """

    pinion: SpurGear
    wheel: SpurGear
    center_distance: float
    driver: str = "pinion"
    misalignment: float = 0.0

    def __post_init__(self) -> None:
        problems = match_problems(self.pinion, self.wheel, self.driver) or mesh_problems(self)
        problems = problems or [*misalignment_problems(self.misalignment), *_fit_problems(self)]
        if problems:
            raise InputError(problems)
        _warn_of_limits(self)

    def __repr__(self) -> str:
        """One line with units."""
        return (
            f"SpurPair(z {self.pinion.teeth}/{self.wheel.teeth}, "
            f"m {self.pinion.normal_module * 1e3:g} mm, a {self.center_distance * 1e3:g} mm, "
            f"contact ratio {self.transverse_contact_ratio:.4g}, {self.driver} drives)"
        )

    @cached_property
    def driving(self) -> SpurGear:
        """The gear that drives."""
        return self.pinion if self.driver == "pinion" else self.wheel

    def driving_radius(self, path: _Path) -> _Path:
        """Radius of curvature of the driving flank at positions on the line of action [m].

        Parameters
        ----------
        path : float or array
            Distance from the pinion's base tangent point [m].

        Returns
        -------
        float or array
            Distance from the base tangent point of the driving gear [m].
        """
        return path if self.driver == "pinion" else self.line_of_action_length - path

    @property
    def driven_gear(self) -> str:
        """Name of the driven gear."""
        return "wheel" if self.driver == "pinion" else "pinion"

    @cached_property
    def driven(self) -> SpurGear:
        """The gear that is driven."""
        return self.wheel if self.driver == "pinion" else self.pinion

    @cached_property
    def common_face_width(self) -> float:
        """Face width in contact [m]."""
        return min(self.pinion.face_width, self.wheel.face_width)

    @cached_property
    def has_profile_modification(self) -> bool:
        """Whether the gap of a flank changes over its profile."""
        return any(gear.modification.changes_profile for gear in (self.pinion, self.wheel))

    @cached_property
    def has_lead_modification(self) -> bool:
        """Whether the gap changes over the face width."""
        leads = any(gear.modification.changes_lead for gear in (self.pinion, self.wheel))
        return leads or self.misalignment != 0.0

    @cached_property
    def has_pitch_deviation(self) -> bool:
        """Whether tooth pairs differ by pitch deviations."""
        return any(gear.modification.changes_pitch for gear in (self.pinion, self.wheel))

    @cached_property
    def has_run_out(self) -> bool:
        """Whether a gear turns about an axis that is not its own."""
        return any(gear.modification.run_out != 0.0 for gear in (self.pinion, self.wheel))

    @cached_property
    def teeth_differ(self) -> bool:
        """Whether one mesh cycle differs from the next."""
        return any(gear.modification.teeth_differ for gear in (self.pinion, self.wheel))

    @cached_property
    def has_modification(self) -> bool:
        """Whether the flanks differ from ideally placed involutes."""
        shape = self.has_profile_modification or self.has_lead_modification
        return shape or self.teeth_differ


def match_problems(pinion: ToothForm, wheel: ToothForm, driver: str) -> list[Problem]:
    """Problems of two gears that cannot form a pair."""
    problems = []
    if pinion.teeth > wheel.teeth:
        what = f"the pinion has {pinion.teeth} teeth, the wheel {wheel.teeth}"
        why = "The pinion is the gear with fewer teeth, whichever drives"
        remedy = 'Exchange the two gears and set driver to "wheel" if the larger one drives'
        problems.append(Problem(what, Argument("teeth", "pinion"), why, remedy))
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
        what, why = f'driver = "{driver}"', 'One of the two gears drives: "pinion" or "wheel"'
        problems.append(Problem(what, Argument("driver"), why, 'Write "pinion" or "wheel"'))
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
    what = f"transverse contact ratio {ratio:.6g}"
    remedy = "Increase the tip diameters or reduce the centre distance"
    return [Problem(what, why="Below 1 the contact is lost between two tooth pairs", remedy=remedy)]


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
    """Problem of interfering flanks, with the centre distance that fits."""
    return Problem(
        what=f"the centre distance must be at least {fitting * 1e3:.6g} mm for these tooth "
        f"thicknesses; {mesh.center_distance * 1e3:.6g} mm is given and the flanks interfere",
        where=Argument("center_distance"),
        why=f"Both flanks touch at {fitting * 1e3:.6g} mm already",
        remedy="Increase the centre distance or reduce a profile shift",
    )


def mesh_problems(mesh: MeshGeometry) -> list[Problem]:
    """Problems of two gears that cannot run together."""
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


def misalignment_problems(misalignment: float) -> list[Problem]:
    """Problem of a misalignment out of range."""
    return amount_problems("misalignment", misalignment, -LARGEST_AMOUNT, LARGEST_AMOUNT)


def _length_problems(
    name: str, modification: FlankModification, flank: FlankRange
) -> list[Problem]:
    problems = []
    for end in ("tip_relief", "root_relief"):
        length = getattr(modification, f"{end}_length")
        if length is None or length <= flank.length * (1.0 + _SLACK):
            continue
        problems.append(
            Problem(
                what=f"{end}_length = {length * 1e3:.6g} mm of the {name}",
                where=Argument(f"modification.{end}_length", name),
                why=f"The relief is longer than the used flank of {flank.length * 1e3:.6g} mm roll "
                "length, which is the length of the path of contact",
                remedy="Reduce it; without it the relief ends where the number of tooth pairs "
                "changes",
            )
        )
    return problems


def _map_problems(
    name: str, chart: ProfileMap, gear: SpurGear, flank: FlankRange, face_width: float
) -> list[Problem]:
    problems, where = [], Argument("modification.profile_map", name)
    low, high = chart.limits(gear.base_radius)
    slack = _SLACK * flank.length
    if low > flank.lowest + slack or high < flank.highest - slack:
        needed, covered = (f"{a * 1e3:.6g} to {b * 1e3:.6g} mm" for a, b in (flank, (low, high)))
        what = f"the profile map of the {name} covers the roll lengths {covered}"
        diameters = [2e3 * math.hypot(gear.base_radius, radius) for radius in flank]
        why = (
            f"The used flank lies from {needed}, which are the diameters {diameters[0]:.6g} to "
            f"{diameters[1]:.6g} mm, and a map is not extrapolated"
        )
        problems.append(Problem(what, where, why, "Measure over the whole used flank"))
    half, face = 0.5 * face_width, chart.face_position
    if len(face) > 1 and (face[0] > -half + slack or face[-1] < half - slack):
        what = f"the profile map of the {name} covers the face from {face[0] * 1e3:.6g} to "
        what += f"{face[-1] * 1e3:.6g} mm"
        why = f"The face in contact lies from {-half * 1e3:.6g} to {half * 1e3:.6g} mm from its "
        why += "middle, and a map is not extrapolated"
        remedy = "Measure over the whole width, or give a single profile"
        problems.append(Problem(what, where, why, remedy))
    return problems


def _fit_problems(pair: SpurPair) -> list[Problem]:
    """Problems of modifications that do not fit the used flanks."""
    problems = []
    gears = {"pinion": pair.pinion, "wheel": pair.wheel}
    for (name, gear), flank in zip(gears.items(), flank_ranges(pair), strict=True):
        problems += _length_problems(name, gear.modification, flank)
        chart = gear.modification.profile_map
        if chart is not None:
            problems += _map_problems(name, chart, gear, flank, pair.common_face_width)
    return problems


def _warn_of_limits(mesh: MeshGeometry) -> None:
    """Warn of a pair close to a limit."""
    module, play = mesh.pinion.normal_module, mesh.geometric_backlash
    if play < -ROUNDING_WARNING * module:
        warn(
            "flank-interference-rounding",
            f"the play on the line of action is {play * 1e6:.4g} um; down to "
            f"{-ROUNDING_TOLERANCE * module * 1e6:.4g} um it counts as rounding of the shift "
            "coefficients and counts as zero. Give the shifts with more digits",
            stacklevel=4,
        )
    for name, _, gear, _, least in _used_flanks(mesh):
        if gear.undercut:
            used = math.hypot(gear.base_radius, max(least, 0.0))
            warn(
                "undercut",
                f"the {name} is undercut up to the diameter {2e3 * gear.form_radius:.6g} mm, "
                f"its flank is used from {2e3 * used:.6g} mm on: no contact is lost, but the "
                "root is weaker. A profile shift further outwards avoids it",
                stacklevel=4,
            )
