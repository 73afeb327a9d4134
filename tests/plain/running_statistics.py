"""Moments of recorded mesh cycles in plain NumPy: what the compiled sums are tested against."""

import numpy as np

from tribodyn.dynamics._engine.statistics import PLAIN_MOMENTS
from tribodyn.dynamics.equations.motion import Scales, forces, with_middles


def add_record(statistics, member, grid, period, extra_force, scales, record):
    """Add a mesh cycle of all lanes: both ends and the middle of every step by Simpson's rule."""
    q, v = with_middles(period[:, None] * grid.width, np.moveaxis(record, -1, 0))
    beat, extra = (1.0 / period)[:, None, None, None], extra_force[:, None, None, :]
    law = forces(
        member.system, member.nodes, beat, q, v, scales=Scales.of_lanes(scales), extra=extra
    )
    weight, rows = member.nodes.weight, statistics.of_contacts
    signals_of_contacts = np.concatenate((law.deflection, law.contact), axis=-1)
    _add(signals_of_contacts, weight, rows)
    parts = np.einsum(
        "rs,rshp,brsj->jhpb", weight, statistics.waves, signals_of_contacts, optimize=True
    )
    rows[:, PLAIN_MOMENTS:] += parts.reshape(rows[:, PLAIN_MOMENTS:].shape)
    off = 1.0 - np.maximum(law.side, 0.0)
    rows[statistics.contacts :, 4] += np.einsum("rs,brsj->jb", weight, off)
    states = np.concatenate((q, v), axis=-1)
    signals = np.concatenate((law.acceleration, states @ statistics.outputs.T), axis=-1)
    _add(signals, weight, statistics.others)


def _add(signals, weight, rows):
    rows[:, 0] += np.einsum("rs,brsj->jb", weight, signals)
    rows[:, 1] += np.einsum("rs,brsj,brsj->jb", weight, signals, signals)
    rows[:, 2] = np.minimum(rows[:, 2], signals.min(axis=(1, 2)).T)
    rows[:, 3] = np.maximum(rows[:, 3], signals.max(axis=(1, 2)).T)
