"""Statistics of lanes: what is gathered, in which order, and the same sums of recorded motions.

Signals are, in this order: compression of every contact, force of every contact, acceleration of
every coordinate, and linear outputs of the state. Both ends and the middle of every step count with
Simpson's weights, and at an event both sides do. While a block marches,
:mod:`tribodyn.dynamics._engine.moments` gathers them.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tribodyn.dynamics.equations.compiled import Compiled, Member
from tribodyn.dynamics.equations.grid import Grid
from tribodyn.dynamics.equations.motion import Scales, forces, with_middles
from tribodyn.types import Array

#: Per signal: mean, mean square, minimum, maximum, share of the time off the driving flank.
#: Signals of the contacts are followed by a cosine and a sine part per harmonic.
PLAIN_MOMENTS = 5


class RecordedLanes(NamedTuple):
    """One mesh cycle of lanes that march the same system."""

    member: Member  #: the system on its grid
    grid: Grid
    period: Array  #: mesh period [s]
    extra_force: Array  #: constant generalized force on top of the system's [N or N*m]
    scales: Array  #: [1]
    states: Array  #: position and velocity before every step and at the end


class Statistics(NamedTuple):
    """What is gathered of lanes, so that no time series is stored."""

    outputs: Array  #: linear outputs of the state (m, 2 n)
    waves: Array  #: cosine and sine of harmonics, (steps, 3, harmonics, 2)
    moments: Array  #: (numbers, lanes); overwritten
    contacts: int

    @classmethod
    def of(cls, compiled: Compiled, outputs: Array, lanes: int, harmonics: int = 0) -> Statistics:
        """Statistics before the first step: zero, but minima and maxima at infinity."""
        contacts, others = len(compiled.system.contacts), compiled.system.size + len(outputs)
        angle = 2.0 * np.pi * compiled.nodes.phase[:, :, None] * np.arange(1, harmonics + 1)
        waves = np.stack((np.cos(angle), np.sin(angle)), axis=-1)
        numbers = 2 * contacts * (PLAIN_MOMENTS + 2 * harmonics) + others * PLAIN_MOMENTS
        new = cls(outputs, waves, np.zeros((numbers, lanes)), contacts)
        for rows in (new.of_contacts, new.others):
            rows[:, 2], rows[:, 3] = np.inf, -np.inf
        return new

    @property
    def _split(self) -> int:
        return 2 * self.contacts * (PLAIN_MOMENTS + 2 * self.waves.shape[2])

    @property
    def of_contacts(self) -> Array:
        """Compressions, then forces, of all contacts: (2 contacts, 5 + 2 harmonics, lanes)."""
        rows, long = self.moments[: self._split], PLAIN_MOMENTS + 2 * self.waves.shape[2]
        return rows.reshape(2 * self.contacts, long, self.moments.shape[1])

    @property
    def others(self) -> Array:
        """Accelerations, then outputs: (signals, 5, lanes)."""
        return self.moments[self._split :].reshape(-1, PLAIN_MOMENTS, self.moments.shape[1])

    @property
    def figures(self) -> Array:
        """The plain moments of all signals, (signals, 5, lanes)."""
        return np.concatenate((self.of_contacts[:, :PLAIN_MOMENTS], self.others))

    def add(self, lanes: RecordedLanes, share: float) -> None:
        """Add a mesh cycle of all lanes."""
        q, v = with_middles(
            lanes.period[:, None] * lanes.grid.width, np.moveaxis(lanes.states, -1, 0)
        )
        beat, extra = 1.0 / lanes.period, lanes.extra_force[:, None, None, :]
        system, nodes = lanes.member.system, lanes.member.nodes
        scales = Scales.of_lanes(lanes.scales)
        law = forces(system, nodes, beat[:, None, None, None], q, v, scales=scales, extra=extra)
        weight, rows = share * nodes.weight, self.of_contacts
        both = np.concatenate((law.deflection, law.contact), axis=-1)
        _add(both, weight, rows)
        parts = np.einsum("rs,rshp,brsj->jhpb", weight, self.waves, both, optimize=True)
        rows[:, PLAIN_MOMENTS:] += parts.reshape(rows[:, PLAIN_MOMENTS:].shape)
        off = 1.0 - np.maximum(law.side, 0.0)
        rows[self.contacts :, 4] += np.einsum("rs,brsj->jb", weight, off)
        states = np.concatenate((q, v), axis=-1)
        signals = np.concatenate((law.acceleration, states @ self.outputs.T), axis=-1)
        _add(signals, weight, self.others)


def _add(signals: Array, weight: Array, rows: Array) -> None:
    rows[:, 0] += np.einsum("rs,brsj->jb", weight, signals)
    rows[:, 1] += np.einsum("rs,brsj,brsj->jb", weight, signals, signals)
    rows[:, 2] = np.minimum(rows[:, 2], signals.min(axis=(1, 2)).T)
    rows[:, 3] = np.maximum(rows[:, 3], signals.max(axis=(1, 2)).T)
