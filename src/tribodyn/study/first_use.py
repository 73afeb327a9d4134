"""Compilation in a background process during the first run on a machine."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager, suppress
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

import numpy as np

from tribodyn.compiled.cache_lock import CacheLock, ElsewhereError, is_cached, locked
from tribodyn.interrupt import STOPPED, processors, refuse_stopped, stop_flag
from tribodyn.study.processes import in_background

if TYPE_CHECKING:
    from tribodyn.dynamics import System
    from tribodyn.study.case.pair import PairCase

#: Whether a first run may start a process; compiling processes start none themselves.
allowed = True
#: Trajectories that fill a block of the engine.
_BLOCK = 16
#: Jobs of each study in reverse order of use: the study itself starts with the other end.
_JOBS = {
    "run": ("loads", "one motion", "motions"),
    "map": ("loads", "rows of motions"),
    "bifurcation": ("followed motion",),
    "run-up": ("followed motion", "one motion"),
}


@contextmanager
def compile_in_parallel(case: PairCase, study: str = "run") -> Iterator[bool]:
    """Compile in parallel what a study needs inside the block; yield whether there is anything."""
    jobs = _missing_jobs(case, study) if allowed and processors() > 1 else []
    with ExitStack() as stack:
        if jobs:
            with suppress(OSError):  # Without a temporary folder this process compiles alone.
                directory = TemporaryDirectory(prefix="tribodyn-", ignore_cleanup_errors=True)
                folder = stack.enter_context(directory)
                busy = stack.enter_context(in_background(_compile, [(folder, job) for job in jobs]))
                lock = CacheLock(Path(folder), partial(_interruptibly, busy))
                stack.enter_context(locked(lock))
        yield bool(jobs)


def _interruptibly(busy: Callable[[], bool]) -> bool:
    refuse_stopped(STOPPED * int(stop_flag()[0]))
    return busy()


def _missing_jobs(case: PairCase, study: str = "run") -> Sequence[str]:
    """Return the jobs of a study that are not cached."""
    from tribodyn.dynamics._engine.marching import march_block
    from tribodyn.study.case.sections import AUTO

    if not hasattr(march_block, "_cache"):  # Numba is disabled
        return []
    uncached = set()
    if case.spur_pair is not None:
        from tribodyn.stiffness.loaded.kernel import solve_loads

        uncached |= set() if is_cached(solve_loads) else {"loads"}
    if case.solver.engine in ("runge-kutta-4", AUTO) and not is_cached(march_block):
        uncached |= {job for jobs in _JOBS.values() for job in jobs} - {"loads"}
    return [job for job in _JOBS[study] if job in uncached]


def _compile(order: tuple[str, str]) -> None:
    """Compile for another process, unless that has already started to."""
    folder, job = order
    with suppress(ElsewhereError), locked(CacheLock(Path(folder))):
        _WORK[job]()


def compile_marches() -> None:
    """Compile the time integration of all studies in this process."""
    for job, work in _WORK.items():
        if job != "loads":
            work()


def _loads() -> None:
    """Compile the load distribution with empty arrays."""
    from tribodyn.stiffness.loaded.kernel import solve_loads

    none, line = np.zeros((0, 1, 1)), np.zeros((1, 0))
    loads = line, line, np.zeros((1, 0, 1, 1)), line
    solve_loads(none, none[0:, :, 0], 0.0, none, none, *loads, stop_flag())


def _march(lanes: int, followed: bool = False) -> None:
    """Compile a time integration of zero length, and its statistics."""
    from tribodyn.dynamics._engine.statistics import Statistics
    from tribodyn.dynamics.time.engines import Setting, prepare

    system, frequency = _system(), np.full(lanes, 10.0)
    trajectories = prepare("rk4", Setting(system, frequency, 1, 64, np.zeros((lanes, 1))))
    gathered = Statistics.of(trajectories.compiled, np.zeros((1, 2)), lanes) if followed else None
    trajectories.march(np.zeros((lanes, 2)), 1, statistics=gathered)


def _rows() -> None:
    """Compile the batched time integration of an operating map with zero length."""
    from tribodyn.dynamics.orbits.batched_orbits import SystemBatch

    batch = SystemBatch([_system()] * _BLOCK, np.full(_BLOCK, 10.0), 64)
    batch.march(batch.full_steps, batch.start(), np.arange(_BLOCK), lambda number, states: None)


def _system() -> System:
    from tribodyn.dynamics import Contact, System

    contact = Contact([1.0], 1e4, 10.0)
    return System([[1.0]], [[1.0]], [[1e4]], [1.0], contacts=[contact])


_WORK: dict[str, Callable[[], None]] = {
    "loads": _loads,
    "one motion": partial(_march, 1),
    "motions": partial(_march, _BLOCK),
    "followed motion": partial(_march, 1, followed=True),
    "rows of motions": _rows,
}
