"""Fair races: every contender once per round, in turn, in one process, by processor time.

A busy machine slows all contenders of a round alike, so that the ratio within a round says more
than any absolute time. Ratios are medians over the rounds.
"""

from __future__ import annotations

import argparse
import os
import platform
import time
from collections.abc import Callable, Mapping, Sequence
from statistics import median

__all__ = ["Goal", "Times", "arguments", "machine", "print_goals", "print_table", "race"]

#: Does some work and returns how much: steps, trajectories, calls.
Runner = Callable[[], float]


class Times:
    """Processor and wall-clock time per unit of work, one value per round.

    Parameters
    ----------
    processor, wall : sequence of float
        In s.
    """

    def __init__(self, processor: Sequence[float], wall: Sequence[float]) -> None:
        self.processor = list(processor)
        self.wall = list(wall)

    @property
    def median(self) -> float:
        """Median processor time per unit [s]."""
        return median(self.processor)

    @property
    def best(self) -> float:
        """Shortest processor time per unit [s]."""
        return min(self.processor)

    def faster_than(self, peer: Times) -> float:
        """How many times less processor time a unit takes than with the peer.

        Parameters
        ----------
        peer : Times
            Of the same race.

        Returns
        -------
        float
        """
        pairs = zip(self.processor, peer.processor, strict=True)
        return median(theirs / ours for ours, theirs in pairs)


def race(runners: Mapping[str, Runner], rounds: int) -> dict[str, Times]:
    """Run all contenders in turn, round after round, after one round that does not count.

    Parameters
    ----------
    runners : mapping of str to Runner
        Contenders by name.
    rounds : int
        Rounds that count.

    Returns
    -------
    dict of str to Times
    """
    processor: dict[str, list[float]] = {name: [] for name in runners}
    wall: dict[str, list[float]] = {name: [] for name in runners}
    for number in range(rounds + 1):
        for name, run in runners.items():
            begin_wall, begin = time.perf_counter(), time.process_time()
            work = run()
            spent, spent_wall = time.process_time() - begin, time.perf_counter() - begin_wall
            if number > 0:
                processor[name].append(spent / work)
                wall[name].append(spent_wall / work)
    return {name: Times(processor[name], wall[name]) for name in runners}


class Goal:
    """A figure that was promised, and what came out.

    Parameters
    ----------
    name : str
    goal, measured : float
    unit : str
    at_least : bool
        Whether more is better.
    """

    def __init__(
        self, name: str, goal: float, measured: float, unit: str, *, at_least: bool
    ) -> None:
        self.row = (
            name,
            f"{'>=' if at_least else '<='} {goal:g} {unit}",
            f"{measured:.4g} {unit}",
            "ok" if (measured >= goal if at_least else measured <= goal) else "missed",
        )


def print_goals(goals: Sequence[Goal]) -> None:
    """Print goals and measured figures side by side.

    Parameters
    ----------
    goals : sequence of Goal
    """
    print_table(("goal", "promised", "measured", ""), [goal.row for goal in goals])


def print_table(head: Sequence[str], rows: Sequence[Sequence[str]]) -> None:
    """Print a table, the first column to the left and the others to the right.

    Parameters
    ----------
    head : sequence of str
    rows : sequence of sequences of str
    """
    widths = [max(len(row[i]) for row in (head, *rows)) for i in range(len(head))]
    for row in (head, ["-" * width for width in widths], *rows):
        cells = [
            cell.ljust(width) if i == 0 else cell.rjust(width)
            for i, (cell, width) in enumerate(zip(row, widths, strict=True))
        ]
        print("  ".join(cells).rstrip())
    print()


def machine() -> str:
    """Describe processor, cores and how busy they are.

    Returns
    -------
    str
    """
    load = f"{os.getloadavg()[0]:.1f}" if hasattr(os, "getloadavg") else "unknown"
    return f"{platform.machine()}, {os.cpu_count()} cores, load {load} (0 is a quiet machine)"


def arguments(description: str | None, words: Sequence[str] | None) -> argparse.Namespace:
    """Read the options that all scripts share.

    Parameters
    ----------
    description : str or None
        For the help text.
    words : sequence of str, optional
        Words of the command line; those of the process by default.

    Returns
    -------
    argparse.Namespace
        With ``quick``.
    """
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument(
        "--quick", action="store_true", help="little work and one round: does it run?"
    )
    return parser.parse_args(words)
