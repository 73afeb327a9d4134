"""How many steps a second of processor time brings: our kernel against other solvers.

A step is four evaluations of the right-hand side, whatever scheme makes use of them. What the steps
are worth is the other question: see equal_accuracy.py.
"""

from __future__ import annotations

from collections.abc import Sequence

from marchers import kernel, multiplications, peak
from peers import Solver, numbalsoda_problem, peers
from race import Goal, Runner, Times, arguments, machine, print_goals, print_table, race
from reference_pair import D2, WITH_BACKLASH, Pair

__all__ = ["main"]

#: Lanes, and mesh cycles that make about equal work.
_LANES = {1: 40, 16: 20, 256: 4, 4096: 1}
#: The largest ensemble, in which speed is promised.
_MANY = max(_LANES)
_SUMMED = f"tribodyn, {_MANY} lanes, statistics"
_APART = f"tribodyn, {_MANY} lanes, teeth separating"
_PEAK = "fused multiply-adds alone"
_PEERS = ("SciPy RK45, NumPy", "SciPy RK45, Numba", "numbalsoda LSODA", "numbalsoda DOP853")


def _peer_runner(solver: Solver, pair: Pair) -> Runner:
    """One mesh cycle at a tolerance of 1e-6, as steps of four evaluations."""
    return lambda: solver(pair, 1, 1e-6)[1] / 4.0


def _contenders(pair: Pair, lanes: dict[int, int], *, quick: bool) -> dict[str, Runner]:
    found: dict[str, Runner] = {
        f"tribodyn, {count} lane{'s' if count > 1 else ''}": kernel(
            pair, count, 1 if quick else cycles, settle=0 if quick else 20
        )
        for count, cycles in lanes.items()
    }
    if not quick:
        found[f"tribodyn, {_MANY} lanes, 2 threads"] = kernel(pair, _MANY, 2, threads=2, settle=20)
        found[_SUMMED] = kernel(pair, _MANY, 1, settle=20, statistics=True)
        found[_APART] = kernel(WITH_BACKLASH, _MANY, 1, settle=20)
        found[_PEAK] = peak()
    available = peers()
    found.update(
        {name: _peer_runner(available[name], pair) for name in _PEERS if name in available}
    )
    return found


def _rows(times: dict[str, Times]) -> list[tuple[str, ...]]:
    rivals = [times[name] for name in _PEERS if name in times]
    return [
        (
            name,
            f"{1e-6 / own.median:.3g}",
            f"{1e-6 / own.best:.3g}",
            f"{1e9 * own.best:.4g}",
            *(f"{own.faster_than(rival):.3g}" for rival in rivals),
        )
        for name, own in times.items()
        if name != _PEAK
    ]


def _print(title: str, times: dict[str, Times]) -> None:
    print(title)
    head = ("", "M steps/CPU-s", "best", "best ns/step")
    shorter = tuple(f"x {name.replace('numbalsoda', 'nbs')}" for name in _PEERS if name in times)
    print_table((*head, *shorter), _rows(times))
    parallel = times.get(f"tribodyn, {_MANY} lanes, 2 threads")
    if parallel:
        print(f"two threads: {1e-6 / min(parallel.wall):.3g} M steps per second of wall clock\n")


def main(words: Sequence[str] | None = None) -> None:
    """Run the races and print them.

    Parameters
    ----------
    words : sequence of str, optional
        Words of the command line.
    """
    quick = arguments(__doc__, words).quick
    lanes = {1: 1} if quick else _LANES
    rounds = 1 if quick else 9
    print(f"Ensemble speed: {machine()}")
    if problem := numbalsoda_problem():
        print(problem)
    print()
    times = race(_contenders(D2, lanes, quick=quick), rounds)
    _print("Reference pair D2, linear mesh", times)
    with_gap = race(_contenders(WITH_BACKLASH, lanes, quick=quick), rounds)
    _print("Reference pair with backlash, teeth separating in every cycle", with_gap)
    if not quick:
        alone, many = times["tribodyn, 1 lane"].best, times[f"tribodyn, {_MANY} lanes"]
        count = multiplications(D2)
        share = count * times[_PEAK].median / many.median
        print(
            f"a step of the linear mesh multiplies and adds {count} times: "
            f"{100.0 * share:.0f} % of the measured peak of "
            f"{1e-9 / times[_PEAK].median:.3g} G fused multiply-adds per second\n"
        )
        print_goals(
            [
                Goal("single run", 300.0, 1e9 * alone, "ns/step", at_least=False),
                Goal("ensemble", 30.0, 1e-6 / many.best, "M steps/s and core", at_least=True),
                Goal("separations", 0.6, times[_APART].faster_than(many), "times", at_least=True),
                Goal("statistics", 0.75, times[_SUMMED].faster_than(many), "times", at_least=True),
            ]
        )


if __name__ == "__main__":
    main()
