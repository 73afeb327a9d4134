"""Tolerances of the adaptive engine: what a state may be wrong by, and each step of it."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.dynamics.equations.compiled import Compiled
from tribodyn.dynamics.equations.step_limit import state_roots
from tribodyn.dynamics.orbits.start import static_start
from tribodyn.errors import InputError
from tribodyn.types import Array

#: An absolute tolerance: one number, one for positions and one for velocities, or one per state.
Tolerance = float | Sequence[float] | ArrayLike

#: Default absolute tolerance, over the relative one and the size of the static state.
SMALL = 1e-3
#: Error of a step over the tolerance asked for, and the same times the memory of the motion [rad].
#: Errors of steps add up over the memory; so their sum stayed below half of the tolerance in all
#: reference cases, up to a hundred undamped periods. Impacts spread neighbouring motions, hence the
#: smaller share of steps where flanks can part: with it the error of two masses that spread small
#: differences 450-fold equals the tolerance.
_SHARE, _SHARE_WITH_GAP, _BUDGET, _LEAST = 0.015, 0.001, 3.0, 1e-5


def read_atol(atol: Tolerance, size: int) -> Array:
    """Absolute tolerance of each state."""
    values = np.atleast_1d(np.asarray(atol, dtype=float))
    if values.shape == (2,):
        values = np.repeat(values, size)
    if values.shape not in ((1,), (2 * size,)) or not np.all(np.isfinite(values) & (values > 0.0)):
        raise InputError(
            f"atol = {atol!r}",
            where="argument atol",
            why="One positive number, one for positions and one for velocities, or one for "
            f"each of the {2 * size} states",
        )
    return np.array(np.broadcast_to(values, (2 * size,)))


def static_scale(compiled: Compiled, mesh_frequency: float) -> Array:
    """Sizes of positions and velocities in the static state, in the metric of the mass."""
    system, nodes = compiled.system, compiled.nodes
    mass = np.sqrt(np.diag(np.asarray(system.mass)))
    position = static_start(compiled)[: system.size]
    size = float(np.max(mass * np.abs(position)))
    if not size > 0.0:
        inside = [np.abs(item).max(initial=0.0) for item in (nodes.error, nodes.gap)]
        size = float(mass.max() * (max(inside) or 1e-6))
    load = np.tensordot(nodes.weight, nodes.force, axes=2)
    speed = math.sqrt(max(float(load @ position), 0.0)) or 2.0 * math.pi * mesh_frequency * size
    return np.concatenate((size / mass, speed / mass))


def step_share(
    compiled: Compiled, duration: float, stiffness_scale: float = 1.0, damping_scale: float = 1.0
) -> float:
    """Error of a step over the tolerance of the motion."""
    system, nodes = compiled.system, compiled.nodes
    inverse = np.linalg.inv(np.asarray(system.mass))
    longest = 0.0
    pairs = (
        (stiffness_scale * nodes.stiffness, system.stiffness),
        (damping_scale * nodes.damping, system.damping),
    )
    for share in (0.0, 1.0):
        parts = []
        for values, own in pairs:
            contact = np.einsum(
                "rs,rsj,rsji,rsjk->ik", nodes.weight, values, nodes.direction, nodes.direction
            )
            parts.append(inverse @ (np.asarray(own) + share * contact))
        roots = state_roots(*parts)
        time = np.minimum(duration, 1.0 / np.maximum(-roots.real, 1e-3 / duration))
        longest = max(longest, float((np.abs(roots.imag) * time).max(initial=0.0)))
    share = _SHARE_WITH_GAP if np.any(nodes.gap > 0.0) else _SHARE
    return max(min(share, _BUDGET / max(longest, 1.0)), _LEAST)
