"""Ctrl-C that ends compiled calls: they run in threads, and look at a flag after every step.

Python hands an interruption to its main thread, and only between two lines of Python: a compiled
call that runs there keeps it waiting. So the main thread waits while other threads compute, and
raises the flag of all threads that it began, and of those that these began, when it is
interrupted.
"""

from __future__ import annotations

import os
import signal
import threading
import time
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Future, wait
from contextlib import contextmanager, suppress
from contextvars import copy_context
from queue import SimpleQueue
from types import FrameType, TracebackType
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

__all__ = [
    "STOPPED",
    "Threads",
    "alone",
    "aside",
    "begins_thread",
    "deferred",
    "in_threads",
    "processors",
    "refuse_stopped",
    "stop_flag",
    "stoppable",
]

Item = TypeVar("Item")
Value = TypeVar("Value")

#: What a compiled march returns that ended because of the flag.
STOPPED = -2
#: Longest wait that lets no signal through [s], and that for threads to end after the flag was
#: raised [s]. What still runs then, a compiler perhaps, ends with the process at the latest.
_MOMENT, _GRACE = 0.1, 1.0

_here = threading.local()


def stop_flag() -> NDArray[np.int64]:
    """Flag of this thread, which a compiled call looks at: not zero when it has to end."""
    flag = getattr(_here, "flag", None)
    return np.zeros(1, dtype=np.int64) if flag is None else flag


def refuse_stopped(code: int) -> int:
    """Raise the interruption that ended a compiled march; else hand on what it returned."""
    if code == STOPPED:
        raise KeyboardInterrupt
    return code


@contextmanager
def deferred() -> Iterator[None]:
    """Raise an interruption after the block: in HDF5 it may leave a lock that nobody releases."""
    main_thread = threading.current_thread() is threading.main_thread()
    handler = signal.getsignal(signal.SIGINT) if main_thread else None
    if not callable(handler):
        yield
        return
    received: list[tuple[int, FrameType | None]] = []
    signal.signal(signal.SIGINT, lambda *signal_and_frame: received.append(signal_and_frame))
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, handler)
        if received:
            handler(*received[0])


class Threads:
    """Threads that end with the block that began them: soon where it was interrupted."""

    def __init__(self, count: int) -> None:
        self.flag = stop_flag()
        self._tasks: SimpleQueue[tuple[Future[Any], Callable[..., Any], Any] | None] = SimpleQueue()
        self._waiting: list[Future[Any]] = []
        self._threads = [threading.Thread(target=self._work, daemon=True) for _ in range(count)]

    def _work(self) -> None:
        _here.flag = self.flag
        while (task := self._tasks.get()) is not None:
            future, function, arguments = task
            if not future.set_running_or_notify_cancel():
                continue
            try:
                future.set_result(function(*arguments))
            except (Exception, KeyboardInterrupt, SystemExit) as error:
                future.set_exception(error)
            del task, future, function, arguments

    def submit(self, function: Callable[..., Value], *arguments: Any) -> Future[Value]:
        """Let one of the threads call a function."""
        future: Future[Value] = Future()
        self._waiting.append(future)
        # What listens to warnings here listens to those of the thread too.
        self._tasks.put((future, copy_context().run, (function, *arguments)))
        return future

    def __enter__(self) -> Threads:
        """Begin the threads."""
        try:
            for thread in self._threads:
                thread.start()
        except BaseException:
            self._stop()
            raise
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """Wait for the threads; after an error nothing new begins, and an interruption ends all."""
        try:
            if error is not None and not isinstance(error, Exception):
                self._stop()
            self._dismiss(cancel=kind is not None)
            while any(thread.is_alive() for thread in self._threads):
                for thread in self._threads:
                    thread.join(_MOMENT)
        except BaseException:
            self._stop()
            raise

    def _dismiss(self, cancel: bool) -> None:
        """Let every thread end after its task; with ``cancel`` nothing that waits is begun."""
        if cancel:
            for future in self._waiting:
                future.cancel()
        for _ in self._threads:
            self._tasks.put(None)

    def _stop(self) -> None:
        """Raise the flag, and wait a little for the threads to see it."""
        self.flag[0] = 1
        self._dismiss(cancel=True)
        end = time.monotonic() + _GRACE
        while any(thread.is_alive() for thread in self._threads) and time.monotonic() < end:
            time.sleep(0.1 * _MOMENT)
        self._threads = []


@contextmanager
def alone() -> Iterator[None]:
    """Let this thread begin no others inside the block: others like it keep the processors busy."""
    _here.alone = True
    try:
        yield
    finally:
        _here.alone = False


def processors() -> int:
    """Threads that this one may begin."""
    return 1 if getattr(_here, "alone", False) else os.cpu_count() or 1


def begins_thread() -> bool:
    """Whether a stoppable call from here needs a thread: not beside others, nor in one already."""
    if getattr(_here, "alone", False) or getattr(_here, "flag", None) is not None:
        return False
    return threading.current_thread() is threading.main_thread()


def in_threads(
    function: Callable[[Item], Value], items: Iterable[Item], count: int, *, brief: bool = False
) -> list[Value]:
    """Results of a function of every item, as many at a time as there are threads.

    What is ``brief`` anyway, and what one thread of several does by itself, is computed here.
    """
    items = list(items)
    count = 1 if getattr(_here, "alone", False) else max(min(count, len(items)), 1)
    if count == 1 and (brief or not begins_thread()):
        return [function(item) for item in items]
    with Threads(count) as threads:
        running = [threads.submit(function, item) for item in items]
        left: set[Future[Value]] = set(running)
        while left:
            done, left = wait(left, _MOMENT, "FIRST_EXCEPTION")
            for future in done:
                future.result()
        return [future.result() for future in running]


def aside(work: Callable[[], Value]) -> Value:
    """Let a thread do several stoppable calls and what lies between them: it is begun once."""
    if not begins_thread():
        return work()
    with Threads(1) as threads:
        future = threads.submit(work)
        while not future.done():
            with suppress(TimeoutError):
                future.exception(_MOMENT)
        return future.result()


def stoppable(kernel: Callable[..., Any], *arguments: Any, brief: bool = False) -> Any:
    """Call a compiled function that takes the flag last, and returns its status (first)."""
    answer = in_threads(lambda _: kernel(*arguments, stop_flag()), (0,), 1, brief=brief)[0]
    refuse_stopped(answer[0] if isinstance(answer, tuple) else answer)
    return answer
