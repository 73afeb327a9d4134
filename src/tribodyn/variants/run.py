"""Run a study: chunk by chunk into its store, here or on the workers of a Dask cluster."""

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
from tribodyn.variants.compute import Job, Stored
from tribodyn.variants.members import Chunk
from tribodyn.variants.store import Store, StudyState
from tribodyn.variants.study_file import Study, load_study

Jobs = Iterable[tuple[Chunk, Job]]
Results = Iterator[tuple[Chunk, Stored | Exception]]

#: Chunks that fail as a whole before any is finished, after which nothing else is tried.
_HOPELESS = 3
#: Time for a scheduler to answer, and for a worker to come before it is missed [s].
_PATIENCE = 10.0


def run_study(
    study: Study | str | os.PathLike[str],
    store: str | os.PathLike[str],
    *,
    scheduler: str = "",
    force: bool = False,
    progress: Progress = SILENT,
) -> StudyState:
    """Compute what a store lacks of a study.

    Parameters
    ----------
    study : Study, str or path
        From :func:`load_study`, or the path of a study file.
    store : str or path
        Directory; it is made, or the study goes on where it was left, with the members that it
        got since.
    scheduler : str
        Address of a Dask scheduler whose workers compute; by default the processors of this
        machine do.
    force : bool
        Replace another study in that place.
    progress : Progress
        Told how many members are done; silent by default.

    Returns
    -------
    StudyState
        How many members are done and failed, and why. A member that fails is stored with its
        reason, and the study goes on.

    Raises
    ------
    InputError
        If the study file has faults, another study or process has the place, or no scheduler
        answers.
    ComputationError
        If the place cannot be written to any more, or nothing can be computed at all. What is
        finished is stored.
    """
    ready = study if isinstance(study, Study) else load_study(study)
    missing: dict[str, str] = {}
    engine = _cluster(scheduler) if scheduler else nullcontext(_here)
    with engine as compute, Store(ready, Path(store), force) as place:
        left = place.left()
        total = ready.layout.count
        progress.start("Members", total)
        progress.advance(total - sum(chunk.end - chunk.begin for chunk in left))
        jobs = ((chunk, place.job(chunk)) for chunk in left)
        for chunk, found in compute(jobs, progress):
            if isinstance(found, Stored):
                place.put(chunk, found)
            else:
                missing[chunk.name] = f"{type(found).__name__}: {found}"
                _give_up(missing, len(place.left()) == len(left))
        progress.finish()
        return place.state(missing)


def _give_up(missing: dict[str, str], none_done: bool) -> None:
    """End what cannot succeed."""
    if none_done and len(missing) >= _HOPELESS:
        what = f"none of the first {len(missing)} chunks can be computed"
        why = next(iter(missing.values()))
        remedy = "Mend it on the machines that compute; the same command goes on"
        raise ComputationError(what, "", why, remedy)


def _here(jobs: Jobs, progress: Progress) -> Results:
    """Compute one chunk after the other, each with all processors."""
    with helpers():
        for chunk, job in jobs:
            try:
                yield chunk, job.stored(_Within(progress))
            except (ImportError, MemoryError, OSError) as error:
                yield chunk, error


class _Within:
    """Progress of a chunk within that of the study."""

    def __init__(self, whole: Progress) -> None:
        self.advance = whole.advance

    def start(self, task: str, total: int | None = None) -> None:
        """Begin nothing: the study has begun."""

    def finish(self) -> None:
        """End nothing."""


def compute_alone(version: str, job: Job) -> Stored:
    """Compute a chunk in one thread of a worker."""
    if version != tribodyn.__version__:
        what = f"a worker has version {tribodyn.__version__} of tribodyn, the study {version}"
        raise InputError(what, "", "", "Install the same version on all machines")
    with alone():
        return job.stored()


@contextmanager
def _cluster(address: str) -> Iterator[Callable[[Jobs, Progress], Results]]:
    """Workers of a cluster, which are there before anything is written."""
    try:
        from distributed import Client
        from distributed.comm.addressing import parse_host_port
    except ImportError:
        remedy = 'Install it: pip install "tribodyn[cluster]"'
        raise InputError("Dask is not installed", "--scheduler", "", remedy) from None
    try:
        # A client that finds nobody takes long to tell it.
        socket.create_connection(parse_host_port(address.split("://")[-1]), _PATIENCE).close()
        client = Client(address, timeout=_PATIENCE, set_as_default=False)
    except (OSError, ValueError, TypeError, OverflowError) as error:
        what, why = f"no Dask scheduler answers at {address}", str(error).strip()
        remedy = "Start one with: dask scheduler; it tells its address"
        raise InputError(what, "--scheduler", why, remedy) from None

    def compute(jobs: Jobs, progress: Progress) -> Results:
        try:
            yield from _on_workers(client, jobs, progress)
        except Exception:
            if client.status == "running":
                raise
            what, why = f"the Dask scheduler at {address} is gone", "What is finished is stored"
            remedy = "Start a scheduler; the same command goes on with it"
            raise ComputationError(what, "--scheduler", why, remedy) from None

    with client:
        yield compute


def _on_workers(client: Any, jobs: Jobs, progress: Progress) -> Results:
    """Let the workers compute, a few chunks ahead of what they can do at once."""
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
            found: Stored | Exception = future.result()
            progress.advance(chunk.end - chunk.begin)
        except Exception as error:
            if client.status != "running":
                raise
            found = error
        yield chunk, found
        fill()


def _await_any(client: Any, ended: Any) -> None:
    """Wait for a chunk that has ended, and say so once when there is nobody to compute it."""
    told, looked = False, time.monotonic()
    while not ended.has_ready():
        with ended.thread_condition:
            ended.thread_condition.wait(timeout=0.1)
        if time.monotonic() - looked < _PATIENCE:
            continue
        alone = not client.nthreads()
        if alone and not told:
            address = client.scheduler.address
            text = f"the Dask scheduler at {address} has no workers; the study waits for them"
            warn("no-workers", f"{text}. Start one with: dask worker {address} --nthreads 1.")
        told, looked = alone, time.monotonic()
