"""Statistics of lanes: signals, moments and their order.

Signals are, in this order: compression of every contact, force of every contact, acceleration of
every coordinate, and linear outputs of the state. Both ends and the middle of every step count with
Simpson's weights, and at an event both sides do.
:mod:`tribodyn.dynamics._engine.running_statistics` accumulates them during the integration of a
block or from a recorded mesh cycle.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tribodyn.dynamics.equations.compiled import Compiled
from tribodyn.types import Array

#: Per signal: mean, mean square, minimum, maximum, share of the time off the driving flank.
#: Signals of the contacts are followed by a cosine and a sine part per harmonic.
PLAIN_MOMENTS = 5


class Statistics(NamedTuple):
    """Moments of the signals of all lanes, accumulated without storing time series."""

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
