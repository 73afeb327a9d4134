"""Contacts of a plane pair of gears in space, and over the coordinates of a structure.

A plane pair has the coordinates x (across the line of action, in the direction of the surface
speeds), y (along it, towards the driven gear) and theta (in the running sense) of its first gear,
then those of its second gear.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any, TypeVar

import numpy as np

from tribodyn.dynamics import Contact, LoadFriction
from tribodyn.machine.graph.directions import MeshDirection
from tribodyn.types import Array

T = TypeVar("T", Contact, LoadFriction)


def plane_coordinates(direction: MeshDirection, *, first_drives: bool) -> Array:
    """Coordinates of a plane pair from those of both gear nodes in space, (6, 12)."""
    along = np.array([0.0, *direction.normal[1:]]) * (1.0 if first_drives else -1.0)
    rows = np.zeros((6, 12))
    for gear, sense in enumerate(direction.senses):
        first = 6 * gear
        rows[3 * gear, first : first + 3] = direction.across
        rows[3 * gear + 1, first : first + 3] = along
        rows[3 * gear + 2, first + 3] = sense
    return rows


def projected(part: T, onto: Array, **changes: Any) -> T:
    """Contact or friction whose directions are over other coordinates."""
    entries = {name: getattr(part, name, None) for name in ("direction", "friction")}
    moved = {n: _entry(entry, onto) for n, entry in entries.items() if entry is not None}
    return replace(part, **moved, **changes)


def _entry(entry: Any, onto: Array) -> Any:
    if not callable(entry):
        return np.asarray(entry, dtype=float) @ onto
    if getattr(entry, "onto", None) is not None:  # a table stays a table
        return type(entry)(entry.grid, entry.values, entry.onto @ onto)
    return lambda phase: np.asarray(entry(phase)) @ onto
