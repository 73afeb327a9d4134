"""An interruption that Python drops inside a destructor comes again."""

from __future__ import annotations

import os
import sys
import threading

import pytest

from tribodyn.cli.entry import interruptible


class _Interrupted:
    def __del__(self) -> None:
        raise KeyboardInterrupt


def _drop_an_interruption_and_wait(pipe: int) -> None:
    thing = _Interrupted()
    del thing
    os.read(pipe, 1)


def test_a_dropped_interruption_comes_again() -> None:
    before = sys.unraisablehook
    reading, writing = os.pipe()
    released: list[bool] = []

    def release() -> None:
        released.append(True)
        os.write(writing, b"x")

    guard = threading.Timer(20.0, release)
    guard.start()
    with pytest.raises(KeyboardInterrupt), interruptible():
        _drop_an_interruption_and_wait(reading)
    guard.cancel()
    # The wait in the system was ended by the signal, not by the guard.
    assert not released
    assert sys.unraisablehook is before


def test_other_dropped_exceptions_go_their_usual_way(monkeypatch: pytest.MonkeyPatch) -> None:
    seen = []
    monkeypatch.setattr(sys, "unraisablehook", lambda dropped: seen.append(dropped.exc_type))

    class Failing:
        def __del__(self) -> None:
            raise OSError

    with interruptible():
        thing = Failing()
        del thing
    assert seen == [OSError]
