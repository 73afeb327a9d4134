"""Flanks that open over two phases: a solution, and a march that starts on it."""

from __future__ import annotations

from math import pi

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from tribodyn.dynamics import Contact, System, harmonic_balance
from tribodyn.dynamics.harmonic import residual
from tribodyn.dynamics.harmonic.phase_balance import _products_in_vain
from tribodyn.dynamics.harmonic.phase_grid import Follower, first_sizes

MASS = np.array([1.0124, 1.4138, 1.4208, 2.8117, 0.21168, 0.52338, 5.8178, 8.1268])
FREQUENCIES = np.array([2244.0, 770.31])
ROWS = np.kron(np.eye(2), [[1.0, 1.0, -1.0, -1.0]])
SPRING, DAMPER = np.array([2.7610688e8, 4.2185189e8]), np.array([1172.6, 939.6])
GAP, OFFSET = np.array([3.45915e-5, 3.801057e-5]), np.array([0.5657087, 0.1652272])
#: Amplitudes and angles of three orders of the stiffness, and of two of the error.
STIFF = np.array([
    [[0.14883, 0.91898], [0.019587, 1.5518], [0.030341, -0.041929]],
    [[0.123398, 2.3461], [0.024886, 2.44748], [0.028793, 0.37588]],
])  # fmt: skip
ERROR = np.array([
    [[2.67953e-6, 2.17643], [5.7961e-7, 1.82137]],
    [[3.89371e-6, -1.90266], [1.6549e-6, -1.35233]],
])  # fmt: skip


def matrices():
    """Damping and stiffness of the supports and of the shaft between the meshes."""
    stiffness = np.diag([0.0, 2.907e8, 0.0, 2.3621e8, 0.0, 1.6085e8, 0.0, 3.1278e8])
    damping = np.diag([0.0, 1526.8, 0.0, 1940.9, 0.0, 691.04, 0.0, 3797.1])
    twist = np.zeros(8)
    twist[2], twist[4] = 1.0, -2.43717
    return damping + 114.464 * np.outer(twist, twist), stiffness + 1.573534e8 * np.outer(
        twist, twist
    )


def load():
    """Forces on the first and last gear, in balance through the shaft."""
    force = np.zeros(8)
    force[0], force[6] = 224.08, -224.08 * 2.43717
    return force


def series(terms, x, order=0):
    """Sum of cosines, or its derivative by the phase."""
    n = np.arange(1, len(terms) + 1) * 2 * pi
    angles = np.multiply.outer(x, n) + terms[:, 1]
    return np.cos(angles) @ terms[:, 0] if not order else -np.sin(angles) @ (terms[:, 0] * n)


def pressed(share=1.0):
    """System under a share of its load."""
    contacts = [
        Contact(
            ROWS[m], lambda x, m=m: SPRING[m] * (1 + series(STIFF[m], x)), DAMPER[m],
            lambda x, m=m: series(ERROR[m], x), GAP[m],
            cycles=(1 - m, m), offset=OFFSET[m],
        )
        for m in range(2)
    ]  # fmt: skip
    return System(np.diag(MASS), *matrices(), share * load(), contacts)


@pytest.fixture(scope="module")
def system():
    return pressed()


def slope(t, state):
    """Equations of motion, written apart."""
    damping, stiffness = matrices()
    q, v = np.split(state, 2)
    force = load() - stiffness @ q - damping @ v
    for m, row in enumerate(ROWS):
        x = FREQUENCIES[m] * t + OFFSET[m]
        distance = row @ q - series(ERROR[m], x)
        speed = row @ v - FREQUENCIES[m] * series(ERROR[m], x, 1)
        beyond = np.sign(distance) * max(abs(distance) - GAP[m], 0.0)
        if beyond:
            k = SPRING[m] * (1 + series(STIFF[m], x))
            force = force - row * (k * beyond + DAMPER[m] * speed)
    return np.concatenate((v, force / MASS))


@pytest.fixture(scope="module")
def motion(system):
    return harmonic_balance(system, FREQUENCIES)


@pytest.mark.filterwarnings("ignore:.*unstable-orbit")
def test_a_motion_with_open_flanks_is_found(motion):
    """Newton's method alone finds none from the linear motion; damping is taken away in steps."""
    assert motion.converged
    assert np.mean(motion.fine.contact_force[:, 0] == 0.0) > 0.3
    assert motion.step_error < 1e-2


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore:.*unstable-orbit")
def test_a_march_that_starts_on_a_motion_with_open_flanks_stays_on_it(motion):
    times = np.linspace(0.0, 10.0 / FREQUENCIES[0], 101)
    at = motion.at(times)
    start = np.concatenate((at.position[0], at.velocity[0]))
    marched = solve_ivp(
        slope, (0.0, times[-1]), start, "DOP853", times, rtol=1e-9, atol=1e-14, max_step=3e-5
    ).y.T
    compression, expected = at.position @ ROWS.T, marched[:, :8] @ ROWS.T
    error = np.abs(compression - expected).max() / np.linalg.norm(expected, axis=1).max()
    assert error < 2.0 * motion.step_error


@pytest.mark.filterwarnings("ignore:.*steady-state")
def test_a_search_without_a_motion_ends_after_a_bounded_number_of_products(monkeypatch):
    """Flanks that rattle have no motion over phases; what the search spends is counted."""
    spent, linear = [], residual.solve_linear

    def counted(*arguments):
        solution, count = linear(*arguments)
        spent.append(count)
        return solution, count

    monkeypatch.setattr(residual, "solve_linear", counted)
    motion = harmonic_balance(pressed(0.5), FREQUENCIES)
    assert not motion.converged
    assert np.all(np.mean(motion.fine.contact_force == 0.0, axis=0) > 0.3)
    assert 200 < sum(spent) < 800
    followers = [Follower(1, each.cycles) for each in motion._rows.system.contacts]
    assert sum(spent) <= _products_in_vain(sum(first_sizes(followers, 0)))
