"""What a run-up marches on: grids fine enough for each speed, tables that follow the speed.

The samples kept and all events are grid points, so that nothing is interpolated. The rows of a
cycle are those of the constant speed, put right for what the change of speed does within a step:
the middle row belongs to the middle in time, and slopes over the phase become rates with the speed
at the place instead of that of the cycle.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from tribodyn.checks import require_whole
from tribodyn.dynamics.equations.grid import Grid, system_events
from tribodyn.dynamics.equations.nodes import Nodes, evaluate_nodes
from tribodyn.dynamics.equations.program import Program, build_program
from tribodyn.dynamics.equations.step_limit import LIMIT, rate_on_grid
from tribodyn.dynamics.equations.system import System
from tribodyn.errors import InputError, require_positive
from tribodyn.types import Array, Index

#: ``omega_max * dt`` of the chosen steps; the damping that the integrator adds is then below 4e-5.
_FINE = 0.35
#: Fewest and most steps per mesh cycle, ratio between one grid and the next.
_FEWEST, _MOST, _LADDER = 256, 65536, 1.42


class Table(NamedTuple):
    """All systems on one grid."""

    grid: Grid
    nodes: tuple[Nodes, ...]
    programs: tuple[Program, ...]
    kept: Index  #: steps that begin at the samples
    slopes: Index  #: columns of the rows that are slopes over the mesh phase
    step_number: float  #: ``omega_max * dt`` at a mesh frequency of 1 Hz [-]


def systems_by_frequency(
    system: System | Mapping[float, System],
) -> tuple[Array, tuple[System, ...]]:
    """Take one system, or several over the mesh frequency."""
    if isinstance(system, System):
        return np.zeros(1), (system,)
    if not system:
        why = "The equations of motion belong to a system"
        remedy = "Give a System, or several by mesh frequency"
        raise InputError("no system", "argument system", why, remedy)
    frequency = np.array(sorted(system), dtype=float)
    require_positive("mesh_frequency", frequency, "Hz")
    found = tuple(system[each] for each in sorted(system))
    first = found[0]
    for at, other in zip(frequency, found, strict=True):
        same = other.size == first.size and len(other.contacts) == len(first.contacts)
        same = same and len(other.frictions) == len(first.frictions)
        same = same and all(
            np.allclose(getattr(other, name), getattr(first, name), rtol=1e-12, atol=0.0)
            for name in ("mass", "damping", "stiffness")
        )
        if not same or (other.balance is None) != (first.balance is None):
            raise InputError(
                f"the system at {at:g} Hz is another structure",
                where="argument system",
                why="Contacts, friction and loads may change with the speed; matrices, "
                "coordinates, the number of contacts and the balanced torque stay",
                remedy="Give systems of one structure",
            )
    return frequency, found


def blend_weight(known: Array, frequency: float) -> tuple[int, float]:
    """Find the two neighbouring systems at a speed."""
    last = known.size - 1
    if last == 0:
        return 0, 0.0
    left = min(max(int(np.searchsorted(known, frequency)) - 1, 0), last - 1)
    low, high = float(known[left]), float(known[left + 1])
    return left, min(max((frequency - low) / (high - low), 0.0), 1.0)


def sampled_grid(events: tuple[float, ...], steps: int, samples: int) -> Grid:
    """Divide the mesh cycle so that events and equally spaced samples are grid points."""
    jumps = np.array([*events, 1.0])
    marks = np.arange(1, samples) / samples
    apart = np.abs(marks[:, None] - jumps).min(axis=1) > 1e-9
    edges = np.sort(np.concatenate((jumps, marks[apart])))
    lengths = np.diff(edges)
    counts = np.maximum(np.ceil(lengths * steps - 1e-6).astype(np.int64), 1)
    within = np.concatenate([np.arange(count) for count in counts])
    width = np.repeat(lengths / counts, counts)
    left = np.repeat(edges[:-1], counts) + within * width
    segment = np.searchsorted(jumps, left + 0.5 * width, side="right") - 1
    first = np.zeros(left.size, dtype=np.bool_)
    first[np.flatnonzero(np.append(True, segment[1:] != segment[:-1]))] = True
    return Grid(left, width, first, jumps[segment], jumps[segment + 1])


class Tables:
    """Systems on grids that suit each speed, compiled where they are first needed."""

    def __init__(
        self, systems: tuple[System, ...], samples: int, lowest: float, steps: int | None
    ) -> None:
        self.systems, self.samples, self.fixed = systems, samples, steps
        events = sorted({event for system in systems for event in system_events(system)})
        near = [i for i in range(1, len(events)) if events[i] - events[i - 1] < 1e-9]
        self.events = tuple(event for i, event in enumerate(events) if i not in near)
        least = max(64, 2 * len(self.events))
        self.rate = max(rate_on_grid(system, least) for system in systems)
        self._made: dict[int, Table] = {}
        self._refuse(lowest)

    def _refuse(self, lowest: float) -> None:
        steps = self.fixed
        needed = self.rate / (LIMIT * lowest)
        if steps is not None:
            require_whole("steps", steps)
        if steps is not None and needed > steps:
            raise InputError(
                f"omega_max*dt = {LIMIT * needed / steps:.3f} with {steps} steps per mesh "
                f"cycle at {lowest:g} Hz and a fastest motion of {self.rate:.4g} rad/s",
                where="argument steps",
                why=f"The limit is {LIMIT}, and the lowest speed has the longest steps",
                remedy=f"Use at least {64 * int(np.ceil(needed / 64))} steps, or leave steps "
                "out: each speed then gets as many as it needs",
            )
        if needed > _MOST:
            raise InputError(
                f"{lowest:g} Hz needs {needed:.3g} steps per mesh cycle",
                where="argument profile",
                why=f"The fastest motion is {self.rate:.4g} rad/s; {_MOST} steps are the most",
                remedy=f"Begin at {self.rate / (LIMIT * _MOST):.3g} Hz or above; below it the "
                "load is carried statically",
            )

    def steps_at(self, frequency: float) -> int:
        """Steps per mesh cycle at a mesh frequency."""
        if self.fixed is not None:
            return int(self.fixed)
        needed = self.rate / (_FINE * frequency)
        level = np.ceil(np.log(max(needed / _FEWEST, 1.0)) / np.log(_LADDER) - 1e-9)
        return int(min(np.ceil(_FEWEST * _LADDER**level / 64.0) * 64, _MOST))

    def at(self, frequency: float) -> Table:
        """Tables for a mesh frequency."""
        steps = self.steps_at(frequency)
        if steps not in self._made:
            self._made[steps] = self._make(steps)
        return self._made[steps]

    def _make(self, steps: int) -> Table:
        grid = sampled_grid(self.events, steps, self.samples)
        nodes = [evaluate_nodes(system, grid) for system in self.systems]
        pairs = list(zip(self.systems, nodes, strict=True))
        programs = tuple(build_program(system, grid, node) for system, node in pairs)
        if len(programs) > 1:
            # A term that one speed has is kept at all.
            kept_terms = np.any([each.pattern for each in programs], axis=0)
            programs = tuple(
                build_program(system, grid, node, pattern=kept_terms) for system, node in pairs
            )
        if any(not np.array_equal(each.code, programs[0].code) for each in programs):
            raise InputError(
                "the systems differ in which terms there are",
                where="argument system",
                why="Rows of neighbouring speeds are blended term by term",
                remedy="Give every speed the same kinds of contacts: a gap everywhere or "
                "nowhere, loads that vary over the mesh cycle everywhere or nowhere",
            )
        marks = np.arange(self.samples) / self.samples
        kept = np.abs(grid.left[:, None] - marks).argmin(axis=0)
        number = self.rate * float(grid.width.max())
        return Table(grid, tuple(nodes), programs, kept, _slope_columns(programs[0]), number)


def _slope_columns(program: Program) -> Index:
    code, column, found = program.code, 0, []
    for j in range(int(code[1])):
        along, turning = int(code[4 + 4 * j]), int(code[5 + 4 * j])
        found.append(column + 3)
        found += range(column + 5 + along, column + 5 + along + turning)
        column += 5 + along + turning
    return np.array(found, dtype=np.int64)
