"""A system linearised about its static load."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from tribodyn.dynamics.equations.grid import system_events, unrepeated
from tribodyn.dynamics.equations.nodes import (
    Nodes,
    carried_load,
    combined,
    force_laws,
    friction_secant,
    friction_tangent,
    lowest_of_each_law,
    push_with_friction,
    sampled,
)
from tribodyn.dynamics.equations.ramps import split_ramps
from tribodyn.dynamics.equations.system import System
from tribodyn.errors import InputError, require_between
from tribodyn.types import Array, Index, Mask

ModePhase = Literal["mean"] | float

#: Steps over which a cycle is averaged, and iterations in which ramps open and close.
_STEPS, _ROUNDS = 256, 50
#: Part of the largest stiffness, or of the longest direction, that is none.
_ZERO = 1e-12


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
    direction: Array  #: [1 or m]
    push: Array  #: [1 or m]
    gyroscopic: Array | None  #: skew matrix of the gyroscopic moments [N*s/m, ...]
    spring: Array  #: stiffness of each contact, mean over the cycle [N/m]
    damper: Array  #: damping of each contact, mean over the cycle [N*s/m]
    bundle: Index  #: number of the force law to which each contact belongs


def linear_system(system: System, phase: ModePhase = "mean") -> LinearSystem:
    """Replace every contact by the spring and the damper that act at the static load; cached."""
    if phase not in system._linear:
        system._linear[phase] = _linearised(split_ramps(system), phase)
    linear: LinearSystem = system._linear[phase]
    return linear


def _linearised(system: System, phase: ModePhase) -> LinearSystem:
    nodes, weight = _rows(system, phase)
    closed, push = _at_rest(system, nodes)
    along, rub = nodes.direction, combined(np.subtract, push, nodes.direction)
    spring = weight[:, :, None] * np.where(closed, nodes.stiffness, 0.0)
    free = np.array([contact.damping_in_gap for contact in system.contacts], dtype=bool)
    damper = weight[:, :, None] * np.where(closed | free, nodes.damping, 0.0)
    contact_stiffness = _over_cycle(spring, along, along)
    return LinearSystem(
        names=tuple(system.names),
        mass=np.asarray(system.mass),
        damping=np.asarray(system.damping) + _over_cycle(damper, along, along).sum(axis=0),
        stiffness=np.asarray(system.stiffness) + contact_stiffness.sum(axis=0),
        friction_damping=_over_cycle(damper, rub, along).sum(axis=0),
        friction_stiffness=_over_cycle(spring, rub, along).sum(axis=0),
        contact_stiffness=contact_stiffness,
        direction=_mean(weight, along),
        push=_mean(weight, push),
        gyroscopic=None if system.gyroscopic is None else np.asarray(system.gyroscopic),
        spring=spring.sum(axis=(0, 1)),
        damper=damper.sum(axis=(0, 1)),
        bundle=force_laws(nodes),
    )


def _mean(weight: Array, directions: Array) -> Array:
    """Mean of directions over the cycle, (contacts, n)."""
    directions = unrepeated(directions, 2)
    weight = weight if directions.shape[:2] == weight.shape else np.ones((1, 1))
    return np.asarray(np.einsum("rs,rsji->ji", weight, directions))


def _over_cycle(factor: Array, rows: Array, columns: Array) -> Array:
    """Sum over the cycle of a factor times two directions, for each contact (contacts, n, n)."""
    rows, columns = unrepeated(rows, 2), unrepeated(columns, 2)
    if rows.shape[:2] == columns.shape[:2] == (1, 1):
        factor = factor.sum(axis=(0, 1), keepdims=True)
    shape = (factor.shape[0] * factor.shape[1], *rows.shape[2:])
    left = (factor[..., None] * rows).reshape(shape).transpose(1, 2, 0)
    if columns.shape[:2] == (1, 1):
        return np.asarray(left.sum(axis=-1, keepdims=True) * columns[0, 0][:, None])
    return np.asarray(
        left @ (columns + np.zeros_like(factor[..., None])).reshape(shape).transpose(1, 0, 2)
    )


def _rows(system: System, phase: ModePhase) -> tuple[Nodes, Array]:
    """Rows of the system with weights of sum 1: over the whole cycle, or at one phase."""
    if phase == "mean":
        _, nodes = sampled(system, max(_STEPS * system.cycles, 4 * len(system_events(system))))
        return nodes, nodes.weight
    if isinstance(phase, str):
        why = '"mean" or a mesh phase in [0, 1)'
        raise InputError(f'phase = "{phase}"', "argument phase", why, "Choose one of the two")
    at = float(phase)
    require_between("phase", at, 0.0, np.nextafter(1.0, 0.0), "")
    clocked = system.clocked_contacts
    contacts = tuple(replace(contact, events=(*contact.events, at)) for contact in clocked)
    marked = replace(system, contacts=contacts, frictions=system.clocked_frictions)
    grid, nodes = sampled(marked, 4 * len(system_events(marked)))
    row = int(np.argmin(np.abs(grid.left - at)))
    single = Nodes(*(part[row : row + 1, :1] for part in nodes))
    return single, np.ones((1, 1))


def _at_rest(system: System, nodes: Nodes) -> tuple[Mask, Array]:
    """Contacts that are closed at rest, and the generalized force per newton with friction."""
    lowest = np.broadcast_to(lowest_of_each_law(nodes), nodes.stiffness.shape)
    push = nodes.force_direction
    if lowest.all() and not system.frictions:
        return np.array(lowest), push
    still, closed = _Rest(system, nodes), np.ones(nodes.stiffness.shape, dtype=bool)
    load = np.zeros((*nodes.stiffness.shape[:2], len(system.frictions)))
    for _ in range(_ROUNDS):
        carrying = np.where(closed, nodes.stiffness, 0.0)
        compression = still.compression(carrying, push)
        updated = lowest | (compression > nodes.gap)
        done = np.array_equal(updated, closed)
        if system.frictions:
            last, load = load, carried_load(system, carrying * (compression - nodes.gap))
            ratio = friction_secant(system, nodes.friction_coefficients, load)
            push = push_with_friction(system, nodes, ratio)
            done &= bool(np.abs(load - last).max() <= 1e-12 * np.abs(load).max())
        if done:
            break
        closed = updated
    tangent = friction_tangent(system, nodes.friction_coefficients, load)
    return closed, push_with_friction(system, nodes, tangent)


class _Rest:
    """Compression of the contacts at rest at every phase; free motions get no displacement."""

    # The structure is inverted once, with its contacts at their mean stiffness. What differs at a
    # phase acts between the few directions of the contacts (the formula of Woodbury).
    def __init__(self, system: System, nodes: Nodes) -> None:
        scale = 1.0 / np.sqrt(np.diag(np.asarray(system.mass)))
        along = unrepeated(nodes.direction, 2) * scale
        upper = np.linalg.qr(along.reshape(-1, system.size), mode="r")
        _, sizes, basis = np.linalg.svd(upper, full_matrices=False)
        basis = basis[sizes > _ZERO * sizes[0]]
        feel = along @ basis.T
        spring = (nodes.weight[..., None] * nodes.stiffness)[..., None] * feel
        mean = np.einsum("rsja,rsjb->ab", spring, feel + np.zeros_like(spring))
        matrix = np.asarray(system.stiffness) * np.outer(scale, scale)
        left, values, right = np.linalg.svd(matrix + basis.T @ mean @ basis)
        nonzero = values > _ZERO * values[0]
        # Motion along the directions of the contacts per force, and the forces that move freely.
        reach, free = (
            (basis @ right[nonzero].T / values[nonzero]) @ left[:, nonzero].T,
            left[:, ~nonzero],
        )
        self._nodes, self._feel, self._square = nodes, feel, reach @ reach.T
        self._still, self._lost = np.eye(len(basis)) - reach @ basis.T @ mean, mean.T @ basis @ free
        self._project = scale[:, None] * np.hstack((reach.T, free))

    def compression(self, carrying: Array, push: Array) -> Array:
        """Compressions (rows, stages, contacts) where contacts of a stiffness push."""
        nodes, feel, size = self._nodes, self._feel, len(self._square)
        parts = unrepeated(push, 2) @ self._project
        shift = carrying * (nodes.error + nodes.gap)
        force = nodes.force @ self._project + np.einsum("rsj,rsja->rsa", shift, parts)
        pressed = np.swapaxes(carrying[..., None] * feel, -1, -2) @ parts
        matrix = self._still + np.swapaxes(pressed[..., :size], -1, -2)
        moved, turned = force[..., :size, None], pressed[..., size:] - self._lost
        if turned.any():
            # Forces with friction that accelerate the free motions are left out.
            bent = np.linalg.solve(np.swapaxes(matrix, -1, -2), turned)
            back = np.swapaxes(bent, -1, -2)
            gained = force[..., size:, None] - back @ moved
            share = np.linalg.solve(np.eye(gained.shape[-2]) + back @ self._square @ bent, gained)
            moved = moved + self._square @ bent @ share
        return np.asarray((feel @ np.linalg.solve(matrix, moved))[..., 0] - nodes.error)
