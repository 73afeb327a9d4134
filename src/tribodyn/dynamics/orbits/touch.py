"""Whether a motion in touch stays in touch until it has reached its orbit.

While no flank parts, the motion over a period is linear. The disturbed motions that give the
matrix of the map then tell the compression at every later time: that of the orbit, plus what is
left of the distance to it. A start whose flanks stay in touch all the way belongs to the orbit.
"""

from __future__ import annotations

import numpy as np

from tribodyn.dynamics.orbits.orbit_map import OrbitMap
from tribodyn.types import Array

#: Periods looked ahead at most, and the part of the distance at which there is nothing to fear.
_HORIZON, _GONE = 2000, 1e-3


class FlankWatch:
    """Compressions beyond the play of the meshes that have one."""

    def __init__(self, mapping: OrbitMap) -> None:
        nodes = mapping.compiled.nodes
        dead = np.any(nodes.gap > 0.0, axis=(0, 1))
        meshes: list[list[int]] = []
        for j in range(dead.size):
            for mesh in meshes:
                if all(
                    np.array_equal(part[:, :, j], part[:, :, mesh[0]])
                    for part in (nodes.direction, nodes.error)
                ):
                    mesh.append(j)
                    break
            else:
                meshes.append([j])
        kept = [mesh for mesh in meshes if dead[mesh].all()]
        first = [mesh[0] for mesh in kept]
        self._direction = nodes.direction[:, ::2][:, :, first]
        self._error = nodes.error[:, ::2][:, :, first]
        gaps = [nodes.gap[:, ::2, mesh].min(axis=2) for mesh in kept]
        self._gap = np.stack(gaps, axis=-1) if gaps else np.zeros((*self._error.shape[:2], 0))
        self._steps = mapping.compiled.grid.steps
        self._size = mapping.compiled.system.size

    def compression(self, states: Array) -> Array:
        """Compression of each mesh at both ends of every step, (periods, steps, 2, meshes)."""
        q = states[:, : self._size]
        ends = np.stack((q[:-1], q[1:]), axis=1).reshape(-1, self._steps, 2, self._size)
        return np.asarray(np.einsum("rsji,crsi->crsj", self._direction, ends) - self._error)

    def clearance(self, compression: Array) -> Array:
        """Distance of each mesh from parting, on the flank on which it begins."""
        return self.flank(compression) * compression - self._gap

    @staticmethod
    def flank(compression: Array) -> Array:
        """Side of the play on which each mesh begins, (meshes,): 1 or -1."""
        return np.where(compression[0, 0, 0] < 0.0, -1.0, 1.0)

    def in_touch(self, states: Array) -> bool:
        """Whether no mesh parts on the way."""
        return bool(np.all(self.clearance(self.compression(states)) > 0.0))

    def stays(self, states: Array, slopes: Array, matrix: Array, distance: Array) -> bool:
        """Whether a motion beside an orbit reaches it without parting."""
        compression = self.compression(states)
        room = self.clearance(compression).reshape(-1)
        if np.any(room <= 0.0):
            return False
        still = self.compression(np.zeros_like(states))
        flank = self.flank(compression)
        rates = np.stack(
            [(flank * (self.compression(slope) - still)).reshape(-1) for slope in slopes], axis=1
        )
        first = float(np.abs(rates @ distance).max(initial=0.0))
        for _ in range(_HORIZON):
            moved = rates @ distance
            if np.any(room + moved <= 0.0):
                return False
            if float(np.abs(moved).max(initial=0.0)) <= _GONE * first:
                break
            distance = matrix @ distance
        return True
