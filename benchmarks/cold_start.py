"""What a newcomer waits for: the import, and the first and the second run of the built-in case.

Everything runs in child processes; the first run begins with an empty compiler cache. Processor
time counts the child with its own children. The peers of the import are those that anybody in the
field has waited for.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import median

from race import Goal, arguments, machine, print_goals, print_table

__all__ = ["Spent", "child", "main"]

_PYTHON = "an empty process"
_IMPORTS = {
    _PYTHON: "pass",
    "import tribodyn": "import tribodyn",
    "import numpy": "import numpy",
    "import scipy.integrate": "import scipy.integrate",
    "import numba": "import numba",
}


@dataclass(frozen=True)
class Spent:
    """Time of a child process.

    Parameters
    ----------
    processor, wall : float
        In s.
    """

    processor: float
    wall: float


def child(words: Sequence[str], folder: str, cache: str) -> Spent:
    """Run a command in a child process and measure it.

    Parameters
    ----------
    words : sequence of str
        Arguments of the Python interpreter.
    folder : str
        Folder to run in.
    cache : str
        Folder of the compiler's cache.

    Returns
    -------
    Spent

    Raises
    ------
    subprocess.CalledProcessError
        If the command fails.
    """
    environment = {**os.environ, "NUMBA_CACHE_DIR": cache}
    before, begin = os.times(), time.perf_counter()
    subprocess.run(
        [sys.executable, *words], cwd=folder, env=environment, check=True, capture_output=True
    )
    wall, after = time.perf_counter() - begin, os.times()
    processor = (
        after.children_user + after.children_system - before.children_user - before.children_system
    )
    return Spent(processor, wall)


def _imports(folder: str, rounds: int, *, warm: bool) -> dict[str, list[Spent]]:
    found: dict[str, list[Spent]] = {name: [] for name in _IMPORTS}
    for _ in range(rounds + warm):  # a first one fills the file cache
        for name, code in _IMPORTS.items():
            found[name].append(child(["-c", code], folder, str(Path(folder, "unused"))))
    return {name: spent[warm:] for name, spent in found.items()}


def _print_imports(found: dict[str, list[Spent]]) -> float:
    """Print the imports; returns the shortest processor time of ours."""
    peer = found["import scipy.integrate"]
    rows = []
    for name, spent in found.items():
        ratios = [own.processor / other.processor for own, other in zip(spent, peer, strict=True)]
        processor = [one.processor for one in spent]
        rows.append(
            (name, f"{median(processor):.3f}", f"{min(processor):.3f}", f"{median(ratios):.2f}")
        )
    print_table(("", "CPU s", "best", "over scipy.integrate"), rows)
    return min(one.processor for one in found["import tribodyn"])


def _runs(folder: str, rounds: int) -> tuple[Spent, Spent]:
    """First and second run of the built-in case; the quickest of some rounds."""
    first: list[Spent] = []
    second: list[Spent] = []
    for number in range(rounds):
        cache = str(Path(folder, f"cache{number}"))
        for kind, spent in (("first", first), ("second", second)):
            words = ["-m", "tribodyn.cli", "run", "fzg-roughness", "--out", f"{kind}{number}"]
            spent.append(child(words, folder, cache))
    quickest = [min(spent, key=lambda one: one.wall) for spent in (first, second)]
    return quickest[0], quickest[1]


def main(words: Sequence[str] | None = None) -> None:
    """Measure and print.

    Parameters
    ----------
    words : sequence of str, optional
        Words of the command line.
    """
    quick = arguments(__doc__, words).quick
    print(f"Cold start: {machine()}\n")
    with tempfile.TemporaryDirectory() as folder:
        seconds = _print_imports(_imports(folder, 1 if quick else 7, warm=not quick))
        if quick:
            return
        first, second = _runs(folder, 2)
    rows = [
        (name, f"{spent.processor:.2f}", f"{spent.wall:.2f}")
        for name, spent in (("first run", first), ("second run", second))
    ]
    print_table(("tribodyn run fzg-roughness", "CPU s", "wall s"), rows)
    print_goals(
        [
            Goal("import tribodyn", 0.35, seconds, "s CPU", at_least=False),
            Goal("first run", 20.0, first.wall, "s", at_least=False),
            Goal("second run", 6.0, second.wall, "s", at_least=False),
        ]
    )


if __name__ == "__main__":
    main()
