"""Machines over the speed: steady motions one after the other, and run-ups in time."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from tribodyn.dynamics import harmonic_balance
from tribodyn.errors import ComputationError, InputError, collected, warn
from tribodyn.interrupt import single_blas_thread
from tribodyn.progress import SILENT, Progress
from tribodyn.study.machine.result import STEPS
from tribodyn.study.machine.run import machine_motion, run_load
from tribodyn.study.machine_studies.levels import MachineLevels, levels_of
from tribodyn.study.machine_studies.points import results_under

if TYPE_CHECKING:
    from tribodyn.machine import MachineStructure
    from tribodyn.study.machine.case import MachineCase
    from tribodyn.study.machine.motion import MachineMotion
    from tribodyn.types import Array

#: Most periods of a run-up whose levels are computed.
_RECORDED = 400
#: Change of the speed from one period of the clock to the next that causes a warning.
_COARSE = 0.02


def machine_speed_sweep(
    case: MachineCase, speeds: Array, progress: Progress = SILENT
) -> MachineLevels:
    """Levels of the steady motions of a machine over the speed of its input [rad/s]."""
    from tribodyn.machine import machine_modes

    progress.start("Speeds", speeds.size)
    failed: list[str] = []
    structures: list[MachineStructure] = []

    def motions() -> Iterator[MachineMotion | None]:
        for result, _ in results_under(case, [{"operation.speed": float(n)} for n in speeds]):
            if isinstance(result, InputError | ComputationError):
                failed.append(str(result))
                yield None
            else:
                failed.append("")
                if not structures or len(failed) <= speeds.size // 2:
                    structures[:] = [result.structure]
                yield result.motion
            progress.advance()

    try:
        levels = levels_of(motions(), speeds)
    except ComputationError as error:
        raise ComputationError(replace(error.problems[0], why=failed[0])) from None
    progress.finish()
    modes = machine_modes(structures[0])
    return replace(levels, failed=np.array(failed, dtype=object), modes=modes)


def machine_run_up(
    case: MachineCase,
    ends: tuple[float, float],
    duration: float,
    *,
    down: bool = False,
    hold: float = 0.0,
    progress: Progress = SILENT,
) -> MachineLevels:
    """Levels of a machine along a run-up from one speed of its input to another [rad/s]."""
    # The speed rises from period to period; teeth and gyroscopic moments are of the mean speed.
    from tribodyn.dynamics.harmonic.varying_speed import periods_at
    from tribodyn.machine import machine_modes

    middle = case.replace({"operation.speed": float(np.sqrt(ends[0] * ends[1]))})
    per_speed = middle.machine().clock.frequency / middle.operating_point.speed
    speed, time = _periods(per_speed, ends, duration, hold, down)
    with collected(), single_blas_thread():
        result = run_load(middle, middle.operating_point, progress, [])
        start = harmonic_balance(result.system, float(per_speed * speed[0]), steps=STEPS)
        every = -(-speed.size // _RECORDED)
        progress.start("Periods of the run-up", speed.size)

        def motions() -> Iterator[MachineMotion]:
            frequency = (per_speed * speed).tolist()
            for response in periods_at(result.system, frequency, start, STEPS, every):
                if response is not None:
                    yield machine_motion(result.structure, response)
                progress.advance()

        times = {"time": time[::every], "modes": machine_modes(result.structure)}
        levels = levels_of(motions(), speed[::every], **times)
        progress.finish()
    return levels


def _periods(
    per_speed: float, ends: tuple[float, float], duration: float, hold: float, down: bool
) -> tuple[Array, Array]:
    """Speed and time in the middle of each period of the clock; the last one is completed."""
    corners = np.cumsum([0.0, duration, hold, duration * down])
    speeds = [ends[0], ends[1], ends[1], ends[0] if down else ends[1]]
    times, rows, now = [], [], 0.0
    while now < corners[-1]:
        period = 1.0 / (per_speed * float(np.interp(now, corners, speeds)))
        middle = now + 0.5 * period
        rows.append(float(np.interp(middle, corners, speeds)))
        times.append(middle)
        now += 1.0 / (per_speed * rows[-1])
    change = np.abs(np.diff(rows)).max(initial=0.0) / ends[0]
    if change > _COARSE:
        warn(
            "run-up-steps",
            f"the speed changes by {100.0 * change:.2g} % from one period of the clock to the next "
            f"({1.0 / (per_speed * ends[0]):.3g} s at the lowest speed), limit "
            f"{100.0 * _COARSE:g} %. Let it rise more slowly",
        )
    return np.array(rows), np.array(times)
