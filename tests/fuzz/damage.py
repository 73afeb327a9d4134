"""Damaged bytes, and a limit on the processor time of one call that could make it hang."""

from __future__ import annotations

import random
import signal
from collections.abc import Iterator
from contextlib import contextmanager


class HangError(BaseException):
    """A call took longer than any of its kind should; no handler of errors catches it."""


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


def flip(content: bytes, rng: random.Random) -> bytes:
    damaged = bytearray(content)
    for _ in range(rng.choice((1, 1, 2, 30))):
        damaged[rng.randrange(len(damaged))] ^= 1 << rng.randrange(8)
    return bytes(damaged)


def cut(content: bytes, rng: random.Random) -> bytes:
    start = rng.randrange(len(content))
    kind = rng.randrange(4)
    if kind == 0:
        return content[:start]
    if kind == 1:
        return content[:start] + content[start + rng.randrange(1, 500) :]
    if kind == 2:
        return content[:start] + bytes(rng.randrange(1, 4000)) + content[start + 4000 :]
    return content + bytes(rng.randrange(1, 4000))
