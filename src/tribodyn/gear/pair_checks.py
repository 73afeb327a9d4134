"""Reasons why two cylindrical gears cannot run together, or why a modification does not fit."""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import suppress

from tribodyn.errors import Argument, InputError, Problem, warn
from tribodyn.gear.contact_lines import FaceGeometry
from tribodyn.gear.curves import involute
from tribodyn.gear.cylindrical_gear import HANDS, GearData
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
from tribodyn.gear.tooth_form import ToothForm

#: Negative play over the module that printed, hence rounded, shift coefficients may leave.
ROUNDING_TOLERANCE = 0.002
#: Negative play over the module above which the rounding is worth a warning.
ROUNDING_WARNING = 0.0005
#: Part of the used flank by which a length or a map may miss it.
_SLACK = 1e-6


def teeth_problems(pinion: GearData, wheel: GearData) -> list[Problem]:
    """Problems of numbers of teeth that make no pair."""
    what = f"the pinion has {pinion.teeth} teeth, the wheel {wheel.teeth}"
    if pinion.is_ring:
        why = "Only the wheel of a pair may be a ring (negative number of teeth)"
        return [Problem(what, Argument("teeth", "pinion"), why, "Exchange the two gears")]
    if wheel.is_ring and pinion.teeth >= -wheel.teeth:
        why = "The gear inside of a ring has fewer teeth than the ring"
        remedy = f"Reduce the pinion below {-wheel.teeth} teeth, or use a larger ring"
        return [Problem(what, Argument("teeth", "pinion"), why, remedy)]
    if pinion.teeth > abs(wheel.teeth):
        why = "The pinion is the gear with fewer teeth, whichever drives"
        remedy = 'Exchange the two gears and set driver to "wheel" if the larger one drives'
        return [Problem(what, Argument("teeth", "pinion"), why, remedy)]
    return []


def _hand_problems(pinion: GearData, wheel: GearData) -> list[Problem]:
    fitting = mating_hand(pinion.hand, wheel.teeth)
    if not pinion.helix_angle or wheel.hand == fitting:
        return []
    kind, hands = ("an internal", "equal") if wheel.is_ring else ("an external", "opposite")
    what = f"the pinion is {pinion.hand}-handed, the wheel {wheel.hand}-handed"
    why = f"Helical gears of {kind} pair on parallel shafts have {hands} hands"
    return [Problem(what, Argument("hand", "wheel"), why, f'Make the wheel "{fitting}"')]


def mating_hand(hand: str, wheel_teeth: int) -> str:
    """Hand of a wheel that runs with a pinion of this hand on a parallel shaft."""
    return hand if wheel_teeth < 0 or hand not in HANDS else HANDS[1 - HANDS.index(hand)]


def match_problems(pinion: GearData, wheel: GearData, driver: str) -> list[Problem]:
    """Problems of two gears that cannot form a pair."""
    problems = [*teeth_problems(pinion, wheel), *_hand_problems(pinion, wheel)]
    for name, unit, factor in (
        ("normal_module", "mm", 1e3),
        ("normal_pressure_angle", "deg", math.degrees(1.0)),
        ("helix_angle", "deg", math.degrees(1.0)),
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


def _interference(mesh: MeshGeometry) -> Iterator[tuple[bool, Problem]]:
    """Tips that pass the base tangent point of the mate (True), or meet its fillet (False)."""
    for name, mate_name, gear, mate, least in _used_flanks(mesh):
        form = gear.sign * gear.roll_angle(gear.form_radius) * gear.base_radius
        if least >= form - 1e-6 * gear.normal_module:
            continue
        reach = max(mate.sign * (mesh.line_of_action_length - form), 0.0)
        limit = f"{2e3 * math.hypot(mate.base_radius, reach):.6g} mm"
        passed = least < 0.0 and not gear.is_ring
        if passed:
            why = f"It passes the base tangent point of the {name} by {-least * 1e3:.6g} mm"
        else:
            end = "undercut removes flank" if gear.undercut else "fillet reaches"
            used = f"{2e3 * math.hypot(gear.base_radius, least):.6g} mm"
            used = f"up to the diameter {used}" if gear.is_ring else f"from the diameter {used} on"
            why = (
                f"It needs the {name}'s flank {used}, but its {end} "
                f"{'down' if gear.is_ring else 'up'} to {2e3 * gear.form_radius:.6g} mm"
            )
        change, bound = ("Increase", "more") if mate.is_ring else ("Reduce", "less")
        yield (
            passed,
            Problem(
                what=f"interference: the tip diameter of the {mate_name} is "
                f"{mate.tip_diameter * 1e3:.6g} mm",
                where=Argument("tip_diameter", mate_name),
                why=why,
                remedy=f"{change} it to {limit} or {bound}, or shift the {name} outwards",
            ),
        )


def tip_play(mesh: MeshGeometry) -> float:
    """Play along the ring's tip circle where the tips of an internal pair pass each other [m]."""
    # Source: Colbourne, The geometry of involute gears, tip interference of internal gears.
    distance = mesh.center_distance
    inner, outer = mesh.pinion.tip_radius, mesh.wheel.tip_radius
    cosines = (
        (outer**2 - distance**2 - inner**2) / (2.0 * distance * inner),
        (distance**2 + outer**2 - inner**2) / (2.0 * distance * outer),
    )
    if max(map(abs, cosines)) >= 1.0:
        return math.inf
    angles = [
        math.acos(cosine) + involute(gear.pressure_angle_at(gear.tip_radius))
        for cosine, gear in zip(cosines, (mesh.pinion, mesh.wheel), strict=True)
    ]
    working = involute(mesh.operating_pressure_angle)
    turned = (angles[0] - working) / abs(mesh.ratio)
    return outer * (turned - angles[1] + working)


def _tip_interference(mesh: MeshGeometry) -> list[Problem]:
    """The tips of an internal pair must pass each other beyond the path of contact."""
    play = tip_play(mesh)
    if play >= 0.0:
        return []
    pinion, ring = mesh.pinion, mesh.wheel
    return [
        Problem(
            what=f"tip interference: the tips of pinion and ring overlap by {-play * 1e3:.6g} mm "
            "beyond the path of contact",
            where=Argument("teeth", "wheel"),
            why=f"{pinion.teeth} teeth are too many for a ring of {-ring.teeth} with the tip "
            f"diameters {pinion.tip_diameter * 1e3:.6g} and {ring.tip_diameter * 1e3:.6g} mm",
            remedy="Use fewer teeth on the pinion, shorter tips, or a larger profile shift of the "
            "pinion and a smaller one of the ring",
        )
    ]


def _clearance(mesh: MeshGeometry) -> list[Problem]:
    problems = []
    sign = mesh.wheel.sign
    for name, mate_name, gear, mate in (
        ("pinion", "wheel", mesh.pinion, mesh.wheel),
        ("wheel", "pinion", mesh.wheel, mesh.pinion),
    ):
        reach = gear.sign * gear.tip_radius + mate.sign * mate.root_radius
        clearance = sign * mesh.center_distance - reach
        if clearance <= 0.0:
            change = "Increase" if gear.is_ring else "Reduce"
            problems.append(
                Problem(
                    what=f"the bottom clearance at the {name}'s tip is {clearance * 1e3:.6g} mm",
                    where=Argument("tip_diameter", name),
                    why=f"Tip diameter {gear.tip_diameter * 1e3:.6g} mm and the {mate_name}'s root "
                    f"diameter {2e3 * mate.root_radius:.6g} mm overlap at the centre distance "
                    f"{mesh.center_distance * 1e3:.6g} mm",
                    remedy=f"{change} the tip diameter or "
                    f"{'reduce' if sign < 0 else 'increase'} the centre distance",
                )
            )
    return problems


def _contact_ratio(mesh: FaceGeometry) -> list[Problem]:
    ratio, name = mesh.transverse_contact_ratio, "transverse"
    if mesh.helix_angle:
        ratio, name = mesh.total_contact_ratio, f"transverse contact ratio {ratio:.6g} and total"
    if ratio >= 1.0 and mesh.transverse_contact_ratio > 0.0:
        return []
    change = "Reduce the ring's and increase the pinion's tip diameter"
    remedy = "Increase the tip diameters or reduce the centre distance"
    return [
        Problem(
            what=f"{name} contact ratio {ratio:.6g}",
            why="Below 1 the contact is lost between two tooth pairs",
            remedy=change if mesh.is_internal else remedy,
        )
    ]


def fitting_center_distance(mesh: MeshGeometry) -> float | None:
    """Centre distance without play where the teeth interfere at the actual one; None elsewhere."""
    pinion, wheel, module = mesh.pinion, mesh.wheel, mesh.pinion.normal_module
    try:
        if mesh.geometric_backlash >= -ROUNDING_TOLERANCE * module:
            return None
    except InputError:
        if mesh.is_internal:  # The distance is too small there, not too large.
            return None
    with suppress(InputError):
        return zero_backlash_center_distance(
            pinion.teeth + wheel.teeth,
            module,
            pinion.normal_pressure_angle,
            pinion.generating_shift_coefficient + wheel.generating_shift_coefficient,
            pinion.helix_angle,
        )
    return None


def too_close(mesh: MeshGeometry, fitting: float) -> Problem:
    """Problem of interfering flanks, with the centre distance that fits."""
    least, change = ("most", "Reduce") if mesh.is_internal else ("least", "Increase")
    return Problem(
        what=f"the centre distance must be at {least} {fitting * 1e3:.6g} mm for these tooth "
        f"thicknesses; {mesh.center_distance * 1e3:.6g} mm is given and the flanks interfere",
        where=Argument("center_distance"),
        why=f"Both flanks touch at {fitting * 1e3:.6g} mm already",
        remedy=f"{change} the centre distance or reduce a profile shift",
    )


def mesh_problems(mesh: FaceGeometry) -> list[Problem]:
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
        # The fillets of an internal pair are those of other tools: they are only warned of.
        internal = mesh.is_internal
        problems += [fault for passed, fault in _interference(mesh) if passed or not internal]
        problems += _contact_ratio(mesh)
        if mesh.is_internal and not problems:
            problems += _tip_interference(mesh)
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


def _end_relief_problems(name: str, gear: GearData) -> list[Problem]:
    length, half = gear.modification.end_relief_length, 0.5 * gear.face_width
    if length is None or length <= half * (1.0 + _SLACK):
        return []
    what = f"end_relief_length = {length * 1e3:.6g} mm of the {name}"
    why = f"The reliefs of both ends meet beyond half of the face width, {half * 1e3:.6g} mm"
    remedy = "Reduce it, or give crowning"
    return [Problem(what, Argument("modification.end_relief_length", name), why, remedy)]


def map_problems(
    name: str, chart: ProfileMap, gear: GearData, flank: FlankRange, face_width: float
) -> list[Problem]:
    """Problems of a map that does not cover the used flank of its gear."""
    problems, where = [], Argument("modification.profile_map", name)
    low, high = chart.limits(gear.base_radius)
    flank = FlankRange(*sorted(map(abs, flank)))
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


def fit_problems(pair: FaceGeometry) -> list[Problem]:
    """Problems of modifications that do not fit the used flanks."""
    problems = []
    gears = {"pinion": pair.pinion, "wheel": pair.wheel}
    for (name, gear), flank in zip(gears.items(), flank_ranges(pair), strict=True):
        problems += _length_problems(name, gear.modification, flank)
        problems += _end_relief_problems(name, gear)
        chart = gear.modification.profile_map
        if chart is not None:
            problems += map_problems(name, chart, gear, flank, pair.common_face_width)
    return problems


def warn_of_limits(mesh: MeshGeometry) -> None:
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
    for _, fault in _interference(mesh):
        what = fault.what.replace("interference", "contact on a fillet")
        warn("fillet-contact", f"{what}. {fault.why}. {fault.remedy}", stacklevel=4)
    for name, _, gear, _, least in _used_flanks(mesh):
        if gear.undercut and not mesh.is_internal:
            used = math.hypot(gear.base_radius, max(least, 0.0))
            warn(
                "undercut",
                f"the {name} is undercut up to the diameter {2e3 * gear.form_radius:.6g} mm, "
                f"its flank is used from {2e3 * used:.6g} mm on: no contact is lost, but the "
                "root is weaker. A profile shift further outwards avoids it",
                stacklevel=4,
            )
