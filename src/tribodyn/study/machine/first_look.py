"""What follows from a machine before anything is computed: speeds, torques, power, frequencies."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

from tribodyn.arrays.memory import machine_memory
from tribodyn.errors import ComputationError, ModelWarning, Problem, warn
from tribodyn.machine.reduction import unreduced_size
from tribodyn.study.case.section import flat_keys
from tribodyn.study.machine.motion import phase_names
from tribodyn.study.machine.pair_cases import TeethUnder, inputs_under, read_teeth, teeth_under
from tribodyn.study.machine.summary import geometry_figures
from tribodyn.study.pipeline.assembly import geometry
from tribodyn.study.pipeline.cautions import (
    MeshWarning,
    case_cautions,
    idle_values,
    teeth_cautions,
    warn_of_meshes,
)
from tribodyn.study.pipeline.preview import operating_figures
from tribodyn.study.pipeline.summary_figures import PARTS
from tribodyn.study.planetary.machine_stages import motion_of_stage

if TYPE_CHECKING:
    from tribodyn.dynamics.harmonic.phase_grid import Fields, Work
    from tribodyn.machine import Machine
    from tribodyn.machine.graph.clock import Phases
    from tribodyn.study.case.pair import PairCase
    from tribodyn.study.machine.case import MachineCase
    from tribodyn.study.machine.read_parts import LoadCase
    from tribodyn.study.machine.tables import SolverTable

#: Mesh cycles of a period above which a warning says what they cost, steps per cycle, and bytes of
#: a step: of each, for each coordinate, contact of teeth that vary, and pair of these contacts.
_LONG_PERIOD, _STEPS, _BYTES = 400, 128, (1e3, 280.0, 3e3, 250.0)
#: Time of a motion on one clock at least, and of a step: of each, for each contact, pair of
#: contacts, and coordinate of a contact and of all [s]; times as much with twice the steps too.
_ONCE, _STEP, _TWICE = 0.05, (1e-5, 7e-6, 7.5e-6, 2.5e-7), 3.0
#: Seconds of a motion for each mesh cycle on one clock and each pair of meshes, which may need
#: finer steps or a second search; over phases at least, and for each point and pair.
_ON_CLOCK, _OVER_PHASES = 1.28e-3, (1.2, 2.5e-4)
#: Coordinates that a large structure has at least after its reduction.
_FEWEST = 60


def over_phases(solver: SolverTable, machine: Machine) -> bool:
    """Whether the motion of a machine is found over independent phases of its meshes."""
    if solver.phases == "off" or len(machine.phases.frequency) == 1:
        return False
    cycles = max(machine.clock.cycles.values())
    return solver.phases == "on" or repeats_late(machine, machine.phases, cycles)


def repeats_late(machine: Machine, phases: Phases, cycles: int, orders: Any = 0) -> bool:
    """Whether so many mesh cycles of a period take longer than these phases."""
    from tribodyn.dynamics.harmonic.phase_grid import first_sizes

    meshes = machine.meshes.values()
    if cycles > _LONG_PERIOD or not any(m.contacts or m.stiffness is None for m in meshes):
        return cycles > _LONG_PERIOD
    followers = [each._replace(contacts=1) for each in machine._followers(phases)]
    least, each = _OVER_PHASES
    over_phases = least + each * len(meshes) * sum(first_sizes(followers, orders))
    return _ON_CLOCK * cycles * len(meshes) ** 2 > over_phases


class PhaseCost(NamedTuple):
    """What a motion over independent phases takes, before it is computed."""

    phases: tuple[tuple[str, float], ...]  #: what turns with each phase, and its frequency [Hz]
    unknowns: int
    memory: float  #: [byte]
    time: float  #: of this computer's processor, once all is compiled [s]
    marched: float  #: the same at most, where the motion is not found and is integrated [s]

    def __str__(self) -> str:
        """One line."""
        listed = ", ".join(f"{name} {value:.6g} Hz" for name, value in self.phases)
        return (
            f"The motion is found over {len(self.phases)} phases without a common period "
            f"({listed}): about {self.unknowns} unknowns, {1e-9 * self.memory:.2g} GB and "
            f"{self.time:.2g} s once all is compiled"
        ) + (self.marched > 0.0) * (
            f"; at most {float(f'{self.marched:.2g}'):g} s where it is not found and is integrated "
            "over time"
        )


class ClockCost(NamedTuple):
    """What a motion over the common period takes, before it is computed."""

    cycles: int  #: mesh cycles of the fastest mesh
    period: float  #: [s]
    contacts: int  #: of teeth that vary
    coordinates: int

    @property
    def steps(self) -> int:
        """Steps of the period."""
        return _STEPS * self.cycles

    @property
    def memory(self) -> float:
        """With half the steps too [byte]."""
        r, (each, wide, linear, square) = self.contacts, _BYTES
        return self.steps * (each + wide * self.coordinates + r * (linear + square * r))

    @property
    def time(self) -> float:
        """Of this computer's processor, once all is compiled [s]."""
        r, (each, linear, square, wide) = self.contacts, _STEP
        each += r * (linear + square * r) + (1 + r) * wide * self.coordinates
        return _ONCE + self.steps * each

    def __str__(self) -> str:
        """One line."""
        return (
            f"The motion repeats after {self.cycles} mesh cycles ({self.period:.4g} s): "
            f"about {self.steps} steps, {1e-9 * self.memory:.2g} GB and {self.time:.2g} s once all "
            f"is compiled; {_TWICE * self.time:.2g} s where it needs twice the steps"
        )


def phase_cost_of(
    memory: float,
    machine: Machine,
    driven: tuple[Phases, Sequence[str]] | None = None,
    orders: Any = 0,
    work: Work | None = None,
    fewer: Callable[[], str] | None = None,
) -> PhaseCost:
    """Cost of the motion of a machine over phases; refuse too much, with what makes it less."""
    phases, shafts = driven or (machine.phases, ())
    names = phase_names(machine, phases, shafts)
    followers: list[Fields] = [*machine._followers(phases)]
    loose = sum(each.clearance > 0.0 or each.unloaded is not None
                for each in machine.bearings.values())  # fmt: skip
    if loose:
        followers.append((2 * loose, (0,) * len(phases.frequency), 1, ()))
    cost = cost_over_phases(phases, names, followers, orders, work=work)
    if loose:  # refused where it is not found
        cost = cost._replace(marched=0.0)
    remedy = "Raise solver.memory, or compute a part of the machine"
    if fewer is not None and cost.memory > memory and (without := fewer()):
        remedy = f"Raise solver.memory, or give fewer faults: {without}"
    refuse_memory(cost, memory, "solver.memory", remedy)
    return cost


def cost_over_phases(
    phases: Phases,
    names: Sequence[str],
    followers: Sequence[Fields],
    orders: Any,
    mesh: int | None = None,
    work: Work | None = None,
) -> PhaseCost:
    """Cost of a motion over named phases, of the fields of each follower."""
    from tribodyn.dynamics.harmonic.phase_balance import phase_cost

    pairs = tuple(zip(names, phases.frequency, strict=True))
    return PhaseCost(pairs, *phase_cost(followers, phases.frequency, orders, mesh, work))


def refuse_memory(cost: PhaseCost, memory: float, key: str, remedy: str) -> None:
    """Refuse a motion that takes more memory [byte] than is allowed."""
    if cost.memory > memory:
        what = f"the motion over {len(cost.phases)} phases takes about {1e-9 * cost.memory:.3g} GB"
        allowed = f" by {key}" if key == "solver.memory" else ""
        why = f"At most {1e-9 * memory:.3g} GB are allowed{allowed}"
        raise ComputationError(Problem(what, key, why, remedy))


def warn_of_motion(
    solver: SolverTable, machine: Machine, work: Work | None = None
) -> PhaseCost | None:
    """Warn of a long period, or return the cost of the motion over phases; refuse too much."""
    if over_phases(solver, machine):
        return phase_cost_of(solver.memory, machine, work=work)
    warn_of_period(machine, solver.memory)
    return None


def warn_of_gears(case: MachineCase) -> None:
    """Warn of gears whose teeth are computed, as those of a pair are warned of, by their names."""
    listed: dict[str, MeshWarning] = {}
    for name, pair, _ in computed_pairs(case):
        for each in (*case_cautions(pair, case), *teeth_cautions(pair)):
            text = pair.source.named(each.message)
            listed.setdefault(text, MeshWarning(name, "", ModelWarning(each.code, text)))
    warn_of_meshes(listed.values())


def periods_of_turns(machine: Machine) -> int:
    """Periods of the clock of a machine after which what turns with its gears repeats too."""
    return round(machine.clock.frequency / machine.phases_with(together=True).frequency[0])


def warn_of_period(machine: Machine, memory: float = math.inf) -> None:
    """Warn of a period with so many mesh cycles that it takes much time and memory [byte]."""
    if periods_of_turns(machine) * max(machine.clock.cycles.values()) > _LONG_PERIOD:
        clock_cost(machine, memory)


def clock_cost(machine: Machine, memory: float, cycles: int = 0, coordinates: int = 0) -> ClockCost:
    """Cost of a motion on one clock; ``cycles`` are those with orders of torques and speeds."""
    clock, longer = machine.clock, periods_of_turns(machine)
    fastest = max(clock.cycles, key=lambda name: clock.cycles[name])
    of_meshes = longer * clock.cycles[fastest]
    cycles = cycles or of_meshes
    seconds = cycles / (clock.cycles[fastest] * clock.frequency)
    meshes = [m for m in machine.meshes.values() if m.stiffness is None or callable(m.stiffness)]
    contacts = sum(max(len(mesh.contacts), 1) for mesh in meshes)
    coordinates = coordinates or min(unreduced_size(machine), _FEWEST)
    cost = ClockCost(cycles, seconds, contacts, coordinates)
    reason = "the teeth have few common factors"
    remedy = 'Set solver.phases = "auto", which finds the motion without a common period'
    if longer > 1 or any(mesh.period > 1 for mesh in machine.meshes.values()):
        reason = "unequal teeth repeat with whole turns of their gears"
        remedy = 'Set solver.phases = "auto", or compute a case of its stage alone'
    pairs = (
        f"{name} {' : '.join(str(abs(machine.gears[gear].teeth)) for gear in mesh.gears)}"
        for name, mesh in machine.meshes.items()
    )
    reason += f" ({', '.join(pairs)})"
    if cycles > of_meshes:
        reason = "shafts with varying torques or speeds make whole turns"
        remedy = (
            "Excitations of one shaft only, or orders that repeat after a part of a turn, shorten "
            "the period"
        )
    period = (
        f"all repeats only after {cycles} cycles of mesh {fastest} ({seconds:.4g} s), because "
        f"{reason}"
    )
    _warn_of_steps(cost, period, remedy, memory)
    return cost


def _warn_of_steps(cost: ClockCost, period: str, remedy: str, memory: float) -> None:
    """Warn of what a long period costs; refuse what there is no memory [byte] for."""
    takes = f"takes {cost.steps} steps and at least {1e-9 * cost.memory:.2g} GB"
    if cost.memory > min(machine_memory(), memory):
        where = f"This computer has {1e-9 * machine_memory():.3g} GB, and {period}"
        if memory < machine_memory():
            where = f"solver.memory allows {1e-9 * memory:.3g} GB, and {period}"
        raise ComputationError(Problem(f"the motion {takes}", "meshes", where, remedy))
    if cost.cycles > _LONG_PERIOD:
        warn("long-period", f"{period}. Each motion {takes}. {remedy}")


#: Geometry of cylindrical meshes that is among the figures of every load.
_OF_LOADS = (
    *("center_distance", "operating_pressure_angle", "transverse_contact_ratio", "overlap_ratio"),
)


def shape_figures(case: MachineCase) -> dict[str, float]:
    """Gears and oil of the meshes with computed teeth, of planets those of the first."""
    values: dict[str, float] = {}
    for name, pair, _ in computed_pairs(case):
        figures = {**geometry(pair), **operating_figures(pair)}
        of_loads = () if pair.gears.kind == "hypoid" else _OF_LOADS
        of_pairs = [key for key in PARTS["meshes"]["of_pairs"] if key not in of_loads]
        names = (key for key in figures if key in of_pairs)
        values |= {f"meshes.{name}.{key}": float(figures[key]) for key in names}
    return values


def computed_pairs(case: MachineCase) -> Iterator[tuple[str, PairCase, TeethUnder]]:
    """Iterate over meshes with computed teeth and their pairs, of planets the first."""
    firsts = {case.tooth_group(name): name for name in reversed(case.meshes_with_teeth)}
    for name in reversed(firsts.values()):
        under = teeth_under(case, name, case.operating_point)
        speed, torque = under.operation
        pair, _ = read_teeth(case, name, under)
        yield name, pair.replace({"operation.speed": speed, "operation.torque": torque}), under


def idle_keys(case: MachineCase) -> dict[str, str]:
    """Keys of teeth that have no effect in any mesh because of other values, and why."""
    idle: dict[str, str] = {}
    used: set[str] = set()
    for _, pair, _ in computed_pairs(case):
        values = idle_values(pair)  # bodies are those of the shafts
        why = {key: each for key, each in values if not key.endswith(("density", "face_width"))}
        idle |= {pair.source.key(key): reason for key, reason in why.items()}
        used |= {pair.source.key(key) for key, _ in flat_keys(pair.data) if key not in why}
    if case.lone_stage is not None:
        stage = case.stages[case.lone_stage].table
        keys = [f"gears.{each}.position" for each in (stage.sun, stage.ring)]
        if not stage.helix_angle:
            idle |= dict.fromkeys(keys, "the gears of a stage alone have one plane")
            tilts = (f"gears.{name}.transverse_moment_of_inertia" for name in case.data["gears"])
            idle |= dict.fromkeys(tilts, "the gears of a stage alone do not tilt")
    has_oil = case.losses is not None or case.is_rated or case.heat is not None
    return {
        key: why
        for key, why in idle.items()
        if key not in used
        and case.get(key) is not None
        and not (has_oil and key.startswith("lubricant"))
    }


def kinematic_figures(case: MachineCase, load: LoadCase | None = None) -> dict[str, float]:
    """Speeds, torques and power of shafts and meshes, in SI by dotted key."""
    machine = case.machine(load)
    flow, run = machine.kinematics, machine.operation
    values: dict[str, float | None] = {
        **shape_figures(case),
        "machine.clock_frequency": machine.clock.frequency,
        "machine.input_power": abs(run.speed * run.torque),
        "machine.output_torque": abs(flow.shafts[run.output].torque),
    }
    for name, mesh in flow.meshes.items():
        values[f"meshes.{name}.mesh_frequency"] = mesh.mesh_frequency
        values[f"meshes.{name}.static_mesh_force"] = mesh.force
        computed = name in case.meshes_with_teeth
        pair = inputs_under(case, name, case.operating_point).cylindrical if computed else None
        ratio = None if pair is None else pair.transverse_contact_ratio
        for key, value in geometry_figures(machine, name, mesh.force, ratio).items():
            values[f"meshes.{name}.{key}"] = value
    for name, shaft in flow.shafts.items():
        values[f"shafts.{name}.speed"] = shaft.speed
        values[f"shafts.{name}.torque"] = shaft.torque
        values[f"shafts.{name}.power"] = shaft.power
    for name, stage in machine.planets.items():
        for key, value in motion_of_stage(machine, name, stage, flow).items():
            values[f"planets.{name}.{key}"] = value
    return {key: float(value) for key, value in values.items() if value is not None}
