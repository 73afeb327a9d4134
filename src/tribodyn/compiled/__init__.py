"""Compiled kernels: disk cache keyed by their sources, and messages while they compile."""

from __future__ import annotations

import gc
import hashlib
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from typing import Any, TypeVar

from tribodyn.compiled import cache_lock

__all__ = ["announce", "announced", "announcing_to", "source_digest"]

Kernel = TypeVar("Kernel")

#: Message of each kernel that has not been compiled yet.
_texts: dict[Any, str] = {}

#: All kernels that announce their compilation.
kernels: list[Any] = []


def source_digest(folder: str | Path, names: Sequence[str]) -> str:
    """Hash of the source files of a kernel and of everything that it calls."""
    # Numba looks at the file of the cached function alone, and would load a stale one after a
    # change in a file that it calls. Hence this hash is a part of the cache key.
    content = [(Path(folder) / f"{name}.py").read_bytes() for name in names]
    return hashlib.sha256(b"".join(content)).hexdigest()


def announced(kernel: Kernel, description: str, time: str) -> Kernel:
    """Announce the compilation of a kernel, which otherwise looks like a hang."""
    kernels.append(kernel)
    scope = "once on this machine" if cache_lock.has_disk_cache(kernel) else "for this process"
    _texts[kernel] = f"compiling {description}, {scope}, about {time}"
    _listen()
    cache_lock.use_lock(kernel, lambda: _announce_kernel(kernel))
    return kernel


def _announce_kernel(kernel: object) -> None:
    """Announce the compilation of a kernel once."""
    if kernel in _texts:
        announce(_texts.pop(kernel))


@cache
def _listen() -> None:
    """Register for the events of Numba's compiler, once."""
    from numba.core import event

    class Compiling(event.Listener):  # type: ignore[misc]
        depth = 0

        def on_start(self, event: Any) -> None:
            # The compiler creates millions of objects: garbage collection takes a noticeable part
            # of its time and frees next to nothing.
            if self.depth == 0:
                self.collects = gc.isenabled()
                gc.disable()
            self.depth += 1
            _announce_kernel(event.data["dispatcher"])

        def on_end(self, event: object) -> None:
            self.depth -= 1
            if self.depth == 0 and self.collects:
                gc.enable()

    event.register("numba:compile", Compiling())


def _to_terminal(text: str) -> None:
    """Write to an interactive terminal or a notebook."""
    if sys.stderr.isatty() or hasattr(sys, "ps1"):
        sys.stderr.write(f"tribodyn: {text}\n")


_receivers: list[Callable[[str], None]] = [_to_terminal]


def announce(text: str) -> None:
    """Pass a message about a long computation to the active receiver."""
    _receivers[-1](text)


@contextmanager
def announcing_to(receiver: Callable[[str], None]) -> Iterator[None]:
    """Let a function receive the messages about compilation and long computations in the block."""
    _receivers.append(receiver)
    try:
        yield
    finally:
        _receivers.remove(receiver)
