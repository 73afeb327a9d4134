"""Statistics of recorded lanes in NumPy: the same sums as those gathered while marching.

See :mod:`tribodyn.dynamics.moments` for the signals and their order: both ends and the middle of
every step count with Simpson's weights, and at an event both sides do.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from tribodyn.dynamics.grid import Grid
from tribodyn.dynamics.load_friction import friction_force
from tribodyn.dynamics.march import Member
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
    q, v = _hermite(lanes)
    d, force, side = _contacts(lanes, q, v)
    acceleration = _acceleration(lanes, q, v, force)
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


def _hermite(lanes: RecordedLanes) -> tuple[Array, Array]:
    """Position and velocity at the nodes, (lanes, steps, 3, n): cubic in every step."""
    states = np.moveaxis(lanes.states, -1, 0)
    size = states.shape[-1] // 2
    h = (lanes.period[:, None] * lanes.grid.width)[:, :, None]
    q0, v0 = states[:, :-1, :size], states[:, :-1, size:]
    q1, v1 = states[:, 1:, :size], states[:, 1:, size:]
    q = np.stack((q0, 0.5 * (q0 + q1) + 0.125 * h * (v0 - v1), q1), axis=2)
    v = np.stack((v0, 1.5 * (q1 - q0) / h - 0.25 * (v0 + v1), v1), axis=2)
    return q, v


def _contacts(lanes: RecordedLanes, q: Array, v: Array) -> tuple[Array, Array, Array]:
    """Compression, force and side of every contact at the nodes."""
    nodes, system = lanes.member.nodes, lanes.member.system
    stiff, damp, _, error, wide, _ = lanes.scales.T[:, :, None, None, None]
    beat = (1.0 / lanes.period)[:, None, None, None]
    d = np.einsum("rsji,brsi->brsj", nodes.direction, q) - error * nodes.error
    rate = np.einsum("rsji,brsi->brsj", nodes.direction, v)
    rate += beat * np.einsum("rsji,brsi->brsj", nodes.direction_slope, q)
    rate -= beat * error * nodes.error_slope
    gap = wide * nodes.gap
    dead = np.any(nodes.gap > 0.0, axis=(0, 1))
    side = np.where(dead, np.where(d > gap, 1.0, np.where(d < -gap, -1.0, 0.0)), 1.0)
    free = np.array([contact.damping_in_gap for contact in system.contacts], dtype=bool)
    spring = np.abs(side) * stiff * nodes.stiffness * (d - side * gap)
    force = spring + ((side != 0.0) | free) * damp * nodes.damping * rate
    return d, np.asarray(force), side


def _acceleration(lanes: RecordedLanes, q: Array, v: Array, force: Array) -> Array:
    nodes, system = lanes.member.nodes, lanes.member.system
    rub, pull = (lanes.scales[:, item, None, None, None] for item in (2, 5))
    total = pull * nodes.force + lanes.extra_force[:, None, None, :]
    total = total - q @ np.asarray(system.stiffness).T - v @ np.asarray(system.damping).T
    own = np.einsum("rsji,brsj->brsi", nodes.force_direction - nodes.direction, force)
    if system.frictions:
        drag = friction_force(system, nodes.friction_coefficients, force)
        own = own + np.einsum("rsfi,brsf->brsi", nodes.friction_direction, drag)
    total = total - np.einsum("rsji,brsj->brsi", nodes.direction, force) - rub * own
    return np.asarray(total @ np.linalg.inv(np.asarray(system.mass)).T)
