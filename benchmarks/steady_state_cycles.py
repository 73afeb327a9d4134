"""Mesh cycles until a steady state is found, over the largest Floquet multiplier.

A sweep of the mesh frequency and random gear pairs, with and without play, all from rest under the
mean load. "search" counts the mesh cycles marched one after the other until Newton's method found
the orbit, "all" the steps of Newton's method as well, each of which marches the columns of the
monodromy matrix at a time.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from race import Goal, arguments, machine, print_goals, print_table
from reference_pair import D2, Pair, system
from tribodyn.dynamics import Response, steady_state
from tribodyn.errors import ModelWarning

__all__ = ["LIMITS", "find", "main", "variants"]

#: Largest multiplier, and mesh cycles that may be marched up to it.
LIMITS = ((0.95, 10), (0.993, 30))
_STEPS = 512
_SWEEP = (240.0, 500.0, 900.0, 1500.0, 2500.0, 4000.0, 5800.0, 7000.0, 9000.0)
_PLAY = 30e-6


def variants(count: int, seed: int = 1) -> Iterator[Pair]:
    """Random gear pairs, every other one with play.

    Parameters
    ----------
    count : int
    seed : int

    Yields
    ------
    Pair
    """
    generator = np.random.default_rng(seed)
    for number in range(count):
        yield Pair(
            friction=generator.uniform(0.0, 0.1),
            mesh_damping=float(np.exp(generator.uniform(np.log(5.0), np.log(900.0)))),
            gap=_PLAY * (number % 2),
            torque=generator.uniform(30.0, 300.0),
            mesh_frequency=float(np.exp(generator.uniform(np.log(240.0), np.log(9000.0)))),
        )


def find(pair: Pair) -> Response:
    """Steady state of a pair.

    Parameters
    ----------
    pair : Pair

    Returns
    -------
    Response
    """
    with warnings.catch_warnings():
        # An orbit that is not stable is told in the table.
        warnings.simplefilter("ignore", ModelWarning)
        return steady_state(system(pair), pair.mesh_frequency, steps=_STEPS)


def _row(pair: Pair, orbit: Response) -> tuple[str, ...]:
    lost = float(np.mean(np.abs(orbit.deflection) <= pair.gap)) if pair.gap else 0.0
    return (
        f"{pair.mesh_frequency:.0f} Hz, {pair.mesh_damping:.0f} N*s/m, {pair.torque:.0f} N*m",
        f"{1e6 * pair.gap:.0f}",
        f"{100.0 * lost:.0f} %",
        f"{abs(orbit.floquet_multipliers[0]):.4f}",
        str(orbit.search_cycles),
        str(orbit.cycles_used),
        f"{orbit.error:.0e}",
    )


def main(words: Sequence[str] | None = None) -> None:
    """Find the steady states and print the cycles.

    Parameters
    ----------
    words : sequence of str, optional
        Words of the command line.
    """
    quick = arguments(__doc__, words).quick
    print(f"Steady state, cycles: {machine()}\n")
    sweep = [
        replace(D2, mesh_frequency=frequency, mesh_damping=damping, gap=gap)
        for damping in (900.0, 90.0, 10.0)
        for gap in (0.0, _PLAY)
        for frequency in _SWEEP
    ]
    pairs = [*(sweep[::9] if quick else sweep), *variants(2 if quick else 30)]
    found = [(pair, find(pair)) for pair in pairs]
    head = ("", "half play um", "apart", "multiplier", "search", "all", "error")
    print_table(head, [_row(*each) for each in found])
    kept = [
        orbit
        for pair, orbit in found
        if orbit.stable and (pair.gap == 0.0 or np.all(orbit.deflection > pair.gap))
    ]
    goals, least = [], -1.0
    for limit, cycles in LIMITS:
        own = [o.search_cycles for o in kept if least < abs(o.floquet_multipliers[0]) <= limit]
        name = f"flanks in touch, multiplier up to {limit}, {len(own)} orbits"
        goals.append(Goal(name, cycles, max(own, default=0), "cycles", at_least=False))
        least = limit
    print_goals(goals)


if __name__ == "__main__":
    main()
