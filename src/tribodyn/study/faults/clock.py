"""Whether a case with faults moves on one clock or over phases, and what its motion costs."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property, partial
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from tribodyn.faults import Fault, ShaftExcitation, Waviness, clock_cycles, turns_of
from tribodyn.faults.driven import repeats_after
from tribodyn.faults.excitation import Shaft
from tribodyn.machine.graph.clock import Clock, Phases, clock_of, phases_of
from tribodyn.machine.mesh import Turn
from tribodyn.nomenclature import GEARS
from tribodyn.study.faults.machine_section import faults_of_mesh, shaft_excitation
from tribodyn.study.faults.turning import refuse_long_period
from tribodyn.study.machine.first_look import (
    ClockCost,
    PhaseCost,
    clock_cost,
    cost_over_phases,
    over_phases,
    periods_of_turns,
    phase_cost_of,
    refuse_memory,
    repeats_late,
    warn_of_motion,
)
from tribodyn.study.machine.motion import Unit, unit_of

if TYPE_CHECKING:
    from tribodyn.dynamics.harmonic.phase_grid import Work
    from tribodyn.machine import Machine
    from tribodyn.study.case.pair import PairCase
    from tribodyn.study.machine.case import MachineCase

#: Mesh cycles of the longest motion: beyond it the samples need more memory than a notebook has.
MOST_CYCLES = 6000
#: Seconds of one core: at least, for each mesh cycle of the motion, and of the teeth whose contacts
#: are lines, slices of the face, or slices of helical teeth; finite elements of a cracked tooth in
#: the plane and in space.
_LEAST, _MOTION, _TEETH, _CRACK = 0.1, 6.5e-3, (5e-4, 0.04, 0.095), (3.5, 6.5)
#: Mesh cycles of a period that is taken as one clock, with a line at each of its orders.
_SHORT = 100
#: Points of a mesh cycle of a motion over phases.
MESH_POINTS = 128
#: Memory that the motion of a pair may take [byte].
_MEMORY = 4e9
_SHORTER = (
    'Set solver.phases = "auto", which needs no period, or give faults of one gear of the mesh only'
)


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
        Processor time of a motion over the period, once all is compiled, within a factor of two.
    phases : PhaseCost, optional
        What the motion over phases takes, where the period is so long that it is found over them.
    """

    cycles: int
    period: float
    turns_pinion: float
    turns_wheel: float
    cost: float
    phases: PhaseCost | None = None

    def __str__(self) -> str:
        """One line."""
        text = (
            f"{self.cycles} mesh cycles, {self.turns_pinion:.6g} turns of the pinion and "
            f"{self.turns_wheel:.6g} of the wheel, {self.period:.4g} s"
        )
        cost = f"; about {self.cost:.1g} s of computation"
        return f"{text}{cost}" if self.phases is None else f"{text}. {self.phases}"


def varies_over_turns(case: PairCase) -> bool:
    """Whether teeth of a gear differ, or torques or speeds vary over the turns."""
    pair = case.spur_pair
    return case.faults is not None or (pair is not None and pair.teeth_differ)


def turning_clock(case: PairCase) -> TurningClock:
    """Find the period of the motion with the faults of a case, without computing anything.

    Parameters
    ----------
    case : PairCase
        Of a cylindrical or hypoid pair, with its faults.

    Returns
    -------
    TurningClock

    Raises
    ------
    InputError
        If the gears are those of a table.
    ComputationError
        If the motion takes more memory than 4 GB.

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
    return PairTurns.of(case).clock()


@dataclass(frozen=True)
class PairTurns:
    """What turns with the gears of a pair, and what drives them."""

    case: PairCase
    teeth: dict[str, int]  #: of pinion and wheel
    faults: tuple[Fault, ...]  #: of teeth that differ
    waves: tuple[Turn, ...]  #: errors that all teeth share
    excited: tuple[ShaftExcitation, ...]

    @classmethod
    def of(cls, case: PairCase) -> PairTurns:
        """Divide the faults of a case."""
        from tribodyn.study.faults.section import excitations, gear_faults, require_teeth

        require_teeth(case)
        teeth = {name: abs(gear.teeth) for name, gear in case.gears.by_name.items()}
        waves, others = split_waves(gear_faults(case).values())
        turns = tuple(turn_of(wave, teeth[wave.gear], wave.gear) for wave in waves)
        return cls(case, teeth, tuple(others), turns, tuple(excitations(case).values()))

    @cached_property
    def vary(self) -> bool:
        """Whether teeth differ or the drive is unsteady; a damaged bearing changes neither."""
        pair = self.case.spur_pair
        differ = pair is not None and pair.teeth_differ
        return differ or bool(self.faults or self.waves or self.excited)

    @cached_property
    def period(self) -> int:
        """Mesh cycles after which the teeth that differ repeat."""
        pair = self.case.spur_pair
        if pair is not None:
            return turns_of(pair, self.faults)
        return math.lcm(*(self.teeth[fault.gear] for fault in self.faults))

    @cached_property
    def of_pinion(self) -> Clock:
        """Mesh cycles in turns of the pinion that are turns of the wheel as well."""
        ratio = Fraction(self.teeth["pinion"], self.teeth["wheel"])
        cycles, turns = Fraction(self.teeth["pinion"]), {"pinion": Fraction(1), "wheel": ratio}
        clock = clock_of({"mesh": cycles}, turns, self.case.pinion_speed / (2.0 * math.pi))
        return clock.with_whole_periods({"mesh": self.period})

    @property
    def rates(self) -> list[Fraction]:
        """Cycles of the waves in a period of the clock."""
        return [self.of_pinion.cycles["mesh"] * turn.waves for turn in self.waves]

    @property
    def driven_rates(self) -> list[Fraction]:
        """Cycles of the excitations in a period of the clock."""
        return [rate_of(self.of_pinion, each) for each in self.excited]

    def speed(self, gear: str) -> float:
        """Turns of a gear per second."""
        return float(self.of_pinion.turns[gear]) * self.of_pinion.frequency

    def phases(self, *, together: bool = False) -> Phases:
        """Phases of the mesh, of what turns with it and what drives it; or one of all gears."""
        periods, driven = {"mesh": self.period}, () if together else self.driven_rates
        return phases_of(self.of_pinion, periods, self.rates, driven, together=together)

    @property
    def cycles_of_mesh(self) -> tuple[int, ...]:
        """Mesh cycles over each phase."""
        return tuple(self.period * cycles for cycles in self.phases().cycles["mesh"])

    @cached_property
    def cycles(self) -> int:
        """Mesh cycles after which all repeats."""
        of_teeth = self.phases(together=True).cycles["mesh"][0] * self.period
        frequency = self.speed("pinion") * self.teeth["pinion"]
        return clock_cycles(of_teeth, self.excited, self.teeth, frequency)

    @property
    def seconds(self) -> float:
        """Time after which all repeats [s]."""
        # Cycles that last as long as a random load do so to the last digit.
        period = self.cycles / (self.speed("pinion") * self.teeth["pinion"])
        return max((period, *(each._duration for each in self.excited)))

    def clock(self) -> TurningClock:
        """Period after which all repeats, and how the motion is found."""
        pinion, wheel = (self.cycles / self.teeth[gear] for gear in GEARS)
        cost, phases = _LEAST + self.cycles * _MOTION, None
        if self.cycles > _SHORT and len(self.phases().frequency) > 1:
            phases = self._phase_cost()
            if self.cycles <= MOST_CYCLES and (cost <= phases.time or phases.memory > _MEMORY):
                phases = None
        if phases is None:
            remedy = (
                "Give faults of one gear, orders that repeat after fewer turns, or a random load "
                f"of a shorter duration ({self.period} mesh cycles are those of the teeth)"
            )
            refuse_long_period(self.cycles, self.seconds, MOST_CYCLES, remedy)
        else:
            refuse_memory(phases, _MEMORY, "faults", "Give fewer faults, or a shorter random load")
            cost = phases.time
        cost += time_of_teeth(self.case, self.faults)
        return TurningClock(self.cycles, self.seconds, pinion, wheel, cost, phases)

    def _phase_cost(self) -> PhaseCost:
        """What a motion over phases takes."""
        phases, (follower, highest) = self.phases(), self._followed
        names = self._names(phases)
        return cost_over_phases(phases, names, [follower], highest, MESH_POINTS)

    @cached_property
    def _followed(self) -> tuple[tuple[Any, ...], Any]:
        """What the mesh follows, and the highest orders of what drives it."""
        phases = self.phases()
        turns = tuple(phases.turns[rate] for rate in self.rates)
        follower = 1, phases.cycles["mesh"], self.period, turns
        return follower, highest_orders(self.of_pinion, self.excited, phases)

    def points(self, mesh: int) -> tuple[int, ...]:
        """Points over each phase, with so many over a mesh cycle."""
        from tribodyn.dynamics.harmonic.phase_grid import Follower, given_points

        follower, highest = self._followed
        return given_points(Follower(*follower), highest, mesh)

    def units(self, *, together: bool = False) -> tuple[Unit, ...]:
        """Gear that turns with each phase."""
        phases, clock = self.phases(together=together), self.of_pinion
        units = []
        for axis, frequency in enumerate(phases.frequency):
            rates = {gear: float(clock.turns[gear]) for gear in GEARS}
            alone = phases.cycles["mesh"][axis] and self.period == 1 and not together
            unit = unit_of({} if alone else rates, frequency / clock.frequency)
            random = any(
                not each._turns and phases.driven[rate_of(clock, each)][axis]
                for each in (() if together else self.excited)
            )
            units.append(Unit("random load", Fraction(1)) if random else unit)
        return tuple(units)

    def _names(self, phases: Phases) -> list[str]:
        """What turns with each phase."""
        names = []
        for unit, cycles in zip(self.units(), phases.cycles["mesh"], strict=True):
            names.append(f"mesh over {unit.part}" if cycles and unit.name else unit.part or "mesh")
        return names


def time_of_teeth(case: PairCase, faults: Sequence[Fault]) -> float:
    """Seconds of the contacts of teeth that differ."""
    from tribodyn.faults import Crack

    pair = case.spur_pair
    if pair is None or not (faults or pair.teeth_differ):
        return 0.0
    over_face = pair.has_lead_modification
    over_face |= any(fault._varies_over_face for fault in faults)
    in_space = case.stiffness.model == "fe3d"
    kind = 2 if pair.helix_angle or in_space else 1 if over_face else 0
    cracks = sum(isinstance(each, Crack) and each.depth > 0.0 for each in faults)
    return turns_of(pair, faults) * _TEETH[kind] + cracks * _CRACK[in_space]


class FaultyTeeth(NamedTuple):
    """Faults of a mesh: what differs from tooth to tooth, and waves that turn with the gears."""

    others: list[Fault]
    turns: list[Turn]

    @classmethod
    def of(cls, case: MachineCase, machine: Machine, mesh: str) -> FaultyTeeth:
        """Faults of a mesh."""
        waves, others = split_waves(faults_of_mesh(case, machine, mesh))
        teeth = teeth_of(case, machine, mesh)
        names = dict(zip(GEARS, case._pinion_and_wheel(mesh), strict=True))
        turns = [
            turn_of(wave, teeth[wave.gear], names[wave.gear]) for wave in waves if wave.amplitude
        ]
        return cls(others, turns)


def split_waves(faults: Iterable[Fault]) -> tuple[list[Waviness], list[Fault]]:
    """Waves that all teeth share, and the other faults."""
    waves: list[Waviness] = []
    others: list[Fault] = []
    for each in faults:
        if isinstance(each, Waviness) and not each.lead_angle:
            waves.append(each)
        else:
            others.append(each)
    return waves, others


def turn_of(wave: Waviness, teeth: int, gear: str) -> Turn:
    """A wave as an error that turns with its gear."""
    return Turn(
        lambda phase: wave._gap_after(phase / wave.order), Fraction(wave.order, teeth), gear
    )


def teeth_of(case: MachineCase, machine: Machine, mesh: str) -> dict[str, int]:
    """Teeth of both gears of a mesh, as its pair names them."""
    names = dict(zip(GEARS, case._pinion_and_wheel(mesh), strict=True))
    return {role: abs(machine.gears[gear].teeth) for role, gear in names.items()}


def _with_turns(case: MachineCase, machine: Machine) -> Machine:
    """The machine with the periods of its faulty meshes, whose teeth are not computed."""
    meshes = {}
    for name, mesh in machine.meshes.items():
        faulty, teeth = FaultyTeeth.of(case, machine, name), None
        if name in case.meshes_with_teeth:
            teeth = case.pair(name, case.operating_point).spur_pair
        differ = [teeth_of(case, machine, name)[each.gear] for each in faulty.others]
        period = math.lcm(*differ) if teeth is None else turns_of(teeth, faulty.others)
        meshes[name] = replace(mesh, period=period, turning=tuple(faulty.turns))
    return machine._with(meshes=meshes)


def excitations_of(case: MachineCase) -> list[ShaftExcitation]:
    """Torques and speeds of shafts that vary."""
    return [shaft_excitation(fault) for fault in case.faults.values() if fault.shaft]


def repeats_of(clock: Clock, each: ShaftExcitation) -> tuple[Fraction, float]:
    """Turns of its shaft, and time, after which an excitation repeats [s]."""
    return repeats_after(each, float(clock.turns[each.gear]) * clock.frequency)


def rate_of(clock: Clock, each: ShaftExcitation) -> Fraction:
    """Rate at which an excitation repeats: times in a period of the clock."""
    turns, period = repeats_of(clock, each)
    if each._turns:
        return clock.turns[each.gear] / turns
    return Fraction(1.0 / (period * clock.frequency))


def highest_orders(clock: Clock, excited: Sequence[ShaftExcitation], phases: Phases) -> Any:
    """Highest order of the excitations over each phase."""
    orders = [
        (len(each._torque(Shaft(*repeats_of(clock, each), 0.0))) - 1)
        * np.abs(phases.driven[rate_of(clock, each)])
        for each in excited
    ]
    return np.max(orders, axis=0) if orders else 0


def phases_with_faults(machine: Machine, excited: Sequence[ShaftExcitation]) -> Phases:
    """Phases of the meshes of a machine, of what turns with its gears, and of its excitations."""
    return machine.phases_with([rate_of(machine.clock, each) for each in excited])


def faults_over_phases(case: MachineCase, machine: Machine) -> bool:
    """Whether the motion with faults is found over phases: where its period is long."""
    if case.solver.phases == "off":
        return False
    if over_phases(case.solver, machine):
        return True
    excited, turned = excitations_of(case), _with_turns(case, machine)
    phases = phases_with_faults(turned, excited)
    several = len(phases.frequency) > 1
    if not several or case.solver.phases == "on":
        return several
    cycles, highest = _cycles(turned, excited), highest_orders(turned.clock, excited, phases)
    return repeats_late(turned, phases, cycles, highest)


def _cycles(turned: Machine, excited: Sequence[ShaftExcitation]) -> int:
    """Cycles of the fastest mesh after which a machine and what drives it repeat."""
    longer, clock = periods_of_turns(turned), turned.clock
    fastest = max(clock.cycles.values())
    teeth = {n: Fraction(fastest) / turns for n, turns in clock.turns.items() if turns}
    return clock_cycles(longer * fastest, excited, teeth, fastest * clock.frequency)


def fault_cost(
    case: MachineCase, machine: Machine, work: Work | None = None
) -> PhaseCost | ClockCost | None:
    """Cost of the motion with faults; None where it is that without them. Refuse too much."""
    return _cost_within(case.solver.memory, case, machine, work)


def _cost_within(
    memory: float, case: MachineCase, machine: Machine, work: Work | None = None
) -> PhaseCost | ClockCost | None:
    """Cost as of :func:`fault_cost` with so much memory [byte]."""
    turned, excited = _with_turns(case, machine), excitations_of(case)
    if not faults_over_phases(case, machine):
        loose = any(fault.kind == "looseness" for fault in case.faults.values())
        differ = any(mesh.turning or mesh.period > 1 for mesh in turned.meshes.values())
        if not (loose or differ or excited):
            return None
        cycles = _cycles(turned, excited)
        cost = clock_cost(turned, memory, cycles, work.size if work else 0)
        refuse_long_period(cycles, cost.period, MOST_CYCLES, _SHORTER)
        return cost
    phases = phases_with_faults(turned, excited)
    highest = highest_orders(turned.clock, excited, phases)
    shafts = [each.gear for each in excited]
    fewer = partial(_fewer_faults, case, machine, work)
    return phase_cost_of(memory, turned, (phases, shafts), highest, work, fewer)


def _fewer_faults(case: MachineCase, machine: Machine, work: Work | None) -> str:
    """Faults without which the motion takes little enough memory; empty if there are none."""
    remaining, removed, memory = case, [], math.inf
    while remaining.faults and memory > case.solver.memory:
        tried = {name: remaining.replace({f"faults.{name}": None}) for name in remaining.faults}
        costs = {name: _cost_within(math.inf, each, machine, work) for name, each in tried.items()}
        sizes = {name: 0.0 if cost is None else cost.memory for name, cost in costs.items()}
        removed.append(min(sizes, key=lambda each: sizes[each]))
        remaining, memory = tried[removed[-1]], sizes[removed[-1]]
    if memory > case.solver.memory:
        return ""
    takes = f"it takes about {1e-9 * memory:.3g} GB" if memory else "it repeats on one clock"
    return f"without {' and '.join(removed)} {takes}"


def check_motion(
    case: MachineCase, work: Work | None = None, faulty_work: Work | None = None, teeth: float = 0.0
) -> list[str]:
    """What the motions of a machine cost, and its faulty teeth [s]; refuse what takes too much."""
    machine = case.machine()
    sound = warn_of_motion(case.solver, machine, work)
    faulty = fault_cost(case, machine, faulty_work) if case.faults else None
    texts = [] if sound is None else [f"Under each load: {sound}."]
    if faulty is None:
        return texts
    of_teeth = f"; its teeth take about {teeth:.2g} s" if teeth > 0.0 else ""
    return [*texts, f"With its faults, at the operating point alone: {faulty}{of_teeth}."]
