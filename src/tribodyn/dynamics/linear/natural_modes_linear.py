"""A system made linear about its static load: matrices with the contacts in touch.

Only what carries at rest counts. Of a force law made of ramps the tangent at the static load
remains: the sum of the ramps that the compression reaches.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from tribodyn.dynamics.equations.grid import system_events
from tribodyn.dynamics.equations.load_friction import (
    carried_load,
    friction_secant,
    friction_tangent,
    push_with_friction,
)
from tribodyn.dynamics.equations.nodes import Nodes, force_laws, lowest_of_each_law, sampled
from tribodyn.dynamics.equations.system import System
from tribodyn.errors import InputError, require_between
from tribodyn.types import Array, Index, Mask

ModePhase = Literal["mean"] | float

#: Steps over which the mean of a cycle is taken, and rounds in which ramps open and close.
_STEPS, _ROUNDS = 256, 50


@dataclass(frozen=True)
class LinearSystem:
    """Matrices of a system about its static load."""

    names: tuple[str, ...]  #: names of the coordinates
    mass: Array  #: [kg or kg*m^2, N*s/m, N/m, ...]
    damping: Array  #: [kg or kg*m^2, N*s/m, N/m, ...]
    stiffness: Array  #: [kg or kg*m^2, N*s/m, N/m, ...]
    friction_damping: Array
    friction_stiffness: Array
    contact_stiffness: Array  #: share of each contact in ``stiffness`` [N/m, ...]
    contact_damping: Array  #: share of each contact in ``damping`` [N*s/m, ...]
    direction: Array  #: [1 or m]
    push: Array  #: [1 or m]
    spring: Array  #: stiffness of each contact, mean over the cycle [N/m]
    damper: Array  #: damping of each contact, mean over the cycle [N*s/m]
    bundle: Index  #: number of the force law to which each contact belongs


def linear_system(system: System, phase: ModePhase = "mean") -> LinearSystem:
    """Replace every contact by the spring and the damper that act at the static load."""
    nodes, weight = _rows(system, phase)
    closed, push = _at_rest(system, nodes)
    outer = np.einsum("rsji,rsjk->rsjik", nodes.direction, nodes.direction)
    rub = push - nodes.direction
    cross = np.einsum("rsji,rsjk->rsjik", rub, nodes.direction)
    spring = weight[:, :, None] * np.where(closed, nodes.stiffness, 0.0)
    free = np.array([contact.damping_in_gap for contact in system.contacts], dtype=bool)
    damper = weight[:, :, None] * np.where(closed | free, nodes.damping, 0.0)
    contact_stiffness = np.einsum("rsj,rsjik->jik", spring, outer)
    contact_damping = np.einsum("rsj,rsjik->jik", damper, outer)
    return LinearSystem(
        names=tuple(system.names),
        mass=np.asarray(system.mass),
        damping=np.asarray(system.damping) + contact_damping.sum(axis=0),
        stiffness=np.asarray(system.stiffness) + contact_stiffness.sum(axis=0),
        friction_damping=np.einsum("rsj,rsjik->ik", damper, cross),
        friction_stiffness=np.einsum("rsj,rsjik->ik", spring, cross),
        contact_stiffness=contact_stiffness,
        contact_damping=contact_damping,
        direction=np.einsum("rs,rsji->ji", weight, nodes.direction),
        push=np.einsum("rs,rsji->ji", weight, push),
        spring=spring.sum(axis=(0, 1)),
        damper=damper.sum(axis=(0, 1)),
        bundle=force_laws(nodes),
    )


def _rows(system: System, phase: ModePhase) -> tuple[Nodes, Array]:
    """Rows of the system with weights of sum 1: over the whole cycle, or at one phase."""
    if phase == "mean":
        _, nodes = sampled(system, max(_STEPS, 4 * len(system_events(system))))
        return nodes, nodes.weight
    if isinstance(phase, str):
        raise InputError(
            f'phase = "{phase}"', where="argument phase", why='"mean" or a mesh phase in [0, 1)'
        )
    at = float(phase)
    require_between("phase", at, 0.0, np.nextafter(1.0, 0.0), "")
    contacts = tuple(replace(contact, events=(*contact.events, at)) for contact in system.contacts)
    marked = replace(system, contacts=contacts)
    grid, nodes = sampled(marked, 4 * len(system_events(marked)))
    row = int(np.argmin(np.abs(grid.left - at)))
    single = Nodes(*(part[row : row + 1, :1] for part in nodes))
    return single, np.ones((1, 1))


def _at_rest(system: System, nodes: Nodes) -> tuple[Mask, Array]:
    """Contacts that carry at rest, and what a further newton of each pushes, friction included."""
    kept = np.broadcast_to(lowest_of_each_law(nodes), nodes.stiffness.shape)
    push = nodes.force_direction
    if kept.all() and not system.frictions:
        return np.array(kept), push
    closed = np.ones(nodes.stiffness.shape, dtype=bool)
    position = np.zeros(nodes.force.shape)
    load = np.zeros((*nodes.stiffness.shape[:2], len(system.frictions)))
    for _ in range(_ROUNDS):
        carrying = np.where(closed, nodes.stiffness, 0.0)
        last, position = position, _equilibrium(system, nodes, carrying, push)
        compression = np.einsum("rsji,rsi->rsj", nodes.direction, position) - nodes.error
        found = kept | (compression > nodes.gap)
        done = np.array_equal(found, closed)
        if system.frictions:
            load = carried_load(system, carrying * (compression - nodes.gap))
            ratio = friction_secant(system, nodes.friction_coefficients, load)
            push = push_with_friction(system, nodes, ratio)
            done &= bool(np.abs(position - last).max() <= 1e-12 * np.abs(position).max())
        if done:
            break
        closed = found
    tangent = friction_tangent(system, nodes.friction_coefficients, load)
    return closed, push_with_friction(system, nodes, tangent)


def _equilibrium(system: System, nodes: Nodes, carrying: Array, push: Array) -> Array:
    """Position at rest at every phase, (rows, stages, n); free motions get no displacement."""
    outer = np.einsum("rsji,rsjk->rsjik", push, nodes.direction)
    stiffness = system.stiffness + np.einsum("rsj,rsjik->rsik", carrying, outer)
    shift = carrying * (nodes.error + nodes.gap)
    force = nodes.force + np.einsum("rsj,rsji->rsi", shift, push)
    scale = 1.0 / np.sqrt(np.diag(np.asarray(system.mass)))
    inverse = np.linalg.pinv(stiffness * np.outer(scale, scale), rcond=1e-12)
    return np.asarray(scale * np.einsum("rsik,rsk->rsi", inverse, scale * force))
