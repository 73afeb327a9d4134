"""Systems evaluated on their grid with a checked step size: one for all lanes, or one per lane.

Different systems share a grid with the events of all and one structure of terms; each has its rows.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.dynamics.equations.grid import Grid, build_grid, system_events
from tribodyn.dynamics.equations.lane_parameters import LaneParameters
from tribodyn.dynamics.equations.motion import has_gap
from tribodyn.dynamics.equations.nodes import (
    Nodes,
    coefficient_count,
    evaluate_nodes,
    over_spanned,
)
from tribodyn.dynamics.equations.program import Program, build_program, compile_system
from tribodyn.dynamics.equations.step_limit import (
    largest_rate,
    refuse_rate,
    refuse_unstable_lanes,
)
from tribodyn.dynamics.equations.system import System
from tribodyn.errors import InputError, require_positive
from tribodyn.nomenclature import require_whole
from tribodyn.types import Index, Mask


@dataclass(frozen=True)
class Member:
    """One of several systems on a common grid, with the numbers of its lanes."""

    system: System
    nodes: Nodes
    lanes: Index  #: numbers of its lanes


@dataclass(frozen=True)
class Compiled:
    """A system on its grid, with checked step size."""

    system: System
    grid: Grid
    nodes: Nodes
    program: Program
    step_number: float  #: ``omega_max * dt`` of the slowest mesh frequency [-]
    members: tuple[Member, ...] = ()  #: systems of the lanes where these differ
    parameters: LaneParameters | None = None  #: factors of the lanes for which the step was checked
    engine: Any = field(
        default=None, repr=False, compare=False
    )  #: integrates instead of the program
    _programs: dict[int, tuple[Program, ...]] = field(
        default_factory=dict, init=False, repr=False, compare=False
    )

    @property
    def limited_number(self) -> float:
        """The number of the step where its size is limited; 0 for an engine without a limit."""
        return self.step_number if self.engine is None else 0.0

    def programs(self, kind: int = 0) -> tuple[Program, ...]:
        """Programs of all members, or of the one system, for lanes of a kind (``kinds_of``)."""
        if not (kind or self.members):
            return (self.program,)
        if kind not in self._programs:
            options: dict[str, Any] = {"scaled": bool(kind & 1), "split": bool(kind & 2)}
            pairs = [(member.system, member.nodes) for member in self.each(1)]

            def build(pattern: Mask | None) -> tuple[Program, ...]:
                return tuple(
                    build_program(system, self.grid, nodes, pattern=pattern, **options)
                    for system, nodes in pairs
                )

            programs = build(None)
            if len(programs) > 1:
                programs = build(np.any([program.pattern for program in programs], axis=0))
            self._programs[kind] = programs
        return self._programs[kind]

    def each(self, lanes: int) -> tuple[Member, ...]:
        """Members, or the one system as that of all lanes."""
        return self.members or (Member(self.system, self.nodes, np.arange(lanes)),)


def sample_system(system: System, steps: int, *, narrow: bool = False) -> Compiled:
    """Grid and rows of a system, without a program for lanes and a number of the step."""
    # narrow: with directions over few coordinates, if they span few
    require_whole("steps", steps)
    grid = build_grid(system_events(system), int(steps) * system.cycles)
    none, mask = np.zeros(0, dtype=np.int64), np.zeros(0, dtype=bool)
    program = Program(none, none, np.zeros(0), grid.width, grid.after_event, np.zeros(0), mask)
    evaluate = partial(evaluate_nodes, grid=grid)
    nodes = over_spanned(system, evaluate) if narrow else evaluate(system)
    return Compiled(system, grid, nodes, program, float("nan"))


def compile_for(
    system: System, mesh_frequency: ArrayLike, steps: int, parameters: LaneParameters | None = None
) -> Compiled:
    """Compile a system; raise if the step is beyond the stability limit of the integrator."""
    require_positive("mesh_frequency", mesh_frequency, "Hz")
    require_whole("steps", steps)
    grid, nodes, program = compile_system(system, int(steps))
    beat = np.atleast_1d(np.asarray(mesh_frequency, dtype=float))
    if parameters is None:
        # The cached rate is from the same rows.
        rate = system._rates.get(grid.steps) or largest_rate(system, nodes)
        number = refuse_rate(system, grid, float(beat.min()), rate)
    else:
        number = refuse_unstable_lanes(system, nodes, grid, beat, parameters)
    return Compiled(system, grid, nodes, program, number, parameters=parameters)


def compile_lanes(
    systems: System | Sequence[System],
    mesh_frequency: ArrayLike,
    steps: int,
    parameters: LaneParameters | None = None,
    *,
    any_step: bool = False,
) -> Compiled:
    """Compile the systems of all lanes on one grid; ``any_step`` skips the check of the step."""
    lane_systems = [systems] if isinstance(systems, System) else list(systems)
    distinct = list({id(lane_system): lane_system for lane_system in lane_systems}.values())
    if len(distinct) == 1 and not any_step:
        return compile_for(distinct[0], mesh_frequency, steps, parameters)
    _refuse_different(lane_systems)
    require_positive("mesh_frequency", mesh_frequency, "Hz")
    require_whole("steps", steps)
    if len(distinct) == 1:
        system, (grid, nodes, program) = distinct[0], compile_system(distinct[0], int(steps))
        rate = largest_rate(system, nodes) if parameters is None else float("nan")
        number = rate * float(grid.width.max() / np.min(mesh_frequency))
        return Compiled(system, grid, nodes, program, number, parameters=parameters)
    beat = np.broadcast_to(np.asarray(mesh_frequency, dtype=float), (len(lane_systems),))
    events = system_events(*distinct)
    places = {id(lane_system): number for number, lane_system in enumerate(distinct)}
    which = np.array([places[id(lane_system)] for lane_system in lane_systems])
    members, number = [], float("nan") if any_step else 0.0
    for place, system in enumerate(distinct):
        lanes = np.flatnonzero(which == place)
        grid, nodes, program = compile_system(system, steps, events)
        if not any_step:
            lane_number = refuse_unstable_lanes(system, nodes, grid, beat, parameters, lanes=lanes)
            number = max(number, lane_number)
        members.append(Member(system, nodes, lanes))
        if place == 0:
            first = program
    _refuse_mixed_gaps(members)
    return Compiled(distinct[0], grid, members[0].nodes, first, number, tuple(members), parameters)


def _refuse_different(systems: list[System]) -> None:
    def counts(system: System) -> dict[str, object]:
        return {
            "coordinates": system.size,
            "contacts": len(system.contacts),
            "mesh cycles of its contacts": tuple(contact.cycles for contact in system.contacts),
            "contacts with damping in the gap": tuple(
                contact.damping_in_gap for contact in system.contacts
            ),
            "contacts that its frictions follow": tuple(
                friction.contacts for friction in system.frictions
            ),
            "coefficients of its frictions": tuple(
                coefficient_count(f"frictions[{f}].coefficients", friction)
                for f, friction in enumerate(system.frictions)
            ),
        }

    if not systems or not all(isinstance(friction, System) for friction in systems):
        what = "systems is neither a System nor a sequence of one System for each lane"
        why = "All lanes share one system, or each lane has one"
        raise InputError(what, "argument systems", why, "Give one System, or a list of them")
    structures = {id(systems[0]): counts(systems[0])}
    first = structures[id(systems[0])]
    for lane, system in enumerate(systems):
        if id(system) in structures:
            continue
        structures[id(system)] = structure = counts(system)
        for name, value in structure.items():
            if value != first[name]:
                raise InputError(
                    f"the system of lane {lane} has {value} {name}, that of lane 0 has "
                    f"{first[name]}",
                    where="argument systems",
                    why="The lanes of an ensemble are integrated together: their systems may "
                    "differ in values but not in structure",
                    remedy="Simulate different structures in separate ensembles",
                )


def _refuse_mixed_gaps(members: list[Member]) -> None:
    dead: list[Mask] = [has_gap(member.nodes) for member in members]
    for member, has_gap_here in zip(members, dead, strict=True):
        mixed = np.flatnonzero(has_gap_here != dead[0])
        if mixed.size:
            raise InputError(
                f"contact {mixed[0]} has a dead zone in lane "
                f"{(member if has_gap_here[mixed[0]] else members[0]).lanes[0]} and none in lane "
                f"{(members[0] if has_gap_here[mixed[0]] else member).lanes[0]}",
                where="argument systems",
                why="A contact without a dead zone also pulls, which is another force law",
                remedy="Give it a gap in every lane, however small, or in none",
            )
