"""The first run: its background process compiles what the run needs, and the run loads it."""

from __future__ import annotations

import inspect
import json
import os
import shutil
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from numba.core.caching import UserProvidedCacheLocator

from tribodyn import load_case
from tribodyn.dynamics._engine.marching import march_block
from tribodyn.stiffness.loaded.kernel import solve_loads
from tribodyn.study import first_use
from tribodyn.study.processes import in_background

#: Prints the kernels, with their signatures, that a script compiled and that it loaded.
_SCRIPT = """
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
from tribodyn.interrupt import alone
from tribodyn.study import first_use
case = tribodyn.load_case("fzg-roughness")
{}
from tribodyn.dynamics._engine.marching import march_block
from tribodyn.stiffness.loaded.kernel import solve_loads
loaded = [
    f"{{kernel.py_func.__name__}} {{signature}}"
    for kernel in (march_block, solve_loads)
    for signature in kernel.stats.cache_hits
]
print(json.dumps({{"compiled": compiled, "loaded": loaded}}))
"""
_RUN = """
first_use.allowed = sys.argv[1] == "allowed"
tribodyn.run(case).save(sys.argv[2])
"""
_JOBS = """
for job in first_use._JOBS[sys.argv[1]]:
    first_use._compile((sys.argv[2], job))
"""
#: Processes of a map may compile more than it does.
_STUDY = """
first_use.allowed = False
with alone():
    {}
"""
_STUDIES = {
    "run": "tribodyn.run(case).save(sys.argv[1])",
    "map": 'tribodyn.sweep(case, between=("900 rpm", "1500 rpm"), points=64)',
    "bifurcation": 'tribodyn.bifurcation(case, between=("900 rpm", "1500 rpm"), points=20)',
    "run-up": 'tribodyn.run_up(case, between=("900 rpm", "1000 rpm"), duration=0.05, tables=2)',
}


def _kernels(script: str, cache: Path, *arguments: str) -> dict[str, Any]:
    """Run a script with a kernel cache; return the kernels that it compiled and loaded."""
    command = [sys.executable, "-c", _SCRIPT.format(script), *arguments]
    environment = os.environ | {"NUMBA_CACHE_DIR": str(cache)}
    process = subprocess.run(command, env=environment, capture_output=True, text=True, check=True)
    return dict(json.loads(process.stdout.splitlines()[-1]))


def _count_codes(cache: Path) -> int:
    return len([*cache.glob("*/*.nbc")])


@pytest.fixture(scope="module")
def full_cache(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Cache with the kernels of the jobs of all studies; those of earlier tests are copied."""
    cache = tmp_path_factory.mktemp("full")
    for kernel in (march_block, solve_loads):
        source = inspect.getfile(kernel.py_func)
        subfolder = UserProvidedCacheLocator.get_suitable_cache_subpath(source)
        (cache / subfolder).mkdir()
        for pattern in ("*.nbi", "*.nbc"):  # other workers may write: first the index
            for file in Path(kernel._cache.cache_path).glob(pattern):
                shutil.copy(file, cache / subfolder)
    _kernels("first_use.compile_marches(); first_use._loads()", cache)
    return cache


@pytest.mark.slow
@pytest.mark.skipif(os.cpu_count() == 1, reason="one processor compiles alone")
def test_a_first_run_compiles_only_a_part_itself(tmp_path: Path) -> None:
    cache = tmp_path / "cache"
    first_run = _kernels(_RUN, cache, "allowed", str(tmp_path / "report"))
    assert "solve_loads" not in first_run["compiled"]
    assert len(first_run["compiled"]) < 3
    assert _count_codes(cache) == 3 == len(first_use._JOBS["run"])
    assert _kernels(_RUN, cache, "allowed", str(tmp_path / "again"))["compiled"] == []


def test_all_jobs_of_a_study_are_missing_in_an_empty_cache(tmp_path: Path) -> None:
    script = """
assert {study: first_use._missing_jobs(case, study) for study in first_use._JOBS} == {
    study: list(jobs) for study, jobs in first_use._JOBS.items()}
"""
    assert _kernels(script, tmp_path)["compiled"] == []


@pytest.mark.slow
def test_no_job_is_missing_in_a_full_cache(full_cache: Path) -> None:
    script = "assert not any(first_use._missing_jobs(case, study) for study in first_use._JOBS)"
    assert _kernels(script, full_cache)["compiled"] == []
    kernels = _kernels("first_use.compile_marches(); first_use._loads()", full_cache)
    assert kernels["compiled"] == []
    assert len(kernels["loaded"]) == len(first_use._WORK)


@pytest.mark.slow
@pytest.mark.parametrize("study", _STUDIES)
def test_a_study_loads_what_its_jobs_compile(full_cache: Path, tmp_path: Path, study: str) -> None:
    jobs = _kernels(_JOBS, full_cache, study, str(tmp_path))
    computed = _kernels(_STUDY.format(_STUDIES[study]), full_cache, str(tmp_path / "report"))
    assert jobs["compiled"] == computed["compiled"] == []
    assert len(jobs["loaded"]) == len(first_use._JOBS[study])
    assert set(jobs["loaded"]) <= set(computed["loaded"])


def test_where_no_folder_can_be_made_a_run_compiles_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuses(*_: object, **__: object) -> None:
        raise FileNotFoundError("No usable temporary directory found")

    calls: list[object] = []
    monkeypatch.setattr(first_use, "TemporaryDirectory", refuses)
    monkeypatch.setattr(first_use, "in_background", lambda *arguments: calls.append(arguments))
    monkeypatch.setattr(first_use, "_missing_jobs", lambda *_: ["loads"])
    monkeypatch.setattr(first_use, "processors", lambda: 2)
    with first_use.compile_in_parallel(load_case("fzg-roughness")):
        calls.append("run")
    assert calls == ["run"]


@pytest.mark.parametrize("job", [print, os._exit], ids=["done", "lost"])
def test_a_process_is_busy_until_all_is_done_or_it_is_lost(job: Callable[[int], None]) -> None:
    with in_background(job, [3, 3]) as busy:
        assert busy()
        looks = next(count for count in range(6000) if not busy() or time.sleep(0.01))
        assert looks > 0
