"""What one oil film costs from a cold start: both engines, and plain NumPy.

The contacts are a random set like those of gears. Every contact is solved by everyone in turn,
round after round; its time is the processor time of its quickest round, and the figures are those
of the whole set. The plain rival solves the same discrete equations on the same grid to the same
tolerance, with full matrices from the first step.
"""

from __future__ import annotations

import math
import os
import time
from collections.abc import Callable, Mapping, Sequence
from functools import partial

# The rival's linear algebra keeps to one core like ours; NumPy reads this when it is loaded.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
os.environ.setdefault("MKL_NUM_THREADS", "1")

import numpy as np

from film_contacts import MoesContact, random_contacts, twin
from plain.film_newton import solve_plain
from race import Goal, arguments, machine, print_goals, print_table
from tribodyn.ehl import ThermalModel, solve_line_contact, solve_transient_line_contact
from tribodyn.errors import ComputationError
from tribodyn.lubricant import from_library

__all__ = ["main", "plain_times", "quickest"]

_ENGINES = ("newton", "multigrid")
#: Goals for the median processor time [ms] from a cold start, by engine and nodes.
_GOALS = {
    ("newton", 1025): 10.0,
    ("newton", 4097): 25.0,
    ("multigrid", 1025): 20.0,
    ("multigrid", 4097): 50.0,
}
#: Goals for the median processor time [ms] of a heated contact, by shear model.
_HEATED_GOALS = {
    "newtonian": 40.0,
    "ree-eyring": 40.0,
    "carreau": 100.0,
    "carreau-eyring": 100.0,
    "bair-winer": 100.0,
}
_PLAIN = "plain NumPy"
#: Tolerances that everyone stops at: relative change of the pressure, and of the flux.
_TOLERANCE, _FLUX_TOLERANCE = 1e-4, 1e-3


def quickest(
    runners: Mapping[str, Callable[[MoesContact], object]],
    contacts: Sequence[MoesContact],
    rounds: int,
) -> dict[str, np.ndarray]:
    """Let everyone solve every contact in turn.

    Parameters
    ----------
    runners : mapping of str to callable
    contacts : sequence of MoesContact
    rounds : int
        Rounds that count, after one that does not.

    Returns
    -------
    dict of str to array
        Processor time [s] of the quickest round of each contact.
    """
    best = {name: np.full(len(contacts), np.inf) for name in runners}
    for number in range(rounds + 1):
        for i, contact in enumerate(contacts):
            for name, run in runners.items():
                begin = time.process_time()
                run(contact)
                spent = time.process_time() - begin
                if number > 0:
                    best[name][i] = min(best[name][i], spent)
    return best


def plain_times(
    contacts: Sequence[MoesContact], nodes: int, rounds: int
) -> tuple[dict[str, np.ndarray], int]:
    """Race against plain NumPy on the contacts that it can solve from a cold start.

    Parameters
    ----------
    contacts : sequence of MoesContact
    nodes, rounds : int

    Returns
    -------
    tuple of dict and int
        Times as of :func:`quickest`, and how many contacts the rival could not solve.
    """
    solvable: dict[MoesContact, object] = {}
    for contact in contacts:
        same = twin(contact.solve(nodes))
        try:
            solve_plain(same, tolerance=_TOLERANCE, flux_tolerance=_FLUX_TOLERANCE)
        except (ComputationError, np.linalg.LinAlgError):
            continue
        solvable[contact] = same
    runners: dict[str, Callable[[MoesContact], object]] = {
        "newton": lambda contact: contact.solve(nodes),
        _PLAIN: lambda contact: solve_plain(
            solvable[contact], tolerance=_TOLERANCE, flux_tolerance=_FLUX_TOLERANCE
        ),
    }
    return quickest(runners, list(solvable), rounds), len(contacts) - len(solvable)


def _row(name: str, spent: np.ndarray, *more: str) -> tuple[str, ...]:
    parts = (np.median(spent), *np.percentile(spent, [90, 99]), spent.max())
    return (name, *(f"{1e3 * part:.3g}" for part in parts), *more)


def _random_set(count: int, nodes: Sequence[int], rounds: int) -> dict[tuple[str, int], np.ndarray]:
    contacts, found = random_contacts(count), {}
    for number in nodes:
        runners = {
            name: (lambda contact, name=name, number=number: contact.solve(number, name))
            for name in _ENGINES
        }
        for name, spent in quickest(runners, contacts, rounds).items():
            found[name, number] = spent
    print(f"Random set of {count} contacts, cold start, CPU ms")
    rows = [_row(f"{name}, {number} nodes", spent) for (name, number), spent in found.items()]
    print_table(("", "median", "p90", "p99", "most"), rows)
    return found


def _growth(count: int, rounds: int) -> dict[str, float]:
    """Exponent of the median time over the number of nodes from 1025 to 16385."""
    contacts, rows, exponents = random_contacts(count, seed=11), [], {}
    for name in _ENGINES:
        runners = {
            str(nodes): (lambda contact, name=name, nodes=nodes: contact.solve(nodes, name))
            for nodes in (1025, 4097, 16385)
        }
        spent = quickest(runners, contacts, rounds)
        first, middle, last = (float(np.median(times)) for times in spent.values())
        exponents[name] = math.log(last / first) / math.log(16.0)
        row = (f"{1e3 * first:.3g}", f"{1e3 * middle:.3g}", f"{1e3 * last:.3g}")
        rows.append((name, *row, f"{exponents[name]:.2f}"))
    print(f"Growth with the grid, medians over {count} contacts, CPU ms")
    print_table(("", "1025", "4097", "16385", "exponent"), rows)
    return exponents


def _heated(rounds: int) -> dict[str, float]:
    """Processor time [ms] of a heated gear contact, the median over slide-to-roll ratios."""
    oil, spent, ratios = from_library("80W"), {}, (0.0, 0.1, 0.5, 1.0, 1.5)
    contact = partial(solve_line_contact, 147802.0, 8e-3, 3.0722, oil, 2.2e11, nodes=513)
    for name in _HEATED_GOALS:
        contacts = [contact]
        contacts += [
            partial(contact, thermal=ThermalModel(name), sliding_speed=ratio * 3.0722)
            for ratio in ratios
        ]
        times = quickest({name: lambda contact: contact()}, contacts, rounds)[name]
        spent[name] = 1e3 * float(np.median(times[1:]))
        print(
            f"Heated film, 513 nodes, {name}, CPU ms at SR {ratios}: {(1e3 * times[1:]).round(1)}"
        )
        print(f"  over the film at one temperature: {(times[1:] / times[0]).round(1)}")
    return spent


def _heated_over_time(steps: int, rounds: int) -> float:
    """Processor time of a heated film over time over that of the film at one temperature."""
    time, load = np.linspace(0.0, 5e-4, steps + 1), 147802.0
    loads = load * (1.0 + 0.3 * np.sin(2.0 * np.pi * time / time[-1]))
    follow = partial(
        solve_transient_line_contact, time, loads, 8e-3, 3.0722, from_library("80W"), 2.2e11,
        nodes=257, surface_speeds=(3.9939, 2.1505), keep_every=0,
    )  # fmt: skip
    runners = {
        "one temperature": lambda contact: contact(),
        "heated": lambda contact: contact(thermal=ThermalModel("ree-eyring")),
    }
    cold, hot = (1e3 * float(t[0]) / steps for t in quickest(runners, [follow], rounds).values())
    print(f"Film over time, 257 nodes, {steps} steps, CPU ms a step: {cold:.2f}, heated {hot:.2f}")
    return hot / cold


def _against_plain(count: int, nodes: int, rounds: int) -> float:
    """Median ratio of processor times."""
    spent, unsolved = plain_times(random_contacts(count, seed=7), nodes, rounds)
    ratio = spent[_PLAIN] / spent["newton"]
    median = float(np.median(ratio))
    print(f"Against plain NumPy, dense, {nodes} nodes, {len(ratio)} contacts, CPU ms")
    rows = [
        _row("newton", spent["newton"], "1"),
        _row(_PLAIN, spent[_PLAIN], f"{median:.3g}"),
    ]
    print_table(("", "median", "p90", "p99", "most", "ratio, median"), rows)
    print(f"ratios from {ratio.min():.3g} to {ratio.max():.3g}; {unsolved} more contacts that")
    print("the plain solver did not solve from its cold start\n")
    return median


def main(words: Sequence[str] | None = None) -> None:
    """Run the races and print them.

    Parameters
    ----------
    words : sequence of str, optional
        Words of the command line.
    """
    quick = arguments(__doc__, words).quick
    print(f"Speed of the film: {machine()}\n")
    if quick:
        _random_set(2, (257,), 1)
        _against_plain(2, 257, 1)
        _heated(1)
        _heated_over_time(4, 1)
        return
    found = _random_set(100, (1025, 4097), 3)
    exponents = _growth(15, 3)
    ratio = _against_plain(12, 1025, 3)
    goals = [
        Goal(f"{name}, {nodes} nodes", goal, 1e3 * float(np.median(found[name, nodes])),
             "ms CPU", at_least=False)
        for (name, nodes), goal in _GOALS.items()
    ]  # fmt: skip
    goals += [
        Goal(f"{name}, growth", 1.05, exponent, "exponent", at_least=False)
        for name, exponent in exponents.items()
    ]
    goals.append(Goal("newton over plain NumPy", 100.0, ratio, "times", at_least=True))
    goals += [
        Goal(f"heated film, {name}", _HEATED_GOALS[name], spent, "ms CPU", at_least=False)
        for name, spent in _heated(3).items()
    ]
    goals.append(
        Goal("heated film over time", 30.0, _heated_over_time(200, 3), "times", at_least=False)
    )
    print_goals(goals)


if __name__ == "__main__":
    main()
