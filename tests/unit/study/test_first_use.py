"""The first run: what a process beside it compiles is what the run needs, and loads."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from tribodyn import load_case
from tribodyn.study import first_use
from tribodyn.study.processes import in_background

#: Kernels of the disk cache that a process compiled, and how often each.
_LISTEN = """
import json, sys, warnings
from numba.core import event
from numba.core.caching import FunctionCache

compiled = []

class Listener(event.Listener):
    def on_start(self, event): pass
    def on_end(self, event):
        kernel = event.data["dispatcher"]
        if isinstance(kernel._cache, FunctionCache):
            compiled.append(kernel.py_func.__name__)

event.register("numba:compile", Listener())
warnings.simplefilter("ignore")
import tribodyn
"""
_JOBS = """
import os
from tribodyn.study import first_use
case, study = tribodyn.load_case("fzg-roughness"), sys.argv[2]
for job in first_use._missing_jobs(case, study):
    first_use._compile((sys.argv[1], job))
assert first_use._missing_jobs(case, study) == []
"""
_RUN = """
from tribodyn.study import first_use
first_use.allowed = sys.argv[1] == "allowed"
tribodyn.run(tribodyn.load_case("fzg-roughness")).save(sys.argv[2])
"""
#: What a study compiles itself and what it loads.
_STUDY = """
from tribodyn.dynamics._engine.marching import march_block
from tribodyn.stiffness.loaded.kernel import solve_loads
from tribodyn.interrupt import alone
from tribodyn.study import first_use
first_use.allowed = False
case = tribodyn.load_case("fzg-roughness")
with alone():  # Processes beside a map may compile more than it does.
    {}
compiled = [len(compiled), sum(map(len, (k.stats.cache_hits for k in (march_block, solve_loads))))]
"""
_STUDIES = {
    "map": 'tribodyn.sweep(case, between=("900 rpm", "1500 rpm"), points=64)',
    "bifurcation": 'tribodyn.bifurcation(case, between=("900 rpm", "1500 rpm"), points=20)',
    "run-up": 'tribodyn.run_up(case, between=("900 rpm", "1000 rpm"), duration=0.05, tables=2)',
}
_SAY = "print(json.dumps(compiled))"


def _compiled(script: str, cache: Path, *words: str) -> list[str]:
    call = [sys.executable, "-c", _LISTEN + script + _SAY, *words]
    environment = os.environ | {"NUMBA_CACHE_DIR": str(cache)}
    done = subprocess.run(call, env=environment, capture_output=True, text=True, check=True)
    return list(json.loads(done.stdout.splitlines()[-1]))


@pytest.mark.slow
def test_the_jobs_compile_what_a_run_needs_and_nothing_else(tmp_path: Path) -> None:
    marks, cache = tmp_path / "marks", tmp_path / "cache"
    marks.mkdir()
    jobs = _compiled(_JOBS, cache, str(marks), "run")
    assert sorted(jobs) == ["march_block", "march_block", "solve_loads"]
    assert len(list(marks.iterdir())) == len(jobs)
    assert _compiled(_RUN, cache, "alone", str(tmp_path / "report")) == []


@pytest.mark.slow
@pytest.mark.parametrize("study", _STUDIES)
def test_the_jobs_of_a_study_are_among_what_it_loads(tmp_path: Path, study: str) -> None:
    (tmp_path / "marks").mkdir()
    cache = tmp_path / "cache"
    jobs = _compiled(_JOBS, cache, str(tmp_path / "marks"), study)
    own, loaded = _compiled(_STUDY.format(_STUDIES[study]), cache)
    assert len(jobs) == len(first_use._JOBS[study])
    assert loaded == len(jobs)
    assert len([*cache.glob("*/*.nbc")]) == len(jobs) + own


@pytest.mark.slow
def test_after_the_jobs_of_all_studies_none_compiles_anything(tmp_path: Path) -> None:
    cache = tmp_path / "cache"
    work = "from tribodyn.study import first_use; first_use.compile_marches(); first_use._loads();"
    jobs = _compiled(work, cache)
    assert len(jobs) == len([*cache.glob("*/*.nbc")]) == len(first_use._WORK)
    own, _ = _compiled(_STUDY.format("; ".join(_STUDIES.values())), cache)
    assert own == 0


@pytest.mark.slow
@pytest.mark.skipif(os.cpu_count() == 1, reason="one processor compiles alone")
def test_a_first_run_compiles_only_a_part_itself(tmp_path: Path) -> None:
    cache = tmp_path / "cache"
    own = _compiled(_RUN, cache, "allowed", str(tmp_path / "report"))
    assert "solve_loads" not in own
    assert len(own) < 3
    assert len([*cache.glob("*/*.nbc")]) == 3
    assert _compiled(_RUN, cache, "allowed", str(tmp_path / "again")) == []


def test_where_no_folder_can_be_made_a_run_compiles_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuses(*_: object, **__: object) -> None:
        raise FileNotFoundError("No usable temporary directory found")

    asked: list[object] = []
    monkeypatch.setattr(first_use, "TemporaryDirectory", refuses)
    monkeypatch.setattr(first_use, "in_background", lambda *given: asked.append(given))
    monkeypatch.setattr(first_use, "_missing_jobs", lambda *_: ["loads"])
    monkeypatch.setattr(first_use, "processors", lambda: 2)
    with first_use.compile_in_parallel(load_case("fzg-roughness")):
        asked.append("run")
    assert asked == ["run"]


@pytest.mark.parametrize("job", [print, os._exit], ids=["done", "lost"])
def test_a_process_is_busy_until_all_is_done_or_it_is_lost(job: Callable[[int], None]) -> None:
    with in_background(job, [3, 3]) as busy:
        assert busy()
        looks = next(count for count in range(6000) if not busy() or time.sleep(0.01))
        assert looks > 0
