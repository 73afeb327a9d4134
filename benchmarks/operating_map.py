"""An operating map over speed and torque, against single runs of the same points.

Both give every figure of the summary at every point; what points share is at hand for both. So the
ratio tells what the map costs beyond its points, and its wall clock how many cores it uses.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

import tribodyn as td
from race import arguments, machine, print_table, race

__all__ = ["main"]

_CASE, _SPEEDS, _TORQUES = "fzg-roughness", (42.0, 366.0), (50.0, 300.0)


def main(words: Sequence[str] | None = None) -> None:
    """Run the race and print it.

    Parameters
    ----------
    words : sequence of str, optional
        Words of the command line.
    """
    quick = arguments(__doc__, words).quick
    side, rounds = (3, 1) if quick else (10, 5)
    speeds, torques = (np.linspace(*ends, side) for ends in (_SPEEDS, _TORQUES))
    case = td.load_case(_CASE)

    def whole() -> float:
        over = {"operation.speed": speeds, "operation.torque": torques}
        return float(len(td.sweep(case, over).points))

    def single() -> float:
        points = [(speed, torque) for speed in speeds for torque in torques][:: side + 1]
        for speed, torque in points:
            changes = {"operation.speed": float(speed), "operation.torque": float(torque)}
            td.run(case.replace(changes)).summary()
        return float(len(points))

    times = race({"map": whole, "single": single}, rounds)
    print(machine())
    rows = [
        (name, f"{1e3 * each.median:.3g}", f"{1e3 * min(each.wall):.3g}")
        for name, each in times.items()
    ]
    print_table(("", "processor ms a point", "wall ms a point"), rows)
    print(f"a point of the map takes 1/{times['map'].faster_than(times['single']):.3g} of a run")


if __name__ == "__main__":
    main()
