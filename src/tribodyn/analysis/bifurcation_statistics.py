"""Statistics of motions that have settled: section, rms, contact loss."""

from __future__ import annotations

import os
from dataclasses import dataclass

import numpy as np

from tribodyn.analysis.attractors import Motions
from tribodyn.analysis.poincare_march import repeat_period
from tribodyn.dynamics._engine import blocks
from tribodyn.errors import ComputationError
from tribodyn.types import Array, Index

#: Statistics of a signal without harmonics: mean, mean square, minimum, maximum, share off flank.
_PLAIN = 5


@dataclass(frozen=True)
class Statistics:
    """What was gathered of motions that go on from their last state."""

    points: Array  #: the signal once per mesh cycle [m or rad]
    period: Index  #: mesh cycles after which it repeats
    rms: Array  #: alternating rms of the signal [m or rad]
    contact_loss_share: Array  #: part of the time off the driving flank [-]
    last: Array  #: last state [mixed]


def measure(
    motions: Motions, indices: Index, cycles: int, keep: int, signal: int | str
) -> Statistics:
    """March on from the last states, and gather statistics."""
    nan = np.full(indices.size, np.nan)
    found = Statistics(
        np.full((indices.size, keep), np.nan), np.zeros(indices.size, dtype=np.int64), nan,
        nan.copy(), np.full((indices.size, motions.start.shape[1]), np.nan),
    )  # fmt: skip
    alive = np.all(np.isfinite(motions.state[indices]), axis=1)
    for period in np.unique(motions.period[indices]):
        rows = np.flatnonzero(alive & (motions.period[indices] == period))
        if rows.size:
            _measure_rows(motions, indices, rows, int(period), cycles, signal, found)
    return found


def _measure_rows(
    motions: Motions, indices: Index, rows: Index, period: int, cycles: int, signal: int | str,
    found: Statistics,
) -> None:  # fmt: skip
    """Motions of one period together; one by one if one of them grows beyond all bounds."""
    try:
        _gather(motions, indices[rows], rows, period, period or cycles, signal, found)
    except ComputationError:
        if rows.size > 1:
            for row in rows:
                _measure_rows(
                    motions, indices, np.array([row]), period, cycles, signal, found
                )  # fmt: skip


def _gather(
    motions: Motions, index: Index, rows: Index, period: int, cycles: int, signal: int | str,
    found: Statistics,
) -> None:  # fmt: skip
    system = motions.compiled.system
    contacts, size, lanes = len(system.contacts), system.size, index.size
    outputs = np.zeros((1, 2 * size))
    if isinstance(signal, str):
        outputs[0, tuple(system.names).index(signal)] = 1.0
    row = -1 if isinstance(signal, str) else signal
    state, total = motions.state[index], np.zeros((3, lanes))
    points, reduced = np.empty((cycles, lanes)), []
    for cycle in range(cycles):
        points[cycle] = _signal(motions, state, signal, outputs[0])
        reduced.append(motions.coordinates.reduce(state))
        moments = np.zeros((2 * contacts + size + 1, _PLAIN, lanes))
        moments[:, 2], moments[:, 3] = np.inf, -np.inf
        flat = moments.reshape(-1, lanes)
        state = motions.march(
            index, state, 1, motions.force[index],
            statistics=blocks.Statistics(outputs, np.zeros((1, 3, 0, 2)), flat),
            width=1 if lanes < 4 else 16, threads=os.cpu_count() or 1,
        )  # fmt: skip
        state = motions.coordinates.expand(motions.coordinates.reduce(state))
        here = flat.reshape(moments.shape)
        total[:2] += here[row, :2] / cycles
        if contacts:
            total[2] += here[contacts + (signal if isinstance(signal, int) else 0), 4] / cycles
    keep = found.points.shape[1]
    history = np.stack(reduced[-keep:])
    found.points[rows] = np.resize(points[-keep:], (keep, lanes)).T
    found.period[rows] = period or [repeat_period(history[:, lane]) for lane in range(lanes)]
    # A motion on its way beyond all bounds has no rms.
    with np.errstate(over="ignore", invalid="ignore"):
        found.rms[rows] = np.sqrt(np.maximum(total[1] - total[0] ** 2, 0.0))
    found.contact_loss_share[rows] = total[2]
    found.last[rows] = state


def _signal(motions: Motions, state: Array, signal: int | str, output: Array) -> Array:
    """Compression of the contact, or the coordinate, at the mesh phase 0, (lanes,)."""
    if isinstance(signal, str):
        return np.asarray(state @ output)
    nodes = motions.compiled.nodes
    place = state[:, : state.shape[1] // 2]
    return np.asarray(place @ nodes.direction[0, 0, signal] - nodes.error[0, 0, signal])
