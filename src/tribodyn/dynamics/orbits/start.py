"""Where a search begins: the static equilibrium at mean stiffness."""

from __future__ import annotations

import numpy as np

from tribodyn.dynamics.equations.compiled import Compiled
from tribodyn.dynamics.equations.load_friction import (
    carried_load,
    friction_secant,
    push_with_friction,
)
from tribodyn.dynamics.equations.motion import compression
from tribodyn.dynamics.equations.nodes import lowest_of_each_law
from tribodyn.types import Array

#: Rounds in which the ramps of a force law open and close; each round goes down the law.
#: The same number of rounds is enough for the friction that goes with the load.
_ROUNDS = 50


def static_start(compiled: Compiled) -> Array:
    """State at rest under the mean loads, every contact on its driving flank."""
    nodes = compiled.nodes
    kept = lowest_of_each_law(nodes)
    carrying = nodes.stiffness
    position = _equilibrium(compiled, carrying)
    for _ in range(0 if kept.all() else _ROUNDS):
        beyond = compression(nodes, position) > nodes.gap
        closed = np.where(kept | beyond, nodes.stiffness, 0.0)
        if np.array_equal(closed, carrying):
            break
        carrying = closed
        position = _equilibrium(compiled, carrying)
    return np.concatenate((position, np.zeros(compiled.system.size)))


def _equilibrium(compiled: Compiled, carrying: Array) -> Array:
    """Position at rest with the stiffness (steps, 3, contacts) that carries."""
    system, nodes = compiled.system, compiled.nodes
    position = _balance(compiled, carrying, nodes.force_direction)
    for _ in range(_ROUNDS if system.frictions else 0):
        load = carried_load(system, carrying * (compression(nodes, position) - nodes.gap))
        ratio = friction_secant(system, nodes.friction_coefficients, load)
        last, position = (
            position,
            _balance(compiled, carrying, push_with_friction(system, nodes, ratio)),
        )
        if np.abs(position - last).max() <= 1e-12 * np.abs(position).max():
            break
    return position


def _balance(compiled: Compiled, carrying: Array, push: Array) -> Array:
    """Position at rest if each newton of a contact pushes with ``push`` (steps, 3, contacts, n)."""
    system, nodes = compiled.system, compiled.nodes
    weight = nodes.weight
    outer = np.einsum("rsji,rsjk->rsjik", push, nodes.direction)
    stiffness = system.stiffness + np.einsum("rs,rsj,rsjik->ik", weight, carrying, outer)
    shift = carrying * (nodes.error + nodes.gap)
    force = np.einsum("rs,rsi->i", weight, nodes.force)
    force = force + np.einsum("rs,rsj,rsji->i", weight, shift, push)
    # Least squares in mass-weighted coordinates: free motions get no displacement.
    scale = 1.0 / np.sqrt(np.diag(np.asarray(system.mass)))
    matrix = stiffness * np.outer(scale, scale)
    return np.asarray(scale * np.linalg.lstsq(matrix, scale * force, rcond=1e-12)[0])
