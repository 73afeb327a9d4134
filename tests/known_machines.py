"""Machines with independently computed figures: two meshes with eight coordinates."""

import numpy as np

from tribodyn.dynamics import Contact, System

#: Frequency of the clock at which the first of the meshes has 610 Hz [Hz].
CLOCK = 610.0 / 51.0
#: Compression mean and rms about the mean [um], force mean, rms, greatest and least [N], per mesh.
PRINTED = (
    (57.69143, 1.481370, 7197.943, 43.7404, 7288.26, 7118.44),
    (79.19575, 2.592679, 11316.481, 70.8326, 11453.20, 11148.50),
)


def wave(phase, *parts):
    """Sum of cosines ``amplitude*cos(2 pi order phase + shift)``."""
    return sum(a * np.cos(2.0 * np.pi * k * phase + shift) for k, a, shift in parts)


def two_mesh_system(*, gaps=(40e-6, 60e-6), **changes) -> System:
    """Four gears on three shafts: base radius times rotation, shift along the line of action."""
    radius = np.array([0.05835, 0.11021, 0.07010, 0.10362])
    inertia, mass = np.array([0.0045, 0.052, 0.012, 0.045]), np.array([6.2, 22.0, 9.5, 20.0])
    support = 1e8 * np.array([3.1, 4.2, 3.6, 5.0])
    pairs = np.stack((inertia / radius**2, mass), axis=1).reshape(-1)
    stiffness = np.diag(np.stack((0.0 * support, support), axis=1).reshape(-1))
    damping = 2.0 * 0.02 * np.sqrt(stiffness * np.diag(pairs))
    twist = np.zeros(8)
    twist[[2, 4]] = 1.0 / radius[1], -1.0 / radius[2]
    force, balance = np.zeros(8), np.zeros(8)
    force[0], balance[6] = 420.0 / radius[0], 1.0
    first = Contact(
        [1, 1, -1, -1, 0, 0, 0, 0],
        lambda x: 4.1e8 * (1.0 + wave(x, (1, 0.12, 0.0), (2, 0.05, 0.6))),
        damping=1900.0,
        error=lambda x: wave(x, (1, 4e-6, 0.3), (2, 1e-6, 1.1)),
        gap=gaps[0],
        cycles=51,
    )
    second = Contact(
        [0, 0, 0, 0, 1, 1, -1, -1],
        lambda x: 6.0e8 * (1.0 + wave(x, (1, 0.18, 0.4), (2, 0.04, -1.0))),
        damping=2600.0,
        error=lambda x: wave(x, (1, 6e-6, -0.2)),
        gap=gaps[1],
        cycles=23,
        offset=0.31,
    )
    return System(
        np.diag(pairs),
        damping + 90.0 * np.outer(twist, twist),
        stiffness + 1.9e6 * np.outer(twist, twist),
        force,
        [first, second],
        balance=balance,
        **changes,
    )
