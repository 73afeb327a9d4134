"""Memory that lasts from one use to the next, as new memory is far from the processor."""

from __future__ import annotations

import math
import threading
from collections.abc import Callable

import numpy as np

from tribodyn.types import Array

#: Gives an array of a name and a shape, whatever is in it.
Memory = Callable[[str, tuple[int, ...]], Array]


class _Kept(threading.local):
    def __init__(self) -> None:
        self._arrays: dict[str, Array] = {}

    def room(self, name: str, shape: tuple[int, ...]) -> Array:
        """An array that lasts until this thread asks for that name again."""
        size = math.prod(shape)
        if name not in self._arrays or self._arrays[name].size < size:
            self._arrays[name] = np.empty(size)
        return self._arrays[name][:size].reshape(shape)


#: Memory of this thread.
kept_memory: Memory = _Kept().room


def new_memory(name: str, shape: tuple[int, ...]) -> Array:
    """An array of its own, as :data:`kept_memory` gives one that lasts until the next."""
    return np.empty(shape)
