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
from tribodyn.study.faults.motion import (
    TurningMotion,
    turning_mesh_of,
    turning_motion,
    turning_system_of,
)
from tribodyn.study.pipeline.run import prepare_run

__all__ = ["main"]

#: Goals: CPU time of a healthy and a cracked pair over 48 and 408 mesh cycles [s], of the longer
#: one over its period marched [-], and of a recording [s].
_MOTIONS, _LONG_MOTIONS, _OVER_MARCH, _RECORDING = 1.0, 5.0, 1.0, 0.36
#: Relatively prime numbers of teeth.
_PRIME = {"gears.pinion.teeth": 17, "gears.center_distance": "94 mm", "dynamics.backlash": "0.2 mm"}
_CRACK = {"kind": "crack", "gear": "pinion", "tooth": 3, "depth": "1.5 mm"}
#: An eccentric wheel, so that the period is the hunting period.
_AXIS = {"kind": "eccentricity", "gear": "wheel", "amplitude": "5 um"}


def _case(depth: str, **changed: Any) -> td.Case:
    faults: dict[str, dict[str, Any]] = {"crack": {**_CRACK, "depth": depth}, "axis": _AXIS}
    changes = {f"faults.{n}.{k}": v for n, table in faults.items() for k, v in table.items()}
    case: td.Case = td.load_case("fzg-roughness")
    return case.replace({"stiffness.model": "fe2d", **changes, **changed})


class _Pair:
    """A healthy and a cracked pair, their motions, and one period of the cracked one marched."""

    def __init__(self, **changed: Any) -> None:
        self.prepared = [prepare_run(_case(depth, **changed)) for depth in ("0 mm", "1.5 mm")]
        self.solution = self.motions()[1].response  # compiles, and keeps compliances
        mesh = turning_mesh_of(self.prepared[1].case)
        run = self.prepared[1]
        self.system = turning_system_of(run.case, run.mesh, run.damping, mesh)
        self.frequency = self.prepared[1].mesh.mesh_frequency / mesh.cycles
        self.steps = 128 * mesh.cycles

    def motions(self) -> list[TurningMotion]:
        return [turning_motion(each) for each in self.prepared]

    def timed(self) -> float:
        return float(len(self.motions()))

    def balance(self) -> float:
        response = harmonic_balance(self.system, self.frequency, steps=self.steps)
        return float(response.converged)

    def march(self) -> float:
        start = self.solution.position[0], self.solution.velocity[0]
        simulate(self.system, self.frequency, 1, start, steps=self.steps, method="modal")
        return 1.0


def main(words: Sequence[str] | None = None) -> None:
    """Run the races and print them.

    Parameters
    ----------
    words : sequence of str, optional
        Words of the command line.
    """
    quick = arguments(__doc__, words).quick
    print(f"Faults over 48 and 408 mesh cycles: {machine()}\n")
    with collected():
        pair, prime = _Pair(), _Pair(**_PRIME)
        rounds = 1 if quick else 5
        engines = race({"harmonic balance": pair.balance, "one period marched": pair.march}, rounds)
        both = race({"healthy and cracked": pair.timed}, rounds)
        long = race(
            {
                "harmonic balance, 17 x 24": prime.balance,
                "one period marched, 17 x 24": prime.march,
                "healthy and cracked, 17 x 24": prime.timed,
            },
            1 if quick else 3,
        )
        with tempfile.TemporaryDirectory() as folder:
            repeats = 2 if quick else 100
            begin = time.process_time()
            record_set(
                _case("1 mm"), Path(folder) / "set", {"faults.crack.depth": ["0 mm", "1 mm"]},
                sensor="pinion_y", duration=1.0, repeats=repeats, noise=1.0,
            )  # fmt: skip
            recording = (time.process_time() - begin) / (2 * repeats)
    print("CPU s of one solution")
    times = {**engines, **both, **long}
    medians = {name: own.median for name, own in times.items()}
    ratio = medians["harmonic balance, 17 x 24"] / medians["one period marched, 17 x 24"]
    print_table(("", "median"), [(name, f"{median:.3g}") for name, median in medians.items()])
    print_goals(
        [
            Goal("healthy and cracked", _MOTIONS, medians["healthy and cracked"], "s CPU",
                 at_least=False),
            Goal("the same over 408 mesh cycles", _LONG_MOTIONS,
                 medians["healthy and cracked, 17 x 24"], "s CPU", at_least=False),
            Goal("harmonic balance over one period marched", _OVER_MARCH, ratio, "",
                 at_least=False),
            Goal("a recording of a second", _RECORDING, recording, "s CPU", at_least=False),
        ]
    )  # fmt: skip


if __name__ == "__main__":
    main()
