"""Compile kernels with Numba and cache them on disk where a folder can be written."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any

import numba as nb
from numba.core.runtime import rtsys

from tribodyn.compiled import announce, announced, cache_lock

#: What turns a function into a kernel.
Compile = Callable[[Any], Any]


def cached_njit(digest: str = "", text: str = "", time: str = "", **options: object) -> Compile:
    """Compile a function at its first call, and cache the code on disk if that is possible."""
    # digest: of all sources that end up in the code, see source_digest; text and time announce a
    # compilation that would otherwise look like a hang.

    def compile_kernel(function: object) -> Any:
        try:
            kernel = nb.njit(cache=True, **options)(function)
            if cache_lock.has_disk_cache(kernel):  # for example not with NUMBA_DISABLE_JIT
                _ignore_outdated_index(kernel._cache._cache_file)
                _load_code_alone(kernel)
                _tell_sources_apart(kernel._cache, digest)
        except RuntimeError as error:
            # Neither the source folder nor the home directory can be written: a container perhaps.
            if "no locator" not in str(error):
                raise
            _announce_missing_cache()
            kernel = nb.njit(**options)(function)
        return announced(kernel, text, time) if text else kernel

    return compile_kernel


def _tell_sources_apart(cached: Any, digest: str) -> None:
    """Let the key of cached code hold a digest: Numba looks at the file of the kernel alone."""
    key = cached._index_key
    cached._index_key = lambda *call: (*key(*call), digest)


def _ignore_outdated_index(cache_file: Any) -> None:
    """Treat an index of another version, whose classes have moved since, as an empty one."""
    load = cache_file._load_index

    def load_index() -> dict[Any, str]:
        try:
            return dict(load())
        except (ImportError, AttributeError):  # Numba unpickles before it compares the sources
            return {}

    cache_file._load_index = load_index


def _load_code_alone(kernel: object) -> None:
    """Load cached code without all that Numba can compile, which takes 0.7 s once in a process."""
    # Where code is not cached, the compiler loads it after all.
    cached: Any = getattr(kernel, "_cache", None)
    if not hasattr(cached, "_load_overload"):  # private: another version of Numba may lack it
        return

    def load_overload(signature: object, context: object) -> Any:
        """Code of a signature; None if it is not cached."""
        rtsys.initialize(context)
        with cached._guard_against_spurious_io_errors():
            return cached._load_overload(signature, context)

    cached.load_overload = load_overload


@cache
def _announce_missing_cache() -> None:
    announce(
        "compiled kernels cannot be cached, so that every process compiles them again: set "
        "NUMBA_CACHE_DIR to a folder that can be written"
    )
