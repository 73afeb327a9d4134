"""Contact forces and accelerations of a run-up at the samples that are kept."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tribodyn.dynamics.equations.motion import compression, forces, has_gap, sides
from tribodyn.dynamics.equations.nodes import Nodes
from tribodyn.dynamics.equations.system import System
from tribodyn.dynamics.running_up.run_up_tables import Table
from tribodyn.types import Array


class Samples:
    """Collects the samples of all mesh cycles."""

    def __init__(
        self, systems: Sequence[System], frequency: Array, cycles: int, samples: int
    ) -> None:
        system = systems[0]
        self.system, self.size, self.several = system, system.size, frequency.size > 1
        shape = (cycles, samples)
        self.time, self.beat = np.empty(shape), np.empty(shape)
        self.state = np.empty((*shape, 2 * system.size))
        self.acceleration = np.empty((*shape, system.size))
        self.deflection = np.empty((*shape, len(system.contacts)))
        self.force = np.empty((*shape, len(system.contacts)))

    def add(
        self,
        table: Table,
        first: int,
        time: Array,
        frequency: Array,
        states: Array,
        weights: Sequence[tuple[int, float]],
        extra: Sequence[Array],
    ) -> None:
        """Add some mesh cycles."""
        part = slice(first, first + len(weights))
        q, v = states[..., : self.size], states[..., self.size :]

        rows = Nodes(*(self._rows(table, name, weights) for name in Nodes._fields))
        dead = np.any([has_gap(node) for node in table.nodes], axis=0)
        beat, pulled = frequency[..., None], np.array(extra)[:, None]
        d = compression(rows, q)
        moved = forces(self.system, rows, beat, q, v, side=sides(d, rows.gap, dead), extra=pulled)
        self.time[part], self.beat[part], self.state[part] = time, frequency, states
        self.acceleration[part] = moved.acceleration
        self.deflection[part], self.force[part] = d, moved.contact

    def _rows(self, table: Table, name: str, weights: Sequence[tuple[int, float]]) -> Array:
        """Values at the samples, (cycles or 1, samples, ...)."""
        own = [getattr(node, name)[table.kept, 0] for node in table.nodes]
        if not self.several:
            return np.asarray(own[0][None])
        stacked = np.array(own)
        left = np.array([number for number, _ in weights])
        part = np.array([share for _, share in weights])
        part = part.reshape(-1, *(1,) * (stacked.ndim - 1))
        return np.asarray((1.0 - part) * stacked[left] + part * stacked[left + 1])

    def series(self, outputs: Array) -> dict[str, Array]:
        """Everything as series over time."""
        cycles, samples = self.time.shape
        flat = self.state.reshape(cycles * samples, -1)
        return {
            "time": self.time.reshape(-1),
            "phase": np.arange(cycles * samples) / samples,
            "mesh_frequency": self.beat.reshape(-1),
            "position": flat[:, : self.size],
            "velocity": flat[:, self.size :],
            "acceleration": self.acceleration.reshape(-1, self.size),
            "deflection": self.deflection.reshape(cycles * samples, -1),
            "contact_force": self.force.reshape(cycles * samples, -1),
            "output": flat @ outputs.T,
        }
