"""What motions over whole turns and recordings cost, against marching the same turns.

The rival of harmonic balance is the modal march of the package, which integrates the same system
over the same period from the solution, so that it needs no settling: its most favourable case.
"""

from __future__ import annotations

import os
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.setdefault("MKL_NUM_THREADS", "1")

import tribodyn as td
from race import Goal, arguments, machine, print_goals, print_table, race
from tribodyn.dynamics import harmonic_balance, simulate
from tribodyn.errors import collected
from tribodyn.study import record_set
from tribodyn.study.faults.motion import turning_mesh_of, turning_motion, turning_system
from tribodyn.study.pipeline.run import prepare_run

__all__ = ["main"]

#: Goals: CPU time of a healthy and a cracked pair over 48 mesh cycles, and of a recording [s].
_MOTIONS, _RECORDING = 1.0, 0.36
_CRACK = {"kind": "crack", "gear": "pinion", "tooth": 3, "depth": "1.5 mm"}
#: An eccentric wheel, so that the period is the hunting period.
_AXIS = {"kind": "eccentricity", "gear": "wheel", "amplitude": "5 um"}


def _case(depth: str) -> td.Case:
    faults: dict[str, dict[str, Any]] = {"crack": {**_CRACK, "depth": depth}, "axis": _AXIS}
    changes = {f"faults.{n}.{k}": v for n, table in faults.items() for k, v in table.items()}
    case: td.Case = td.load_case("fzg-roughness")
    return case.replace({"stiffness.model": "fe2d", **changes})


def main(words: Sequence[str] | None = None) -> None:
    """Run the races and print them.

    Parameters
    ----------
    words : sequence of str, optional
        Words of the command line.
    """
    quick = arguments(__doc__, words).quick
    print(f"Faults over 48 mesh cycles: {machine()}\n")
    with collected():
        prepared = [prepare_run(_case(depth)) for depth in ("0 mm", "1.5 mm")]
        motions = [turning_motion(each) for each in prepared]  # compiles, and keeps compliances
        mesh = turning_mesh_of(prepared[1].case)
        system = turning_system(prepared[1], mesh)
        frequency, steps = prepared[1].mesh.mesh_frequency / mesh.cycles, 128 * mesh.cycles
        solution = motions[1].response
        start = solution.position[0], solution.velocity[0]

        def balance() -> float:
            return float(harmonic_balance(system, frequency, steps=steps).converged)

        def march() -> float:
            simulate(system, frequency, 1, start, steps=steps, method="modal")
            return 1.0

        def both() -> float:
            for each in prepared:
                turning_motion(each)
            return 1.0

        rounds = 1 if quick else 5
        engines = race({"harmonic balance": balance, "one period marched": march}, rounds)
        pair = race({"healthy and cracked": both}, rounds)
        with tempfile.TemporaryDirectory() as folder:
            repeats = 2 if quick else 100
            begin = time.process_time()
            record_set(
                _case("1 mm"), Path(folder) / "set", {"faults.crack.depth": ["0 mm", "1 mm"]},
                sensor="pinion_y", duration=1.0, repeats=repeats, noise=1.0,
            )  # fmt: skip
            recording = (time.process_time() - begin) / (2 * repeats)
    print("CPU s of one solution")
    times = {**engines, **pair}
    print_table(("", "median"), [(name, f"{own.median:.3g}") for name, own in times.items()])
    print_goals(
        [
            Goal("healthy and cracked", _MOTIONS, pair["healthy and cracked"].median, "s CPU",
                 at_least=False),
            Goal("a recording of a second", _RECORDING, recording, "s CPU", at_least=False),
        ]
    )  # fmt: skip


if __name__ == "__main__":
    main()
