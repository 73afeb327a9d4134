"""One interruption ends every kind of long call within a second of computing, and leaves no thread.

Each call here would go on for a long time. The second is counted in processor time of the
process, which a busy machine does not stretch.
"""

from __future__ import annotations

import os
import signal
import sys
import threading
import time
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import tribodyn as td
from known_systems import MESH_FREQUENCY, hysteresis_system, reference_system
from tribodyn.analysis import basins, bifurcation, lyapunov_exponents, parameter_map, poincare
from tribodyn.dynamics import (
    continuation,
    run_up,
    simulate,
    simulate_ensemble,
    solve_adaptive,
    speed_sweep,
    steady_state,
)
from tribodyn.ehl import (
    solve_line_contact_moes,
    solve_line_contacts,
    solve_transient_line_contact,
)
from tribodyn.lubricant import Lubricant
from tribodyn.stiffness import loaded_contact

resource = pytest.importorskip("resource", reason="signals to the own process")
OIL = Lubricant(0.082, 880.0, 2.19e-8)


def film(count: int, method: str) -> None:
    for _ in range(count):
        solve_line_contact_moes(50, 5, nodes=16385, method=method, domain="auto", inlet="flooded")


def films(size: int, threads: int) -> Any:
    loads = np.linspace(5e4, 1.5e5, size)
    return solve_line_contacts(loads, 8e-3, 3.0722, OIL, 2.2e11, threads=threads, nodes=2049)


def transient(steps: int) -> Any:
    time = np.linspace(0.0, 1e-3, steps + 1)
    load = 147802.0 * (1.0 - 0.3 * np.sin(np.pi * time / 1e-3) ** 2)
    return solve_transient_line_contact(time, load, 8e-3, 3.0722, OIL, 2.2e11, nodes=1025)


def case(**changes: Any) -> td.Case:
    return td.load_case("fzg-roughness").replace({"stiffness.model": "fe2d", **changes})


def teeth(count: int) -> None:
    crowned = case(**{"gears.pinion.modification.crowning": "5 um"})
    for _ in range(count):
        loaded_contact(crowned.gear_pair, 100.0, slices=1001)


def torques(count: int) -> list[str]:
    return [f"{60 + 0.2 * i} N*m" for i in range(count)]


START = ([1.8], [0.0])
SLOW = np.linspace(0.1, 0.2, 20_000)

#: A call of each kind: of a small size, which compiles it, and of one that takes long.
CALLS: dict[str, tuple[Callable[[int], Any], int, int]] = {
    "film, newton": (lambda n: film(n, "newton"), 1, 1000),
    "film, multigrid": (lambda n: film(n, "multigrid"), 1, 1000),
    "films, one thread": (lambda n: films(n, 1), 1, 4000),
    "films, threads": (lambda n: films(n, 2), 2, 4000),
    "film over time": (transient, 10, 20000),
    "loaded contact": (teeth, 1, 1000),
    "fixed steps": (
        lambda n: simulate(hysteresis_system(), 0.14, n, START, steps=4096), 2, 100_000,
    ),
    "free steps": (
        lambda n: solve_adaptive(hysteresis_system(), 0.14, n, START, rtol=1e-11), 2, 100_000,
    ),
    "newmark": (
        lambda n: simulate(hysteresis_system(), 0.14, n, START, steps=4096, method="newmark"),
        2, 100_000,
    ),
    "ensemble": (
        lambda n: simulate_ensemble(hysteresis_system(), np.full(64, 0.14), n, START), 2, 200_000,
    ),
    "steady state": (
        lambda n: steady_state(reference_system(0.05), MESH_FREQUENCY, steps=n), 512, 2_000_000,
    ),
    "speed sweep": (
        lambda n: speed_sweep(hysteresis_system(), SLOW[::n], steps=4096), 10_000, 1,
    ),
    "continuation": (
        lambda n: continuation(hysteresis_system(), between=(0.1, 0.2), steps=n), 64, 20_000,
    ),
    "bifurcation": (
        lambda n: bifurcation(hysteresis_system(), SLOW[:n], transient=n * 5_000, steps=4096),
        1, 20_000,
    ),
    "basins": (
        lambda n: basins(
            hysteresis_system(), 0.14, between=((0.0, 4.0), (-2.0, 2.0)), points=(n, n), steps=512
        ), 2, 400,
    ),
    "parameter map": (
        lambda n: parameter_map(
            hysteresis_system(),
            over=(("mesh_frequency", SLOW[:n]), ("force_scale", np.linspace(0.8, 1.2, n))),
            steps=512,
        ), 2, 400,
    ),
    "section": (
        lambda n: poincare(hysteresis_system(), 0.14, transient=n, steps=4096), 10, 200_000,
    ),
    "exponents": (
        lambda n: lyapunov_exponents(hysteresis_system(), 0.14, cycles=n, steps=4096), 50, 50_000,
    ),
    "run-up": (
        lambda n: run_up(hysteresis_system(), ([0.0, 100.0 * n], [0.1, 0.2])), 1, 100_000,
    ),
    "case": (lambda n: td.run(case(**{"film.model": "newton", "film.positions": n})), 8, 200),
    "tip relief": (lambda n: td.optimize_tip_relief(case(), torques(n)), 1, 60),
    "harris map": (lambda n: td.harris_map(case(), torques(n)), 2, 20_000),
}  # fmt: skip


def processor_time() -> float:
    used = resource.getrusage(resource.RUSAGE_SELF)
    return used.ru_utime + used.ru_stime


def seconds_until_it_ends(call: Callable[[], Any], after: float) -> float:
    """Processor time from a signal to the end of a call and of its threads."""
    signal_times: list[float] = []

    def interrupt() -> None:
        signal_times.append(processor_time())
        os.kill(os.getpid(), signal.SIGINT)

    def again(dropped: sys.UnraisableHookArgs) -> None:
        # Python drops an interruption that meets the callback of a weak reference.
        if dropped.exc_type is KeyboardInterrupt:
            threading.Timer(0.01, interrupt).start()

    before = threading.active_count()
    timer = threading.Timer(after, interrupt)
    timer.start()
    hook, sys.unraisablehook = sys.unraisablehook, again
    try:
        with pytest.raises(KeyboardInterrupt):
            call()
    finally:
        timer.cancel()
        sys.unraisablehook = hook
    left = 1000
    while threading.active_count() > before and left:
        time.sleep(0.01)
        left -= 1
    assert left, "a thread goes on"
    return processor_time() - signal_times[-1]


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::tribodyn.errors.ModelWarning")
@pytest.mark.parametrize("name", CALLS)
def test_one_interruption_ends_it(name: str) -> None:
    call, small, large = CALLS[name]
    call(small)
    spent = seconds_until_it_ends(lambda: call(large), 1.5)
    print(f"{name}: {spent:.2f} s of processor time")
    # Two threads, each of which ends within a second.
    assert spent < 2.0
