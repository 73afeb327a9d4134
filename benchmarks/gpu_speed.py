"""Motions on a graphics processor against all cores of the machine, and whether both are the same.

Each way is one call of ``simulate_ensemble``, set-up included, on the reference pair whose teeth
separate in every cycle; a map over speed and load follows. Without a graphics processor it says so.
"""

from __future__ import annotations

from collections.abc import Sequence
from time import perf_counter

import numpy as np

from race import arguments, machine, print_table
from reference_pair import WITH_BACKLASH, lanes, starting_state, system
from tribodyn.analysis import parameter_map
from tribodyn.dynamics import LaneParameters, simulate_ensemble
from tribodyn.dynamics._engine.generated.cuda import MissingProcessorError, require_gpu

__all__ = ["main"]

_STEPS, _RUNS = 512, 3


def _march(count: int, backend: str, *, summed: bool) -> np.ndarray:
    """States of lanes after their mesh cycles, and the mean square of each contact force."""
    each = lanes(WITH_BACKLASH, count)
    frequency = np.array([lane.mesh_frequency for lane in each])
    factors = LaneParameters(stiffness_scale=np.linspace(0.9, 1.1, count))
    motions = simulate_ensemble(
        system(WITH_BACKLASH), frequency, _cycles(count), starting_state(WITH_BACKLASH),
        steps=_STEPS, averaged=1 if summed else 0, parameters=factors, backend=backend,
    )  # fmt: skip
    return np.hstack([motions.position, motions.velocity])


def _cycles(count: int) -> int:
    return max(4, (1 << 15) // count)


def _time(count: int, backend: str, *, summed: bool) -> tuple[float, np.ndarray]:
    """Shortest of some times [s], the first of which compiles and does not count."""
    states = _march(count, backend, summed=summed)
    times = []
    for _ in range(_RUNS):
        start = perf_counter()
        _march(count, backend, summed=summed)
        times.append(perf_counter() - start)
    return min(times), states


def _rows(counts: Sequence[int]) -> list[tuple[str, ...]]:
    rows = []
    for count in counts:
        for summed in (False, True):
            ways = [_time(count, one, summed=summed) for one in ("cuda", "cpu")]
            taken, states = zip(*ways, strict=True)
            steps = count * _cycles(count) * _STEPS
            apart = np.abs(states[0] - states[1]).max(axis=0) / np.abs(states[1]).max(axis=0)
            what = f"{count} lanes{', statistics' if summed else ''}"
            speeds = [f"{1e-9 * steps / each:.3g}" for each in taken]
            rows.append((what, *speeds, f"{taken[1] / taken[0]:.3g}", f"{apart.max():.1e}"))
    return rows


def _map_row(points: int) -> tuple[str, ...]:
    over = (
        ("mesh_frequency", np.linspace(3000.0, 7000.0, points)),
        ("force_scale", np.linspace(0.3, 3.0, points)),
    )
    charts, times = [], []
    for backend in ("cuda", "cpu"):
        start = perf_counter()
        charts.append(parameter_map(system(WITH_BACKLASH), over=over, backend=backend))
        times.append(perf_counter() - start)
    gpu, cpu = charts
    changed = int(np.sum(gpu.period != cpu.period))
    apart = np.nanmax(np.abs(gpu.rms - cpu.rms) / np.nanmax(cpu.rms))
    return (f"map {points} x {points}", *(f"{each:.3g} s" for each in times),
            f"{times[1] / times[0]:.3g}", f"{apart:.1e}, {changed} periods")  # fmt: skip


def main(words: Sequence[str] | None = None) -> None:
    """Run the race and print it.

    Parameters
    ----------
    words : sequence of str, optional
        Words of the command line.
    """
    quick = arguments(__doc__, words).quick
    print(f"Motions on a graphics processor: {machine()}\n")
    try:
        require_gpu()
    except MissingProcessorError as missing:
        print(missing)
        return
    rows = _rows((64,) if quick else (4_096, 131_072))
    rows.append(_map_row(6 if quick else 100))
    head = ("", "G steps/s, GPU", "all cores", "ratio", "largest difference")
    print_table(head, rows)


if __name__ == "__main__":
    main()
