"""Many oil films at once: contacts per second and core, threads, and a study of one gear pair.

The peer of the batch is a loop over single calls that ask for the same: film and film stiffness.
"""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from statistics import median

import numpy as np

from film_contacts import MODULUS, Study, random_si, study
from race import Goal, Runner, arguments, machine, print_goals, print_table, race
from tribodyn.ehl import solve_line_contact, solve_line_contacts
from tribodyn.errors import ModelWarning

__all__ = ["batch", "main", "one_by_one"]


def batch(contacts: Study, nodes: int, threads: int) -> Runner:
    """All contacts in one call.

    Parameters
    ----------
    contacts : Study
    nodes, threads : int

    Returns
    -------
    Runner
        Returns the number of contacts.
    """

    def run() -> float:
        found = solve_line_contacts(
            contacts.load_per_width,
            contacts.equivalent_radius,
            contacts.entrainment_speed,
            contacts.lubricant,
            MODULUS,
            nodes=nodes,
            threads=threads,
        )
        return float(np.size(found.central_film))

    return run


def one_by_one(contacts: Study, nodes: int) -> Runner:
    """All contacts in a loop over single calls.

    Parameters
    ----------
    contacts : Study
    nodes : int

    Returns
    -------
    Runner
        Returns the number of contacts.
    """
    rows = list(
        zip(
            contacts.load_per_width.ravel(),
            contacts.equivalent_radius.ravel(),
            contacts.entrainment_speed.ravel(),
            strict=True,
        )
    )

    def run() -> float:
        for load, radius, speed in rows:
            found = solve_line_contact(
                load, radius, speed, contacts.lubricant, MODULUS, nodes=nodes
            )
            found.film_stiffness(1.0)
        return float(len(rows))

    return run


def main(words: Sequence[str] | None = None) -> None:
    """Run the races and print them.

    Parameters
    ----------
    words : sequence of str, optional
        Words of the command line.
    """
    quick = arguments(__doc__, words).quick
    nodes, rounds = (129, 1) if quick else (513, 5)
    print(f"Many films: {machine()}\n")
    with warnings.catch_warnings():
        # Of the lightest contacts: their film stiffness is negative.
        warnings.simplefilter("ignore", ModelWarning)
        _races(nodes, rounds, quick=quick)


def _races(nodes: int, rounds: int, *, quick: bool) -> None:
    contacts = random_si(4 if quick else 300)
    times = race(
        {
            "batch, 1 thread": batch(contacts, nodes, 1),
            "batch, 2 threads": batch(contacts, nodes, 2),
            "one by one": one_by_one(contacts, nodes),
        },
        rounds,
    )
    single = times["one by one"]
    rows = [
        (
            name,
            f"{1.0 / own.median:.4g}",
            f"{1.0 / own.best:.4g}",
            f"{1.0 / min(own.wall):.4g}",
            f"{own.faster_than(single):.3g}",
        )
        for name, own in times.items()
    ]
    print(f"Random gear contacts, {nodes} nodes")
    head = ("", "contacts/CPU-s", "best", "per s of wall clock", "x one by one")
    print_table(head, rows)
    walls = (times["batch, 1 thread"].wall, times["batch, 2 threads"].wall)
    scaling = median(one / two for one, two in zip(*walls, strict=True))
    pair = study(3 if quick else 30)
    whole = race({"study": batch(pair, nodes, 2)}, 1 if quick else 3)["study"]
    seconds = pair.load_per_width.size * min(whole.wall)
    processor = pair.load_per_width.size * whole.best
    points, positions = pair.load_per_width.shape
    print(f"two threads: {scaling:.3g} times as fast by the wall clock")
    print(
        f"{points} operating points x {positions} positions, {nodes} nodes, 2 threads: "
        f"{seconds:.3g} s by the wall clock, {processor:.3g} s CPU\n"
    )
    if not quick:
        rate = 1.0 / times["batch, 1 thread"].best
        print_goals(
            [
                Goal("batch", 250.0, rate, "contacts/s and core", at_least=True),
                Goal("study", 4.0, seconds, "s of wall clock", at_least=False),
            ]
        )


if __name__ == "__main__":
    main()
