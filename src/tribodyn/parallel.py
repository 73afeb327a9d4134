"""Pieces of work on several threads; kernels that hold no lock then run at the same time."""

from __future__ import annotations

import os
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future, ThreadPoolExecutor, wait
from itertools import islice
from typing import TypeVar

__all__ = ["run_blocks"]

Item = TypeVar("Item")
Value = TypeVar("Value")

#: Items handed to the threads ahead of the one that is collected.
_AHEAD = 64


def run_blocks(
    work: Callable[[Item], Value], items: Sequence[Item], threads: int | None = None
) -> Iterator[Value]:
    """Do one piece of work for each item and yield what it returns, in the order of the items.

    The first error ends it, as does an interrupt: what has not begun is then left undone.

    Parameters
    ----------
    work : callable
        Takes an item.
    items : sequence
        What is worked on.
    threads : int, optional
        Items worked on at a time; the number of processors by default. With one, no thread is
        started.

    Yields
    ------
    object
        What ``work`` returns.

    Examples
    --------
    >>> list(run_blocks(lambda number: number**2, [1, 2, 3], threads=2))
    [1, 4, 9]
    """
    threads = min(threads or os.cpu_count() or 1, len(items))
    if threads <= 1:
        yield from map(work, items)
        return
    pool, left = ThreadPoolExecutor(threads), iter(items)
    waiting: deque[Future[Value]] = deque()
    try:
        waiting.extend(pool.submit(work, item) for item in islice(left, _AHEAD))
        while waiting:
            future = waiting.popleft()
            while not future.done():
                # A wait with an end lets Ctrl-C through on every system.
                wait([future], timeout=0.2)
            yield future.result()
            waiting.extend(pool.submit(work, item) for item in islice(left, 1))
    finally:
        pool.shutdown(wait=True, cancel_futures=True)
