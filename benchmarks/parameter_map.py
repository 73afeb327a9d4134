"""A map of 300 x 300 motions over mesh frequency and load, each with its period and verdict.

Ours marches all motions in blocks of lanes, ends a transient where the motion is certified to
repeat, and judges by half the step. The rival, SciPy's DOP853 with a right-hand side in Numba and a
restart at every event, marches a few mesh cycles at 1e-3 (a map needs no more); its time for the
map is that of one mesh cycle times 90000 points times as many cycles as ours may take.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from peers import scipy_solver
from race import Goal, arguments, machine, print_goals, print_table, race
from reference_pair import WITH_BACKLASH, system
from tribodyn.analysis import parameter_map

__all__ = ["main"]

_TRANSIENT, _TOLERANCE = 300, 2e-4


def main(words: Sequence[str] | None = None) -> None:
    """Run the race and print it.

    Parameters
    ----------
    words : sequence of str, optional
        Words of the command line.
    """
    quick = arguments(__doc__, words).quick
    print(f"Map over two parameters: {machine()}\n")
    points = 6 if quick else 300
    pair, solve = WITH_BACKLASH, scipy_solver("DOP853", compiled=True)
    gears = system(pair)
    over = (
        ("mesh_frequency", np.linspace(3000.0, 7000.0, points)),
        ("force_scale", np.linspace(0.3, 3.0, points)),
    )

    def ours() -> float:
        parameter_map(gears, over=over, transient=_TRANSIENT)
        return float(points**2)

    def rival() -> float:
        solve(replace(pair, mesh_frequency=5000.0), 1 if quick else 10, _TOLERANCE)
        return 1.0 if quick else 10.0

    times = race({"ours": ours, "rival": rival}, 1)
    per_point = _TRANSIENT * times["rival"].median
    rows = [
        (
            f"{points} x {points} points",
            f"{points**2 * times['ours'].median:.3g}",
            f"{points**2 * times['ours'].wall[0]:.3g}",
            f"{points**2 * per_point:.4g}",
            f"{per_point / times['ours'].median:.3g}",
        )
    ]
    print_table(("", "CPU s", "wall s", "rival CPU s", "ratio"), rows)
    if not quick:
        wall = points**2 * times["ours"].wall[0]
        print_goals([Goal("map of 300 x 300", 60.0, wall, "s", at_least=False)])


if __name__ == "__main__":
    main()
