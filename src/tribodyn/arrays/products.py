"""Products of a small matrix and many vectors, laid out for what is done with them afterwards."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from tribodyn.types import Array

#: Gives an array of a shape, whatever is in it.
Room = Callable[[tuple[int, ...]], Array]


def times(vectors: Array, matrix: Array, lead: int = 0, room: Room = np.empty) -> Array:
    """Matrix (m, n) times vectors (..., n); all first items lie side by side, then all second ones.

    What sums and scales many vectors afterwards has long loops then. Along the first ``lead`` axes
    each has its own memory, which ``room`` gives.
    """
    flat = vectors.reshape(*vectors.shape[:lead], -1, vectors.shape[-1])
    memory = room((*flat.shape[:-2], len(matrix), flat.shape[-2]))
    found = np.swapaxes(np.matmul(matrix, np.swapaxes(flat, -1, -2), out=memory), -1, -2)
    return np.asarray(found.reshape(*vectors.shape[:-1], len(matrix)))
