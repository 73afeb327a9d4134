"""Adaptive steps where impacts spread neighbouring motions, and where a contact chatters."""

import numpy as np
import pytest

from known_marches import march_adaptive
from tribodyn.dynamics import Contact, System, solve_adaptive
from tribodyn.dynamics._engine.blocks import march
from tribodyn.dynamics.equations.compiled import compile_for
from tribodyn.errors import ComputationError

GRID, FINER = 64, 1024
START = np.array([0.0, 0.0, 0.05, 0.0])


def two_masses():
    """Two masses that meet each other and two walls, all of which move."""
    contacts = [
        Contact([1.0, -1.0], 1e6, 20.0, gap=1e-4, error=lambda p: 5e-5 * np.cos(4 * np.pi * p)),
        Contact([0.0, 1.0], 2e5, 5.0, gap=lambda p: 2e-4 + 1e-4 * np.cos(2 * np.pi * p)),
        Contact([1.0, 0.0], 3e5, 5.0, gap=2e-4),
    ]
    return System(
        np.eye(2),
        np.diag([0.5, 0.5]),
        1e4 * np.array([[1.0, -1.0], [-1.0, 1.0]]),
        lambda p: np.stack([20.0 * np.sin(2 * np.pi * p), 0.0 * p], axis=1),
        contacts,
    )


@pytest.mark.parametrize(("frequency", "cycles"), [(30.0, 4), (25.0, 4)])
def test_impacts_that_spread_differences_stay_within_the_tolerance(frequency, cycles):
    system, period = two_masses(), np.array([1.0 / frequency])
    fine = compile_for(system, frequency, GRID * FINER)
    exact = np.empty((cycles * GRID * FINER + 1, 4, 1))
    march(fine, period, START[None], cycles, record=exact)
    exact = exact[::FINER, :, 0]
    size = np.abs(exact).max(axis=0)
    # A difference at the start grows many times over: this is what makes the case hard.
    moved = START + 1e-9 * size * np.array([0.0, 0.0, 1.0, 0.0])
    other = march(fine, period, moved[None], cycles)[0]
    assert (np.abs(other - exact[-1]) / size).max() > 20e-9
    compiled = compile_for(system, frequency, 2048)
    assert compiled.grid.steps % GRID == 0
    part = compiled.grid.steps // GRID
    record = np.empty((cycles * 2048 + 1, 4, 1))
    for rtol in (1e-4, 1e-6, 1e-8):
        march_adaptive(compiled, period, START[None], cycles, rtol=rtol, record=record)
        error = (np.abs(record[::part, :, 0] - exact) / size).max()
        assert error < 2.0 * rtol


def _rattling(stiffness, gap):
    return System([[1.0]], [[0.0]], [[0.0]], [0.0], [Contact([1.0], stiffness, gap=gap)])


def test_hundreds_of_impacts_in_one_step_of_free_flight():
    """A ball between two hard flanks, in closed form: flight and half a swing in turn."""
    stiffness, gap, speed = 1e8, 1e-3, 1.0
    motion = solve_adaptive(_rattling(stiffness, gap), 1.0, 1, ([0.0], [speed]), rtol=1e-8)
    half = 2.0 * gap / speed + np.pi / np.sqrt(stiffness)
    flights = np.floor((1.0 + gap / speed) / half)
    assert flights > 400
    assert abs(motion.crossings - 2.0 * flights) <= 2.0
    landing = 1.0 + gap / speed - half * flights
    assert gap < landing * speed < 2.0 * gap
    side = 1.0 if flights % 2 == 0 else -1.0
    assert motion.state[-1, 0] == pytest.approx(side * (speed * landing - gap), abs=1e-8)


def test_a_contact_that_chatters_is_reported():
    with pytest.raises(ComputationError) as caught:
        solve_adaptive(_rattling(1e22, 1e-9), 1.0, 6, ([0.0], [1.0]))
    text = str(caught.value)
    assert "open and close more than 64 times within a millionth" in text
    assert "contacts[0]" in text
    assert "mesh cycle 1" in text
