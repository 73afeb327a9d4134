"""What does a study cost beyond its members: its store, and one or two workers of Dask?

The members are motions of the pair with backlash and a verdict, as in ``parameter_map.py``. The
same chunks are computed without a store (the plain function), into a store by one thread, by all
threads, and by workers that are processes of this machine. The overhead of a chunk is what one
worker takes longer than one thread without a store, divided by the chunks.
"""

from __future__ import annotations

import os
import tempfile
import time
from collections.abc import Callable, Sequence
from pathlib import Path

from race import arguments
from tribodyn.interrupt import alone
from tribodyn.variants import read_study, run_study
from tribodyn.variants.members import Plan

STUDY = """
case = "fzg-roughness"
compute = "motions"
chunk = {chunk}
[set]
stiffness.model = "iso6336"
film.model = "none"
friction.law = "constant"
friction.coefficient = 0.05
dynamics.mesh_damping_ratio = 0.02
dynamics.backlash = "60 um"
[axes]
operation.speed = "3000..9000 rpm:{speeds}"
force_scale = "0.05..1:{loads}"
"""


def main(words: Sequence[str] | None = None) -> None:
    """Print seconds, members per second, and ratios to one thread without a store."""
    from distributed import Client, LocalCluster

    quick = arguments(__doc__, words).quick
    speeds, loads, chunk = (4, 4, 8) if quick else (100, 100, 1000)
    study = read_study(STUDY.format(chunk=chunk, speeds=speeds, loads=loads))
    members, chunks = study.layout.count, -(-study.layout.count // chunk)
    plan = Plan(study.layout, [{**study.layout.facts(), "chunk": chunk}])

    def plain() -> None:
        from tribodyn.variants.compute import Job

        for each in plan.chunks:
            columns = study.layout.columns(plan.members(each))
            Job(study.compute, study.case, study.keep, columns).compute()

    def stored(address: str = "") -> float:
        with tempfile.TemporaryDirectory() as folder:
            return timed(lambda: run_study(study, Path(folder) / "s", scheduler=address))

    with alone():
        timed(plain)  # what is compiled once
        bare = timed(plain)
        told("one thread, no store", bare, members, bare)
        single = stored()
        told("one thread, into a store", single, members, bare)
        print(f"    the store costs {(single - bare) / chunks * 1e3:.1f} ms a chunk")
    told(f"all threads ({os.cpu_count()}), into a store", stored(), members, bare)
    for count in () if quick else (1, 2):
        with (
            LocalCluster(count, threads_per_worker=1, dashboard_address=None) as cluster,
            Client(cluster) as client,
        ):
            client.run(warm, STUDY.format(chunk=8, speeds=4, loads=2))
            took = stored(cluster.scheduler_address)
            told(f"Dask, workers: {count}", took, members, bare)
            if count == 1:
                print(f"    overhead of a chunk: {(took - bare) / chunks * 1e3:.1f} ms")


def warm(text: str) -> None:
    """Let a worker load what it needs once."""
    with tempfile.TemporaryDirectory() as folder, alone():
        run_study(read_study(text), Path(folder) / "s")


def timed(work: Callable[[], object]) -> float:
    """Wall seconds of a call."""
    start = time.perf_counter()
    work()
    return time.perf_counter() - start


def told(words: str, seconds: float, members: int, bare: float) -> None:
    """Print one line."""
    print(f"{words:36} {seconds:8.2f} s {members / seconds:8.0f} members/s {bare / seconds:6.2f} x")


if __name__ == "__main__":
    main()
