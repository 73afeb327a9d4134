"""Refusing a contact whose force falls while it is pressed together."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from tribodyn.errors import InputError, Problem

__all__ = ["refuse_falling_force"]

Array = NDArray[np.float64]

#: Sums of stiffnesses below zero by less than this part of the largest are rounding.
_ROUNDING = 1e-9


def refuse_falling_force(
    phase: Array, stiffness: Array, gap: Array, direction: Array, error: Array
) -> None:
    """Refuse dead zones beyond which the force of a mesh falls with compression.

    Parameters
    ----------
    phase : (steps, 3) array
        Mesh phase of the nodes.
    stiffness : (steps, 3, contacts) array
        Stiffness [N/m].
    gap : (steps, 3, contacts) array
        Half dead zone [m].
    direction : (steps, 3, contacts, n) array
        Derivative of the compression [1 or m].
    error : (steps, 3, contacts) array
        Displacement error [m]; contacts that share it and the direction are ramps of one law.

    Raises
    ------
    InputError
        If the stiffness of a contact with a dead zone, together with that of the ramps below it,
        is negative.

    Notes
    -----
    A force law that falls has several compressions for one load, and the search for orbits, the
    step limit and the linear modes would each take another of them. A negative stiffness without a
    dead zone is a linear spring and stays allowed.

    Examples
    --------
    >>> one = np.ones((1, 3, 1))
    >>> refuse_falling_force(one[..., 0], 1e8 * one, 1e-5 * one, one[..., None], 0.0 * one)
    """
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
