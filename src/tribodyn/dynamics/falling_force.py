"""Refusing a contact whose force falls while it is pressed together."""

from __future__ import annotations

import numpy as np

from tribodyn.errors import InputError, Problem
from tribodyn.types import Array

#: Sums of stiffnesses below zero by less than this part of the largest are rounding.
_ROUNDING = 1e-9


def refuse_falling_force(
    phase: Array, stiffness: Array, gap: Array, direction: Array, error: Array
) -> None:
    """Refuse dead zones beyond which the force of a mesh falls with compression."""
    dead = np.flatnonzero(np.any(gap > 0.0, axis=(0, 1)))
    if not np.any(stiffness[:, :, dead] < 0.0):
        return
    floor = -_ROUNDING * float(np.abs(stiffness).max())
    for j in dead:
        total = np.zeros(phase.shape)
        for i in range(stiffness.shape[2]):
            same = np.array_equal(direction[:, :, i], direction[:, :, j]) and np.array_equal(
                error[:, :, i], error[:, :, j]
            )
            if same:
                total += np.where(gap[:, :, i] <= gap[:, :, j], stiffness[:, :, i], 0.0)
        if total.min() < floor:
            at = np.unravel_index(int(np.argmin(total)), total.shape)
            raise InputError(
                Problem(
                    what=f"the force falls by {-total[at]:.4g} N per m of compression beyond "
                    f"{1e6 * gap[(*at, j)]:.4g} um, at the mesh phase {phase[at]:.4g}",
                    where=f"contacts[{j}].stiffness",
                    why="A contact that is pressed together pushes back more: a force law that "
                    "falls has several compressions for one load",
                    remedy="Give contacts with a dead zone stiffnesses whose sum, from the lowest "
                    "to any other, is not negative",
                )
            )
