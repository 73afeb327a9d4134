"""What helical gears cost: loaded contact over path and face, whole runs with their files.

The rival of the solver is SciPy's non-negative least squares on the same contact with the local
compression linear in the load, which both must solve alike.
"""

from __future__ import annotations

import math
import os
from collections.abc import Sequence
from dataclasses import replace
from tempfile import TemporaryDirectory
from typing import Any

# Everyone's linear algebra keeps to one core; NumPy reads this when it is loaded.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.setdefault("MKL_NUM_THREADS", "1")

import numpy as np
from scipy.optimize import nnls

import tribodyn as td
from race import Goal, arguments, machine, print_goals, print_table, race
from tribodyn.gear import CylindricalPair, Material, cylindrical_pair
from tribodyn.stiffness import ContactProblem, loaded_contact
from tribodyn.stiffness.loaded import contact_problem

__all__ = ["least_squares", "linear_problem", "main", "pair"]

_STEEL = Material()
_TORQUE = 600.0
#: Goals: processor times [s] of the loaded contact, of a whole run and of that of a two-stage
#: reducer with two load cases, compliances kept.
_LOADED, _RUN, _REDUCER = 0.3, 3.0, 8.0


def pair() -> CylindricalPair:
    """First stage of a gearbox of the FVA: 27/51 teeth, helix angle 21 degrees.

    Returns
    -------
    CylindricalPair
    """
    return cylindrical_pair(
        pinion_teeth=27,
        wheel_teeth=51,
        normal_module=4.5e-3,
        normal_pressure_angle=math.radians(20.0),
        helix_angle=math.radians(21.0),
        center_distance=190e-3,
        pinion_profile_shift_coefficient=0.231415,
        wheel_profile_shift_coefficient=0.231415,
        pinion_face_width=50e-3,
        pinion_bore_diameter=40e-3,
        wheel_bore_diameter=70e-3,
    )


def linear_problem(phases: int, provider: str = "fe3d") -> ContactProblem:
    """Loaded contact whose local compression is linear: that of the mean load.

    Parameters
    ----------
    phases : int
    provider : str

    Returns
    -------
    ContactProblem
    """
    phase = np.arange(phases) / phases
    force = _TORQUE / pair().pinion.base_radius
    problem = contact_problem(
        pair(), provider=provider, phase=phase, total_force=force, material=_STEEL
    )
    parts = problem.compliance
    mean = force / problem.face_widths.sum(axis=1).mean()
    local = parts.local - parts.logarithm * math.log(mean)
    return replace(problem, compliance=replace(parts, local=local, logarithm=0.0))


def least_squares(problem: ContactProblem, force: float) -> np.ndarray:
    """Approach at every phase by SciPy: loads of all touching slices and the approach together.

    Parameters
    ----------
    problem : ContactProblem
        With a local compression that is linear, and no gaps.
    force : float [N]

    Returns
    -------
    array (p,) [m]
    """
    approach = np.empty(len(problem.gaps))
    for p, structure in enumerate(problem.compliance.structure):
        touching = np.flatnonzero(problem.widths[p, 0] > 0.0)
        matrix = structure[np.ix_(touching, touching)].copy()
        matrix[np.diag_indices(touching.size)] += problem.compliance.local[p, touching]
        # C f = delta for slices that carry; the force row has the weight of the compliances.
        scale = float(np.abs(matrix).max())
        width = problem.widths[p, 0, touching]
        rows = np.vstack(
            [
                np.hstack([matrix / scale, -np.ones((touching.size, 1))]),
                np.append(width / width.sum(), 0.0),
            ]
        )
        right = np.append(np.zeros(touching.size), force / width.sum())
        approach[p] = nnls(rows, right)[0][-1] * scale
    return approach


def _against_scipy(quick: bool) -> tuple[float, float]:
    """How many times longer SciPy takes, and the greatest difference of the approaches."""
    problem = linear_problem(4 if quick else 32, "fe2d" if quick else "fe3d")
    force = _TORQUE / pair().pinion.base_radius
    gap = np.abs(problem.at_loads(np.array([force])).approach[0] / least_squares(problem, force))
    count = float(len(problem.gaps))

    def ours() -> float:
        problem.at_loads(np.array([force]))
        return count

    def theirs() -> float:
        least_squares(problem, force)
        return count

    times = race({"compiled": ours, "SciPy nnls": theirs}, 1 if quick else 5)
    print("One phase with 24 slices a pair, CPU ms")
    print_table(("", "median"), [(n, f"{1e3 * own.median:.4g}") for n, own in times.items()])
    return times["compiled"].faster_than(times["SciPy nnls"]), float(np.abs(gap - 1.0).max())


def main(words: Sequence[str] | None = None) -> None:
    """Run the races and print them.

    Parameters
    ----------
    words : sequence of str, optional
        Words of the command line.
    """
    quick = arguments(__doc__, words).quick
    print(f"Helical pair: {machine()}\n")
    ratio, gap = _against_scipy(quick)
    print(f"greatest difference of the approaches {gap:.1e}\n")
    if quick:
        return
    pair_case, reducer = map(td.load_case, ("helical-pair", "two-stage-helical"))

    def contact(provider: str) -> float:
        return float(loaded_contact(pair(), _TORQUE, provider=provider, phases=32).phase.size)

    def run(case: Any, torque: float, **changes: Any) -> float:
        # Each run has another load: teeth and films of the run before are of no use.
        loads[0] += 1e-3
        changes = {key.replace("_", "."): value for key, value in changes.items()}
        result = td.run(case.replace({**changes, "operation.torque": torque * loads[0]}))
        with TemporaryDirectory() as folder:
            result.save(f"{folder}/result")
        return 1.0

    loads = [1.0]
    contacts = race({n: lambda n=n: contact(n) / 32.0 for n in ("fe3d", "fe2d")}, 5)
    runs = race({n: lambda n=n: run(pair_case, 500.0, stiffness_model=n) for n in contacts}, 5)
    runs |= race({"reducer": lambda: run(reducer, 150.0)}, 3)
    rows = [
        (
            name,
            f"{1e3 * contacts[name].median:.3g}" if name in contacts else "",
            f"{own.median:.3g}",
        )
        for name, own in runs.items()
    ]
    print("Compliances kept: 32 phases x 24 slices [CPU ms], whole run with its files [CPU s]")
    print_table(("", "loaded contact", "run"), rows)
    print_goals(
        [
            Goal("loaded contact", _LOADED, contacts["fe3d"].median, "s CPU", at_least=False),
            Goal("whole run", _RUN, runs["fe3d"].median, "s CPU", at_least=False),
            Goal("two-stage reducer", _REDUCER, runs["reducer"].median, "s CPU", at_least=False),
            Goal("compiled over SciPy", 2.0, ratio, "times", at_least=True),
        ]
    )


if __name__ == "__main__":
    main()
