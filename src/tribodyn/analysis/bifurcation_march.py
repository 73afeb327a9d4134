"""The motions behind a bifurcation diagram: one after the other, or many side by side."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from concurrent.futures import FIRST_EXCEPTION, wait

import numpy as np

from tribodyn.analysis.attractors import Motions, settle
from tribodyn.analysis.bifurcation_statistics import measure
from tribodyn.analysis.bifurcation_sweep import Stretches, march_stretches
from tribodyn.analysis.bifurcation_values import Plan, Row, Values
from tribodyn.dynamics.start import static_start
from tribodyn.interrupt import Threads
from tribodyn.progress import SILENT, Progress
from tribodyn.types import Array, Index


def march_points(
    values: Values, first: Array | None, plan: Plan, progress: Progress, chosen: Array | None = None
) -> Row:
    """March every value of the parameter from a start of its own."""
    row = Row(values.count, plan.keep, values.size)
    if first is not None:
        row.first[:] = first
    numbers = np.arange(values.count) if chosen is None else np.flatnonzero(chosen)
    if values.shared is not None and numbers.size > 1:
        unknown = ~np.all(np.isfinite(row.first), axis=1)
        row.first[unknown] = static_start(values.shared)
        motions = Motions(values.shared, values.mesh_frequency, row.first)
        _uninterrupted(plan, lambda: settle(motions, numbers, plan.transient, progress=progress))
        _fill(row, motions, np.arange(values.count), plan)
        return row

    def one(number: int) -> None:
        _march_one(values, number, row, plan)

    _in_threads(plan, [lambda n=n: one(n) for n in numbers.tolist()], progress)  # type: ignore[misc]
    return row


def march_sweeps(
    values: Values, first: Array | None, plan: Plan, branches: tuple[str, ...], progress: Progress
) -> list[Row]:
    """March the values of the parameter each from the end of the last."""
    count = values.count
    rows = [Row(count, plan.keep, values.size) for _ in branches]
    if values.shared is not None:
        rest = static_start(values.shared)
        begin = rest if first is None else first
        sweeps = Stretches(values.shared, values.mesh_frequency, begin, rest, branches)
        _uninterrupted(plan, lambda: march_stretches(sweeps, plan.transient, progress))
        for number, row in enumerate(rows):
            _fill(row, sweeps, np.arange(count) + number * count, plan)
        return rows

    def sweep(branch: str, row: Row) -> None:
        state = first
        for number in range(count)[::-1] if branch == "down" else range(count):
            if plan.stop.is_set():
                return
            if state is not None:
                row.first[number] = state
            _march_one(values, number, row, plan)
            last = row.last[number]
            state = last if np.all(np.isfinite(last)) else None
            progress.advance()

    tasks = [
        lambda branch=branch, row=row: sweep(branch, row)  # type: ignore[misc]
        for branch, row in zip(branches, rows, strict=True)
    ]
    _in_threads(plan, tasks, SILENT)
    return rows


def _march_one(values: Values, number: int, row: Row, plan: Plan) -> None:
    """March one value by itself, from ``row.first`` if that is known."""
    compiled = values.at(number)
    if not np.all(np.isfinite(row.first[number])):
        row.first[number] = static_start(compiled)
    frequency = values.mesh_frequency[number : number + 1]
    motions = Motions(compiled, frequency, row.first[number : number + 1])
    settle(motions, [0], plan.transient, width=1)
    _fill(row, motions, np.array([0]), plan, np.array([number]))


def _fill(
    row: Row, motions: Motions, indices: Index, plan: Plan,
    numbers: Index | None = None,
) -> None:  # fmt: skip
    """Measure the finished motions, and write them into the row."""
    to = np.arange(indices.size) if numbers is None else numbers
    done = motions.finished[indices]
    indices, to = indices[done], to[done]
    found = measure(motions, indices, plan.cycles, plan.keep, plan.signal)
    row.first[to] = motions.start[indices]
    row.section[to], row.period[to], row.rms[to] = found.points, found.period, found.rms
    row.contact_loss_share[to], row.last[to] = found.contact_loss_share, found.last
    row.force[to] = motions.force[indices]
    row.finished[to] = True


def _uninterrupted(plan: Plan, work: Callable[[], None]) -> None:
    """Do some work; if it is interrupted, go on with what there is, where that is wanted."""
    try:
        work()
    except KeyboardInterrupt:
        plan.stop.set()
        if not plan.keep_partial:
            raise


def _in_threads(plan: Plan, tasks: Sequence[Callable[[], None]], progress: Progress) -> None:
    def guarded(task: Callable[[], None]) -> None:
        if not plan.stop.is_set():
            task()

    def work() -> None:
        with Threads(os.cpu_count() or 1) as pool:
            running = {pool.submit(guarded, task) for task in tasks}
            try:
                while running:
                    done, running = wait(running, 0.05, FIRST_EXCEPTION)
                    for item in done:
                        item.result()
                        progress.advance()
            except BaseException:
                plan.stop.set()
                raise

    _uninterrupted(plan, work)
