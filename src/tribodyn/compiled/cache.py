"""Compile kernels with Numba and cache them on disk where a folder can be written."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any

import numba as nb
from numba.core.runtime import rtsys

from tribodyn.compiled import announce


def cached_njit(**options: object) -> Callable[[Any], Any]:
    """Compile a function at its first call, and cache the code on disk if that is possible."""

    def compile_kernel(function: object) -> Any:
        try:
            kernel = nb.njit(cache=True, **options)(function)
            _ignore_outdated_index(kernel)
            _load_code_alone(kernel)
            return kernel
        except RuntimeError as error:
            # Neither the source folder nor the home directory can be written: a container perhaps.
            if "no locator" not in str(error):
                raise
            _announce_missing_cache()
            return nb.njit(**options)(function)

    return compile_kernel


def _ignore_outdated_index(kernel: object) -> None:
    """Treat an index of another version, whose classes have moved since, as an empty one."""
    cache_file = getattr(getattr(kernel, "_cache", None), "_cache_file", None)
    if cache_file is None:  # nothing is compiled, for example with NUMBA_DISABLE_JIT
        return
    load = cache_file._load_index

    def load_index() -> dict[Any, str]:
        try:
            index: dict[Any, str] = load()
        except (ImportError, AttributeError):  # Numba unpickles before it compares the sources
            return {}
        return index

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
