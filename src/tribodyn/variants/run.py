"""Run a study chunk by chunk into its store, on this machine or on a Dask cluster."""

from __future__ import annotations

import os
import socket
import time
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager, nullcontext
from pathlib import Path
from typing import Any

import tribodyn
from tribodyn.errors import ComputationError, InputError, warn
from tribodyn.interrupt import alone
from tribodyn.progress import SILENT, Progress
from tribodyn.study.processes import helpers
from tribodyn.variants.compute import Chunk, Job, Stored
from tribodyn.variants.store import Store, StudyState
from tribodyn.variants.study_file import Study, load_study

Jobs = Iterable[tuple[Chunk, Job]]
Results = Iterator[tuple[Chunk, Stored | Exception]]

#: Number of failed chunks, before any has succeeded, after which the study is given up.
_HOPELESS = 3
#: Time limit for an answer of the scheduler, and for a worker before a warning [s].
_PATIENCE = 10.0


def run_study(
    study: Study | str | os.PathLike[str],
    store: str | os.PathLike[str],
    *,
    scheduler: str = "",
    force: bool = False,
    progress: Progress = SILENT,
) -> StudyState:
    """Compute the members of a study that its store does not have yet.

    Parameters
    ----------
    study : Study, str or path
        From :func:`load_study`, or the path of a study file.
    store : str or path
        Directory. It is created, or a study in it is continued, including members that were added
        to the study since.
    scheduler : str
        Address of a Dask scheduler whose workers compute; by default the processors of this
        machine are used.
    force : bool
        Replace another study in this directory.
    progress : Progress
        Receives the number of finished members; silent by default.

    Returns
    -------
    StudyState
        Number of finished and failed members, and the reasons. A member that fails is stored with
        its reason, and the study continues.

    Raises
    ------
    InputError
        If the study file has errors, another study or process uses the directory, or no scheduler
        answers.
    ComputationError
        If the directory cannot be written any more, or nothing can be computed at all. Finished
        members are stored.
    """
    ready = study if isinstance(study, Study) else load_study(study)
    missing: dict[str, str] = {}
    engine = _cluster(scheduler) if scheduler else nullcontext(_on_this_machine)
    with engine as compute, Store(ready, Path(store), force) as place:
        left = place.left()
        total = ready.layout.count
        progress.start("Members", total)
        progress.advance(total - sum(chunk.end - chunk.begin for chunk in left))
        jobs = ((chunk, place.job(chunk)) for chunk in left)
        for chunk, outcome in compute(jobs, progress):
            if isinstance(outcome, Stored):
                place.put(chunk, outcome)
            else:
                missing[chunk.name] = f"{type(outcome).__name__}: {outcome}"
                _give_up(missing, len(place.left()) == len(left))
        progress.finish()
        return place.state(missing)


def _give_up(missing: dict[str, str], none_done: bool) -> None:
    """Raise if the first chunks fail and none has succeeded."""
    if none_done and len(missing) >= _HOPELESS:
        what = f"none of the first {len(missing)} chunks can be computed"
        why = next(iter(missing.values()))
        remedy = "Fix this on the computing machines; the same command continues the study"
        raise ComputationError(what, "", why, remedy)


def _on_this_machine(jobs: Jobs, progress: Progress) -> Results:
    """Compute one chunk after the other, each with all processors."""
    with helpers():
        for chunk, job in jobs:
            try:
                yield chunk, job.stored(_Within(progress))
            except (ImportError, MemoryError, OSError) as error:
                yield chunk, error


class _Within:
    """Progress of a chunk as part of the progress of the study."""

    def __init__(self, study_progress: Progress) -> None:
        self.advance = study_progress.advance
        self.describe = getattr(study_progress, "describe", None)

    def start(self, task: str, total: int | None = None) -> None:
        """Do nothing: the study has already started its progress."""

    def finish(self) -> None:
        """Do nothing: the study finishes its progress."""


def compute_alone(version: str, job: Job) -> Stored:
    """Compute a chunk in one thread of a worker."""
    if version != tribodyn.__version__:
        what = f"a worker has version {tribodyn.__version__} of tribodyn, the study {version}"
        raise InputError(what, "", "", "Install the same version on all machines")
    with alone():
        return job.stored()


@contextmanager
def _cluster(address: str) -> Iterator[Callable[[Jobs, Progress], Results]]:
    """Connect to the workers of a cluster before anything is written."""
    try:
        from distributed import Client
        from distributed.comm import CommClosedError
        from distributed.comm.addressing import parse_host_port
    except ImportError:
        remedy = 'Install it: pip install "tribodyn[cluster]"'
        raise InputError("Dask is not installed", "--scheduler", "", remedy) from None
    try:
        # A client without a scheduler takes long to report it.
        socket.create_connection(parse_host_port(address.split("://")[-1]), _PATIENCE).close()
        client = Client(address, timeout=_PATIENCE, set_as_default=False)
    except (OSError, ValueError, TypeError, OverflowError) as error:
        what, why = f"no Dask scheduler answers at {address}", str(error).strip()
        remedy = "Start one with: dask scheduler; it prints its address"
        raise InputError(what, "--scheduler", why, remedy) from None

    def compute(jobs: Jobs, progress: Progress) -> Results:
        try:
            yield from _on_workers(client, jobs, progress)
        except Exception as error:
            if client.status == "running" and not isinstance(error, CommClosedError):
                raise
            what = f"the connection to the Dask scheduler at {address} is lost"
            why = "Finished members are stored"
            remedy = "Start a scheduler; the same command continues the study"
            raise ComputationError(what, "--scheduler", why, remedy) from None

    with client:
        yield compute


def _on_workers(client: Any, jobs: Jobs, progress: Progress) -> Results:
    """Compute on the workers, with a few more chunks submitted than they process at a time."""
    from distributed import as_completed

    waiting, token = iter(jobs), os.urandom(4).hex()
    running: dict[Any, Chunk] = {}
    ended = as_completed([], loop=client.loop)

    def fill() -> None:
        ahead = 2 * sum(client.nthreads().values()) + 2
        while len(running) < ahead and (task := next(waiting, None)) is not None:
            chunk, job = task
            key = f"{chunk.name}-{token}"
            future = client.submit(compute_alone, tribodyn.__version__, job, key=key)
            running[future] = chunk
            ended.add(future)

    fill()
    while running:
        _await_any(client, ended)
        future = next(ended)
        chunk = running.pop(future)
        try:
            outcome: Stored | Exception = future.result()
            progress.advance(chunk.end - chunk.begin)
        except Exception as error:
            if client.status != "running":
                raise
            outcome = error
        yield chunk, outcome
        fill()


def _await_any(client: Any, ended: Any) -> None:
    """Wait for a finished chunk, and warn once if there are no workers."""
    warned, last_check = False, time.monotonic()
    while not ended.has_ready():
        with ended.thread_condition:
            ended.thread_condition.wait(timeout=0.1)
        if time.monotonic() - last_check < _PATIENCE:
            continue
        alone = not client.nthreads()
        if alone and not warned:
            address = client.scheduler.address
            text = f"the Dask scheduler at {address} has no workers; the study waits for them"
            warn("no-workers", f"{text}. Start one with: dask worker {address} --nthreads 1.")
        warned, last_check = alone, time.monotonic()
