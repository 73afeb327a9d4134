"""Period after which a case with faults repeats, and what its motion costs, before the run."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

from tribodyn.study.faults.turning import refuse_long_period

if TYPE_CHECKING:
    from tribodyn.study.case.case import Case

#: Mesh cycles of the longest motion: beyond it the samples need more memory than a notebook has.
MOST_CYCLES = 6000
#: Seconds of one core: at least, for each mesh cycle of the motion, and of the teeth whose contacts
#: are lines, slices of the face, or slices of helical teeth; finite elements of a cracked tooth in
#: the plane and in space.
_LEAST, _MOTION, _TEETH, _CRACK = 0.1, 6.5e-3, (5e-4, 0.04, 0.095), (3.5, 6.5)


class TurningClock(NamedTuple):
    """Period of the motion of a case with faults.

    Parameters
    ----------
    cycles : int
        Mesh cycles.
    period : float [s]
        Time.
    turns_pinion, turns_wheel : float
        Turns of both gears.
    cost : float [s]
        Processor time of the motion, once all is compiled, within a factor of two.
    """

    cycles: int
    period: float
    turns_pinion: float
    turns_wheel: float
    cost: float

    def __str__(self) -> str:
        """One line."""
        return (
            f"{self.cycles} mesh cycles, {self.turns_pinion:.6g} turns of the pinion and "
            f"{self.turns_wheel:.6g} of the wheel, {self.period:.4g} s; about "
            f"{self.cost:.1g} s of computation"
        )


def varies_over_turns(case: Case) -> bool:
    """Whether teeth of a gear differ, or torques or speeds vary over the turns."""
    pair = case.spur_pair
    return case.faults is not None or (pair is not None and pair.teeth_differ)


def turning_clock(case: Case) -> TurningClock:
    """Find the period of the motion with the faults of a case, without computing anything.

    Parameters
    ----------
    case : Case
        Of a cylindrical or hypoid pair, with its faults.

    Returns
    -------
    TurningClock

    Raises
    ------
    InputError
        If the gears are those of a table, or the period is too long to be computed.

    Examples
    --------
    >>> import tribodyn
    >>> case = tribodyn.load_case("fzg-roughness").replace({
    ...     "faults.axis.kind": "eccentricity", "faults.axis.gear": "wheel",
    ...     "faults.axis.amplitude": "10 um"})
    >>> clock = turning_clock(case)
    >>> clock.cycles, clock.turns_pinion
    (24, 1.5)
    """
    from tribodyn.faults import Crack, clock_cycles, turns_of
    from tribodyn.study.faults.section import excitations, gear_faults, require_teeth

    require_teeth(case)
    pair = case.spur_pair
    teeth = {name: abs(gear.teeth) for name, gear in case.gears.by_name.items()}
    frequency = case.pinion_speed * teeth["pinion"] / (2.0 * math.pi)
    faults = tuple(gear_faults(case).values())
    of_teeth = (
        turns_of(pair, faults)
        if pair is not None
        else math.lcm(*(teeth[fault.gear] for fault in faults))
    )
    excited = tuple(excitations(case).values())
    cycles = clock_cycles(of_teeth, excited, teeth, frequency)
    # Cycles that last as long as a random load do so to the last digit.
    period = max((cycles / frequency, *(each._duration for each in excited)))
    remedy = (
        "Give faults of one gear, orders that repeat after fewer turns, or a random load of a "
        f"shorter duration ({of_teeth} mesh cycles are those of the teeth)"
    )
    refuse_long_period(cycles, period, MOST_CYCLES, remedy)
    cost = _LEAST + cycles * _MOTION
    if pair is not None:
        over_face = pair.has_lead_modification or any(fault._varies_over_face for fault in faults)
        in_space = case.stiffness.model == "fe3d"
        cost += of_teeth * _TEETH[2 if pair.helix_angle or in_space else 1 if over_face else 0]
        cracks = sum(isinstance(fault, Crack) and fault.depth > 0.0 for fault in faults)
        cost += cracks * _CRACK[in_space]
    turns_pinion, turns_wheel = (cycles / teeth[gear] for gear in ("pinion", "wheel"))
    return TurningClock(cycles, period, turns_pinion, turns_wheel, cost)
