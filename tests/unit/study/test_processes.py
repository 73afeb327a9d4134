"""Worker processes: same figures, nothing lost with a helper, none left behind."""

from __future__ import annotations

import os
import pickle
import signal
import subprocess
import sys
import threading
import time

import pytest

import tribodyn as td
from registries import as_before
from tribodyn.friction import LAWS
from tribodyn.friction.benedict_kelly import VARIANTS
from tribodyn.model import known_elsewhere
from tribodyn.study.processes import Helpers, helpers
from tribodyn.study.studies import sweep as studied
from tribodyn.study.studies.runner import Groups

#: A script without a guard, as many are written: its first process would begin it again otherwise.
_SCRIPT = """
import pickle, time
from concurrent.futures import Future
from tribodyn.study.processes import Helpers

helper, pool = Future(), Helpers(1)
pool.each(lambda item: helper.result(), pickle.dumps(eval), ["__import__('os').getpid()"] * 2,
          lambda number, found: helper.done() or helper.set_result(found))
print(helper.result(), flush=True)
pool.each(lambda item: time.sleep(0.1), pickle.dumps(time.sleep), [1000.0] * 2000, seen.append)
"""


def _has_ended(process: int) -> bool:
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return True
    return False


@pytest.mark.skipif(os.name != "posix", reason="signals")
@pytest.mark.parametrize("name", ["SIGINT", "SIGKILL"])
def test_no_helper_outlives_who_began_it(name: str) -> None:
    with subprocess.Popen([sys.executable, "-c", _SCRIPT], stdout=subprocess.PIPE) as process:
        helper = int(process.stdout.readline())
        time.sleep(0.1)
        assert not _has_ended(helper)
        process.send_signal(getattr(signal, name))
        process.wait(timeout=20.0)
    for _ in range(2000):
        if _has_ended(helper):
            break
        time.sleep(0.01)
    assert _has_ended(helper)


def _each(abroad: object, items: list[object], work: object) -> list[object]:
    """What becomes of items of which a helper takes all but one, where it can."""
    results: dict[int, object] = {}
    done = threading.Event()

    def keep(number: int, value: object) -> None:
        results[number] = value
        if len(results) == len(items) - 1:
            done.set()

    def waiting(item: object) -> object:
        done.wait(timeout=60.0)
        return work(item)

    pool = Helpers(1)
    try:
        pool.each(waiting, pickle.dumps(abroad), items, keep)
    finally:
        pool.end()
    return [results[number] for number in range(len(items))]


def test_points_of_a_sweep_are_the_same_in_another_process() -> None:
    case = td.load_case("fzg-roughness").replace(
        {"film.model": "none", "solver.steps_per_mesh_cycle": 512}
    )
    source = studied._source(case, ("operation.speed", "operation.torque"))
    # The second is refused, with its reason.
    places = [[(100.0, 50.0)], [(1e-6, 90.0)], [(200.0, 70.0), (200.0, 90.0)]]
    work = source.points_at
    results = _each(pickle.loads(Groups(remote=work).pickled()), places, work)
    assert results == [work(place) for place in places]
    assert [bool(point.failed) for points in results for point in points] == [0, 1, 0, 0]


def test_helpers_begin_no_threads_for_matrices(monkeypatch) -> None:
    monkeypatch.delenv("OPENBLAS_NUM_THREADS", raising=False)
    monkeypatch.delenv("OMP_NUM_THREADS", raising=False)
    ask = "__import__('os').environ['OPENBLAS_NUM_THREADS']"
    assert _each(eval, [ask] * 3, lambda item: "here").count("1") == 2


@pytest.mark.parametrize("first", ["1", "__import__('os')._exit(3)"])
def test_items_of_a_lost_worker_are_computed_by_the_caller(first: str) -> None:
    pool = Helpers(1)
    items, results = [first, "__import__('os')._exit(3)", "22"], dict[int, int]()

    def work(item: str) -> int:
        pool._helpers[0]._child.wait(timeout=60.0)
        return len(item)

    try:
        for _ in range(2):  # It stays away.
            pool.each(work, pickle.dumps(eval), items, results.__setitem__)
            assert results == {number: len(item) for number, item in enumerate(items)}
            results.clear()
    finally:
        pool.end()


def test_an_error_here_ends_all() -> None:
    with helpers(1) as pool, pytest.raises(ZeroDivisionError):
        pool.each(lambda item: 1 / item, pickle.dumps(float), [0, 1], lambda *_: None)


def test_a_law_that_a_script_registers_stays_in_its_process() -> None:
    case = td.load_case("fzg-roughness")
    groups = Groups(remote=studied._source(case, ("operation.speed",)).points_at)
    assert known_elsewhere()
    assert groups.pickled()
    with as_before():
        LAWS.define("of-a-script", source="a script")(lambda contact: contact.load_per_width)
        assert not known_elsewhere()
        assert not groups.pickled()
    with as_before():
        VARIANTS.register("of-a-script")(0.01)  # a number, which has no module
        assert not known_elsewhere()
    assert known_elsewhere()
