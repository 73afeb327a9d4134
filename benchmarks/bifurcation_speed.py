"""A bifurcation diagram of 200 values, each over up to 400 mesh cycles, with its verdict.

Ours follows all values upwards, ends a transient where the motion is certified to repeat, and
marches everything again with half the step. The rival, SciPy's DOP853 with a right-hand side in
Numba and a restart at every event, marches a few cycles of one value at 1e-6; its time for the
diagram is that of one mesh cycle times 200 values times 400 cycles, without a verdict. The last
column, one lane against the rival per mesh cycle, leaves out what ours saves by ending transients
early and by marching lanes side by side.
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from marchers import march_once
from peers import scipy_solver
from race import Goal, arguments, machine, print_goals, print_table, race
from reference_pair import WITH_BACKLASH, starting_state, system
from tribodyn.analysis import bifurcation
from tribodyn.dynamics import Contact, System
from tribodyn.dynamics.equations.compiled import compile_for

__all__ = ["main"]

_STEPS, _CYCLES = 512, 400
#: Mesh frequencies [Hz] around the resonance, where the teeth separate.
_BETWEEN = (3000.0, 7000.0)
#: Mesh cycles of the statistics, and tolerance of the rival that gives 1e-6.
_STATISTICS, _TOLERANCE = 64, 2e-7


def _oscillator() -> System:
    """One degree of freedom with a dead zone and a pulsating stiffness."""
    contact = Contact([1.0], stiffness=lambda phase: 1.0 + 0.2 * np.cos(2 * np.pi * phase), gap=1.0)
    return System([[1.0]], [[0.1]], [[0.0]], [0.5], [contact])


def _diagram(points: int, of: System, between: tuple[float, float]) -> float:
    """Wall-clock time [s] of a diagram."""
    begin = time.perf_counter()
    bifurcation(
        of, np.linspace(*between, points), steps=_STEPS, cycles=_STATISTICS,
        transient=_CYCLES - _STATISTICS,
    )  # fmt: skip
    return time.perf_counter() - begin


def main(words: Sequence[str] | None = None) -> None:
    """Run the race and print it.

    Parameters
    ----------
    words : sequence of str, optional
        Words of the command line.
    """
    quick = arguments(__doc__, words).quick
    print(f"Bifurcation diagram: {machine()}\n")
    points, rounds = (8, 1) if quick else (200, 3)
    pair, solve = WITH_BACKLASH, scipy_solver("DOP853", compiled=True)
    gears, compiled = system(pair), compile_for(system(pair), _BETWEEN[0], _STEPS)
    begin = np.concatenate(starting_state(pair))

    def ours() -> float:
        _diagram(points, gears, _BETWEEN)
        return float(points)

    def rival() -> float:
        own = replace(pair, mesh_frequency=_BETWEEN[1])
        solve(own, 1 if quick else 4, _TOLERANCE)
        return 1.0 if quick else 4.0

    def marching() -> float:
        march_once(compiled, pair, begin, 20)
        return 20.0

    times = race({"ours": ours, "rival": rival, "marching": marching}, rounds)
    per_value = _CYCLES * times["rival"].median
    rows = [
        (
            f"6 degrees of freedom, {points} values",
            f"{points * times['ours'].median:.3g}",
            f"{min(times['ours'].wall) * points:.3g}",
            f"{points * per_value:.4g}",
            f"{per_value / times['ours'].median:.3g}",
            f"{times['marching'].faster_than(times['rival']):.3g}",
        )
    ]
    head = ("", "CPU s", "wall s", "rival CPU s", "ratio", "ratio per cycle")
    print_table(head, rows)
    single = [_diagram(points, _oscillator(), (0.08, 0.2)) for _ in range(rounds + 1)]
    if not quick:
        wall = min(times["ours"].wall) * points
        print_goals([
            Goal("6 degrees of freedom", 3.0, wall, "s", at_least=False),
            Goal("one with backlash", 3.0, min(single[1:]), "s", at_least=False),
        ])  # fmt: skip


if __name__ == "__main__":
    main()
