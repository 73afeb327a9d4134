"""What all criteria of a pair, and a spectrum of 20 load cases of a two-stage reducer cost.

Both rate a result that is computed already, as ``result.rating`` does beside its run: safeties by
the standard and by computed loads, root stress by finite elements and criteria over the flank of a
pair; safeties and damage of four gears under all load cases. The rival is the run itself.
"""

from __future__ import annotations

import time
import warnings
from collections.abc import Callable, Sequence
from typing import Any

from race import Goal, arguments, machine, print_goals, print_table
from tribodyn import load_case, run
from tribodyn.errors import ModelWarning
from tribodyn.study.machine.case import MachineCase
from tribodyn.study.rating import case_rating

__all__ = ["main"]

_PAIR = {
    "rating.required_life": "20000 h", "rating.scuffing_load_stage": 12,
    "rating.micropitting_load_stage": 9,
}  # fmt: skip


def _spectrum(count: int) -> Any:
    """Two-stage reducer under load cases of equal shares."""
    case = load_case("two-stage-helical")
    loads = [
        {"name": f"case {i}", "share": 1.0 / count,
         "torque": f"{60 + 6 * i} N*m", "speed": f"{2950 - 60 * i} rpm"}
        for i in range(count)
    ]  # fmt: skip
    data = {**case.data, "load_cases": loads, "rating": {"required_life": "20000 h"}}
    return MachineCase(case.source, **data)


def _seconds(compute: Callable[[], object], rounds: int) -> tuple[float, float]:
    """Least processor time and least wall-clock time of some rounds [s]."""
    times = []
    for _ in range(rounds):
        begin = time.process_time(), time.perf_counter()
        compute()
        times.append((time.process_time() - begin[0], time.perf_counter() - begin[1]))
    return min(cpu for cpu, _ in times), min(wall for _, wall in times)


def main(words: Sequence[str] | None = None) -> None:
    """Print the time of both ratings over that of their runs."""
    quick = arguments(__doc__, words).quick
    print(machine())
    rows, goals = [], []
    cases = (
        ("all criteria of a pair", load_case("fzg-roughness").replace(_PAIR), 0.2),
        ("spectrum of 20 load cases", _spectrum(2 if quick else 20), 5.0),
    )
    for name, case, goal in cases:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", ModelWarning)
            begin = time.process_time()
            result = run(case)
            of_run = time.process_time() - begin
            result.rating.to_dict()

            def rate(of: Any = result) -> object:
                return case_rating(of._rated_meshes(), of._rated_parts()).to_dict()

            cpu, wall = _seconds(rate, 1 if quick else 3)
        rows.append((name, f"{cpu:.3g}", f"{wall:.3g}", f"{of_run / cpu:.3g}"))
        goals.append(Goal(name, goal, wall, "s", at_least=False))
    print_table(("what", "CPU s", "wall s, best", "run over rating"), rows)
    if not quick:
        print_goals(goals)


if __name__ == "__main__":
    main()
