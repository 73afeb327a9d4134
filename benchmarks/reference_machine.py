"""A two-stage machine of 40 coordinates: four gears on shafts, a housing of masses and springs."""

from __future__ import annotations

import numpy as np

from tribodyn.dynamics import Contact, System

__all__ = ["CLOCK", "GEARS", "two_stage_machine"]

#: Frequency of the clock: a turn of the middle shaft, the first mesh at 610 Hz [Hz].
CLOCK = 610.0 / 51.0
#: Coordinates of the gears: base radius times rotation, and shift along the line of action.
GEARS = 8


def _wave(phase: np.ndarray, *parts: tuple[float, float]) -> np.ndarray:
    orders = enumerate(parts, start=1)
    waves = [a * np.cos(2.0 * np.pi * order * phase + shift) for order, (a, shift) in orders]
    return np.asarray(sum(waves))


def two_stage_machine(housing: int = 32) -> System:
    """Two meshes with 51 and 23 cycles; every gear is supported by a mass of the housing.

    Parameters
    ----------
    housing : int
        Masses of the housing.

    Returns
    -------
    System
    """
    radius = np.array([0.05835, 0.11021, 0.07010, 0.10362])
    inertia, mass = np.array([0.0045, 0.052, 0.012, 0.045]), np.array([6.2, 22.0, 9.5, 20.0])
    size = GEARS + housing
    stiffness = np.zeros((size, size))
    generator = np.random.default_rng(2)
    links = [(1 + 2 * i, GEARS + i * housing // 4, k) for i, k in enumerate((3.1, 4.2, 3.6, 5.0))]
    walls = zip(range(GEARS, size - 1), generator.uniform(2.0, 12.0, housing - 1), strict=True)
    links += [(i, i + 1, k) for i, k in walls]
    for first, second, spring in links:
        row = np.zeros(size)
        row[[first, second]] = 1.0, -1.0
        stiffness += 1e8 * spring * np.outer(row, row)
    stiffness[range(GEARS, size), range(GEARS, size)] += 2e7
    masses = np.concatenate(
        (
            np.stack((inertia / radius**2, mass), axis=1).reshape(-1),
            generator.uniform(2, 9, housing),
        )
    )
    twist = np.zeros(size)
    twist[[2, 4]] = 1.0 / radius[1], -1.0 / radius[2]
    stiffness += 1.9e6 * np.outer(twist, twist)
    directions, force, balance = np.zeros((2, size)), np.zeros(size), np.zeros(size)
    directions[0, :4] = directions[1, 4:8] = 1.0, 1.0, -1.0, -1.0
    force[0], balance[6] = 420.0 / radius[0], 1.0
    first = Contact(
        directions[0],
        lambda x: 4.1e8 * (1.0 + _wave(x, (0.12, 0.0), (0.05, 0.6))),
        damping=1900.0,
        error=lambda x: _wave(x, (4e-6, 0.3), (1e-6, 1.1)),
        gap=40e-6,
        events=(),
        cycles=51,
    )
    second = Contact(
        directions[1],
        lambda x: 6.0e8 * (1.0 + _wave(x, (0.18, 0.4), (0.04, -1.0))),
        damping=2600.0,
        error=lambda x: _wave(x, (6e-6, -0.2)),
        gap=60e-6,
        events=(),
        cycles=23,
        offset=0.31,
    )
    damping = 1e-5 * stiffness + 20.0 * np.diag(masses) * (np.arange(size) >= GEARS)
    return System(np.diag(masses), damping, stiffness, force, [first, second], balance=balance)
