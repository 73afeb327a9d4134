"""Contacts of a pair of gears in space, and over the coordinates of a structure.

A pair has the coordinates x (across the line of action, in the direction of the surface speeds),
y (along it, towards the driven gear) and theta (in the running sense) of its first gear, then those
of its second gear. Where the force has an axial part or moves over the face, each gear has x, y, z
(along the axes, in the sense in which the first gear turns), rotations about x and y, and theta.
A pair on crossed axes has those of its mesh table, alone or between engine and load, with a driving
pinion; a driving wheel turns it back in time.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from tribodyn.dynamics import Contact, LoadFriction
from tribodyn.machine.graph.crossed import CrossedGeometry
from tribodyn.machine.graph.directions import MeshDirection
from tribodyn.machine.mesh import PHASES, Mesh
from tribodyn.types import Array, Tree

if TYPE_CHECKING:
    from tribodyn.machine.machine import Machine

T = TypeVar("T", Contact, LoadFriction)
#: Coordinates of a pair in space that a plane pair has.
_PLANE = [0, 1, 5, 6, 7, 11]
#: Entries of contacts and friction that may be functions of the phase.
_ENTRIES = (
    *("direction", "stiffness", "damping", "error", "gap", "friction", "coefficients"),
    *("ramp_stiffness", "ramp_gap"),
)
#: Number of coordinates of a pair in space.
SPATIAL = 12


def pair_coordinates(
    direction: MeshDirection,
    size: int,
    *,
    first_drives: bool,
    crossing: CrossedGeometry | None = None,
) -> Array:
    """The coordinates of a pair from those of both gear nodes in space, (size, 12)."""
    if crossing is not None:
        between, sign = (size - SPATIAL) // 2, 1 if first_drives else -1
        senses = sign * direction.senses[0], sign * direction.senses[1]
        return np.pad(crossing.pair_coordinates(senses), ((between, between), (0, 0)))
    along = np.array([0.0, *direction.normal[1:]]) * (1.0 if first_drives else -1.0)
    axis = np.array([direction.senses[0], 0.0, 0.0])
    rows = np.zeros((SPATIAL, SPATIAL))
    for gear, sense in enumerate(direction.senses):
        first = 6 * gear
        rows[first : first + 3, first : first + 3] = direction.across, along, axis
        rows[first + 3 : first + 5, first + 3 : first + 6] = direction.across, along
        rows[first + 5, first + 3] = sense
    return rows if size == SPATIAL else rows[_PLANE]


def coordinate_count(part: Contact | LoadFriction) -> int:
    """Number of coordinates of the directions of a contact or of friction."""
    entry: Any = part.direction
    return int(np.shape(entry(np.zeros(1)) if callable(entry) else entry)[-1])


def _mean(contact: Contact) -> Array:
    entry: Any = contact.direction
    return np.asarray(entry(PHASES).mean(axis=0) if callable(entry) else entry, dtype=float)


def mean_in_space(machine: Machine, name: str) -> Array:
    """Mean over the mesh phase of the direction of a mesh, by the nodes of both gears (12,)."""
    mesh, direction = machine.meshes[name], machine.directions[name]
    if not mesh.contacts:
        return direction.direction
    drives, mean = machine.kinematics.meshes[name].driver == mesh.gears[0], _mean(mesh.contacts[0])
    onto = pair_coordinates(direction, mean.size, first_drives=drives, crossing=mesh.crossing)
    return np.asarray(mean @ onto)


def with_exchanged_gears(mesh: Mesh, *, internal: bool) -> Mesh:
    """Mesh whose contacts were those of its second and its first gear, in this order."""

    def exchanged(part: T) -> T:
        size = coordinate_count(part)
        rows = np.roll(np.eye(size), size // 2, axis=0)
        if size == SPATIAL and not internal:  # z follows the rotation of the first gear
            rows[[2, 8]] *= -1.0
        return projected(part, rows)

    contacts, frictions = map(exchanged, mesh.contacts), map(exchanged, mesh.frictions)
    return replace(mesh, contacts=tuple(contacts), frictions=tuple(frictions))


def run_back(part: T) -> T:
    """Contact or friction of a driving pinion for a driving wheel, which turns it back in time."""
    changes: Tree = {n: _back(getattr(part, n)) for n in _ENTRIES if hasattr(part, n)}
    # What slides the other way rubs the other way.
    opposed = "friction" if "friction" in changes else "coefficients"
    changes[opposed] = _opposed(changes[opposed])
    return replace(part, **changes, events=tuple(sorted({-event % 1.0 for event in part.events})))


def _back(entry: object) -> Any:
    return (lambda phase: entry(-np.asarray(phase) % 1.0)) if callable(entry) else entry


def _opposed(entry: object) -> Any:
    if callable(entry):
        return lambda phase: -np.asarray(entry(phase))
    return None if entry is None else -np.asarray(entry)


def projected(part: T, onto: Array, **changes: Any) -> T:
    """Contact or friction whose directions are over other coordinates."""
    entries = {name: getattr(part, name, None) for name in ("direction", "friction")}
    moved = {n: _entry(entry, onto) for n, entry in entries.items() if entry is not None}
    return replace(part, **moved, **changes)


def _entry(entry: Any, onto: Array) -> Any:
    if not callable(entry):
        return np.asarray(entry, dtype=float) @ onto
    if hasattr(entry, "onto"):  # a table stays a table
        onto = onto if entry.onto is None else entry.onto @ onto
        return type(entry)(entry.grid, entry.values, onto)
    return lambda phase: np.asarray(entry(phase)) @ onto
