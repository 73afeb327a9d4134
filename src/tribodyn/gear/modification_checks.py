"""Checks of modifications: of each value alone, on its gear, and on the flank that is used."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from tribodyn.errors import Argument, Problem

if TYPE_CHECKING:
    from tribodyn.gear.flank_range import FlankRange
    from tribodyn.gear.modification import FlankModification
    from tribodyn.gear.modification_map import ProfileMap
    from tribodyn.gear.spur_gear import SpurGear
    from tribodyn.gear.spur_pair import SpurPair


#: How a relief may fall to zero.
SHAPES = ("linear", "parabolic")
#: Amount of a modification or deviation beyond which a unit is wrong [m].
LARGEST_AMOUNT = 0.5e-3
#: Run-out beyond which a unit is wrong [m].
LARGEST_RUN_OUT = 1e-3

#: Sum of the single pitch deviations round a gear that is rounding of their figures [m].
_CLOSURE = 1e-6
#: Part of the used flank by which a length or a map may miss it.
_SLACK = 1e-6

_FROM_ZERO = ("tip_relief", "root_relief", "wear_depth")
_SIGNED = ("profile_crowning", "profile_slope", "crowning", "lead_slope")
_PITCHES = ("single_pitch_deviation", "cumulative_pitch_deviation")


def _amount(name: str, value: object, low: float, high: float) -> list[Problem]:
    """One problem for the first value that is no number between the limits."""
    for item in value if isinstance(value, tuple) else (value,):
        number = isinstance(item, (int, float))
        if number and math.isfinite(item) and low <= item <= high:
            continue
        shown = f"{item * 1e6:.6g} um" if number else repr(item)
        limits = f"from {low * 1e6:g} to {high * 1e6:g} um"
        why = f"{name} must be finite and {limits}"
        return [Problem(f"{name} = {shown}", Argument(name), why, "Check value and unit")]
    return []


def _relief_problems(given: FlankModification) -> list[Problem]:
    problems = []
    for name in ("tip_relief", "root_relief"):
        length, shape = getattr(given, f"{name}_length"), getattr(given, f"{name}_shape")
        if length is not None and not (math.isfinite(length) and length > 0.0):
            what, where = f"{name}_length = {length * 1e3:.6g} mm", Argument(f"{name}_length")
            why = "A length is finite and greater than zero"
            problems.append(Problem(what, where, why, f"Set {name} to zero for no relief"))
        if shape not in SHAPES:
            what, where = f'{name}_shape = "{shape}"', Argument(f"{name}_shape")
            why = f"Allowed: {', '.join(SHAPES)}"
            problems.append(Problem(what, where, why, "Choose one of these"))
    return problems


def _pitch_problems(given: FlankModification) -> list[Problem]:
    single, cumulative = given.single_pitch_deviation, given.cumulative_pitch_deviation
    if single and cumulative:
        what = "single_pitch_deviation and cumulative_pitch_deviation are both given"
        why = "They are two ways of saying the same thing"
        return [Problem(what, Argument("single_pitch_deviation"), why, "Keep one of them")]
    if abs(sum(single)) <= _CLOSURE:
        return []
    return [
        Problem(
            what=f"the single pitch deviations sum to {sum(single) * 1e6:.6g} um",
            where=Argument("single_pitch_deviation"),
            why="Round the gear all pitches together make one turn, so that they sum to zero",
            remedy="Subtract their mean, or give cumulative_pitch_deviation",
        )
    ]


def modification_value_problems(given: FlankModification) -> list[Problem]:
    """Find the values of a modification that are out of range."""
    problems = []
    for name in _FROM_ZERO:
        problems += _amount(name, getattr(given, name), 0.0, LARGEST_AMOUNT)
    for name in (*_SIGNED, *_PITCHES):
        problems += _amount(name, getattr(given, name), -LARGEST_AMOUNT, LARGEST_AMOUNT)
    problems += _amount("run_out", given.run_out, 0.0, LARGEST_RUN_OUT)
    if not math.isfinite(given.run_out_phase):
        what, why = f"run_out_phase = {given.run_out_phase}", "An angle is finite"
        problems.append(Problem(what, Argument("run_out_phase"), why, "Give it in radians"))
    problems += _relief_problems(given)
    return problems or _pitch_problems(given)


def modification_gear_problems(given: FlankModification, teeth: int) -> list[Problem]:
    """Find what does not belong to a gear of this number of teeth."""
    return [
        Problem(
            what=f"{name} has {len(getattr(given, name))} entries",
            where=Argument(f"modification.{name}"),
            why=f"The gear has {teeth} teeth, and each tooth has its own",
            remedy=f"Give {teeth} values",
        )
        for name in _PITCHES
        if getattr(given, name) and len(getattr(given, name)) != teeth
    ]


def _length_problems(name: str, given: FlankModification, flank: FlankRange) -> list[Problem]:
    problems = []
    for end in ("tip_relief", "root_relief"):
        length = getattr(given, f"{end}_length")
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
        needed, found = (f"{a * 1e3:.6g} to {b * 1e3:.6g} mm" for a, b in (flank, (low, high)))
        what = f"the profile map of the {name} covers the roll lengths {found}"
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


def misalignment_problems(misalignment: float) -> list[Problem]:
    """Find whether a misalignment is out of range."""
    return _amount("misalignment", misalignment, -LARGEST_AMOUNT, LARGEST_AMOUNT)


def modification_pair_problems(pair: SpurPair) -> list[Problem]:
    """Find modifications that do not fit the flanks that a pair uses."""
    from tribodyn.gear.flank_range import flank_ranges

    problems = misalignment_problems(pair.misalignment)
    names, gears = ("pinion", "wheel"), (pair.pinion, pair.wheel)
    for name, gear, flank in zip(names, gears, flank_ranges(pair), strict=True):
        problems += _length_problems(name, gear.modification, flank)
        chart = gear.modification.profile_map
        if chart is not None:
            problems += _map_problems(name, chart, gear, flank, pair.common_face_width)
    return problems
