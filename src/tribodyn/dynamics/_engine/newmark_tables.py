"""A compiled system in the flat arrays that Newmark's scheme reads."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from tribodyn.dynamics.equations.grid import Grid
from tribodyn.dynamics.equations.nodes import Nodes
from tribodyn.dynamics.equations.system import System
from tribodyn.types import Array, Index

_MATRICES = ("mass", "damping", "stiffness")


@dataclass(frozen=True)
class NewmarkTables:
    """What the lanes share, in flat arrays."""

    shape: tuple[int, int, int, int]
    structure: tuple[Index, Index, Array]
    matrices: Array  #: mass, damping, stiffness and inverse mass
    rows: Array  #: row table, see :mod:`~tribodyn.dynamics.newmark_force`
    widths: Array  #: different phase widths of steps [-]
    kind: Index  #: which of them each step has
    dead: Index  #: whether a contact has a dead zone
    facts: Array  #: numbers of contacts and frictions that do not vary


def newmark_tables(
    system: System, nodes: Nodes, grid: Grid, *, split: bool = False
) -> NewmarkTables:
    """Lay out a system on its grid for Newmark's scheme."""
    n, contacts = system.size, len(system.contacts)
    mass, damping, stiffness = (np.asarray(getattr(system, name)) for name in _MATRICES)
    both = np.hstack((stiffness, damping))
    at, columns = np.nonzero(both)
    first = np.concatenate(([0], np.cumsum(np.bincount(at, minlength=n))))
    numbers = [nodes.stiffness, nodes.damping, nodes.error, nodes.error_slope, nodes.gap]
    per_contact = np.concatenate(
        (
            np.stack(numbers, axis=-1),
            nodes.direction,
            nodes.direction_slope,
            nodes.direction if split else nodes.force_direction,
        ),
        axis=-1,
    )
    flat = per_contact.reshape(*nodes.phase.shape, contacts * (5 + 3 * n))
    rubbing, (frictions, coefficients), facts = _frictions(system, nodes, split)
    widths, kind = np.unique(grid.width, return_inverse=True)
    inverse = np.linalg.inv(mass)
    return NewmarkTables(
        shape=(n, contacts, frictions, coefficients),
        structure=(first.astype(np.int64), columns.astype(np.int64), both[at, columns]),
        matrices=np.concatenate([part.ravel() for part in (mass, damping, stiffness, inverse)]),
        rows=np.ascontiguousarray(np.concatenate((flat, rubbing, nodes.force), axis=-1)).reshape(
            -1
        ),
        widths=widths,
        kind=kind.astype(np.int64),
        dead=np.any(nodes.gap > 0.0, axis=(0, 1)).astype(np.int64),
        facts=np.array([float(contact.damping_in_gap) for contact in system.contacts] + facts),
    )


def _frictions(
    system: System, nodes: Nodes, split: bool
) -> tuple[Array, tuple[int, int], list[float]]:
    """Rows, numbers and facts of the frictions that follow their load."""
    contacts = len(system.contacts)
    if not (system.frictions or split):
        return np.zeros((*nodes.phase.shape, 0)), (0, 0), []
    direction, coefficients = nodes.friction_direction, nodes.friction_coefficients
    facts: list[float] = []
    for one in system.frictions:
        facts += [1.0 / float(one.load), float(one.limit)]
        facts += [float(j in one.contacts) for j in range(contacts)]
    if split:
        # The friction of a contact as one with the coefficient 1, to be scaled by itself.
        own = np.zeros((*nodes.phase.shape, contacts, coefficients.shape[-1]))
        own[..., 0] = 1.0
        rub = nodes.force_direction - nodes.direction
        direction = np.concatenate((direction, rub), axis=2)
        coefficients = np.concatenate((coefficients, own), axis=2)
        for j in range(contacts):
            facts += [0.0, 1.0, *(float(j == other) for other in range(contacts))]
    both = np.concatenate((direction, coefficients), axis=-1)
    shape = int(direction.shape[2]), int(coefficients.shape[-1])
    return both.reshape(*nodes.phase.shape, -1), shape, facts
