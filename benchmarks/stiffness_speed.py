"""What the static studies of a gear pair cost: loaded contact, its compliances, the best relief.

The compiled solver races the plain one, which it must equal; compliances race the mesh stiffness
of ROSS, the energy method on a standard pair without profile shift, where ROSS is installed.
"""

from __future__ import annotations

import math
import os
import sys
import warnings
from collections.abc import Callable, Sequence
from pathlib import Path

# Everyone's linear algebra keeps to one core; NumPy reads this when it is loaded.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.setdefault("MKL_NUM_THREADS", "1")
# The plain solver stands beside the tests that compare the compiled one with it.
sys.path.append(str(Path(__file__).resolve().parents[1] / "tests"))

import numpy as np

from plain.loaded_contact import plain_approach
from race import Goal, Runner, Times, arguments, machine, print_goals, print_table, race
from tribodyn.errors import ModelWarning
from tribodyn.gear import Material, SpurPair, spur_pair
from tribodyn.stiffness import MODELS, ContactProblem, loaded_contact, optimize_tip_relief
from tribodyn.stiffness.loaded import contact_problem

__all__ = ["compiled", "main", "plain", "ross_mesh", "studies"]

_STEEL = Material()
#: Goals: processor times [s] of 64 phases x 20 torques, of analytic and of kept compliances.
_LOADED, _ANALYTIC, _KEPT = 0.3, 0.05, 0.1


def fzg() -> SpurPair:
    """FZG type A with bores of 30 mm.

    Returns
    -------
    SpurPair
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)
        return spur_pair(
            pinion_teeth=16,
            wheel_teeth=24,
            normal_module=4.5e-3,
            normal_pressure_angle=math.radians(20.0),
            center_distance=91.5e-3,
            pinion_face_width=20e-3,
            pinion_profile_shift_coefficient=0.8635,
            wheel_profile_shift_coefficient=-0.5103,
            pinion_bore_diameter=30e-3,
            wheel_bore_diameter=30e-3,
        )


def standard_pair() -> SpurPair:
    """A pair that ROSS can describe: 62/62 teeth, module 2 mm, no profile shift.

    Returns
    -------
    SpurPair
    """
    return spur_pair(
        pinion_teeth=62,
        wheel_teeth=62,
        normal_module=2e-3,
        normal_pressure_angle=math.radians(20.0),
        pinion_face_width=20e-3,
        pinion_bore_diameter=35e-3,
        wheel_bore_diameter=35e-3,
    )


def problem(pair: SpurPair, phases: int) -> ContactProblem:
    """Loaded tooth contact of a pair, ready to be solved.

    Parameters
    ----------
    pair : SpurPair
    phases : int

    Returns
    -------
    ContactProblem
    """
    return contact_problem(
        pair, provider="analytic", phase=np.arange(phases) / phases, total_force=1.0,
        material=_STEEL,
    )  # fmt: skip


def compiled(mesh: ContactProblem, totals: np.ndarray) -> np.ndarray:
    """Approaches (t, p) [m] by the compiled solver.

    Parameters
    ----------
    mesh : ContactProblem
    totals : array (t,) [N]

    Returns
    -------
    array (t, p)
    """
    return mesh.at_loads(totals).approach


def plain(mesh: ContactProblem, totals: np.ndarray) -> np.ndarray:
    """Approaches (t, p) [m] by the plain solver.

    Parameters
    ----------
    mesh : ContactProblem
    totals : array (t,) [N]

    Returns
    -------
    array (t, p)
    """
    parts = mesh.compliance
    return np.array(
        [
            [
                plain_approach(
                    parts.structure[p], parts.local[p], parts.logarithm, mesh.gaps[p],
                    mesh.widths[0, :, 0], float(total),
                )
                for p in range(mesh.gaps.shape[0])
            ]
            for total in totals
        ]
    )  # fmt: skip


def studies(pair: SpurPair, phases: int, torques: int) -> dict[str, Runner]:
    """What a user calls.

    Parameters
    ----------
    pair : SpurPair
    phases, torques : int

    Returns
    -------
    dict of str to Runner
    """
    load = np.linspace(20.0, 300.0, torques)

    def influences(name: str) -> float:
        for gear in (pair.pinion, pair.wheel):
            MODELS[name].influence(gear, _STEEL, reference="bore")
        return 1.0

    def contact(name: str) -> float:
        return float(loaded_contact(pair, load, provider=name, phases=phases).phase.size > 0)

    def relief(name: str) -> float:
        coarse = {"phases": phases} if phases < 64 else {}
        found = optimize_tip_relief(pair, (60.0, 120.0), provider=name, **coarse)
        return float(found.objective < found.objective_before)

    return {
        "compliances, analytic": lambda: influences("analytic"),
        "compliances, fe2d, kept": lambda: influences("fe2d"),
        f"{phases} phases x {torques} torques, analytic": lambda: contact("analytic"),
        f"{phases} phases x {torques} torques, fe2d, kept": lambda: contact("fe2d"),
        "best tip relief, fe2d, kept": lambda: relief("fe2d"),
    }


def ross_mesh() -> Callable[[int], np.ndarray] | None:
    """Mesh stiffness of the standard pair by ROSS over a number of phases.

    Returns
    -------
    callable or None
        None where ROSS is not installed.
    """
    try:
        from ross.gear_element import GearElementTVMS, Mesh
        from ross.materials import steel
    except (ImportError, ValueError):  # the latter where its figures do not suit Plotly
        return None
    given = {
        "material": steel, "width": 20e-3, "bore_diameter": 35e-3, "module": 2e-3,
        "n_teeth": 62, "pr_angle": math.radians(20.0),
    }  # fmt: skip
    mesh = Mesh(GearElementTVMS(n=0, **given), GearElementTVMS(n=1, **given))
    return lambda phases: np.array(mesh.get_stiffness_for_mesh_period(1, phases)[1])


def _against_plain(quick: bool) -> float:
    """How many times longer the plain solver takes for the same approaches."""
    mesh = problem(fzg(), 4 if quick else 16)
    totals = np.linspace(1000.0, 8000.0, 2 if quick else 4)
    gap = float(np.abs(compiled(mesh, totals) / plain(mesh, totals) - 1.0).max())
    points, times_over = float(totals.size * mesh.gaps.shape[0]), 20

    def ours() -> float:
        for _ in range(times_over):
            compiled(mesh, totals)
        return points * times_over

    def theirs() -> float:
        plain(mesh, totals)
        return points

    times = race({"compiled": ours, "plain": theirs}, 1 if quick else 3)
    rows = [(name, f"{1e6 * own.median:.4g}") for name, own in times.items()]
    print("One phase under one torque, CPU us")
    print_table(("", "median"), rows)
    print(f"greatest difference of the approaches {gap:.1e}\n")
    return times["compiled"].faster_than(times["plain"])


def _against_ross(phases: int, rounds: int) -> None:
    theirs, pair = ross_mesh(), standard_pair()
    if theirs is None:
        print('ROSS: not installed (pip install ross-rotordynamics "plotly<6")\n')
        return

    def ours(name: str) -> float:
        return float(loaded_contact(pair, 100.0, provider=name, phases=phases).phase.size > 0)

    times = race(
        {
            "ROSS": lambda: float(theirs(phases).size > 0),
            "analytic": lambda: ours("analytic"),
            "fe2d, kept": lambda: ours("fe2d"),
        },
        rounds,
    )
    _print_ross(times, theirs(phases), pair, phases)


def _print_ross(times: dict[str, Times], theirs: np.ndarray, pair: SpurPair, phases: int) -> None:
    means = {"ROSS": float(theirs.mean())}
    for name in ("analytic", "fe2d"):
        mesh = loaded_contact(pair, 100.0, provider=name, phases=phases)
        means["fe2d, kept" if name == "fe2d" else name] = float(mesh.mesh_stiffness_secant.mean())
    rows = [
        (
            name, f"{1e3 * own.median:.3g}", f"{own.faster_than(times['ROSS']):.3g}",
            f"{1e-6 * means[name]:.4g}", f"{100 * (means[name] / means['fe2d, kept'] - 1):+.1f}",
        )
        for name, own in times.items()
    ]  # fmt: skip
    print(f"62/62 teeth, {phases} phases, from the gears to the mesh stiffness")
    print_table(("", "CPU ms", "x ROSS", "mean stiffness N/um", "to fe2d %"), rows)


def main(words: Sequence[str] | None = None) -> None:
    """Run the races and print them.

    Parameters
    ----------
    words : sequence of str, optional
        Words of the command line.
    """
    quick = arguments(__doc__, words).quick
    phases, torques, rounds = (16, 3, 1) if quick else (64, 20, 5)
    print(f"Static studies: {machine()}\n")
    times = race(studies(fzg(), phases, torques), rounds)
    rows = [
        (name, f"{1e3 * own.median:.3g}", f"{1e3 * own.best:.3g}") for name, own in times.items()
    ]
    print("FZG type A, CPU ms")
    print_table(("", "median", "best"), rows)
    ratio = _against_plain(quick)
    _against_ross(phases, rounds)
    if quick:
        return
    analytic, kept, _, loaded, relief = (own.median for own in times.values())
    print_goals(
        [
            Goal("loaded contact, 64 x 20", _LOADED, loaded, "s CPU", at_least=False),
            Goal("compliances, analytic", _ANALYTIC, analytic, "s CPU", at_least=False),
            Goal("compliances, fe2d, kept", _KEPT, kept, "s CPU", at_least=False),
            Goal("compiled over plain", 100.0, ratio, "times", at_least=True),
            Goal("best tip relief", 10.0, relief, "s CPU", at_least=False),
        ]
    )


if __name__ == "__main__":
    main()
