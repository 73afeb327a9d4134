"""Statistics of recorded lanes in NumPy: the same sums as those gathered while marching.

See :mod:`tribodyn.dynamics.moments` for the signals and their order: both ends and the middle of
every step count with Simpson's weights, and at an event both sides do.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tribodyn.dynamics.equations.compiled import Member
from tribodyn.dynamics.equations.grid import Grid
from tribodyn.dynamics.equations.motion import Scales, forces, with_middles
from tribodyn.types import Array

#: Mean, mean square, minimum, maximum, share off the driving flank; see the compiled statistics.
_PLAIN = 5


class RecordedLanes(NamedTuple):
    """One mesh cycle of lanes that march the same system."""

    member: Member  #: the system on its grid
    grid: Grid
    period: Array  #: mesh period [s]
    extra_force: Array  #: constant generalized force on top of the system's [N or N*m]
    scales: Array  #: [1]
    states: Array  #: position and velocity before every step and at the end


def add_moments(
    lanes: RecordedLanes, outputs: Array, waves: Array, share: float, moments: Array
) -> None:
    """Add a mesh cycle to the moments."""
    duration = lanes.period[:, None] * lanes.grid.width
    q, v = with_middles(duration, np.moveaxis(lanes.states, -1, 0))
    beat = (1.0 / lanes.period)[:, None, None, None]
    d, force, side, acceleration = forces(
        lanes.member.system, lanes.member.nodes, beat, q, v,
        scales=Scales.of_lanes(lanes.scales), extra=lanes.extra_force[:, None, None, :],
    )  # fmt: skip
    contacts, harmonics = d.shape[-1], waves.shape[2]
    long = _PLAIN + 2 * harmonics
    weight = share * lanes.member.nodes.weight
    split = 2 * contacts * long
    tall = moments[:split].reshape(2 * contacts, long, moments.shape[1])
    short = moments[split:].reshape(-1, _PLAIN, moments.shape[1])
    both = np.concatenate((d, force), axis=-1)
    _add(both, weight, tall)
    parts = np.einsum("rs,rshp,brsj->jhpb", weight, waves, both, optimize=True)
    tall[:, _PLAIN:] += parts.reshape(2 * contacts, 2 * harmonics, moments.shape[1])
    tall[contacts:, 4] += np.einsum("rs,brsj->jb", weight, 1.0 - np.maximum(side, 0.0))
    signals = np.concatenate((acceleration, np.concatenate((q, v), axis=-1) @ outputs.T), axis=-1)
    _add(signals, weight, short)


def _add(signals: Array, weight: Array, rows: Array) -> None:
    rows[:, 0] += np.einsum("rs,brsj->jb", weight, signals)
    rows[:, 1] += np.einsum("rs,brsj,brsj->jb", weight, signals, signals)
    rows[:, 2] = np.minimum(rows[:, 2], signals.min(axis=(1, 2)).T)
    rows[:, 3] = np.maximum(rows[:, 3], signals.max(axis=(1, 2)).T)
