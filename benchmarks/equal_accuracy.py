"""Processor time of one trajectory at equal accuracy: final displacements to 1e-6 after 20 cycles.

Every contender takes the cheapest setting, of steps or of tolerance, that reaches the accuracy on
three trajectories spread over the ensemble. Displacements are those of both gears and the
deflection of the mesh, the error the largest difference over the largest displacement; the truth
comes from two methods that must agree to 1e-8.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from marchers import call, end_displacements, kernel
from peers import Solver, numbalsoda_problem, peers
from race import Goal, Runner, Times, arguments, machine, print_goals, print_table, race
from reference_pair import D2, Pair, elastic, lanes
from reference_solution import displacement_error, reference

__all__ = ["ACCURACY", "Setting", "cheapest", "main"]

Array = NDArray[np.float64]

ACCURACY = 1e-6
_STEPS = (256, 384, 512, 640, 768, 832, 896, 1024, 1280, 1536, 2048, 3072)
_TOLERANCES = (1e-4, 3e-5, 1e-5, 3e-6, 2e-6, 1e-6, 6e-7, 3e-7, 2e-7, 1e-7, 6e-8, 3e-8, 1e-8, 1e-9)
_MARK = "SciPy RK45, NumPy"


@dataclass(frozen=True)
class Setting:
    """Cheapest setting that reaches the accuracy.

    Parameters
    ----------
    value : float
        Steps per mesh cycle, or tolerance.
    error : float
        Largest error of the trajectories.
    """

    value: float
    error: float


def cheapest(
    solve: Callable[[Pair, float], Array],
    ladder: Sequence[float],
    trajectories: Sequence[tuple[Pair, Array]],
) -> Setting:
    """Find the first setting of a ladder that reaches the accuracy on all trajectories.

    Parameters
    ----------
    solve : callable
        Final displacements [m] of a pair at a setting.
    ladder : sequence of float
        Settings from cheap to dear.
    trajectories : sequence of (Pair, (5,) array)
        Pairs and their true final displacements [m].

    Returns
    -------
    Setting

    Raises
    ------
    RuntimeError
        If none does.
    """
    for value in ladder:
        error = max(displacement_error(solve(pair, value), exact) for pair, exact in trajectories)
        if error <= ACCURACY:
            return Setting(value, error)
    raise RuntimeError(f"no setting up to {ladder[-1]:g} reaches {ACCURACY:g}")


def _peer_settings(
    solvers: dict[str, Solver], cycles: int, trajectories: Sequence[tuple[Pair, Array]]
) -> dict[str, Setting]:
    """Settings by name; a NumPy right-hand side needs the tolerance of its compiled twin."""

    def ending(solver: Solver) -> Callable[[Pair, float], Array]:
        return lambda pair, tolerance: elastic(solver(pair, cycles, tolerance)[0])

    found: dict[str, Setting] = {}
    for name, solver in sorted(solvers.items(), key=lambda item: "NumPy" in item[0]):
        twin = name.replace("NumPy", "Numba")
        found[name] = found.get(twin) or cheapest(ending(solver), _TOLERANCES, trajectories)
    return {name: found[name] for name in solvers}


def _per_trajectory(run: Runner, count: int, repeat: int = 1) -> Runner:
    def measured() -> float:
        for _ in range(repeat):
            run()
        return float(count * repeat)

    return measured


def _contenders(
    solvers: dict[str, Solver], settings: dict[str, Setting], steps: int, cycles: int, many: int
) -> dict[str, Runner]:
    ours = {
        f"tribodyn, ensemble of {many}": _per_trajectory(call(D2, many, cycles, steps=steps), many),
        "tribodyn, single": _per_trajectory(kernel(D2, 1, cycles, steps=steps), 1, 10),
        "tribodyn, single, set-up included": _per_trajectory(
            call(D2, 1, cycles, steps=steps), 1, 10
        ),
    }

    def theirs(name: str) -> Runner:
        repeat = 5 if "numbalsoda" in name else 1
        return _per_trajectory(
            lambda: solvers[name](D2, cycles, settings[name].value)[1], 1, repeat
        )

    return {**ours, **{name: theirs(name) for name in solvers}}


def _print(times: dict[str, Times], settings: dict[str, Setting], ours: Setting) -> None:
    rows = []
    for name, own in times.items():
        setting = settings.get(name, ours)
        kind = f"{setting.value:g}" if name in settings else f"{setting.value:g} steps"
        figures = (kind, f"{setting.error:.1e}", f"{1e3 * own.median:.4g}", f"{1e3 * own.best:.4g}")
        rows.append((name, *figures, f"{own.faster_than(times[_MARK]):.4g}"))
    head = ("", "setting", "error", "CPU ms each", "best", f"x {_MARK}")
    print_table(head, rows)


def main(words: Sequence[str] | None = None) -> None:
    """Find the settings, run the race and print it.

    Parameters
    ----------
    words : sequence of str, optional
        Words of the command line.
    """
    quick = arguments(__doc__, words).quick
    cycles, many, rounds = (2, 64, 1) if quick else (20, 4096, 3)
    print(f"Equal accuracy: {machine()}")
    if problem := numbalsoda_problem():
        print(problem)
    own = lanes(D2, many)
    truths = [(pair, *reference(pair, cycles)) for pair in (own[0], own[many // 2], own[-1])]
    print(f"two reference methods agree to {max(gap for *_, gap in truths):.1e}\n")
    trajectories = [(pair, exact) for pair, exact, _ in truths]
    ours = cheapest(
        lambda pair, steps: end_displacements(pair, cycles, int(steps)), _STEPS, trajectories
    )
    solvers = peers()
    settings = _peer_settings(solvers, cycles, trajectories)
    times = race(_contenders(solvers, settings, int(ours.value), cycles, many), rounds)
    _print(times, settings, ours)
    if not quick:
        in_ensemble = times[f"tribodyn, ensemble of {many}"].faster_than(times[_MARK])
        single = times["tribodyn, single"]
        alone = single.faster_than(times[_MARK])
        # The compiled loop of numbalsoda, or where it does not load that of SciPy in Python.
        strongest = next(n for n in ("numbalsoda DOP853", "SciPy DOP853, Numba") if n in times)
        compiled = single.faster_than(times[strongest])
        print_goals(
            [
                Goal("ensemble, SciPy with NumPy", 1000.0, in_ensemble, "times", at_least=True),
                Goal("single run, SciPy with NumPy", 250.0, alone, "times", at_least=True),
                Goal(f"single run, {strongest}", 1.0, compiled, "times", at_least=True),
            ]
        )


if __name__ == "__main__":
    main()
