"""Work arrays that are reused from call to call, so that their memory stays in the cache."""

from __future__ import annotations

import math
import threading
from collections.abc import Callable

import numpy as np

from tribodyn.types import Array

#: Returns an array of a name and a shape with undefined content.
Memory = Callable[[str, tuple[int, ...]], Array]


class _Workspace(threading.local):
    def __init__(self) -> None:
        self._arrays: dict[str, Array] = {}

    def array(self, name: str, shape: tuple[int, ...]) -> Array:
        """An array that is valid until this thread requests the same name again."""
        size = math.prod(shape)
        if name not in self._arrays or self._arrays[name].size < size:
            self._arrays[name] = np.empty(size)
        return self._arrays[name][:size].reshape(shape)


#: Reused memory of this thread.
reused_memory: Memory = _Workspace().array


def new_memory(name: str, shape: tuple[int, ...]) -> Array:
    """A new array, where :data:`reused_memory` would return one that is overwritten later."""
    return np.empty(shape)
