"""Ctrl-C ends compiled calls: one signal, no process stays alive."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
import time
from concurrent.futures import Future
from pathlib import Path

import numpy as np
import pytest

from known_marches import march_newmark, march_one
from tribodyn import interrupt
from tribodyn.cli.entry import interruptible
from tribodyn.dynamics import Contact, System
from tribodyn.dynamics._engine.blocks import march
from tribodyn.dynamics.equations.compiled import compile_for
from tribodyn.interrupt import Threads, aside, deferred, in_threads, stop_flag

_SYSTEM = System([[1.0]], [[0.05]], [[0.0]], [0.3], [Contact([1.0], 1.0, damping=0.05, gap=1.0)])
#: Mesh cycles that nobody waits for: they take hours.
_HOURS = 2_000_000_000

_PROGRAM = """
import sys
import numpy as np
from tribodyn.dynamics import Contact, System
from tribodyn.dynamics._engine.blocks import march
from tribodyn.dynamics.equations.compiled import compile_for

contact = Contact([1.0], 1.0, damping=0.05, gap=1.0)
system = System([[1.0]], [[0.05]], [[0.0]], [0.3], [contact])
compiled = compile_for(system, 0.16, 64)
lanes = int(sys.argv[1])
period, start = np.full(lanes, 1 / 0.16), np.ones((lanes, 2))
march(compiled, period, start, 1)
print("ready", flush=True)
march(compiled, period, start, 2_000_000_000)
"""


def _engines():
    compiled = compile_for(_SYSTEM, 0.16, 64)
    period, start = np.array([1 / 0.16]), np.array([[1.0, 0.0]])
    return {
        "runge-kutta": lambda cycles: march(compiled, period, start, cycles),
        "newmark": lambda cycles: march_newmark(compiled, period, start, cycles),
        "adaptive": lambda cycles: march_one(_SYSTEM, 0.16, start[0], cycles),
    }


@pytest.mark.parametrize("name", ["runge-kutta", "newmark", "adaptive"])
def test_every_engine_looks_at_the_flag_of_its_thread(name):
    run = _engines()[name]
    run(1)
    with Threads(1) as threads:
        future = threads.submit(run, _HOURS)
        time.sleep(0.2)
        assert not future.done()
        threads.flag[0] = 1
        with pytest.raises(KeyboardInterrupt):
            future.result(timeout=20.0)


@pytest.mark.skipif(not hasattr(signal, "pthread_kill"), reason="signals to threads")
@pytest.mark.parametrize("lanes", [1, 64])
def test_one_interruption_ends_a_march_and_its_process(lanes):
    command = [sys.executable, "-c", _PROGRAM, str(lanes)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        assert process.stdout is not None
        assert process.stdout.readline().strip() == b"ready"
        time.sleep(0.3)
        assert process.poll() is None
        process.send_signal(signal.SIGINT)
        try:
            _, errors = process.communicate(timeout=20.0)
        finally:
            process.kill()
    assert b"KeyboardInterrupt" in errors


@pytest.mark.slow
@pytest.mark.skipif(os.name != "posix", reason="signals")
@pytest.mark.parametrize(
    "arguments", [["run", "--set", "solver.method=transient", "--set", "solver.cycles=100000"],
              ["bifurcation", "operation.speed=2000..3000 rpm:4000", "--cycles", "2"]]
)  # fmt: skip
def test_one_interruption_ends_a_command(arguments, tmp_path: Path):
    target = tmp_path / "out"
    module = [sys.executable, "-m", "tribodyn.cli"]
    command = [*module, arguments[0], "time-varying-friction", *arguments[1:]]
    with subprocess.Popen(
        [*command, "--out", str(target)], stdout=subprocess.PIPE, stderr=subprocess.PIPE
    ) as process:
        time.sleep(12.0)  # by then it integrates, or compiles what it integrates with
        running = process.poll() is None
        process.send_signal(signal.SIGINT)
        try:
            _, errors = process.communicate(timeout=60.0)
        finally:
            process.kill()
    assert running, errors.decode()
    assert process.returncode == 130
    # A diagram of finished motions is stored; a run leaves nothing unfinished.
    assert not target.exists() or arguments[0] == "bifurcation"


def test_flags_are_of_the_threads_that_one_call_began():
    before = stop_flag()
    assert before[0] == 0
    flags = in_threads(lambda _: (stop_flag(), threading.get_ident()), range(4), 2)
    assert all(flag is flags[0][0] for flag, _ in flags)
    assert threading.get_ident() not in {thread for _, thread in flags}
    inner = in_threads(lambda _: in_threads(lambda _: stop_flag(), range(2), 2), range(2), 2)
    assert inner[0][0] is inner[0][1]
    assert flags[0][0] is not inner[0][0]


def test_brief_work_stays_in_the_calling_thread():
    threads = in_threads(lambda _: threading.get_ident(), range(3), 1, brief=True)
    assert set(threads) == {threading.get_ident()}


def test_a_failure_ends_what_has_not_begun_and_is_raised():
    started = []

    def work(item):
        started.append(item)
        if item == 0:
            raise ValueError("no")
        time.sleep(0.05)
        return item

    with pytest.raises(ValueError, match="no"):
        in_threads(work, range(1000), 2)
    assert len(started) < 1000


@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
@pytest.mark.parametrize("call", [lambda work: in_threads(work, range(3), 2),
                                  lambda work: aside(lambda: work(0))])  # fmt: skip
def test_an_interruption_that_a_finaliser_discards_still_ends_the_threads(call, monkeypatch):
    """The signal arrives in the main thread while Python runs code whose exceptions it drops."""

    class Finalised:
        def __del__(self):
            signal.raise_signal(signal.SIGINT)

    def work(_):
        for _ in range(300):
            if stop_flag()[0] != 0:
                raise KeyboardInterrupt
            time.sleep(0.01)

    waits = interrupt.wait, Future.exception

    def wait_after_signal(*arguments):
        Finalised()
        return waits[0](*arguments)

    def exception_after_signal(*arguments):
        Finalised()
        return waits[1](*arguments)

    monkeypatch.setattr(interrupt, "wait", wait_after_signal)
    monkeypatch.setattr(Future, "exception", exception_after_signal)
    with pytest.raises(KeyboardInterrupt):
        call(work)
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
def test_an_interruption_that_reached_the_threads_is_not_repeated(monkeypatch):
    """A second one would disturb what the first one leads to, such as storing what is finished."""

    class Finalised:
        def __del__(self):
            signal.raise_signal(signal.SIGINT)

    plain = interrupt.wait

    def wait_after_signal(*arguments):
        Finalised()
        return plain(*arguments)

    monkeypatch.setattr(interrupt, "wait", wait_after_signal)
    with interruptible():
        with pytest.raises(KeyboardInterrupt):
            in_threads(lambda _: time.sleep(0.05), range(2), 2)
        time.sleep(0.3)


def test_a_deferred_interruption_is_raised_after_the_block():
    steps = []

    @deferred()
    @deferred()
    def interrupted():
        signal.raise_signal(signal.SIGINT)
        steps.append("after the signal")

    with pytest.raises(KeyboardInterrupt):
        interrupted()
    assert steps == ["after the signal"]
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler


def test_an_ignored_interruption_stays_ignored():
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        with deferred():
            signal.raise_signal(signal.SIGINT)
        assert signal.getsignal(signal.SIGINT) is signal.SIG_IGN
    finally:
        signal.signal(signal.SIGINT, before)
