"""Whether a case with faults moves over whole turns or over phases, and what its motion costs."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from tribodyn.faults import Fault, ShaftExcitation, Waviness, clock_cycles, turns_of
from tribodyn.faults.driven import repeats_after
from tribodyn.faults.excitation import Shaft
from tribodyn.machine.mesh import Turn
from tribodyn.nomenclature import GEARS
from tribodyn.study.faults.machine_section import faults_of_mesh, shaft_excitation
from tribodyn.study.faults.turning import refuse_long_period
from tribodyn.study.machine.first_look import (
    PhaseCost,
    has_clearance,
    over_phases,
    phase_cost_of,
    repeats_late,
    warn_of_motion,
    warn_of_period,
)

if TYPE_CHECKING:
    from tribodyn.machine import Machine
    from tribodyn.machine.graph.clock import Phases
    from tribodyn.study.case.case import Case
    from tribodyn.study.machine.case import MachineCase

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
    from tribodyn.faults import Crack
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


class FaultyTeeth(NamedTuple):
    """Faults of a mesh: waves that all teeth share, and what differs from tooth to tooth."""

    waves: list[Waviness]
    others: list[Fault]
    turns: list[Turn]  #: the waves as errors that turn with the gears

    @classmethod
    def of(cls, case: MachineCase, machine: Machine, mesh: str, *, phases: bool) -> FaultyTeeth:
        """Faults of a mesh; over one clock all of them are of teeth."""
        faults = faults_of_mesh(case, machine, mesh)
        shared = (each for each in faults if isinstance(each, Waviness) and not each.lead_angle)
        waves = [*shared] if phases else []
        teeth = teeth_of(case, machine, mesh)
        names = dict(zip(GEARS, case._pinion_and_wheel(mesh), strict=True))
        turns = [
            Turn(_shape(each), Fraction(each.order, teeth[each.gear]), names[each.gear])
            for each in waves
        ]
        return cls(waves, [each for each in faults if each not in waves], turns)


def _shape(wave: Waviness) -> Any:
    """Error of a wave over its phase."""
    return lambda phase: wave._gap_after(phase / wave.order)


def teeth_of(case: MachineCase, machine: Machine, mesh: str) -> dict[str, int]:
    """Teeth of both gears of a mesh, as its pair names them."""
    names = dict(zip(GEARS, case._pinion_and_wheel(mesh), strict=True))
    return {role: abs(machine.gears[gear].teeth) for role, gear in names.items()}


def _with_turns(case: MachineCase, machine: Machine, *, phases: bool) -> Machine:
    """The machine with the periods of its faulty meshes, whose teeth are not computed."""
    meshes = {}
    for name, mesh in machine.meshes.items():
        faulty, teeth = FaultyTeeth.of(case, machine, name, phases=phases), None
        if name in case.meshes_with_teeth:
            teeth = case.pair(name, case.operating_point).spur_pair
        differ = [teeth_of(case, machine, name)[each.gear] for each in faulty.others]
        period = math.lcm(*differ) if teeth is None else turns_of(teeth, faulty.others)
        meshes[name] = replace(mesh, period=period, turning=tuple(faulty.turns))
    return machine._with(meshes=meshes)


def excitations_of(case: MachineCase) -> list[ShaftExcitation]:
    """Torques and speeds of shafts that vary."""
    return [shaft_excitation(fault) for fault in case.faults.values() if fault.shaft]


def repeats_of(machine: Machine, each: ShaftExcitation) -> tuple[Fraction, float]:
    """Turns of its shaft, and time, after which an excitation repeats [s]."""
    return repeats_after(each, float(machine.clock.turns[each.gear]) * machine.clock.frequency)


def rate_of(machine: Machine, each: ShaftExcitation) -> Fraction:
    """Rate at which an excitation repeats: times in a period of the clock."""
    turns, period = repeats_of(machine, each)
    if each._turns:
        return machine.clock.turns[each.gear] / turns
    return Fraction(1.0 / (period * machine.clock.frequency))


def phases_with_faults(machine: Machine, excited: Sequence[ShaftExcitation]) -> Phases:
    """Phases of the meshes of a machine, of what turns with its gears, and of its excitations."""
    return machine.phases_with([rate_of(machine, each) for each in excited])


def faults_over_phases(case: MachineCase, machine: Machine) -> bool:
    """Whether the motion with faults is found over phases: where its period is long."""
    if case.solver.phases == "off" or has_clearance(machine):
        return False
    if over_phases(case.solver, machine):
        return True
    excited = excitations_of(case)
    turned = _with_turns(case, machine, phases=True)
    several = len(phases_with_faults(turned, excited).frequency) > 1
    if not several or case.solver.phases == "on":
        return several
    clocked = _with_turns(case, machine, phases=False)
    fastest, clock = max(clocked.clock.cycles.values()), clocked.clock
    teeth = {shaft: Fraction(fastest) / turns for shaft, turns in clock.turns.items() if turns}
    return repeats_late(clock_cycles(fastest, excited, teeth, fastest * clock.frequency))


def fault_cost(case: MachineCase, machine: Machine) -> PhaseCost | None:
    """Cost of the motion with faults over phases; None over whole turns. Refuse too much."""
    if not faults_over_phases(case, machine):
        warn_of_period(_with_turns(case, machine, phases=False), case.solver.memory)
        return None
    turned, excited = _with_turns(case, machine, phases=True), excitations_of(case)
    phases = phases_with_faults(turned, excited)
    orders = [
        (len(each._torque(Shaft(*repeats_of(turned, each), 0.0))) - 1)
        * np.abs(phases.driven[rate_of(turned, each)])
        for each in excited
    ]
    highest = np.max(orders, axis=0) if orders else 0
    shafts = [each.gear for each in excited]
    return phase_cost_of(case.solver, turned, (phases, shafts), highest)


def check_motion(case: MachineCase) -> list[str]:
    """What the motions of a machine over phases cost; refuse what takes too much."""
    machine = case.machine()
    sound = warn_of_motion(case.solver, machine)
    faulty = fault_cost(case, machine) if case.faults else None
    texts = [] if sound is None else [f"{sound}."]
    return texts if faulty is None else [*texts, f"With its faults: {faulty}."]
