"""Our side of the races: the reference pair marched in lanes."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from reference_pair import Pair, elastic, lanes, starting_state, system
from tribodyn.dynamics import simulate_ensemble
from tribodyn.dynamics._engine.blocks import march
from tribodyn.dynamics._engine.generated.source import write_source
from tribodyn.dynamics._engine.lanes import load, store
from tribodyn.dynamics._engine.statistics import Statistics
from tribodyn.dynamics.equations.compiled import Compiled, compile_for

__all__ = ["call", "end_displacements", "kernel", "march_once", "multiplications", "peak"]

Array = NDArray[np.float64]


def _variety(pair: Pair, count: int) -> tuple[Array, Array]:
    """Mesh frequency [Hz] and extra force of every lane."""
    own = lanes(pair, count)
    frequency = np.array([lane.mesh_frequency for lane in own])
    torque = np.array([lane.torque - pair.torque for lane in own])
    extra = np.zeros((count, 6))
    extra[:, 2], extra[:, 5] = torque, -1.5 * torque
    return frequency, extra


def kernel(
    pair: Pair, count: int, cycles: int, *, steps: int = 512, threads: int = 1, settle: int = 0,
    statistics: bool = False,
) -> Callable[[], float]:  # fmt: skip
    """March lanes on a system that is set up beforehand; nothing but the kernel.

    Parameters
    ----------
    pair : Pair
    count : int
        Lanes.
    cycles : int
        Mesh cycles.
    steps : int
        Steps per mesh cycle.
    threads : int
        Blocks at a time.
    settle : int
        Mesh cycles beforehand.
    statistics : bool
        Whether statistics are gathered.

    Returns
    -------
    callable
        Marches and returns the number of steps of all lanes together.
    """
    frequency, extra = _variety(pair, count)
    compiled = compile_for(system(pair), frequency, steps)
    state = np.tile(np.concatenate(starting_state(pair)), (count, 1))
    period = 1.0 / frequency
    if settle:
        state = march(compiled, period, state, settle, extra_force=extra)

    sums = Statistics.of(compiled, np.zeros((0, state.shape[1])), count) if statistics else None

    def run() -> float:
        march(compiled, period, state, cycles, extra_force=extra, threads=threads, statistics=sums)
        return float(count * cycles * steps)

    return run


def call(pair: Pair, count: int, cycles: int, *, steps: int = 512) -> Callable[[], float]:
    """One whole call of ``simulate_ensemble`` on one thread, its set-up included.

    Parameters
    ----------
    pair : Pair
    count : int
        Lanes.
    cycles : int
        Mesh cycles.
    steps : int
        Steps per mesh cycle.

    Returns
    -------
    callable
        Marches and returns the number of steps of all lanes together.
    """
    frequency, extra = _variety(pair, count)
    structure, start = system(pair), starting_state(pair)

    def run() -> float:
        simulate_ensemble(
            structure, frequency, cycles, start, steps=steps, extra_force=extra, threads=1
        )
        return float(count * cycles * steps)

    return run


def march_once(compiled: Compiled, pair: Pair, state: Array, cycles: int) -> Array:
    """March one state by whole mesh cycles.

    Parameters
    ----------
    compiled : Compiled
        The pair on its grid.
    pair : Pair
    state : (12,) array
        Position and velocity.
    cycles : int
        Mesh cycles.

    Returns
    -------
    (12,) array
    """
    period = np.array([1.0 / pair.mesh_frequency])
    return np.asarray(march(compiled, period, state[None, :], cycles)[0])


def end_displacements(pair: Pair, cycles: int, steps: int) -> Array:
    """Displacements after whole mesh cycles.

    Parameters
    ----------
    pair : Pair
    cycles : int
        Mesh cycles.
    steps : int
        Steps per mesh cycle.

    Returns
    -------
    (5,) array
        In m.
    """
    end = simulate_ensemble(
        system(pair), pair.mesh_frequency, cycles, starting_state(pair), steps=steps, averaged=0
    )
    return elastic(end.position[0])


def multiplications(pair: Pair) -> int:
    """Multiplications of one step of one lane, most of which add at the same time.

    Parameters
    ----------
    pair : Pair

    Returns
    -------
    int
    """
    program = compile_for(system(pair), pair.mesh_frequency, 512).program
    step = write_source(program).partition("def step")[2]
    head, _, rest = step.partition("for stage in range(4):")
    stage, _, tail = rest.partition("\n    w[")
    return head.count(" * ") + 4 * stage.count(" * ") + tail.count(" * ")


def peak() -> Callable[[], float]:
    """Multiply and add in vectors of lanes, from registers alone.

    Returns
    -------
    callable
        Does so some hundred million times and returns how often.
    """
    import numba as nb

    width, rounds = 16, 2_000_000

    @nb.njit(fastmath={"contract", "nsz"})
    def turn(lanes: object, rounds: int, w: Array) -> None:
        factor, a, b, c = load(lanes, w, 0), load(lanes, w, 1), load(lanes, w, 2), load(lanes, w, 3)
        for _ in range(rounds):
            a, b, c = a * factor + factor, b * factor + factor, c * factor + factor
        store(w, 1, a + b + c)

    def run() -> float:
        turn((0.0,) * width, rounds, np.full(4 * width, 0.5))
        return 3.0 * width * rounds

    run()
    return run
