"""What does a study cost beyond its members: its store, and one or two workers of Dask?

The members are motions of the pair with backlash and a verdict, as in ``parameter_map.py``. The
same chunks are computed without a store (the plain function), into a store by one thread, by all
threads, and by workers that are processes of this machine. The overhead of a chunk is what one
worker takes longer than one thread without a store, divided by the chunks, in processor time of
all processes: wall clocks tell something on a quiet machine only.
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
from tribodyn.variants.compute import Plan

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
    speeds, loads, chunk = (4, 4, 8) if quick else (200, 100, 1000)
    study = read_study(STUDY.format(chunk=chunk, speeds=speeds, loads=loads))
    members, chunks = study.layout.count, -(-study.layout.count // chunk)
    plan = Plan(study.layout, [{**study.layout.facts(), "chunk": chunk}])

    def plain() -> None:
        from tribodyn.variants.compute import Job

        for each in plan.chunks:
            columns = study.layout.columns(plan.members(each))
            Job(study.compute, study.case, study.keep, columns).compute()

    def stored(address: str = "") -> Callable[[], object]:
        place = Path(tempfile.mkdtemp(dir=folder)) / "s"
        return lambda: run_study(study, place, scheduler=address)

    with tempfile.TemporaryDirectory() as folder:
        with alone():
            timed(plain)  # what is compiled once
            bare = timed(plain)
            told("one thread, no store", bare, members, bare)
            single = timed(stored())
            told("one thread, into a store", single, members, bare)
            print(f"    the store costs {(single[1] - bare[1]) / chunks * 1e3:.1f} ms a chunk")
        told(f"all threads ({os.cpu_count()}), into a store", timed(stored()), members, bare)
        for count in () if quick else (1, 2):
            with (
                LocalCluster(
                    n_workers=count, threads_per_worker=1, dashboard_address=None
                ) as cluster,
                Client(cluster) as client,
            ):
                client.run(warm, STUDY.format(chunk=8, speeds=4, loads=2))
                before = sum(client.run(time.process_time).values())
                wall, used = timed(stored(cluster.scheduler_address))
                used += sum(client.run(time.process_time).values()) - before
                told(f"Dask, workers: {count}", (wall, used), members, bare)
                print(f"    overhead of a chunk: {(used - bare[1]) / chunks * 1e3:.1f} ms")


def warm(text: str) -> None:
    """Let a worker load what it needs once."""
    with tempfile.TemporaryDirectory() as folder, alone():
        run_study(read_study(text), Path(folder) / "s")


def timed(work: Callable[[], object]) -> tuple[float, float]:
    """Wall and processor seconds of a call."""
    start = time.perf_counter(), time.process_time()
    work()
    return time.perf_counter() - start[0], time.process_time() - start[1]


def told(words: str, took: tuple[float, float], members: int, bare: tuple[float, float]) -> None:
    """Print one line; the ratio is that of the wall clocks."""
    wall, used = took
    rates = f"{members / wall:8.0f} members/s {bare[0] / wall:6.2f} x"
    print(f"{words:32} {wall:7.2f} s, of processors {used:7.2f} s {rates}", flush=True)


if __name__ == "__main__":
    main()
