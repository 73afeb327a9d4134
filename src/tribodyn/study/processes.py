"""Processes that compute beside this one, where most of a computation is Python.

They are fresh interpreters that load this package and nothing of the script that asks, which so
needs no ``if __name__ == "__main__"`` and may have threads. This process computes too, from the
first moment on; a helper joins in once it has loaded what it needs, and what a lost one left is
computed here.
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
from queue import Empty, SimpleQueue
from typing import IO, Any, TypeVar

from tribodyn.interrupt import STOPPED, alone, in_threads, processors, refuse_stopped, stop_flag

Item = TypeVar("Item")
Value = TypeVar("Value")

#: It finds the modules that this process finds.
_CALL = "import sys; sys.path[:] = {0!r}; from {1} import serve; serve()"
#: Longest wait that lets no interruption through [s].
_MOMENT = 0.05


class _LostError(Exception):
    """A helper that ended, or could not compute."""


class _Helper:
    """A process that calls functions; it ends with the one that began it, however that ends."""

    def __init__(self) -> None:
        self.ready = self._loading = False
        self._answers: SimpleQueue[tuple[Any] | None] = SimpleQueue()
        self._child = subprocess.Popen(
            [sys.executable, "-c", _CALL.format(sys.path, __name__)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            # Matrices are small here: threads of several processes would wait for each other.
            env=os.environ | {"OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"},
            start_new_session=True,  # Ctrl-C is for this process, which ends the others.
        )
        threading.Thread(target=self._read, daemon=True).start()

    def _read(self) -> None:
        assert self._child.stdout is not None
        with suppress(Exception):
            while True:
                self._answers.put((pickle.load(self._child.stdout),))
        self._answers.put(None)

    def ask(self, function: bytes, item: Any) -> None:
        """Let it call a pickled function of an item."""
        assert self._child.stdin is not None
        try:
            pickle.dump((function, item), self._child.stdin)
            self._child.stdin.flush()
        except OSError:
            raise _LostError from None

    def answer(self, wanted: Callable[[], bool] = lambda: True) -> tuple[Any] | None:
        """What it found, waited for as long as that is wanted."""
        while wanted():
            with suppress(Empty):
                told = self._answers.get(timeout=_MOMENT)
                if told is None:
                    self._answers.put(None)  # for whoever asks next
                    raise _LostError
                return told
            refuse_stopped(STOPPED * int(stop_flag()[0]))
        return None

    def answered(self, most: int) -> int:
        """Number of answers that are there, at most so many; they are dropped."""
        for number in range(most):
            try:
                told = self._answers.get_nowait()
            except Empty:
                return number
            if told is None:
                self._answers.put(None)  # for whoever asks next
                raise _LostError
        return most

    def load(self, function: bytes, item: Any, wanted: Callable[[], bool]) -> None:
        """Let it load all that the function needs, by a call that nothing is kept of."""
        if not self._loading:
            self._loading = True
            self.ask(function, item)
        self.ready = self.ready or self.answer(wanted) is not None

    def end(self) -> None:
        """End it at once."""
        self._child.kill()
        self._child.wait()
        for stream in (self._child.stdin, self._child.stdout):
            with suppress(OSError):
                stream.close()  # type: ignore[union-attr]


class Helpers:
    """Processes beside this one; made by :func:`helpers`."""

    def __init__(self, count: int = 0) -> None:
        self._helpers: list[_Helper] = []
        self.grow(count)

    @property
    def count(self) -> int:
        """Number of processes."""
        return len(self._helpers)

    def grow(self, count: int) -> None:
        """Begin as many as are missing; where no process can be begun, this one computes alone."""
        if sys.executable and not getattr(sys, "frozen", False):
            with suppress(OSError):
                while len(self._helpers) < count:
                    self._helpers.append(_Helper())

    def each(
        self,
        function: Callable[[Item], Value],
        abroad: bytes,
        items: Sequence[Item],
        keep: Callable[[int, Value], None],
    ) -> None:
        """Hand a function of every item to ``keep``, by its number; helpers call it ``abroad``."""
        left = list(reversed(range(len(items))))

        def taken() -> Iterator[int]:
            with suppress(IndexError):
                while True:
                    yield left.pop()

        def here() -> None:
            with alone():
                for number in taken():
                    keep(number, function(items[number]))

        def beside(helper: _Helper) -> None:
            try:
                helper.load(abroad, items[0], lambda: bool(left))
            except _LostError:
                return here()
            for number in taken():
                try:
                    helper.ask(abroad, items[number])
                    found = helper.answer()
                except _LostError:
                    left.append(number)
                    return here()
                if found is not None:
                    keep(number, found[0])
            return None

        def work(helper: _Helper | None) -> None:
            try:
                here() if helper is None else beside(helper)
            except BaseException:
                left.clear()
                raise

        from threadpoolctl import threadpool_limits

        with threadpool_limits(1, "blas"):
            in_threads(work, [None, *self._helpers], 1 + len(self._helpers))

    def aside(self, function: Callable[[Item], None], items: Sequence[Item]) -> Callable[[], bool]:
        """Let the first call a function of every item; whether it still does."""
        if not self._helpers:
            return lambda: False
        helper, order = self._helpers[0], pickle.dumps(function)
        with suppress(_LostError):
            for item in items:
                helper.ask(order, item)
        left = len(items)

        def busy() -> bool:
            nonlocal left
            with suppress(_LostError):
                left -= helper.answered(left)
                return left > 0
            return False

        return busy

    def end(self) -> None:
        """End all of them."""
        for helper in self._helpers:
            helper.end()


_begun: ContextVar[Helpers | None] = ContextVar("helpers", default=None)


@contextmanager
def helpers(most: int = 0) -> Iterator[Helpers]:
    """Helpers, at most so many; the same ones for all blocks inside this one, and ended with it."""
    outer = _begun.get()
    own = Helpers() if outer is None else outer
    token = _begun.set(own)
    try:
        own.grow(min(most, processors() - 1))
        yield own
    finally:
        _begun.reset(token)
        if outer is None:
            own.end()


@contextmanager
def aside(function: Callable[[Item], None], items: Sequence[Item]) -> Iterator[Callable[[], bool]]:
    """Let a process call a function of every item; the block is told whether it still does.

    It is ended with the block. Where it cannot be begun, or is lost, nothing is said.
    """
    own = Helpers(min(1, processors() - 1))
    try:
        yield own.aside(function, items)
    finally:
        own.end()


def serve() -> None:
    """Call what is asked for on the standard input until that ends; answer on the output."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    asked: SimpleQueue[tuple[bytes, Any]] = SimpleQueue()
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # What a model prints is no answer.

    def listen(orders: IO[bytes]) -> None:
        with suppress(Exception):
            while True:
                asked.put(pickle.load(orders))
        os._exit(0)  # Nobody waits for what is still computed.

    threading.Thread(target=listen, args=(sys.stdin.buffer,), daemon=True).start()
    text, function = b"", None
    try:
        with alone():
            while True:
                order, item = asked.get()
                if order != text:
                    text, function = order, pickle.loads(order)
                assert function is not None
                pickle.dump(function(item), answers)
                answers.flush()
    finally:  # Whoever asked computes what cannot be computed here, and tells why.
        os._exit(1)
