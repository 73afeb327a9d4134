"""Compile kernels into the disk cache ahead of the first run, in parallel processes."""

from __future__ import annotations

import json as text
import os
import subprocess
import sys
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor, as_completed
from contextlib import contextmanager
from tempfile import TemporaryDirectory
from typing import Any

from tribodyn.cases.catalogue import cases
from tribodyn.cases.load import load_case
from tribodyn.errors import ComputationError
from tribodyn.nomenclature import require_whole
from tribodyn.progress import SILENT, Progress
from tribodyn.types import Tree

#: The job that needs no case: the time integration of all studies. Other processes start with
#: teeth and films.
_ENGINE = ""
_CALL = "import sys; from {0} import compile_for; compile_for(sys.argv[1])"


def warm_up(case: str | None = None, jobs: int | None = None, progress: Progress = SILENT) -> Tree:
    """Compile what a case needs into the disk cache, by a run whose result is discarded.

    Parameters
    ----------
    case : str, optional
        Built-in case or path of a case file; all built-in cases by default.
    jobs : int, optional
        Parallel processes; by default one per processor, at most four.
    progress : Progress
        Reports how many jobs are done; silent by default.

    Returns
    -------
    dict of str to object
        ``"compiled"``: time by kernel [s], ``"there_already"``: kernels that were loaded,
        ``"seconds"``: total time [s].

    Raises
    ------
    InputError
        If there is no such case.
    ComputationError
        If a process fails, or compiled kernels cannot be cached.

    Examples
    --------
    >>> warm_up("fzg-roughness")  # doctest: +SKIP
    """
    from tribodyn.compiled.cache_lock import has_disk_cache
    from tribodyn.dynamics._engine.marching import march_block

    most = min(os.cpu_count() or 1, 4) if jobs is None else require_whole("jobs", jobs)
    if case is not None:
        load_case(case)
    if not has_disk_cache(march_block) and hasattr(march_block, "_cache"):
        what, why = "compiled kernels cannot be cached", "No cache folder is writable"
        raise ComputationError(what, "", why, "Set NUMBA_CACHE_DIR to one that can be written")
    # A solved film takes longest.
    names = sorted(cases(), key=lambda name: "film" not in name) if case is None else [case]
    todo, start = [names[0], _ENGINE, *names[1:]], time.monotonic()
    compiled: dict[str, float] = {}
    ready: set[str] = set()
    with _children(todo, most) as results:
        progress.start("Compiling", len(todo))
        for result in results:
            for name, seconds in result["compiled"].items():
                compiled[name] = compiled.get(name, 0.0) + seconds
            ready |= set(result["loaded"])
            progress.advance()
        progress.finish()
    seconds = time.monotonic() - start
    cached = sorted(ready - set(compiled))
    return {"compiled": compiled, "there_already": cached, "seconds": seconds}


@contextmanager
def _children(todo: list[str], most: int) -> Iterator[Iterator[Tree]]:
    """Yield what the processes compiled for each job as it ends; stop all of them on exit."""
    running: set[subprocess.Popen[str]] = set()
    stopped: list[bool] = []

    def work(job: str) -> Tree:
        if stopped:
            return {}
        call = [sys.executable, "-c", _CALL.format(__name__), job]
        pipes: Tree = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
        child = subprocess.Popen(call, text=True, start_new_session=True, **pipes)
        running.add(child)
        output, errors = child.communicate()
        running.discard(child)
        if child.returncode == 0:
            return dict(text.loads(output.splitlines()[-1]))
        why = (errors.strip().splitlines() or [f"exit code {child.returncode}"])[-1]
        what = f"The kernels of {job or 'the time integration'} were not compiled"
        remedy = "Run the case"
        raise ComputationError(what, "", why, remedy)

    pool = ThreadPoolExecutor(most)
    futures = [pool.submit(work, job) for job in todo]
    try:
        yield (future.result() for future in as_completed(futures))
    finally:
        stopped.append(True)
        for child in list(running):
            child.kill()
        pool.shutdown()


def compile_for(job: str) -> None:
    """Run a job in this process and print which kernels were compiled and which were loaded."""
    import warnings

    from numba.core import event
    from numba.core.caching import FunctionCache

    from tribodyn.compiled import kernels

    compiled: dict[str, float] = {}
    starts: dict[Any, float] = {}

    class Compiling(event.Listener):  # type: ignore[misc]
        def on_start(self, event: Any) -> None:
            starts.setdefault(event.data["dispatcher"], time.monotonic())

        def on_end(self, event: Any) -> None:
            kernel = event.data["dispatcher"]
            seconds = time.monotonic() - starts.pop(kernel, time.monotonic())
            if isinstance(kernel._cache, FunctionCache):
                name = _name(kernel)
                compiled[name] = compiled.get(name, 0.0) + seconds

    event.register("numba:compile", Compiling())
    warnings.simplefilter("ignore")
    from tribodyn.study import first_use

    if job == _ENGINE:
        first_use.compile_marches()
    else:
        from tribodyn.cases.load import run

        first_use.allowed = False  # Other processes are running already.
        with TemporaryDirectory() as place:  # Some figures of the report compute too.
            run(job).save(f"{place}/result")
    loaded = sorted({_name(kernel) for kernel in kernels if kernel.stats.cache_hits})
    sys.stdout.write(text.dumps({"compiled": compiled, "loaded": loaded}) + "\n")


def _name(kernel: Any) -> str:
    return f"{kernel.py_func.__module__.removeprefix('tribodyn.')}.{kernel.py_func.__name__}"
