"""Motion of a machine over several phases by integration over time, where it has no lines.

Steps end at the jumps of all meshes. A block of steps is a period of a clock that runs once over
it, so that the modal engine takes it as one.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from tribodyn.dynamics.equations.compiled import Compiled
from tribodyn.dynamics.equations.grid import RowEvaluator, build_grid
from tribodyn.dynamics.equations.motion import forces
from tribodyn.dynamics.equations.nodes import Nodes, step_weights
from tribodyn.dynamics.harmonic.phase_rows import PhaseRows
from tribodyn.dynamics.modal.closed_structure import ClosedStructure
from tribodyn.dynamics.modal.modal_march import ModalMotion
from tribodyn.errors import ComputationError
from tribodyn.types import Array

#: Steps in a cycle of the fastest phase, cycles in a block, and how often steps that are too long
#: are halved.
STEPS, _BLOCK, _HALVINGS = 128, 16, 4
#: Jumps nearer than this part of a block are one; repetitions for those of an unsteady rotation.
_NEAR, _REPEATS = 1e-9, 40


@dataclass(frozen=True, eq=False)
class PhaseMarch:
    """Motion from a state at the time zero."""

    rows: PhaseRows
    structure: ClosedStructure
    torque: Array  #: balancing torque (n,)
    begins: list[Array]  #: states (2 n,) at the beginnings of the blocks so far

    @property
    def duration(self) -> float:
        """Time of a block [s]."""
        meshes = [abs(self.rows.rate(mesh.cycles)) * mesh.period for mesh in self.rows.meshes]
        return _BLOCK / max(float(self.rows.frequency.max()), *meshes)

    def states(self, times: Array) -> Array:
        """Positions and velocities (s, 2 n) at times that are not negative."""
        states = np.empty((times.size, self.begins[0].size))
        blocks = np.floor(times / self.duration).astype(np.int64)
        for block in range(int(blocks.max(initial=-1)) + 1):
            chosen = blocks == block
            if chosen.any() or block + 1 == len(self.begins):
                states[chosen] = self._block(block, times[chosen])
        return states

    def _block(self, number: int, times: Array) -> Array:
        """States at times within a block; keeps that at its end."""
        for halving in range(_HALVINGS + 1):
            compiled = self._compiled(number * self.duration, _BLOCK * STEPS * 2**halving)
            motion = ModalMotion(compiled, self.structure)
            q, v = np.split(self.begins[number], 2)
            try:
                states = motion.march(q, v, 1.0 / self.duration, 1, self.torque, recorded=True)
                break
            except ComputationError:
                if halving == _HALVINGS:
                    raise
        if number + 1 == len(self.begins):
            self.begins.append(states[-1])
        return self._between(compiled, states, times / self.duration - number)

    def _between(self, compiled: Compiled, states: Array, places: Array) -> Array:
        """States at places of a block, by the cubics through the ends of its steps."""
        left, width = compiled.grid.left, compiled.grid.width
        step = np.clip(np.searchsorted(left, places, side="right") - 1, 0, left.size - 1)
        ends = np.stack((states[step], states[step + 1]), axis=1)
        q, v = np.split(ends, 2, axis=2)
        rows = Nodes(*(part[step][:, ::2] for part in compiled.nodes))
        moved = forces(compiled.system, rows, 1.0 / self.duration, q, v, extra=self.torque)
        at, h = ((places - left[step]) / width[step])[:, None], self.duration * width[step, None]
        slopes = np.concatenate((v, moved.acceleration), axis=2) * h[:, None]
        change = ends[:, 1] - ends[:, 0]
        bent = slopes[:, 0] - change, change - slopes[:, 1]
        inside = at * (1.0 - at) * ((1.0 - at) * bent[0] + at * bent[1])
        return np.asarray(ends[:, 0] + at * change + inside)

    def _compiled(self, begin: float, steps: int) -> Compiled:
        """Steps and entries of a block."""
        grid = build_grid(self._jumps(begin), steps)
        phase = RowEvaluator(grid).nodes
        points = (begin + self.duration * phase.reshape(-1, 1)) * self.rows.frequency % 1.0
        fields = self.rows.nodes(points)._asdict() | {"phase": phase.reshape(-1, 1)}
        for name in ("error_slope", "direction_slope"):
            fields[name] = fields[name] * self.duration
        shaped = {}
        for name, values in fields.items():
            wide = np.broadcast_to(values[:, 0], (phase.size, *values.shape[2:]))
            shaped[name] = wide.reshape(*phase.shape, *values.shape[2:])
        nodes = Nodes(**shaped)._replace(weight=step_weights(grid))
        return replace(self.rows.means, system=self.rows.system, grid=grid, nodes=nodes)

    def _led(self, on_time: Array) -> Array:
        """Times at which a rotation that is ahead comes to places that it has at some times."""
        lead, times = self.rows.system.lead, on_time
        for _ in range(_REPEATS if lead is not None else 0):
            assert lead is not None
            times = on_time - lead(times[:, None] * self.rows.frequency % 1.0)[0]
        return times

    def _jumps(self, begin: float) -> tuple[float, ...]:
        """Phases of a block at which a mesh passes a jump, from 0."""
        places = [np.zeros(1)]
        for mesh in self.rows.meshes:
            rate = self.rows.rate(mesh.cycles)
            if mesh.jumps.size and rate:
                first, last = np.sort((np.array([0.0, self.duration]) + begin) * rate + mesh.offset)
                cycles = np.arange(np.floor(first) - 1.0, np.ceil(last) + 1.0)
                on_time = ((mesh.jumps[:, None] + cycles - mesh.offset) / rate).reshape(-1)
                places.append((self._led(on_time) - begin) / self.duration)
        at = np.unique(np.concatenate(places))
        at = at[(at >= 0.0) & (at < 1.0 - _NEAR)]
        return tuple(at[np.diff(at, prepend=-1.0) > _NEAR].tolist())
