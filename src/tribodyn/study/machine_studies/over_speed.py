"""Machines and stages over the speed: steady motions one after the other, and run-ups in time."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from tribodyn.dynamics import harmonic_balance
from tribodyn.errors import ComputationError, InputError, collected, warn
from tribodyn.interrupt import single_blas_thread
from tribodyn.progress import SILENT, Progress
from tribodyn.study.machine_studies.levels import MachineLevels, levels_of
from tribodyn.study.machine_studies.points import result_under, results_under
from tribodyn.study.planetary.result import PlanetaryLoadResult
from tribodyn.study.planetary.stage_signals import common_lines

if TYPE_CHECKING:
    from tribodyn.study.machine.motion import MachineMotion
    from tribodyn.study.machine.user_tables import PartsCase
    from tribodyn.study.machine_studies.points import AnyLoadResult
    from tribodyn.types import Array

#: Most periods of a run-up whose levels are computed.
_RECORDED = 400
#: Change of the speed from one period of the clock to the next that causes a warning.
_COARSE = 0.02


def parts_speed_sweep(case: PartsCase, speeds: Array, progress: Progress = SILENT) -> MachineLevels:
    """Levels of the steady motions of a machine or stage over the speed of its input [rad/s]."""
    progress.start("Speeds", speeds.size)
    failed: list[str] = []
    middle: list[AnyLoadResult] = []

    def motions() -> Iterator[MachineMotion | None]:
        changes = [{"operation.speed": float(n)} for n in speeds]
        for result, _ in results_under(case, changes, progress):
            if isinstance(result, InputError | ComputationError):
                failed.append(str(result))
                yield None
            else:
                failed.append("")
                if not middle or len(failed) <= speeds.size // 2:
                    middle[:] = [result]
                yield result.signals_along(result.response)
            progress.advance()

    try:
        levels = levels_of(motions(), speeds)
    except ComputationError as error:
        raise ComputationError(replace(error.problems[0], why=failed[0])) from None
    progress.finish()
    return replace(_levels_of_result(levels, middle[0]), failed=np.array(failed, dtype=object))


def parts_run_up(
    case: PartsCase,
    ends: tuple[float, float],
    duration: float,
    *,
    down: bool = False,
    hold: float = 0.0,
    progress: Progress = SILENT,
) -> MachineLevels:
    """Levels of a machine or stage along a run-up between speeds of its input [rad/s]."""
    # The speed rises from period to period; teeth and gyroscopic moments are of the mean speed.
    from tribodyn.dynamics.harmonic.varying_speed import periods_at

    middle = case.replace({"operation.speed": float(np.sqrt(ends[0] * ends[1]))})
    with collected(), single_blas_thread():
        result = result_under(middle, progress, [])
    per_speed = result.clock_frequency / middle.operating_point.speed
    speed, time = _periods(per_speed, ends, duration, hold, down)
    with collected(), single_blas_thread():
        steps = result.steps
        start = harmonic_balance(result.system, float(per_speed * speed[0]), steps=steps)
        every = -(-speed.size // _RECORDED)
        progress.start("Periods of the run-up", speed.size)

        def motions() -> Iterator[MachineMotion]:
            frequency = (per_speed * speed).tolist()
            for response in periods_at(result.system, frequency, start, steps, every):
                if response is not None:
                    yield result.signals_along(response)
                progress.advance()

        levels = levels_of(motions(), speed[::every], time=time[::every])
        progress.finish()
    return _levels_of_result(levels, result)


def _levels_of_result(levels: MachineLevels, result: AnyLoadResult) -> MachineLevels:
    """Levels with the modes of a result, and what its meshes excite."""
    changes: dict[str, Any] = {}
    if isinstance(result, PlanetaryLoadResult):
        changes = common_lines(levels, result.motion.planet.size)
    return replace(levels, modes=result.modes, mesh_orders=result.mesh_orders, **changes)


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
