"""Values of functions that are cached by the content of their arrays, and reused work arrays."""

from __future__ import annotations

import math
import os
import threading
from collections.abc import Callable
from typing import Any, Generic, TypeVar

import numpy as np
from numpy.typing import NDArray

from tribodyn.types import Array

Value = TypeVar("Value")
Arrays = tuple[NDArray[Any], ...]


class Memo(Generic[Value]):
    """The last values of a function, keyed by the content of its arguments."""

    def __init__(self, size: int) -> None:
        self._size = size
        self._entries: tuple[tuple[Arrays, Value], ...] = ()

    def get(self, arrays: Arrays, compute: Callable[[], Value]) -> Value:
        """The value for these arrays, from the cache or computed now."""
        entries = self._entries
        for key, value in entries:
            if all(map(_same, arrays, key)):
                return value
        value = compute()
        entry = tuple(array.copy() for array in arrays), value
        self._entries = (entry, *entries[: self._size - 1])
        return value


def _same(a: NDArray[Any], b: NDArray[Any]) -> bool:
    if a.shape != b.shape or (a.size and a.flat[-1] != b.flat[-1]):
        return False  # a cheap check before all elements are compared
    return bool((a == b).all())


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


def machine_memory() -> float:
    """Memory of this machine [byte]; infinite where the system does not report it."""
    try:
        return float(os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES"))
    except (AttributeError, OSError, ValueError):
        return math.inf
