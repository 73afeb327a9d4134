"""A compiled system in the flat arrays that Newmark's scheme reads."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from tribodyn.dynamics.grid import Grid
from tribodyn.dynamics.program import Nodes
from tribodyn.dynamics.system import System

__all__ = ["NewmarkTables", "newmark_tables"]

Array = NDArray[np.float64]

_MATRICES = ("mass", "damping", "stiffness")


@dataclass(frozen=True)
class NewmarkTables:
    """What the lanes share, in flat arrays.

    Parameters
    ----------
    shape : tuple of four int
        Coordinates, contacts, frictions that follow their load, and their coefficients.
    structure : tuple of arrays
        Damping and stiffness by row, only what is not zero: first items, columns, factors.
    matrices : (4 n^2,) array
        Mass, damping, stiffness and inverse mass.
    rows : (steps * 3 * columns,) array
        Row table, see :mod:`~tribodyn.dynamics.newmark_force`.
    widths : (kinds,) array
        Different phase widths of steps [-].
    kind : (steps,) array
        Which of them each step has.
    dead : (contacts,) array
        Whether a contact has a dead zone.
    facts : array
        Numbers of contacts and frictions that do not vary.
    """

    shape: tuple[int, int, int, int]
    structure: tuple[NDArray[np.int64], NDArray[np.int64], Array]
    matrices: Array
    rows: Array
    widths: Array
    kind: NDArray[np.int64]
    dead: NDArray[np.int64]
    facts: Array


def newmark_tables(
    system: System, nodes: Nodes, grid: Grid, *, split: bool = False
) -> NewmarkTables:
    """Lay out a system on its grid for Newmark's scheme.

    Parameters
    ----------
    system : System
    nodes : Nodes
    grid : Grid
    split : bool
        Whether lanes scale the friction of the contacts, which is then a force of its own.

    Returns
    -------
    NewmarkTables
    """
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
