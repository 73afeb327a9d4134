"""Eigenvectors whose signs, and whose bases of equal eigenvalues, are not chosen by rounding."""

from __future__ import annotations

from typing import Any

import numpy as np

from tribodyn.types import Array, Index

#: Distance of equal eigenvalues over their size, and over the largest one of all.
_EQUAL, _NOISE = 1e-9, 1e-13
#: Entries that differ by less than this part are equally large.
_ALIKE = 1e-6


def groups_of_equal(values: Array) -> list[Index]:
    """Numbers of the equal ones among ascending values, group by group."""
    distance = _EQUAL * np.abs(values[1:]) + _NOISE * np.abs(values).max(initial=0.0)
    return np.split(np.arange(values.size), np.flatnonzero(np.diff(values) > distance) + 1)


def leading(vectors: Any) -> Any:
    """First of the largest entries of each row (m, n), as a column (m, 1)."""
    size = np.abs(vectors)
    first = (size >= (1.0 - _ALIKE) * size.max(axis=1, keepdims=True)).argmax(axis=1)
    return np.take_along_axis(vectors, first[:, None], axis=1)


def standard_rotation(values: Array, vectors: Any) -> Any:
    """Rotation (m, m) of eigenvectors, rows (m, n), to a basis of equal ascending values (m,)."""
    # The first row of a group gets all of the column in which the group is largest, as a positive
    # entry, the next one of what is left, and so on: whatever their basis was.
    rotation = np.zeros((len(vectors),) * 2, dtype=vectors.dtype)
    for group in groups_of_equal(values):
        left = vectors[group]
        for row in group:
            size = np.linalg.norm(left, axis=0)
            column = int((size >= (1.0 - _ALIKE) * size.max()).argmax())
            part = left[:, column].conj() / (size[column] or 1.0)
            rotation[row, group] = part
            left = left - np.outer(part.conj(), part @ left)
    return rotation
