"""Lock of the kernel cache: of several processes, the first to need a kernel compiles it."""

from __future__ import annotations

import hashlib
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext, suppress
from pathlib import Path
from typing import Any

#: Interval at which a waiting process polls the cache [s].
_POLL_INTERVAL = 0.05
#: Longest time that writing a kernel takes; a killed process leaves its marker file [s].
_WRITE_TIMEOUT = 10.0


class ElsewhereError(Exception):
    """Another process is compiling the requested kernel."""


class CacheLock:
    """Marker files, in a folder shared by the processes, that say which kernels are taken."""

    def __init__(self, folder: Path, wait: Callable[[], bool] | None = None) -> None:
        # ``wait`` returns whether the other processes still compile; without it nothing waits.
        self._folder, self._wait = folder, wait
        self._claimed: set[str] = set()

    def retry_load(self, kernel: str, announce: Callable[[], None]) -> bool:
        """Whether to load a missing kernel from the cache again, rather than to compile it."""
        name = hashlib.sha256(kernel.encode()).hexdigest()
        if name in self._claimed or self._claim(name):
            return False
        if self._wait is None:
            raise ElsewhereError
        announce()
        if not self._wait():
            self._claimed.add(name)  # The others have ended: this process compiles what is missing.
        time.sleep(_POLL_INTERVAL)
        return True

    def _claim(self, name: str) -> bool:
        """Whether this process is the first to create the marker of a kernel."""
        if self._create(self._folder / name):
            self._claimed.add(name)
        return name in self._claimed

    @contextmanager
    def writing(self) -> Iterator[None]:
        """Let one process at a time write into the cache: Numba numbers the files of a kernel."""
        marker, end = self._folder / "writing", time.monotonic() + _WRITE_TIMEOUT
        while not self._create(marker) and time.monotonic() < end:
            time.sleep(0.1 * _POLL_INTERVAL)
        try:
            yield
        finally:
            with suppress(OSError):
                marker.unlink()

    def _create(self, marker: Path) -> bool:
        """Create a marker file unless it exists; a folder that cannot be written locks nothing."""
        try:
            marker.touch(exist_ok=False)
        except OSError as error:
            return not isinstance(error, FileExistsError)
        return True


_active: list[CacheLock] = []


@contextmanager
def locked(lock: CacheLock) -> Iterator[None]:
    """Use a lock of the cache for all that is compiled inside the block."""
    _active.append(lock)
    try:
        yield
    finally:
        _active.remove(lock)


def use_lock(kernel: Any, announce: Callable[[], None]) -> None:
    """Let a kernel that is cached on disk respect the active lock."""
    cache: Any = getattr(kernel, "_cache", None)  # none where Numba is disabled
    if not hasattr(cache, "load_overload"):
        return
    load, save = cache.load_overload, cache.save_overload
    name = f"{kernel.py_func.__module__}.{kernel.py_func.__name__}"

    def load_overload(signature: object, context: object) -> Any:
        code = load(signature, context)
        while code is None and _active and _active[-1].retry_load(f"{name} {signature}", announce):
            code = load(signature, context)
        return code

    def save_overload(signature: object, data: object) -> None:
        with _active[-1].writing() if _active else nullcontext():
            save(signature, data)

    cache.load_overload, cache.save_overload = load_overload, save_overload


def has_disk_cache(kernel: object) -> bool:
    """Whether a kernel is cached on disk."""
    return hasattr(getattr(kernel, "_cache", None), "_cache_file")


def is_cached(kernel: Any) -> bool:
    """Whether the disk cache holds code of a kernel for this processor and these sources.

    True as well for a kernel without disk cache: no other process can compile it.
    """
    from numba.core.registry import cpu_target

    if not has_disk_cache(kernel):
        return True
    cache = kernel._cache
    target = cache._index_key(None, cpu_target.target_context.codegen())[1:]
    return any(key[1:] == target for key in cache._cache_file._load_index())
