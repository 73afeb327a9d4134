"""What the contact analysis of a hypoid pair costs, from the design to the loaded mesh cycle.

The rivals take the same surfaces and general root finders: SciPy's ``root`` for the five equations
of each exact contact, continued from the one before, and for the two of each cell on a contact
line, and ``brentq`` for the balance of moments at each phase. Both must find the same.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from scipy.optimize import brentq, root

from race import Goal, arguments, machine, print_goals, print_table, race
from tribodyn.gear import EaseOff, HypoidFlanks, Misalignment, hypoid_blank, hypoid_flanks
from tribodyn.gear.hypoid.conjugate import ContactLines
from tribodyn.gear.hypoid.envelope import envelope, turned
from tribodyn.gear.hypoid.tooth_contact import exact_contact, lightest, start_values
from tribodyn.mesh import HypoidLoadedContact, hypoid_loaded_contact
from tribodyn.mesh.hypoid.cells import carried, lag_under

#: Lines whose cells the rival looks for, of those of a mesh cycle.
_LINES = 3


def design() -> HypoidFlanks:
    """Flanks of 10 x 43 with an ease-off."""
    blank = hypoid_blank(10, 43, 31.7e-3, 336e-3, 47.7e-3, math.radians(46.0), 114.3e-3)
    ease_off = EaseOff(lengthwise_crowning=28e-6, profile_crowning=6e-6, bias=4e-6)
    return hypoid_flanks(blank, ease_off=ease_off)


class Exact:
    """Exact contact at rotations about the calculation point, both ways."""

    def __init__(self, flanks: HypoidFlanks, count: int) -> None:
        self.flanks = flanks.conjugate
        lines = ContactLines(self.flanks)
        rotation = np.linspace(-0.06, 0.06, count)
        ends, _ = lines.ends(rotation)
        station, lag, _ = lightest(lines, rotation, ends, Misalignment())
        self.turn = rotation / self.flanks.axes.ratio
        self.guess = start_values(lines, rotation, station, lag)

    def own(self) -> np.ndarray:
        """Rotation of the wheel by the library."""
        return exact_contact(self.flanks, self.turn, self.guess, Misalignment()).wheel_rotation

    def general(self) -> np.ndarray:
        """The same by a general root finder, one rotation after the other."""
        unit = np.array([1e-3, 1e-2, 1e-3, 1e-2, 1e-3])
        found, start = [], self.guess[0] / unit
        for turn in self.turn:
            start = root(lambda x, turn=turn: self._error(turn, x * unit), start, tol=1e-13).x
            found.append(start[4] * unit[4])
        return np.array(found)

    def _error(self, turn: float, unknown: np.ndarray) -> np.ndarray:
        axes, flanks = self.flanks.axes, self.flanks
        place, facing = (turned(v, axes.axis, turn) for v in flanks.pinion_at(unknown[:2]))
        mate = flanks.wheel.at(unknown[2:4])
        to, normal = (turned(v, np.array([0.0, 0.0, 1.0]), -unknown[4]) for v in mate[:2])
        one = np.cross(normal, [1.0, 0.0, 0.0])
        turns = [(facing - normal) @ each for each in (one, np.cross(normal, one))]
        return np.array([*(place + axes.origin - to) * 1e3, *turns])


def cells(loaded: HypoidLoadedContact, lines: int) -> float:
    """Parameters of the cells of some lines, each by a general root finder; greatest difference."""
    conjugate, touch = loaded.cells.flanks.conjugate, loaded.cells.touch
    across, along = ContactLines(conjugate), []
    for number in np.linspace(5, len(touch.lever) - 5, lines).astype(int):
        start = np.zeros(2)
        for place, rotation in zip(
            touch.places[number], touch.contact.rotation[number], strict=True
        ):
            start = root(_cell, start, (across, rotation, place @ across.along), tol=1e-13).x
            surface = conjugate.wheel.at(start * [1e-3, 1e-2])
            along.append(np.abs(conjugate.wheel.projected(surface)[0] - place).max())
    return max(along)


def _cell(unknown: np.ndarray, lines: ContactLines, rotation: float, station: float) -> np.ndarray:
    flanks = lines.flanks
    surface = flanks.wheel.at(unknown * [1e-3, 1e-2])
    here = flanks.wheel.projected(surface)[0] @ lines.along
    turn = envelope(surface, flanks.axes).rotation
    return np.array([1e3 * (turn - rotation), 1e3 * (here - station)])


def balance(loaded: HypoidLoadedContact) -> np.ndarray:
    """Rotation under load, each phase by itself."""
    found = []
    for phase in range(loaded.phase.size):
        lag = loaded.unloaded_rotation.copy()

        def lacks(turn: float, phase: int = phase, lag: np.ndarray = lag) -> float:
            lag[phase] = turn
            return carried(loaded.cells, loaded.springs, lag)[1][phase] - loaded.wheel_torque

        found.append(brentq(lacks, 0.0, 1e-2, xtol=1e-18, rtol=1e-14))
    return np.array(found)


def main(words: Sequence[str] | None = None) -> None:
    """Print the times and their ratios."""
    quick = arguments(__doc__, words).quick
    rounds, steps = (1, 16) if quick else (5, 100)
    print(machine())
    flanks = design()
    exact, loaded = Exact(flanks, 5 if quick else 100), hypoid_loaded_contact(flanks, 500.0)
    if quick:
        loaded = hypoid_loaded_contact(flanks, 500.0, steps=steps, cells=8)
    number = 1 if quick else _LINES

    def work(call: object, amount: float = 1.0) -> object:
        return lambda: (call(), amount)[1]

    times = race(
        {
            "design to loaded contact": work(
                lambda: hypoid_loaded_contact(design(), 500.0, steps=steps)
            ),
            "general lines": work(lambda: cells(loaded, number), number / len(loaded.cells.row)),
            "exact contact": work(exact.own),
            "general exact contact": work(exact.general),
            "balance": work(lambda: lag_under(loaded.cells, loaded.springs, loaded.wheel_torque)),
            "general balance": work(lambda: balance(loaded)),
        },
        rounds,
    )
    pairs = (
        ("design to loaded contact", "general lines"),
        ("exact contact", "general exact contact"),
        ("balance", "general balance"),
    )
    rows = [
        (own, f"{times[own].median:.3g}", rival, f"{times[rival].median:.3g}",
         f"{times[own].faster_than(times[rival]):.3g}")
        for own, rival in pairs
    ]  # fmt: skip
    print_table((f"{steps} phases", "CPU s", "rival", "CPU s", "x rival"), rows)
    if not quick:
        name = "design to loaded contact, 100 positions, one core"
        print_goals([Goal(name, 3.0, times[pairs[0][0]].median, "s", at_least=False)])


if __name__ == "__main__":
    main()
