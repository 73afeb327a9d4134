"""The first run on a machine: another process compiles what it needs later, while it goes on."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager, suppress
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

import numpy as np

from tribodyn.compiled.agreement import Agreement, ElsewhereError, agreed, cached
from tribodyn.interrupt import STOPPED, processors, refuse_stopped, stop_flag
from tribodyn.study.processes import aside

if TYPE_CHECKING:
    from tribodyn.study.case.case import Case

#: Whether a first run may begin a process; those that compile for others begin none.
allowed = True
#: Motions side by side that fill a block of the engine.
_BLOCK = 16


@contextmanager
def compiled_beside(case: Case) -> Iterator[None]:
    """Share what a run of the case compiles inside the block with a process beside it."""
    jobs = _missing(case) if allowed and processors() > 1 else []
    with ExitStack() as stack:
        if jobs:
            with suppress(OSError):  # Where no folder can be made, this process compiles alone.
                made = TemporaryDirectory(prefix="tribodyn-", ignore_cleanup_errors=True)
                folder = stack.enter_context(made)
                busy = stack.enter_context(aside(_compile, [(folder, job) for job in jobs]))
                agreement = Agreement(Path(folder), partial(_interruptibly, busy))
                stack.enter_context(agreed(agreement))
        yield


def _interruptibly(busy: Callable[[], bool]) -> bool:
    refuse_stopped(STOPPED * int(stop_flag()[0]))
    return busy()


def _missing(case: Case) -> Sequence[str]:
    """What the run comes to last, first: it begins with the other end itself."""
    from tribodyn.dynamics._engine.marching import march_block
    from tribodyn.dynamics.time.engines import ENGINES

    if not hasattr(march_block, "_cache"):  # Numba was told to compile nothing
        return []
    jobs = []
    if case.gears.kind == "spur":
        from tribodyn.stiffness.loaded.kernel import solve_loads

        jobs += [] if cached(solve_loads) else ["loads"]
    if ENGINES[case.solver.engine].method == "rk4" and not cached(march_block):
        jobs += ["one motion", "motions"]
    return jobs


def _compile(order: tuple[str, str]) -> None:
    """Do a job for another process, unless that has begun to."""
    folder, job = order
    with suppress(ElsewhereError), agreed(Agreement(Path(folder))):
        if job == "loads":
            _loads()
        else:
            _march(_BLOCK if job == "motions" else 1)


def _loads() -> None:
    """Loads of tooth pairs at no phase."""
    from tribodyn.stiffness.loaded.kernel import solve_loads

    none, line = np.zeros((0, 1, 1)), np.zeros((1, 0))
    loads = line, line, np.zeros((1, 0, 1, 1)), line
    solve_loads(none, none[0:, :, 0], 0.0, none, np.zeros(1), *loads, stop_flag())


def _march(lanes: int) -> None:
    """A march that takes no time."""
    from tribodyn.dynamics import System
    from tribodyn.dynamics.time.engines import Setting, prepare

    system, frequency = System([[1.0]], [[1.0]], [[1e4]], [0.0]), np.full(lanes, 10.0)
    setting = Setting(system, frequency, 1, 64, np.zeros((lanes, 1)))
    prepare("rk4", setting).march(np.zeros((lanes, 2)), 1)
