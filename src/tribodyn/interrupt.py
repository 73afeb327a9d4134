"""Interrupt compiled calls with Ctrl-C: they run in threads and check a flag after every step.

Python raises an interruption in its main thread, between two bytecode instructions: a compiled
call in the main thread would delay it until it returns. Therefore the main thread waits while
worker threads compute, and when it is interrupted it sets the flag that these threads, and the
threads that they started, share.

Python discards an exception that is raised in a finaliser or in the callback of a weak reference,
and garbage collection may run those anywhere in the main thread. An interruption that arrives there
would be lost. Therefore its handler sets the flag too while threads compute, and the main thread
looks at the record of the handler at every wait and when the threads end.
"""

from __future__ import annotations

import ctypes
import os
import signal
import threading
import time
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import Future, wait
from contextlib import ExitStack, contextmanager, suppress
from contextvars import copy_context
from functools import cache
from importlib.machinery import PathFinder
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
    "interruption_recorded",
    "processors",
    "refuse_stopped",
    "stop_flag",
    "stoppable",
]

Item = TypeVar("Item")
Value = TypeVar("Value")

#: Status that a compiled time integration returns when the flag ended it.
STOPPED = -2
#: Longest wait during which no signal is handled [s], and time for threads to end after the flag
#: was set [s]. A thread that still runs then, in a compiler perhaps, ends with the process.
_POLL_INTERVAL, _GRACE = 0.1, 1.0

_thread_state = threading.local()


#: Threads that the main thread waits for.
_awaited: list[Threads] = []


def interruption_recorded() -> bool:
    """Whether the main thread waits for threads that an interruption has already reached."""
    return any(threads.interrupted for threads in _awaited)


def stop_flag() -> NDArray[np.int64]:
    """Flag of this thread that compiled calls check: non-zero when they must end."""
    flag = getattr(_thread_state, "flag", None)
    return np.zeros(1, dtype=np.int64) if flag is None else flag


def refuse_stopped(code: int) -> int:
    """Raise KeyboardInterrupt if the flag ended a compiled call; else return its status."""
    if code == STOPPED:
        raise KeyboardInterrupt
    return code


@contextmanager
def deferred() -> Iterator[None]:
    """Delay an interruption until the block ends: inside HDF5 it could leave its lock acquired."""
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
    """Worker threads that end with the ``with`` block, or soon after an interruption."""

    def __init__(self, count: int) -> None:
        self.flag, self.interrupted, self._limits = stop_flag(), False, ExitStack()
        self._handler: Any = None  #: handler of Ctrl-C before, where these threads replace it
        self._tasks: SimpleQueue[tuple[Future[Any], Callable[..., Any], Any] | None] = SimpleQueue()
        self._waiting: list[Future[Any]] = []
        self._threads = [threading.Thread(target=self._work, daemon=True) for _ in range(count)]

    def _work(self) -> None:
        _thread_state.flag = self.flag
        while (task := self._tasks.get()) is not None:
            future, function, arguments = task
            if not future.set_running_or_notify_cancel():
                continue
            try:
                future.set_result(function(*arguments))
            except (Exception, KeyboardInterrupt, SystemExit) as error:
                future.set_exception(error)
            del task, future, function, arguments

    def submit(self, function: Callable[..., Value], *arguments: object) -> Future[Value]:
        """Run a function in one of the threads."""
        future: Future[Value] = Future()
        self._waiting.append(future)
        # Warnings in the thread reach the collectors of this context.
        self._tasks.put((future, copy_context().run, (function, *arguments)))
        return future

    def _interrupt(self, number: int, frame: FrameType | None) -> None:
        """Interrupt the main thread and the threads, even if Python discards the exception."""
        try:
            self._handler(number, frame)
        except KeyboardInterrupt:
            self.interrupted, self.flag[0] = True, 1
            raise

    def refuse_interrupted(self) -> None:
        """Raise KeyboardInterrupt if one was raised since the threads began."""
        if self.interrupted:
            raise KeyboardInterrupt

    def __enter__(self) -> Threads:
        """Start the threads; while they exist the linear algebra starts none."""
        self._limits.enter_context(single_blas_thread())
        try:
            if threading.current_thread() is threading.main_thread():
                handler = signal.getsignal(signal.SIGINT)
                if callable(handler):
                    self._handler = handler
                    _awaited.append(self)
                    signal.signal(signal.SIGINT, self._interrupt)
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
        """Wait for the threads; an error cancels waiting tasks, an interruption ends all."""
        try:
            if error is not None and not isinstance(error, Exception):
                self._stop()
            self._dismiss(cancel=kind is not None)
            while any(thread.is_alive() for thread in self._threads):
                for thread in self._threads:
                    thread.join(_POLL_INTERVAL)
            self._restore()
            if error is None:
                self.refuse_interrupted()
        except BaseException:
            self._stop()
            raise

    def _restore(self) -> None:
        """Restore the linear algebra, and the handler of Ctrl-C unless another one replaced it."""
        self._limits.close()
        if self in _awaited:
            _awaited.remove(self)
        if self._handler is not None and signal.getsignal(signal.SIGINT) == self._interrupt:
            signal.signal(signal.SIGINT, self._handler)

    def _dismiss(self, cancel: bool) -> None:
        """Let every thread end after its task; ``cancel`` drops the tasks that wait."""
        if cancel:
            for future in self._waiting:
                future.cancel()
        for _ in self._threads:
            self._tasks.put(None)

    def _stop(self) -> None:
        """Set the flag and give the threads a short time to end."""
        self.flag[0] = 1
        self._restore()
        self._dismiss(cancel=True)
        end = time.monotonic() + _GRACE
        while any(thread.is_alive() for thread in self._threads) and time.monotonic() < end:
            time.sleep(0.1 * _POLL_INTERVAL)
        self._threads = []


@contextmanager
def alone() -> Iterator[None]:
    """Start no threads from this one inside the block: parallel workers use all processors."""
    _thread_state.alone = True
    try:
        yield
    finally:
        _thread_state.alone = False


def processors() -> int:
    """Number of threads that this thread may start."""
    return 1 if getattr(_thread_state, "alone", False) else os.cpu_count() or 1


#: Blocks that limit the linear algebra now, and what restores it after the last one.
_blas_users: list[Any] = [0, None]
_blas_lock = threading.Lock()


@cache
def _blas() -> Any:
    import scipy
    from threadpoolctl import ThreadpoolController

    # SciPy brings a library of its own, which has to be limited too; its package is slow to import.
    module = PathFinder.find_spec("_fblas", [f"{scipy.__path__[0]}/linalg"])
    try:
        ctypes.CDLL(str(module and module.origin))
    except OSError:
        import scipy.linalg
    return ThreadpoolController()


def _release_blas() -> None:
    """Let any thread set the number of threads of the linear algebra (threadpoolctl 3.8)."""
    for library in _blas().lib_controllers:
        if hasattr(library, "clear_controlling_thread"):
            library.clear_controlling_thread(force=True)


@contextmanager
def single_blas_thread() -> Iterator[None]:
    """Limit the linear algebra to one thread until the last of such blocks, in any thread, ends."""
    with _blas_lock:
        _blas_users[0] += 1
        if _blas_users[0] == 1:
            _blas_users[1] = _blas().limit(limits=1, user_api="blas")
    try:
        yield
    finally:
        with _blas_lock:
            _blas_users[0] -= 1
            if not _blas_users[0]:
                _release_blas()  # only the thread that set the limit could restore it
                _blas_users[1].restore_original_limits()
                _release_blas()


def begins_thread() -> bool:
    """Whether an interruptible call needs a thread: in the main thread outside :func:`alone`."""
    if getattr(_thread_state, "alone", False) or getattr(_thread_state, "flag", None) is not None:
        return False
    return threading.current_thread() is threading.main_thread()


def in_threads(
    function: Callable[[Item], Value], items: Iterable[Item], count: int, *, brief: bool = False
) -> list[Value]:
    """Apply a function to every item, in ``count`` threads; results in the order of the items.

    A single item that is ``brief``, or that comes from a worker thread, is computed directly.
    """
    items = list(items)
    count = 1 if getattr(_thread_state, "alone", False) else max(min(count, len(items)), 1)
    if count == 1 and (brief or not begins_thread()):
        return [function(item) for item in items]
    with Threads(count) as threads:
        running = [threads.submit(function, item) for item in items]
        left: set[Future[Value]] = set(running)
        while left:
            done, left = wait(left, _POLL_INTERVAL, "FIRST_EXCEPTION")
            threads.refuse_interrupted()
            for future in done:
                future.result()
        return [future.result() for future in running]


def aside(work: Callable[[], Value]) -> Value:
    """Run a function with several interruptible calls in one thread."""
    if not begins_thread():
        return work()
    with Threads(1) as threads:
        future = threads.submit(work)
        while not future.done():
            with suppress(TimeoutError):
                future.exception(_POLL_INTERVAL)
            threads.refuse_interrupted()
        return future.result()


def stoppable(kernel: Callable[..., Any], *arguments: object, brief: bool = False) -> Any:
    """Call a compiled function that takes the flag last and returns its status (first)."""
    # Numba compiles a function anew for arrays that are read-only: it gets copies of these.
    items = [np.require(a, None, "W") if isinstance(a, np.ndarray) else a for a in arguments]
    answer = in_threads(lambda _: kernel(*items, stop_flag()), (0,), 1, brief=brief)[0]
    refuse_stopped(answer[0] if isinstance(answer, tuple) else answer)
    return answer
