"""Ctrl-C that is never lost.

Python drops an exception that arises inside a destructor or a callback, and Ctrl-C can arrive
right there; the program would go on as if nothing had happened. A dropped interruption is asked
for again a moment later, by a real signal: only that wakes a program that waits in the system.
"""

from __future__ import annotations

import _thread
import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager

#: Time to get out of the callback before the interruption is repeated [s].
_MOMENT = 0.05


@contextmanager
def interruptible() -> Iterator[None]:
    """Repeat an interruption that was dropped inside the block.

    Yields
    ------
    None
    """
    previous = sys.unraisablehook

    def again(dropped: sys.UnraisableHookArgs) -> None:
        if issubclass(dropped.exc_type, KeyboardInterrupt):
            timer = threading.Timer(_MOMENT, _interrupt)
            timer.daemon = True
            timer.start()
        else:
            previous(dropped)

    sys.unraisablehook = again
    try:
        yield
    finally:
        sys.unraisablehook = previous


def _interrupt() -> None:
    """Interrupt the main thread, also out of a system call."""
    if hasattr(signal, "pthread_kill"):
        main = threading.main_thread().ident
        if main is not None:
            signal.pthread_kill(main, signal.SIGINT)
    else:
        _thread.interrupt_main()
