"""Systems on their grid, checked for the longest step: one for all lanes, or one for each.

Lanes with systems of their own have one grid with the events of all, one structure of terms, and
rows for each lane.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.checks import require_whole
from tribodyn.dynamics.equations.grid import Grid, system_events
from tribodyn.dynamics.equations.lane_parameters import LaneParameters
from tribodyn.dynamics.equations.motion import has_gap
from tribodyn.dynamics.equations.nodes import Nodes, coefficient_count
from tribodyn.dynamics.equations.program import Program, build_program, compile_system
from tribodyn.dynamics.equations.step_limit import (
    largest_rate,
    refuse_unstable_lanes,
    refuse_unstable_step,
)
from tribodyn.dynamics.equations.system import System
from tribodyn.errors import InputError, require_positive
from tribodyn.types import Index, Mask


@dataclass(frozen=True)
class Member:
    """One of several systems on a common grid, with the lanes that march it."""

    system: System
    nodes: Nodes
    lanes: Index  #: numbers of its lanes


@dataclass(frozen=True)
class Compiled:
    """A system on its grid, checked for one highest step size."""

    system: System
    grid: Grid
    nodes: Nodes
    program: Program
    step_number: float  #: ``omega_max * dt`` of the slowest mesh frequency [-]
    members: tuple[Member, ...] = ()  #: systems of the lanes where these differ
    parameters: LaneParameters | None = None  #: factors of the lanes for which the step was checked
    _programs: dict[tuple[bool, bool], tuple[Program, ...]] = field(
        default_factory=dict, init=False, repr=False, compare=False
    )

    def programs(self, parameters: LaneParameters | None = None) -> tuple[Program, ...]:
        """Programs of all members, or of the one system, all with the same terms."""
        scaled = parameters is not None and parameters.scales_contacts
        split = parameters is not None and parameters.scales_friction
        if not (scaled or split or self.members):
            return (self.program,)
        if (scaled, split) not in self._programs:
            options: dict[str, Any] = {"scaled": scaled, "split": split}
            pairs = [(member.system, member.nodes) for member in self.each(1)]

            def build(pattern: Mask | None) -> tuple[Program, ...]:
                return tuple(
                    build_program(system, self.grid, nodes, pattern=pattern, **options)
                    for system, nodes in pairs
                )

            programs = build(None)
            if len(programs) > 1:
                programs = build(np.any([program.pattern for program in programs], axis=0))
            self._programs[scaled, split] = programs
        return self._programs[scaled, split]

    def each(self, lanes: int) -> tuple[Member, ...]:
        """Members, or the one system as that of all lanes."""
        return self.members or (Member(self.system, self.nodes, np.arange(lanes)),)


def compile_for(
    system: System, mesh_frequency: ArrayLike, steps: int, parameters: LaneParameters | None = None
) -> Compiled:
    """Compile a system and refuse a step that the integrator cannot follow."""
    require_positive("mesh_frequency", mesh_frequency, "Hz")
    require_whole("steps", steps)
    grid, nodes, program = compile_system(system, int(steps))
    beat = np.atleast_1d(np.asarray(mesh_frequency, dtype=float))
    if parameters is None:
        known = system._rates.get(grid.steps)  # of the same rows
        number = refuse_unstable_step(system, nodes, grid, float(beat.min()), rate=known)
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
    """Compile the systems of all lanes on one grid; ``any_step``: however long the steps are."""
    given = [systems] if isinstance(systems, System) else list(systems)
    distinct = list({id(one): one for one in given}.values())
    if len(distinct) == 1 and not any_step:
        return compile_for(distinct[0], mesh_frequency, steps, parameters)
    _refuse_different(given)
    require_positive("mesh_frequency", mesh_frequency, "Hz")
    require_whole("steps", steps)
    if len(distinct) == 1:
        system, (grid, nodes, program) = distinct[0], compile_system(distinct[0], int(steps))
        rate = largest_rate(system, nodes) if parameters is None else float("nan")
        number = rate * float(grid.width.max() / np.min(mesh_frequency))
        return Compiled(system, grid, nodes, program, number, parameters=parameters)
    beat = np.broadcast_to(np.asarray(mesh_frequency, dtype=float), (len(given),))
    events = system_events(*distinct)
    places = {id(one): number for number, one in enumerate(distinct)}
    which = np.array([places[id(one)] for one in given])
    members, number = [], float("nan") if any_step else 0.0
    for place, system in enumerate(distinct):
        lanes = np.flatnonzero(which == place)
        grid, nodes, program = compile_system(system, steps, events)
        if not any_step:
            own = refuse_unstable_lanes(system, nodes, grid, beat, parameters, lanes=lanes)
            number = max(number, own)
        members.append(Member(system, nodes, lanes))
        if place == 0:
            first = program
    _refuse_mixed_gaps(members)
    return Compiled(distinct[0], grid, members[0].nodes, first, number, tuple(members), parameters)


def _refuse_different(systems: list[System]) -> None:
    def facts(system: System) -> dict[str, object]:
        return {
            "coordinates": system.size,
            "contacts": len(system.contacts),
            "contacts with damping in the gap": tuple(
                contact.damping_in_gap for contact in system.contacts
            ),
            "contacts that its frictions follow": tuple(one.contacts for one in system.frictions),
            "coefficients of its frictions": tuple(
                coefficient_count(f"frictions[{f}].coefficients", one)
                for f, one in enumerate(system.frictions)
            ),
        }

    if not systems or not all(isinstance(one, System) for one in systems):
        what = "systems is neither a System nor a sequence of one System for each lane"
        why = "Every lane has a system of its own"
        raise InputError(what, "argument systems", why, "Give one System, or a list of them")
    known = {id(systems[0]): facts(systems[0])}
    first = known[id(systems[0])]
    for lane, system in enumerate(systems):
        if id(system) in known:
            continue
        known[id(system)] = own = facts(system)
        for name, value in own.items():
            if value != first[name]:
                raise InputError(
                    f"the system of lane {lane} has {value} {name}, that of lane 0 has "
                    f"{first[name]}",
                    where="argument systems",
                    why="Lanes march side by side and have the same structure, with values of "
                    "their own",
                    remedy="March different structures in separate ensembles",
                )


def _refuse_mixed_gaps(members: list[Member]) -> None:
    dead: list[Mask] = [has_gap(one.nodes) for one in members]
    for one, own in zip(members, dead, strict=True):
        apart = np.flatnonzero(own != dead[0])
        if apart.size:
            raise InputError(
                f"contact {apart[0]} has a dead zone in lane "
                f"{(one if own[apart[0]] else members[0]).lanes[0]} and none in lane "
                f"{(members[0] if own[apart[0]] else one).lanes[0]}",
                where="argument systems",
                why="A contact without a dead zone also pulls, which is another force law",
                remedy="Give it a gap in every lane, however small, or in none",
            )
