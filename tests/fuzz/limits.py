"""A limit on the processor time of one call, for inputs that could make it hang."""

from __future__ import annotations

import signal
from collections.abc import Iterator
from contextlib import contextmanager


class HangError(AssertionError):
    """A call took longer than anything of its kind should."""


@contextmanager
def at_most(seconds: float) -> Iterator[None]:
    """Fail when the block takes longer on the processor."""

    def ring(*_: object) -> None:
        raise HangError(f"more than {seconds} s of the processor")

    before = signal.signal(signal.SIGVTALRM, ring)
    signal.setitimer(signal.ITIMER_VIRTUAL, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_VIRTUAL, 0.0)
        signal.signal(signal.SIGVTALRM, before)
