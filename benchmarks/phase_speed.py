"""What does a motion over independent phases cost, and the same one over the common period?

A pair 37/53 with both gears eccentric: over the phases of mesh, pinion and wheel, and over the 1961
mesh cycles after which it repeats. Both give the same contact force, and the memory over phases
does not grow with the teeth. Then two and three meshes in a row, with points by default.
"""

from __future__ import annotations

import tracemalloc
from collections.abc import Sequence

import numpy as np

from race import Goal, arguments, machine, print_goals, print_table, race
from tribodyn.dynamics import Contact, System, harmonic_balance

__all__ = ["main"]

#: Teeth, mesh frequency [Hz], points over mesh, pinion and wheel, steps of a mesh cycle.
_TEETH, _FREQUENCY, _POINTS, _STEPS = (37, 53), 1200.0, (64, 8, 12), 64
#: Ratio of the common period over the phases, and largest difference of the contact forces [-].
_FASTER, _AGREEMENT = 5.0, 1e-5
#: Time of meshes in a row [s], and teeth of pairs whose memory is compared, with its largest ratio.
_ROW, _PAIRS, _FLAT = {2: 0.02, 3: 0.5}, ((37, 53), (137, 253)), 1.1


def _pair(common: bool, teeth: tuple[int, int] = _TEETH) -> tuple[System, object]:
    """A pair and its frequencies, on one clock or over phases."""
    first, second = teeth
    period = first * second
    stiffness = lambda x: 3e8 * (1 + 0.15 * np.cos(2 * np.pi * x))  # noqa: E731
    error = lambda x: 2e-6 * np.cos(2 * np.pi * x + 0.4)  # noqa: E731
    runs_out = [
        lambda x, size=size, angle=angle: size * np.cos(2 * np.pi * x + angle)
        for size, angle in ((3e-6, 0.3), (8e-6, -1.1))
    ]
    direction = [1.0, 1.0, -1.0, -1.0]
    if common:

        def turned(x: np.ndarray) -> np.ndarray:
            shafts = runs_out[0](second * x) + runs_out[1](first * x)
            return np.asarray(error(period * x) + shafts)

        turned.cycles = period  # type: ignore[attr-defined]  # the scale of its derivative
        contact = Contact(direction, lambda x: stiffness(period * x), 800.0, turned, 20e-6)
        frequencies: object = _FREQUENCY / period
    else:
        contact = Contact(
            direction, stiffness, 800.0, error, 20e-6, cycles=(1, 0, 0), turning_error=runs_out,
            turning_cycles=[(0, 1, 0), (0, 0, 1)],
        )  # fmt: skip
        frequencies = (_FREQUENCY, _FREQUENCY / first, _FREQUENCY / second)
    mass, springs = np.diag([1.2, 2.5, 0.8, 1.7]), np.diag([0.0, 2e8, 0.0, 3e8])
    damping = np.diag([20.0, 1500.0, 20.0, 2000.0])
    return System(mass, damping, springs, [3e3, 0.0, -3e3, 0.0], [contact]), frequencies


def _row(count: int) -> tuple[System, object]:
    """Meshes in a row and their frequencies; shafts between them."""
    size, contacts = 2 * count, []
    stiffness, damping = np.zeros((2, size, size))
    for shaft in range(1, size - 1, 2):
        twist = np.zeros(size)
        twist[shaft], twist[shaft + 1] = 1.0, -1.2
        stiffness += 4e7 * np.outer(twist, twist)
        damping += 2e3 * np.outer(twist, twist)
    for number in range(count):
        law = lambda x, angle=number: 3e8 * (1 + 0.15 * np.cos(2 * np.pi * x + angle))  # noqa: E731
        direction, cycles = np.zeros(size), tuple(int(axis == number) for axis in range(count))
        direction[2 * number : 2 * number + 2] = 1.0, -1.0
        error = lambda x: 2e-6 * np.cos(2 * np.pi * x)  # noqa: E731
        contacts.append(Contact(direction, law, 2e3, error, 30e-6, cycles=cycles))
    force = np.zeros(size)
    force[0], force[-1] = 3e3, -3e3 * 1.2 ** (count - 1)
    system = System(np.diag(np.linspace(0.8, 6.0, size)), damping, stiffness, force, contacts)
    return system, 1400.0 * 0.43 ** np.arange(count)


def _memory(teeth: tuple[int, int]) -> float:
    """Most memory of the motion of a pair over phases [byte]."""
    system, frequencies = _pair(common=False, teeth=teeth)
    tracemalloc.start()
    harmonic_balance(system, frequencies, steps=_POINTS)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    return float(peak)


def main(words: Sequence[str] | None = None) -> None:
    """Run the race and print it.

    Parameters
    ----------
    words : sequence of str, optional
        Words of the command line.
    """
    quick = arguments(__doc__, words).quick
    print(f"Motion over independent phases: {machine()}\n")
    (phased, frequencies), (common, clock) = _pair(common=False), _pair(common=True)
    steps = _STEPS * _TEETH[0] * _TEETH[1]
    motions = {}

    def over_phases() -> float:
        motions["phases"] = harmonic_balance(phased, frequencies, steps=_POINTS)
        return 1.0

    def over_period() -> float:
        motions["period"] = harmonic_balance(common, clock, steps=steps)
        return 1.0

    times = race({"three phases": over_phases, "1961 mesh cycles": over_period}, 1 if quick else 5)
    rows = {
        f"{count} meshes": lambda count=count: bool(harmonic_balance(*_row(count)).converged) * 1.0
        for count in _ROW
    }
    times |= race(rows, 1 if quick else 5)
    few, many = map(_memory, _PAIRS)
    force = motions["period"].contact_force
    phases = motions["phases"].at(motions["period"].time).contact_force
    difference = float(np.abs(phases - force).max() / force.max())
    print_table(("", "median CPU s"), [(name, f"{own.median:.3g}") for name, own in times.items()])
    print_goals(
        [
            Goal("phases over the common period", _FASTER,
                 times["three phases"].faster_than(times["1961 mesh cycles"]), "", at_least=True),
            Goal("difference of the contact forces", _AGREEMENT, difference, "", at_least=False),
            Goal("memory of 137/253 over 37/53 teeth", _FLAT, many / few, "", at_least=False),
            *(Goal(f"{count} meshes", most, times[f"{count} meshes"].median, "s", at_least=False)
              for count, most in _ROW.items()),
        ]
    )  # fmt: skip


if __name__ == "__main__":
    main()
