"""How compiled kernels are kept on disk, by the content of all their sources, and announced."""

from __future__ import annotations

import gc
import hashlib
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from typing import Any, TypeVar

from tribodyn.compiled import agreement

__all__ = ["announced", "source_digest", "tell", "telling"]

Kernel = TypeVar("Kernel")

#: What is told of a kernel when it is first compiled; by kernel.
_texts: dict[Any, str] = {}

#: All that were announced.
kernels: list[Any] = []


def source_digest(folder: str | Path, names: Sequence[str]) -> str:
    """Hash of the source files of a kernel and of everything that it calls."""
    # Numba looks at the file of the cached function alone, and would load a stale one after a
    # change in a file that it calls. As a closure variable the hash is part of the cache key.
    content = [(Path(folder) / f"{name}.py").read_bytes() for name in names]
    return hashlib.sha256(b"".join(content)).hexdigest()


def announced(kernel: Kernel, what: str, time: str) -> Kernel:
    """Say so whenever a kernel is compiled, once on a machine: else it looks like a hang."""
    kernels.append(kernel)
    once = "once on this machine" if agreement.is_kept(kernel) else "for this process"
    _texts[kernel] = f"compiling {what}, {once}, about {time}"
    _listen()
    agreement.share(kernel, lambda: _tell_of(kernel))
    return kernel


def _tell_of(kernel: Any) -> None:
    """Say that a kernel is compiled, once."""
    text = _texts.pop(kernel, None)
    if text is not None:
        tell(text)


@cache
def _listen() -> None:
    """Listen to Numba, once."""
    from numba.core import event

    class Compiling(event.Listener):  # type: ignore[misc]
        depth = 0

        def on_start(self, event: Any) -> None:
            # The compiler makes millions of objects: the search for circles among them takes a
            # part of its time and finds next to nothing.
            if self.depth == 0:
                self.collects = gc.isenabled()
                gc.disable()
            self.depth += 1
            _tell_of(event.data["dispatcher"])

        def on_end(self, event: Any) -> None:
            self.depth -= 1
            if self.depth == 0 and self.collects:
                gc.enable()

    event.register("numba:compile", Compiling())


def _to_terminal(text: str) -> None:
    """Write to whoever sits before a terminal or a notebook."""
    if sys.stderr.isatty() or hasattr(sys, "ps1"):
        sys.stderr.write(f"tribodyn: {text}\n")


_tellers: list[Callable[[str], None]] = [_to_terminal]


def tell(text: str) -> None:
    """Say what will take long to whoever listens."""
    _tellers[-1](text)


@contextmanager
def telling(teller: Callable[[str], None]) -> Iterator[None]:
    """Let a function tell what is compiled or takes long inside the block."""
    _tellers.append(teller)
    try:
        yield
    finally:
        _tellers.remove(teller)
