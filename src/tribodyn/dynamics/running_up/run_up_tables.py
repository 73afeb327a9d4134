"""Grids and row tables of a run-up: fine enough for each speed, and following the speed.

Recorded samples and all events are grid points, so that nothing is interpolated. The rows of a
cycle are those of a constant speed, corrected for the change of speed within a step: the middle row
belongs to the middle in time, and slopes over the phase become rates with the local speed instead
of the mean speed of the cycle.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np

from tribodyn.dynamics.equations.grid import Grid, system_events
from tribodyn.dynamics.equations.nodes import Nodes, evaluate_nodes
from tribodyn.dynamics.equations.program import Program, build_program
from tribodyn.dynamics.equations.step_limit import LIMIT, rate_on_grid
from tribodyn.dynamics.equations.system import System
from tribodyn.errors import InputError, require_positive
from tribodyn.nomenclature import require_whole
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
    sample_steps: Index  #: steps that begin at the samples
    slopes: Index  #: columns of the rows that are slopes over the mesh phase
    step_number: float  #: ``omega_max * dt`` at a mesh frequency of 1 Hz [-]


def systems_by_frequency(
    system: System | Mapping[float, System],
) -> tuple[Array, tuple[System, ...]]:
    """Read one system, or several over the mesh frequency."""
    if isinstance(system, System):
        return np.zeros(1), (system,)
    if not system:
        why = "The equations of motion belong to a system"
        remedy = "Give a System, or several by mesh frequency"
        raise InputError("the mapping of systems is empty", "argument system", why, remedy)
    frequency = np.array(sorted(system), dtype=float)
    require_positive("mesh_frequency", frequency, "Hz")
    systems = tuple(system[each] for each in sorted(system))
    first = systems[0]
    for at, other in zip(frequency, systems, strict=True):
        same = other.size == first.size and len(other.contacts) == len(first.contacts)
        same = (
            same and len(other.frictions) == len(first.frictions) and other.cycles == first.cycles
        )
        same = same and all(
            np.allclose(getattr(other, name), getattr(first, name), rtol=1e-12, atol=0.0)
            for name in ("mass", "rate_matrix", "stiffness")
        )
        if not same or (other.balance is None) != (first.balance is None):
            raise InputError(
                f"the system at {at:g} Hz has another structure than that at {frequency[0]:g} Hz",
                where="argument system",
                why="Contacts, friction and loads may change with the speed; matrices, "
                "coordinates, the number of contacts and the balanced torque may not",
                remedy="Give systems of the same structure",
            )
    return frequency, systems


def blend_weight(frequencies: Array, frequency: float) -> tuple[int, float]:
    """Number of the first of two neighbouring systems at a speed, and part of the second."""
    last = frequencies.size - 1
    if last == 0:
        return 0, 0.0
    left = min(max(int(np.searchsorted(frequencies, frequency)) - 1, 0), last - 1)
    low, high = float(frequencies[left]), float(frequencies[left + 1])
    return left, min(max((frequency - low) / (high - low), 0.0), 1.0)


def sampled_grid(events: tuple[float, ...], steps: int, samples: int) -> Grid:
    """Divide the mesh cycle so that events and equally spaced samples are grid points."""
    jumps = np.array([*events, 1.0])
    marks = np.arange(1, samples) / samples
    separate = np.abs(marks[:, None] - jumps).min(axis=1) > 1e-9
    edges = np.sort(np.concatenate((jumps, marks[separate])))
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
    """Systems on grids that suit each speed, compiled on demand."""

    def __init__(
        self, systems: tuple[System, ...], samples: int, lowest: float, steps: int | None
    ) -> None:
        self.systems, self.samples, self.fixed = systems, samples, steps
        events = sorted({event for system in systems for event in system_events(system)})
        duplicates = [i for i in range(1, len(events)) if events[i] - events[i - 1] < 1e-9]
        self.events = tuple(event for i, event in enumerate(events) if i not in duplicates)
        self.cycles = systems[0].cycles
        least = max(64, 2 * -(-len(self.events) // self.cycles))
        self.rate = max(rate_on_grid(system, least) for system in systems)
        self._tables: dict[int, Table] = {}
        self._refuse(lowest)

    def _refuse(self, lowest: float) -> None:
        steps = self.fixed
        needed = self.rate / (LIMIT * lowest * self.cycles)
        if steps is not None:
            require_whole("steps", steps)
        if steps is not None and needed > steps:
            raise InputError(
                f"omega_max*dt = {LIMIT * needed / steps:.3f} with {steps} steps per mesh "
                f"cycle at {self.cycles * lowest:g} Hz and a fastest motion of "
                f"{self.rate:.4g} rad/s",
                where="argument steps",
                why=f"The limit is {LIMIT}, and the lowest speed has the longest steps",
                remedy=f"Use at least {64 * int(np.ceil(needed / 64))} steps, or omit steps: "
                "each speed then has as many as it needs",
            )
        if needed > _MOST:
            raise InputError(
                f"{self.cycles * lowest:g} Hz needs {needed:.3g} steps per mesh cycle",
                where="argument profile",
                why=f"The fastest motion is {self.rate:.4g} rad/s, and the limit is {_MOST} steps",
                remedy=f"Begin at {self.rate / (LIMIT * _MOST):.3g} Hz or above; below it the "
                "motion is quasi-static",
            )

    def steps_at(self, frequency: float) -> int:
        """Steps per cycle of the fastest mesh at a frequency of the clock."""
        if self.fixed is not None:
            return int(self.fixed)
        needed = self.rate / (_FINE * self.cycles * frequency)
        level = np.ceil(np.log(max(needed / _FEWEST, 1.0)) / np.log(_LADDER) - 1e-9)
        return int(min(np.ceil(_FEWEST * _LADDER**level / 64.0) * 64, _MOST))

    def at(self, frequency: float) -> Table:
        """Tables for a mesh frequency."""
        steps = self.steps_at(frequency)
        if steps not in self._tables:
            self._tables[steps] = self._make(steps)
        return self._tables[steps]

    def _make(self, steps: int) -> Table:
        grid = sampled_grid(self.events, steps * self.cycles, self.samples)
        nodes = [evaluate_nodes(system, grid) for system in self.systems]
        pairs = list(zip(self.systems, nodes, strict=True))
        programs = tuple(build_program(system, grid, node) for system, node in pairs)
        if len(programs) > 1:
            # All speeds have a term that one of them has.
            pattern = np.any([each.pattern for each in programs], axis=0)
            programs = tuple(
                build_program(system, grid, node, pattern=pattern) for system, node in pairs
            )
        if any(not np.array_equal(each.code, programs[0].code) for each in programs):
            raise InputError(
                "the equations of the systems have different terms",
                where="argument system",
                why="Rows of neighbouring speeds are interpolated term by term",
                remedy="Use the same kinds of contacts at every speed: a gap at all or at none, "
                "loads that vary over the mesh cycle at all or at none",
            )
        marks = np.arange(self.samples) / self.samples
        sample_steps = np.abs(grid.left[:, None] - marks).argmin(axis=0)
        number = self.rate * float(grid.width.max())
        return Table(
            grid, tuple(nodes), programs, sample_steps, _slope_columns(programs[0]), number
        )


def _slope_columns(program: Program) -> Index:
    code, column, columns = program.code, 0, []
    for j in range(int(code[1])):
        along, turning = int(code[4 + 4 * j]), int(code[5 + 4 * j])
        columns.append(column + 3)
        columns += range(column + 5 + along, column + 5 + along + turning)
        column += 5 + along + turning
    return np.array(columns, dtype=np.int64)
