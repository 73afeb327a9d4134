"""Directions of a mesh whose gears move in one plane, over the coordinates of a structure."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, cast

import numpy as np

from tribodyn.nomenclature import GEARS
from tribodyn.types import Array

#: Friction force over mesh force, and its moments on both gears; rows 1 to 3 of the directions.
FRICTION_SUMS = ("friction_sum", *(f"friction_moment_{gear}" for gear in GEARS))


def plane_rows(
    names: Sequence[str], gears: Sequence[str] = GEARS, line_angle: float = 0.5 * np.pi
) -> Array:
    """Rows (4, n): along the line of action, across it, and the rotation of either gear."""
    along = np.array([np.cos(line_angle), np.sin(line_angle)])
    along[np.abs(along) < 1e-15] = 0.0
    ways = {"x": along, "y": np.array([along[1], -along[0]])}
    rows = np.zeros((4, len(names)))
    for gear, sign, turn in zip(gears, (1.0, -1.0), (2, 3), strict=True):
        rows[turn, names.index(f"{gear}_theta")] = sign
        for way, row in (*ways.items(), ("v", ways["x"]), ("w", ways["y"])):
            if f"{gear}_{way}" in names:
                rows[:2, names.index(f"{gear}_{way}")] = sign * row
    return rows


def friction_direction(mesh: Any, onto: Array) -> Callable[..., Array]:
    """Friction of a mesh (p, n) from its three sums; a table if all three share their grid."""
    sums = [getattr(mesh, name) for name in FRICTION_SUMS]
    kind, grid = type(sums[0]), getattr(sums[0], "grid", None)
    if hasattr(kind, "onto") and all(type(e) is kind and e.grid is grid for e in sums):
        values = np.stack([each.values for each in sums], axis=-1)
        return cast("Callable[..., Array]", kind(grid, values, onto))
    return lambda phase: np.stack([np.asarray(each(phase)) for each in sums], axis=-1) @ onto
