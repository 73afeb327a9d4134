"""An interruption that Python drops inside a destructor comes again."""

from __future__ import annotations

import sys
import time

import pytest

from tribodyn.cli.interrupt import interruptible


class _Interrupted:
    def __del__(self) -> None:
        raise KeyboardInterrupt


def _drop_an_interruption_and_wait() -> None:
    thing = _Interrupted()
    del thing
    time.sleep(60.0)


def test_a_dropped_interruption_comes_again() -> None:
    before = sys.unraisablehook
    began = time.monotonic()
    with pytest.raises(KeyboardInterrupt), interruptible():
        _drop_an_interruption_and_wait()
    # The wait in the system was ended, not sat out.
    assert time.monotonic() - began < 30.0
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
