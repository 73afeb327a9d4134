"""Processes that fill one cache: each kernel is compiled by the one that comes to it first."""

from __future__ import annotations

import hashlib
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext, suppress
from pathlib import Path
from typing import Any

#: Time between two looks at what the other process does [s].
_MOMENT = 0.05
#: Longest time that a process writes what it compiled; one that was killed leaves its mark [s].
_WRITING = 10.0


class ElsewhereError(Exception):
    """Another process compiles what this one was about to."""


class Agreement:
    """Who compiles what, as marks in a folder of the processes that agree."""

    def __init__(self, folder: Path, wait: Callable[[], bool] | None = None) -> None:
        # It tells whether the others still compile; without it nothing waits.
        self._folder, self._wait = folder, wait
        self._mine: set[str] = set()

    def look_again(self, what: str, tell: Callable[[], None]) -> bool:
        """Whether to look into the cache again for what is not there, rather than to compile it."""
        name = hashlib.sha256(what.encode()).hexdigest()
        if name in self._mine or self._marked(name):
            return False
        if self._wait is None:
            raise ElsewhereError
        tell()
        if not self._wait():
            self._mine.add(name)  # They have ended: whatever is not there by now is for this one.
        time.sleep(_MOMENT)
        return True

    def _marked(self, name: str) -> bool:
        """Whether this process is the first to leave a mark."""
        if self._leaves(self._folder / name):
            self._mine.add(name)
        return name in self._mine

    @contextmanager
    def writing(self) -> Iterator[None]:
        """Write into the cache one after the other: Numba numbers the files of a kernel."""
        mark, end = self._folder / "writing", time.monotonic() + _WRITING
        while not self._leaves(mark) and time.monotonic() < end:
            time.sleep(0.1 * _MOMENT)
        try:
            yield
        finally:
            with suppress(OSError):
                mark.unlink()

    def _leaves(self, mark: Path) -> bool:
        """Leave a mark where there is none yet; a place that takes none binds nobody."""
        try:
            mark.touch(exist_ok=False)
        except FileExistsError:
            return False
        except OSError:
            pass
        return True


_agreed: list[Agreement] = []


@contextmanager
def agreed(agreement: Agreement) -> Iterator[None]:
    """Compile by an agreement inside the block."""
    _agreed.append(agreement)
    try:
        yield
    finally:
        _agreed.remove(agreement)


def share(kernel: Any, tell: Callable[[], None]) -> None:
    """Let a kernel with a cache on disk keep to what is agreed."""
    cache: Any = getattr(kernel, "_cache", None)  # none where nothing is compiled
    if not hasattr(cache, "load_overload"):
        return
    load, save = cache.load_overload, cache.save_overload
    named = f"{kernel.py_func.__module__}.{kernel.py_func.__name__}"

    def load_overload(signature: Any, context: Any) -> Any:
        found = load(signature, context)
        while found is None and _agreed and _agreed[-1].look_again(f"{named} {signature}", tell):
            found = load(signature, context)
        return found

    def save_overload(signature: Any, data: Any) -> None:
        with _agreed[-1].writing() if _agreed else nullcontext():
            save(signature, data)

    cache.load_overload, cache.save_overload = load_overload, save_overload


def is_kept(kernel: Any) -> bool:
    """Whether a kernel has a cache on the disk."""
    return hasattr(getattr(kernel, "_cache", None), "_cache_file")


def cached(kernel: Any) -> bool:
    """Whether the disk cache holds anything of a kernel, for this processor and these sources.

    One that is not kept is no other process's to compile.
    """
    from numba.core.registry import cpu_target

    if not is_kept(kernel):
        return True
    cache = kernel._cache
    wanted = cache._index_key(None, cpu_target.target_context.codegen())[1:]
    return any(key[1:] == wanted for key in cache._cache_file._load_index())
