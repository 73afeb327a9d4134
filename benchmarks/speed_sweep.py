"""Steady motions at 500 speeds, up and down, with their stability; and a run-up of 5000 cycles.

The rival of the sweep is the search of every orbit by itself. It is run at every 20th speed of one
direction; its time is that of as many searches.
"""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from race import Goal, arguments, machine, print_goals, print_table, race
from reference_pair import D2, Pair, system
from tribodyn.dynamics import run_up, speed_ramp, speed_sweep, steady_state
from tribodyn.errors import ModelWarning

__all__ = ["main"]

_LOW, _HIGH, _SPEEDS, _PART = 100.0, 6000.0, 500, 20
_CYCLES = 5000
#: The linear pair, and one whose teeth separate near its resonances.
_PAIRS = {"linear": D2, "with backlash": replace(D2, gap=20e-6)}


def _compare(name: str, pair: Pair, quick: bool) -> tuple[tuple[str, ...], list[Goal]]:
    made = system(pair)
    speeds = np.linspace(_LOW, _HIGH, 25 if quick else _SPEEDS)
    found = speed_sweep(made, speeds, teeth=16)

    def sweep() -> float:
        speed_sweep(made, speeds, teeth=16)
        return 1.0

    def one_by_one() -> float:
        chosen = speeds[::_PART]
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", ModelWarning)
            for beat in chosen:
                steady_state(made, float(beat), steps=512)
        return chosen.size / (2.0 * speeds.size)

    times = race({"sweep": sweep, "one by one": one_by_one}, 1 if quick else 5)
    row = (
        name,
        str(2 * speeds.size),
        str(int(np.count_nonzero(found.contact_loss.max(axis=-1)))),
        str(len(found.jumps)),
        f"{times['sweep'].median:.3g}",
        f"{min(times['sweep'].wall):.3g}",
        f"{times['sweep'].faster_than(times['one by one']):.3g}",
    )
    goal = Goal(f"{_SPEEDS} speeds up and down, {name}", 3.0, min(times["sweep"].wall), "s wall",
                at_least=False)  # fmt: skip
    return row, [] if quick else [goal]


def _run_up(quick: bool) -> list[Goal]:
    cycles = 200 if quick else _CYCLES
    made = system(_PAIRS["with backlash"])
    profile = speed_ramp(600.0, 1400.0, cycles / 1000.0)

    def run() -> float:
        run_up(made, profile, teeth=16, steps=512)
        return 1.0

    time = race({"run": run}, 1 if quick else 5)["run"]
    print(f"Run-up, {cycles} mesh cycles of 512 steps: {time.median:.3g} s of processor time\n")
    goal = Goal(f"run-up of {cycles} mesh cycles", 3.0, time.best, "CPU s", at_least=False)
    return [] if quick else [goal]


def main(words: Sequence[str] | None = None) -> None:
    """Run the comparison and print it.

    Parameters
    ----------
    words : sequence of str, optional
        Words of the command line.
    """
    quick = arguments(__doc__, words).quick
    print(f"Speed sweep: {machine()}\n")
    rows, goals = [], []
    for name, pair in _PAIRS.items():
        row, own = _compare(name, pair, quick)
        rows.append(row)
        goals += own
    head = ("", "motions", "contact lost", "jumps", "CPU s", "wall s", "x one by one")
    print_table(head, rows)
    goals += _run_up(quick)
    if goals:
        print_goals(goals)


if __name__ == "__main__":
    main()
