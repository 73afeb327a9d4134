"""What a bifurcation diagram is made of: values of the parameter, plan, rows of motions."""

from __future__ import annotations

import threading
from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from tribodyn.dynamics.equations.compiled import Compiled
from tribodyn.dynamics.equations.program import compile_system
from tribodyn.dynamics.equations.step_limit import largest_rate
from tribodyn.dynamics.equations.system import System
from tribodyn.types import Array, Index


@dataclass(frozen=True)
class Plan:
    """What to do at every value of the parameter."""

    transient: int
    cycles: int
    keep: int
    signal: int | str  #: contact whose compression is looked at, or name of a coordinate
    keep_partial: bool = False  #: whether an interruption leaves what is finished
    stop: threading.Event = field(default_factory=threading.Event, repr=False, compare=False)


class Row:
    """What came of all values of the parameter on one branch; filled while marching."""

    def __init__(self, count: int, keep: int, size: int) -> None:
        self.section = np.full((count, keep), np.nan)
        self.period = np.zeros(count, dtype=np.int64)
        self.rms, self.contact_loss_share = np.full(count, np.nan), np.full(count, np.nan)
        self.first, self.last = (np.full((count, 2 * size), np.nan) for _ in range(2))
        self.force = np.zeros((count, size))
        self.finished = np.zeros(count, dtype=bool)


def compile_unchecked(system: System, mesh_frequency: float, steps: int) -> Compiled:
    """Compile a system without refusing a long step; whoever calls has to look at its number."""
    grid, nodes, program = compile_system(system, steps)
    number = largest_rate(system, nodes) * float(grid.width.max()) / mesh_frequency
    return Compiled(system, grid, nodes, program, number)


class Values:
    """Systems, mesh frequencies and steps of all values of the parameter."""

    def __init__(self, systems: Sequence[System], mesh_frequency: Array, steps: Index) -> None:
        self.systems, self.mesh_frequency, self.steps = list(systems), mesh_frequency, steps
        self.count, self.size = len(self.systems), self.systems[0].size
        same = all(item is self.systems[0] for item in self.systems)
        self.shared: Compiled | None = None
        if same and np.all(steps == steps[0]):
            slowest = float(mesh_frequency.min())
            self.shared = compile_unchecked(self.systems[0], slowest, int(steps[0]))
        self.step_number = np.zeros(self.count)
        if self.shared is not None:
            self.step_number = self.shared.step_number * mesh_frequency.min() / mesh_frequency

    def at(self, number: int) -> Compiled:
        """Compile the system of one value, and note its ``omega_max * dt``."""
        if self.shared is not None:
            return self.shared
        beat, steps = float(self.mesh_frequency[number]), int(self.steps[number])
        found = compile_unchecked(self.systems[number], beat, steps)
        self.step_number[number] = found.step_number
        return found
