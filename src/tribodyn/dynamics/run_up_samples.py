"""Contact forces and accelerations of a run-up at the samples that are kept."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tribodyn.dynamics.equations.system import System
from tribodyn.dynamics.load_friction import friction_force
from tribodyn.dynamics.run_up_tables import Table
from tribodyn.types import Array


class Samples:
    """Collects the samples of all mesh cycles."""

    def __init__(
        self, systems: Sequence[System], frequency: Array, cycles: int, samples: int
    ) -> None:
        system = systems[0]
        self.system, self.size, self.several = system, system.size, frequency.size > 1
        self.inverse = np.linalg.inv(np.asarray(system.mass))
        self.free = np.array([contact.damping_in_gap for contact in system.contacts], dtype=bool)
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

        def rows(name: str) -> Array:
            return self._rows(table, name, weights)

        direction, gap = rows("direction"), rows("gap")
        beat = frequency[..., None]
        d = np.einsum("csji,csi->csj", direction, q) - rows("error")
        rate = np.einsum("csji,csi->csj", direction, v)
        rate += beat * np.einsum("csji,csi->csj", rows("direction_slope"), q)
        rate -= beat * rows("error_slope")
        dead = np.any([np.any(node.gap > 0.0, axis=(0, 1)) for node in table.nodes], axis=0)
        side = np.where(dead, np.where(d > gap, 1.0, np.where(d < -gap, -1.0, 0.0)), 1.0)
        force = np.abs(side) * rows("stiffness") * (d - side * gap)
        force = force + ((side != 0.0) | self.free) * rows("damping") * rate
        total = rows("force") + np.array(extra)[:, None] - q @ np.asarray(self.system.stiffness).T
        total = total - v @ np.asarray(self.system.damping).T
        total = total - np.einsum("csji,csj->csi", rows("force_direction"), force)
        if self.system.frictions:
            rub = friction_force(self.system, rows("friction_coefficients"), force)
            total = total - np.einsum("csfi,csf->csi", rows("friction_direction"), rub)
        self.time[part], self.beat[part], self.state[part] = time, frequency, states
        self.acceleration[part] = total @ self.inverse.T
        self.deflection[part], self.force[part] = d, force

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
