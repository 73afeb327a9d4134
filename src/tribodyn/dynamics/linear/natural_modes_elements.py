"""The springs of which a stiffness matrix is made."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike

from tribodyn.dynamics.equations.system import System
from tribodyn.errors import InputError
from tribodyn.types import Array

#: Entries below this share of the row's largest are rounding of the sums.
_ROUNDING = 1e-12


def structure_elements(
    system: System, elements: Mapping[str, ArrayLike] | None = None
) -> dict[str, Array]:
    """Name the springs of the structure."""
    matrix = np.asarray(system.stiffness)
    size = float(np.abs(matrix).max(initial=0.0))
    if np.abs(matrix - matrix.T).max(initial=0.0) > 1e-9 * size:
        raise InputError(
            "the stiffness matrix is not symmetric",
            where="System.stiffness",
            why="Only a symmetric matrix stores energy",
            remedy="Give friction as the friction of a contact",
        )
    if elements is None:
        return _springs(matrix, tuple(system.names))
    given = {name: np.asarray(element, dtype=float) for name, element in elements.items()}
    wrong = [name for name, element in given.items() if element.shape != matrix.shape]
    if wrong or np.abs(sum(given.values()) - matrix).max() > 1e-9 * size:
        what = f'"{wrong[0]}" is no {matrix.shape} matrix' if wrong else "they do not add up"
        raise InputError(
            what,
            where="argument elements",
            why="The springs together are the stiffness matrix of the structure",
        )
    return given


def _springs(matrix: Array, names: tuple[str, ...]) -> dict[str, Array]:
    count = len(names)
    found: dict[str, Array] = {}
    for i in range(count):
        ground = float(matrix[i].sum())
        if abs(ground) > _ROUNDING * np.abs(matrix[i]).sum():
            found[names[i]] = _spring(count, i, None, ground)
        for k in range(i + 1, count):
            if matrix[i, k] != 0.0:
                found[f"{names[i]} - {names[k]}"] = _spring(count, i, k, -float(matrix[i, k]))
    return found


def _spring(count: int, i: int, k: int | None, stiffness: float) -> Array:
    along = np.zeros(count)
    along[i] = 1.0
    if k is not None:
        along[k] = -1.0
    return np.asarray(stiffness * np.outer(along, along))
