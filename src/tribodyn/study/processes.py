"""Worker processes for computations that spend most of their time in Python.

They are fresh interpreters that import this package but not the user's script, which therefore
needs no ``if __name__ == "__main__"`` and may have threads. This process computes as well from the
start; a helper joins in once its imports are done, and items of a lost helper are computed in this
process.
"""

from __future__ import annotations

import os
import pickle
import signal
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from contextvars import ContextVar
from functools import partial
from queue import Empty, SimpleQueue
from typing import IO, Any, TypeVar

from tribodyn.interrupt import (
    STOPPED,
    alone,
    in_threads,
    processors,
    refuse_stopped,
    single_blas_thread,
    stop_flag,
)

Item = TypeVar("Item")
Value = TypeVar("Value")

#: Command of a helper, with the module search path of this process.
_COMMAND = "import sys; sys.path[:] = {0!r}; from {1} import serve; serve()"
#: Interval between checks for an interruption while waiting [s].
_POLL_INTERVAL = 0.05


class _LostError(Exception):
    """A helper has ended or failed to compute."""


class _Helper:
    """A process that calls functions; it ends with its parent, however that ends."""

    def __init__(self) -> None:
        self.ready = self._loading = False
        self._results: SimpleQueue[tuple[Any] | None] = SimpleQueue()
        self._child = subprocess.Popen(
            [sys.executable, "-c", _COMMAND.format(sys.path, __name__)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            # Matrices are small here: threads of several processes would wait for each other.
            env=os.environ | {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"},
            start_new_session=True,  # Ctrl-C reaches only this process, which ends the helpers.
        )
        threading.Thread(target=self._read, daemon=True).start()

    def _read(self) -> None:
        assert self._child.stdout is not None
        with suppress(Exception):
            while True:
                self._results.put((pickle.load(self._child.stdout),))
        self._results.put(None)

    def submit(self, function: bytes, item: Any) -> None:
        """Send a pickled function and an item to call it with."""
        assert self._child.stdin is not None
        try:
            pickle.dump((function, item), self._child.stdin)
            self._child.stdin.flush()
        except OSError:
            raise _LostError from None

    def result(self, wanted: Callable[[], bool] = lambda: True) -> tuple[Any] | None:
        """Wait for the next result; None once ``wanted`` returns False."""
        while wanted():
            with suppress(Empty):
                result = self._results.get(timeout=_POLL_INTERVAL)
                if result is None:
                    self._results.put(None)  # for the next caller
                    raise _LostError
                return result
            refuse_stopped(STOPPED * int(stop_flag()[0]))
        return None

    def busy(self) -> bool:
        """Whether a submitted item has no result yet."""
        return self._results.empty()

    def warm_up(self, function: bytes, item: Any, wanted: Callable[[], bool]) -> None:
        """Import what the function needs by a call whose result is discarded."""
        if not self._loading:
            self._loading = True
            self.submit(function, item)
        self.ready = self.ready or self.result(wanted) is not None

    def end(self) -> None:
        """Kill the process."""
        self._child.kill()
        self._child.wait()
        for stream in (self._child.stdin, self._child.stdout):
            with suppress(OSError):
                stream.close()  # type: ignore[union-attr]


class Helpers:
    """Pool of helper processes; created by :func:`helpers`."""

    def __init__(self, count: int = 0) -> None:
        self._helpers: list[_Helper] = []
        self.grow(count)

    @property
    def count(self) -> int:
        """Number of processes."""
        return len(self._helpers)

    def grow(self, count: int) -> None:
        """Start processes up to a count; if none can be started, this process computes alone."""
        if sys.executable and not getattr(sys, "frozen", False):
            with suppress(OSError):
                while len(self._helpers) < count:
                    self._helpers.append(_Helper())

    def each(
        self,
        function: Callable[[Item], Value],
        pickled: bytes,
        items: Sequence[Item],
        keep: Callable[[int, Value], None],
        first_call: Item | None = None,
    ) -> None:
        """Pass the function of every item to ``keep`` by number; helpers call ``pickled``."""
        # first_call: item with which helpers load what the function needs; the first by default.
        remaining = list(reversed(range(len(items))))

        def next_numbers() -> Iterator[int]:
            with suppress(IndexError):
                while True:
                    yield remaining.pop()

        def compute_locally() -> None:
            with alone():
                for number in next_numbers():
                    keep(number, function(items[number]))

        def compute_remotely(helper: _Helper) -> None:
            try:
                warm_up = items[0] if first_call is None else first_call
                helper.warm_up(pickled, warm_up, lambda: bool(remaining))
            except _LostError:
                return compute_locally()
            for number in next_numbers():
                try:
                    helper.submit(pickled, items[number])
                    result = helper.result()
                except _LostError:
                    remaining.append(number)
                    return compute_locally()
                if result is not None:
                    keep(number, result[0])
            return None

        def work(helper: _Helper | None) -> None:
            try:
                compute_locally() if helper is None else compute_remotely(helper)
            except BaseException:
                remaining.clear()
                raise

        with single_blas_thread():
            in_threads(work, [None, *self._helpers], 1 + len(self._helpers))

    def start_in_background(
        self, function: Callable[[Item], None], items: Sequence[Item]
    ) -> Callable[[], bool]:
        """Call a function of every item in the first helper; return a check whether it is busy."""
        if not self._helpers:
            return lambda: False
        with suppress(_LostError):
            self._helpers[0].submit(pickle.dumps(partial(_call_with_each, function)), items)
        return self._helpers[0].busy

    def end(self) -> None:
        """Kill all processes."""
        for helper in self._helpers:
            helper.end()


def _call_with_each(function: Callable[[Item], None], items: Sequence[Item]) -> None:
    for item in items:
        function(item)


_current: ContextVar[Helpers | None] = ContextVar("helpers", default=None)


@contextmanager
def helpers(most: int = 0) -> Iterator[Helpers]:
    """Provide at most ``most`` helpers, shared by inner blocks and ended with the outermost."""
    outer = _current.get()
    pool = Helpers() if outer is None else outer
    token = _current.set(pool)
    try:
        pool.grow(min(most, processors() - 1))
        yield pool
    finally:
        _current.reset(token)
        if outer is None:
            pool.end()


@contextmanager
def in_background(
    function: Callable[[Item], None], items: Sequence[Item]
) -> Iterator[Callable[[], bool]]:
    """Call a function of every item in another process; yield a check whether it is busy.

    The process is killed at the end of the block. Failures to start it are ignored.
    """
    pool = Helpers(min(1, processors() - 1))
    try:
        yield pool.start_in_background(function, items)
    finally:
        pool.end()


def serve() -> None:
    """Call functions read from standard input until it ends; write results to standard output."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    requests: SimpleQueue[tuple[bytes, Any]] = SimpleQueue()
    output = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # Output printed by a model must not mix with results.

    def listen(stream: IO[bytes]) -> None:
        with suppress(Exception):
            while True:
                requests.put(pickle.load(stream))
        os._exit(0)  # The parent has ended: results are no longer needed.

    threading.Thread(target=listen, args=(sys.stdin.buffer,), daemon=True).start()
    loaded, function = b"", None
    try:
        with alone():
            while True:
                pickled_function, item = requests.get()
                if pickled_function != loaded:
                    loaded, function = pickled_function, pickle.loads(pickled_function)
                assert function is not None
                pickle.dump(function(item), output)
                output.flush()
    finally:  # The parent recomputes a failed item and reports its error.
        os._exit(1)
