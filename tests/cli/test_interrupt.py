"""Interruptions that Python drops come again; repeated ones leave the documented exit code."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
from pathlib import Path

import pytest

from tribodyn.cli.entry import interruptible, main


class _Interrupted:
    def __del__(self) -> None:
        raise KeyboardInterrupt


def _drop_an_interruption_and_wait(pipe: int) -> None:
    interrupted = _Interrupted()
    del interrupted
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
    exceptions = []
    monkeypatch.setattr(sys, "unraisablehook", lambda dropped: exceptions.append(dropped.exc_type))

    class Failing:
        def __del__(self) -> None:
            raise OSError

    with interruptible():
        failing = Failing()
        del failing
    assert exceptions == [OSError]


#: Interrupts a command and, so many lines later, whatever Python does then; 0 is a shower. One
#: process for each number writes its errors into a file of that name; prints the exit codes.
_TWICE = """
import os, signal, sys
from tribodyn.cli import entry

def trace(frame, event, argument):
    global left
    if heard:
        left -= 1
        if left <= 0:
            left = 10**9 if every else 0
            signal.raise_signal(signal.SIGINT)
    return trace

def command(arguments):
    global heard
    heard = True
    signal.raise_signal(signal.SIGINT)

entry._dispatch = command
numbers = sys.argv[1:]
del sys.argv[1:]
for number in numbers:
    child = os.fork()
    if child == 0:
        left = every = int(number)
        heard = False
        os.dup2(os.open(number, os.O_WRONLY | os.O_CREAT), 2)
        sys.settrace(trace)
        entry.main()
    print(number, os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), flush=True)
"""


@pytest.mark.skipif(os.name != "posix", reason="signals to the own process")
def test_a_second_interruption_leaves_the_documented_code(tmp_path: Path) -> None:
    numbers = [str(lines) for lines in (0, 1, 8, *range(20, 70, 6), 1000)]
    command = [sys.executable, "-c", _TWICE, *numbers]
    done = subprocess.run(
        command, cwd=tmp_path, capture_output=True, text=True, timeout=60.0, check=False
    )
    assert done.stdout.split("\n")[:-1] == [f"{lines} 130" for lines in numbers], done.stderr
    for lines in numbers:
        error = (tmp_path / lines).read_text()
        assert "Traceback" not in error, lines
        assert "interrupted" in error, lines


def test_a_program_that_calls_a_command_listens_to_interruptions_after_it() -> None:
    before = signal.getsignal(signal.SIGINT)
    with pytest.raises(SystemExit) as left:
        main(["check", "no-such-case"])
    assert left.value.code == 2
    assert signal.getsignal(signal.SIGINT) is before
