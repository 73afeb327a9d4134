"""The steady state found directly, against marching until the motion repeats.

Marching goes on until displacements and speeds are within 1e-8 of the periodic orbit. That number
of cycles is found beforehand and then marched in one go, so that marching pays nothing for knowing
when to stop. Both sides set the system up.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from marchers import march_once
from race import arguments, machine, print_table, race
from reference_pair import D2, Pair, elastic, starting_state, system
from tribodyn.dynamics import Response, steady_state
from tribodyn.dynamics.equations.compiled import compile_for

__all__ = ["cycles_to_repeat", "main"]

ACCURACY = 1e-8
_STEPS = 512
_LONGEST = 20000
#: Mesh frequency [Hz] and mesh damping [N*s/m]: the natural frequency of the mesh is near 5800 Hz.
_RUNS = ((240.0, 900.0), (1500.0, 900.0), (5800.0, 900.0), (5800.0, 90.0), (9000.0, 90.0))


def _state_error(state: np.ndarray, orbit: Response) -> float:
    parts = ((state[:6], orbit.position[0]), (state[6:], orbit.velocity[0]))
    pairs = [(elastic(own), elastic(exact)) for own, exact in parts]
    return max(float(np.abs(own - exact).max() / np.abs(exact).max()) for own, exact in pairs)


def cycles_to_repeat(pair: Pair, orbit: Response) -> int:
    """Mesh cycles after which a marched motion is within 1e-8 of its periodic orbit.

    Parameters
    ----------
    pair : Pair
    orbit : Response
        The periodic orbit.

    Returns
    -------
    int

    Raises
    ------
    RuntimeError
        If it takes more than 20000 cycles.
    """
    compiled = compile_for(system(pair), pair.mesh_frequency, _STEPS)
    state = np.concatenate(starting_state(pair))
    for cycle in range(1, _LONGEST + 1):
        state = march_once(compiled, pair, state, 1)
        if _state_error(state, orbit) <= ACCURACY:
            return cycle
    raise RuntimeError(f"the motion does not repeat within {_LONGEST} mesh cycles")


def _direct(pair: Pair) -> Response:
    return steady_state(system(pair), pair.mesh_frequency, steps=_STEPS, start=starting_state(pair))


def _compare(pair: Pair, rounds: int) -> tuple[str, ...]:
    orbit = _direct(pair)
    cycles = cycles_to_repeat(pair, orbit)

    def direct() -> float:
        _direct(pair)
        return 1.0

    def marching() -> float:
        compiled = compile_for(system(pair), pair.mesh_frequency, _STEPS)
        march_once(compiled, pair, np.concatenate(starting_state(pair)), cycles)
        return 1.0

    times = race({"direct": direct, "marching": marching}, rounds)
    return (
        f"{pair.mesh_frequency:g} Hz, {pair.mesh_damping:g} N*s/m",
        f"{abs(orbit.floquet_multipliers[0]):.4f}",
        f"{orbit.error:.1e}",
        str(orbit.cycles_used),
        str(cycles),
        f"{cycles / orbit.cycles_used:.3g}",
        f"{1e3 * times['direct'].median:.3g}",
        f"{1e3 * times['marching'].median:.3g}",
        f"{times['direct'].faster_than(times['marching']):.3g}",
    )


def main(words: Sequence[str] | None = None) -> None:
    """Run the comparison and print it.

    Parameters
    ----------
    words : sequence of str, optional
        Words of the command line.
    """
    quick = arguments(__doc__, words).quick
    print(f"Steady state: {machine()}\n")
    runs = _RUNS[1:2] if quick else _RUNS
    rows = [
        _compare(replace(D2, mesh_frequency=frequency, mesh_damping=damping), 1 if quick else 7)
        for frequency, damping in runs
    ]
    head = ("", "multiplier", "error", "cycles", "marched", "ratio", "CPU ms", "marched", "ratio")
    print_table(head, rows)


if __name__ == "__main__":
    main()
